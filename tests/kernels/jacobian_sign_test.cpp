// SPDX-License-Identifier: BSD-3-Clause
// Detection of folded elements: the sign of det J over the whole element, compared with many samples.
#include "operator/element_maps.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <kacanov/cells.hpp>

using namespace kacanov;

namespace {

struct OneElement {
  ElementType type;
  std::vector<double> coordinates;
  std::vector<std::int32_t> connectivity;

  explicit OneElement(ElementType of) : type(of) {
    for (const auto& at : cell(of).reference) {
      coordinates.insert(coordinates.end(), at.begin(), at.begin() + cell(of).dim);
      connectivity.push_back(static_cast<std::int32_t>(connectivity.size()));
    }
  }
  MeshView view() const { return {type, coordinates, connectivity, PlaneState::strain}; }

  double det_at(const std::array<double, 3>& xi) const {
    const Cell& c = cell(type);
    std::array<double, 3 * most_nodes> slopes{};
    c.gradients(xi.data(), slopes.data());
    std::array<std::array<double, 3>, 3> j{};
    if (c.dim == 2) j[2][2] = 1.0;
    const std::size_t dim = c.dim;
    for (std::size_t a = 0; a < static_cast<std::size_t>(c.nodes); ++a)
      for (std::size_t k = 0; k < dim; ++k)
        for (std::size_t i = 0; i < dim; ++i) j[k][i] += coordinates[a * dim + i] * slopes[a * dim + k];
    return j[0][0] * (j[1][1] * j[2][2] - j[1][2] * j[2][1]) -
           j[0][1] * (j[1][0] * j[2][2] - j[1][2] * j[2][0]) +
           j[0][2] * (j[1][0] * j[2][1] - j[1][1] * j[2][0]);
  }
};

struct Sampled {
  double least = HUGE_VAL, most = -HUGE_VAL;
  bool at_corner = false;  ///< the minimum is attained at a corner
};

/// Samples det J on a grid over the reference element, corners and edges included.
Sampled sample(const OneElement& element) {
  constexpr int cells = 12;
  const Cell& c = cell(element.type);
  Sampled out;
  double corners = HUGE_VAL;
  for (int i = 0; i <= cells; ++i)
    for (int j = 0; j <= (c.simplex ? cells - i : cells); ++j)
      for (int k = 0; k <= (c.dim == 2 ? 0 : c.simplex ? cells - i - j : cells); ++k) {
        std::array<double, 3> xi{1.0 * i / cells, 1.0 * j / cells, 1.0 * k / cells};
        if (!c.simplex)
          for (double& one : xi) one = 2.0 * one - 1.0;
        const double det = element.det_at(xi);
        out.least = std::min(out.least, det);
        out.most = std::max(out.most, det);
        const auto end = [](int n) { return n == 0 || n == cells; };
        if (end(i) && end(j) && end(k)) corners = std::min(corners, det);
      }
  out.at_corner = corners <= out.least;
  return out;
}

bool is_folded(const OneElement& element) { return find_negative_jacobian(element.view(), 0).has_value(); }

}  // namespace

TEST_CASE("an element is folded exactly where some sample of its Jacobian is negative") {
  std::mt19937 bits(47);
  std::uniform_real_distribution<double> some(-1.0, 1.0);
  for (const ElementType type : {ElementType::quad4, ElementType::tet10, ElementType::hex8}) {
    int folded = 0, valid = 0, unseen_by_points = 0, unseen_by_corners = 0;
    for (int trial = 0; trial < 4000; ++trial) {
      OneElement element(type);
      const double size = (type == ElementType::tet10 ? 0.2 : 1.6) * std::abs(some(bits));
      for (double& x : element.coordinates) x += size * some(bits);
      const Sampled seen = sample(element);
      const bool found = is_folded(element);
      // Samples can miss a negative det J between them, so a negative sample implies a folded element, not
      // vice versa.
      if (seen.least < -1e-6 * seen.most) {
        REQUIRE(found);
        ++folded;
        if (element_map(element.view(), 0).least_det > 0.0) ++unseen_by_points;
        if (!seen.at_corner) ++unseen_by_corners;
      } else if (!found) {
        ++valid;
      }
      // Curved, but det J stays well above 0 between the samples too: the check must accept the element.
      if (seen.least > 0.2 * seen.most) CHECK_FALSE(found);
    }
    CAPTURE(cell(type).name);
    CHECK(folded > 300);
    CHECK(valid > 300);
    CHECK(unseen_by_points > 50);
    if (type != ElementType::quad4) CHECK(unseen_by_corners > 5);
  }
}

TEST_CASE("mid-side nodes in another order are found, all over as at the corner they name") {
  OneElement element(ElementType::tet10);
  CHECK_FALSE(is_folded(element));
  // Swap the mid-side nodes of edges 12 and 20, and of 30 and 32, as another program numbers them.
  std::swap(element.connectivity[5], element.connectivity[6]);
  CHECK(is_folded(element));
  std::swap(element.connectivity[7], element.connectivity[8]);
  const auto found = find_negative_jacobian(element.view(), 0);
  REQUIRE(found);
  CHECK(found->det < 0.0);
}

TEST_CASE("elements whose Jacobian falls to zero at a corner or an edge are valid") {
  // Quarter-point nodes around corner 0, as at a crack tip, also with the rounding error of six digits.
  for (const double off : {0.0, 1e-7, -1e-7}) {
    OneElement tip(ElementType::tet10);
    for (const CellEdge& edge : cell(tip.type).edges)
      if (edge.a == 0 || edge.b == 0)
        for (std::size_t c = 0; c < 3; ++c) tip.coordinates[3 * edge.middle + c] *= 0.5 * (1.0 + off);
    CHECK(tip.det_at({0, 0, 0}) == doctest::Approx(0.0).epsilon(1e-6));
    CHECK_FALSE(is_folded(tip));
    // Moved closer to the corner than a quarter of the edge, the nodes fold the map.
    for (const CellEdge& edge : cell(tip.type).edges)
      if (edge.a == 0 || edge.b == 0)
        for (std::size_t c = 0; c < 3; ++c) tip.coordinates[3 * edge.middle + c] *= 0.9;
    CHECK(is_folded(tip));
  }
  // A hexahedron degenerated to a wedge: two edges of its upper face coincide.
  OneElement wedge(ElementType::hex8);
  for (std::size_t c = 0; c < 3; ++c) {
    wedge.coordinates[3 * 7 + c] = wedge.coordinates[3 * 4 + c];
    wedge.coordinates[3 * 6 + c] = wedge.coordinates[3 * 5 + c];
  }
  CHECK(std::abs(wedge.det_at({-1, -1, 1})) < 1e-12);
  CHECK_FALSE(is_folded(wedge));
}
