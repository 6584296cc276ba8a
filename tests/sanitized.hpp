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
