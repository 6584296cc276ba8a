// SPDX-License-Identifier: BSD-3-Clause
// MPI inside a host process, which continues after a solve.
#include "program/host_mpi.hpp"

#include <mpi.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <kacanov/error.hpp>
#include "program/launch.hpp"
#include "program/mpi_folder.hpp"

namespace kacanov {
namespace {

std::set<std::string> variables() {
  std::set<std::string> names;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string text = *entry;
    names.insert(text.substr(0, text.find('=')));
  }
  return names;
}

/// Saves all signal actions and restores them at the end: Open MPI installs handlers that print traces of
/// crashes.
class KeptSignals {
 public:
  KeptSignals() : actions_(static_cast<std::size_t>(SIGRTMAX) + 1) {
    for (int signal = 1; signal <= SIGRTMAX; ++signal) {
      struct sigaction action {};
      if (sigaction(signal, nullptr, &action) == 0) actions_[signal] = action;
    }
  }
  ~KeptSignals() {
    for (int signal = 1; signal <= SIGRTMAX; ++signal) {
      if (!actions_[signal]) continue;
      struct sigaction now {};
      const struct sigaction& before = *actions_[signal];
      if (sigaction(signal, nullptr, &now) == 0 && now.sa_sigaction != before.sa_sigaction)
        sigaction(signal, &before, nullptr);
    }
  }
  KeptSignals(const KeptSignals&) = delete;
  KeptSignals& operator=(const KeptSignals&) = delete;

 private:
  std::vector<std::optional<struct sigaction>> actions_;
};

pid_t started_in = 0;                 // process in which we started MPI; 0: none
MpiFolder* session_folder = nullptr;  // never deleted in a child after fork(), which exits too

}  // namespace

bool start_host_mpi() {
  int started = 0, ended = 0;
  MPI_Finalized(&ended);
  if (ended != 0) throw InternalError("MPI has been finalized in this process; a solve needs it");
  if (started_in != 0 && started_in != getpid())
    throw InternalError("MPI was started before fork(); a child process cannot solve");
  MPI_Initialized(&started);
  if (started != 0) return false;
  // Remove variables set by MPI: children of the host would take them for their own.
  const std::set<std::string> before = variables();
  const KeptSignals signals;
  session_folder = new MpiFolder;
  set_mpi_environment();
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
  for (const std::string& name : variables())
    if (!before.contains(name)) unsetenv(name.c_str());
  started_in = getpid();
  return true;
}

void end_host_mpi() {
  if (started_in != getpid()) return;
  int ended = 0;
  MPI_Finalized(&ended);
  if (ended == 0) MPI_Finalize();
  delete std::exchange(session_folder, nullptr);
}

}  // namespace kacanov
