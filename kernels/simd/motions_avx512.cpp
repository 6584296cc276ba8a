// SPDX-License-Identifier: BSD-3-Clause
// The products of rigid motions built for AVX-512 (F, DQ, VL).
#include "simd/motion_loop.hpp"

namespace kacanov::simd {

MotionLoops motions_avx512() { return {add_products<3>, add_products<6>}; }

}  // namespace kacanov::simd
