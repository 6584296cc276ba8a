// SPDX-License-Identifier: BSD-3-Clause
// Solves a case from its file to its numbers, for commands and for host programs.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include <kacanov/coarse_solution.hpp>
#include <kacanov/part.hpp>
#include <kacanov/reference.hpp>
#include <kacanov/run_options.hpp>
#include "case/case_file.hpp"
#include "pictures/picture.hpp"
#include "program/field_files.hpp"
#include "program/parallel.hpp"

namespace kacanov {

/// Solves this rank's part of a case, including moving obstacles. Collective.
Solution solve_part(const Case& input, Part& part, const MpiSession& mpi, const RunOptions& options);

/// Prepends the warnings of the case and its problem to those of the result, and adds a likely cause to the
/// message of a run that did not converge. On the first rank.
void complete_messages(const Case& input, const Problem& problem, Result& result);

/// Content of a picture: values, their name, and surroundings.
struct PictureContent {
  std::span<const double> values;  ///< nodes
  std::array<std::string, 2> quantity{"von Mises", "stress"};
  std::vector<DeformedPicture::ObstacleFacet> obstacles = {};  ///< except planes at rest
  Vector3 view = {};                                           ///< zero: as set in the case
  bool surroundings = true;                                    ///< planes, supports and loads
};

/// Returns the deformed body as SVG. `displacement` (nodes × dim) and values are numbered as the mesh, of
/// which 3D needs the boundary only.
std::string deformed_picture(const Case& input, const Mesh& mesh, std::span<const double> displacement,
                             const PictureContent& content, double largest_von_mises);

/// State at the end of a load step before the last; displacement and contact are on the first rank.
struct StepFields {
  std::size_t number = 0;            ///< from 1: belongs to result.load_steps[number − 1]
  std::vector<double> displacement;  ///< nodes × dim
  std::vector<double> thermal;       ///< as SolvedCase::thermal
  ContactFields contact;
};

/// All results of a run, on the first rank and numbered as problem.mesh and problem.contact; other ranks have
/// only `result` and `json`.
struct SolvedCase {
  Case input;
  Problem problem;
  Result result;
  nlohmann::ordered_json json;       ///< content of result.json
  std::vector<double> displacement;  ///< nodes × dim
  std::vector<double> nodal_stress;  ///< nodes × 6: xx yy zz xy yz zx, recovered (theory: nodal-stress)
  std::vector<double> recovered_von_mises;  ///< nodes: of the recovered stress
  std::vector<double> averaged_von_mises;   ///< nodes: mean over the adjacent elements, as in pictures
  std::vector<double> error;                ///< elements: shares() of estimate_error()
  ContactFields contact;
  std::vector<double> thermal;               ///< Solution::thermal of all elements
  std::vector<std::int64_t> pressure_patch;  ///< as in Body
  std::vector<StepFields> steps;             ///< with CaseRun::keep_steps: the steps that converged
};

/// Computes element means on problem.mesh, as in the program's files: at the end of the run, or of one of its
/// steps. On the first rank.
void element_fields(const SolvedCase& solved, const reference::ElementFields& out);
void element_fields(const SolvedCase& solved, const StepFields& step, const reference::ElementFields& out);

struct CaseRun {
  RunOptions options;                 ///< without checkpoint and start
  const SolvedCase* start = nullptr;  ///< initial guess: same body, any mesh; on all ranks or none
  bool memory_check = true;           ///< refuse a run that does not fit into memory
  bool keep_steps = false;            ///< also keep fields of load steps before the last
};

/// Does what `kacanov run` does, except writing files: bitwise the same numbers for equal numbers of ranks
/// and threads and the same start. Not converging is a status. Throws InputError and InternalError.
/// Collective.
SolvedCase solve_case(const Case& input, const MpiSession& mpi, const CaseRun& run);

}  // namespace kacanov
