// SPDX-License-Identifier: BSD-3-Clause
// Maps from the reference element (volume, range of det J, thinness), batched and one by one.
#include "operator/element_maps.hpp"

#include <doctest/doctest.h>

#include <random>
#include <vector>

#include <kacanov/cells.hpp>

using namespace kacanov;

namespace {

constexpr ElementType every_type[] = {ElementType::tri3, ElementType::quad4, ElementType::tet4,
                                      ElementType::tet10, ElementType::hex8};

/// Elements that share no nodes: each is the reference element with its nodes moved by `map(element, node)`.
struct Elements {
  std::vector<double> coordinates;
  std::vector<std::int32_t> connectivity;
  ElementType type;

  template <class Map>
  Elements(ElementType of, std::size_t count, const Map& map) : type(of) {
    const Cell& cell = kacanov::cell(of);
    for (std::size_t e = 0; e < count; ++e)
      for (const auto& at : cell.reference) {
        connectivity.push_back(static_cast<std::int32_t>(connectivity.size()));
        const auto x = map(e, at);
        coordinates.insert(coordinates.end(), x.begin(), x.begin() + cell.dim);
      }
  }
  MeshView view() const { return {type, coordinates, connectivity, PlaneState::strain}; }
};

}  // namespace

TEST_CASE("batched maps are those of one element after the other") {
  for (const ElementType type : every_type)
    for (const std::size_t count : {std::size_t{1}, std::size_t{16}, std::size_t{37}}) {
      CAPTURE(cell(type).name);
      CAPTURE(count);
      std::minstd_rand draw;
      std::uniform_real_distribution<double> some(-0.3, 0.3);
      const Elements elements(type, count, [&](std::size_t, std::array<double, 3> x) {
        for (double& one : x) one += some(draw);
        return x;
      });
      std::size_t seen = 0;
      visit_element_maps(elements.view(), [&](std::size_t first, std::span<const ElementMap> maps) {
        CHECK(first == seen);
        for (const ElementMap& map : maps) {
          const ElementMap expected = element_map(elements.view(), seen++);
          CHECK(map.volume == doctest::Approx(expected.volume).epsilon(1e-12));
          CHECK(map.least_det == doctest::Approx(expected.least_det).epsilon(1e-12));
          CHECK(map.most_det == doctest::Approx(expected.most_det).epsilon(1e-12));
          CHECK(map.thinness == doctest::Approx(expected.thinness).epsilon(1e-12));
        }
      });
      CHECK(seen == count);
    }
}

TEST_CASE("squeezed, turned round and overflowing elements show it") {
  for (const ElementType type : every_type) {
    CAPTURE(cell(type).name);
    const int dim = cell(type).dim;
    const double whole = cell(type).weight * static_cast<double>(cell(type).points.size());
    for (const double size : {1e-30, 1.0, 1e30})
      for (const double squeeze : {1.0, 1e-4, -1.0, 0.0}) {
        CAPTURE(size);
        CAPTURE(squeeze);
        const Elements elements(type, 3, [&](std::size_t, std::array<double, 3> x) {
          for (double& one : x) one *= size;
          x[0] *= squeeze;
          return x;
        });
        visit_element_maps(elements.view(), [&](std::size_t, std::span<const ElementMap> maps) {
          for (const ElementMap& map : maps) {
            const double det = squeeze * std::pow(size, dim);
            CHECK(map.volume == doctest::Approx(whole * det).epsilon(1e-12));
            CHECK(map.least_det == doctest::Approx(det).epsilon(1e-12));
            CHECK(map.most_det == doctest::Approx(det).epsilon(1e-12));
            if (squeeze == 1.0 || squeeze == -1.0)
              CHECK(map.thinness == doctest::Approx(squeeze));
            else if (squeeze == 0.0)
              CHECK(map.thinness == 0.0);
            else
              CHECK((map.thinness > squeeze && map.thinness < 3.0 * squeeze));
          }
        });
      }
    const Elements huge(type, 1, [](std::size_t, std::array<double, 3> x) {
      for (double& one : x) one *= 1e200;
      return x;
    });
    CHECK(element_map(huge.view(), 0).thinness == 0.0);
    visit_element_maps(huge.view(),
                       [](std::size_t, std::span<const ElementMap> maps) { CHECK(maps[0].thinness == 0.0); });
  }
}
