// SPDX-License-Identifier: BSD-3-Clause
// Choice of the loops' instruction set at run time.
#pragma once

#include <string_view>

#include "simd/kernels.hpp"

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
