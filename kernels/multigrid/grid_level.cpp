// SPDX-License-Identifier: BSD-3-Clause
// One level of displacements and pressures on a background grid: its matrix and its smoother.
#include "multigrid/grid_level.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <utility>

#include "multigrid/largest_eigenvalue.hpp"
#include "multigrid/rigid_blocks.hpp"
#include "operator/threads.hpp"

namespace kacanov {

GridLevel::GridLevel(std::span<const std::int64_t> starts, BlockSums<4> sums, const Communicator& comm,
                     int threads)
    : rows_(static_cast<std::size_t>(starts[comm.rank + 1] - starts[comm.rank])), threads_(threads) {
  blocks_.emplace(std::vector<Vector3>(rows_), std::move(sums), comm, 1);
  map_ = std::make_unique<const IndexMap>(blocks_->map());
  fill_u_.emplace(*map_, static_cast<int>(GridVector::width));
  fill_p_.emplace(*map_, 1);
  take_rows();
  find_scales();
}

/// Whole rows, kind by kind.
void GridLevel::take_rows() {
  std::vector<std::int64_t> count(rows_ + 1, 0);
  const auto both = [&](const auto& visit) {
    blocks_->visit([&](std::int32_t i, std::int32_t j, const BlockSums<4>::Block& block) {
      visit(static_cast<std::size_t>(i), j, block, false);
      if (j != i && static_cast<std::size_t>(j) < rows_) visit(static_cast<std::size_t>(j), i, block, true);
    });
  };
  both([&](std::size_t row, std::int32_t, const auto&, bool) { ++count[row + 1]; });
  for (std::size_t i = 0; i < rows_; ++i) count[i + 1] += count[i];
  start_ = count;
  const std::size_t entries = start_.back();
  column_.resize(entries), a_.resize(12 * entries), gradient_.resize(4 * entries);
  divergence_.resize(4 * entries), compliance_.resize(entries);
  both([&](std::size_t row, std::int32_t column, const BlockSums<4>::Block& block, bool turned) {
    const std::size_t k = count[row]++;
    const auto at = [&](std::size_t r, std::size_t t) {
      return static_cast<float>(turned ? block[t * 4 + r] : block[r * 4 + t]);
    };
    column_[k] = column;
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t t = 0; t < 3; ++t) a_[12 * k + 4 * t + r] = at(r, t);
      gradient_[4 * k + r] = at(r, 3), divergence_[4 * k + r] = at(3, r);
    }
    compliance_[k] = -at(3, 3);
  });
}

void GridLevel::find_scales() {
  inverse_.assign(12 * map_->size(), 0.0);
  for (std::size_t i = 0; i < rows_; ++i)
    for (std::int64_t k = start_[i]; k < start_[i + 1]; ++k) {
      if (static_cast<std::size_t>(column_[k]) != i) continue;
      Eigen::Matrix3d d;
      for (int r = 0; r < 3; ++r)
        for (int t = 0; t < 3; ++t) d(r, t) = static_cast<double>(a_[12 * k + 4 * t + r]);
      // What no node moves with has no stiffness: it stays where it is.
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(d);
      Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();
      for (int m = 0; m < 3; ++m)
        if (const double value = solver.eigenvalues()[m]; value > 1e-6 * d.diagonal().maxCoeff())
          inverse += solver.eigenvectors().col(m) * solver.eigenvectors().col(m).transpose() / value;
      for (int r = 0; r < 3; ++r)
        for (int t = 0; t < 3; ++t) inverse_[12 * i + 4 * t + r] = inverse(r, t);
    }
  const auto dot = [this](std::size_t components) {
    return [this, components](const std::vector<double>& x, const std::vector<double>& y) {
      double sum = 0.0;
      for (std::size_t i = 0; i < components * rows_; ++i) sum += x[i] * y[i];
      return map_->sum_all(sum);
    };
  };
  std::vector<double> u = scattered<double>(*map_, GridVector::width);
  for (std::size_t i = 3; i < u.size(); i += GridVector::width) u[i] = 0.0;
  const double largest = largest_eigenvalue(
      u,
      [this](std::span<double> x, std::span<double> y) {
        fill_u_->start_forward(x), fill_u_->finish_forward(x);
        force(x, y);
      },
      [this](std::span<const double> x, std::span<double> y) { scale(x, y); }, dot(GridVector::width));
  for (double& v : inverse_) v /= pressure_damping * largest;
  map_->forward(inverse_, 12);
  schur_inverse_.assign(rows_, 0.0);
  for (std::size_t i = 0; i < rows_; ++i) {
    double sum = 0.0;
    for (std::int64_t k = start_[i]; k < start_[i + 1]; ++k) {
      const float* b = &divergence_[4 * k];
      const double* d = &inverse_[12 * static_cast<std::size_t>(column_[k])];
      for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t t = 0; t < 3; ++t)
          sum += static_cast<double>(b[r]) * d[4 * t + r] * static_cast<double>(b[t]);
      if (static_cast<std::size_t>(column_[k]) == i) sum += static_cast<double>(compliance_[k]);
    }
    schur_inverse_[i] = sum > 0.0 ? 1.0 / sum : 0.0;
  }
  std::vector<double> p = scattered<double>(*map_, 1);
  solve_.largest = largest_eigenvalue(
      p, [this](std::span<double> x, std::span<double> y) { schur(x, y); },
      [this](std::span<const double> x, std::span<double> y) {
        for (std::size_t i = 0; i < rows_; ++i) y[i] = schur_inverse_[i] * x[i];
      },
      dot(1));
}

