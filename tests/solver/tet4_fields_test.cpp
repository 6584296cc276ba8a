// SPDX-License-Identifier: BSD-3-Clause
// Fields of tet4 some elements abreast: those of the reference, for any number of elements and any law.
#include "tet4_fields.hpp"

#include <doctest/doctest.h>

#include <cmath>

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

}  // namespace

TEST_CASE("tet4 abreast have the fields of the reference") {
  Mesh mesh = box_mesh(ElementType::tet4, {2.0, 1.0, 1.0}, 3);
  map_nodes(mesh, [](const Vector3& x) {
    return Vector3{x[0] + 0.1 * std::sin(3.0 * x[1]), x[1] + 0.05 * x[0] * x[2], 1.2 * x[2]};
  });
  std::vector<double> u(mesh.coordinates.size());
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = 0.02 * std::sin(1.7 * static_cast<double>(i));
  Law log = elastic_law(1.0, 0.3), linear = elastic_law(3.0, 0.45);
  log.form = laws::Logarithmic{0.01};
  const std::vector<Law> laws{log, linear};
  const std::size_t npe = 4;
  for (const std::size_t elements :
       {std::size_t{1}, std::size_t{16}, std::size_t{37}, mesh.element_count()}) {
    CAPTURE(elements);
    std::vector<std::uint16_t> law_of_element(elements);
    for (std::size_t e = 0; e < elements; ++e) law_of_element[e] = e % 3 == 2 ? 1 : 0;
    MeshView view = mesh.view();
    view.connectivity = view.connectivity.first(npe * elements);
    const Body body{view, laws, law_of_element};

    Fields found(elements), expected(elements);
    tet4::fields(body, u, found.all());
    reference::fields(body, u, expected.all());
    check_near(found.stress, expected.stress);
    check_near(found.von_mises, expected.von_mises);
    check_near(found.dev_strain, expected.dev_strain);
    check_near(found.secant, expected.secant);
    check_near(found.strain, expected.strain);
    check_near(found.rotation, expected.rotation);
    check_near(found.volume, expected.volume);
    CHECK(found.plastic == expected.plastic);

    Points points(elements), as_reference(elements);
    tet4::point_fields(body, u, points.all());
    reference::point_fields(body, u, as_reference.all());
    check_near(points.stress, as_reference.stress);
    check_near(points.strain, as_reference.strain);
    check_near(points.volume, as_reference.volume);
    for (std::size_t e = 0; e < elements; ++e) check_near(points.position[e], as_reference.position[e]);

    std::vector<double> volume(elements), reference_volume(elements);
    tet4::volumes(body, volume);
    reference::volumes(body, reference_volume);
    check_near(volume, reference_volume);
    CHECK(tet4::energy(body, u) == doctest::Approx(reference::energy(body, u)).epsilon(1e-12));
  }
}

TEST_CASE("fields of tet4 that nobody asked for are left alone") {
  const Mesh mesh = box_mesh(ElementType::tet4, {1.0, 1.0, 1.0}, 1);
  const std::vector<Law> laws{elastic_law(1.0, 0.3)};
  const Body body{mesh.view(), laws, {}};
  const std::vector<double> u = mesh.coordinates;
  std::vector<double> strain(6 * mesh.element_count());
  tet4::point_fields(body, u, {{}, {}, strain, {}});
  for (std::size_t k = 0; k < strain.size(); ++k) CHECK(strain[k] == doctest::Approx(k % 6 < 3 ? 1.0 : 0.0));
  std::vector<double> von_mises(mesh.element_count(), 1.0);
  reference::ElementFields wanted;
  wanted.von_mises = von_mises;
  tet4::fields(body, u, wanted);
  for (const double one : von_mises) CHECK(std::abs(one) < 1e-12);
}
