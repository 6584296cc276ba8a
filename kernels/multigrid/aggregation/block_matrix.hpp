// SPDX-License-Identifier: BSD-3-Clause
// A distributed symmetric block matrix over the rigid motions of aggregates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include <kacanov/scatterer.hpp>
#include <kacanov/vector3.hpp>
#include "multigrid/cycle.hpp"

namespace kacanov {

/// M = 3 (2D: two translations, a rotation) or 6 (3D) coefficients of a rigid motion u(x) = t + θ × (x −
/// centre) / length.
template <int M>
struct RigidMotion {
  static constexpr int modes = M;
  static constexpr int dim = M == 6 ? 3 : 2;

  /// Displacement at x − centre = d for each motion: the matrix of add_motion.
  using Rows = std::array<std::array<double, static_cast<std::size_t>(M)>, static_cast<std::size_t>(dim)>;
  static Rows rows(const double* d, double inverse_length) {
    const double x = d[0] * inverse_length, y = d[1] * inverse_length;
    if constexpr (M == 6) {
      const double z = d[2] * inverse_length;
      return {{{1, 0, 0, 0, z, -y}, {0, 1, 0, -z, 0, x}, {0, 0, 1, y, -x, 0}}};
    } else {
      return {{{1, 0, -y}, {0, 1, x}}};
    }
  }

  /// u += displacement at x − centre = d of the motion with coefficients q.
  template <class S>
  static void add_motion(const S* q, const double* d, double inverse_length, S* u) {
    if constexpr (M == 6) {
      const S x = static_cast<S>(d[0] * inverse_length), y = static_cast<S>(d[1] * inverse_length),
              z = static_cast<S>(d[2] * inverse_length);
      u[0] += q[0] + q[4] * z - q[5] * y;
      u[1] += q[1] + q[5] * x - q[3] * z;
      u[2] += q[2] + q[3] * y - q[4] * x;
    } else {
      const S x = static_cast<S>(d[0] * inverse_length), y = static_cast<S>(d[1] * inverse_length);
      u[0] += q[0] - q[2] * y;
      u[1] += q[1] + q[2] * x;
    }
  }
  /// q += generalised forces of the force f at x − centre = d: the transpose of add_motion.
  template <class S>
  static void add_force(const S* f, const double* d, double inverse_length, S* q) {
    if constexpr (M == 6) {
      const S x = static_cast<S>(d[0] * inverse_length), y = static_cast<S>(d[1] * inverse_length),
              z = static_cast<S>(d[2] * inverse_length);
      q[0] += f[0];
      q[1] += f[1];
      q[2] += f[2];
      q[3] += f[2] * y - f[1] * z;
      q[4] += f[0] * z - f[2] * x;
      q[5] += f[1] * x - f[0] * y;
    } else {
      const S x = static_cast<S>(d[0] * inverse_length), y = static_cast<S>(d[1] * inverse_length);
      q[0] += f[0];
      q[1] += f[1];
      q[2] += f[1] * x - f[0] * y;
    }
  }

  /// q += coefficients, in a part with its centre at d, of the motion `from` of a larger aggregate.
  template <class S>
  static void add_to_part(const S* from, const double* d, double inverse_length, S* q) {
    add_motion(from, d, inverse_length, q);
    for (int m = dim; m < M; ++m) q[m] += from[m];
  }
  /// The transpose: q += generalised forces on the larger aggregate from those on the part, `f`.
  template <class S>
  static void add_from_part(const S* f, const double* d, double inverse_length, S* q) {
    add_force(f, d, inverse_length, q);
    for (int m = dim; m < M; ++m) q[m] += f[m];
  }
};

/// Sums of blocks (row, column), with global row numbers; only blocks with row ≤ column are stored, the
/// others follow by symmetry.
template <int M>
class BlockSums {
 public:
  using Block = std::array<double, static_cast<std::size_t>(M* M)>;
  struct Entry {
    std::int64_t row = 0, column = 0;
    Block block{};
  };
  /// Reference to the sum at (row, column), initially zero; it remains valid. row ≤ column < 2³².
  Block& at(std::int64_t row, std::int64_t column) {
    const auto key = static_cast<std::uint64_t>(row) << 32 | static_cast<std::uint64_t>(column);
    const auto [place, fresh] = index_.try_emplace(key, static_cast<std::uint32_t>(entries_.size()));
    if (fresh) entries_.push_back({row, column, {}});
    return entries_[place->second].block;
  }
  const std::deque<Entry>& entries() const noexcept { return entries_; }

 private:
  std::unordered_map<std::uint64_t, std::uint32_t> index_;
  std::deque<Entry> entries_;  // never moved: they are most of the memory of a setup
};

template <int M>
typename BlockSums<M>::Block transposed(const typename BlockSums<M>::Block& block) {
  typename BlockSums<M>::Block result;
  for (std::size_t i = 0; i < M; ++i)
    for (std::size_t j = 0; j < M; ++j) result[j * M + i] = block[i * M + j];
  return result;
}

/// A Galerkin matrix over rigid motions, distributed by rows: M × M blocks, symmetric (theory: multigrid).
/// Vectors have M entries per row; those passed to multiply have room for the ghosts behind the owned rows.
/// Double precision is needed: bending of a slender body has 1e-8 of the energy that its entries suggest,
/// which single precision would round away.
template <int M>
class BlockMatrix {
 public:
  using Block = typename BlockSums<M>::Block;

