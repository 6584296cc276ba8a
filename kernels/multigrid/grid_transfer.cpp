// SPDX-License-Identifier: BSD-3-Clause
// Transfer between points (nodes or rows of a finer grid) and the trilinear functions on a tree.
#include "multigrid/grid_transfer.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

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

GridTransfer::GridTransfer(const GridVertices& vertices, std::vector<Place> points, const Communicator& comm,
                           int threads)
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
void GridTransfer::prolong(std::span<const float> rows, std::size_t stride, std::size_t count,
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
void GridTransfer::restrict_to(std::span<const Real> x, std::size_t count, std::span<float> rows,
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

std::size_t GridTransfer::bytes() const noexcept {
  const auto size = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return size(first_share_) + size(shares_) + size(first_point_) + size(point_) + size(within_) +
         size(local_) + size(corner_);
}

template void GridTransfer::prolong(std::span<const float>, std::size_t, std::size_t, std::span<float>);
template void GridTransfer::prolong(std::span<const float>, std::size_t, std::size_t, std::span<double>);
template void GridTransfer::restrict_to(std::span<const float>, std::size_t, std::span<float>, std::size_t);
template void GridTransfer::restrict_to(std::span<const double>, std::size_t, std::span<float>, std::size_t);

}  // namespace kacanov
