// SPDX-License-Identifier: BSD-3-Clause
// The constant `sanitized`: true in builds with the address sanitizer, which need much more memory and time.
#pragma once

#if defined(__SANITIZE_ADDRESS__)  // GCC
#define KACANOV_TESTS_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)  // clang
#define KACANOV_TESTS_SANITIZED
#endif
#endif

namespace kacanov::testing {

/// For `* doctest::skip(sanitized)` on cases about the accuracy or speed of larger bodies, whose code other
/// cases cover. With --no-skip the test program runs them anyway.
#ifdef KACANOV_TESTS_SANITIZED
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif

}  // namespace kacanov::testing
