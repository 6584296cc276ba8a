// SPDX-License-Identifier: BSD-3-Clause
// A distributed symmetric block matrix over the rigid motions of aggregates, and its coarsening.
#include "multigrid/aggregation/block_matrix.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "multigrid/aggregation/aggregates.hpp"
#include "multigrid/cycle.hpp"
#include "operator/threads.hpp"
#include "parallel/exchange.hpp"

namespace kacanov {
namespace {

template <int M>
using Dense = Eigen::Matrix<double, M, M, Eigen::RowMajor>;

template <int M>
Dense<M> dense(const typename BlockSums<M>::Block& block) {
  return Eigen::Map<const Dense<M>>(block.data());
}

}  // namespace

template <int M>
BlockMatrix<M>::BlockMatrix(std::vector<Vector3> centres, BlockSums<M> sums, const Communicator& comm,
                            int threads)
    : centres_(std::move(centres)), threads_(threads) {
  IndexMap owned;  // still without ghosts: only the ownership of rows
  static_cast<Communicator&>(owned) = comm;
  owned.owned = rows();
  owned.starts = number_owned(rows(), comm);
  map_ = std::make_unique<IndexMap>(std::move(owned));
  send_to_owners(sums);
  map_ = std::make_unique<IndexMap>(make_index_map(comm, rows(), ghosts_of(sums)));
  fill_.emplace(*map_, M);
  build_rows(sums);
  share_out();
  invert_diagonal();
}

/// Gives the threads rows with equal numbers of blocks.
template <int M>
void BlockMatrix<M>::share_out() {
  constexpr std::size_t worth = 4096;  // blocks
  const std::size_t team = column_.size() < worth ? 1 : threads_, owned = centres_.size();
  std::size_t row = 0;
  for (std::size_t t = 0; t < team; ++t) {
    Share share;
    share.begin = row;
    const std::size_t until = column_.size() * (t + 1) / team;
    while (row < owned && (t + 1 == team || static_cast<std::size_t>(start_[row]) < until)) ++row;
    share.end = share.reach = row;
    for (std::size_t i = share.begin; i < share.end; ++i)
      for (std::size_t k = start_[i]; k < static_cast<std::size_t>(start_[i + 1]); ++k)
        if (const std::size_t j = column_[k]; j < owned) share.reach = std::max(share.reach, j + 1);
    share.beyond.resize((share.reach - share.end) * M);
    shares_.push_back(std::move(share));
  }
}

template <int M>
std::size_t BlockMatrix<M>::bytes() const noexcept {
  std::size_t sum = centres_.size() * sizeof(Vector3) +
                    (start_.size() + column_.size()) * sizeof(std::int32_t) +
                    (block_.size() + inverse_diagonal_.size()) * sizeof(Block);
  for (const Share& share : shares_) sum += share.beyond.size() * sizeof(double);
  return sum;
}

template <int M>
void BlockMatrix<M>::send_to_owners(BlockSums<M>& sums) const {
  if (map_->ranks == 1) return;
  for (const auto& entry : exchanged(sums)) {
    auto& sum = sums.at(entry.row, entry.column);
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += entry.block[k];
  }
}

/// Exchanges contributions to rows of other ranks; returns those to this rank's rows.
template <int M>
std::vector<typename BlockSums<M>::Entry> BlockMatrix<M>::exchanged(const BlockSums<M>& sums) const {
  std::vector<std::vector<typename BlockSums<M>::Entry>> to(map_->ranks);
  for (const auto& entry : sums.entries()) {
    const int row = map_->owner(entry.row), column = map_->owner(entry.column);
    if (row != map_->rank) to[row].push_back(entry);
    if (column != map_->rank && column != row) to[column].push_back(entry);
  }
  return exchange_all(to, *map_).entries;
}

template <int M>
std::int32_t BlockMatrix<M>::local(std::int64_t row) const {
  if (is_mine(row)) return static_cast<std::int32_t>(row - first());
  const auto& ghosts = map_->ghosts;
  const auto at = std::lower_bound(ghosts.begin(), ghosts.end(), row);
  return at != ghosts.end() && *at == row ? rows() + static_cast<std::int32_t>(at - ghosts.begin()) : -1;
}

template <int M>
void BlockMatrix<M>::clear() {
  for (Block& block : block_) block.fill(0.0);
}

template <int M>
typename BlockMatrix<M>::Block& BlockMatrix<M>::block(std::int32_t row, std::int32_t column) {
  std::size_t k = start_[row];
  while (column_[k] != column) ++k;
  return block_[k];
}

template <int M>
void BlockMatrix<M>::complete(BlockSums<M> outside) {
  if (map_->ranks > 1) {
    visit([&](std::int32_t i, std::int32_t j, const Block& sum) {
      if (j < rows()) return;
      const std::int64_t row = first() + i, column = map_->number(j);
      if (row < column)
        outside.at(row, column) = sum;
      else
        outside.at(column, row) = transposed<M>(sum);
    });
    for (const auto& entry : exchanged(outside)) add_to_rows(entry);
  }
  invert_diagonal();
}

template <int M>
void BlockMatrix<M>::add(const BlockSums<M>& sums) {
  for (const auto& entry : sums.entries())
    if (is_mine(entry.row) || is_mine(entry.column)) add_to_rows(entry);
  if (map_->ranks > 1)
    for (const auto& entry : exchanged(sums)) add_to_rows(entry);
  invert_diagonal();
}

/// Adds an entry whose row or column is on this rank.
template <int M>
void BlockMatrix<M>::add_to_rows(const typename BlockSums<M>::Entry& entry) {
  const std::int32_t row = local(entry.row), column = local(entry.column);
  const bool here = row >= 0 && row < rows();
  Block& sum = here ? block(row, column) : block(column, row);
  const Block add = here ? entry.block : transposed<M>(entry.block);
  for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += add[k];
}

/// Rows of other ranks that owned rows couple to.
template <int M>
std::vector<std::int64_t> BlockMatrix<M>::ghosts_of(const BlockSums<M>& sums) const {
  std::vector<std::int64_t> ghosts;
  for (const auto& entry : sums.entries()) {
    const bool row = is_mine(entry.row), column = is_mine(entry.column);
    if (row && !column) ghosts.push_back(entry.column);
    if (!row && column) ghosts.push_back(entry.row);
  }
  std::sort(ghosts.begin(), ghosts.end());
  ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());
  ghosts.shrink_to_fit();
  return ghosts;
}

