// SPDX-License-Identifier: BSD-3-Clause
// Arbitrary bytes as a height map: rejected with a message, or a full grid of finite numbers.
#include <algorithm>
#include <cmath>

#include <kacanov/error.hpp>
#include "bytes.hpp"
#include "formats/height_reader.hpp"

using namespace kacanov;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const NumberGrid grid = parse_heights("fuzz.csv", fuzz::Bytes(data, size).rest());
    fuzz::expect(grid.rows >= 2 && grid.columns >= 2 && grid.values.size() == grid.rows * grid.columns);
    fuzz::expect(
        std::all_of(grid.values.begin(), grid.values.end(), [](double v) { return std::isfinite(v); }));
  } catch (const InputError&) {
  }
  return 0;
}
