// SPDX-License-Identifier: BSD-3-Clause
// Replaces signal() for the libraries of this program, so that they keep the handlers of catch_signals().
//
// METIS installs a handler of SIGTERM while it works and treats the signal as a failure of its own; that
// handler cannot run in a thread unknown to METIS. Linked into the program only, never into a library.
#include <csignal>

#include "program/signal_pipe.hpp"

namespace {

sighandler_t set_unless_caught(int signal, sighandler_t handler, int flags) noexcept {
  struct sigaction action {
  }, before{};
  if (sigaction(signal, nullptr, &before) != 0) return SIG_ERR;
  if (kacanov::is_caught(signal)) return before.sa_handler;
  action.sa_handler = handler;
  action.sa_flags = flags;
  return sigaction(signal, &action, nullptr) == 0 ? before.sa_handler : SIG_ERR;
}

}  // namespace

extern "C" {

sighandler_t signal(int number, sighandler_t handler) noexcept {
  return set_unless_caught(number, handler, SA_RESTART);
}

/// The symbol behind signal() in sources compiled for strict POSIX, such as METIS.
sighandler_t __sysv_signal(int number, sighandler_t handler) noexcept {
  return set_unless_caught(number, handler, static_cast<int>(SA_RESETHAND | SA_NODEFER));
}
}
