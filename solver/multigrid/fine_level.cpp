// SPDX-License-Identifier: BSD-3-Clause
// The fine level of the multigrid: B(g) and node blocks in single precision, with its block diagonal.
#include "multigrid/fine_level.hpp"

#include <Eigen/Dense>

#include "multigrid/largest_eigenvalue.hpp"
#include "multigrid/rigid_multigrid.hpp"

namespace kacanov {

FineLevel::FineLevel(const Part& part, const MultigridOptions& options)
    : part_(part), op_(part.body(), OperatorOptions{options.threads, options.instruction_set}), space_(part) {}

void FineLevel::build(std::span<const double> g, std::span<const NodeBlock> blocks, const Space& space) {
  op_.set_secant(g);
  rebuild(blocks, space);
}

void FineLevel::rebuild(std::span<const NodeBlock> blocks, const Space& space) {
  space_ = space;
  blocks_.assign(blocks.begin(), blocks.end());
  const auto dim = static_cast<std::size_t>(part_.dim());
  const std::size_t packed = dim * (dim + 1) / 2;
  std::vector<float> diagonal(part_.nodes() * dim * dim);
  op_.block_diagonal(diagonal);
  for (const auto& b : blocks_)
    for (std::size_t k = 0; k < dim * dim; ++k) diagonal[static_cast<std::size_t>(b.node) * dim * dim + k] += static_cast<float>(b.value[k]);
  part_.halo.sum(std::span<float>(diagonal), static_cast<int>(dim * dim));
  inverse_.resize(part_.nodes() * packed);
  for (std::size_t n = 0; n < part_.nodes(); ++n) {
    Eigen::Matrix3d d = Eigen::Matrix3d::Identity();
    for (std::size_t i = 0; i < dim; ++i)
      for (std::size_t j = 0; j < dim; ++j)
        if (part_.held[n * dim + i] == 0 && part_.held[n * dim + j] == 0)
          d(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = static_cast<double>(diagonal[(n * dim + i) * dim + j]);
    const Eigen::Matrix3d inverse = d.inverse();
    float* to = &inverse_[n * packed];
    for (std::size_t i = 0; i < dim; ++i)
      for (std::size_t j = i; j < dim; ++j)
        *to++ = static_cast<float>(inverse(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
  }
}

void FineLevel::multiply(std::span<const float> x, std::span<float> y) const {
  op_.apply(x, y);
  const auto dim = static_cast<std::size_t>(part_.dim());
  for (const auto& b : blocks_) {
    const auto at = static_cast<std::size_t>(b.node) * dim;
    for (std::size_t i = 0; i < dim; ++i)
      for (std::size_t j = 0; j < dim; ++j) y[at + i] += static_cast<float>(b.value[i * dim + j]) * x[at + j];
  }
  part_.halo.sum(y, part_.dim());
  hold(y);
}

void FineLevel::scale(std::span<const float> x, std::span<float> y) const {
  const std::size_t nodes = part_.nodes();
  if (part_.dim() == 3) {
    for (std::size_t n = 0; n < nodes; ++n) {
      const float* d = &inverse_[6 * n];
      const float a = x[3 * n], b = x[3 * n + 1], c = x[3 * n + 2];
      y[3 * n] = d[0] * a + d[1] * b + d[2] * c;
      y[3 * n + 1] = d[1] * a + d[3] * b + d[4] * c;
      y[3 * n + 2] = d[2] * a + d[4] * b + d[5] * c;
    }
  } else {
    for (std::size_t n = 0; n < nodes; ++n) {
      const float* d = &inverse_[3 * n];
      const float a = x[2 * n], b = x[2 * n + 1];
      y[2 * n] = d[0] * a + d[1] * b;
      y[2 * n + 1] = d[1] * a + d[2] * b;
    }
  }
}

void FineLevel::hold(std::span<float> x) const { Space(part_).project(x); }

void FineLevel::project(std::span<float> x) const { space_.project(x); }

void FineLevel::choose_smoother(int degree, double range) {
  std::vector<float> x(part_.unknowns());
  const auto dim = static_cast<std::size_t>(part_.dim());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const auto id = part_.node_number(i / dim) * static_cast<std::int64_t>(dim) + static_cast<std::int64_t>(i % dim);
    x[i] = scatter(static_cast<std::uint64_t>(id));
  }
  hold(x);
  const auto owned = part_.owned_unknowns();
  const double largest = largest_eigenvalue(
      x, [this](std::span<const float> p, std::span<float> q) { multiply(p, q); },
      [this](std::span<const float> p, std::span<float> q) { scale(p, q); },
      [&](const std::vector<float>& p, const std::vector<float>& q) {
        double sum = 0.0;
        for (std::size_t i = 0; i < owned; ++i) sum += static_cast<double>(p[i]) * static_cast<double>(q[i]);
        return part_.halo.sum_all(sum);
      });
  smoother_ = {degree, largest / range, largest};
}

}  // namespace kacanov
