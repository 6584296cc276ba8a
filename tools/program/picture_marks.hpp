// SPDX-License-Identifier: BSD-3-Clause
// Marks of supports and loads in the picture of a body.
#pragma once

#include <vector>

#include "case/case_file.hpp"
#include "pictures/picture.hpp"

namespace kacanov {

/// Returns the nodes of supports, springs and loads, the latter with directions. In 3D `mesh` needs the
/// boundary only; inner nodes and volume loads have no marks.
std::vector<DeformedPicture::Mark> picture_marks(const Case& input, const Mesh& mesh);

}  // namespace kacanov
