// SPDX-License-Identifier: BSD-3-Clause
// Shares exceptions among the ranks of a solve, so that no rank waits for one that has left.
#pragma once

#include <pybind11/pybind11.h>

#include <exception>
#include <string>

#include "program/parallel.hpp"

namespace kacanov::python {

/// The first rank with an exception; KeyboardInterrupt takes precedence.
struct Elsewhere {
  int rank = -1;           ///< negative: none
  bool interrupt = false;  ///< a KeyboardInterrupt
  std::string text;        ///< type and message
};

/// Returns the exception to report. `raised`: exception of this rank, or null. Requires the GIL, and releases
/// it while ranks wait for each other. Collective.
Elsewhere agree_on_exceptions(const MpiSession& mpi, const std::exception_ptr& raised);

/// Runs `work`, which must not communicate. Returns the exception it throws, or null. Requires the GIL.
template <class Work>
std::exception_ptr caught(const Work& work) {
  try {
    work();
  } catch (...) {
    return std::current_exception();
  }
  return nullptr;
}

}  // namespace kacanov::python
