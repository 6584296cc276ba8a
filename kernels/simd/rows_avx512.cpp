// SPDX-License-Identifier: BSD-3-Clause
// The loops over consecutive elements built for AVX-512 (F, DQ, VL).
#include "simd/row_loop.hpp"

namespace kacanov::simd {

const AllRowLoops& rows_avx512() { return all_row_loops; }

}  // namespace kacanov::simd
