// SPDX-License-Identifier: BSD-3-Clause
// Forced inlining in element loops: a call would spill about thirty vector registers. Without it the compiler
// emitted calls, and the loops took twice the time.
#pragma once

// Under the address sanitizer, whose checks multiply with every inlined copy, compilation would take minutes:
// use calls there.
#ifdef __SANITIZE_ADDRESS__
#define KACANOV_INLINE
#else
#define KACANOV_INLINE [[gnu::always_inline]]
#endif

#include <cstdint>

namespace {

/// Makes the compiler reload indices that it has already read, because keeping them would cause spills.
KACANOV_INLINE inline const std::uint16_t* read_anew(const std::uint16_t* at) {
  __asm__("" : "+r"(at));
  return at;
}

}  // namespace