  /// This rank owns rows first … first + rows − 1, the motions of aggregates with these centres. `sums`: its
  /// contributions to any rows, which are sent to their owners. Collective.
  BlockMatrix(std::vector<Vector3> centres, BlockSums<M> sums, const Communicator& comm, int threads = 1);

  std::int32_t rows() const noexcept { return static_cast<std::int32_t>(centres_.size()); }
  /// Index map of the rows; ghosts are the other ranks' rows that owned ones couple to, ascending.
  const IndexMap& map() const noexcept { return *map_; }
  std::int64_t first() const noexcept { return map_->first(); }
  std::int64_t total() const noexcept { return map_->total(); }
  std::span<const Vector3> centres() const noexcept { return centres_; }
  std::size_t size() const noexcept { return map_->size() * M; }  ///< length of a vector
  std::size_t owned_size() const noexcept { return centres_.size() * M; }
  std::size_t bytes() const noexcept;

  /// y = A x on owned rows; fills x's ghosts. Collective.
  void multiply(std::span<double> x, std::span<double> y);
  /// The step of Chebyshev::smooth on owned rows, with D the block diagonal.
  void relax(const ChebyshevStep<double>& weights, std::span<const double> b, std::span<const double> image,
             std::span<double> step, std::span<double> x) const;
  /// Upper estimate of the largest eigenvalue of D⁻¹A (kacanov::largest_eigenvalue). Collective.
  double largest_eigenvalue();

  /// Local number of a row: owned rows first, then rows of other ranks that they couple to; −1 for others.
  std::int32_t local(std::int64_t row) const;
  /// Calls f(row, column, block) for the stored blocks of every owned row.
  template <class F>
  void visit(F&& f) const {
    for (std::int32_t i = 0; i < rows(); ++i)
      for (std::size_t k = start_[i]; k < static_cast<std::size_t>(start_[static_cast<std::size_t>(i) + 1]);
           ++k)
        f(i, column_[k], block_[k]);
  }
  /// Calls f(row, column, block) with global numbers for all blocks of the owned rows.
  template <class F>
  void visit_rows(F&& f) const {
    visit([&](std::int32_t i, std::int32_t j, const Block& here) {
      f(first() + i, map_->number(j), here);
      if (j < rows() && j != i) f(first() + j, first() + i, transposed<M>(here));
    });
  }
  /// To sum the matrix again with the same couplings: clear(), add to block(), complete().
  void clear();
  /// Block of an owned row and a local column, which must couple; column ≥ row if the column is owned.
  Block& block(std::int32_t row, std::int32_t column);
  /// Adds the ranks' contributions to each other's rows: blocks with ghosts, and `outside` for the rest.
  /// Collective.
  void complete(BlockSums<M> outside);
  /// Adds this rank's contributions to any rows that couple. Collective.
  void add(const BlockSums<M>& sums);

  /// The next level. `group`: group of each owned row, numbered from 0; `length` makes rotations comparable
  /// to translations, as on this level. Collective.
  BlockMatrix coarsened(std::span<const std::int32_t> group, double length) const;
  /// Couplings between owned rows, for grouping.
  struct WeightedGraph couplings() const;

  /// The whole matrix on every rank, for a direct solve. Collective.
  std::vector<typename BlockSums<M>::Entry> gathered() const;

 private:
  void send_to_owners(BlockSums<M>& sums) const;
  void add_to_rows(const typename BlockSums<M>::Entry& entry);
  std::vector<typename BlockSums<M>::Entry> exchanged(const BlockSums<M>& sums) const;
  bool is_mine(std::int64_t row) const noexcept { return row >= first() && row < first() + rows(); }
  std::vector<std::int64_t> ghosts_of(const BlockSums<M>& sums) const;
  void build_rows(const BlockSums<M>& sums);
  void invert_diagonal();
  void share_out();
  void multiply_share(int t, std::span<const double> x, std::span<double> y);

  std::unique_ptr<const IndexMap> map_;  ///< at a fixed address when the level moves
  std::vector<Vector3> centres_;
  /// Entries of owned row i: columns i, then later owned rows (stored once), then ghosts.
  std::vector<std::int32_t> start_, column_;
  std::vector<Block> block_, inverse_diagonal_;
  struct Edge {
    std::int32_t row = 0, first = 0;  ///< first entry with a ghost
  };
  std::vector<Edge> edge_;  ///< rows with ghosts
  int threads_ = 1;
  /// A thread's rows, and its sums for rows of later threads that its columns reach.
  struct Share {
    std::size_t begin = 0, end = 0, reach = 0;
    std::vector<double> beyond;
  };
  std::vector<Share> shares_;
  std::optional<Scatterer<double>> fill_;  ///< for the ghosts of a vector
};

extern template class BlockMatrix<3>;
extern template class BlockMatrix<6>;

}  // namespace kacanov
