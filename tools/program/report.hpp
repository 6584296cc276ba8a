// SPDX-License-Identifier: BSD-3-Clause
// Terminal output of a run: one line per step and a summary.
#pragma once

#include <string>

#include <kacanov/problem.hpp>
#include <kacanov/solve.hpp>
#include "program/result_json.hpp"
#include "program/terminal.hpp"

namespace kacanov {

/// Prints progress as an aligned table to standard output, with a heading at the first step. It fits 80
/// columns; wider terminals get more columns.
class ProgressTable {
 public:
  ProgressTable(const Terminal& terminal, double tolerance) : terminal_(terminal), tolerance_(tolerance) {}
  void operator()(const ProgressStep& step);
  /// See RunOptions::stage.
  void stage(const std::string& name);

 private:
  void head();
  std::string left(const ProgressStep& step) const;

  Terminal terminal_;
  double tolerance_;
  double worst_ = 0.0, seconds_ = 0.0;  ///< of the previous step
  bool headed_ = false;
};

/// Returns a text such as "12.3 MB".
std::string readable_bytes(double bytes);
/// Returns a text such as "3.4 %".
std::string readable_share(double share);
/// Returns a text such as "0.12 s" or "12 min".
std::string readable_seconds(double seconds);

/// Returns the summary of a run, several lines of any length. The model provides the names of probes.
std::string summary(const Result& result, const RunFigures& figures, const Model& model, int dim);

/// Returns a summary formatted for a terminal: wrapped lines, and colours if supported.
std::string shown(const Terminal& terminal, Status status, const std::string& summary);

}  // namespace kacanov
