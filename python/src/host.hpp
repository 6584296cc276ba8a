// SPDX-License-Identifier: BSD-3-Clause
// Python while a case is solved: its callbacks, its signals, its threads.
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <exception>
#include <mutex>

#include <kacanov/run_options.hpp>
#include "program/one_run.hpp"
#include "program/plain_locale.hpp"

namespace kacanov::python {

/// Asks and tells Python on a run's way. What is raised there, by callbacks or a signal, is kept, and stops
/// the run at its next question.
class Host {
 public:
  Host(pybind11::object progress, pybind11::object stop, const PlainLocale& locale)
      : progress_(std::move(progress)), stop_(std::move(stop)), locale_(locale) {}

  void tell(const ProgressStep& step);
  /// Python's lock has to be waited for, so that it is asked no more than fifty times a second.
  bool wants_stop();
  /// A signal that came after the run's last question is one of the run still. With Python's lock.
  void look_once_more();
  /// What was raised; null: nothing.
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

/// Throws StateError where this thread is at a solve already, whose callback asks for another one.
void refuse_within_callback();

/// Waits until nobody else is at a run, and may be interrupted meanwhile. With Python's lock, which is let go
/// while waiting.
std::unique_lock<RunMutex> begin_run();

}  // namespace kacanov::python
