// SPDX-License-Identifier: BSD-3-Clause
// Detects the processor's instruction sets and selects the loops built for one.
#include "simd/instruction_set.hpp"

#include <cstdlib>
#include <stdexcept>
#include <string>

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
