// SPDX-License-Identifier: BSD-3-Clause
// Hardware counters of this process and the threads and processes that it starts, where the kernel supports
// them.
#include "hardware_counters.hpp"

#include <linux/perf_event.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

namespace kacanov::perf {
namespace {

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

}  // namespace

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

}  // namespace kacanov::perf
