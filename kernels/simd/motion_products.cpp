// SPDX-License-Identifier: BSD-3-Clause
// Selects the products of rigid motions built for an instruction set.
#include "simd/motion_products.hpp"

#include "simd/instruction_set.hpp"

namespace kacanov::simd {
namespace {

MotionLoops loops([[maybe_unused]] InstructionSet set) {
#ifdef KACANOV_X86_KERNELS
  if (set == InstructionSet::avx512) return motions_avx512();
  if (set == InstructionSet::avx2) return motions_avx2();
#endif
  return motions_plain();
}

}  // namespace

template <int M>
AddMotionProducts<M> motion_products(std::string_view instruction_set) {
  const MotionLoops found = loops(choose_instruction_set(instruction_set));
  if constexpr (M == 3)
    return found.plane;
  else
    return found.space;
}

template AddMotionProducts<3> motion_products<3>(std::string_view);
template AddMotionProducts<6> motion_products<6>(std::string_view);

}  // namespace kacanov::simd
