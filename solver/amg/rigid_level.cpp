// SPDX-License-Identifier: BSD-3-Clause
// One level of the hierarchy: a symmetric block matrix over the rigid motions of aggregates, its rows spread
// over the ranks.
#include "amg/rigid_level.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "amg/aggregation.hpp"
#include "amg/largest_eigenvalue.hpp"

namespace kacanov {
namespace {

template <int M>
using Dense = Eigen::Matrix<double, M, M, Eigen::RowMajor>;

template <int M>
Dense<M> dense(const typename BlockSums<M>::Block& block) {
  return Eigen::Map<const Dense<M>>(block.data());
}

template <int M>
typename BlockSums<M>::Block transposed(const typename BlockSums<M>::Block& block) {
  typename BlockSums<M>::Block result;
  for (std::size_t i = 0; i < M; ++i)
    for (std::size_t j = 0; j < M; ++j) result[j * M + i] = block[i * M + j];
  return result;
}

/// Takes coefficients of a group's motion to those of an aggregate in it.
template <int M>
Dense<M> prolongation(const Vector3& offset, double inverse_length) {
  Dense<M> p;
  for (int k = 0; k < M; ++k) {
    std::array<double, M> group{}, member{};
    group[static_cast<std::size_t>(k)] = 1.0;
    RigidMotion<M>::add_to_part(group.data(), offset.data(), inverse_length, member.data());
    p.col(k) = Eigen::Map<const Eigen::Matrix<double, M, 1>>(member.data());
  }
  return p;
}

/// Sends each rank its bytes and returns all that came.
template <class T>
std::vector<T> exchange_entries(const std::vector<std::vector<T>>& to, MPI_Comm comm) {
  const std::size_t ranks = to.size();
  std::vector<int> out(ranks), in(ranks), out_at(ranks, 0), in_at(ranks, 0);
  std::vector<T> sent;
  for (std::size_t r = 0; r < ranks; ++r) {
    out[r] = static_cast<int>(to[r].size());
    sent.insert(sent.end(), to[r].begin(), to[r].end());
  }
  MPI_Alltoall(out.data(), 1, MPI_INT, in.data(), 1, MPI_INT, comm);
  std::exclusive_scan(out.begin(), out.end(), out_at.begin(), 0);
  std::exclusive_scan(in.begin(), in.end(), in_at.begin(), 0);
  std::vector<T> received(static_cast<std::size_t>(in_at.back() + in.back()));
  MPI_Datatype type;
  MPI_Type_contiguous(static_cast<int>(sizeof(T)), MPI_BYTE, &type);
  MPI_Type_commit(&type);
  MPI_Alltoallv(sent.data(), out.data(), out_at.data(), type, received.data(), in.data(), in_at.data(), type,
                comm);
  MPI_Type_free(&type);
  return received;
}

}  // namespace

template <int M>
RigidLevel<M>::RigidLevel(std::vector<Vector3> centres, BlockSums<M> sums, MPI_Comm comm)
    : comm_(comm), centres_(std::move(centres)) {
  MPI_Comm_rank(comm, &rank_);
  MPI_Comm_size(comm, &ranks_);
  first_.assign(static_cast<std::size_t>(ranks_) + 1, 0);
  const auto mine = static_cast<std::int64_t>(centres_.size());
  MPI_Allgather(&mine, 1, MPI_INT64_T, first_.data() + 1, 1, MPI_INT64_T, comm);
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  send_to_owners(sums);
  build_rows(sums);
  plan_exchange();
  invert_diagonal();
}

template <int M>
int RigidLevel<M>::owner(std::int64_t row) const {
  return static_cast<int>(std::upper_bound(first_.begin(), first_.end(), row) - first_.begin()) - 1;
}

template <int M>
void RigidLevel<M>::send_to_owners(BlockSums<M>& sums) const {
  if (ranks_ == 1) return;
  for (const auto& entry : exchanged(sums)) {
    auto& sum = sums.at(entry.row, entry.column);
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += entry.block[k];
  }
}

/// What the other ranks have for rows of this one, in exchange for theirs.
template <int M>
std::vector<typename BlockSums<M>::Entry> RigidLevel<M>::exchanged(const BlockSums<M>& sums) const {
  std::vector<std::vector<typename BlockSums<M>::Entry>> to(static_cast<std::size_t>(ranks_));
  for (const auto& entry : sums.entries()) {
    const int row = owner(entry.row), column = owner(entry.column);
    if (row != rank_) to[static_cast<std::size_t>(row)].push_back(entry);
    if (column != rank_ && column != row) to[static_cast<std::size_t>(column)].push_back(entry);
  }
  return exchange_entries(to, comm_);
}

template <int M>
std::int32_t RigidLevel<M>::local(std::int64_t row) const {
  if (row >= first() && row < first() + rows()) return static_cast<std::int32_t>(row - first());
  const auto at = std::lower_bound(ghosts_.begin(), ghosts_.end(), row);
  return at != ghosts_.end() && *at == row ? rows() + static_cast<std::int32_t>(at - ghosts_.begin()) : -1;
}

template <int M>
void RigidLevel<M>::clear() {
  for (Block& block : block_) block.fill(0.0);
}

template <int M>
typename RigidLevel<M>::Block& RigidLevel<M>::block(std::int32_t row, std::int32_t column) {
  auto k = static_cast<std::size_t>(start_[static_cast<std::size_t>(row)]);
  while (column_[k] != column) ++k;
  return block_[k];
}

template <int M>
void RigidLevel<M>::complete(BlockSums<M> outside) {
  if (ranks_ > 1) {
    visit([&](std::int32_t i, std::int32_t j, const Block& sum) {
      if (j < rows()) return;
      const std::int64_t row = first() + i, column = ghosts_[static_cast<std::size_t>(j - rows())];
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
void RigidLevel<M>::add(const BlockSums<M>& sums) {
  const auto mine = [this](std::int64_t row) { return row >= first() && row < first() + rows(); };
  for (const auto& entry : sums.entries())
    if (mine(entry.row) || mine(entry.column)) add_to_rows(entry);
  if (ranks_ > 1)
    for (const auto& entry : exchanged(sums)) add_to_rows(entry);
  invert_diagonal();
}

/// Of an entry with a row or a column of this rank.
template <int M>
void RigidLevel<M>::add_to_rows(const typename BlockSums<M>::Entry& entry) {
  const std::int32_t row = local(entry.row), column = local(entry.column);
  const bool here = row >= 0 && row < rows();
  Block& sum = here ? block(row, column) : block(column, row);
  const Block add = here ? entry.block : transposed<M>(entry.block);
  for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += add[k];
}

template <int M>
void RigidLevel<M>::build_rows(const BlockSums<M>& sums) {
  const std::int64_t begin = first(), end = begin + rows();
  const auto mine = [&](std::int64_t row) { return row >= begin && row < end; };
  start_.assign(static_cast<std::size_t>(rows()) + 1, 0);
  for (const auto& entry : sums.entries()) {
    const bool row = mine(entry.row), column = mine(entry.column);
    if (row || column) ++start_[static_cast<std::size_t>((row ? entry.row : entry.column) - begin) + 1];
    if (row && !column) ghosts_.push_back(entry.column);
    if (!row && column) ghosts_.push_back(entry.row);
  }
  std::sort(ghosts_.begin(), ghosts_.end());
  ghosts_.erase(std::unique(ghosts_.begin(), ghosts_.end()), ghosts_.end());
  ghosts_.shrink_to_fit();
  std::partial_sum(start_.begin(), start_.end(), start_.begin());

  column_.resize(static_cast<std::size_t>(start_.back()));
  block_.resize(column_.size());
  auto next = start_;
  for (const bool ghosts : {false, true}) {
    for (const auto& entry : sums.entries()) {
      const bool row = mine(entry.row), column = mine(entry.column);
      if (row == column ? !row || ghosts : !ghosts) continue;
      const auto k = static_cast<std::size_t>(
          next[static_cast<std::size_t>((row ? entry.row : entry.column) - begin)]++);
      column_[k] = local(row ? entry.column : entry.row);
      block_[k] = row ? entry.block : transposed<M>(entry.block);
    }
    for (std::int32_t i = 0; i < rows() && !ghosts; ++i)
      if (const auto at = static_cast<std::size_t>(i); next[at] < start_[at + 1])
        edge_.push_back({i, next[at]});
  }
}

template <int M>
void RigidLevel<M>::plan_exchange() {
  if (ranks_ == 1) return;
  std::vector<std::vector<std::int64_t>> wanted(static_cast<std::size_t>(ranks_));
  for (std::size_t i = 0; i < ghosts_.size(); ++i) {
    const int from = owner(ghosts_[i]);
    if (wanted[static_cast<std::size_t>(from)].empty())
      neighbours_.push_back({from, {}, rows() + static_cast<std::int32_t>(i), 0});
    ++neighbours_.back().ghosts;
    wanted[static_cast<std::size_t>(from)].push_back(ghosts_[i]);
  }
  // The couplings are symmetric: who is wanted from wants something too.
  for (auto& n : neighbours_) {
    auto& ids = wanted[static_cast<std::size_t>(n.rank)];
    std::int32_t count = 0;
    MPI_Sendrecv(&n.ghosts, 1, MPI_INT32_T, n.rank, 2, &count, 1, MPI_INT32_T, n.rank, 2, comm_,
                 MPI_STATUS_IGNORE);
    std::vector<std::int64_t> asked(static_cast<std::size_t>(count));
    MPI_Sendrecv(ids.data(), n.ghosts, MPI_INT64_T, n.rank, 3, asked.data(), count, MPI_INT64_T, n.rank, 3,
                 comm_, MPI_STATUS_IGNORE);
    for (const std::int64_t id : asked) n.send.push_back(static_cast<std::int32_t>(id - first()));
  }
}

template <int M>
void RigidLevel<M>::invert_diagonal() {
  inverse_diagonal_.resize(centres_.size());
  for (std::size_t i = 0; i < centres_.size(); ++i) {
    Dense<M> d = Dense<M>::Zero();
    for (auto k = start_[i]; k < start_[i + 1]; ++k)
      if (column_[static_cast<std::size_t>(k)] == static_cast<std::int32_t>(i))
        d = dense<M>(block_[static_cast<std::size_t>(k)]);
    // Motions that boundary conditions leave no node for have no stiffness: they stay where they are.
    const double largest = d.diagonal().maxCoeff();
    Eigen::SelfAdjointEigenSolver<Dense<M>> solver(d);
    Dense<M> inverse = Dense<M>::Zero();
    for (int k = 0; k < M; ++k) {
      const double value = solver.eigenvalues()[k];
      if (value > 1e-6 * largest)
        inverse += solver.eigenvectors().col(k) * solver.eigenvectors().col(k).transpose() / value;
    }
    for (int k = 0; k < M * M; ++k) inverse_diagonal_[i][static_cast<std::size_t>(k)] = inverse.data()[k];
  }
}

/// To be waited for before ghosts are read or the next product is started.
template <int M>
void RigidLevel<M>::start_filling_ghosts(std::span<double> x) const {
  std::size_t count = 0;
  for (const auto& n : neighbours_) count += n.send.size() * M;
  sent_.resize(count);
  double* to = sent_.data();
  for (const auto& n : neighbours_) {
    MPI_Irecv(x.data() + static_cast<std::size_t>(n.first_ghost) * M, n.ghosts * M, MPI_DOUBLE, n.rank, 4,
              comm_, &requests_.emplace_back());
    double* const from = to;
    for (const std::int32_t row : n.send)
      to = std::copy_n(x.data() + static_cast<std::size_t>(row) * M, M, to);
    MPI_Isend(from, static_cast<int>(to - from), MPI_DOUBLE, n.rank, 4, comm_, &requests_.emplace_back());
  }
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

template <int M>
void RigidLevel<M>::multiply(std::span<double> x, std::span<double> y) const {
  start_filling_ghosts(x);
  const auto mine = y.first(owned_size());
  std::fill(mine.begin(), mine.end(), 0.0);
  const std::size_t owned = centres_.size();
  for (std::size_t i = 0; i < owned; ++i) {
    std::array<double, M> sum{};
    const double* here = x.data() + i * M;
    for (auto k = static_cast<std::size_t>(start_[i]); k < static_cast<std::size_t>(start_[i + 1]); ++k) {
      const auto j = static_cast<std::size_t>(column_[k]);
      if (j >= owned) break;
      add_product<M>(block_[k].data(), x.data() + j * M, sum.data());
      if (j != i) add_transposed<M>(block_[k].data(), here, y.data() + j * M);
    }
    for (std::size_t m = 0; m < M; ++m) y[i * M + m] += sum[m];
  }
  MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
  requests_.clear();
  for (const Edge& edge : edge_) {
    const auto i = static_cast<std::size_t>(edge.row);
    for (auto k = static_cast<std::size_t>(edge.first); k < static_cast<std::size_t>(start_[i + 1]); ++k)
      add_product<M>(block_[k].data(), x.data() + static_cast<std::size_t>(column_[k]) * M, y.data() + i * M);
  }
}

template <int M>
void RigidLevel<M>::relax(const ChebyshevStep<double>& weights, std::span<const double> b,
                          std::span<const double> image, std::span<double> step, std::span<double> x) const {
  weights.visit([&]<bool zero, bool first>() {
    for (std::size_t i = 0; i < centres_.size(); ++i) {
      std::array<double, M> residual, scaled{};
      for (std::size_t m = 0; m < M; ++m) residual[m] = zero ? b[i * M + m] : b[i * M + m] - image[i * M + m];
      add_product<M>(inverse_diagonal_[i].data(), residual.data(), scaled.data());
      for (std::size_t m = 0; m < M; ++m) weights.take<zero, first>(scaled[m], step[i * M + m], x[i * M + m]);
    }
  });
}

template <int M>
RigidLevel<M> RigidLevel<M>::coarsened(std::span<const std::int32_t> group, double length) const {
  const double inverse_length = 1.0 / length;
  const std::int32_t groups = group.empty() ? 0 : 1 + *std::max_element(group.begin(), group.end());
  std::vector<Vector3> centre(static_cast<std::size_t>(groups), Vector3{});
  std::vector<double> members(centre.size(), 0.0);
  for (std::size_t i = 0; i < group.size(); ++i) {
    const auto to = static_cast<std::size_t>(group[i]);
    members[to] += 1.0;
    for (std::size_t c = 0; c < 3; ++c) centre[to][c] += centres_[i][c];
  }
  for (std::size_t i = 0; i < centre.size(); ++i)
    for (double& c : centre[i]) c /= members[i];

  std::int64_t first_group = 0;
  const auto mine = static_cast<std::int64_t>(groups);
  MPI_Exscan(&mine, &first_group, 1, MPI_INT64_T, MPI_SUM, comm_);
  if (rank_ == 0) first_group = 0;

  // Of every row, ghosts included: its group over all ranks and where it lies in it.
  struct Place {
    std::int64_t group = 0;
    Vector3 offset{};
  };
  std::vector<Place> place(centres_.size() + ghosts_.size());
  for (std::size_t i = 0; i < group.size(); ++i) {
    const auto& c = centre[static_cast<std::size_t>(group[i])];
    place[i] = {first_group + group[i],
                {centres_[i][0] - c[0], centres_[i][1] - c[1], centres_[i][2] - c[2]}};
  }
  for (const auto& n : neighbours_) {
    std::vector<Place> out;
    for (const std::int32_t row : n.send) out.push_back(place[static_cast<std::size_t>(row)]);
    MPI_Sendrecv(out.data(), static_cast<int>(out.size() * sizeof(Place)), MPI_BYTE, n.rank, 5,
                 place.data() + n.first_ghost,
                 static_cast<int>(static_cast<std::size_t>(n.ghosts) * sizeof(Place)), MPI_BYTE, n.rank, 5,
                 comm_, MPI_STATUS_IGNORE);
  }

  BlockSums<M> sums;
  for (std::size_t i = 0; i < centres_.size(); ++i) {
    const Dense<M> row = prolongation<M>(place[i].offset, inverse_length).transpose();
    for (auto k = static_cast<std::size_t>(start_[i]); k < static_cast<std::size_t>(start_[i + 1]); ++k) {
      const auto j = static_cast<std::size_t>(column_[k]);
      const Place& other = place[j];
      const bool with_transpose = j != i && j < centres_.size();
      const Dense<M> product = row * dense<M>(block_[k]) * prolongation<M>(other.offset, inverse_length);
      if (place[i].group <= other.group) {  // else the owner of the column's row has it
        auto& sum = sums.at(place[i].group, other.group);
        for (std::size_t e = 0; e < sum.size(); ++e) sum[e] += product.data()[e];
      }
      if (with_transpose && other.group <= place[i].group) {
        const Dense<M> transpose = product.transpose();
        auto& sum = sums.at(other.group, place[i].group);
        for (std::size_t e = 0; e < sum.size(); ++e) sum[e] += transpose.data()[e];
      }
    }
  }
  return RigidLevel(std::move(centre), std::move(sums), comm_);
}

template <int M>
WeightedGraph RigidLevel<M>::couplings() const {
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
  graph.column.resize(static_cast<std::size_t>(graph.start.back()));
  graph.weight.resize(graph.column.size());
  auto next = graph.start;
  visit_edges([&](std::int32_t i, std::int32_t j, const Block& block) {
    double square = 0.0;
    for (int a = 0; a < dim; ++a)
      for (int b = 0; b < dim; ++b) {
        const double v = block[static_cast<std::size_t>(a * M + b)];
        square += v * v;
      }
    for (const auto& [from, to] : {std::pair{i, j}, std::pair{j, i}}) {
      const auto at = static_cast<std::size_t>(next[static_cast<std::size_t>(from)]++);
      graph.column[at] = to;
      graph.weight[at] = static_cast<float>(std::sqrt(square));
    }
  });
  return graph;
}

template <int M>
double RigidLevel<M>::largest_eigenvalue() const {
  std::vector<double> start(size());
  for (std::size_t i = 0; i < owned_size(); ++i)
    start[i] = scatter(static_cast<std::uint64_t>(first()) * M + i);
  return kacanov::largest_eigenvalue(
      start, [this](std::span<double> x, std::span<double> y) { multiply(x, y); },
      [&](std::span<const double> x, std::span<double> y) {
        relax({0.0, 1.0, true, true}, x, x, y, y);
      },
      [this](const std::vector<double>& x, const std::vector<double>& y) {
        double sum = 0.0;
        for (std::size_t i = 0; i < owned_size(); ++i) sum += x[i] * y[i];
        MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, comm_);
        return sum;
      });
}

template <int M>
std::vector<typename BlockSums<M>::Entry> RigidLevel<M>::gathered() const {
  std::vector<typename BlockSums<M>::Entry> mine;
  visit([&](std::int32_t i, std::int32_t j, const Block& block) {
    mine.push_back(
        {first() + i, j < rows() ? first() + j : ghosts_[static_cast<std::size_t>(j - rows())], block});
    if (j < rows() && j != i) mine.push_back({first() + j, first() + i, transposed<M>(block)});
  });
  return exchange_entries(std::vector(static_cast<std::size_t>(ranks_), mine), comm_);
}

template class RigidLevel<3>;
template class RigidLevel<6>;

}  // namespace kacanov