template <int M>
void BlockMatrix<M>::build_rows(const BlockSums<M>& sums) {
  const std::int64_t begin = first();
  start_.assign(static_cast<std::size_t>(rows()) + 1, 0);
  for (const auto& entry : sums.entries()) {
    const bool row = is_mine(entry.row), column = is_mine(entry.column);
    if (row || column) ++start_[static_cast<std::size_t>((row ? entry.row : entry.column) - begin) + 1];
  }
  std::partial_sum(start_.begin(), start_.end(), start_.begin());

  column_.resize(start_.back());
  block_.resize(column_.size());
  auto next = start_;
  for (const bool ghosts : {false, true}) {
    for (const auto& entry : sums.entries()) {
      const bool row = is_mine(entry.row), column = is_mine(entry.column);
      if (row == column ? !row || ghosts : !ghosts) continue;
      const std::size_t k = next[(row ? entry.row : entry.column) - begin]++;
      column_[k] = local(row ? entry.column : entry.row);
      block_[k] = row ? entry.block : transposed<M>(entry.block);
    }
    for (std::int32_t i = 0; i < rows() && !ghosts; ++i)
      if (const std::size_t at = i; next[at] < start_[at + 1]) edge_.push_back({i, next[at]});
  }
}

template <int M>
void BlockMatrix<M>::invert_diagonal() {
  inverse_diagonal_.resize(centres_.size());
  in_shares(shares_.size() > 1 ? threads_ : 1, centres_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Dense<M> d = Dense<M>::Zero();
      for (auto k = start_[i]; k < start_[i + 1]; ++k)
        if (column_[k] == static_cast<std::int32_t>(i)) d = dense<M>(block_[k]);
      // Motions that boundary conditions leave without a node have no stiffness and get no displacement.
      const double largest = d.diagonal().maxCoeff();
      Eigen::SelfAdjointEigenSolver<Dense<M>> solver(d);
      Dense<M> inverse = Dense<M>::Zero();
      for (int k = 0; k < M; ++k) {
        const double value = solver.eigenvalues()[k];
        if (value > 1e-6 * largest)
          inverse += solver.eigenvectors().col(k) * solver.eigenvectors().col(k).transpose() / value;
      }
      for (int k = 0; k < M * M; ++k) inverse_diagonal_[i][k] = inverse.data()[k];
    }
  });
}

