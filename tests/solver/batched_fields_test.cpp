// SPDX-License-Identifier: BSD-3-Clause
// Batched element fields of tet4, tet10 and hex8 against the reference, for any number of elements and any
// law.
#include <doctest/doctest.h>

#include <cmath>

#include "recovery/element_batch.hpp"
#include "support.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

void check_near(std::span<const double> found, std::span<const double> expected) {
  double largest = 0.0, apart = 0.0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    largest = std::max(largest, std::abs(expected[i]));
    apart = std::max(apart, std::abs(found[i] - expected[i]));
  }
  CHECK(largest > 0.0);
  CHECK(apart < 1e-12 * largest);
}

struct Fields {
  std::vector<double> stress, von_mises, dev_strain, secant, strain, rotation, volume;
  std::vector<std::uint8_t> plastic;
  explicit Fields(std::size_t n)
      : stress(6 * n),
        von_mises(n),
        dev_strain(n),
        secant(n),
        strain(n),
        rotation(n),
        volume(n),
        plastic(n) {}
  reference::ElementFields all() {
    return {stress, von_mises, dev_strain, secant, plastic, strain, rotation, volume};
  }
};

struct Points {
  std::vector<Vector3> position;
  std::vector<double> stress, strain, volume;
  explicit Points(std::size_t n) : position(n), stress(6 * n), strain(6 * n), volume(n) {}
  reference::PointFields all() { return {position, stress, strain, volume}; }
};

constexpr ElementType batched_types[] = {ElementType::tet4, ElementType::tet10, ElementType::hex8};

void compare_with_reference(ElementType type, bool mean_dilatation) {
  const FieldLoops& fast = field_loops(type);
  CAPTURE(cell(type).name);
  CAPTURE(mean_dilatation);
  Mesh mesh = box_mesh(type, {2.0, 1.0, 1.0}, 3);
  map_nodes(mesh, [](const Vector3& x) {
    return Vector3{x[0] + 0.1 * std::sin(3.0 * x[1]), x[1] + 0.05 * x[0] * x[2], 1.2 * x[2]};
  });
  std::vector<double> u(mesh.coordinates.size());
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = 0.02 * std::sin(1.7 * static_cast<double>(i));
  Law log = elastic_law(1.0, 0.3), linear = elastic_law(3.0, 0.45);
  log.form = laws::Logarithmic{0.01};
  log.mean_dilatation = mean_dilatation;
  const std::vector<Law> laws{log, linear};
  const auto npe = static_cast<std::size_t>(nodes_per_element(type));
  const auto points_each = static_cast<std::size_t>(points_per_element(type));
  for (const std::size_t elements :
       {std::size_t{1}, std::size_t{16}, std::size_t{37}, mesh.element_count()}) {
    if (elements > mesh.element_count()) continue;
    CAPTURE(elements);
    std::vector<std::uint16_t> law_of_element(elements);
    for (std::size_t e = 0; e < elements; ++e) law_of_element[e] = e % 3 == 2 ? 1 : 0;
    MeshView view = mesh.view();
    view.connectivity = view.connectivity.first(npe * elements);
    const Body body{view, laws, law_of_element};

    Fields found(elements), expected(elements);
    fast.fields(body, u, found.all());
    reference::fields(body, u, expected.all());
    check_near(found.stress, expected.stress);
    check_near(found.von_mises, expected.von_mises);
    check_near(found.dev_strain, expected.dev_strain);
    check_near(found.secant, expected.secant);
    check_near(found.strain, expected.strain);
    check_near(found.rotation, expected.rotation);
    check_near(found.volume, expected.volume);
    CHECK(found.plastic == expected.plastic);

    Points points(elements * points_each), as_reference(elements * points_each);
    fast.point_fields(body, u, points.all());
    reference::point_fields(body, u, as_reference.all());
    check_near(points.stress, as_reference.stress);
    check_near(points.strain, as_reference.strain);
    check_near(points.volume, as_reference.volume);
    for (std::size_t k = 0; k < points.position.size(); ++k)
      check_near(points.position[k], as_reference.position[k]);

    std::vector<double> volume(elements), reference_volume(elements);
    fast.volumes(body, volume);
    reference::volumes(body, reference_volume);
    check_near(volume, reference_volume);
    CHECK(fast.energy(body, u) == doctest::Approx(reference::energy(body, u)).epsilon(1e-12));
  }
}

}  // namespace

TEST_CASE("batches of elements have the fields of the reference") {
  for (const ElementType type : batched_types) compare_with_reference(type, false);
  for (const ElementType type : batched_types) compare_with_reference(type, true);
}

TEST_CASE("fields that nobody asked for are left alone") {
  for (const ElementType type : batched_types) {
    const FieldLoops& fast = field_loops(type);
    CAPTURE(cell(type).name);
    const Mesh mesh = box_mesh(type, {1.0, 1.0, 1.0}, 1);
    const std::vector<Law> laws{elastic_law(1.0, 0.3)};
    const Body body{mesh.view(), laws, {}};
    const std::vector<double> u = mesh.coordinates;
    std::vector<double> strain(6 * mesh.element_count() * static_cast<std::size_t>(points_per_element(type)));
    fast.point_fields(body, u, {{}, {}, strain, {}});
    for (std::size_t k = 0; k < strain.size(); ++k)
      CHECK(strain[k] == doctest::Approx(k % 6 < 3 ? 1.0 : 0.0));
    std::vector<double> von_mises(mesh.element_count(), 1.0);
    reference::ElementFields wanted;
    wanted.von_mises = von_mises;
    fast.fields(body, u, wanted);
    for (const double one : von_mises) CHECK(std::abs(one) < 1e-12);
  }
}
