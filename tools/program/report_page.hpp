// SPDX-License-Identifier: BSD-3-Clause
// report.html: a self-contained page about a run with an interactive 3D view.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "case/case_file.hpp"
#include "program/show_run.hpp"

namespace kacanov {

/// With more triangles the page has no interactive view and states the reason.
constexpr std::size_t most_report_triangles = 400'000;

/// Content of the page. Spans and pointers are not owned.
struct ReportPage {
  const Case* input = nullptr;
  const nlohmann::ordered_json* result = nullptr;  ///< content of result.json
  std::string history;                             ///< content of history.csv
  const Mesh* mesh = nullptr;                      ///< 3D: the boundary suffices
  std::span<const double> displacement;            ///< nodes × dim
  const ShownRun* shown = nullptr;
  std::size_t most_triangles = most_report_triangles;
};

/// Returns the page. Names and texts of the case may contain any character. Throws InternalError if an array
/// does not fit the mesh.
std::string report_html(const ReportPage& page);

/// Fixed parts of the page: the style, and the script that builds the rest from embedded data.
extern const char* const report_style;
extern const char* const report_script;
extern const char* const report_view;  ///< part of the script that draws the body

}  // namespace kacanov
