// SPDX-License-Identifier: BSD-3-Clause
// Laws of the C interface: checks, conversion to Law, and values of user-defined ones from their callbacks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <kacanov/kacanov.h>
#include <kacanov/law.hpp>
#include <kacanov/reference.hpp>

namespace kacanov::c_api {

/// An invalid argument: the code to return, and the message.
class Fault : public std::runtime_error {
 public:
  Fault(kacanov_code code, const std::string& message) : std::runtime_error(message), code_(code) {}
  kacanov_code code() const noexcept { return code_; }

 private:
  kacanov_code code_;
};

/// Converts `count` consecutive laws, each of the size given by the first one. Throws Fault, which names the
/// index of the law and the invalid parameter.
std::vector<Law> checked_laws(std::size_t count, const kacanov_law* laws);

/// The part of a user-defined law besides k0 and μ; `evaluate` is null for other laws.
struct OwnLaw {
  kacanov_law_callback evaluate = nullptr;
  void* data = nullptr;
  bool parallel = false;
  double yield = 0.0;  ///< strain beyond which it is plastic; 0: none
};

/// One per law of an array that checked_laws() has accepted.
std::vector<OwnLaw> own_laws(std::size_t count, const kacanov_law* laws);

/// Throws Fault for the first element with an invalid law.
void check_law_of_element(std::span<const std::uint16_t> law_of_element, std::size_t laws);

}  // namespace kacanov::c_api

struct kacanov_operator;

namespace kacanov::c_api {

/// Values of the laws at a displacement, elements × points.
struct PointValues {
  std::vector<double> x, secant, derivative, energy;
  PointModuli moduli() const { return {secant, derivative, energy}; }
};

struct WantedValues {
  bool derivative = false, energy = false;
};

/// Evaluates every law, user-defined or not, at u. Throws Fault if a callback returns an error or an invalid
/// modulus.
PointValues ask_laws(kacanov_operator& op, std::span<const double> u, WantedValues wanted);

}  // namespace kacanov::c_api
