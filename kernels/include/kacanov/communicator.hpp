// SPDX-License-Identifier: BSD-3-Clause
// The communicator: the ranks that work together, and reductions over them.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>

#include <kacanov/transport.hpp>

namespace kacanov {

/// Source location of a call to a collective function: the default of that function's last argument. Builds
/// with KACANOV_CHECK_COLLECTIVES compare it over the ranks; in other builds it is empty.
struct CallSite {
#ifdef KACANOV_CHECK_COLLECTIVES
  explicit constexpr CallSite(const char* in_file = __builtin_FILE(), int at_line = __builtin_LINE(),
                              const char* in_function = __builtin_FUNCTION())
      : file(in_file), function(in_function), line(at_line) {}
  const char *file, *function;
  int line;
#endif
};

/// Every function is collective and returns the same bits on every rank. With one rank each returns at once.
struct Communicator {
  std::shared_ptr<const Transport> transport;  ///< null: there is only this process
  int rank = 0, ranks = 1;

  double sum_all(double value, CallSite at = CallSite()) const;
  std::int64_t sum_all(std::int64_t value, CallSite at = CallSite()) const;
  /// Element-wise.
  void sum_all(std::span<double> values, CallSite at = CallSite()) const;
  /// Sums each of these separate numbers over the ranks, in one message.
  void sum_each(std::initializer_list<double*> numbers, CallSite at = CallSite()) const;
  double max_all(double value, CallSite at = CallSite()) const;
  /// Element-wise.
  void max_all(std::span<double> values, CallSite at = CallSite()) const;
  /// Returns true if `here` is true on at least one rank.
  bool any(bool here, CallSite at = CallSite()) const { return max_all(here ? 1.0 : 0.0, at) > 0.0; }
  /// Returns the sum over the ranks below this one.
  std::int64_t sum_below(std::int64_t value, CallSite at = CallSite()) const;

  /// Called before every collective operation: by each function above, and by hand before MPI or hypre calls.
  /// With KACANOV_CHECK_COLLECTIVES it throws std::logic_error on all ranks, with the source locations,
  /// unless all ranks call it from the same place with the same number of entries; otherwise it does nothing.
#ifdef KACANOV_CHECK_COLLECTIVES
  void expect_all_here(CallSite at = CallSite(), std::int64_t entries = 0) const;
#else
  void expect_all_here(CallSite = CallSite(), std::int64_t = 0) const noexcept {}
#endif
};

}  // namespace kacanov
