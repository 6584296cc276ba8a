// SPDX-License-Identifier: BSD-3-Clause
// kacanov_solve(): solves a case given as text inside a host process.
#include <kacanov/kacanov_solve.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <kacanov/error.hpp>
#include "c/handle.hpp"
#include "c/sized.hpp"
#include "embedding/host_guards.hpp"
#include "embedding/solution.hpp"
#include "program/launch.hpp"
#include "program/plain_locale.hpp"
#include "program/solve_case.hpp"

namespace kacanov::embedding {
namespace {

using c_api::Fault;

constexpr std::size_t options_bytes = offsetof(kacanov_solve_options, communicator) + sizeof(const void*);

kacanov_solve_options checked(const kacanov_solve_options* given) {
  if (given == nullptr) return {};
  auto options =
      c_api::read_sized<kacanov_solve_options>(given, options_bytes, "options.", "kacanov_solve_options");
  if (options.threads < 0 || options.threads > 4096)
    throw Fault(KACANOV_ERROR_VALUE,
                "options.threads: expected 0 to 4096, got " + std::to_string(options.threads));
  if (options.skip_memory_check != 0 && options.skip_memory_check != 1)
    throw Fault(KACANOV_ERROR_VALUE, "options.skip_memory_check: expected 0 or 1");
  if (options.mesh == nullptr && options.mesh_size > 0)
    throw Fault(KACANOV_ERROR_NULL, "options.mesh: null pointer");
  return options;
}

/// Parses the text of the first rank on every rank. Collective.
Case read_case(std::string text, const kacanov_solve_options& options, const MpiSession& mpi) {
  if (mpi.ranks() > 1) broadcast(mpi, text);
  Case input;
  together(mpi, [&] {
    const std::filesystem::path folder = options.folder == nullptr ? "" : options.folder;
    const std::string name = options.name == nullptr ? "case" : options.name;
    input = parse_case(CaseText{(folder / (name + ".json")).string(), text}, {});
    if (options.mesh != nullptr && input.mesh.file)
      input.mesh.content =
          std::make_shared<const std::string>(static_cast<const char*>(options.mesh), options.mesh_size);
  });
  return input;
}

int threads_for(const Case& input, int asked, const MpiSession& mpi) {
  if (asked > 0) return asked;
  return mpi.ranks() > 1 || estimate_unknowns(input.mesh) < small_problem ? 1 : usable_cores();
}

void tell(const kacanov_solve_options& host, const ProgressStep& step) {
  kacanov_progress told{};
  told.struct_size = sizeof told;
  told.phase = step.phase.c_str();
  told.contact_iterations = step.contact_iterations;
  told.cg_iterations = step.cg_iterations;
  told.penalty = step.r;
  told.energy = step.energy;
  told.worst_residual = step.certificate.worst();
  told.seconds = step.seconds;
  told.outer = step.outer;
  host.progress(host.data, &told);
}

std::unique_ptr<kacanov_solution> solve(const char* text, const kacanov_solve_options& options) {
  const std::unique_lock alone = begin_run();
  const PlainLocale locale;
  require_mpi();
  const auto* given = static_cast<const MPI_Comm*>(options.communicator);
  if (given != nullptr && *given == MPI_COMM_NULL)
    throw Fault(KACANOV_ERROR_VALUE, "options.communicator: MPI_COMM_NULL");
  const MpiSession mpi(given == nullptr ? MPI_COMM_SELF : *given);
  const Case input = read_case(text, options, mpi);
  CaseRun run;
  run.start = options.start == nullptr ? nullptr : &options.start->solved;
  run.memory_check = options.skip_memory_check == 0;
  run.options.threads = threads_for(input, options.threads, mpi);
  if (options.progress != nullptr)
    run.options.progress = [&](const ProgressStep& step) { locale.in_hosts([&] { tell(options, step); }); };
  bool stopped = false;
  if (options.stop != nullptr)
    run.options.stop_requested = [&] {
      stopped = stopped || locale.in_hosts([&] { return options.stop(options.data) != 0; });
      return stopped;
    };
  return std::make_unique<kacanov_solution>(solve_case(input, mpi, run));
}

}  // namespace
}  // namespace kacanov::embedding

int kacanov_solve(const char* text, const kacanov_solve_options* options, kacanov_solution** solution,
                  char* message, size_t message_size) {
  using namespace kacanov;
  if (solution != nullptr) *solution = nullptr;
  c_api::copy_message("", message, message_size);
  return c_api::guarded(message, message_size, [&] {
    c_api::require(text, "text");
    c_api::require(solution, "solution");
    try {
      *solution = embedding::solve(text, embedding::checked(options)).release();
    } catch (const InputError& error) {
      throw c_api::Fault(KACANOV_ERROR_CASE, error.what());
    }
  });
}
