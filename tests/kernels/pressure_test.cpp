// SPDX-License-Identifier: BSD-3-Clause
// Parts of an operator with tr ε averaged at corners, compared with the reference displacement–pressure form.
#include <doctest/doctest.h>

#include <stdexcept>

#include <kacanov/corner_means.hpp>
#include <kacanov/operator.hpp>
#include <kacanov/reference.hpp>
#include "bodies.hpp"

using namespace kacanov;
using test::difference;
using test::dot;

namespace {

template <class Real>
std::vector<Real> rounded(const std::vector<double>& v) {
  return {v.begin(), v.end()};
}

test::OwnedBody mixed_body(ElementType type, double bent) {
  auto mesh = meshes::box(type, {3, 2, 3}, {1.5, 1.0, 1.2});
  if (bent > 0.0) meshes::jitter(mesh, bent, 3);
  Law law = elastic_law(1.0, 0.3);
  law.mean_dilatation = true;
  return test::with_one_law(std::move(mesh), law);
}

template <class Real>
void check_parts(const test::OwnedBody& owned, const OperatorOptions& options, double tolerance) {
  const Body body = owned.body();
  const CornerMeans means = corner_means(body);
  const std::vector<double> g = test::some_secant(body, 5), x = test::random_vector(body.unknowns(), 6),
                            p = test::random_vector(means.size(), 7);
  std::vector<double> at_nodes(body.mesh.node_count(), 0.0), none(at_nodes), no_motion(x.size(), 0.0);
  for (std::size_t i = 0; i < means.size(); ++i) at_nodes[means.place[i]] = p[i];
  const auto reference = [&](const std::vector<double>& u, const std::vector<double>& pressure) {
    std::pair<std::vector<double>, std::vector<double>> y{std::vector<double>(x.size()),
                                                          std::vector<double>(at_nodes.size())};
    reference::apply_mixed(body, g, {u, pressure}, {y.first, y.second});
    return y;
  };
  BasicOperator<Real> op(body, options);
  op.set_secant(g);
  REQUIRE(op.pressures() == means.size());
  const auto u = rounded<Real>(x), pressure = rounded<Real>(p);
  std::vector<Real> y(x.size(), Real(7)), q(p.size(), Real(7));
  op.apply_deviator(u, {}, y);
  CHECK(difference(y, reference(x, none).first) < tolerance);
  op.apply_deviator(u, pressure, y);
  CHECK(difference(y, reference(x, at_nodes).first) < tolerance);
  op.pressure_force(pressure, y);
  CHECK(difference(y, reference(no_motion, at_nodes).first) < tolerance);
  op.volume_change(u, q);
  std::vector<double> change;
  const auto of_nodes = reference(x, none).second;
  for (std::size_t i = 0; i < means.size(); ++i) change.push_back(of_nodes[means.place[i]]);
  CHECK(difference(q, change) < tolerance);
}

}  // namespace

TEST_CASE("deviator, forces of pressures and volume changes are those of the plain form") {
  for (const auto& body : {std::pair(ElementType::tet10, 0.0), std::pair(ElementType::tet10, 0.03),
                           std::pair(ElementType::tet4, 0.1)}) {
    const ElementType type = body.first;
    const double bent = body.second;
    const auto owned = mixed_body(type, bent);
    for (const char* set : {"avx512", "avx2", "plain"})
      for (const int threads : {1, 2, 3}) {
        CAPTURE(cell(type).name);
        CAPTURE(bent);
        CAPTURE(set);
        CAPTURE(threads);
        try {
          check_parts<double>(owned, {threads, set}, 1e-12);
          check_parts<float>(owned, {threads, set}, 2e-5);
        } catch (const std::invalid_argument&) {  // not supported by this processor
        }
      }
  }
}

TEST_CASE("the parts make up the whole, pressures transpose volume changes, with laws of several moduli") {
  ElementType type = ElementType::tet10;
  SUBCASE("tet10") {}
  SUBCASE("tet4, over patches") { type = ElementType::tet4; }
  const auto owned = test::small_body(type, 3);
  const Body body = owned.body();
  const CornerMeans means = corner_means(body);
  const std::vector<double> g = test::some_secant(body, 5), x = test::random_vector(body.unknowns(), 6),
                            p = test::random_vector(means.size(), 7);
  std::vector<double> change(means.size()), volume(means.size()), y(x.size()), whole(x.size()),
      q(means.size());
  reference::corner_changes(body, means, x, change, volume);
  Operator op(body, {2, ""});
  op.set_secant(g);
  op.volume_change(x, q);
  CHECK(difference(q, change) < 1e-12);
  std::vector<double> mean(means.size());
  for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = means.bulk(i) * change[i] / volume[i];
  op.apply_deviator(x, mean, y);
  op.apply(x, whole);
  CHECK(difference(y, whole) < 1e-12);
  op.pressure_force(p, y);
  CHECK(dot(x, y) == doctest::Approx(dot(p, q)).epsilon(1e-12));
}

TEST_CASE("the deviator's blocks are those of single displacements") {
  ElementType type = ElementType::tet10;
  bool straight = false;
  SUBCASE("tet10") {}
  SUBCASE("tet10 with straight sides") { straight = true; }
  SUBCASE("tet4") { type = ElementType::tet4; }
  auto mesh = meshes::box(type, {3, 2, 2}, {1.5, 1.0, 1.0});
  meshes::jitter(mesh, 0.04, 3);
  if (straight) meshes::straighten(mesh);
  const auto owned = test::with_every_law(std::move(mesh), 3);
  const Body body = owned.body();
  Operator op(body, {2, ""});
  op.set_secant(test::some_secant(body, 5));
  std::vector<double> blocks(3 * body.unknowns()), x(body.unknowns(), 0.0), y(x.size()),
      expected(blocks.size());
  op.block_diagonal_deviator(blocks);
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = 1.0;
    op.apply_deviator(x, {}, y);
    x[i] = 0.0;
    for (std::size_t c = 0; c < 3; ++c) expected[3 * (i - i % 3 + c) + i % 3] = y[i - i % 3 + c];
  }
  CHECK(difference(blocks, expected) < 1e-12);
  std::vector<char> wanted(blocks.size() / 9, 0);
  for (std::size_t node = 1; node < wanted.size(); node += 4) wanted[node] = 1;
  std::vector<double> some(blocks.size());
  op.block_diagonal_deviator(some, wanted);
  for (std::size_t i = 0; i < some.size(); ++i)
    if (wanted[i / 9] != 0) CHECK(some[i] == blocks[i]);
}

TEST_CASE("what has no pressures says so") {
  const auto owned =
      test::with_one_law(meshes::box(ElementType::tet10, {1, 1, 1}, {1, 1, 1}), elastic_law(1.0, 0.3));
  Operator op(owned.body());
  std::vector<double> x(op.unknowns()), y(x.size()), blocks(3 * x.size());
  CHECK(op.pressures() == 0);
  CHECK_THROWS_AS(op.apply_deviator(x, {}, y), std::logic_error);
  CHECK_THROWS_AS(op.pressure_force({}, y), std::logic_error);
  CHECK_THROWS_AS(op.volume_change(x, {}), std::logic_error);
  CHECK_THROWS_AS(op.block_diagonal_deviator(blocks), std::logic_error);
}
