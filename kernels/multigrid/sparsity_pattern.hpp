// SPDX-License-Identifier: BSD-3-Clause
// Sparsity pattern of a distributed matrix assembled from dense element matrices.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <kacanov/index_map.hpp>

namespace kacanov {

/// The rows, or the columns, of element matrices: indices into a list of global numbers.
struct MatrixSide {
  std::span<const std::int64_t> starts;  ///< ranks + 1 entries: the first number of each rank, and the total
  std::span<const std::int64_t> number;  ///< global number per index
  std::span<const std::int32_t> index;   ///< matrix by matrix, without repetition in a matrix
  std::span<const std::size_t> first;    ///< matrices + 1 entries: start of each matrix
};

/// Complete rows, computed once: this rank's, then those of other ranks to which element matrices here
/// contribute, ascending. Columns are numbered the same way and ascend in each row.
class SparsityPattern {
 public:
  /// The arguments need not outlive it. Collective.
  SparsityPattern(const MatrixSide& rows, const MatrixSide& columns, const Communicator& comm, int threads);

  std::size_t owned_rows() const noexcept { return owned_; }
  std::size_t rows() const noexcept { return owned_ + others_.size(); }
  /// Global number of a local row.
  std::int64_t number(std::size_t row) const {
    return row < owned_ ? row_begin_ + static_cast<std::int64_t>(row) : others_[row - owned_];
  }
  /// Index map of vectors that the matrix multiplies.
  const IndexMap& columns() const noexcept { return *columns_; }
  /// Local row and column of a global number in the element matrices here.
  std::int32_t row(std::int64_t number) const { return local(number, row_begin_, owned_, others_); }
  std::int32_t column(std::int64_t number) const {
    return local(number, columns_->first(), static_cast<std::size_t>(columns_->owned), columns_->ghosts);
  }

  std::span<const std::int64_t> start() const noexcept { return start_; }  ///< size rows + 1
  std::span<const std::int32_t> column() const noexcept { return column_; }
  std::size_t entries() const noexcept { return column_.size(); }
  /// Moves out the columns of all rows.
  std::vector<std::int32_t> take_columns() && noexcept { return std::move(column_); }
  /// Position of an existing column in the row.
  std::size_t entry(std::int32_t row, std::int32_t column) const;

  /// Adds to this rank's rows the sums of the other ranks for them: `width` values per entry. Collective.
  void complete(std::span<float> values, std::size_t width) const;
  /// The entries that complete() may change.
  std::span<const std::int64_t> added() const noexcept { return into_; }
  std::size_t bytes() const noexcept;

 private:
  static std::int32_t local(std::int64_t number, std::int64_t begin, std::size_t owned,
                            const std::vector<std::int64_t>& others);
  Communicator comm_;
  std::int64_t row_begin_;
  std::size_t owned_;
  std::vector<std::int64_t> others_;  ///< global numbers of other ranks' rows
  std::vector<int> owner_;            ///< their owners
  std::unique_ptr<const IndexMap> columns_;
  std::vector<std::int64_t> start_;
  std::vector<std::int32_t> column_;
  std::vector<std::int64_t> into_;  ///< entries to which other ranks contribute, in message order
};

}  // namespace kacanov
