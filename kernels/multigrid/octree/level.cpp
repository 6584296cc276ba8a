// SPDX-License-Identifier: BSD-3-Clause
// One level of displacements and pressures on an octree: matrix, smoother, and transfer to nodes and finer
// levels.
#include "multigrid/octree/level.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include "multigrid/cg.hpp"
#include "multigrid/cycle.hpp"
#include "operator/threads.hpp"
#include "simd/node_blocks.hpp"

namespace kacanov {
namespace {

/// Completes a map for reverse scatters: shared indices are those sent and received, the lower rank's own
/// ones first. Ghosts receive partial sums, which are not used.
void add_sums(IndexMap& map) {
  for (IndexMap::Neighbour& n : map.neighbours) {
    const auto& [first, second] =
        map.rank < n.rank ? std::tie(n.send, n.receive) : std::tie(n.receive, n.send);
    n.shared = first;
    n.shared.insert(n.shared.end(), second.begin(), second.end());
    map.shared.insert(map.shared.end(), n.shared.begin(), n.shared.end());
  }
  std::sort(map.shared.begin(), map.shared.end());
  map.shared.erase(std::unique(map.shared.begin(), map.shared.end()), map.shared.end());
}

}  // namespace

OctreeTransfer::OctreeTransfer(const OctreeVertices& vertices, std::vector<Place> points,
                               const Communicator& comm, int threads)
    : threads_(threads) {
  std::vector<std::int32_t> place(vertices.tree().cells().size(), -1), leaves;
  for (const Place& p : points)
    if (place[p.leaf] < 0) place[p.leaf] = 0, leaves.push_back(p.leaf);
  std::sort(leaves.begin(), leaves.end());
  for (std::size_t i = 0; i < leaves.size(); ++i) place[leaves[i]] = static_cast<std::int32_t>(i);
  first_point_.assign(leaves.size() + 1, 0);
  for (const Place& p : points) ++first_point_[static_cast<std::size_t>(place[p.leaf]) + 1];
  std::partial_sum(first_point_.begin(), first_point_.end(), first_point_.begin());
  std::vector<std::size_t> next(first_point_.begin(), first_point_.end() - 1);
  point_.resize(points.size());
  within_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t to = next[place[points[i].leaf]]++;
    point_[to] = static_cast<std::int32_t>(i);
    for (std::size_t k = 0; k < 3; ++k) within_[to][k] = static_cast<float>(points[i].within[k]);
  }

  const auto starts = vertices.starts();
  const std::int64_t begin = starts[comm.rank], end = starts[comm.rank + 1];
  std::vector<std::int64_t> ghosts;
  for (const std::int32_t leaf : leaves)
    for (std::size_t k = 0; k < 8; ++k)
      for (const auto& share : vertices.corner(leaf, k))
        if (share.row < begin || share.row >= end) ghosts.push_back(share.row);
  std::sort(ghosts.begin(), ghosts.end());
  ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());
  IndexMap map = make_index_map(comm, static_cast<std::int32_t>(end - begin), std::move(ghosts));
  add_sums(map);
  map_ = std::make_unique<const IndexMap>(std::move(map));
  first_share_.push_back(0);
  for (const std::int32_t leaf : leaves)
    for (std::size_t k = 0; k < 8; ++k) {
      for (const auto& share : vertices.corner(leaf, k)) {
        const bool mine = share.row >= begin && share.row < end;
        const auto ghost = std::lower_bound(map_->ghosts.begin(), map_->ghosts.end(), share.row);
        const std::int64_t local = mine ? share.row - begin : end - begin + (ghost - map_->ghosts.begin());
        shares_.push_back({static_cast<std::int32_t>(local), static_cast<float>(share.weight)});
      }
      first_share_.push_back(shares_.size());
    }
}

