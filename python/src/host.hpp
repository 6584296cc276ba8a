// SPDX-License-Identifier: BSD-3-Clause
// Connects a running solve to Python: callbacks, signals, threads.
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <exception>
#include <mutex>

#include <kacanov/run_options.hpp>
#include "program/one_run.hpp"
#include "program/plain_locale.hpp"

namespace kacanov::python {

/// Calls the Python callbacks of a run. Stores an exception raised by a callback or a signal, which stops the
/// run at its next wants_stop().
class Host {
 public:
  Host(pybind11::object progress, pybind11::object stop, const PlainLocale& locale)
      : progress_(std::move(progress)), stop_(std::move(stop)), locale_(locale) {}

  void tell(const ProgressStep& step);
  /// Polls Python at most fifty times per second, because acquiring the GIL takes time.
  bool wants_stop();
  /// Handles a signal that arrived after the last wants_stop() of the run. Requires the GIL.
  void look_once_more();
  /// The stored exception; null: none.
  const std::exception_ptr& raised() const noexcept { return raised_; }

 private:
  template <class Work>
  void guard(const Work& work);

  pybind11::object progress_, stop_;
  const PlainLocale& locale_;
  std::exception_ptr raised_;
  bool stopped_ = false;
  std::chrono::steady_clock::time_point asked_{};
};

/// Throws StateError if this thread is already in a solve, that is, in one of its callbacks.
void refuse_within_callback();

/// Waits until no other thread is in a run; signals can interrupt the wait. Requires the GIL, and releases it
/// while waiting.
std::unique_lock<RunMutex> begin_run();

}  // namespace kacanov::python
