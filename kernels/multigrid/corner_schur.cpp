// SPDX-License-Identifier: BSD-3-Clause
// The Schur complement of the pressures at corners, as a matrix.
#include "multigrid/corner_schur.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "cells/dispatch.hpp"
#include "cells/straight.hpp"
#include "multigrid/largest_eigenvalue.hpp"
#include "multigrid/sums.hpp"
#include "operator/threads.hpp"
#include "simd/grid_rows.hpp"

namespace kacanov {
namespace {

/// Nodes, and entries of the pressures, of all elements here that average.
struct AveragingElements {
  std::vector<std::size_t> element, first_node{0}, first_entry{0};
  std::vector<std::int32_t> node, entry;
};

AveragingElements averaging_elements(const Body& body, const CornerPressures& pressures) {
  AveragingElements all;
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    if constexpr (E::dim == 3 && E::corner_dilatation) {
      const std::size_t most = body.mesh.element_count();
      for (auto* v : {&all.element, &all.first_node, &all.first_entry}) v->reserve(most + 1);
      all.node.reserve(most * E::nodes), all.entry.reserve(most * E::corners);
      for (std::size_t e = 0; e < most; ++e) {
        const std::int32_t* entry = &pressures.means().of_element[e * E::corners];
        if (entry[0] < 0) continue;
        const std::int32_t* node = body.mesh.connectivity.data() + e * E::nodes;
        all.element.push_back(e);
        all.node.insert(all.node.end(), node, node + E::nodes);
        all.entry.insert(all.entry.end(), entry, entry + E::corners);
        std::sort(all.entry.end() - E::corners, all.entry.end());
        all.entry.erase(std::unique(all.entry.end() - E::corners, all.entry.end()), all.entry.end());
        all.first_node.push_back(all.node.size()), all.first_entry.push_back(all.entry.size());
      }
    }
  });
  return all;
}

/// Nodes in the middle of an edge whose end is one of the first `nodes`, too: the end moves all rows that the
/// middle does, and couples them.
std::vector<char> enclosed_nodes(const Body& body, const CornerPressures& pressures, std::size_t nodes) {
  std::vector<char> enclosed(body.mesh.node_count(), 0);
  const Cell& type = cell(body.mesh.type);
  const auto here = [&](std::int32_t node) { return static_cast<std::size_t>(node) < nodes; };
  for (std::size_t e = 0; type.order == 2 && e < body.mesh.element_count(); ++e) {
    if (pressures.means().of_element[e * static_cast<std::size_t>(type.corners)] < 0) continue;
    const std::int32_t* node = body.mesh.connectivity.data() + e * static_cast<std::size_t>(type.nodes);
    for (const CellEdge& edge : type.edges)
      if (here(node[edge.a]) || here(node[edge.b])) enclosed[node[edge.middle]] = 1;
  }
  return enclosed;
}

}  // namespace

CornerSchur::CornerSchur(const MultigridBody& body, const CornerPressures& pressures, int threads)
    : threads_(threads), nodes_(body.owned_nodes()) {
  take_changes(body, pressures);
  const std::size_t rows = pattern_->rows();
  fill_.emplace(pattern_->columns(), 1);
  fill_single_.emplace(pattern_->columns(), 1);
  solve_.resize(pattern_->owned_rows(), size());
  image_.resize(pattern_->owned_rows());
  std::vector<std::int32_t> row_of(size(), -1);
  for (std::size_t r = 0; r < rows; ++r)
    row_of[pattern_->column(pattern_->number(r))] = static_cast<std::int32_t>(r);
  first_node_.assign(rows + 1, 0);
  for (const std::int32_t row : row_) ++first_node_[static_cast<std::size_t>(row_of[row]) + 1];
  std::partial_sum(first_node_.begin(), first_node_.end(), first_node_.begin());
  std::vector<std::int64_t> next(first_node_.begin(), first_node_.end() - 1);
  node_.resize(row_.size());
  for (std::size_t n = 0; n < nodes_; ++n)
    for (std::int64_t k = first_[n]; k < first_[n + 1]; ++k)
      node_[next[row_of[row_[k]]]++] = static_cast<std::int32_t>(n);
}

