// SPDX-License-Identifier: BSD-3-Clause
// signal() of this program for the libraries it loads: it replaces no handler
// of catch_signals().
//
// METIS sets a handler of SIGTERM while it works and makes a failure of its own of the signal; a thread that
// METIS does not know cannot run that handler. Linked into the program alone, never into a library.
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

/// What signal() is to sources compiled for POSIX alone, as those of METIS.
sighandler_t __sysv_signal(int number, sighandler_t handler) noexcept {
  return set_unless_caught(number, handler, static_cast<int>(SA_RESETHAND | SA_NODEFER));
}
}
