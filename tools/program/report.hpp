// SPDX-License-Identifier: BSD-3-Clause
// What a run tells people: a line a step while it goes, a summary when it is done.
#pragma once

#include <string>

#include <kacanov/problem.hpp>
#include <kacanov/solve.hpp>
#include "program/result_json.hpp"

namespace kacanov {

/// Prints progress as an aligned table on standard output; its headings come with the first step.
class ProgressTable {
 public:
  void operator()(const ProgressStep& step);

 private:
  bool headed_ = false;
};

/// "12.3 MB" and the like.
std::string readable_bytes(double bytes);
/// "0.12 s", "12 min" and the like.
std::string readable_seconds(double seconds);

/// The summary at the end of a run, several lines. Takes names of probes from the model.
std::string summary(const Result& result, const RunFigures& figures, const Model& model, int dim);

}  // namespace kacanov
