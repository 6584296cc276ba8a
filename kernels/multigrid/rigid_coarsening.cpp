// SPDX-License-Identifier: BSD-3-Clause
// Coarsening of a rigid-motion level: couplings, and the Galerkin matrix over groups.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "multigrid/aggregation.hpp"
#include "multigrid/rigid_blocks.hpp"
#include "multigrid/rigid_level.hpp"

namespace kacanov {
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
RigidLevel<M> RigidLevel<M>::coarsened(std::span<const std::int32_t> group, double length) const {
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
  return RigidLevel(std::move(centre), std::move(sums), *map_, threads_);
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

template RigidLevel<3> RigidLevel<3>::coarsened(std::span<const std::int32_t>, double) const;
template RigidLevel<6> RigidLevel<6>::coarsened(std::span<const std::int32_t>, double) const;
template WeightedGraph RigidLevel<3>::couplings() const;
template WeightedGraph RigidLevel<6>::couplings() const;

}  // namespace kacanov
