// SPDX-License-Identifier: BSD-3-Clause
// The ranks that work together, and reductions over them.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>

#include <kacanov/transport.hpp>

namespace kacanov {

/// Every function is collective and gives every rank the same bits. With one rank they return at once.
struct Communicator {
  std::shared_ptr<const Transport> transport;  ///< null: this process is alone
  int rank = 0, ranks = 1;

  double sum_all(double value) const;
  std::int64_t sum_all(std::int64_t value) const;
  /// Entry by entry.
  void sum_all(std::span<double> values) const;
  /// Each of some numbers that lie apart, in one message.
  void sum_each(std::initializer_list<double*> numbers) const;
  double max_all(double value) const;
  /// Entry by entry.
  void max_all(std::span<double> values) const;
  /// Whether it holds on some rank.
  bool any(bool here) const { return max_all(here ? 1.0 : 0.0) > 0.0; }
  /// Sum over the ranks below this one.
  std::int64_t sum_below(std::int64_t value) const;
};

}  // namespace kacanov
