// SPDX-License-Identifier: BSD-3-Clause
// Materials in the words of the case file, as laws of the C interface.
#pragma once

#include <string>
#include <vector>

#include <kacanov/kacanov.h>
#include <kacanov/law.hpp>

namespace kacanov::python {

/// Laws and the tables that they point to.
class CLaws {
 public:
  /// A JSON list of materials, each with the keys of one in a case file but `on`. Throws InputError with
  /// the path of the key: "law[0].young: expected a number > 0, got 0".
  explicit CLaws(const std::string& json);
  CLaws(const CLaws&) = delete;
  CLaws& operator=(const CLaws&) = delete;

  const std::vector<kacanov_law>& laws() const noexcept { return laws_; }
  kacanov_law& law(std::size_t index) { return laws_.at(index); }

 private:
  std::vector<Law> kept_;
  std::vector<kacanov_law> laws_;
};

}  // namespace kacanov::python
