// SPDX-License-Identifier: BSD-3-Clause
// The tables of loops, one per instruction set; instruction_set.hpp chooses between them.
#pragma once

#include "simd/block.hpp"

namespace kacanov::simd {

// The argument only selects the precision.
const Kernels<double>& kernels_plain(double);
const Kernels<float>& kernels_plain(float);
const Kernels<double>& kernels_avx2(double);
const Kernels<float>& kernels_avx2(float);
const Kernels<double>& kernels_avx512(double);
const Kernels<float>& kernels_avx512(float);

}  // namespace kacanov::simd
