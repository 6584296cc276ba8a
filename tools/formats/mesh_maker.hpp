// SPDX-License-Identifier: BSD-3-Clause
// Converts file content to a mesh: the elements of the highest dimension form the body, groups its named
// parts.
#pragma once

#include <string>

#include <kacanov/mesh.hpp>
#include "formats/mesh_content.hpp"

namespace kacanov {

/// `path` names the file in messages. Throws InputError naming the element or node that cannot be part of a
/// body. Elements are not checked yet: see check_mesh().
Mesh make_mesh(const std::string& path, MeshContent content);

}  // namespace kacanov