namespace {

/// y += B x.
template <int M>
inline void add_product(const double* block, const double* x, double* y) {
  for (int i = 0; i < M; ++i) {
    double sum = 0.0;
    for (int j = 0; j < M; ++j) sum += block[i * M + j] * x[j];
    y[i] += sum;
  }
}

/// y += Bᵀ x.
template <int M>
inline void add_transposed(const double* block, const double* x, double* y) {
  for (int i = 0; i < M; ++i)
    for (int j = 0; j < M; ++j) y[j] += block[i * M + j] * x[i];
}

}  // namespace

/// y on the thread's rows, without the contributions of earlier threads and of ghosts.
template <int M>
void BlockMatrix<M>::multiply_share(int t, std::span<const double> x, std::span<double> y) {
  Share& mine = shares_[t];
  std::fill(y.begin() + static_cast<std::ptrdiff_t>(mine.begin * M),
            y.begin() + static_cast<std::ptrdiff_t>(mine.end * M), 0.0);
  std::fill(mine.beyond.begin(), mine.beyond.end(), 0.0);
  const std::size_t owned = centres_.size();
  for (std::size_t i = mine.begin; i < mine.end; ++i) {
    std::array<double, M> sum{};
    const double* here = x.data() + i * M;
    for (std::size_t k = start_[i]; k < static_cast<std::size_t>(start_[i + 1]); ++k) {
      const std::size_t j = column_[k];
      if (j >= owned) break;
      add_product<M>(block_[k].data(), x.data() + j * M, sum.data());
      double* to = j < mine.end ? y.data() + j * M : mine.beyond.data() + (j - mine.end) * M;
      if (j != i) add_transposed<M>(block_[k].data(), here, to);
    }
    for (std::size_t m = 0; m < M; ++m) y[i * M + m] += sum[m];
  }
}

template <int M>
void BlockMatrix<M>::multiply(std::span<double> x, std::span<double> y) {
  fill_->start_forward(x);
  const auto team = static_cast<int>(shares_.size());
  in_team(team, [&](int t) { multiply_share(t, x, y); });
  for (const Share& share : shares_)
    for (std::size_t i = 0; i < share.beyond.size(); ++i) y[share.end * M + i] += share.beyond[i];
  fill_->finish_forward(x);
  for (const Edge& edge : edge_) {
    const std::size_t i = edge.row;
    for (std::size_t k = edge.first; k < static_cast<std::size_t>(start_[i + 1]); ++k)
      add_product<M>(block_[k].data(), x.data() + static_cast<std::size_t>(column_[k]) * M, y.data() + i * M);
  }
}

template <int M>
void BlockMatrix<M>::relax(const ChebyshevStep<double>& weights, std::span<const double> b,
                           std::span<const double> image, std::span<double> step, std::span<double> x) const {
  weights.visit([&]<bool zero, bool first>() {
    in_shares(shares_.size() > 1 ? threads_ : 1, centres_.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        std::array<double, M> residual, scaled{};
        for (std::size_t m = 0; m < M; ++m)
          residual[m] = zero ? b[i * M + m] : b[i * M + m] - image[i * M + m];
        add_product<M>(inverse_diagonal_[i].data(), residual.data(), scaled.data());
        for (std::size_t m = 0; m < M; ++m)
          weights.template take<zero, first>(scaled[m], step[i * M + m], x[i * M + m]);
      }
    });
  });
}

template <int M>
double BlockMatrix<M>::largest_eigenvalue() {
  std::vector<double> start = scattered<double>(*map_, M);
  return kacanov::largest_eigenvalue(
      start, [this](std::span<double> x, std::span<double> y) { multiply(x, y); },
      [&](std::span<const double> x, std::span<double> y) {
        relax({0.0, 1.0, true, true}, x, x, y, y);
      },
      [this](const std::vector<double>& x, const std::vector<double>& y) {
        double sum = 0.0;
        for (std::size_t i = 0; i < owned_size(); ++i) sum += x[i] * y[i];
        return map_->sum_all(sum);
      });
}

template <int M>
std::vector<typename BlockSums<M>::Entry> BlockMatrix<M>::gathered() const {
  std::vector<typename BlockSums<M>::Entry> mine;
  visit_rows([&](std::int64_t row, std::int64_t column, const Block& block) {
    mine.push_back({row, column, block});
  });
  return kacanov::gathered(mine, *map_);
}

template class BlockMatrix<3>;
template class BlockMatrix<6>;

namespace {

/// Maps coefficients of a group's motion to those of an aggregate in it.
template <int M>
Dense<M> prolongation(const double* offset, double inverse_length) {
  Dense<M> p;
  for (int k = 0; k < M; ++k) {
    std::array<double, M> group{}, member{};
    group[k] = 1.0;
    RigidMotion<M>::add_to_part(group.data(), offset, inverse_length, member.data());
    p.col(k) = Eigen::Map<const Eigen::Matrix<double, M, 1>>(member.data());
  }
  return p;
}

}  // namespace

