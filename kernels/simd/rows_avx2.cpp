// SPDX-License-Identifier: BSD-3-Clause
// The loops over consecutive elements built for AVX2 with FMA.
#include "simd/row_loop.hpp"

namespace kacanov::simd {

const AllRowLoops& rows_avx2() { return all_row_loops; }

}  // namespace kacanov::simd
