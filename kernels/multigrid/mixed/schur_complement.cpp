// SPDX-License-Identifier: BSD-3-Clause
// The divergence operator and the assembled Schur complement of the pressures.
#include "multigrid/mixed/schur_complement.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "cells/elements.hpp"
#include "cells/straight.hpp"
#include "multigrid/cg.hpp"
#include "multigrid/cycle.hpp"
#include "multigrid/sparsity_pattern.hpp"
#include "operator/threads.hpp"
#include "simd/node_blocks.hpp"

namespace kacanov {
namespace {

/// Averaging elements on this rank with a wanted node: their wanted nodes and pressure entries.
struct AveragingElements {
  std::vector<std::size_t> element, first_node{0}, first_entry{0};
  std::vector<std::int32_t> node, entry;
};

template <class E>
AveragingElements averaging_elements(const Body& body, const PressureRows& pressures,
                                     std::span<const char> wanted) {
  AveragingElements all;
  for (std::size_t e = 0; e < body.mesh.element_count(); ++e) {
    const std::int32_t* entry = &pressures.means().of_element[e * E::corners];
    if (entry[0] < 0) continue;
    const std::size_t before = all.node.size();
    for (std::size_t a = 0; a < E::nodes; ++a)
      if (const std::int32_t node = body.mesh.connectivity[e * E::nodes + a]; wanted[node] != 0)
        all.node.push_back(node);
    if (all.node.size() == before) continue;
    all.element.push_back(e);
    all.entry.insert(all.entry.end(), entry, entry + E::corners);
    std::sort(all.entry.end() - E::corners, all.entry.end());
    // Corners of one patch share an entry.
    all.entry.erase(std::unique(all.entry.end() - E::corners, all.entry.end()), all.entry.end());
    all.first_node.push_back(all.node.size()), all.first_entry.push_back(all.entry.size());
  }
  return all;
}

/// An element's corners, in the order of their columns.
template <class E>
std::array<std::size_t, E::corners> by_column(const std::int32_t* entry,
                                              std::span<const std::int32_t> column) {
  std::array<std::size_t, E::corners> corners;
  std::iota(corners.begin(), corners.end(), std::size_t{0});
  std::sort(corners.begin(), corners.end(),
            [&](std::size_t c, std::size_t d) { return column[entry[c]] < column[entry[d]]; });
  return corners;
}

/// 3 values per entry of the pattern, summed over the elements on this rank.
template <class E>
std::vector<float> summed_changes(const SparsityPattern& b, const AveragingElements& elements,
                                  const Body& body, const PressureRows& pressures,
                                  std::span<const std::int32_t> row, std::span<const std::int32_t> column) {
  std::vector<float> change(3 * b.entries(), 0.0F);
  for (const std::size_t e : elements.element) {
    const std::int32_t* node = body.mesh.connectivity.data() + e * E::nodes;
    const std::int32_t* entry = &pressures.means().of_element[e * E::corners];
    const auto corners = by_column<E>(entry, column);
    const auto sum = elements::corner_integrals<E>(elements::coordinates_of<E>(body.mesh, e)).change;
    for (std::size_t a = 0; a < E::nodes; ++a) {
      if (row[node[a]] < 0) continue;
      auto k = static_cast<std::size_t>(b.start()[row[node[a]]]);
      for (const std::size_t c : corners) {
        while (b.column()[k] != column[entry[c]]) ++k;
        for (std::size_t i = 0; i < 3; ++i) change[3 * k + i] += static_cast<float>(sum[a][c][i]);
      }
    }
  }
  return change;
}

template <class E>
DivergenceOperator changes_of(const MultigridBody& body, const PressureRows& pressures,
                              std::span<const char> wanted, bool rows_alone, int threads) {
  const IndexMap& map = *body.node_map;
  std::vector<std::int64_t> node_number(body.nodes()), entry_number(pressures.means().size());
  for (std::size_t n = 0; n < node_number.size(); ++n) node_number[n] = map.number(n);
  for (std::size_t k = 0; k < entry_number.size(); ++k) entry_number[k] = pressures.number(k);
  const AveragingElements elements = averaging_elements<E>(body.body, pressures, wanted);
  SparsityPattern b({map.starts, node_number, elements.node, elements.first_node},
                    {pressures.starts(), entry_number, elements.entry, elements.first_entry}, map, threads);
  DivergenceOperator all;
  const auto start = b.start().first(body.owned_nodes() + 1);
  all.first.assign(start.begin(), start.end());
  if (!rows_alone) {
    std::vector<std::int32_t> row(body.nodes(), -1), column;
    for (std::size_t n = 0; n < row.size(); ++n)
      if (wanted[n] != 0) row[n] = b.row(node_number[n]);
    for (const std::int64_t n : entry_number) column.push_back(b.column(n));
    all.change = summed_changes<E>(b, elements, body.body, pressures, row, column);
    b.complete(all.change, 3);
    all.change.resize(3 * static_cast<std::size_t>(all.first.back()));
    for (std::size_t n = 0; n < body.owned_nodes(); ++n)
      for (std::size_t i = 0; i < 3; ++i)
        for (std::int64_t k = all.first[n]; body.held[3 * n + i] != 0 && k < all.first[n + 1]; ++k)
          all.change[3 * k + i] = 0.0F;
  }
  for (std::size_t c = 0; c < b.columns().size(); ++c) all.number.push_back(b.columns().number(c));
  all.row = std::move(b).take_columns();
  all.row.resize(static_cast<std::size_t>(all.first.back()));  // of this rank's nodes, which come first
  return all;
}

DivergenceOperator changes_of(const MultigridBody& body, const PressureRows& pressures,
                              std::span<const char> wanted, bool rows_alone, int threads) {
  DivergenceOperator all;
  elements::dispatch(body.body.mesh.type, [&]<class E>(E) {
    if constexpr (E::dim == 3) all = changes_of<E>(body, pressures, wanted, rows_alone, threads);
  });
  return all;
}

}  // namespace

DivergenceOperator divergence_operator(const MultigridBody& body, const PressureRows& pressures,
                                       std::span<const char> wanted, int threads) {
  return changes_of(body, pressures, wanted, false, threads);
}

DivergenceOperator divergence_pattern(const MultigridBody& body, const PressureRows& pressures,
                                      std::span<const char> wanted, int threads) {
  return changes_of(body, pressures, wanted, true, threads);
}

namespace {

constexpr std::int64_t most_parts = 8;

/// The ranks that own the body's nodes.
std::vector<int> owners(const MultigridBody& body) {
  std::vector<int> owner(body.nodes(), body.node_map->rank);
  for (std::size_t n = body.owned_nodes(); n < owner.size(); ++n)
    owner[n] = body.node_map->owner(body.node_map->number(n));
  return owner;
}

/// All nodes except mid-side nodes of an edge with an end that the same rank owns: the end contributes to all
/// rows of the mid-side node, and couples them.
std::vector<char> coupling_nodes(const MultigridBody& body, const PressureRows& pressures) {
  std::vector<char> coupling(body.nodes(), 1);
  const auto& mesh = body.body.mesh;
  const Cell& type = cell(mesh.type);
  if (type.order != 2) return coupling;
  const std::vector<int> owner = owners(body);
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    if (pressures.means().of_element[e * static_cast<std::size_t>(type.corners)] < 0) continue;
    const std::int32_t* node = mesh.connectivity.data() + e * static_cast<std::size_t>(type.nodes);
    for (const CellEdge& edge : type.edges) {
      const std::int32_t middle = node[edge.middle];
      for (const std::int32_t end : {node[edge.a], node[edge.b]})
        if (owner[end] == owner[middle]) coupling[middle] = 0;
    }
  }
  return coupling;
}

/// Assigns each of the body's nodes to one of `parts`, the same on all ranks, with about equal numbers per
/// rank.
std::vector<char> parts_of(const MultigridBody& body, std::int64_t parts) {
  const IndexMap& map = *body.node_map;
  const std::vector<int> owner = owners(body);
  std::vector<char> part(body.nodes());
  for (std::size_t n = 0; n < part.size(); ++n) {
    const auto rank = static_cast<std::size_t>(owner[n]);
    const std::int64_t nodes = map.starts[rank + 1] - map.starts[rank];
    part[n] = static_cast<char>(parts * (map.number(n) - map.starts[rank]) / nodes);
  }
  return part;
}

/// A node that changes a row, and the index of the row among the node's rows.
struct Use {
  std::int32_t node, place;
};

}  // namespace