template <int M>
BlockMatrix<M> BlockMatrix<M>::coarsened(std::span<const std::int32_t> group, double length) const {
  const double inverse_length = 1.0 / length;
  const std::int32_t groups = group.empty() ? 0 : 1 + *std::max_element(group.begin(), group.end());
  std::vector<Vector3> centre(groups, Vector3{});
  std::vector<double> members(centre.size(), 0.0);
  for (std::size_t i = 0; i < group.size(); ++i) {
    const std::size_t to = group[i];
    members[to] += 1.0;
    for (std::size_t c = 0; c < 3; ++c) centre[to][c] += centres_[i][c];
  }
  for (std::size_t i = 0; i < centre.size(); ++i)
    for (double& c : centre[i]) c /= members[i];

  // For every row, ghosts included: global number of its group, and its position in the group.
  const std::int64_t first_group = map_->sum_below(groups);
  std::vector<std::int64_t> group_of(map_->size());
  std::vector<double> offset(3 * map_->size());
  for (std::size_t i = 0; i < group.size(); ++i) {
    group_of[i] = first_group + group[i];
    for (std::size_t k = 0; k < 3; ++k) offset[3 * i + k] = centres_[i][k] - centre[group[i]][k];
  }
  map_->forward(group_of, 1);
  map_->forward(offset, 3);

  BlockSums<M> sums;
  for (std::size_t i = 0; i < centres_.size(); ++i) {
    const Dense<M> row = prolongation<M>(&offset[3 * i], inverse_length).transpose();
    for (std::size_t k = start_[i]; k < static_cast<std::size_t>(start_[i + 1]); ++k) {
      const std::size_t j = column_[k];
      const std::int64_t here = group_of[i], other = group_of[j];
      const bool with_transpose = j != i && j < centres_.size();
      const Dense<M> product = row * dense<M>(block_[k]) * prolongation<M>(&offset[3 * j], inverse_length);
      if (here <= other) {  // otherwise the owner of the column's row has it
        auto& sum = sums.at(here, other);
        for (std::size_t e = 0; e < sum.size(); ++e) sum[e] += product.data()[e];
      }
      if (with_transpose && other <= here) {
        const Dense<M> transpose = product.transpose();
        auto& sum = sums.at(other, here);
        for (std::size_t e = 0; e < sum.size(); ++e) sum[e] += transpose.data()[e];
      }
    }
  }
  return BlockMatrix(std::move(centre), std::move(sums), *map_, threads_);
}

template <int M>
WeightedGraph BlockMatrix<M>::couplings() const {
  constexpr int dim = RigidMotion<M>::dim;
  const auto visit_edges = [this](auto&& edge) {
    visit([&](std::int32_t i, std::int32_t j, const Block& block) {
      if (j != i && j < rows()) edge(i, j, block);
    });
  };
  WeightedGraph graph;
  graph.start.assign(static_cast<std::size_t>(rows()) + 1, 0);
  visit_edges([&](std::int32_t i, std::int32_t j, const Block&) {
    ++graph.start[static_cast<std::size_t>(i) + 1];
    ++graph.start[static_cast<std::size_t>(j) + 1];
  });
  std::partial_sum(graph.start.begin(), graph.start.end(), graph.start.begin());
  graph.column.resize(graph.start.back());
  graph.weight.resize(graph.column.size());
  auto next = graph.start;
  visit_edges([&](std::int32_t i, std::int32_t j, const Block& block) {
    double square = 0.0;
    for (int a = 0; a < dim; ++a)
      for (int b = 0; b < dim; ++b) {
        const double v = block[a * M + b];
        square += v * v;
      }
    for (const auto& [from, to] : {std::pair{i, j}, std::pair{j, i}}) {
      const std::size_t at = next[from]++;
      graph.column[at] = to;
      graph.weight[at] = static_cast<float>(std::sqrt(square));
    }
  });
  return graph;
}

template BlockMatrix<3> BlockMatrix<3>::coarsened(std::span<const std::int32_t>, double) const;
template BlockMatrix<6> BlockMatrix<6>::coarsened(std::span<const std::int32_t>, double) const;
template WeightedGraph BlockMatrix<3>::couplings() const;
template WeightedGraph BlockMatrix<6>::couplings() const;

}  // namespace kacanov
