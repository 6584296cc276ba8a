// SPDX-License-Identifier: BSD-3-Clause
// Runs a command under the hardware counters and writes one line of JSON to standard error when it ends.
#include <linux/perf_event.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace {

/// Counts user-space events by perf_event_open between start() and stop(), in this process and in threads and
/// children created after construction. Virtual machines and containers often have no counters: then
/// available() is false and why() returns one sentence for the user.
class HardwareCounters {
 public:
  HardwareCounters();
  ~HardwareCounters();
  HardwareCounters(const HardwareCounters&) = delete;
  HardwareCounters& operator=(const HardwareCounters&) = delete;

  bool available() const noexcept;
  const std::string& why() const noexcept { return why_; }

  void start();
  void stop();

  struct Count {
    std::string_view name;
    /// Number of events, scaled up if the counter was shared; empty if it is not supported or never ran.
    std::optional<double> value;
  };
  /// Returns "cycles", "instructions", "cache_references", "cache_misses", "branch_misses", in this order.
  std::vector<Count> read() const;

 private:
  struct Event {
    std::string_view name;
    std::uint64_t config;
    int file = -1;
  };
  std::vector<Event> events_;
  std::string why_;
};

int open_event(std::uint64_t config) {
  perf_event_attr attributes{};
  attributes.size = sizeof attributes;
  attributes.type = PERF_TYPE_HARDWARE;
  attributes.config = config;
  attributes.disabled = 1;
  attributes.inherit = 1;
  attributes.exclude_kernel = 1;  // fewer rights needed, and kernel time is not measured
  attributes.exclude_hv = 1;
  attributes.read_format = PERF_FORMAT_TOTAL_TIME_ENABLED | PERF_FORMAT_TOTAL_TIME_RUNNING;
  const long file = syscall(SYS_perf_event_open, &attributes, 0, -1, -1, PERF_FLAG_FD_CLOEXEC);
  return static_cast<int>(file);
}

std::string reason(int error) {
  switch (error) {
    case ENOENT:
    case EOPNOTSUPP:
    case ENODEV: return "hardware counters: this machine offers none (a virtual machine?)";
    case EACCES:
    case EPERM: return "hardware counters: not allowed here (see /proc/sys/kernel/perf_event_paranoid)";
    case ENOSYS: return "hardware counters: this kernel has no perf_event_open";
    default: return std::string("hardware counters: ") + std::strerror(error);
  }
}

HardwareCounters::HardwareCounters()
    : events_{{"cycles", PERF_COUNT_HW_CPU_CYCLES},
              {"instructions", PERF_COUNT_HW_INSTRUCTIONS},
              {"cache_references", PERF_COUNT_HW_CACHE_REFERENCES},
              {"cache_misses", PERF_COUNT_HW_CACHE_MISSES},
              {"branch_misses", PERF_COUNT_HW_BRANCH_MISSES}} {
  for (Event& event : events_) {
    event.file = open_event(event.config);
    if (event.file < 0 && why_.empty()) why_ = reason(errno);
  }
  if (available()) why_.clear();
}

HardwareCounters::~HardwareCounters() {
  for (const Event& event : events_)
    if (event.file >= 0) close(event.file);
}

bool HardwareCounters::available() const noexcept {
  return std::any_of(events_.begin(), events_.end(), [](const Event& event) { return event.file >= 0; });
}

void HardwareCounters::start() {
  for (const Event& event : events_)
    if (event.file >= 0) {
      ioctl(event.file, PERF_EVENT_IOC_RESET, 0);
      ioctl(event.file, PERF_EVENT_IOC_ENABLE, 0);
    }
}

void HardwareCounters::stop() {
  for (const Event& event : events_)
    if (event.file >= 0) ioctl(event.file, PERF_EVENT_IOC_DISABLE, 0);
}

std::vector<HardwareCounters::Count> HardwareCounters::read() const {
  std::vector<Count> counts;
  for (const Event& event : events_) {
    Count count{event.name, std::nullopt};
    struct {
      std::uint64_t value, enabled, running;
    } got{};
    if (event.file >= 0 && ::read(event.file, &got, sizeof got) == sizeof got && got.running > 0)
      count.value = static_cast<double>(got.value) * static_cast<double>(got.enabled) /
                    static_cast<double>(got.running);
    counts.push_back(count);
  }
  return counts;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') {
    std::fputs("usage: count COMMAND [ARGUMENT]...\n", stderr);
    return 2;
  }
  HardwareCounters counters;
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
