// SPDX-License-Identifier: BSD-3-Clause
// The steps of a run as a table for other programs: history.csv.
#pragma once

#include <string>
#include <vector>

#include <kacanov/run_options.hpp>

namespace kacanov {

/// Outer steps as they were made, those of the load steps one after the other.
class History {
 public:
  void add(const ProgressStep& step) { steps_.push_back(step); }
  /// A heading and a line a step, all numbers to the last bit.
  std::string csv() const;

 private:
  std::vector<ProgressStep> steps_;
};

}  // namespace kacanov
