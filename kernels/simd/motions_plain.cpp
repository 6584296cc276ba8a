// SPDX-License-Identifier: BSD-3-Clause
// The products of rigid motions built for the compiler's baseline.
#include "simd/motion_loop.hpp"

namespace kacanov::simd {

MotionLoops motions_plain() { return {add_products<3>, add_products<6>}; }

}  // namespace kacanov::simd
