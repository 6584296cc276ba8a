// SPDX-License-Identifier: BSD-3-Clause
// Patches of nodes for pressures: composition, and independence of the node numbering.
#include <kacanov/pressure_patches.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <kacanov/corner_means.hpp>
#include "bodies.hpp"

using namespace kacanov;

namespace {

using Point = std::array<double, 3>;

test::OwnedBody patched(meshes::OwnedMesh mesh) {
  Law law = elastic_law(1.0, 0.3);
  law.mean_dilatation = true;
  auto owned = test::with_one_law(std::move(mesh), law);
  owned.make_patches();
  return owned;
}

Point position(const test::OwnedBody& owned, std::size_t node) {
  const double* x = &owned.mesh.coordinates[3 * node];
  return {x[0], x[1], x[2]};
}

std::map<std::int64_t, std::set<Point>> patches_of(const test::OwnedBody& owned) {
  std::map<std::int64_t, std::set<Point>> all;
  for (std::size_t n = 0; n < owned.pressure_patch.size(); ++n)
    all[owned.pressure_patch[n]].insert(position(owned, n));
  return all;
}

}  // namespace

TEST_CASE("patches are named after one of their nodes, are some nodes wide and not small") {
  auto mesh = meshes::box(ElementType::tet4, {11, 9, 10}, {11, 9, 10});
  meshes::jitter(mesh, 0.1, 3);
  const auto owned = patched(std::move(mesh));
  const auto all = patches_of(owned);
  CHECK(owned.pressure_patch.size() / all.size() > 8);
  CHECK(owned.pressure_patch.size() / all.size() < 27);
  for (const auto& [name, nodes] : all) {
    CHECK(nodes.count(position(owned, static_cast<std::size_t>(name))) == 1);
    CHECK(nodes.size() >= 4);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax_element(
          nodes.begin(), nodes.end(), [k](const Point& a, const Point& b) { return a[k] < b[k]; });
      CHECK((*high)[k] - (*low)[k] < 5.0);
    }
  }
}

TEST_CASE("patches do not depend on how nodes and elements are numbered") {
  auto mesh = meshes::box(ElementType::tet4, {8, 6, 5}, {8, 6, 5});
  const auto owned = patched(mesh);
  meshes::shuffle(mesh, 17);
  const auto shuffled = patched(std::move(mesh));
  std::set<std::set<Point>> one, other;
  for (const auto& [name, nodes] : patches_of(owned)) one.insert(nodes);
  for (const auto& [name, nodes] : patches_of(shuffled)) other.insert(nodes);
  CHECK(one == other);
}

TEST_CASE("the nodes of a patch hang together by edges") {
  auto mesh = meshes::box(ElementType::tet4, {9, 7, 6}, {9, 7, 6});
  meshes::jitter(mesh, 0.2, 5);
  meshes::shuffle(mesh, 18);
  const auto owned = patched(std::move(mesh));
  const std::vector<std::int64_t>& patch = owned.pressure_patch;
  std::vector<std::size_t> least(
      patch.size());  // smallest node number in the node's connected component within its patch
  for (std::size_t n = 0; n < least.size(); ++n) least[n] = n;
  for (bool more = true; std::exchange(more, false);)
    for (std::size_t k = 0; k < owned.mesh.connectivity.size(); ++k)
      for (std::size_t other = k / 4 * 4; other < k / 4 * 4 + 4; ++other) {
        const std::size_t a = owned.mesh.connectivity[k], b = owned.mesh.connectivity[other];
        if (patch[a] == patch[b] && least[a] < least[b]) least[b] = least[a], more = true;
      }
  std::map<std::int64_t, std::set<std::size_t>> pieces;
  for (std::size_t n = 0; n < least.size(); ++n) pieces[patch[n]].insert(least[n]);
  for (const auto& [name, of] : pieces) CHECK(of.size() == 1);
}

TEST_CASE("patches do not reach across a slit") {
  // Two slabs above each other that share no nodes, with a gap smaller than the mesh size.
  auto mesh = meshes::box(ElementType::tet4, {6, 6, 3}, {6, 6, 3});
  const std::size_t coordinates = mesh.coordinates.size(), connectivity = mesh.connectivity.size();
  const auto nodes = static_cast<std::int32_t>(coordinates / 3);
  for (std::size_t i = 0; i < coordinates; ++i)
    mesh.coordinates.push_back(mesh.coordinates[i] + (i % 3 == 2 ? 3.01 : 0.0));
  for (std::size_t i = 0; i < connectivity; ++i) mesh.connectivity.push_back(mesh.connectivity[i] + nodes);
  const auto owned = patched(std::move(mesh));
  for (const auto& [name, points] : patches_of(owned)) {
    const bool above = (*points.begin())[2] > 3.005;
    CHECK(std::all_of(points.begin(), points.end(), [&](const Point& x) { return (x[2] > 3.005) == above; }));
  }
}

TEST_CASE("a patch has one mean for every bulk modulus that meets there, and means of constants are these") {
  const auto owned = test::small_body(ElementType::tet4, 3);
  const Body body = owned.body();
  const CornerMeans means = corner_means(body);
  REQUIRE(means.has_patches);
  CHECK(means.moduli.size() == 2);
  std::set<std::pair<std::int64_t, std::int32_t>> seen;
  for (std::size_t i = 0; i < means.size(); ++i) CHECK(seen.emplace(means.place[i], means.modulus[i]).second);
  CHECK(std::is_sorted(means.place.begin(), means.place.end()));
  for (std::size_t k = 0; k < means.of_element.size(); ++k) {
    const std::int32_t entry = means.of_element[k];
    if (!averages_at_corners(body.law(k / 4), body.mesh.type)) {
      CHECK(entry == -1);
      continue;
    }
    REQUIRE(entry >= 0);
    CHECK(means.place[entry] == body.pressure_patch[body.mesh.connectivity[k]]);
    CHECK(means.bulk(entry) == body.law(k / 4).bulk);
  }
  std::vector<double> u(body.unknowns()), change(means.size()), volume(means.size());
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = 0.01 * body.mesh.coordinates[i];
  reference::corner_changes(body, means, u, change, volume);
  for (std::size_t i = 0; i < means.size(); ++i) CHECK(change[i] / volume[i] == doctest::Approx(0.03));
}

TEST_CASE("nothing averages, no patches") {
  auto owned =
      test::with_one_law(meshes::box(ElementType::tet4, {2, 2, 2}, {1, 1, 1}), elastic_law(1.0, 0.3));
  owned.make_patches();
  CHECK(owned.pressure_patch.empty());
  owned = patched(meshes::box(ElementType::tet10, {2, 2, 2}, {1, 1, 1}));
  CHECK(owned.pressure_patch.empty());
}
