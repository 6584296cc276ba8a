// SPDX-License-Identifier: BSD-3-Clause
// Mesh generators: loops over a grid, random perturbations and random flips.
#include "meshes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <unordered_map>
#include <utility>

namespace kacanov::meshes {
namespace {

using Index = std::int32_t;
using Vec = std::array<double, 3>;

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

Vec node(const OwnedMesh& mesh, Index i) {
  return {mesh.coordinates[3 * at(i)], mesh.coordinates[3 * at(i) + 1], mesh.coordinates[3 * at(i) + 2]};
}

/// Returns six times the volume of tetrahedron abcd.
double determinant(const OwnedMesh& mesh, Index a, Index b, Index c, Index d) {
  const Vec o = node(mesh, a), p = node(mesh, b), q = node(mesh, c), r = node(mesh, d);
  const Vec u{p[0] - o[0], p[1] - o[1], p[2] - o[2]}, v{q[0] - o[0], q[1] - o[1], q[2] - o[2]},
      w{r[0] - o[0], r[1] - o[1], r[2] - o[2]};
  return u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) +
         u[2] * (v[0] * w[1] - v[1] * w[0]);
}

/// Converts a linear mesh to a quadratic one, with a new node on every edge.
void raise_order(OwnedMesh& mesh) {
  const Cell& type = cell(mesh.type);
  const auto dim = at(type.dim), corners_of = at(type.corners);
  const std::vector<Index> corners = std::move(mesh.connectivity);
  mesh.connectivity.clear();
  std::unordered_map<std::uint64_t, Index> middle;
  for (std::size_t first = 0; first < corners.size(); first += corners_of) {
    const Index* node = &corners[first];
    mesh.connectivity.insert(mesh.connectivity.end(), node, node + corners_of);
    for (const CellEdge& edge : type.edges) {
      const auto [low, high] = std::minmax(node[edge.a], node[edge.b]);
      const std::uint64_t key = static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint32_t>(high);
      const auto [found, is_new] = middle.try_emplace(key, static_cast<Index>(mesh.coordinates.size() / dim));
      if (is_new) mesh.coordinates.resize(mesh.coordinates.size() + dim);
      mesh.connectivity.push_back(found->second);
    }
  }
}

struct Flipper {
  OwnedMesh& mesh;
  std::mt19937 random;
  std::map<std::array<Index, 3>, std::vector<Index>> sides;  ///< sorted face → its elements
  double least;                                              ///< smallest determinant allowed after a flip

  Index* tet(Index e) { return &mesh.connectivity[4 * at(e)]; }

  static std::array<Index, 3> face(const Index* t, int opposite) {
    std::array<Index, 3> f{};
    for (int a = 0, n = 0; a < 4; ++a)
      if (a != opposite) f[at(n++)] = t[a];
    std::sort(f.begin(), f.end());
    return f;
  }
  void attach(Index e) {
    for (int a = 0; a < 4; ++a) sides[face(tet(e), a)].push_back(e);
  }
  void detach(Index e) {
    for (int a = 0; a < 4; ++a) std::erase(sides[face(tet(e), a)], e);
  }
  bool good(Index a, Index b, Index c, Index d) const { return determinant(mesh, a, b, c, d) > least; }
  void set(Index e, Index a, Index b, Index c, Index d) {
    Index* t = tet(e);
    t[0] = a, t[1] = b, t[2] = c, t[3] = d;
    attach(e);
  }

  /// Replaces two tetrahedra on one face by three around the edge between their apexes.
  void two_to_three(Index e, int opposite) {
    const auto f = face(tet(e), opposite);
    const auto& both = sides[f];
    if (both.size() != 2) return;
    const Index other = both[0] == e ? both[1] : both[0];
    const Index apex = tet(e)[opposite];
    Index below = 0;
    for (int a = 0; a < 4; ++a)
      if (std::find(f.begin(), f.end(), tet(other)[a]) == f.end()) below = tet(other)[a];
    std::array<Index, 3> r = f;
    if (determinant(mesh, r[0], r[1], r[2], apex) < 0) std::swap(r[1], r[2]);
    for (std::size_t i = 0; i < 3; ++i)
      if (!good(below, apex, r[i], r[(i + 1) % 3])) return;
    detach(e), detach(other);
    const auto added = static_cast<Index>(mesh.connectivity.size() / 4);
    mesh.connectivity.resize(mesh.connectivity.size() + 4);
    const std::array<Index, 3> target{e, other, added};
    for (std::size_t i = 0; i < 3; ++i) set(target[i], below, apex, r[i], r[(i + 1) % 3]);
  }

  /// Replaces three tetrahedra around the edge (p, q) of element e by two. Returns the number of the element
  /// left over.
  Index three_to_two(Index e, Index p, Index q) {
    std::vector<Index> ring{e};  // walk around the edge over the faces that contain it
    std::vector<Index> others;
    for (int a = 0; a < 4; ++a)
      if (tet(e)[a] != p && tet(e)[a] != q) others.push_back(tet(e)[a]);
    const Index start = others[0], second = others[1];
    Index tip = second;
    while (ring.size() < 4) {
      std::array<Index, 3> f{p, q, tip};
      std::sort(f.begin(), f.end());
      const auto& both = sides[f];
      if (both.size() != 2) return -1;
      const Index next = both[0] == ring.back() ? both[1] : both[0];
      if (next == e) break;
      ring.push_back(next);
      for (int a = 0; a < 4; ++a)
        if (const Index v = tet(next)[a]; v != p && v != q && v != tip) {
          tip = v;
          break;
        }
      others.push_back(tip);
    }
    if (ring.size() != 3) return -1;
    std::array<Index, 3> r{start, second, others[2]};
    if (determinant(mesh, r[0], r[1], r[2], q) < 0) std::swap(r[1], r[2]);
    if (!good(r[0], r[1], r[2], q) || !good(r[0], r[2], r[1], p)) return -1;
    for (const Index t : ring) detach(t);
    set(ring[0], r[0], r[1], r[2], q);
    set(ring[1], r[0], r[2], r[1], p);
    return ring[2];
  }

