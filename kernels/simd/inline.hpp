// SPDX-License-Identifier: BSD-3-Clause
// Everything inside an element loop has to be part of it: a call would spill some thirty vector registers.
// Left to itself the compiler made calls, at twice the time.
#pragma once

// Under the address sanitizer, whose checks multiply with every copy, compiling that takes minutes: there
// calls do.
#ifdef __SANITIZE_ADDRESS__
#define KACANOV_INLINE
#else
#define KACANOV_INLINE [[gnu::always_inline]]
#endif

#include <cstdint>

namespace {

/// Keeps the compiler from holding indices it has read before: it would spill them.
KACANOV_INLINE inline const std::uint16_t* read_anew(const std::uint16_t* at) {
  __asm__("" : "+r"(at));
  return at;
}

}  // namespace
