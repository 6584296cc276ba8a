// SPDX-License-Identifier: BSD-3-Clause
// Connects a running solve to Python: callbacks, signals, threads.
#include "host.hpp"

#include "errors.hpp"

namespace py = pybind11;

namespace kacanov::python {
namespace {

void take_signals_of_python() {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

bool try_for_a_moment() {
  const py::gil_scoped_release release;
  return one_run.try_lock_for(std::chrono::milliseconds(50));
}

}  // namespace

template <class Work>
void Host::guard(const Work& work) {
  try {
    locale_.in_hosts(work);
  } catch (py::error_already_set&) {
    raised_ = std::current_exception();
  }
}

void Host::tell(const ProgressStep& step) {
  if (progress_.is_none()) return;
  const py::gil_scoped_acquire acquire;
  guard([&] {
    py::dict line;
    line["phase"] = step.phase;
    line["outer"] = step.outer;
    line["contact_iterations"] = step.contact_iterations;
    line["cg_iterations"] = step.cg_iterations;
    line["r"] = step.r;
    line["energy"] = step.energy;
    line["worst_residual"] = step.certificate.worst();
    line["seconds"] = step.seconds;
    progress_(line);
  });
}

bool Host::wants_stop() {
  if (raised_ || stopped_) return true;
  const auto now = std::chrono::steady_clock::now();
  if (now - asked_ < std::chrono::milliseconds(20)) return false;
  asked_ = now;
  const py::gil_scoped_acquire acquire;
  guard([&] {
    take_signals_of_python();
    if (!stop_.is_none()) stopped_ = py::bool_(stop_());
  });
  return raised_ || stopped_;
}

void Host::look_once_more() {
  if (!raised_) guard(take_signals_of_python);
}

void refuse_within_callback() {
  if (one_run.is_mine()) throw CodeError(KACANOV_ERROR_STATE, "solve: called from a callback of a solve");
}

std::unique_lock<RunMutex> begin_run() {
  while (!try_for_a_moment()) take_signals_of_python();
  return {one_run, std::adopt_lock};
}

}  // namespace kacanov::python
