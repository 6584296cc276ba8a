// SPDX-License-Identifier: BSD-3-Clause
// Small distorted boxes of every element type, as plain arrays.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include <kacanov/kacanov.h>

struct SmallMesh {
  std::int32_t element = KACANOV_TET4;
  std::size_t dim = 3, per_element = 4;
  std::vector<double> coordinates;         ///< interleaved components
  std::vector<std::int32_t> connectivity;  ///< zero-based

  std::size_t nodes() const { return coordinates.size() / dim; }
  std::size_t elements() const { return connectivity.size() / per_element; }
  std::size_t unknowns() const { return coordinates.size(); }
};

/// A box of n cells per side; every node is moved by up to a tenth of a cell.
inline SmallMesh small_mesh(std::int32_t element, std::size_t n) {
  SmallMesh mesh;
  mesh.element = element;
  mesh.dim = element == KACANOV_TRI3 || element == KACANOV_QUAD4 ? 2 : 3;
  mesh.per_element = std::array<std::size_t, 5>{3, 4, 10, 8, 4}.at(element);
  const std::size_t m = n + 1, layers = mesh.dim == 3 ? m : 1;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shift(-0.1, 0.1);
  for (std::size_t z = 0; z < layers; ++z)
    for (std::size_t y = 0; y < m; ++y)
      for (std::size_t x = 0; x < m; ++x)
        for (const std::size_t c : mesh.dim == 3 ? std::vector{x, y, z} : std::vector{x, y})
          mesh.coordinates.push_back(static_cast<double>(c) + shift(random));

  const auto node = [&](std::size_t x, std::size_t y, std::size_t z) {
    return static_cast<std::int32_t>((z * m + y) * m + x);
  };
  const auto add = [&](std::initializer_list<std::int32_t> element_nodes) {
    mesh.connectivity.insert(mesh.connectivity.end(), element_nodes);
  };
  for (std::size_t z = 0; z < (mesh.dim == 3 ? n : 1); ++z)
    for (std::size_t y = 0; y < n; ++y)
      for (std::size_t x = 0; x < n; ++x) {
        const std::int32_t a = node(x, y, z), b = node(x + 1, y, z), c = node(x + 1, y + 1, z),
                           d = node(x, y + 1, z);
        if (element == KACANOV_QUAD4) {
          add({a, b, c, d});
          continue;
        }
        if (mesh.dim == 2) {
          add({a, b, c});
          add({a, c, d});
          continue;
        }
        const std::int32_t e = node(x, y, z + 1), f = node(x + 1, y, z + 1), g = node(x + 1, y + 1, z + 1),
                           h = node(x, y + 1, z + 1);
        if (element == KACANOV_HEX8) {
          add({a, b, c, d, e, f, g, h});
          continue;
        }
        for (const auto& [p, q] : {std::pair{b, c}, {c, d}, {d, h}, {h, e}, {e, f}, {f, b}})
          add({a, p, q, g});
      }
  if (element != KACANOV_TET10) return mesh;

  const std::vector<std::int32_t> corners = std::move(mesh.connectivity);
  mesh.connectivity.clear();
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middle;
  constexpr std::array<std::array<std::size_t, 2>, 6> edges{{{0, 1}, {1, 2}, {2, 0}, {3, 0}, {3, 2}, {3, 1}}};
  for (std::size_t t = 0; t < corners.size(); t += 4) {
    for (std::size_t a = 0; a < 4; ++a) mesh.connectivity.push_back(corners[t + a]);
    for (const auto& [i, j] : edges) {
      const auto [low, high] = std::minmax(corners[t + i], corners[t + j]);
      const auto [entry, is_new] = middle.try_emplace({low, high}, static_cast<std::int32_t>(mesh.nodes()));
      for (std::size_t c = 0; is_new && c < 3; ++c)
        mesh.coordinates.push_back(0.5 * (mesh.coordinates[static_cast<std::size_t>(low) * 3 + c] +
                                          mesh.coordinates[static_cast<std::size_t>(high) * 3 + c]) +
                                   0.3 * shift(random));
      mesh.connectivity.push_back(entry->second);
    }
  }
  return mesh;
}
