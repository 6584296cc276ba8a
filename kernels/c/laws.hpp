// SPDX-License-Identifier: BSD-3-Clause
// From the laws of the C interface to ours, checked.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <kacanov/kacanov.h>
#include <kacanov/law.hpp>

namespace kacanov::c_api {

/// A bad argument: the code to return, and the message.
class Fault : public std::runtime_error {
 public:
  Fault(kacanov_code code, const std::string& message) : std::runtime_error(message), code_(code) {}
  kacanov_code code() const noexcept { return code_; }

 private:
  kacanov_code code_;
};

/// `count` laws one after another, each of the size the first says it has. Throws Fault that names the law by
/// its index and the parameter at fault.
std::vector<Law> checked_laws(std::size_t count, const kacanov_law* laws);

/// What a law of the caller's own is besides k0 and μ; of the others `evaluate` is null.
struct OwnLaw {
  kacanov_law_callback evaluate = nullptr;
  void* data = nullptr;
  bool parallel = false;
  double yield = 0.0;  ///< strain beyond which it is plastic; 0: never
};

/// One a law of an array that checked_laws() has passed.
std::vector<OwnLaw> own_laws(std::size_t count, const kacanov_law* laws);

/// Throws Fault for the first element whose law does not exist.
void check_law_of_element(std::span<const std::uint16_t> law_of_element, std::size_t laws);

}  // namespace kacanov::c_api
