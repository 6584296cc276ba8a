// SPDX-License-Identifier: BSD-3-Clause
// Whether tests are built with the address sanitizer, whose shadow memory knows no limit and takes its time.
#pragma once

#if defined(__SANITIZE_ADDRESS__)  // GCC
#define KACANOV_TESTS_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)  // clang
#define KACANOV_TESTS_SANITIZED
#endif
#endif

namespace kacanov::testing {

/// For `* doctest::skip(sanitized)` behind the name of a case that is about numbers or times of larger
/// bodies: others go through the same code. The test program runs it all the same with --no-skip.
#ifdef KACANOV_TESTS_SANITIZED
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif

}  // namespace kacanov::testing
