// SPDX-License-Identifier: BSD-3-Clause
// The element loops built for the compiler's baseline.
#include "simd/instruction_set.hpp"
#include "simd/vector_plain.hpp"

#include "simd/loops.hpp"

namespace kacanov::simd {

const Kernels<double>& kernels_plain(double) { return Loops<double>::table; }
const Kernels<float>& kernels_plain(float) { return Loops<float>::table; }

}  // namespace kacanov::simd
