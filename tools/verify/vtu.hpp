// SPDX-License-Identifier: BSD-3-Clause
// The fields of a .vtu file with raw appended arrays, packed by zlib or not, and of the pieces of a .pvtu.
#pragma once

#include <filesystem>
#include <map>

#include "verify/real.hpp"

namespace kacanov::verify {

struct Array {
  std::size_t components = 1;
  std::vector<double> values;  ///< numbers of nodes up to 2^53 are exact
};

/// Point data by name, and the points themselves as "Points". Throws Failure for a file that is none.
std::map<std::string, Array> read_point_data(const std::filesystem::path& file);

/// Those of body.vtu, or of all pieces that body.pvtu names, which older versions left. `mark`: of a load
/// step, behind "body".
std::vector<std::map<std::string, Array>> read_body(const std::filesystem::path& folder,
                                                    const std::string& mark);

}  // namespace kacanov::verify
