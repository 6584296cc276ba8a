// SPDX-License-Identifier: BSD-3-Clause
// A case from its file to its numbers, for commands and for programs that have the solver within them.
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

/// Solves the part of a case, with obstacles that move where there are some. Collective.
Solution solve_part(const Case& input, Part& part, const MpiSession& mpi, const RunOptions& options);

/// What was said of the case and of its problem stands before what the run says; a run that has failed says
/// in its message what may be behind it, where something is known. On the first rank.
void complete_messages(const Case& input, const Problem& problem, Result& result);

/// What colours a picture, and what is drawn round the body.
struct PictureContent {
  std::span<const double> values;  ///< nodes
  std::array<std::string, 2> quantity{"von Mises", "stress"};
  std::vector<DeformedPicture::ObstacleFacet> obstacles = {};  ///< but planes at rest
  Vector3 view = {};                                           ///< zero: as the case says
  bool surroundings = true;                                    ///< planes, supports and loads
};

/// The deformed body as SVG. `displacement` (nodes × dim) and values in the numbering of the mesh, of which
/// 3D needs the boundary only.
std::string deformed_picture(const Case& input, const Mesh& mesh, std::span<const double> displacement,
                             const PictureContent& content, double largest_von_mises);

/// The end of a load step before the last; displacement and contact are the first rank's.
struct StepFields {
  std::size_t number = 0;            ///< from 1: its line is result.load_steps[number − 1]
  std::vector<double> displacement;  ///< nodes × dim
  std::vector<double> thermal;       ///< as SolvedCase::thermal
  ContactFields contact;
};

/// Everything that a run has to say, on the first rank and in the numbering of problem.mesh and
/// problem.contact; other ranks have `result` and `json` alone.
struct SolvedCase {
  Case input;
  Problem problem;
  Result result;
  nlohmann::ordered_json json;       ///< what result.json holds
  std::vector<double> displacement;  ///< nodes × dim
  std::vector<double> nodal_stress;  ///< nodes × 6: xx yy zz xy yz zx, recovered (theory: nodal-stress)
  std::vector<double> recovered_von_mises;  ///< nodes: of that stress
  std::vector<double> averaged_von_mises;   ///< nodes: means of the elements round them, as in pictures
  std::vector<double> error;                ///< elements: shares() of estimate_error()
  ContactFields contact;
  std::vector<double> thermal;               ///< Solution::thermal of all elements
  std::vector<std::int64_t> pressure_patch;  ///< as in Body
  std::vector<StepFields> steps;  ///< where CaseRun::keep_steps asks for them: those that have converged
};

/// Means over the elements of problem.mesh, as in the program's files: at the end of the run, or of one of
/// its steps. On the first rank.
void element_fields(const SolvedCase& solved, const reference::ElementFields& out);
void element_fields(const SolvedCase& solved, const StepFields& step, const reference::ElementFields& out);

struct CaseRun {
  RunOptions options;                 ///< without checkpoint and start
  const SolvedCase* start = nullptr;  ///< to start from: of the same body, on any mesh; on all ranks or none
  bool memory_check = true;           ///< refuse what does not fit
  bool keep_steps = false;            ///< fields of the load steps before the last, too
};

/// What `kacanov run` does but for the files it writes: the same numbers to the last bit on as many ranks,
/// threads and starts. Not converging is a status. Throws InputError and InternalError. Collective.
SolvedCase solve_case(const Case& input, const MpiSession& mpi, const CaseRun& run);

}  // namespace kacanov