/// B, and S's pattern by it.
void CornerSchur::take_changes(const MultigridBody& body, const CornerPressures& pressures) {
  const IndexMap& map = *body.node_map;
  const std::vector<std::int64_t> starts = number_owned(static_cast<std::int64_t>(pressures.rows()), map);
  std::vector<std::int64_t> number;
  {
    std::vector<std::int64_t> node_number(body.nodes()), entry_number(pressures.means().size());
    for (std::size_t n = 0; n < node_number.size(); ++n) node_number[n] = map.number(n);
    for (std::size_t k = 0; k < entry_number.size(); ++k) entry_number[k] = pressures.number(k);
    AveragingElements elements = averaging_elements(body.body, pressures);
    SummedPattern b({map.starts, node_number, elements.node, elements.first_node},
                    {starts, entry_number, elements.entry, elements.first_entry}, map, threads_);
    change_.assign(3 * b.entries(), 0.0F);
    std::vector<std::int32_t> row, column;
    for (const std::int64_t n : node_number) row.push_back(b.row(n));
    for (const std::int64_t n : entry_number) column.push_back(b.column(n));
    elements::dispatch(body.body.mesh.type, [&]<class E>(E) {
      if constexpr (E::dim == 3 && E::corner_dilatation)
        for (std::size_t m = 0; m < elements.element.size(); ++m) {
          const std::size_t e = elements.element[m];
          const std::int32_t* node = body.body.mesh.connectivity.data() + e * E::nodes;
          const std::int32_t* corner_entry = &pressures.means().of_element[e * E::corners];
          const auto sum =
              elements::corner_integrals<E>(elements::coordinates_of<E>(body.body.mesh, e)).change;
          // Corners of one patch have an entry together.
          for (std::size_t j = elements.first_entry[m]; j < elements.first_entry[m + 1]; ++j)
            for (std::size_t a = 0; a < E::nodes; ++a) {
              const std::size_t k = b.entry(row[node[a]], column[elements.entry[j]]);
              for (std::size_t c = 0; c < E::corners; ++c) {
                if (corner_entry[c] != elements.entry[j]) continue;
                for (std::size_t i = 0; i < 3; ++i) change_[3 * k + i] += static_cast<float>(sum[a][c][i]);
              }
            }
        }
    });
    b.complete(change_, 3);
    const auto start = b.start().first(nodes_ + 1);
    first_.assign(start.begin(), start.end());
    for (std::size_t c = 0; c < b.columns().size(); ++c) number.push_back(b.columns().number(c));
    row_ = std::move(b).take_columns();
    // Of this rank's nodes, which come first.
    row_.resize(static_cast<std::size_t>(first_.back()));
    change_.resize(3 * row_.size());
    for (std::size_t n = 0; n < nodes_; ++n)
      for (std::size_t i = 0; i < 3; ++i)
        for (std::int64_t k = first_[n]; body.held[3 * n + i] != 0 && k < first_[n + 1]; ++k)
          change_[3 * k + i] = 0.0F;
  }
  std::vector<std::size_t> first_coupling{0};
  std::vector<std::int32_t> coupling;
  const std::vector<char> enclosed = enclosed_nodes(body.body, pressures, nodes_);
  for (std::size_t n = 0; n < nodes_; ++n) {
    if (enclosed[n] != 0) continue;
    coupling.insert(coupling.end(), row_.begin() + first_[n], row_.begin() + first_[n + 1]);
    first_coupling.push_back(coupling.size());
  }
  // A row for every pressure, even one that no node moves.
  for (std::int64_t n = starts[map.rank]; n < starts[map.rank + 1]; ++n) {
    coupling.push_back(static_cast<std::int32_t>(number.size()));
    number.push_back(n);
    first_coupling.push_back(coupling.size());
  }
  const MatrixSide side{starts, number, coupling, first_coupling};
  pattern_.emplace(side, side, map, threads_);
  for (std::int32_t& row : row_) row = pattern_->column(number[row]);
}

