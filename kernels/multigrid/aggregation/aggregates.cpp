// SPDX-License-Identifier: BSD-3-Clause
// Aggregates of strongly coupled nodes by pairwise matching, and the matrix of their motions.
#include "multigrid/aggregation/aggregates.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "operator/threads.hpp"

namespace kacanov {
namespace {

/// Elements with a node in each of the sections first[c] … first[c + 1], in compressed row storage.
struct ElementsOfSections {
  std::vector<std::size_t> start;
  std::vector<std::int32_t> element;

  ElementsOfSections(const MeshView& mesh, std::span<const std::int32_t> first) : start(first.size(), 0) {
    const auto visit = [&](auto&& in_section) {
      const std::size_t npe = nodes_per_element(mesh.type);
      std::vector<std::int32_t> last(first.size() - 1, -1);  // last element of each section
      for (std::size_t k = 0; k < mesh.connectivity.size(); ++k) {
        if (mesh.connectivity[k] >= first.back()) continue;
        const auto c =
            static_cast<std::size_t>(std::upper_bound(first.begin(), first.end(), mesh.connectivity[k]) -
                                     first.begin()) -
            1;
        const auto e = static_cast<std::int32_t>(k / npe);
        if (std::exchange(last[c], e) != e) in_section(c, e);
      }
    };
    visit([&](std::size_t c, std::int32_t) { ++start[c + 1]; });
    std::partial_sum(start.begin(), start.end(), start.begin());
    element.resize(start.back());
    std::vector<std::size_t> next(start.begin(), start.end() - 1);
    visit([&](std::size_t c, std::int32_t e) { element[next[c]++] = e; });
  }
};

constexpr std::int32_t none = -1;
constexpr float weak = 0.2F;  ///< relative to a row's heaviest edge

/// First-in-first-out queues of rows, indexed by a small number; rows can be removed from the middle.
class Queues {
 public:
  Queues(std::int32_t rows, std::int32_t queues)
      : first_(queues, none), last_(first_), next_(rows, none), previous_(next_) {}

  void push(std::int32_t row, std::int32_t queue) {
    const auto q = static_cast<std::size_t>(queue), r = static_cast<std::size_t>(row);
    previous_[r] = last_[q];
    next_[r] = none;
    (last_[q] == none ? first_[q] : next_[last_[q]]) = row;
    last_[q] = row;
    lowest_ = std::min(lowest_, q);
  }
  void remove(std::int32_t row, std::int32_t queue) {
    const auto q = static_cast<std::size_t>(queue), r = static_cast<std::size_t>(row);
    (previous_[r] == none ? first_[q] : next_[previous_[r]]) = next_[r];
    (next_[r] == none ? last_[q] : previous_[next_[r]]) = previous_[r];
  }
  /// The first row of the lowest nonempty queue, or `none`.
  std::int32_t front() {
    while (lowest_ < first_.size() && first_[lowest_] == none) ++lowest_;
    return lowest_ < first_.size() ? first_[lowest_] : none;
  }

