// SPDX-License-Identifier: BSD-3-Clause
// report.html: a run on one page that needs no network, with a view of the body to be turned.
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

/// Above this number of triangles the page has no view to be turned, and says so.
constexpr std::size_t most_report_triangles = 400'000;

/// What a page is made of. Nothing of spans and pointers is owned.
struct ReportPage {
  const Case* input = nullptr;
  const nlohmann::ordered_json* result = nullptr;  ///< what is in result.json
  std::string history;                             ///< what is in history.csv
  const Mesh* mesh = nullptr;                      ///< of which 3D needs the boundary only
  std::span<const double> displacement;            ///< nodes × dim
  const ShownRun* shown = nullptr;
  std::size_t most_triangles = most_report_triangles;
};

/// The page. Names and texts of the case may hold any character. Throws InternalError if an array does not
/// fit the mesh.
std::string report_html(const ReportPage& page);

/// What is fixed of it: the style, and the script that builds the rest from the data in the page.
extern const char* const report_style;
extern const char* const report_script;
extern const char* const report_view;  ///< the part of the script that draws the body

}  // namespace kacanov