SchurComplement::SchurComplement(const MultigridBody& body, const PressureRows& pressures, int threads,
                                 std::int64_t nodes_at_once)
    : body_(&body), pressures_(&pressures), threads_(threads), nodes_at_once_(nodes_at_once) {
  const IndexMap& map = *body.node_map;
  const std::span<const std::int64_t> starts = pressures.starts();
  DivergenceOperator b = divergence_pattern(body, pressures, coupling_nodes(body, pressures), threads);
  std::vector<std::size_t> first_coupling(b.first.begin(), b.first.end());
  // Every pressure has a row, even if no node moves it.
  for (std::int64_t n = starts[map.rank]; n < starts[map.rank + 1]; ++n) {
    b.row.push_back(static_cast<std::int32_t>(b.number.size()));
    b.number.push_back(n);
    first_coupling.push_back(b.row.size());
  }
  const MatrixSide side{starts, b.number, b.row, first_coupling};
  pattern_.emplace(side, side, map, threads_);
  fill_.emplace(pattern_->columns(), 1);
  fill_single_.emplace(pattern_->columns(), 1);
  solve_.resize(pattern_->owned_rows(), size());
}

void SchurComplement::setup(std::span<const float> inverse, double factor) {
  factor_ = factor;
  value_.assign(pattern_->entries(), 0.0F);
  const IndexMap& map = *body_->node_map;
  const std::int64_t parts =
      std::clamp<std::int64_t>(map.total() / (map.ranks * nodes_at_once_), 1, most_parts);
  const std::vector<char> part = parts_of(*body_, parts);
  std::vector<char> wanted(part.size());
  for (char p = 0; p < parts; ++p) {
    for (std::size_t n = 0; n < part.size(); ++n) wanted[n] = part[n] == p ? 1 : 0;
    add(divergence_operator(*body_, *pressures_, wanted, threads_), inverse, {});
  }
  pattern_->complete(value_, 1);
  const std::span<const double> compliance = pressures_->compliance();
  for (std::size_t r = 0; r < compliance.size(); ++r) {
    const auto row = static_cast<std::int32_t>(r);
    value_[pattern_->entry(row, row)] += static_cast<float>(compliance[r]);
  }
  take_diagonal();
}

