// SPDX-License-Identifier: BSD-3-Clause
// The element loops built for AVX-512 (F, DQ).
#include "simd/instruction_set.hpp"
#include "simd/vector_avx512.hpp"

#include "simd/loops.hpp"

namespace kacanov::simd {

const Kernels<double>& kernels_avx512(double) { return Loops<double>::table; }
const Kernels<float>& kernels_avx512(float) { return Loops<float>::table; }

}  // namespace kacanov::simd