 private:
  std::vector<std::int32_t> first_, last_, next_, previous_;
  std::size_t lowest_ = 0;
};

/// Group of each row: it and its partner along its heaviest edge, or itself. Small rows choose first, and
/// among them those with the fewest free strong neighbours (Notay 2010), so that few are left over for any
/// numbering.
std::vector<std::int32_t> match(const WeightedGraph& graph, std::span<const std::int32_t> size) {
  const std::int32_t rows = graph.rows();
  constexpr std::int32_t most_choices = 63;
  std::vector<std::int32_t> group(rows, none), choices(group.size(), 0);
  std::vector<float> strong(group.size(), 0.0F);  // only heavier edges are strong
  const auto begin = [&](std::int32_t i) { return static_cast<std::size_t>(graph.start[i]); };
  const auto end = [&](std::int32_t i) {
    return static_cast<std::size_t>(graph.start[static_cast<std::size_t>(i) + 1]);
  };
  for (std::int32_t i = 0; i < rows; ++i) {
    float& least = strong[i];
    for (auto k = begin(i); k < end(i); ++k) least = std::max(least, weak * graph.weight[k]);
    for (auto k = begin(i); k < end(i); ++k) choices[i] += graph.weight[k] > least ? 1 : 0;
  }
  std::vector<std::int32_t> classes(size.begin(), size.end());
  std::sort(classes.begin(), classes.end());
  classes.erase(std::unique(classes.begin(), classes.end()), classes.end());

  std::int32_t groups = 0;
  Queues queues(rows, most_choices + 1);
  const auto queue_of = [&](std::int32_t i) { return std::min(choices[i], most_choices); };
  for (const std::int32_t now : classes) {
    const auto waits = [&](std::int32_t i) { return group[i] == none && size[i] == now; };
    const auto take = [&](std::int32_t i) {
      if (waits(i)) queues.remove(i, queue_of(i));
      group[i] = groups;
      for (auto k = begin(i); k < end(i); ++k) {
        const std::int32_t j = graph.column[k];
        if (graph.weight[k] <= strong[j] || group[j] != none) continue;
        if (waits(j)) queues.remove(j, queue_of(j));
        --choices[j];
        if (waits(j)) queues.push(j, queue_of(j));
      }
    };
    for (std::int32_t i = 0; i < rows; ++i)
      if (waits(i)) queues.push(i, queue_of(i));
    for (std::int32_t i = queues.front(); i != none; i = queues.front()) {
      std::int32_t best = none;
      // A row whose strong neighbours are all taken waits for the next pass.
      float heaviest = strong[i];
      for (auto k = begin(i); k < end(i); ++k)
        if (group[graph.column[k]] == none && graph.weight[k] > heaviest) {
          heaviest = graph.weight[k];
          best = graph.column[k];
        }
      take(i);
      if (best != none) take(best);
      ++groups;
    }
  }
  // Numbers groups by their first rows.
  std::vector<std::int32_t> number(groups, none);
  std::int32_t next = 0;
  for (std::int32_t& g : group) {
    auto& n = number[g];
    if (n == none) n = next++;
    g = n;
  }
  return group;
}

/// Rows of one group become one row, weights between groups are summed.
WeightedGraph contract(const WeightedGraph& graph, std::span<const std::int32_t> group, std::int32_t groups) {
  std::vector<std::int32_t> first(static_cast<std::size_t>(groups) + 1, 0), member(group.size());
  for (const std::int32_t g : group) ++first[static_cast<std::size_t>(g) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  auto next = first;
  for (std::size_t i = 0; i < group.size(); ++i) member[next[group[i]]++] = static_cast<std::int32_t>(i);

  WeightedGraph coarse;
  coarse.start.reserve(static_cast<std::size_t>(groups) + 1);
  coarse.start.push_back(0);
  std::vector<std::int64_t> place(groups, none);
  for (std::int32_t i = 0; i < groups; ++i) {
    const std::int64_t begin = coarse.start.back();
    for (auto m = first[i]; m < first[static_cast<std::size_t>(i) + 1]; ++m) {
      const std::size_t row = member[m];
      for (auto k = graph.start[row]; k < graph.start[row + 1]; ++k) {
        const std::int32_t j = group[graph.column[k]];
        if (j == i) continue;
        auto& at = place[j];
        if (at < begin) {
          at = static_cast<std::int64_t>(coarse.column.size());
          coarse.column.push_back(j);
          coarse.weight.push_back(0.0F);
        }
        coarse.weight[at] += graph.weight[k];
      }
    }
    coarse.start.push_back(static_cast<std::int64_t>(coarse.column.size()));
  }
  return coarse;
}

/// Couplings of nodes first … last − 1 of a body: Σ g / distance² over the elements two nodes share, g
/// (elements × points) taken in the mean. In flat or stretched elements the short edges are the strong ones.
/// `elements`: those with one of the nodes.
WeightedGraph coupling_graph(const Body& body, std::span<const double> g, std::int32_t first,
                             std::int32_t last, std::span<const std::int32_t> elements) {
  const auto& mesh = body.mesh;
  const std::size_t npe = nodes_per_element(mesh.type);
  const std::size_t points = points_per_element(mesh.type);
  const std::size_t dim = dimension(mesh.type);
  const std::size_t rows = last - first;
  const auto row_of = [&](std::int32_t node) { return static_cast<std::size_t>(node - first); };
  const auto inside = [&](std::int32_t node) { return node >= first && node < last; };

  std::vector<std::int32_t> start(rows + 1, 0), element;  // of each node
  for (const std::int32_t e : elements)
    for (const std::int32_t n : mesh.connectivity.subspan(static_cast<std::size_t>(e) * npe, npe))
      if (inside(n)) ++start[row_of(n) + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  element.resize(start.back());
  std::vector<std::int32_t> next(start.begin(), start.end() - 1);
  for (const std::int32_t e : elements)
    for (const std::int32_t n : mesh.connectivity.subspan(static_cast<std::size_t>(e) * npe, npe))
      if (inside(n)) element[next[row_of(n)]++] = e;

  WeightedGraph graph;
  graph.start.reserve(rows + 1);
  graph.start.push_back(0);
  std::vector<std::int64_t> place(rows, none);
  for (std::int32_t n = first; n < last; ++n) {
    const auto begin = static_cast<std::int64_t>(graph.column.size());
    const double* x = mesh.coordinates.data() + static_cast<std::size_t>(n) * dim;
    for (auto k = start[row_of(n)]; k < start[row_of(n) + 1]; ++k) {
      const std::size_t e = element[k];
      double stiffness = 0.0;
      for (std::size_t q = 0; q < points; ++q) stiffness += g[e * points + q];
      for (const std::int32_t m : mesh.connectivity.subspan(e * npe, npe)) {
        if (m == n || !inside(m)) continue;
        const double* y = mesh.coordinates.data() + static_cast<std::size_t>(m) * dim;
        double square = 0.0;
        for (std::size_t c = 0; c < dim; ++c) square += (x[c] - y[c]) * (x[c] - y[c]);
        auto& at = place[row_of(m)];
        if (at < begin) {
          at = static_cast<std::int64_t>(graph.column.size());
          graph.column.push_back(m - first);
          graph.weight.push_back(0.0F);
        }
        graph.weight[at] += static_cast<float>(stiffness / square);
      }
    }
    graph.start.push_back(static_cast<std::int64_t>(graph.column.size()));
  }
  return graph;
}

}  // namespace

std::vector<std::int32_t> aggregate_nodes(const Body& body, std::span<const double> g, std::int32_t nodes,
                                          const NodeAggregation& options) {
  const std::int32_t sections = std::max(1, (nodes + options.section - 1) / options.section);
  std::vector<std::int32_t> first;
  for (std::int32_t c = 0; c <= sections; ++c)
    first.push_back(static_cast<std::int32_t>(std::int64_t{nodes} * c / sections));
  const ElementsOfSections elements(body.mesh, first);
  std::vector<std::vector<std::int32_t>> found(sections);
  std::atomic<std::size_t> next = 0;
  in_team(std::min(options.threads, sections), [&](int) {
    for (std::size_t c = next++; c < found.size(); c = next++) {
      const auto mine =
          std::span(elements.element).subspan(elements.start[c], elements.start[c + 1] - elements.start[c]);
      found[c] = aggregate(coupling_graph(body, g, first[c], first[c + 1], mine), options.size);
    }
  });
  std::vector<std::int32_t> group;
  group.reserve(nodes);
  std::int32_t groups = 0;
  for (const auto& local : found) {
    const std::int32_t before = groups;
    for (const std::int32_t a : local) {
      group.push_back(before + a);
      groups = std::max(groups, before + a + 1);
    }
  }
  return group;
}

std::vector<std::int32_t> aggregate(WeightedGraph graph, double size) {
  // Weights of a diverged state may be NaN, for which comparisons would fail.
  for (float& weight : graph.weight)
    if (!std::isfinite(weight)) weight = 0.0F;
  const std::int32_t rows = graph.rows();
  std::vector<std::int32_t> result(rows);
  std::iota(result.begin(), result.end(), 0);
  std::vector<std::int32_t> members(result.size(), 1);
  std::int32_t before = rows;
  // Averages only over groups that can still be joined: rows without a neighbour here, at the boundary of a
  // part, would otherwise cause the others to be joined down to almost nothing.
  const auto too_small = [&] {
    std::int32_t lone_groups = 0, lone_rows = 0;
    for (std::int32_t i = 0; i < before; ++i)
      if (graph.start[i] == graph.start[static_cast<std::size_t>(i) + 1])
        ++lone_groups, lone_rows += members[i];
    return static_cast<double>(before - lone_groups) * size > static_cast<double>(rows - lone_rows) * 1.4;
  };
  while (too_small()) {
    const std::vector<std::int32_t> group = match(graph, members);
    const std::int32_t groups = group.empty() ? 0 : 1 + *std::max_element(group.begin(), group.end());
    if (groups == before) break;
    graph = contract(graph, group, groups);
    for (std::int32_t& r : result) r = group[r];
    members.assign(groups, 0);
    for (const std::int32_t r : result) ++members[r];
    before = groups;
  }
  return result;
}

template <int M>
Aggregates<M>::Aggregates(const MultigridBody& body, std::span<const double> g,
                          const MultigridOptions& options)
    : body_(body), threads_(options.threads) {
  const std::span<const double> coordinates = body.body.mesh.coordinates;
  group_ = aggregate_nodes(body.body, g, body.node_map->owned,
                           {.size = options.fine_size, .threads = options.threads});
  owned_ = group_.empty() ? 0 : 1 + *std::max_element(group_.begin(), group_.end());
  centre_.assign(owned_, Vector3{});
  std::vector<double> members(centre_.size(), 0.0);
  for (std::size_t n = 0; n < group_.size(); ++n) {
    const std::size_t a = group_[n];
    members[a] += 1.0;
    for (std::size_t c = 0; c < dim; ++c) centre_[a][c] += coordinates[n * dim + c];
  }
  for (std::size_t a = 0; a < centre_.size(); ++a)
    for (double& c : centre_[a]) c /= members[a];
  double spread = 0.0;
  for (std::size_t n = 0; n < group_.size(); ++n) {
    const Vector3 d = offset(n);
    spread += d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
  }
  length_ = std::sqrt(body.node_map->sum_all(spread) / static_cast<double>(body.node_map->total()));
  if (!(length_ > 0.0)) length_ = 1.0;
}

template <int M>
BlockMatrix<M> Aggregates<M>::make_level() {
  const IndexMap& nodes = *body_.node_map;
  const MeshView& mesh = body_.body.mesh;
  first_ = nodes.sum_below(owned_);

  // Centre and number of the aggregate of every local node; ghosts get them from their owners.
  const std::size_t owned_nodes = group_.size();
  std::vector<std::int64_t> number(body_.nodes());
  std::vector<double> centre(dim * body_.nodes());
  for (std::size_t n = 0; n < owned_nodes; ++n) {
    const std::size_t a = group_[n];
    number[n] = first_ + group_[n];
    for (std::size_t c = 0; c < dim; ++c) centre[n * dim + c] = centre_[a][c];
  }
  nodes.forward(number, 1);
  nodes.forward(centre, static_cast<int>(dim));

  // A thread's elements follow those of the previous thread, and so do the blocks that they create.
  const std::size_t npe = nodes_per_element(mesh.type), elements = mesh.element_count(), team = threads_;
  std::vector<BlockSums<M>> couplings(team);
  in_team(threads_, [&](int t) {
    const std::size_t share = t;
    std::vector<std::int64_t> distinct, before;
    for (std::size_t e = elements * share / team; e < elements * (share + 1) / team; ++e) {
      distinct.clear();
      for (std::size_t a = 0; a < npe; ++a) {
        const std::int64_t id = number[mesh.connectivity[e * npe + a]];
        if (std::find(distinct.begin(), distinct.end(), id) == distinct.end()) distinct.push_back(id);
      }
      if (distinct == before) continue;
      for (const std::int64_t row : distinct)
        for (const std::int64_t column : distinct)
          if (row <= column) couplings[share].at(row, column);
      distinct.swap(before);
    }
  });
  for (std::size_t t = 1; t < team; ++t)
    for (const auto& entry : couplings[t].entries()) couplings[0].at(entry.row, entry.column);
  BlockMatrix<M> level(centre_, std::move(couplings[0]), nodes, threads_);

  group_.resize(body_.nodes());
  std::unordered_map<std::int64_t, std::int32_t>
      unknown;  // not in the level: no element here couples them to an owned one
  number_ = level.map().ghosts;
  centre_.resize(centre_.size() + number_.size());
  const auto known = static_cast<std::int32_t>(centre_.size());
  for (std::size_t n = owned_nodes; n < group_.size(); ++n) {
    const std::int64_t id = number[n];
    std::int32_t at = level.local(id);
    if (at < 0) {
      at = unknown.try_emplace(id, known + static_cast<std::int32_t>(unknown.size())).first->second;
      centre_.resize(std::max(centre_.size(), static_cast<std::size_t>(at) + 1));
      number_.resize(centre_.size() - static_cast<std::size_t>(owned_));
    }
    group_[n] = at;
    for (std::size_t c = 0; c < dim; ++c) centre_[at][c] = centre[n * dim + c];
    number_[at - owned_] = id;
  }
  return level;
}

template class Aggregates<3>;
template class Aggregates<6>;

}  // namespace kacanov
