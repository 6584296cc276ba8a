// SPDX-License-Identifier: BSD-3-Clause
// One level of displacements and pressures on a background grid: matrix and smoother.
#include "multigrid/grid_level.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <numeric>
#include <utility>

#include "multigrid/largest_eigenvalue.hpp"
#include "multigrid/sums.hpp"

namespace kacanov {
namespace {

const SmootherWeights grid_smoothing = chebyshev_weights(2, 6.0);

/// Pseudoinverse: directions without stiffness, which move no node, get no displacement.
Eigen::Matrix3d inverse_of_stiff(const Eigen::Matrix3d& d) {
  const double largest = d.diagonal().maxCoeff();
  // The smallest eigenvalue is at least a ninth of the determinant over the squared largest entry.
  if (d.determinant() > 1e-4 * largest * largest * largest) return d.inverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(d);
  Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();
  for (int m = 0; m < 3; ++m)
    if (const double value = solver.eigenvalues()[m]; value > 1e-6 * largest)
      inverse += solver.eigenvectors().col(m) * solver.eigenvectors().col(m).transpose() / value;
  return inverse;
}

/// Index of a row's diagonal entry.
std::size_t own_entry(const simd::GridRow& row, std::size_t i) {
  std::size_t k = row.begin;
  while (static_cast<std::size_t>(row.column[k]) != i) ++k;
  return k;
}

}  // namespace

GridLevel::GridLevel(const GridVertices& vertices, const GridLeaves& leaves, const Communicator& comm,
                     int threads)
    : threads_(threads) {
  // Element matrices: a leaf's corners, or the vertices that constrain them.
  std::vector<std::int64_t> number(vertices.starts().back());
  std::iota(number.begin(), number.end(), 0);
  std::vector<std::size_t> first{0};
  std::vector<std::int32_t> index;
  for (const std::int32_t leaf : leaves.cell) {
    for (std::size_t k = 0; k < 8; ++k)
      for (const GridVertices::Share& share : vertices.corner(leaf, k)) index.push_back(share.row);
    const auto here = index.begin() + static_cast<std::ptrdiff_t>(first.back());
    std::sort(here, index.end());
    index.erase(std::unique(here, index.end()), index.end());
    first.push_back(index.size());
  }
  const MatrixSide side{vertices.starts(), number, index, first};
  pattern_.emplace(side, side, comm, threads);
  first_.push_back(0);
  for (const std::int32_t leaf : leaves.cell)
    for (std::size_t k = 0; k < 8; ++k) {
      for (const GridVertices::Share& share : vertices.corner(leaf, k))
        shares_.push_back(
            {pattern_->row(share.row), pattern_->column(share.row), static_cast<float>(share.weight)});
      first_.push_back(shares_.size());
    }
  fill_.emplace(map(), static_cast<int>(grid_width));
  fill_p_.emplace(map(), 1);
  solve_.resize(rows(), map().size());
  p_.resize(map().size());
  for (auto* v : {&lifted_, &moved_}) v->resize(grid_width * map().size());
}

void GridLevel::build(const GridTree& tree, const GridLeaves& leaves, const LevelMoments& moments) {
  force_.assign(12 * pattern_->entries(), 0.0F);
  for (auto* v : {&pressure_, &divergence_}) v->assign(4 * pattern_->entries(), 0.0F);
  add_forms(leaves.cell.size(), [&](std::size_t leaf) {
    return std::optional<LeafForm>(std::in_place, moments.leaf[leaf], nullptr,
                                   tree.length(tree.cells()[leaves.cell[leaf]]));
  });
  pattern_->complete(force_, 12), pattern_->complete(pressure_, 4), pattern_->complete(divergence_, 4);
  kept_row_.clear(), kept_.clear();
  change(tree, leaves, moments);
}

void GridLevel::change(const GridTree& tree, const GridLeaves& leaves, const LevelStiffness& stiffness) {
  const float* kept = kept_.data();
  for (const std::int32_t r : kept_row_) {
    const simd::GridRow of = row(static_cast<std::size_t>(r));
    const std::size_t count = 12 * (of.end - of.begin);
    std::copy_n(kept, count, &force_[12 * of.begin]);
    kept += count;
  }
  keep_rows(stiffness);
  // The owners of these rows already have their old values.
  std::fill(force_.begin() + 12 * pattern_->start()[rows()], force_.end(), 0.0F);
  const LeafMoments no_moments;
  add_forms(leaves.cell.size(), [&](std::size_t leaf) {
    std::optional<LeafForm> form;
    if (const std::int32_t which = stiffness.stiff[leaf]; which >= 0)
      form.emplace(no_moments, &stiffness.stiffness[which], tree.length(tree.cells()[leaves.cell[leaf]]));
    return form;
  });
  pattern_->complete(force_, 12);
  invert_diagonal();
  find_scales();
}

/// Stores this rank's rows to which this or another rank may add stiffnesses.
void GridLevel::keep_rows(const LevelStiffness& stiffness) {
  std::vector<char> touched(pattern_->rows(), 0);
  for (std::size_t leaf = 0; leaf < stiffness.stiff.size(); ++leaf)
    if (stiffness.stiff[leaf] >= 0)
      for (const Share& share : shares_of(leaf)) touched[share.row] = 1;
  const auto start = pattern_->start();
  for (const std::int64_t entry : pattern_->added())
    touched[static_cast<std::size_t>(std::upper_bound(start.begin(), start.end(), entry) - start.begin()) -
            1] = 1;
  kept_row_.clear(), kept_.clear();
  for (std::size_t r = 0; r < rows(); ++r) {
    if (touched[r] == 0) continue;
    kept_row_.push_back(static_cast<std::int32_t>(r));
    kept_.insert(kept_.end(), force_.begin() + 12 * start[r], force_.begin() + 12 * start[r + 1]);
  }
}

/// Adds form_of(leaf) of all leaves that have one.
template <class FormOf>
void GridLevel::add_forms(std::size_t leaves, const FormOf& form_of) {
  in_shares(threads_, pattern_->rows(), [&](std::size_t begin, std::size_t end) {
    const auto from = static_cast<std::int32_t>(begin), to = static_cast<std::int32_t>(end);
    for (std::size_t leaf = 0; leaf < leaves; ++leaf) {
      const auto of = shares_of(leaf);
      if (std::none_of(of.begin(), of.end(), [&](const Share& s) { return s.row >= from && s.row < to; }))
        continue;
      if (const std::optional<LeafForm> form = form_of(leaf)) add(*form, leaf, from, to);
    }
  });
}

/// Adds to rows in [begin, end).
void GridLevel::add(const LeafForm& form, std::size_t leaf, std::int32_t begin, std::int32_t end) {
  const auto shares = [&](std::size_t corner) {
    const std::size_t at = 8 * leaf + corner;
    return std::span(shares_).subspan(first_[at], first_[at + 1] - first_[at]);
  };
  for (std::size_t i = 0; i < 8; ++i)
    for (const Share& row : shares(i)) {
      if (row.row < begin || row.row >= end) continue;
      for (std::size_t j = 0; j < 8; ++j)
        for (const Share& column : shares(j)) {
          const std::size_t k = pattern_->entry(row.row, column.column);
          const double w = static_cast<double>(row.weight) * static_cast<double>(column.weight);
          const LeafForm::Block& block = form.block(i, j);
          for (std::size_t r = 0; r < 4; ++r) {
            for (std::size_t t = 0; t < 3; ++t)
              force_[12 * k + 4 * t + r] += static_cast<float>(w * block[4 * r + t]);
            pressure_[4 * k + r] += static_cast<float>(w * block[4 * r + 3]);
          }
          for (std::size_t t = 0; t < 3; ++t) divergence_[4 * k + t] += static_cast<float>(w * block[12 + t]);
        }
    }
}

void GridLevel::invert_diagonal() {
  inverse_.assign(12 * map().size(), 0.0F);
  each_row([&](std::size_t i) {
    const float* columns = &force_[12 * own_entry(row(i), i)];
    Eigen::Matrix3d d;
    for (int r = 0; r < 3; ++r)
      for (int t = 0; t < 3; ++t) d(r, t) = static_cast<double>(columns[4 * t + r]);
    const Eigen::Matrix3d inverse = inverse_of_stiff(d);
    for (int r = 0; r < 3; ++r)
      for (int t = 0; t < 3; ++t)
        inverse_[12 * i + static_cast<std::size_t>(4 * t + r)] = static_cast<float>(inverse(r, t));
  });
}

void GridLevel::find_scales() {
  const auto dot = [this](std::size_t components) {
    return [this, components](const std::vector<float>& x, const std::vector<float>& y) {
      const auto term = [&](std::size_t i) { return static_cast<double>(x[i]) * static_cast<double>(y[i]); };
      return map().sum_all(eight_sums(components * rows(), term));
    };
  };
  std::vector<float> u = scattered<float>(map(), grid_width);
  const double largest = largest_eigenvalue(
      u,
      [this](std::span<float> x, std::span<float> y) {
        fill(x);
        each_row([&](std::size_t i) {
          simd::store_four(&y[grid_width * i], simd::times_blocks(row(i), force_.data(), x.data()));
        });
      },
      [this](std::span<const float> x, std::span<float> y) {
        each_row([&](std::size_t i) {
          simd::store_four(&y[grid_width * i], simd::times_three(&inverse_[12 * i], &x[grid_width * i]));
        });
      },
      dot(grid_width));
  const auto factor = static_cast<float>(1.0 / (grid_smoothing.damping * largest));
  for (float& v : inverse_) v *= factor;
  map().forward(inverse_, 12);
  schur_inverse_.assign(rows(), 0.0F);
  each_row([&](std::size_t i) {
    const simd::GridRow entries = row(i);
    double sum = 0.0;
    for (std::size_t k = entries.begin; k < entries.end; ++k) {
      const float* b = &divergence_[4 * k];
      const auto scaled = simd::times_three(&inverse_[12 * static_cast<std::size_t>(entries.column[k])], b);
      for (int r = 0; r < 3; ++r) sum += static_cast<double>(b[r]) * static_cast<double>(scaled[r]);
    }
    sum -= static_cast<double>(pressure_[4 * own_entry(entries, i) + 3]);
    if (sum > 0.0) schur_inverse_[i] = static_cast<float>(1.0 / sum);
  });
  std::vector<float> p = scattered<float>(map(), 1);
  solve_.largest = largest_eigenvalue(
      p, [this](std::span<float> x, std::span<float> y) { schur(x, y); },
      [this](std::span<const float> x, std::span<float> y) {
        each_row([&](std::size_t i) { y[i] = schur_inverse_[i] * x[i]; });
      },
      dot(1));
}

void GridLevel::lift(std::span<float> p, std::span<float> y) {
  fill_p_->start_forward(p), fill_p_->finish_forward(p);
  each_row([&](std::size_t i) {
    const simd::FourFloats force = simd::times_vectors(row(i), pressure_.data(), p.data());
    const float at[3] = {force[0], force[1], force[2]};
    simd::FourFloats lifted = simd::times_three(&inverse_[12 * i], at);
    lifted[3] = force[3];
    simd::store_four(&y[grid_width * i], lifted);
  });
}

void GridLevel::schur(std::span<float> p, std::span<float> q) {
  lift(p, moved_);
  fill(moved_);
  each_row([&](std::size_t i) {
    q[i] = simd::dot_vectors(row(i), divergence_.data(), moved_.data()) - moved_[grid_width * i + 3];
  });
}

void GridLevel::smooth(bool down, const PressureSteps& with, std::span<const float> b,
                       std::vector<float>& x) {
  if (down) {
    for (auto* v : {&x, &p_, &lifted_}) std::fill(v->begin(), v->end(), 0.0F);
  } else {
    each_row([&](std::size_t i) { p_[i] = x[grid_width * i + 3]; });
    lift(p_, lifted_);
  }
  const std::span<float> residual = solve_.residual();
  const std::size_t steps = grid_smoothing.weight.size();
  for (std::size_t s = 0; s < steps; ++s) {
    const bool from_zero = down && s == 0;
    const auto weight = static_cast<float>(grid_smoothing.weight[down ? steps - 1 - s : s]);
    // moved_ = t − ωÂ⁻¹Bᵀp with t = u + ωÂ⁻¹(b − A u).
    if (!from_zero) fill(x);
    each_row([&](std::size_t i) {
      simd::FourFloats left = simd::load_four(&b[grid_width * i]);
      if (!from_zero) left -= simd::times_blocks(row(i), force_.data(), x.data());
      const float at[3] = {left[0], left[1], left[2]};
      simd::store_four(&moved_[grid_width * i], simd::load_four(&x[grid_width * i]) +
                                                    weight * (simd::times_three(&inverse_[12 * i], at) -
                                                              simd::load_four(&lifted_[grid_width * i])));
    });
    fill(moved_);
    each_row([&](std::size_t i) {
      residual[i] = (simd::dot_vectors(row(i), divergence_.data(), moved_.data()) +
                     lifted_[grid_width * i + 3] - b[grid_width * i + 3]) /
                    weight;
      simd::store_four(&x[grid_width * i], simd::load_four(&moved_[grid_width * i]) +
                                               weight * simd::load_four(&lifted_[grid_width * i]));
    });
    const auto more = solve_.solve(with, schur_inverse_, threads_,
                                   [this](std::span<float> p, std::span<float> y) { schur(p, y); });
    each_row([&](std::size_t i) { p_[i] += more[i]; });
    lift(p_, lifted_);
    each_row([&](std::size_t i) {
      simd::FourFloats u =
          simd::load_four(&x[grid_width * i]) - weight * simd::load_four(&lifted_[grid_width * i]);
      u[3] = p_[i];
      simd::store_four(&x[grid_width * i], u);
    });
  }
}

void GridLevel::residual(std::span<const float> b, std::vector<float>& x, std::span<float> r) {
  fill(x);
  each_row([&](std::size_t i) {
    simd::store_four(&r[grid_width * i],
                     simd::load_four(&b[grid_width * i]) -
                         simd::times_blocks(row(i), force_.data(), x.data()) -
                         simd::times_vectors<grid_width>(row(i), pressure_.data(), x.data() + 3));
  });
}

std::size_t GridLevel::bytes() const noexcept {
  const auto size = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return pattern_->bytes() + size(first_) + size(shares_) + size(kept_row_) + size(kept_) + size(force_) +
         size(pressure_) + size(divergence_) + size(inverse_) + size(schur_inverse_) + size(p_) +
         size(lifted_) + size(moved_) + solve_.bytes();
}

}  // namespace kacanov