void CornerSchur::build(std::span<const float> inverse, double factor, std::span<const double> compliance) {
  value_.resize(pattern_->entries());
  in_shares(threads_, pattern_->rows(),
            [&](std::size_t begin, std::size_t end) { sum_rows(inverse, factor, begin, end); });
  pattern_->complete(value_, 1);
  const std::size_t rows = pattern_->owned_rows();
  inverse_.assign(rows, 0.0F);
  for (std::size_t r = 0; r < rows; ++r) {
    const auto row = static_cast<std::int32_t>(r);
    float& diagonal = value_[pattern_->entry(row, row)];
    diagonal += static_cast<float>(compliance[r]);
    if (diagonal > 0.0F) inverse_[r] = 1.0F / diagonal;
  }
  std::vector<float> start = scattered<float>(pattern_->columns(), 1);
  solve_.largest = largest_eigenvalue(
      start, [this](std::span<float> x, std::span<float> y) { times(*fill_single_, x, y); },
      [this](std::span<const float> x, std::span<float> y) {
        each_in_shares(threads_, inverse_.size(), [&](std::size_t i) { y[i] = inverse_[i] * x[i]; });
      },
      [&](const std::vector<float>& x, const std::vector<float>& y) {
        return pattern_->columns().sum_all(eight_sums(inverse_.size(), [&](std::size_t i) {
          return static_cast<double>(x[i]) * static_cast<double>(y[i]);
        }));
      });
}

/// Row by row: what this rank's nodes give.
void CornerSchur::sum_rows(std::span<const float> inverse, double factor, std::size_t begin,
                           std::size_t end) {
  std::vector<double> sum(pattern_->columns().size(), 0.0);
  for (std::size_t r = begin; r < end; ++r) {
    const std::int32_t own = pattern_->column(pattern_->number(r));
    for (std::int64_t k = first_node_[r]; k < first_node_[r + 1]; ++k) {
      const std::size_t n = node_[k];
      std::int64_t at = first_[n];
      while (row_[at] != own) ++at;
      const auto change = [&](std::int64_t j, std::size_t i) {
        return static_cast<double>(change_[3 * j + i]);
      };
      const double b[3] = {factor * change(at, 0), factor * change(at, 1), factor * change(at, 2)};
      double d[6];
      for (std::size_t i = 0; i < 6; ++i) d[i] = static_cast<double>(inverse[6 * n + i]);
      const double scaled[3] = {d[0] * b[0] + d[1] * b[1] + d[2] * b[2],
                                d[1] * b[0] + d[3] * b[1] + d[4] * b[2],
                                d[2] * b[0] + d[4] * b[1] + d[5] * b[2]};
      for (std::int64_t j = first_[n]; j < first_[n + 1]; ++j)
        sum[row_[j]] += scaled[0] * change(j, 0) + scaled[1] * change(j, 1) + scaled[2] * change(j, 2);
    }
    for (std::int64_t k = pattern_->start()[r]; k < pattern_->start()[r + 1]; ++k) {
      double& from = sum[pattern_->column()[k]];
      value_[k] = static_cast<float>(from), from = 0.0;
    }
  }
}

template <class Real>
void CornerSchur::times(Scatterer<Real>& fill, std::span<Real> p, std::span<Real> y) {
  fill.start_forward(p), fill.finish_forward(p);
  const auto start = pattern_->start();
  each_in_shares(threads_, inverse_.size(), [&](std::size_t i) {
    y[i] = simd::times_numbers({pattern_->column().data(), static_cast<std::size_t>(start[i]),
                                static_cast<std::size_t>(start[i + 1])},
                               value_.data(), p.data());
  });
}

void CornerSchur::multiply(std::span<double> p, std::span<double> y) { times(*fill_, p, y); }

void CornerSchur::improve(bool from_zero, const PressureSteps& steps, std::span<const double> q,
                          std::span<double> p) {
  const std::span<float> residual = solve_.residual();
  if (!from_zero) multiply(p, image_);
  each_in_shares(threads_, q.size(), [&](std::size_t i) {
    residual[i] = static_cast<float>(from_zero ? q[i] : q[i] - image_[i]);
  });
  const auto more = solve_.solve(steps, inverse_, threads_, [this](std::span<float> x, std::span<float> y) {
    times(*fill_single_, x, y);
  });
  each_in_shares(threads_, q.size(), [&](std::size_t i) { p[i] += static_cast<double>(more[i]); });
}

std::size_t CornerSchur::bytes() const noexcept {
  const auto size = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return size(first_) + size(row_) + size(change_) + size(first_node_) + size(node_) + size(inverse_) +
         size(value_) + size(image_) + pattern_->bytes() + solve_.bytes();
}

}  // namespace kacanov
