// SPDX-License-Identifier: BSD-3-Clause
// Regions of similar stiffness, and clusters of regions (theory: regions).
#include "contact/regions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include <kacanov/reference.hpp>
#include "parallel/disjoint_sets.hpp"
#include "parallel/exchange.hpp"
#include "problem/vector3.hpp"

namespace kacanov {
namespace {

/// Returns, for each node of a body, the largest |u| of its elements.
std::vector<double> largest_of_elements(const Body& body, std::span<const double> u) {
  const std::size_t npe = nodes_per_element(body.mesh.type);
  const std::size_t dim = u.size() / std::max(body.mesh.node_count(), std::size_t{1});
  std::vector<double> largest(body.mesh.node_count(), 0.0);
  for (std::size_t e = 0; e < body.mesh.element_count(); ++e) {
    const auto nodes = body.mesh.connectivity.subspan(e * npe, npe);
    double most = 0.0;
    for (const std::int32_t n : nodes)
      for (std::size_t c = 0; c < dim; ++c) most = std::max(most, std::abs(u[n * dim + c]));
    for (const std::int32_t n : nodes) largest[n] = std::max(largest[n], most);
  }
  return largest;
}

/// Returns the bin of every law: the number of factors of ten by which it is softer than the stiffest one
/// in use. Bin edges are offset from powers of ten, which are common ratios between materials.
std::vector<int> bins_of_laws(const Part& part) {
  constexpr double offset = 0.25;
  const Body body = part.body();
  double largest_modulus = 0.0;
  for (std::size_t e = 0; e < part.element_count(); ++e)
    largest_modulus = std::max(largest_modulus, body.law(e).secant(0.0));
  largest_modulus = part.node_map.max_all(largest_modulus);
  std::vector<int> bins;
  for (const Law& law : part.laws) {
    // Moduli that are next to 0 or infinite, in the units of the loop, have no ratio.
    const double ratio = std::min(std::max(1.0, largest_modulus / law.secant(0.0)), 1e300);
    bins.push_back(static_cast<int>(std::floor(std::log10(ratio) + offset)));
  }
  return bins;
}

/// A component of elements of one rank at a node that it shares with other ranks.
struct Touch {
  std::int64_t node;
  std::int32_t bin, component;
};

/// Components of this rank's elements: connected by nodes, with the same bin.
struct Components {
  std::vector<std::int32_t> of_element;
  std::vector<std::int32_t> bin;  ///< of each component
};

Components components_of(const Part& part, const std::vector<int>& bins) {
  const Body body = part.body();
  const std::size_t npe = nodes_per_element(part.type);
  Components out;
  out.of_element.resize(part.element_count());
  for (const int bin : std::set<int>(bins.begin(), bins.end())) {
    DisjointSets sets(part.nodes());
    const auto each = [&](const auto& visit) {
      for (std::size_t e = 0; e < part.element_count(); ++e)
        if (bins[body.law_index(e)] == bin) visit(e, &part.elements[e * npe]);
    };
    each([&](std::size_t, const std::int32_t* node) {
      for (std::size_t k = 1; k < npe; ++k) sets.join(node[0], node[k]);
    });
    std::vector<std::int32_t> number(part.nodes(), -1);
    each([&](std::size_t e, const std::int32_t* node) {
      std::int32_t& component = number[sets.find(node[0])];
      if (component < 0) {
        component = static_cast<std::int32_t>(out.bin.size());
        out.bin.push_back(bin);
      }
      out.of_element[e] = component;
    });
  }
  return out;
}

std::vector<Touch> touches_of(const Part& part, const Components& components, std::int32_t first) {
  const std::size_t npe = nodes_per_element(part.type);
  std::vector<std::uint8_t> shared(part.nodes(), 0);
  for (const std::int32_t node : part.node_map.shared) shared[node] = 1;
  std::vector<Touch> touches;
  for (std::size_t k = 0; k < part.elements.size(); ++k) {
    if (!shared[part.elements[k]]) continue;
    const std::int32_t component = components.of_element[k / npe];
    touches.push_back({part.node_map.number(part.elements[k]), components.bin[component], first + component});
  }
  const auto order = [](const Touch& a, const Touch& b) {
    return std::tie(a.node, a.bin, a.component) < std::tie(b.node, b.bin, b.component);
  };
  const auto same = [&](const Touch& a, const Touch& b) { return !order(a, b) && !order(b, a); };
  std::sort(touches.begin(), touches.end(), order);
  touches.erase(std::unique(touches.begin(), touches.end(), same), touches.end());
  touches = gathered(touches, part.node_map);
  std::sort(touches.begin(), touches.end(), order);
  return touches;
}

}  // namespace

StiffnessRegions::StiffnessRegions(const Part& part) : part_(&part) {
  const IndexMap& ranks = part.node_map;
  const std::size_t npe = nodes_per_element(part.type);
  Components components = components_of(part, bins_of_laws(part));
  const auto first =
      static_cast<std::int32_t>(ranks.sum_below(static_cast<std::int64_t>(components.bin.size())));
  const std::vector<std::int32_t> bins = gathered(components.bin, ranks);
  const std::vector<Touch> touches = touches_of(part, components, first);

  DisjointSets sets(bins.size());
  for (std::size_t k = 1; k < touches.size(); ++k)
    if (touches[k].node == touches[k - 1].node && touches[k].bin == touches[k - 1].bin)
      sets.join(touches[k].component, touches[k - 1].component);
  std::vector<std::int32_t> region(bins.size());
  for (std::size_t c = 0; c < bins.size(); ++c) {
    const std::int32_t top = sets.find(static_cast<std::int32_t>(c));
    if (top == static_cast<std::int32_t>(c)) {
      region[c] = static_cast<std::int32_t>(bin_.size());
      bin_.push_back(bins[c]);
    } else {
      region[c] = region[top];
    }
  }
  std::vector<std::array<std::int32_t, 2>> neighbours;
  if (bin_.size() > 1) {
    for (std::int32_t& component : components.of_element) component = region[first + component];
    const std::vector<std::int32_t>& of_element = components.of_element;
    const auto stiffer = [&](std::int32_t a, std::int32_t b) {
      return b < 0 || std::tie(bin_[a], a) < std::tie(bin_[b], b);
    };
    of_node_.assign(part.nodes(), -1);
    shared_.assign(part.nodes(), 0);
    const auto visit = [&](const auto& look) {
      std::map<std::int64_t, std::int32_t> local;  // nodes shared with other ranks
      for (const std::int32_t node : ranks.shared) local[ranks.number(node)] = node;
      for (const Touch& touch : touches)
        if (const auto found = local.find(touch.node); found != local.end())
          look(found->second, region[touch.component]);
      for (std::size_t k = 0; k < part.elements.size(); ++k) look(part.elements[k], of_element[k / npe]);
    };
    visit([&](std::int32_t node, std::int32_t r) {
      if (stiffer(r, of_node_[node])) of_node_[node] = r;
    });
    std::set<std::array<std::int32_t, 2>> pairs;
    visit([&](std::int32_t node, std::int32_t r) {
      if (r == of_node_[node]) return;
      shared_[node] = 1;
      pairs.insert({of_node_[node], r});
    });
    neighbours = gathered(std::vector(pairs.begin(), pairs.end()), ranks);
    // Node of a multi-node contact point without an element here.
    for (std::int32_t& r : of_node_) r = std::max(r, 0);
    find_interfaces(of_element);
  }
  find_clusters(std::move(neighbours));
}

StiffnessRegions StiffnessRegions::whole(const Part& part) {
  StiffnessRegions one;
  one.part_ = &part;
  one.bin_ = {0};
  one.find_clusters({});
  return one;
}

void StiffnessRegions::find_interfaces(std::span<const std::int32_t> region_of_element) {
  const Part& part = *part_;
  const Body body = part.body();
  const std::size_t npe = nodes_per_element(part.type), dim = part.dim();
  std::map<std::int32_t, std::vector<std::int32_t>> elements;
  for (std::size_t e = 0; e < part.element_count(); ++e) {
    const std::int32_t* node = &part.elements[e * npe];
    if (std::any_of(node, node + npe, [&](std::int32_t n) { return shared_[n] != 0; }))
      elements[region_of_element[e]].push_back(static_cast<std::int32_t>(e));
  }
  for (auto& [region, list] : elements) {
    Interface side;
    side.region = region;
    for (const std::int32_t e : list) {
      side.nodes.insert(side.nodes.end(), &part.elements[e * npe], &part.elements[e * npe] + npe);
      side.laws.push_back(body.law_index(e));
    }
    side.connectivity = side.nodes;
    std::sort(side.nodes.begin(), side.nodes.end());
    side.nodes.erase(std::unique(side.nodes.begin(), side.nodes.end()), side.nodes.end());
    for (std::int32_t& n : side.connectivity)
      n = static_cast<std::int32_t>(std::lower_bound(side.nodes.begin(), side.nodes.end(), n) -
                                    side.nodes.begin());
    for (const std::int32_t n : side.nodes)
      side.coordinates.insert(side.coordinates.end(), &part.coordinates[n * dim],
                              &part.coordinates[n * dim] + dim);
    side.elements = std::move(list);
    const Body body_of_side{
        {part.type, side.coordinates, side.connectivity, part.plane}, part.laws, side.laws};
    std::vector<double> at_rest(side.coordinates.size()), g(body_of_side.secant_count());
    side.diagonal.resize(side.coordinates.size());
    reference::secant(body_of_side, at_rest, g);
    reference::diagonal(body_of_side, g, side.diagonal);
    interfaces_.push_back(std::move(side));
  }
}

void StiffnessRegions::find_clusters(std::vector<std::array<std::int32_t, 2>> neighbours) {
  const Part& part = *part_;
  const std::size_t dim = part.dim();
  // Bounding boxes of the nodes of each region, as maxima of x and −x.
  std::vector<double> reach(6 * count(), -std::numeric_limits<double>::max());
  for (std::size_t k = 0; k < static_cast<std::size_t>(part.owned_nodes()) * dim; ++k) {
    double* box = &reach[6 * of_node(k / dim)];
    box[k % dim] = std::max(box[k % dim], part.coordinates[k]);
    box[3 + k % dim] = std::max(box[3 + k % dim], -part.coordinates[k]);
  }
  part.node_map.max_all(reach);
  std::sort(neighbours.begin(), neighbours.end());
  neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());

