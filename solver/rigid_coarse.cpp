// SPDX-License-Identifier: BSD-3-Clause
// A coarse space: the rigid motions of aggregates of nodes.
#include "rigid_coarse.hpp"

#include <metis.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "assembly.hpp"
#include "element_stiffness.hpp"
#include "error.hpp"

namespace kacanov {
namespace {

using CoarseBlock = Eigen::Matrix<double, 6, 6>;
/// Blocks of E by (row aggregate, column aggregate).
using CoarseBlocks = std::unordered_map<std::uint64_t, CoarseBlock>;

constexpr std::int64_t most_aggregates = 512;
constexpr std::int64_t nodes_an_aggregate = 64;  // at least

std::uint64_t key(std::int32_t row, std::int32_t column) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(row)) << 32 | static_cast<std::uint32_t>(column);
}

/// Every rank gets the sum of all ranks' blocks.
void sum_over_ranks(CoarseBlocks& blocks, const Halo& halo) {
  if (halo.ranks == 1) return;
  std::vector<std::uint64_t> keys;
  std::vector<double> values;
  for (const auto& [k, block] : blocks) {
    keys.push_back(k);
    values.insert(values.end(), block.data(), block.data() + 36);
  }
  std::vector<int> counts(static_cast<std::size_t>(halo.ranks)), first(counts.size(), 0);
  const int mine = static_cast<int>(keys.size());
  MPI_Allgather(&mine, 1, MPI_INT, counts.data(), 1, MPI_INT, halo.comm);
  for (std::size_t r = 1; r < counts.size(); ++r) first[r] = first[r - 1] + counts[r - 1];
  const auto total = static_cast<std::size_t>(first.back() + counts.back());
  std::vector<std::uint64_t> all_keys(total);
  std::vector<double> all_values(36 * total);
  MPI_Allgatherv(keys.data(), mine, MPI_UINT64_T, all_keys.data(), counts.data(), first.data(), MPI_UINT64_T,
                 halo.comm);
  for (std::size_t r = 0; r < counts.size(); ++r) {
    counts[r] *= 36;
    first[r] *= 36;
  }
  MPI_Allgatherv(values.data(), 36 * mine, MPI_DOUBLE, all_values.data(), counts.data(), first.data(), MPI_DOUBLE,
                 halo.comm);
  blocks.clear();
  for (std::size_t i = 0; i < total; ++i) {
    const auto [at, fresh] = blocks.try_emplace(all_keys[i], CoarseBlock::Zero());
    at->second += Eigen::Map<const CoarseBlock>(&all_values[36 * i]);
  }
}

}  // namespace

RigidCoarse::RigidCoarse(const Part& part) : part_(part), modes_(part.dim() == 3 ? 6 : 3) { aggregate_nodes(); }

void RigidCoarse::aggregate_nodes() {
  const auto owned = static_cast<std::size_t>(part_.owned_nodes);
  const auto dim = static_cast<std::size_t>(part_.dim());
  const std::int64_t wanted = std::clamp<std::int64_t>(part_.total_nodes / nodes_an_aggregate, 1, most_aggregates);
  auto parts = static_cast<idx_t>(std::clamp<std::int64_t>(wanted * part_.owned_nodes / part_.total_nodes, 1, wanted));
  std::vector<idx_t> own(owned, 0);
  if (owned > 0 && parts > 1) {
    const NodeGraph graph = node_graph(part_.body().mesh);
    std::vector<idx_t> start{0}, column;
    for (std::size_t n = 0; n < owned; ++n) {
      for (auto k = graph.start[n]; k < graph.start[n + 1]; ++k) {
        const std::int32_t m = graph.column[static_cast<std::size_t>(k)];
        if (m < part_.owned_nodes && m != static_cast<std::int32_t>(n)) column.push_back(m);
      }
      start.push_back(static_cast<idx_t>(column.size()));
    }
    auto nodes = static_cast<idx_t>(owned);
    idx_t balance = 1, cut = 0;
    if (METIS_PartGraphKway(&nodes, &balance, start.data(), column.data(), nullptr, nullptr, nullptr, &parts, nullptr,
                            nullptr, nullptr, &cut, own.data()) != METIS_OK)
      throw InternalError("METIS could not aggregate the nodes");
  }
  std::int64_t first = 0, count = parts, total = part_.halo.sum_all(static_cast<std::int64_t>(parts));
  MPI_Exscan(&count, &first, 1, MPI_INT64_T, MPI_SUM, part_.halo.comm);
  if (part_.halo.rank == 0) first = 0;

  std::vector<double> number(part_.nodes(), 0.0), sums(4 * static_cast<std::size_t>(total), 0.0);
  for (std::size_t n = 0; n < owned; ++n) {
    const auto a = static_cast<std::size_t>(first + own[n]);
    number[n] = static_cast<double>(a);
    sums[4 * a + 3] += 1.0;
    for (std::size_t c = 0; c < dim; ++c) sums[4 * a + c] += part_.coordinates[n * dim + c];
  }
  part_.halo.copy_from_owner(number, 1);
  part_.halo.sum_all(sums);
  for (const double a : number) aggregate_.push_back(static_cast<std::int32_t>(a));
  for (std::size_t a = 0; a < static_cast<std::size_t>(total); ++a) {
    const double weight = std::max(1.0, sums[4 * a + 3]);
    centre_.push_back({sums[4 * a] / weight, sums[4 * a + 1] / weight, sums[4 * a + 2] / weight});
  }
  double spread = 0.0;
  for (std::size_t n = 0; n < owned; ++n)
    for (std::size_t c = 0; c < dim; ++c) {
      const double d = part_.coordinates[n * dim + c] - centre_[static_cast<std::size_t>(aggregate_[n])][c];
      spread += d * d;
    }
  length_ = std::sqrt(part_.halo.sum_all(spread) / static_cast<double>(part_.total_nodes));
  if (!(length_ > 0.0)) length_ = 1.0;
}

