// SPDX-License-Identifier: BSD-3-Clause
// History of the outer steps of a run, as history.csv.
#pragma once

#include <string>
#include <vector>

#include <kacanov/run_options.hpp>

namespace kacanov {

/// Outer steps in order, across all load steps.
class History {
 public:
  void add(const ProgressStep& step) { steps_.push_back(step); }
  /// Returns a header line and one line per step; numbers have all digits.
  std::string csv() const;

 private:
  std::vector<ProgressStep> steps_;
};

}  // namespace kacanov