void SchurComplement::update(std::span<const float> before, std::span<const float> inverse) {
  std::vector<char> changed(body_->nodes(), 0);
  for (std::size_t n = 0; n < changed.size(); ++n)
    if (!std::equal(&before[6 * n], &before[6 * n] + 6, &inverse[6 * n])) changed[n] = 1;
  if (!body_->node_map->any(std::find(changed.begin(), changed.end(), 1) != changed.end())) return;
  // For other ranks' rows only the changes are sent.
  std::fill(value_.begin() + pattern_->start()[pattern_->owned_rows()], value_.end(), 0.0F);
  add(divergence_operator(*body_, *pressures_, changed, threads_), inverse, before);
  pattern_->complete(value_, 1);
  take_diagonal();
}

/// Adds the contribution of these nodes, row by row.
void SchurComplement::add(const DivergenceOperator& b, std::span<const float> inverse,
                          std::span<const float> before) {
  std::vector<std::int32_t> row, column;
  for (const std::int64_t n : b.number) {
    row.push_back(pattern_->row(n));
    column.push_back(pattern_->column(n));
  }
  std::vector<std::int64_t> first_use(pattern_->rows() + 1, 0);
  for (const std::int32_t k : b.row) ++first_use[static_cast<std::size_t>(row[k]) + 1];
  std::partial_sum(first_use.begin(), first_use.end(), first_use.begin());
  std::vector<std::int64_t> next(first_use.begin(), first_use.end() - 1);
  std::vector<Use> use(b.row.size());
  for (std::size_t n = 0; n + 1 < b.first.size(); ++n)
    for (std::int64_t k = b.first[n]; k < b.first[n + 1]; ++k)
      use[next[row[b.row[k]]]++] = {static_cast<std::int32_t>(n), static_cast<std::int32_t>(k - b.first[n])};
  in_shares(threads_, pattern_->rows(), [&](std::size_t begin, std::size_t end) {
    std::vector<double> sum(size(), 0.0);
    for (std::size_t r = begin; r < end; ++r) {
      for (std::int64_t u = first_use[r]; u < first_use[r + 1]; ++u) {
        const std::size_t n = use[u].node;
        const auto change = [&](std::int64_t k, std::size_t i) {
          return static_cast<double>(b.change[3 * k + i]);
        };
        const std::int64_t own = b.first[n] + use[u].place;
        const double mine[3] = {factor_ * change(own, 0), factor_ * change(own, 1), factor_ * change(own, 2)};
        double d[6];
        for (std::size_t i = 0; i < 6; ++i) {
          d[i] = static_cast<double>(inverse[6 * n + i]);
          if (!before.empty()) d[i] -= static_cast<double>(before[6 * n + i]);
        }
        const double scaled[3] = {d[0] * mine[0] + d[1] * mine[1] + d[2] * mine[2],
                                  d[1] * mine[0] + d[3] * mine[1] + d[4] * mine[2],
                                  d[2] * mine[0] + d[4] * mine[1] + d[5] * mine[2]};
        for (std::int64_t k = b.first[n]; k < b.first[n + 1]; ++k)
          sum[column[b.row[k]]] +=
              scaled[0] * change(k, 0) + scaled[1] * change(k, 1) + scaled[2] * change(k, 2);
      }
      if (first_use[r] == first_use[r + 1]) continue;
      for (std::int64_t k = pattern_->start()[r]; k < pattern_->start()[r + 1]; ++k) {
        double& from = sum[pattern_->column()[k]];
        value_[k] += static_cast<float>(from), from = 0.0;
      }
    }
  });
}

