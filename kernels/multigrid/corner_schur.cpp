// SPDX-License-Identifier: BSD-3-Clause
// The Schur complement of the pressures at corners, as a matrix.
#include "multigrid/corner_schur.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "cells/dispatch.hpp"
#include "cells/point.hpp"
#include "distributed/exchange.hpp"
#include "multigrid/largest_eigenvalue.hpp"
#include "operator/threads.hpp"
#include "simd/grid_rows.hpp"

namespace kacanov {
namespace {

/// What a node's displacement does to an entry of the pressures.
struct Part {
  std::int32_t entry;
  std::array<float, 3> change;
};

/// The same between ranks.
struct Change {
  std::int64_t node, row;
  std::array<float, 3> change;
};

/// Of all elements here, by node.
std::vector<std::vector<Part>> element_parts(const Body& body, const CornerPressures& pressures) {
  std::vector<std::vector<Part>> of_node(body.mesh.node_count());
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    if constexpr (E::dim == 3 && E::corner_dilatation)
      for (std::size_t e = 0; e < body.mesh.element_count(); ++e) {
        const std::int32_t* entry = &pressures.means().of_element[e * E::corners];
        if (entry[0] < 0) continue;
        const std::int32_t* node = body.mesh.connectivity.data() + e * E::nodes;
        elements::Nodal<E> x;
        for (std::size_t a = 0; a < E::nodes; ++a)
          for (std::size_t c = 0; c < 3; ++c)
            x[a * 3 + c] = body.mesh.coordinates[static_cast<std::size_t>(node[a]) * 3 + c];
        double sum[E::nodes][E::corners][3] = {};
        for (std::size_t q = 0; q < E::points; ++q) {
          const elements::Point<E> point(x, q);
          const auto share = elements::barycentric<E::dim>(E::point[q].data());
          for (std::size_t a = 0; a < E::nodes; ++a)
            for (std::size_t c = 0; c < E::corners; ++c)
              for (std::size_t k = 0; k < 3; ++k)
                sum[a][c][k] += point.volume * share[c] * point.gradient[a][k];
        }
        for (std::size_t a = 0; a < E::nodes; ++a)
          for (std::size_t c = 0; c < E::corners; ++c) {
            auto& parts = of_node[node[a]];
            auto at =
                std::find_if(parts.begin(), parts.end(), [&](const Part& p) { return p.entry == entry[c]; });
            if (at == parts.end()) at = parts.insert(at, {entry[c], {}});
            for (std::size_t k = 0; k < 3; ++k) at->change[k] += static_cast<float>(sum[a][c][k]);
          }
      }
  });
  return of_node;
}

}  // namespace

CornerSchur::CornerSchur(const MultigridBody& body, const CornerPressures& pressures, int threads)
    : nodes_(body.owned_nodes()), held_(body.held.begin(), body.held.end()), threads_(threads) {
  const IndexMap& map = *body.node_map;
  std::vector<std::vector<Part>> parts = element_parts(body.body, pressures);
  // Of nodes that other ranks own, these are told; theirs of ours come back.
  std::vector<std::vector<Change>> to(map.ranks);
  for (std::size_t n = nodes_; n < parts.size(); ++n)
    for (const Part& part : parts[n])
      to[map.owner(map.number(n))].push_back({map.number(n), pressures.number(part.entry), part.change});
  std::vector<std::vector<Entry>> told(map.ranks > 1 ? nodes_ : 0);
  for (const Change& change : exchange_all(to, map).entries)
    told[change.node - map.first()].push_back({static_cast<std::int32_t>(change.row), change.change});
  first_.push_back(0);
  for (std::size_t n = 0; n < nodes_; ++n) {
    for (const Part& part : parts[n])
      entries_.push_back({static_cast<std::int32_t>(pressures.number(part.entry)), part.change});
    std::vector<Part>().swap(parts[n]);
    for (std::size_t k = 0; !told.empty() && k < told[n].size(); ++k) {
      const Entry& more = told[n][k];
      const auto here = entries_.begin() + static_cast<std::ptrdiff_t>(first_.back());
      const auto same = std::find_if(here, entries_.end(), [&](const Entry& e) { return e.row == more.row; });
      if (same == entries_.end())
        entries_.push_back(more);
      else
        for (std::size_t c = 0; c < 3; ++c) same->change[c] += more.change[c];
    }
    first_.push_back(entries_.size());
  }
  entries_.shrink_to_fit();
  BlockSums<1> couplings;
  const std::int64_t first = body.node_map->sum_below(static_cast<std::int64_t>(pressures.rows()));
  for (std::size_t r = 0; r < pressures.rows(); ++r) {
    const auto row = first + static_cast<std::int64_t>(r);
    couplings.at(row, row);
  }
  for (std::size_t n = 0; n < nodes_; ++n)
    for (std::size_t i = first_[n]; i < first_[n + 1]; ++i)
      for (std::size_t j = first_[n]; j < first_[n + 1]; ++j)
        if (entries_[i].row <= entries_[j].row) couplings.at(entries_[i].row, entries_[j].row);
  level_.emplace(std::vector<Vector3>(pressures.rows()), std::move(couplings), *body.node_map, 1);
  fill_.emplace(level_->map(), 1);
}

