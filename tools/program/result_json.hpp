// SPDX-License-Identifier: BSD-3-Clause
// result.json: the numbers of a run.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include <kacanov/result.hpp>
#include "case/case_file.hpp"

namespace kacanov {

/// As the file's `status` says it.
const char* status_name(Status status);

/// What a coarser mesh took.
struct CoarseLevel {
  std::int64_t unknowns = 0;
  int outer_iterations = 0;
  std::int64_t cg_iterations = 0;
  std::uint64_t operator_applications = 0;
  double seconds = 0.0;  ///< everything from the mesh to the solution
  bool converged = false;
  bool halved = false;         ///< whether the next mesh has this one's edges, each halved
  double error = 0.0;          ///< estimated, where the next mesh is refined by it
  std::vector<Vector3> probe;  ///< as in Result; empty where a probe lies outside this mesh
  Vector3 contact_force{};
};

/// What the program measures of a run besides what solve() says.
struct RunFigures {
  double total = 0.0, read = 0.0, distribute = 0.0, output = 0.0;  ///< seconds
  std::uint64_t peak_memory_bytes = 0;                             ///< of all ranks together
  std::vector<CoarseLevel> nested;                                 ///< coarsest first
  std::vector<std::string> sets;                                   ///< of elements of the mesh, by number
};

/// Every key of the file. `mesh` needs its type and facets only. Vectors have as many entries as the mesh has
/// dimensions, moments always three; numbers that are not finite become null.
nlohmann::ordered_json result_json(const Result& result, const RunFigures& figures, const Case& input,
                                   const Mesh& mesh);

/// The file of a run that broke down: status "failed" and why.
nlohmann::ordered_json failure_json(const std::string& message);

/// What `kacanov spectrum --json` prints: the eigenvalues that decide r*, which are those of [N; T] with
/// friction, and all estimates one by one. `results` has N first and is not empty.
nlohmann::ordered_json spectrum_json(std::span<const SpectrumResult> results, std::int64_t unknowns,
                                     std::int64_t contact_nodes);

}  // namespace kacanov
