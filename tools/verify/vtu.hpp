// SPDX-License-Identifier: BSD-3-Clause
// Reads fields of .vtu files with raw appended arrays, compressed by zlib or not, and of the pieces of a
// .pvtu.
#pragma once

#include <filesystem>
#include <map>

#include "verify/real.hpp"

namespace kacanov::verify {

struct Array {
  std::size_t components = 1;
  std::vector<double> values;  ///< node numbers up to 2^53 are exact
};

/// Returns the point data by name, with the points as "Points". Throws Failure if the file is not a .vtu.
std::map<std::string, Array> read_point_data(const std::filesystem::path& file);

/// Returns the point data of body.vtu, or of all pieces of body.pvtu, which older versions wrote. `mark`:
/// suffix of a load step after "body".
std::vector<std::map<std::string, Array>> read_body(const std::filesystem::path& folder,
                                                    const std::string& mark);

}  // namespace kacanov::verify
