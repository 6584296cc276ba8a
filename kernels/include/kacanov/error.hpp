// SPDX-License-Identifier: BSD-3-Clause
// The two kinds of failure the library throws.
#pragma once

#include <stdexcept>
#include <string>

namespace kacanov {

/// The input is wrong: the message names the key, file and line, or element, and what was expected.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Something that should not happen happened: a library call failed, a file could not be written.
class InternalError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace kacanov
