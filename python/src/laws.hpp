// SPDX-License-Identifier: BSD-3-Clause
// Converts materials in case file syntax to laws of the C interface.
#pragma once

#include <string>
#include <vector>

#include <kacanov/kacanov.h>
#include <kacanov/law.hpp>

namespace kacanov::python {

/// Laws, and the tables they point to.
class CLaws {
 public:
  /// Parses a JSON list of materials, with the keys of a case file except `on`. Throws InputError with the
  /// path of the key: "law[0].young: expected a number > 0, got 0".
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
