// SPDX-License-Identifier: BSD-3-Clause
// What ranks that solve a case together tell each other of exceptions, so that none waits for one that has
// left.
#pragma once

#include <pybind11/pybind11.h>

#include <exception>
#include <string>

#include "program/parallel.hpp"

namespace kacanov::python {

/// The first of the ranks that have raised something; those that Ctrl-C has come to count before others.
struct Elsewhere {
  int rank = -1;           ///< none where negative
  bool interrupt = false;  ///< a KeyboardInterrupt
  std::string text;        ///< type and message
};

/// Whose exceptions are to be known: `raised` is this rank's, or null. Collective; with Python's lock, which
/// is let go while ranks wait for each other.
Elsewhere agree_on_exceptions(const MpiSession& mpi, const std::exception_ptr& raised);

/// Does `work`, which must not communicate. Returns what it throws, or null. With Python's lock.
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
