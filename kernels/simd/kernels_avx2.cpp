// SPDX-License-Identifier: BSD-3-Clause
// The element loops built for AVX2 with FMA.
#include "simd/instruction_set.hpp"
#include "simd/vector_avx2.hpp"

#include "simd/loops.hpp"

namespace kacanov::simd {

const Kernels<double>& kernels_avx2(double) { return Loops<double>::table; }
const Kernels<float>& kernels_avx2(float) { return Loops<float>::table; }

}  // namespace kacanov::simd
