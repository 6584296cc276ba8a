// SPDX-License-Identifier: BSD-3-Clause
// Makes a mesh of what its file says: the elements of highest dimension are the body, groups its named parts.
#pragma once

#include <string>

#include <kacanov/mesh.hpp>
#include "formats/mesh_content.hpp"

namespace kacanov {

/// `path` is the file's name in messages. Throws InputError naming the element or node that cannot be part of
/// a body. Elements are not yet checked: see check_mesh.
Mesh make_mesh(const std::string& path, MeshContent content);

}  // namespace kacanov