void GridLevel::force(std::span<const double> u, std::span<double> y) const {
  in_shares(threads_, rows_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      simd::store_four(&y[GridVector::width * i], simd::times_blocks(row(i), a_.data(), u.data()));
  });
}

void GridLevel::gradient(std::span<const double> p, std::span<double> y) const {
  in_shares(threads_, rows_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      simd::store_four(&y[GridVector::width * i], simd::times_vectors(row(i), gradient_.data(), p.data()));
  });
}

void GridLevel::divergence(std::span<const double> u, std::span<double> q) const {
  in_shares(threads_, rows_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) q[i] = simd::dot_vectors(row(i), divergence_.data(), u.data());
  });
}

void GridLevel::compliance(std::span<const double> p, std::span<double> q) const {
  in_shares(threads_, rows_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      q[i] = simd::times_numbers(row(i), compliance_.data(), p.data());
  });
}

void GridLevel::scale(std::span<const double> x, std::span<double> y) const {
  std::fill_n(y.begin(), GridVector::width * rows_, 0.0);
  add_scaled(1.0, x, y);
}

void GridLevel::add_scaled(double sign, std::span<const double> x, std::span<double> y) const {
  for (std::size_t i = 0; i < rows_; ++i) {
    const double *d = &inverse_[12 * i], *at = &x[GridVector::width * i];
    simd::store_four(
        &y[GridVector::width * i],
        simd::load_four(&y[GridVector::width * i]) +
            (simd::load_four(d) * at[0] + simd::load_four(d + 4) * at[1] + simd::load_four(d + 8) * at[2]) *
                sign);
  }
}

void GridLevel::fill(std::vector<double>& x, Scatterer<double>& scatterer) {
  scatterer.start_forward(x), scatterer.finish_forward(x);
}

void GridLevel::schur(std::span<double> p, std::span<double> q) {
  image_.resize(GridVector::width * map_->size()), lifted_.resize(GridVector::width * map_->size()),
      change_.resize(rows_);
  fill_p_->start_forward(p), fill_p_->finish_forward(p);
  gradient(p, image_);
  scale(image_, lifted_);
  fill(lifted_, *fill_u_);
  divergence(lifted_, q);
  compliance(p, change_);
  for (std::size_t i = 0; i < rows_; ++i) q[i] += change_[i];
}

void GridLevel::smooth(bool from_zero, int steps, const PressureSteps& with, const GridVector& b,
                       GridVector& x) {
  if (from_zero) x.clear();
  std::vector<double> w(GridVector::width * rows_), q(rows_);
  for (int s = 0; s < steps; ++s) {
    if (s == 0 && from_zero) {
      std::copy_n(b.u.begin(), w.size(), w.begin());
    } else {
      fill(x.u, *fill_u_);
      force(x.u, w);
      for (std::size_t i = 0; i < w.size(); ++i) w[i] = b.u[i] - w[i];
    }
    add_scaled(1.0, w, x.u);
    fill(x.u, *fill_u_);
    divergence(x.u, q);
    for (std::size_t i = 0; i < q.size(); ++i) q[i] -= b.p[i];
    solve_.improve(with, q, schur_inverse_, x.p,
                   [this](std::span<double> p, std::span<double> y) { schur(p, y); });
    fill(x.p, *fill_p_);
    gradient(x.p, w);
    add_scaled(-1.0, w, x.u);
  }
}

void GridLevel::residual(const GridVector& b, GridVector& x, GridVector& r) {
  fill(x.u, *fill_u_), fill(x.p, *fill_p_);
  std::vector<double> y(GridVector::width * rows_), q(rows_);
  force(x.u, y), gradient(x.p, std::span(r.u));
  for (std::size_t i = 0; i < y.size(); ++i) r.u[i] = b.u[i] - y[i] - r.u[i];
  divergence(x.u, q), compliance(x.p, std::span(r.p));
  for (std::size_t i = 0; i < q.size(); ++i) r.p[i] = b.p[i] - q[i] + r.p[i];
}

std::size_t GridLevel::bytes() const noexcept {
  const auto size = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return size(start_) + size(column_) + size(a_) + size(gradient_) + size(divergence_) + size(compliance_) +
         size(inverse_) + size(schur_inverse_) + (blocks_ ? blocks_->bytes() : 0);
}

}  // namespace kacanov
