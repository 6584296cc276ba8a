// SPDX-License-Identifier: BSD-3-Clause
// Where a body is held and loaded, for its picture.
#pragma once

#include <vector>

#include "case/case_file.hpp"
#include "pictures/picture.hpp"

namespace kacanov {

/// The nodes of supports, springs and loads, with the directions of the latter. Of `mesh` 3D needs the
/// boundary only; entries of inner nodes and what acts in the volume have no marks.
std::vector<DeformedPicture::Mark> picture_marks(const Case& input, const Mesh& mesh);

}  // namespace kacanov
