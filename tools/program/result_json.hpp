// SPDX-License-Identifier: BSD-3-Clause
// Writes result.json, the numbers of a run.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include <kacanov/result.hpp>
#include "case/case_file.hpp"

namespace kacanov {

/// Returns the value of `status` in the file.
const char* status_name(Status status);

/// Cost and results of one coarser mesh.
struct CoarseLevel {
  std::int64_t unknowns = 0;
  int outer_iterations = 0;
  std::int64_t cg_iterations = 0;
  std::uint64_t operator_applications = 0;
  double seconds = 0.0;  ///< total time from mesh to solution
  bool converged = false;
  bool halved = false;         ///< the next mesh has the edges of this one halved
  double error = 0.0;          ///< estimated; set if the next mesh is refined by it
  std::vector<Vector3> probe;  ///< as in Result; empty if a probe lies outside this mesh
  Vector3 contact_force{};
};

/// Measurements of a run beyond the Result of solve().
struct RunFigures {
  double total = 0.0, read = 0.0, distribute = 0.0, output = 0.0;  ///< seconds
  std::uint64_t peak_memory_bytes = 0;                             ///< sum over the ranks
  std::vector<CoarseLevel> nested;                                 ///< coarsest first
  std::vector<std::string> sets;                                   ///< names of element sets, by number
};

/// Returns all keys of the file. Of `mesh` only type and facets are used. Vectors have one entry per
/// dimension, moments always three; non-finite numbers become null.
nlohmann::ordered_json result_json(const Result& result, const RunFigures& figures, const Case& input,
                                   const Mesh& mesh);

/// Returns the file of a failed run: status "failed" and the reason.
nlohmann::ordered_json failure_json(const std::string& message);

/// Returns the output of `kacanov spectrum --json`: the eigenvalues that determine r*, which are those of [N;
/// T] with friction, and all estimates separately. `results` starts with N and is not empty.
nlohmann::ordered_json spectrum_json(std::span<const SpectrumResult> results, std::int64_t unknowns,
                                     std::int64_t contact_nodes);

}  // namespace kacanov
