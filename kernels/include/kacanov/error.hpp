// SPDX-License-Identifier: BSD-3-Clause
// The two exception types of the library.
#pragma once

#include <stdexcept>
#include <string>

namespace kacanov {

/// Invalid input: the message names the key, file and line, or element, and what was expected.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Internal failure: a library call failed or a file could not be written.
class InternalError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace kacanov
