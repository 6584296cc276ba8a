// SPDX-License-Identifier: BSD-3-Clause
// MPI within a process that others have started: Python's.
#include "host_mpi.hpp"

#include <Python.h>
#include <unistd.h>

#include <cstdlib>
#include <set>
#include <string>

#include <kacanov/error.hpp>
#include "program/launch.hpp"

namespace kacanov::python {
namespace {

std::set<std::string> variables() {
  std::set<std::string> names;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string text = *entry;
    names.insert(text.substr(0, text.find('=')));
  }
  return names;
}

void finalize() {
  int ended = 0;
  MPI_Finalized(&ended);
  if (ended == 0) MPI_Finalize();
}

}  // namespace

void ensure_mpi() {
  int started = 0, ended = 0;
  MPI_Finalized(&ended);
  if (ended != 0) throw InternalError("MPI has been finalized in this process; a solve needs it");
  MPI_Initialized(&started);
  if (started != 0) return;
  // What MPI and its settings leave there would be taken by the host's children for their own.
  const std::set<std::string> before = variables();
  set_mpi_environment();
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
  for (const std::string& name : variables())
    if (!before.contains(name)) unsetenv(name.c_str());
  // Not by atexit, which comes before what PETSc, started later, does at its end.
  Py_AtExit(&finalize);
}

}  // namespace kacanov::python