  void remove(Index e) {
    const auto last = static_cast<Index>(mesh.connectivity.size() / 4) - 1;
    if (e != last) {
      detach(last);
      std::copy_n(tet(last), 4, tet(e));
      attach(e);
    }
    mesh.connectivity.resize(mesh.connectivity.size() - 4);
  }
};

}  // namespace

OwnedMesh box(ElementType type, std::array<int, 3> cells, std::array<double, 3> size) {
  OwnedMesh mesh;
  mesh.type = type;
  const bool flat = dimension(type) == 2;
  const int nz = flat ? 0 : cells[2];
  const auto id = [&](int i, int j, int k) { return (k * (cells[1] + 1) + j) * (cells[0] + 1) + i; };
  for (int k = 0; k <= nz; ++k)
    for (int j = 0; j <= cells[1]; ++j)
      for (int i = 0; i <= cells[0]; ++i) {
        mesh.coordinates.push_back(size[0] * i / cells[0]);
        mesh.coordinates.push_back(size[1] * j / cells[1]);
        if (!flat) mesh.coordinates.push_back(size[2] * k / cells[2]);
      }
  for (int k = 0; k < std::max(nz, 1); ++k)
    for (int j = 0; j < cells[1]; ++j)
      for (int i = 0; i < cells[0]; ++i)
        for (const auto& corner : cell(type).box)
          mesh.connectivity.push_back(id(i + corner[0], j + corner[1], k + corner[2]));
  if (cell(type).order == 2) {
    raise_order(mesh);
    straighten(mesh);
  }
  return mesh;
}

void jitter(OwnedMesh& mesh, double amount, unsigned seed) {
  const std::size_t dim = dimension(mesh.type);
  const std::size_t nodes = nodes_per_element(mesh.type);
  std::array<double, 3> step;  // extent of the smallest element along each axis
  step.fill(std::numeric_limits<double>::max());
  for (std::size_t e = 0; e < mesh.connectivity.size() / nodes; ++e)
    for (std::size_t k = 0; k < dim; ++k) {
      double low = std::numeric_limits<double>::max(), high = -low;
      for (std::size_t a = 0; a < nodes; ++a) {
        const double x = mesh.coordinates[at(mesh.connectivity[e * nodes + a]) * dim + k];
        low = std::min(low, x), high = std::max(high, x);
      }
      step[k] = std::min(step[k], high - low);
    }
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> move(-amount, amount);
  for (std::size_t i = 0; i < mesh.coordinates.size(); ++i)
    mesh.coordinates[i] += move(random) * step[i % dim];
}

void straighten(OwnedMesh& mesh) {
  const Cell& type = cell(mesh.type);
  const auto dim = at(type.dim), nodes = at(type.nodes);
  for (std::size_t first = 0; first < mesh.connectivity.size(); first += nodes)
    for (const CellEdge& edge : type.edges) {
      if (edge.middle < 0) continue;
      const Index* t = &mesh.connectivity[first];
      for (std::size_t k = 0; k < dim; ++k)
        mesh.coordinates[dim * at(t[edge.middle]) + k] =
            0.5 * (mesh.coordinates[dim * at(t[edge.a]) + k] + mesh.coordinates[dim * at(t[edge.b]) + k]);
    }
}

void flip(OwnedMesh& mesh, int rounds, unsigned seed) {
  Flipper flipper{mesh, std::mt19937(seed), {}, std::numeric_limits<double>::max()};
  const auto count = static_cast<Index>(mesh.connectivity.size() / 4);
  double mean = 0.0;
  for (Index e = 0; e < count; ++e) {
    flipper.attach(e);
    const Index* t = flipper.tet(e);
    mean += determinant(mesh, t[0], t[1], t[2], t[3]) / count;
  }
  flipper.least = 0.1 * mean;
  for (int round = 0; round < rounds; ++round)
    for (Index e = 0; e < static_cast<Index>(mesh.connectivity.size() / 4); ++e) {
      const int choice = static_cast<int>(flipper.random() % 4);
      const Index p = flipper.tet(e)[choice], q = flipper.tet(e)[(choice + 1) % 4];
      const Index spare = flipper.three_to_two(e, p, q);
      if (spare >= 0)
        flipper.remove(spare);
      else if (flipper.random() % 4 == 0)
        flipper.two_to_three(e, choice);
    }
}

void shuffle(OwnedMesh& mesh, unsigned seed) {
  std::mt19937 random(seed);
  const std::size_t dim = dimension(mesh.type);
  const std::size_t nodes = nodes_per_element(mesh.type);
  std::vector<Index> place(mesh.coordinates.size() / dim);
  std::iota(place.begin(), place.end(), 0);
  std::shuffle(place.begin(), place.end(), random);
  std::vector<double> moved(mesh.coordinates.size());
  for (std::size_t i = 0; i < place.size(); ++i)
    for (std::size_t k = 0; k < dim; ++k) moved[at(place[i]) * dim + k] = mesh.coordinates[i * dim + k];
  mesh.coordinates = std::move(moved);
  std::vector<std::size_t> order(mesh.connectivity.size() / nodes);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), random);
  std::vector<Index> connectivity;
  for (const std::size_t e : order)
    for (std::size_t a = 0; a < nodes; ++a) connectivity.push_back(place[mesh.connectivity[e * nodes + a]]);
  mesh.connectivity = std::move(connectivity);
}

}  // namespace kacanov::meshes
