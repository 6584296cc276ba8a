// SPDX-License-Identifier: BSD-3-Clause
// Which entries a sparse matrix has that is summed of small full ones, its rows spread over the ranks.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <kacanov/index_map.hpp>

namespace kacanov {

/// The rows, or the columns, of small matrices: by indices into a list of numbers over all ranks.
struct MatrixSide {
  std::span<const std::int64_t> starts;  ///< ranks + 1: the first number of each rank, and their number
  std::span<const std::int64_t> number;  ///< of an index
  std::span<const std::int32_t> index;   ///< matrix by matrix, none twice in one
  std::span<const std::size_t> first;    ///< matrices + 1: where each one's begin
};

/// Whole rows, found once: this rank's, then those of other ranks that small matrices here add to, ascending.
/// Columns are numbered likewise. In a row they ascend.
class SummedPattern {
 public:
  /// What is passed may go afterwards. Collective.
  SummedPattern(const MatrixSide& rows, const MatrixSide& columns, const Communicator& comm, int threads);

  std::size_t owned_rows() const noexcept { return owned_; }
  std::size_t rows() const noexcept { return owned_ + others_.size(); }
  /// Of a local row, over all ranks.
  std::int64_t number(std::size_t row) const {
    return row < owned_ ? row_begin_ + static_cast<std::int64_t>(row) : others_[row - owned_];
  }
  /// Of vectors that the matrix multiplies.
  const IndexMap& columns() const noexcept { return *columns_; }
  /// Local row and column of a number that small matrices here have.
  std::int32_t row(std::int64_t number) const { return local(number, row_begin_, owned_, others_); }
  std::int32_t column(std::int64_t number) const {
    return local(number, columns_->first(), static_cast<std::size_t>(columns_->owned), columns_->ghosts);
  }

  std::span<const std::int64_t> start() const noexcept { return start_; }  ///< rows + 1
  std::span<const std::int32_t> column() const noexcept { return column_; }
  std::size_t entries() const noexcept { return column_.size(); }
  /// The columns of all rows, which it has no more.
  std::vector<std::int32_t> take_columns() && noexcept { return std::move(column_); }
  /// Where in the row a column is; it has to be there.
  std::size_t entry(std::int32_t row, std::int32_t column) const;

  /// Adds to this rank's rows what the others have summed in theirs for it: `width` values an entry.
  /// Collective.
  void complete(std::span<float> values, std::size_t width) const;
  /// The entries that complete() may add to.
  std::span<const std::int64_t> added() const noexcept { return into_; }
  std::size_t bytes() const noexcept;

 private:
  static std::int32_t local(std::int64_t number, std::int64_t begin, std::size_t owned,
                            const std::vector<std::int64_t>& others);
  Communicator comm_;
  std::int64_t row_begin_;
  std::size_t owned_;
  std::vector<std::int64_t> others_;  ///< numbers of other ranks' rows
  std::vector<int> owner_;            ///< of these
  std::unique_ptr<const IndexMap> columns_;
  std::vector<std::int64_t> start_;
  std::vector<std::int32_t> column_;
  std::vector<std::int64_t> into_;  ///< the entries that the other ranks add to, in the order they come in
};

}  // namespace kacanov
