// SPDX-License-Identifier: BSD-3-Clause
// Hardware counters of this process and the threads and processes that it starts, where the kernel supports
// them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kacanov::perf {

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

}  // namespace kacanov::perf
