// SPDX-License-Identifier: BSD-3-Clause
// Interface that carries messages between processes, so that parallel code does not depend on MPI.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace kacanov {

/// Point-to-point messages in flight: arrays of entries of `width` = 4 or 8 bytes. Messages between two ranks
/// arrive in the order in which they were sent. The arrays must stay valid until wait() returns.
class Messages {
 public:
  virtual ~Messages() = default;
  virtual void receive(void* to, std::size_t count, std::size_t width, int rank) = 0;
  virtual void send(const void* from, std::size_t count, std::size_t width, int rank) = 0;
  /// Returns when all started messages have completed.
  virtual void wait() = 0;
};

/// Every function is collective and returns the same bits on every rank.
class Transport {
 public:
  virtual ~Transport() = default;
  /// Element-wise, over all ranks.
  virtual void sum(std::span<double> values) const = 0;
  virtual void sum(std::span<std::int64_t> values) const = 0;
  virtual void max(std::span<double> values) const = 0;
  /// Returns the sum over the ranks below this one; 0 on rank 0.
  virtual std::int64_t sum_below(std::int64_t value) const = 0;
  /// Returns the values of all ranks, one entry per rank.
  virtual std::vector<std::int64_t> all(std::int64_t value) const = 0;
  /// Sends one entry to each rank and returns one from each.
  virtual std::vector<int> exchange(std::span<const int> to) const = 0;

  /// Contiguous pieces of `count` entries of `width` bytes, one piece per rank, in rank order.
  struct Pieces {
    std::span<const int> count;
    std::size_t width = 1;
  };
  /// Sends piece r of `from` (layout `out`) to rank r and receives its piece into `to` (layout `in`), of the
  /// same width.
  virtual void exchange(const void* from, const Pieces& out, void* to, const Pieces& in) const = 0;
  /// Gathers `from`, which has this rank's count of entries, of all ranks into `to` on every rank (layout
  /// `in`).
  virtual void gather(const void* from, void* to, const Pieces& in) const = 0;
  virtual std::unique_ptr<Messages> messages() const = 0;
};

}  // namespace kacanov
