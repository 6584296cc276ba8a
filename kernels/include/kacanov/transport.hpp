// SPDX-License-Identifier: BSD-3-Clause
// What carries messages between processes: an interface, so that who computes with several need not know MPI.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace kacanov {

/// Messages under way between pairs of ranks: arrays of entries of `width` = 4 or 8 bytes. Messages between
/// two ranks arrive in the order they were sent. The arrays have to stay until wait() is over.
class Messages {
 public:
  virtual ~Messages() = default;
  virtual void receive(void* to, std::size_t count, std::size_t width, int rank) = 0;
  virtual void send(const void* from, std::size_t count, std::size_t width, int rank) = 0;
  /// Until all that was started is done.
  virtual void wait() = 0;
};

/// Every function is collective and gives every rank the same bits.
class Transport {
 public:
  virtual ~Transport() = default;
  /// Entry by entry, over all ranks.
  virtual void sum(std::span<double> values) const = 0;
  virtual void sum(std::span<std::int64_t> values) const = 0;
  virtual void max(std::span<double> values) const = 0;
  /// Sum over the ranks below this one; on rank 0 zero.
  virtual std::int64_t sum_below(std::int64_t value) const = 0;
  /// What each rank has, on all of them: an entry a rank.
  virtual std::vector<std::int64_t> all(std::int64_t value) const = 0;
  /// An entry to each rank in exchange for one from each.
  virtual std::vector<int> exchange(std::span<const int> to) const = 0;

  /// Entries of `width` bytes that lie one rank's after the other's, `count` of each rank.
  struct Pieces {
    std::span<const int> count;
    std::size_t width = 1;
  };
  /// Pieces `out` of `from` to the ranks, theirs as pieces `in` into `to`; of one width.
  virtual void exchange(const void* from, const Pieces& out, void* to, const Pieces& in) const = 0;
  /// `from`, which has this rank's count, and what the others have, as pieces `in` into `to`.
  virtual void gather(const void* from, void* to, const Pieces& in) const = 0;
  virtual std::unique_ptr<Messages> messages() const = 0;
};

}  // namespace kacanov
