// SPDX-License-Identifier: BSD-3-Clause
// All-to-all exchange of entries between ranks.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include <kacanov/communicator.hpp>
#include <kacanov/error.hpp>

namespace kacanov {

/// Received entries, in the order of the ranks.
template <class T>
struct Received {
  std::vector<T> entries;
  std::vector<int> starts;  ///< size ranks + 1
  std::span<const T> from(std::size_t rank) const {
    return std::span(entries).subspan(starts[rank], starts[rank + 1] - starts[rank]);
  }
};

/// Sends to[r] to rank r; T: plain structs and numbers. Collective.
template <class T>
Received<T> exchange_all(const std::vector<std::vector<T>>& to, const Communicator& comm,
                         CallSite at = CallSite()) {
  static_assert(std::is_trivially_copyable_v<T>);
  comm.expect_all_here(at);
  if (comm.ranks == 1) return {to[0], {0, static_cast<int>(to[0].size())}};
  std::vector<int> out;
  std::vector<T> sent;
  for (const std::vector<T>& entries : to) {
    out.push_back(static_cast<int>(entries.size()));
    sent.insert(sent.end(), entries.begin(), entries.end());
  }
  const std::vector<int> in = comm.transport->exchange(out);
  Received<T> received;
  received.starts.assign(in.size() + 1, 0);
  std::partial_sum(in.begin(), in.end(), received.starts.begin() + 1);
  received.entries.resize(received.starts.back());
  comm.transport->exchange(sent.data(), {out, sizeof(T)}, received.entries.data(), {in, sizeof(T)});
  return received;
}

/// Returns the entries of all ranks on every rank, in rank order. Collective.
template <class T>
std::vector<T> gathered(const std::vector<T>& mine, const Communicator& comm, CallSite at = CallSite()) {
  static_assert(std::is_trivially_copyable_v<T>);
  comm.expect_all_here(at);
  if (comm.ranks == 1) return mine;
  std::vector<int> count;
  std::size_t total = 0;
  for (const std::int64_t entries : comm.transport->all(static_cast<std::int64_t>(mine.size()))) {
    count.push_back(static_cast<int>(entries));
    total += entries;
  }
  std::vector<T> all(total);
  comm.transport->gather(mine.data(), all.data(), {count, sizeof(T)});
  return all;
}

/// Throws InputError on all ranks if any rank has a text: that of the first such rank. Collective.
inline void refuse_together(const std::string& text, const Communicator& comm, CallSite at = CallSite()) {
  if (!comm.any(!text.empty(), at)) return;
  const auto length = static_cast<std::int64_t>(text.size());
  const std::vector<std::int64_t> lengths = gathered(std::vector<std::int64_t>{length}, comm, at);
  const std::vector<char> all = gathered(std::vector<char>(text.begin(), text.end()), comm, at);
  const auto first = std::find_if(lengths.begin(), lengths.end(), [](std::int64_t l) { return l > 0; });
  throw InputError(std::string(all.data(), static_cast<std::size_t>(*first)));
}

}  // namespace kacanov
