// SPDX-License-Identifier: BSD-3-Clause
// The loops over consecutive elements built for the compiler's baseline.
#include "simd/row_loop.hpp"

namespace kacanov::simd {

const AllRowLoops& rows_plain() { return all_row_loops; }

}  // namespace kacanov::simd
