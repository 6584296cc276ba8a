// SPDX-License-Identifier: BSD-3-Clause
// A library to be preloaded into the program: starts a thread before main(), as
// OpenBLAS does. Such a thread blocks no signal, and the system may hand it any.
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
