// SPDX-License-Identifier: BSD-3-Clause
// Hardware counters of this process and the threads and processes it starts, where the kernel offers them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kacanov::perf {

/// Counts through perf_event_open, in user space only, what runs between start() and stop(): in this process,
/// and in threads and children made after construction. Virtual machines and containers often offer nothing:
/// then available() is false and why() is one sentence for the user.
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
    /// Events, scaled up where the counter had to be shared; none if this one is not offered or never ran.
    std::optional<double> value;
  };
  /// "cycles", "instructions", "cache_references", "cache_misses", "branch_misses", in this order.
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

}  // namespace kacanov::perf
