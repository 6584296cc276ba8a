// SPDX-License-Identifier: BSD-3-Clause
// Shares exceptions among the ranks of a solve, so that no rank waits for one that has left.
#include "ranks.hpp"

namespace py = pybind11;

namespace kacanov::python {
namespace {

/// Returns type and message. Requires the GIL.
std::string words_of(const py::error_already_set& error) {
  std::string text = py::str(error.type().attr("__name__"));
  try {
    const std::string message = py::str(error.value());
    if (!message.empty()) text += ": " + message;
  } catch (const py::error_already_set&) {  // its __str__ raises too
  }
  return text;
}

Elsewhere described(const std::exception_ptr& raised, int rank) {
  if (!raised) return {};
  try {
    std::rethrow_exception(raised);
  } catch (const py::error_already_set& error) {
    return {rank, error.matches(PyExc_KeyboardInterrupt), words_of(error)};
  } catch (...) {
    return {rank, false, current_failure().cause};
  }
}

}  // namespace

Elsewhere agree_on_exceptions(const MpiSession& mpi, const std::exception_ptr& raised) {
  Elsewhere found = described(raised, mpi.rank());
  const py::gil_scoped_release release;
  const int weight = found.rank < 0 ? 0 : found.interrupt ? 2 : 1;
  int most = 0;
  mpi.expect_all_here();
  MPI_Allreduce(&weight, &most, 1, MPI_INT, MPI_MAX, mpi.comm());
  if (most == 0) return {};
  const int candidate = weight == most ? mpi.rank() : mpi.ranks();
  MPI_Allreduce(&candidate, &found.rank, 1, MPI_INT, MPI_MIN, mpi.comm());
  found.interrupt = most == 2;
  broadcast(mpi, found.text, found.rank);
  return found;
}

}  // namespace kacanov::python
