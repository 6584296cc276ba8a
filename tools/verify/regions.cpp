// SPDX-License-Identifier: BSD-3-Clause
// Regions of similar stiffness and the clusters they form (theory: regions).
#include "verify/regions.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <utility>

namespace kacanov::verify {
namespace {

/// Numbers the connected sets of elements in the order of their first elements; returns the set of each
/// element. `counts(e)`: e belongs to a set; `together(a, b)`: elements that share a node are connected.
std::vector<std::size_t> connected(const Mesh& mesh, const std::function<bool(std::size_t)>& counts,
                                   const std::function<bool(std::size_t, std::size_t)>& together) {
  std::vector<std::vector<std::size_t>> at(mesh.nodes.size());
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    for (const Index node : mesh.elements[e]) at[node].push_back(e);
  constexpr std::size_t none = static_cast<std::size_t>(-1);
  std::vector<std::size_t> set(mesh.elements.size(), none), waiting;
  std::size_t sets = 0;
  for (std::size_t first = 0; first < set.size(); ++first) {
    if (set[first] != none || !counts(first)) continue;
    set[first] = sets;
    waiting.push_back(first);
    while (!waiting.empty()) {
      const std::size_t e = waiting.back();
      waiting.pop_back();
      for (const Index node : mesh.elements[e])
        for (const std::size_t other : at[node])
          if (set[other] == none && counts(other) && together(e, other)) {
            set[other] = sets;
            waiting.push_back(other);
          }
    }
    ++sets;
  }
  return set;
}

void add_clusters(const Problem& problem, int bin, Regions& regions) {
  const Mesh& mesh = problem.mesh;
  const auto stiff = [&](std::size_t e) { return regions.bin[regions.of_element[e]] <= bin; };
  const std::vector<std::size_t> set = connected(mesh, stiff, [](std::size_t, std::size_t) { return true; });
  std::map<std::size_t, std::vector<bool>> found;
  for (std::size_t e = 0; e < set.size(); ++e)
    if (stiff(e)) {
      std::vector<bool>& has = found[set[e]];
      has.resize(regions.bin.size());
      has[regions.of_element[e]] = true;
    }
  for (auto& [number, has] : found) {
    if (std::any_of(regions.clusters.begin(), regions.clusters.end(),
                    [&, &mine = has](const Regions::Cluster& other) { return other.has == mine; }))
      continue;
    Regions::Cluster cluster{std::move(has), bin, {}, 0};
    bool any = false;
    Vec low{}, high{};
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
      if (!cluster.has[regions.of_node[n]]) continue;
      for (std::size_t c = 0; c < static_cast<std::size_t>(mesh.dim()); ++c) {
        low[c] = any ? std::min(low[c], mesh.nodes[n][c]) : mesh.nodes[n][c];
        high[c] = any ? std::max(high[c], mesh.nodes[n][c]) : mesh.nodes[n][c];
      }
      any = true;
    }
    cluster.centre = Real(1) / 2 * (low + high);
    cluster.radius = norm(high - low) / 2;
    regions.clusters.push_back(std::move(cluster));
  }
}

}  // namespace

Regions find_regions(const Problem& problem) {
  const Mesh& mesh = problem.mesh;
  Real stiffest = 0;
  const auto modulus = [&](std::size_t e) { return problem.laws[problem.law_of_element[e]].secant(0); };
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) stiffest = larger(stiffest, modulus(e));
  const auto bin_of = [&](std::size_t e) {
    return static_cast<int>(std::floor(std::log10(stiffest / modulus(e)) + Real(1) / 4));
  };
  Regions regions;
  regions.of_element = connected(
      mesh, [](std::size_t) { return true; },
      [&](std::size_t a, std::size_t b) { return bin_of(a) == bin_of(b); });
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    regions.bin.resize(std::max(regions.bin.size(), regions.of_element[e] + 1));
    regions.bin[regions.of_element[e]] = bin_of(e);
  }
  std::vector<bool> known(mesh.nodes.size(), false);
  regions.of_node.assign(mesh.nodes.size(), 0);
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    for (const Index node : mesh.elements[e]) {
      std::size_t& of_node = regions.of_node[node];
      if (!known[node] || bin_of(e) < regions.bin[of_node]) of_node = regions.of_element[e];
      known[node] = true;
    }
  std::vector<int> bins = regions.bin;
  std::sort(bins.begin(), bins.end());
  bins.erase(std::unique(bins.begin(), bins.end()), bins.end());
  for (const int bin : bins) add_clusters(problem, bin, regions);
  return regions;
}

}  // namespace kacanov::verify