void CornerSchur::build(std::span<const float> inverse, double factor, std::span<const double> compliance) {
  RigidLevel<1>& level = *level_;
  level.clear();
  BlockSums<1> outside;
  const std::int32_t rows = level.rows();
  std::vector<std::int32_t> local;
  std::vector<std::array<double, 3>> scaled;
  for (std::size_t n = 0; n < nodes_; ++n) {
    const auto of = std::span(entries_).subspan(first_[n], first_[n + 1] - first_[n]);
    const float* d = &inverse[6 * n];
    const double d00 = d[0], d01 = d[1], d02 = d[2], d11 = d[3], d12 = d[4], d22 = d[5];
    local.clear(), scaled.clear();
    for (const Entry& entry : of) {
      std::array<double, 3> b{};
      for (std::size_t k = 0; k < 3; ++k)
        if (held_[3 * n + k] == 0) b[k] = static_cast<double>(entry.change[k]);
      local.push_back(level.local(entry.row));
      scaled.push_back({factor * (d00 * b[0] + d01 * b[1] + d02 * b[2]),
                        factor * (d01 * b[0] + d11 * b[1] + d12 * b[2]),
                        factor * (d02 * b[0] + d12 * b[1] + d22 * b[2])});
    }
    for (std::size_t i = 0; i < of.size(); ++i)
      for (std::size_t j = 0; j < of.size(); ++j) {
        const std::int32_t a = local[i], b = local[j];
        const bool mine = a >= 0 && b >= 0 && (a < rows || b < rows);
        if (mine ? a > b : of[i].row > of[j].row) continue;
        double value = 0.0;
        for (std::size_t k = 0; k < 3; ++k)
          if (held_[3 * n + k] == 0) value += static_cast<double>(of[i].change[k]) * scaled[j][k];
        (mine ? level.block(a, b) : outside.at(of[i].row, of[j].row))[0] += value;
      }
  }
  for (std::int32_t r = 0; r < rows; ++r) level.block(r, r)[0] += compliance[r];
  level.complete(std::move(outside));
  take_rows();
  std::vector<double> start = scattered<double>(level.map(), 1);
  solve_.largest = largest_eigenvalue(
      start, [this](std::span<double> x, std::span<double> y) { multiply(x, y); },
      [this](std::span<const double> x, std::span<double> y) {
        for (std::size_t i = 0; i < inverse_.size(); ++i) y[i] = inverse_[i] * x[i];
      },
      [&](const std::vector<double>& x, const std::vector<double>& y) {
        double sum = 0.0;
        for (std::size_t i = 0; i < inverse_.size(); ++i) sum += x[i] * y[i];
        return level.map().sum_all(sum);
      });
}

void CornerSchur::take_rows() {
  const std::size_t rows = level_->owned_size();
  start_.assign(rows + 1, 0);
  const auto both = [&](const auto& visit) {
    level_->visit([&](std::int32_t i, std::int32_t j, const BlockSums<1>::Block& block) {
      visit(static_cast<std::size_t>(i), j, block[0]);
      if (j != i && static_cast<std::size_t>(j) < rows) visit(static_cast<std::size_t>(j), i, block[0]);
    });
  };
  both([&](std::size_t row, std::int32_t, double) { ++start_[row + 1]; });
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  std::vector<std::int64_t> next(start_.begin(), start_.end() - 1);
  column_.resize(start_.back());
  value_.resize(start_.back());
  inverse_.assign(rows, 0.0);
  both([&](std::size_t row, std::int32_t column, double value) {
    const std::int64_t k = next[row]++;
    column_[k] = column;
    value_[k] = static_cast<float>(value);
    if (static_cast<std::size_t>(column) == row && value > 0.0) inverse_[row] = 1.0 / value;
  });
}

void CornerSchur::multiply(std::span<double> p, std::span<double> y) {
  fill_->start_forward(p), fill_->finish_forward(p);
  in_shares(threads_, inverse_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      y[i] = simd::times_numbers(
          {column_.data(), static_cast<std::size_t>(start_[i]), static_cast<std::size_t>(start_[i + 1])},
          value_.data(), p.data());
  });
}

void CornerSchur::improve(const PressureSteps& steps, std::span<const double> q, std::span<double> p) {
  solve_.improve(steps, q, inverse_, p, [this](std::span<double> x, std::span<double> y) { multiply(x, y); });
}

std::size_t CornerSchur::bytes() const noexcept {
  const auto size = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return size(first_) + size(entries_) + size(inverse_) + size(start_) + size(column_) + size(value_) +
         level_->bytes();
}

}  // namespace kacanov
