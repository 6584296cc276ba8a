// SPDX-License-Identifier: BSD-3-Clause
// Which instruction set the loops use, decided at run time.
#pragma once

#include <string_view>

#include "simd/kernels.hpp"

namespace kacanov::simd {

enum class InstructionSet { plain, avx2, avx512 };

/// `wanted`, or the environment variable KACANOV_INSTRUCTION_SET if that is empty, or the best there is.
/// Throws std::invalid_argument for names that do not exist or that this processor or build does not have.
InstructionSet choose_instruction_set(std::string_view wanted);

std::string_view name(InstructionSet set) noexcept;

template <class Real>
const Kernels<Real>& kernels(InstructionSet set) noexcept;

}  // namespace kacanov::simd
