// SPDX-License-Identifier: BSD-3-Clause
// The tables of loops, one per instruction set, and the choice between them at run time.
#pragma once

#include <string_view>

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

namespace kacanov::simd {

enum class InstructionSet { plain, avx2, avx512 };

/// Returns `wanted`, or, if that is empty, the environment variable KACANOV_INSTRUCTION_SET, or the best
/// available one. Throws std::invalid_argument for unknown names and those that this processor or build does
/// not support.
InstructionSet choose_instruction_set(std::string_view wanted);

std::string_view name(InstructionSet set) noexcept;

template <class Real>
const Kernels<Real>& kernels(InstructionSet set) noexcept;

}  // namespace kacanov::simd
