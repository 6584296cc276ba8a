// SPDX-License-Identifier: BSD-3-Clause
// A library to be preloaded into the program: starts a thread before main(), as OpenBLAS does. This thread
// blocks no signal, so the system may deliver any signal to it.
#include <unistd.h>

#include <thread>

namespace {

struct EarlyThread {
  EarlyThread() {
    std::thread([] {
      while (true) pause();
    }).detach();
  }
} early_thread;

}  // namespace
