// SPDX-License-Identifier: BSD-3-Clause
// Sparsity pattern of a distributed matrix assembled from dense element matrices.
#include "multigrid/sparsity_pattern.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "operator/threads.hpp"
#include "parallel/exchange.hpp"

namespace kacanov {
namespace {

/// Concatenated lists.
struct Lists {
  std::vector<std::int64_t> start;
  std::vector<std::int32_t> entry;
  std::span<const std::int32_t> of(std::size_t i) const {
    return std::span(entry).subspan(start[i], start[i + 1] - start[i]);
  }
};

/// Transposes lists 0 … n − 1 with entries list(i): for each of 0 … count − 1 the lists that contain it.
template <class List>
Lists turned(std::size_t n, std::size_t count, const List& list) {
  Lists result;
  result.start.assign(count + 1, 0);
  for (std::size_t i = 0; i < n; ++i)
    for (const std::int32_t k : list(i)) ++result.start[static_cast<std::size_t>(k) + 1];
  std::partial_sum(result.start.begin(), result.start.end(), result.start.begin());
  std::vector<std::int64_t> next(result.start.begin(), result.start.end() - 1);
  result.entry.resize(result.start.back());
  for (std::size_t i = 0; i < n; ++i)
    for (const std::int32_t k : list(i)) result.entry[next[k]++] = static_cast<std::int32_t>(i);
  return result;
}

/// The numbers outside [begin, end), ascending and unique.
std::vector<std::int64_t> not_in(std::vector<std::int64_t> numbers, std::int64_t begin, std::int64_t end) {
  std::erase_if(numbers, [&](std::int64_t n) { return n >= begin && n < end; });
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

/// Numbers of the indices that element matrices use.
std::vector<std::int64_t> used_numbers(const MatrixSide& side) {
  std::vector<char> used(side.number.size(), 0);
  for (const std::int32_t i : side.index) used[i] = 1;
  std::vector<std::int64_t> numbers;
  for (std::size_t i = 0; i < used.size(); ++i)
    if (used[i] != 0) numbers.push_back(side.number[i]);
  return numbers;
}

/// Computes the columns of rows.
struct RowCollector {
  const Lists& matrices;  ///< per row
  const Lists& more;      ///< columns from other ranks, per row
  std::span<const std::size_t> first;
  std::span<const std::int32_t> index, column;

  /// Calls `call` once for each column of a row, in any order; `seen`: last row that had the column.
  template <class Visit>
  void visit(std::size_t row, std::vector<std::int32_t>& seen, const Visit& call) const {
    const auto mark = static_cast<std::int32_t>(row);
    const auto once = [&](std::int32_t c) {
      if (seen[c] == mark) return;
      seen[c] = mark;
      call(c);
    };
    for (const std::int32_t m : matrices.of(row))
      for (std::size_t k = first[m]; k < first[static_cast<std::size_t>(m) + 1]; ++k) once(column[index[k]]);
    for (const std::int32_t c : more.of(row)) once(c);
  }

  Lists rows(std::size_t begin, std::size_t end, std::size_t columns, int threads) const {
    Lists result;
    result.start.assign(end - begin + 1, 0);
    in_shares(threads, end - begin, [&](std::size_t from, std::size_t to) {
      std::vector<std::int32_t> seen(columns, -1);
      for (std::size_t r = from; r < to; ++r)
        visit(begin + r, seen, [&](std::int32_t) { ++result.start[r + 1]; });
    });
    std::partial_sum(result.start.begin(), result.start.end(), result.start.begin());
    result.entry.resize(result.start.back());
    in_shares(threads, end - begin, [&](std::size_t from, std::size_t to) {
      std::vector<std::int32_t> seen(columns, -1);
      for (std::size_t r = from; r < to; ++r) {
        std::int32_t* at = result.entry.data() + result.start[r];
        visit(begin + r, seen, [&](std::int32_t c) { *at++ = c; });
        std::sort(result.entry.data() + result.start[r], at);
      }
    });
    return result;
  }
};

}  // namespace

SparsityPattern::SparsityPattern(const MatrixSide& rows, const MatrixSide& columns, const Communicator& comm,
                                 int threads)
    : comm_(comm),
      row_begin_(rows.starts[comm.rank]),
      owned_(static_cast<std::size_t>(rows.starts[comm.rank + 1] - row_begin_)) {
  others_ = not_in(used_numbers(rows), row_begin_, rows.starts[comm.rank + 1]);
  for (const std::int64_t n : others_)
    owner_.push_back(
        static_cast<int>(std::upper_bound(rows.starts.begin(), rows.starts.end(), n) - rows.starts.begin()) -
        1);
  const std::int64_t first = columns.starts[comm.rank], end = columns.starts[comm.rank + 1];
  std::vector<std::int64_t> ghosts = not_in(used_numbers(columns), first, end);
  const auto mine = static_cast<std::size_t>(end - first);
  const auto columns_of = [&] {
    std::vector<std::int32_t> all;
    for (const std::int64_t n : columns.number) all.push_back(local(n, first, mine, ghosts));
    return all;
  };
  std::vector<std::int32_t> row_of, column_of = columns_of();
  for (const std::int64_t n : rows.number) row_of.push_back(local(n, row_begin_, owned_, others_));
  std::vector<std::int32_t> touched;
  for (const std::int32_t i : rows.index) touched.push_back(row_of[i]);
  const Lists matrices = turned(rows.first.size() - 1, this->rows(), [&](std::size_t m) {
    return std::span(touched).subspan(rows.first[m], rows.first[m + 1] - rows.first[m]);
  });
  std::vector<std::int32_t>().swap(touched);
  Lists more;
  more.start.assign(this->rows() + 1, 0);
  const RowCollector collector{matrices, more, columns.first, columns.index, column_of};

  // Entries of other ranks' rows, which are sent to their owners.
  struct Place {
    std::int64_t row, column;
  };
  std::vector<Place> told;
  if (comm.ranks > 1) {
    const Lists outside = collector.rows(owned_, this->rows(), mine + ghosts.size(), 1);
    std::vector<std::vector<Place>> to(comm.ranks);
    for (std::size_t r = 0; r < others_.size(); ++r)
      for (const std::int32_t c : outside.of(r)) {
        const std::size_t at = c;
        to[owner_[r]].push_back(
            {others_[r], at < mine ? first + static_cast<std::int64_t>(at) : ghosts[at - mine]});
      }
    told = exchange_all(to, comm).entries;
    for (const Place& place : told) ghosts.push_back(place.column);
    ghosts = not_in(std::move(ghosts), first, end);
    column_of = columns_of();
  }
  columns_ = std::make_unique<const IndexMap>(
      make_index_map(comm, static_cast<std::int32_t>(mine), std::move(ghosts)));
  for (const Place& place : told) ++more.start[static_cast<std::size_t>(place.row - row_begin_) + 1];
  std::partial_sum(more.start.begin(), more.start.end(), more.start.begin());
  std::vector<std::int64_t> next(more.start.begin(), more.start.end() - 1);
  more.entry.resize(told.size());
  for (const Place& place : told) more.entry[next[place.row - row_begin_]++] = column(place.column);
  Lists all = RowCollector{matrices, more, columns.first, columns.index, column_of}.rows(
      0, this->rows(), columns_->size(), threads);
  start_ = std::move(all.start), column_ = std::move(all.entry);
  for (const Place& place : told)
    into_.push_back(static_cast<std::int64_t>(entry(row(place.row), column(place.column))));
}

std::int32_t SparsityPattern::local(std::int64_t number, std::int64_t begin, std::size_t owned,
                                    const std::vector<std::int64_t>& others) {
  if (number >= begin && number < begin + static_cast<std::int64_t>(owned))
    return static_cast<std::int32_t>(number - begin);
  const auto at = std::lower_bound(others.begin(), others.end(), number);
  return static_cast<std::int32_t>(owned) + static_cast<std::int32_t>(at - others.begin());
}

std::size_t SparsityPattern::entry(std::int32_t row, std::int32_t column) const {
  const std::size_t r = row;
  const auto end = column_.begin() + start_[r + 1];
  return static_cast<std::size_t>(std::lower_bound(column_.begin() + start_[r], end, column) -
                                  column_.begin());
}

void SparsityPattern::complete(std::span<float> values, std::size_t width) const {
  if (comm_.ranks == 1) return;
  std::vector<std::vector<float>> to(comm_.ranks);
  for (std::size_t r = 0; r < others_.size(); ++r) {
    const std::size_t at = owned_ + r;
    const auto from = values.subspan(width * static_cast<std::size_t>(start_[at]),
                                     width * static_cast<std::size_t>(start_[at + 1] - start_[at]));
    to[owner_[r]].insert(to[owner_[r]].end(), from.begin(), from.end());
  }
  const std::vector<float> came = exchange_all(to, comm_).entries;
  for (std::size_t k = 0; k < into_.size(); ++k)
    for (std::size_t i = 0; i < width; ++i)
      values[width * static_cast<std::size_t>(into_[k]) + i] += came[width * k + i];
}

std::size_t SparsityPattern::bytes() const noexcept {
  const auto size = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return size(others_) + size(owner_) + size(start_) + size(column_) + size(into_);
}

}  // namespace kacanov