template <class Real>
void OctreeTransfer::prolong(std::span<const float> rows, std::size_t stride, std::size_t count,
                             std::span<Real> x) {
  const std::size_t leaves = first_point_.size() - 1, owned = map_->owned;
  local_.resize(map_->size() * count);
  for (std::size_t r = 0; r < owned; ++r)
    for (std::size_t c = 0; c < count; ++c) local_[r * count + c] = rows[r * stride + c];
  map_->forward(local_, static_cast<int>(count));
  in_shares(threads_, leaves, [&](std::size_t begin, std::size_t end) {
    std::array<simd::FourFloats, 8> value;  // of the corners
    for (std::size_t leaf = begin; leaf < end; ++leaf) {
      for (std::size_t k = 0; k < 8; ++k) {
        std::array<float, 4> sum{};
        for (const Share& share : shares(8 * leaf + k))
          for (std::size_t c = 0; c < count; ++c)
            sum[c] += share.weight * local_[static_cast<std::size_t>(share.row) * count + c];
        value[k] = simd::load_four(sum.data());
      }
      for (std::size_t i = first_point_[leaf]; i < first_point_[leaf + 1]; ++i) {
        const auto w = trilinear(within_[i]);
        simd::FourFloats sum{};
        for (std::size_t k = 0; k < 8; ++k) sum += value[k] * w[k];
        Real* to = &x[static_cast<std::size_t>(point_[i]) * count];
        for (std::size_t c = 0; c < count; ++c) to[c] += static_cast<Real>(sum[c]);
      }
    }
  });
}

template <class Real>
void OctreeTransfer::restrict_to(std::span<const Real> x, std::size_t count, std::span<float> rows,
                                 std::size_t stride) {
  const std::size_t leaves = first_point_.size() - 1, owned = map_->owned;
  corner_.resize(8 * leaves * count);
  in_shares(threads_, leaves, [&](std::size_t begin, std::size_t end) {
    for (std::size_t leaf = begin; leaf < end; ++leaf) {
      std::array<simd::FourFloats, 8> value{};
      for (std::size_t i = first_point_[leaf]; i < first_point_[leaf + 1]; ++i) {
        const auto w = trilinear(within_[i]);
        std::array<float, 4> at{};
        for (std::size_t c = 0; c < count; ++c)
          at[c] = static_cast<float>(x[static_cast<std::size_t>(point_[i]) * count + c]);
        const simd::FourFloats four = simd::load_four(at.data());
        for (std::size_t k = 0; k < 8; ++k) value[k] += four * w[k];
      }
      for (std::size_t k = 0; k < 8; ++k)
        for (std::size_t c = 0; c < count; ++c) corner_[(8 * leaf + k) * count + c] = value[k][c];
    }
  });
  local_.assign(map_->size() * count, 0.0F);
  for (std::size_t corner = 0; corner < 8 * leaves; ++corner)
    for (const Share& share : shares(corner))
      for (std::size_t c = 0; c < count; ++c)
        local_[static_cast<std::size_t>(share.row) * count + c] += share.weight * corner_[corner * count + c];
  map_->sum(local_, static_cast<int>(count));
  for (std::size_t r = 0; r < owned; ++r)
    for (std::size_t c = 0; c < count; ++c) rows[r * stride + c] = local_[r * count + c];
}

std::size_t OctreeTransfer::bytes() const noexcept {
  const auto size = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return size(first_share_) + size(shares_) + size(first_point_) + size(point_) + size(within_) +
         size(local_) + size(corner_);
}

template void OctreeTransfer::prolong(std::span<const float>, std::size_t, std::size_t, std::span<float>);
template void OctreeTransfer::prolong(std::span<const float>, std::size_t, std::size_t, std::span<double>);
template void OctreeTransfer::restrict_to(std::span<const float>, std::size_t, std::span<float>, std::size_t);
template void OctreeTransfer::restrict_to(std::span<const double>, std::size_t, std::span<float>,
                                          std::size_t);

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

