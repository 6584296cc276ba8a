// SPDX-License-Identifier: BSD-3-Clause
// Runs a command under the hardware counters and writes one line of JSON to standard error when it ends.
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include "hardware_counters.hpp"

int main(int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') {
    std::fputs("usage: count COMMAND [ARGUMENT]...\n", stderr);
    return 2;
  }
  kacanov::perf::HardwareCounters counters;
  counters.start();
  const pid_t child = fork();
  if (child == 0) {
    execvp(argv[1], argv + 1);
    std::fprintf(stderr, "count: %s: %s\n", argv[1], std::strerror(errno));
    _exit(127);
  }
  if (child < 0) {
    std::fprintf(stderr, "count: %s\n", std::strerror(errno));
    return 3;
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  counters.stop();

  if (!counters.available()) {
    std::fprintf(stderr, "%s\n", counters.why().c_str());
  } else {
    std::string line = "{";
    for (const auto& [name, value] : counters.read()) {
      line += (line.size() > 1 ? ", \"" : "\"") + std::string(name) + "\": ";
      line += value ? std::to_string(static_cast<long long>(*value)) : "null";
    }
    std::fprintf(stderr, "%s}\n", line.c_str());
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}
