// SPDX-License-Identifier: BSD-3-Clause
// Detects the processor's instruction sets and selects the loops built for one.
#include "simd/instruction_set.hpp"

#include <cstdlib>
#include <stdexcept>
#include <string>

#include "simd/motion_products.hpp"
#include "simd/row_points.hpp"

namespace kacanov::simd {
namespace {

bool available(InstructionSet set) noexcept {
#ifdef KACANOV_X86_KERNELS
  switch (set) {
    case InstructionSet::plain: return true;
    case InstructionSet::avx2: return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    case InstructionSet::avx512:
      return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
             __builtin_cpu_supports("avx512vl");
  }
#endif
  return set == InstructionSet::plain;
}

}  // namespace

InstructionSet choose_instruction_set(std::string_view wanted) {
  constexpr InstructionSet best_first[] = {InstructionSet::avx512, InstructionSet::avx2,
                                           InstructionSet::plain};
  const char* variable = std::getenv("KACANOV_INSTRUCTION_SET");
  if (wanted.empty() && variable != nullptr) wanted = variable;
  for (const InstructionSet set : best_first) {
    if (wanted.empty() && available(set)) return set;
    if (wanted != name(set)) continue;
    if (available(set)) return set;
    throw std::invalid_argument("instruction set: this processor or build has no " + std::string(wanted));
  }
  throw std::invalid_argument("instruction set: expected avx512, avx2 or plain, got \"" +
                              std::string(wanted) + "\"");
}

std::string_view name(InstructionSet set) noexcept {
  switch (set) {
    case InstructionSet::plain: return "plain";
    case InstructionSet::avx2: return "avx2";
    case InstructionSet::avx512: return "avx512";
  }
  return {};
}

template <class Real>
const Kernels<Real>& kernels(InstructionSet set) noexcept {
#ifdef KACANOV_X86_KERNELS
  if (set == InstructionSet::avx512) return kernels_avx512(Real{});
  if (set == InstructionSet::avx2) return kernels_avx2(Real{});
#endif
  (void)set;
  return kernels_plain(Real{});
}

template const Kernels<double>& kernels<double>(InstructionSet) noexcept;
template const Kernels<float>& kernels<float>(InstructionSet) noexcept;

}  // namespace kacanov::simd

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

namespace kacanov::simd {
namespace {

const AllRowLoops& all_loops([[maybe_unused]] InstructionSet set) {
#ifdef KACANOV_X86_KERNELS
  if (set == InstructionSet::avx512) return rows_avx512();
  if (set == InstructionSet::avx2) return rows_avx2();
#endif
  return rows_plain();
}

}  // namespace

template <std::size_t nodes>
const RowLoops<nodes>& row_loops(std::string_view instruction_set) {
  const AllRowLoops& all = all_loops(choose_instruction_set(instruction_set));
  if constexpr (nodes == 4)
    return all.tet4;
  else if constexpr (nodes == 8)
    return all.hex8;
  else
    return all.tet10;
}

template const RowLoops<4>& row_loops<4>(std::string_view);
template const RowLoops<8>& row_loops<8>(std::string_view);
template const RowLoops<10>& row_loops<10>(std::string_view);

}  // namespace kacanov::simd
