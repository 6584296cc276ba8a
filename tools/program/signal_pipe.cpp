// SPDX-License-Identifier: BSD-3-Clause
// Delivers signals of this process as bytes in a pipe (self-pipe).
#include "program/signal_pipe.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <string>

#include <kacanov/error.hpp>

namespace kacanov {
namespace {

std::atomic<int> reading_end = -1, writing_end = -1;
static_assert(std::atomic<int>::is_always_lock_free);  // required in a signal handler

/// If the pipe is full, it already holds thousands of requests, so one more may be lost.
extern "C" void write_to_pipe(int signal) {
  const int error = errno;
  const auto byte = static_cast<unsigned char>(signal);
  [[maybe_unused]] const ssize_t written = write(writing_end, &byte, 1);
  errno = error;
}

/// Ensures that this thread receives the signal, even if the process was started with it blocked or other
/// threads block it.
void unblock(int signal) noexcept {
  sigset_t one;
  sigemptyset(&one);
  sigaddset(&one, signal);
  pthread_sigmask(SIG_UNBLOCK, &one, nullptr);
}

void catch_one(int signal, bool always) {
  struct sigaction before {
  }, action{};
  if (sigaction(signal, nullptr, &before) != 0 || (before.sa_handler == SIG_IGN && !always)) return;
  action.sa_handler = write_to_pipe;
  action.sa_flags = SA_RESTART;
  sigaction(signal, &action, nullptr);
  unblock(signal);
}

}  // namespace

void catch_signals(std::initializer_list<int> signals, std::initializer_list<int> always) {
  if (reading_end < 0) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC | O_NONBLOCK) != 0)
      throw InternalError(std::string("no pipe for signals: ") + std::strerror(errno));
    reading_end = ends[0];
    writing_end = ends[1];
  }
  for (const int signal : signals) catch_one(signal, false);
  for (const int signal : always) catch_one(signal, true);
}

int signal_pipe() noexcept { return reading_end; }

int next_signal(int milliseconds) noexcept {
  pollfd channel{reading_end, POLLIN, 0};
  unsigned char signal = 0;
  do {
    if (poll(&channel, 1, milliseconds) == 0) return 0;
  } while (read(reading_end, &signal, 1) != 1 && milliseconds < 0);
  return signal;
}

bool is_caught(int signal) noexcept {
  struct sigaction now {};
  return sigaction(signal, nullptr, &now) == 0 && now.sa_handler == write_to_pipe;
}

void end_by(int signal) noexcept {
  struct sigaction action {};
  action.sa_handler = SIG_DFL;
  sigaction(signal, &action, nullptr);
  unblock(signal);
  raise(signal);
  _exit(128 + signal);  // reached only by the first process of a container
}

bool asks_again(timespec& first) noexcept {
  if (first.tv_sec != 0 || first.tv_nsec != 0) return seconds_since(first) > 1.0;
  clock_gettime(CLOCK_MONOTONIC, &first);
  return false;
}

double seconds_since(const timespec& then) noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec - then.tv_sec) +
         1e-9 * static_cast<double>(now.tv_nsec - then.tv_nsec);
}

}  // namespace kacanov