OctreeLevel::OctreeLevel(const OctreeVertices& vertices, const OctreeLeaves& leaves, const Communicator& comm,
                         int threads)
    : threads_(threads) {
  // Element matrices: a leaf's corners, or the vertices that constrain them.
  std::vector<std::int64_t> number(vertices.starts().back());
  std::iota(number.begin(), number.end(), 0);
  std::vector<std::size_t> first{0};
  std::vector<std::int32_t> index;
  for (const std::int32_t leaf : leaves.cell) {
    for (std::size_t k = 0; k < 8; ++k)
      for (const OctreeVertices::Share& share : vertices.corner(leaf, k)) index.push_back(share.row);
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
      for (const OctreeVertices::Share& share : vertices.corner(leaf, k))
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

void OctreeLevel::setup(const Octree& tree, const OctreeLeaves& leaves, const LevelMoments& moments) {
  force_.assign(12 * pattern_->entries(), 0.0F);
  for (auto* v : {&pressure_, &divergence_}) v->assign(4 * pattern_->entries(), 0.0F);
  add_forms(leaves.cell.size(), [&](std::size_t leaf) {
    return std::optional<CellStiffness>(std::in_place, moments.leaf[leaf], nullptr,
                                        tree.length(tree.cells()[leaves.cell[leaf]]));
  });
  pattern_->complete(force_, 12), pattern_->complete(pressure_, 4), pattern_->complete(divergence_, 4);
  kept_row_.clear(), kept_.clear();
  update(tree, leaves, moments);
}

void OctreeLevel::update(const Octree& tree, const OctreeLeaves& leaves, const LevelStiffness& stiffness) {
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
  const CellMoments no_moments;
  add_forms(leaves.cell.size(), [&](std::size_t leaf) {
    std::optional<CellStiffness> form;
    if (const std::int32_t which = stiffness.stiff[leaf]; which >= 0)
      form.emplace(no_moments, &stiffness.stiffness[which], tree.length(tree.cells()[leaves.cell[leaf]]));
    return form;
  });
  pattern_->complete(force_, 12);
  invert_diagonal();
  find_scales();
}

/// Stores this rank's rows to which this or another rank may add stiffnesses.
void OctreeLevel::keep_rows(const LevelStiffness& stiffness) {
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
void OctreeLevel::add_forms(std::size_t leaves, const FormOf& form_of) {
  in_shares(threads_, pattern_->rows(), [&](std::size_t begin, std::size_t end) {
    const auto from = static_cast<std::int32_t>(begin), to = static_cast<std::int32_t>(end);
    for (std::size_t leaf = 0; leaf < leaves; ++leaf) {
      const auto of = shares_of(leaf);
      if (std::none_of(of.begin(), of.end(), [&](const Share& s) { return s.row >= from && s.row < to; }))
        continue;
      if (const std::optional<CellStiffness> form = form_of(leaf)) add(*form, leaf, from, to);
    }
  });
}

/// Adds to rows in [begin, end).
void OctreeLevel::add(const CellStiffness& form, std::size_t leaf, std::int32_t begin, std::int32_t end) {
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
          const CellStiffness::Block& block = form.block(i, j);
          for (std::size_t r = 0; r < 4; ++r) {
            for (std::size_t t = 0; t < 3; ++t)
              force_[12 * k + 4 * t + r] += static_cast<float>(w * block[4 * r + t]);
            pressure_[4 * k + r] += static_cast<float>(w * block[4 * r + 3]);
          }
          for (std::size_t t = 0; t < 3; ++t) divergence_[4 * k + t] += static_cast<float>(w * block[12 + t]);
        }
    }
}

void OctreeLevel::invert_diagonal() {
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

void OctreeLevel::find_scales() {
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

void OctreeLevel::lift(std::span<float> p, std::span<float> y) {
  fill_p_->start_forward(p), fill_p_->finish_forward(p);
  each_row([&](std::size_t i) {
    const simd::FourFloats force = simd::times_vectors(row(i), pressure_.data(), p.data());
    const float at[3] = {force[0], force[1], force[2]};
    simd::FourFloats lifted = simd::times_three(&inverse_[12 * i], at);
    lifted[3] = force[3];
    simd::store_four(&y[grid_width * i], lifted);
  });
}

void OctreeLevel::schur(std::span<float> p, std::span<float> q) {
  lift(p, moved_);
  fill(moved_);
  each_row([&](std::size_t i) {
    q[i] = simd::dot_vectors(row(i), divergence_.data(), moved_.data()) - moved_[grid_width * i + 3];
  });
}

void OctreeLevel::smooth(bool down, const PressureSteps& with, std::span<const float> b,
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

void OctreeLevel::residual(std::span<const float> b, std::vector<float>& x, std::span<float> r) {
  fill(x);
  each_row([&](std::size_t i) {
    simd::store_four(&r[grid_width * i],
                     simd::load_four(&b[grid_width * i]) -
                         simd::times_blocks(row(i), force_.data(), x.data()) -
                         simd::times_vectors<grid_width>(row(i), pressure_.data(), x.data() + 3));
  });
}

std::size_t OctreeLevel::bytes() const noexcept {
  const auto size = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return pattern_->bytes() + size(first_) + size(shares_) + size(kept_row_) + size(kept_) + size(force_) +
         size(pressure_) + size(divergence_) + size(inverse_) + size(schur_inverse_) + size(p_) +
         size(lifted_) + size(moved_) + solve_.bytes();
}

}  // namespace kacanov
