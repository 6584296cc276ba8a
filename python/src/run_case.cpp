// SPDX-License-Identifier: BSD-3-Clause
// Solves cases inside a Python process, alone or with the other ranks of a communicator.
#include "run_case.hpp"

#include <pybind11/stl.h>

#include <memory>
#include <mutex>
#include <optional>

#include <kacanov/error.hpp>
#include "host.hpp"
#include "program/host_mpi.hpp"
#include "program/launch.hpp"
#include "program/loaded_case.hpp"
#include "program/solve_case.hpp"
#include "ranks.hpp"

namespace py = pybind11;

namespace kacanov::python {
namespace {

using Solved = std::shared_ptr<const SolvedCase>;

/// Returns the communicator whose handle mpi4py stores at this address; 0: this process alone.
MPI_Comm communicator_at(std::uintptr_t address) {
  return address == 0 ? MPI_COMM_SELF : *reinterpret_cast<const MPI_Comm*>(address);
}

int threads_for(const Case& input, const std::optional<int>& asked) {
  return asked ? *asked : estimate_unknowns(input.mesh) < small_problem ? 1 : usable_cores();
}

/// Input of one rank, before any communication.
struct Given {
  std::string text, path;
  std::optional<std::string> mesh;
  std::optional<int> threads;
  Solved start;
  bool memory_check = true;
};

Given read(const py::dict& given) {
  const py::object failed = given["failed"];
  if (!failed.is_none()) {
    PyErr_SetObject(py::type::of(failed).ptr(), failed.ptr());
    throw py::error_already_set();
  }
  Given out{given["text"].cast<std::string>(),
            given["path"].cast<std::string>(),
            given["mesh"].cast<std::optional<std::string>>(),
            given["threads"].cast<std::optional<int>>(),
            given["start"].cast<Solved>(),
            given["memory_check"].cast<bool>()};
  if (out.threads && (*out.threads < 1 || *out.threads > 4096))
    throw InputError("threads: expected a whole number from 1 to 4096, got " + std::to_string(*out.threads));
  return out;
}

/// Parses the case of the first rank on all ranks. Collective.
Case share_case(Given& given, const MpiSession& mpi) {
  if (mpi.ranks() > 1) {
    broadcast(mpi, given.text);
    broadcast(mpi, given.path);
  }
  Case input;
  together(mpi, [&] { input = read_case(given.text, given.path, std::move(given.mesh)); });
  return input;
}

Solved solve(Given& given, const MpiSession& mpi, Host& host) {
  const Case input = share_case(given, mpi);
  CaseRun run;
  run.start = given.start.get();
  run.keep_steps = input.output.steps;
  run.memory_check = given.memory_check;
  run.options.threads = threads_for(input, given.threads);
  run.options.progress = [&host](const ProgressStep& step) { host.tell(step); };
  run.options.stop_requested = [&host] { return host.wants_stop(); };
  return std::make_shared<SolvedCase>(solve_case(input, mpi, run));
}

/// Returns the Python exception as an object, None without one; rethrows others. Requires the GIL.
py::object as_object(const std::exception_ptr& raised) {
  if (!raised) return py::none();
  try {
    std::rethrow_exception(raised);
  } catch (py::error_already_set& error) {
    py::object value = error.value();
    if (error.trace()) PyException_SetTraceback(value.ptr(), error.trace().ptr());
    return value;
  }
}

py::tuple outcome(Solved solved, const std::exception_ptr& raised, const Elsewhere& elsewhere) {
  py::object there = py::none();
  if (elsewhere.rank >= 0) there = py::make_tuple(elsewhere.rank, elsewhere.interrupt, elsewhere.text);
  return py::make_tuple(py::cast(std::move(solved)), as_object(raised), there);
}

/// Returns whether this rank ran out of memory inside a collective operation: other ranks would not answer.
bool is_alone(const std::exception_ptr& raised) {
  try {
    if (raised) std::rethrow_exception(raised);
  } catch (const std::bad_alloc&) {
    return true;
  } catch (...) {
    return false;
  }
  return false;
}

}  // namespace

Case read_case(const std::string& text, const std::string& path, std::optional<std::string> mesh) {
  Case input = parse_case(CaseText{path, text}, {});
  if (mesh && input.mesh.file) input.mesh.content = std::make_shared<const std::string>(std::move(*mesh));
  return input;
}

py::tuple run_case(const py::dict& arguments) {
  // A call from a callback must not communicate: the other ranks are still inside the solve and would not
  // answer.
  refuse_within_callback();
  const auto address = arguments["comm"].cast<std::uintptr_t>();
  const PlainLocale locale;
  Host host(arguments["progress"], arguments["stop"], locale);
  Given given;
  std::unique_lock<RunMutex> alone;
  std::exception_ptr raised = caught([&] {
    given = read(arguments);
    alone = begin_run();
  });
  if (address == 0 && raised) std::rethrow_exception(raised);
  // Py_AtExit runs after Python's atexit, by when PETSc, which may start later, has been finalised.
  if (start_host_mpi()) Py_AtExit(&end_host_mpi);
  const MpiSession mpi(communicator_at(address));
  Elsewhere elsewhere = agree_on_exceptions(mpi, raised);
  if (elsewhere.rank >= 0) return outcome(nullptr, raised, elsewhere);
  Solved solved;
  raised = caught([&] {
    const py::gil_scoped_release release;
    solved = solve(given, mpi, host);
  });
  if (is_alone(raised)) std::rethrow_exception(raised);
  host.look_once_more();
  if (host.raised()) raised = host.raised();
  elsewhere = agree_on_exceptions(mpi, raised);
  return outcome(std::move(solved), raised, elsewhere);
}

}  // namespace kacanov::python