RigidCoarse::Modes RigidCoarse::node_modes(std::size_t node) const {
  const auto dim = static_cast<std::size_t>(part_.dim());
  const auto& centre = centre_[static_cast<std::size_t>(aggregate_[node])];
  Vector3 x{};
  for (std::size_t c = 0; c < dim; ++c) x[c] = (part_.coordinates[node * dim + c] - centre[c]) / length_;
  Modes z = Modes::Zero();
  if (dim == 2) {
    z(0, 0) = z(1, 1) = 1.0;
    z(0, 2) = -x[1];
    z(1, 2) = x[0];
  } else {
    z(0, 0) = z(1, 1) = z(2, 2) = 1.0;
    z(1, 3) = -x[2];
    z(2, 3) = x[1];
    z(0, 4) = x[2];
    z(2, 4) = -x[0];
    z(0, 5) = -x[1];
    z(1, 5) = x[0];
  }
  for (std::size_t c = 0; c < dim; ++c)
    if (part_.held[node * dim + c]) z.row(static_cast<Eigen::Index>(c)).setZero();
  return z;
}

void RigidCoarse::build(std::span<const double> g, std::span<const NodeBlock> blocks, const Space& space) {
  const Body body = part_.body();
  const auto dim = static_cast<std::size_t>(part_.dim());
  const auto npe = static_cast<std::size_t>(nodes_per_element(part_.type));
  const auto points = static_cast<std::size_t>(points_per_element(part_.type));
  const std::size_t width = npe * dim;

  // Nodes whose motion is not rigid: held components or directions.
  std::vector<std::uint8_t> bound(part_.nodes(), 0);
  for (std::size_t i = 0; i < part_.held.size(); ++i) bound[i / dim] |= part_.held[i];
  std::unordered_map<std::int32_t, Eigen::Matrix3d> projector;
  for (const auto& entry : space.held_directions()) {
    Eigen::Matrix3d p = Eigen::Matrix3d::Identity();
    for (int k = 0; k < entry.count; ++k) {
      const Eigen::Map<const Eigen::Vector3d> d(entry.basis[static_cast<std::size_t>(k)].data());
      p -= d * d.transpose();
    }
    bound[static_cast<std::size_t>(entry.node)] = 1;
    projector.emplace(entry.node, p);
  }
  const auto modes_of = [&](std::int32_t node) {
    const Modes z = node_modes(static_cast<std::size_t>(node));
    const auto at = projector.find(node);
    return at == projector.end() ? z : Modes(at->second * z);
  };

  CoarseBlocks coarse;
  const auto add = [&](std::int32_t row, std::int32_t column, const CoarseBlock& block) {
    coarse.try_emplace(key(row, column), CoarseBlock::Zero()).first->second += block;
  };
  std::vector<double> matrix(width * width);
  std::vector<Modes> z(npe);
  for (std::size_t e = 0; e < body.mesh.element_count(); ++e) {
    const auto element = body.mesh.connectivity.subspan(e * npe, npe);
    // A rigid motion strains nothing: elements within one aggregate add nothing.
    bool rigid = true;
    const std::int32_t first = aggregate_[static_cast<std::size_t>(element[0])];
    for (const std::int32_t n : element)
      rigid = rigid && aggregate_[static_cast<std::size_t>(n)] == first && bound[static_cast<std::size_t>(n)] == 0;
    if (rigid) continue;
    element_stiffness(body, e, g.subspan(e * points, points), matrix);
    for (std::size_t a = 0; a < npe; ++a) z[a] = modes_of(element[a]);
    for (std::size_t a = 0; a < npe; ++a)
      for (std::size_t b = 0; b < npe; ++b) {
        Eigen::Matrix3d k = Eigen::Matrix3d::Zero();
        for (std::size_t i = 0; i < dim; ++i)
          for (std::size_t j = 0; j < dim; ++j)
            k(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = matrix[(a * dim + i) * width + b * dim + j];
        add(aggregate_[static_cast<std::size_t>(element[a])], aggregate_[static_cast<std::size_t>(element[b])],
            z[a].transpose() * k * z[b]);
      }
  }
  for (const auto& block : blocks) {
    Eigen::Matrix3d k = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < dim; ++i)
      for (std::size_t j = 0; j < dim; ++j)
        k(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = block.value[i * dim + j];
    const Modes m = modes_of(block.node);
    const std::int32_t a = aggregate_[static_cast<std::size_t>(block.node)];
    add(a, a, m.transpose() * k * m);
  }
  sum_over_ranks(coarse, part_.halo);

  const Eigen::Index size = static_cast<Eigen::Index>(centre_.size()) * modes_;
  std::vector<Eigen::Triplet<double>> entries;
  double largest = 0.0;
  for (const auto& [k, block] : coarse) {
    const auto row = static_cast<Eigen::Index>(k >> 32), column = static_cast<Eigen::Index>(k & 0xffffffffU);
    for (Eigen::Index i = 0; i < modes_; ++i)
      for (Eigen::Index j = 0; j < modes_; ++j) {
        entries.emplace_back(row * modes_ + i, column * modes_ + j, block(i, j));
        if (row == column && i == j) largest = std::max(largest, block(i, i));
      }
  }
  // Modes that holds have emptied, and rounding: a shift far below anything that moves.
  const double shift = largest > 0.0 ? 1e-10 * largest : 1.0;
  for (Eigen::Index i = 0; i < size; ++i) entries.emplace_back(i, i, shift);
  Eigen::SparseMatrix<double> e(size, size);
  e.setFromTriplets(entries.begin(), entries.end());
  factor_.compute(e);
  if (factor_.info() != Eigen::Success) throw InternalError("the coarse matrix of the preconditioner is not definite");
}

void RigidCoarse::add(std::span<const double> r, std::span<double> z) const {
  const auto dim = static_cast<Eigen::Index>(part_.dim());
  Vector coarse(centre_.size() * static_cast<std::size_t>(modes_), 0.0);
  const auto owned = static_cast<std::size_t>(part_.owned_nodes);
  for (std::size_t n = 0; n < owned; ++n) {
    const Modes m = node_modes(n);
    double* to = &coarse[static_cast<std::size_t>(aggregate_[n]) * static_cast<std::size_t>(modes_)];
    for (Eigen::Index k = 0; k < modes_; ++k)
      for (Eigen::Index c = 0; c < dim; ++c) to[k] += m(c, k) * r[n * static_cast<std::size_t>(dim) + static_cast<std::size_t>(c)];
  }
  part_.halo.sum_all(coarse);
  const Eigen::VectorXd x =
      factor_.solve(Eigen::Map<const Eigen::VectorXd>(coarse.data(), static_cast<Eigen::Index>(coarse.size())));
  for (std::size_t n = 0; n < owned; ++n) {
    const Modes m = node_modes(n);
    const Eigen::Index first = static_cast<Eigen::Index>(aggregate_[n]) * modes_;
    for (Eigen::Index c = 0; c < dim; ++c) {
      double sum = 0.0;
      for (Eigen::Index k = 0; k < modes_; ++k) sum += m(c, k) * x[first + k];
      z[n * static_cast<std::size_t>(dim) + static_cast<std::size_t>(c)] += sum;
    }
  }
}

}  // namespace kacanov
