// SPDX-License-Identifier: BSD-3-Clause
// Reads a case and its mesh into a problem on the first rank and parts on all ranks.
#include "program/loaded_case.hpp"

#include <malloc.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>

#include <kacanov/error.hpp>
#include <kacanov/refine.hpp>
#include <kacanov/solve.hpp>
#include <kacanov/validity.hpp>
#include "formats/mesh_file.hpp"
#include "formats/node_values.hpp"
#include "formats/printable.hpp"
#include "problem/input_errors.hpp"
#include "program/memory_model.hpp"
#include "program/obstacle_files.hpp"

namespace kacanov {

Mesh load_mesh(const MeshSource& source) {
  if (source.adapted) return *source.adapted;
  Mesh mesh = source.box       ? make_box(*source.box)
              : source.content ? read_mesh(*source.file, *source.content)
                               : read_mesh(source_file(*source.file, source.folder));
  for (const NodeValueFile& file : source.node_values) try {
      mesh.node_fields.push_back(
          {file.path, read_node_values(source_file(file.name, source.folder), file.otherwise, mesh)});
    } catch (const InputError& error) {
      throw InputError(file.path + ".file: " + error.what());
    }
  if (source.box) return mesh;
  const std::vector<std::string> warnings = mesh.warnings;
  if (source.refine > 0) check_mesh(mesh);  // while elements still have the numbers of the file
  for (int times = 0; times < source.refine; ++times) mesh = refine(mesh);
  if (source.order > cell(mesh.type).order) mesh = raise_order(mesh);
  mesh.warnings = warnings;
  return mesh;
}

Problem load_problem(const Case& input, RankCount ranks) {
  const auto check_memory = [&](const ProblemSize& needed) {
    if (ranks.here > 0) refuse_what_cannot_fit(needed, ranks.all, ranks.here);
  };
  if (input.mesh.box && !input.mesh.adapted) check_memory(size_of(*input.mesh.box, input.model));
  for (std::size_t k = 0; k < input.mesh.coarser.size(); ++k)
    if (std::error_code error; !std::filesystem::is_regular_file(input.mesh.coarser[k], error))
      throw InputError("mesh.files[" + std::to_string(k) + "]: expected a mesh file, there is no " +
                       input.mesh.coarser[k]);
  Mesh mesh = load_mesh(input.mesh);
  const ProblemSize size = size_of(mesh, input.model);
  check_memory(size);
  naming_file(input.file, [&] { check_dimension(input, mesh.dim()); });
  std::vector<std::string> warnings;
  if (ranks.here > 0 && may_outgrow(size, ranks.all, ranks.here))
    warnings.push_back(outgrown_memory_message(size, ranks.all, ranks.here));
  const Model model = with_curves(model_with_files(input));
  Problem problem;
  naming_file(input.file, [&] { problem = build_problem(std::move(mesh), model); });
  problem.warnings.insert(problem.warnings.begin(), problem.mesh.warnings.begin(),
                          problem.mesh.warnings.end());
  const std::vector<std::string> found = examine(problem, model);
  problem.warnings.insert(problem.warnings.end(), found.begin(), found.end());
  problem.warnings.insert(problem.warnings.end(), warnings.begin(), warnings.end());
  return problem;
}

void print_warnings(const Case& input, const Problem& problem) {
  for (const auto* warnings : {&input.warnings, &problem.warnings})
    for (const std::string& warning : *warnings)
      std::cerr << "kacanov: warning: " + printable(warning) + "\n";
}

LoadedCase load_case(const Case& input, const MpiSession& mpi, bool memory_check,
                     const std::function<void(const std::string&)>& phase) {
  const bool tells = phase && mpi.first();
  LoadedCase loaded;
  RankCount ranks{mpi.ranks(), 0};
  {
    // On all ranks, whatever options a host has given to each; those of the first rank count.
    mpi.expect_all_here();
    MPI_Comm machine;
    MPI_Comm_split_type(mpi.comm(), MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
    if (memory_check) MPI_Comm_size(machine, &ranks.here);
    MPI_Comm_free(&machine);
  }
  const double start = MPI_Wtime();
  if (tells) phase(input.mesh.box ? "making the mesh" : "reading " + printable(*input.mesh.file));
  together(mpi, [&] {
    if (mpi.first()) loaded.problem = load_problem(input, ranks);
    if (mpi.first() && !mpi.hosted()) print_warnings(input, *loaded.problem);
  });
  const double read = MPI_Wtime();
  if (tells && mpi.ranks() > 1) phase("splitting into " + std::to_string(mpi.ranks()) + " parts");
  loaded.part = distribute(loaded.problem ? &*loaded.problem : nullptr, mpi.comm());
  {
    const ElementSets sets = loaded.problem ? element_sets(loaded.problem->mesh) : ElementSets();
    loaded.sets = distribute_sets(sets, loaded.part, mpi);
    loaded.set_names = sets.names;
  }
  loaded.read_seconds = read - start;
  loaded.distribute_seconds = MPI_Wtime() - read;
  return loaded;
}

void keep_boundary(LoadedCase& loaded) {
  if (loaded.problem) {
    loaded.print = fingerprint(*loaded.problem);
    loaded.boundary_nodes = keep_boundary(*loaded.problem);
  }
  malloc_trim(0);  // return memory to the system before the solver allocates
}

int threads_of(const Command& command) {
  if (command.threads) return *command.threads;
  const char* variable = std::getenv("OMP_NUM_THREADS");
  const int threads = variable != nullptr ? std::atoi(variable) : 1;
  return threads >= 1 ? threads : 1;
}

}  // namespace kacanov
