// SPDX-License-Identifier: BSD-3-Clause
// What a run tells people: a line a step while it goes, a summary when it is done.
#pragma once

#include <string>

#include <kacanov/problem.hpp>
#include <kacanov/solve.hpp>
#include "program/result_json.hpp"
#include "program/terminal.hpp"

namespace kacanov {

/// Prints progress as an aligned table on standard output; its headings come with the first step. 80 columns
/// are enough for it, with more it has some more.
class ProgressTable {
 public:
  ProgressTable(const Terminal& terminal, double tolerance) : terminal_(terminal), tolerance_(tolerance) {}
  void operator()(const ProgressStep& step);
  /// As RunOptions::stage.
  void stage(const std::string& name);

 private:
  void head();
  std::string left(const ProgressStep& step) const;

  Terminal terminal_;
  double tolerance_;
  double worst_ = 0.0, seconds_ = 0.0;  ///< of the step before
  bool headed_ = false;
};

/// "12.3 MB" and the like.
std::string readable_bytes(double bytes);
/// "3.4 %" and the like.
std::string readable_share(double share);
/// "0.12 s", "12 min" and the like.
std::string readable_seconds(double seconds);

/// The summary at the end of a run, several lines of any length. Takes names of probes from the model.
std::string summary(const Result& result, const RunFigures& figures, const Model& model, int dim);

/// A summary as a terminal shows it: lines that fit, colours where it has them.
std::string shown(const Terminal& terminal, Status status, const std::string& summary);

}  // namespace kacanov