  DisjointSets sets(count());
  std::map<std::int32_t, std::size_t> size_of;  // size of a set when it last was a cluster
  for (const int bin : std::set<int>(bin_.begin(), bin_.end())) {
    for (const auto& [a, b] : neighbours)
      if (std::max(bin_[a], bin_[b]) <= bin) sets.join(a, b);
    std::map<std::int32_t, Cluster> now;
    for (std::size_t r = 0; r < count(); ++r)
      if (bin_[r] <= bin)
        now[sets.find(static_cast<std::int32_t>(r))].regions.push_back(static_cast<std::int32_t>(r));
    for (auto& [top, cluster] : now) {
      std::size_t& before = size_of[top];
      if (before == cluster.regions.size()) continue;
      before = cluster.regions.size();
      cluster.bin = bin;
      double square = 0.0;
      for (std::size_t c = 0; c < dim; ++c) {
        double high = -std::numeric_limits<double>::max(), low = high;
        for (const std::int32_t r : cluster.regions) {
          high = std::max(high, reach[6 * r + c]);
          low = std::max(low, reach[6 * r + 3 + c]);
        }
        if (high < -low) continue;  // all of its nodes belong to stiffer regions
        cluster.centre[c] = 0.5 * (high - low);
        square += 0.25 * (high + low) * (high + low);
      }
      cluster.radius = std::sqrt(square);
      clusters_.push_back(std::move(cluster));
    }
  }
}