void SchurComplement::take_diagonal() {
  inverse_.assign(pattern_->owned_rows(), 0.0F);
  for (std::size_t r = 0; r < inverse_.size(); ++r) {
    const auto row = static_cast<std::int32_t>(r);
    const float diagonal = value_[pattern_->entry(row, row)];
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

template <class Real>
void SchurComplement::times(Scatterer<Real>& fill, std::span<Real> p, std::span<Real> y) {
  fill.start_forward(p), fill.finish_forward(p);
  const auto start = pattern_->start();
  each_in_shares(threads_, inverse_.size(), [&](std::size_t i) {
    y[i] = simd::times_numbers({pattern_->column().data(), static_cast<std::size_t>(start[i]),
                                static_cast<std::size_t>(start[i + 1])},
                               value_.data(), p.data());
  });
}

void SchurComplement::multiply(std::span<double> p, std::span<double> y) { times(*fill_, p, y); }

void SchurComplement::improve(const PressureSteps& steps, std::span<const double> rest, std::span<double> p) {
  const std::span<float> residual = solve_.residual();
  each_in_shares(threads_, rest.size(), [&](std::size_t i) { residual[i] = static_cast<float>(rest[i]); });
  const auto more = solve_.solve(steps, inverse_, threads_, [this](std::span<float> x, std::span<float> y) {
    times(*fill_single_, x, y);
  });
  each_in_shares(threads_, rest.size(), [&](std::size_t i) { p[i] += static_cast<double>(more[i]); });
}

std::size_t SchurComplement::bytes() const noexcept {
  const auto size = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return size(inverse_) + size(value_) + pattern_->bytes() + solve_.bytes();
}

}  // namespace kacanov