std::vector<InterfaceForce> StiffnessRegions::interface_forces(std::span<const double> u,
                                                               const ThermalState& thermal,
                                                               std::span<const double> dilatation) const {
  const Part& part = *part_;
  const IndexMap& ranks = part.node_map;
  std::vector<InterfaceForce> forces;
  if (count() == 1) return forces;
  const std::size_t dim = part.dim();
  struct Sent {
    std::int64_t node;
    std::int32_t region, empty;
    Vector3 force, stiff;
  };
  std::vector<Sent> sent;
  std::vector<std::uint8_t> common(part.nodes(), 0);
  for (const std::int32_t node : ranks.shared) common[node] = 1;
  for (const Interface& side : interfaces_) {
    const auto of_elements = [&](std::span<const double> all) {
      const std::size_t width = all.size() / std::max(part.element_count(), std::size_t{1});
      std::vector<double> some;
      if (!all.empty())
        for (const std::int32_t e : side.elements)
          some.insert(some.end(), &all[e * width], &all[e * width] + width);
      return some;
    };
    Body body{{part.type, side.coordinates, side.connectivity, part.plane}, part.laws, side.laws};
    const std::vector<double> strain = of_elements(thermal.free_strain), means = of_elements(dilatation),
                              pressure = of_elements(thermal.pressure);
    body.free_strain = strain;
    body.corner_dilatation = means;
    std::vector<double> moved, force(side.coordinates.size()), expansion(force.size());
    for (const std::int32_t n : side.nodes) moved.insert(moved.end(), &u[n * dim], &u[n * dim] + dim);
    reference::residual(body, moved, force);
    if (!pressure.empty() && strain.empty()) reference::expansion_force(body, pressure, expansion);
    const std::vector<double> largest = largest_of_elements(body, moved);
    for (std::size_t k = 0; k < side.nodes.size(); ++k) {
      const std::int32_t node = side.nodes[k];
      if (!shared_[node]) continue;
      Vector3 f{}, stiff{};
      for (std::size_t c = 0; c < dim; ++c) {
        f[c] = force[k * dim + c] - expansion[k * dim + c];
        stiff[c] = side.diagonal[k * dim + c] * largest[k];
      }
      if (common[node])
        sent.push_back({ranks.number(node), side.region, 0, f, stiff});
      else
        forces.push_back({node, side.region, f, stiff});
    }
  }
  std::map<std::array<std::int64_t, 2>, std::array<Vector3, 2>> sums;
  for (const Sent& one : gathered(sent, ranks)) {
    const std::int64_t local = one.node - ranks.first();
    if (local < 0 || local >= ranks.owned) continue;
    auto& [force, stiff] = sums[{local, one.region}];
    force = force + one.force;
    stiff = stiff + one.stiff;
  }
  for (const auto& [place, sum] : sums)
    forces.push_back(
        {static_cast<std::int32_t>(place[0]), static_cast<std::int32_t>(place[1]), sum[0], sum[1]});
  std::sort(forces.begin(), forces.end(), [](const InterfaceForce& a, const InterfaceForce& b) {
    return std::tie(a.node, a.region) < std::tie(b.node, b.region);
  });
  return forces;
}

}  // namespace kacanov
