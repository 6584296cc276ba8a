// SPDX-License-Identifier: BSD-3-Clause
// Constraints, penalties, multigrid and conjugate gradients through the C interface, and invalid input to
// them.
#include "multigrid/multigrid.hpp"

#include "c_example.hpp"

namespace {

Vector preconditioned(const MultigridHandle& multigrid, const Vector& r) {
  Vector z(r.size());
  REQUIRE(kacanov_multigrid_apply(multigrid.get(), r.size(), r.data(), z.data()) == KACANOV_OK);
  return z;
}

double dot(const Vector& x, const Vector& y) {
  double sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += x[i] * y[i];
  return sum;
}

/// Returns the operator as a dense matrix, from the assembled compressed rows.
std::vector<Vector> dense(const Handle& op, std::size_t n, const double* u) {
  std::size_t entries = 0;
  REQUIRE(kacanov_matrix_entries(op.get(), n, &entries) == KACANOV_OK);
  std::vector<std::int64_t> first(n + 1);
  std::vector<std::int32_t> column(entries);
  Vector value(entries);
  REQUIRE(kacanov_matrix(op.get(), n, u, entries, first.data(), column.data(), value.data()) == KACANOV_OK);
  std::vector<Vector> a(n, Vector(n, 0.0));
  for (std::size_t i = 0; i < n; ++i)
    for (std::int64_t k = first[i]; k < first[i + 1]; ++k) a[i][column[k]] = value[k];
  return a;
}

/// Gaussian elimination without pivoting, for positive definite matrices.
Vector solved(std::vector<Vector> a, Vector b) {
  const std::size_t n = b.size();
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t i = k + 1; i < n; ++i) {
      if (a[i][k] == 0.0) continue;
      const double share = a[i][k] / a[k][k];
      for (std::size_t j = k; j < n; ++j) a[i][j] -= share * a[k][j];
      b[i] -= share * b[k];
    }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) b[k] -= a[k][j] * b[j];
    b[k] /= a[k][k];
  }
  return b;
}

Vector times(const std::vector<Vector>& a, const Vector& x) {
  Vector y;
  for (const Vector& row : a) y.push_back(dot(row, x));
  return y;
}

kacanov_cg_result solve(const Handle& op, const MultigridHandle& multigrid, const Vector& b, Vector& x,
                        double relative, bool tangent = false) {
  auto options = sized<kacanov_cg_options>();
  options.relative = relative;
  options.tangent = tangent ? 1 : 0;
  auto result = sized<kacanov_cg_result>();
  const int code = kacanov_cg(op.get(), multigrid.get(), &options, b.size(), b.data(), x.data(), &result);
  INFO(kacanov_message(op.get()));
  REQUIRE(code == KACANOV_OK);
  return result;
}

}  // namespace

TEST_CASE("constraints and blocks are in every form of the operator") {
  for (const std::int32_t element : all_elements) {
    CAPTURE(element);
    Example example(element);
    example.description.single = 1;
    const Handle op = example.create();
    const std::size_t n = example.n(), dim = example.mesh.dim;
    const Vector u = random_vector(n, 1, 0.1), x = random_vector(n, 2);
    REQUIRE(kacanov_update_tangent(op.get(), n, u.data()) == KACANOV_OK);
    for (const bool tangent : {false, true}) {
      CAPTURE(tangent);
      REQUIRE(kacanov_constrain(op.get(), 0, nullptr) == KACANOV_OK);
      REQUIRE(kacanov_set_blocks(op.get(), 0, nullptr, nullptr) == KACANOV_OK);
      auto want = dense(op, n, tangent ? u.data() : nullptr);
      const Springs springs(example.mesh);
      for (std::size_t s = 0; s < springs.node.size(); ++s)
        for (std::size_t i = 0; i < dim; ++i)
          for (std::size_t j = 0; j < dim; ++j)
            want[springs.node[s] * dim + i][springs.node[s] * dim + j] +=
                springs.block[(s * dim + i) * dim + j];
      for (const std::int32_t i : bottom(example.mesh))
        for (std::size_t j = 0; j < n; ++j)
          want[i][j] = want[j][i] = static_cast<std::size_t>(i) == j ? 1.0 : 0.0;
      hold(op, example.mesh);
      const Vector y = times(want, x);
      CHECK(distance(times(dense(op, n, tangent ? u.data() : nullptr), x), y) < 1e-13);
      Vector got(n), blocks(n * dim);
      double product = 0.0;
      const auto apply = tangent ? kacanov_apply_tangent : kacanov_apply;
      const auto apply_dot = tangent ? kacanov_apply_tangent_dot : kacanov_apply_dot;
      REQUIRE(apply(op.get(), n, x.data(), got.data()) == KACANOV_OK);
      CHECK(distance(got, y) < 1e-6);  // the direction in the tangent's rank-one term is in single precision
      if (!tangent) CHECK(distance(got, y) < 1e-13);
      REQUIRE(apply_dot(op.get(), n, x.data(), got.data(), &product) == KACANOV_OK);
      CHECK(product == doctest::Approx(dot(x, got)).epsilon(1e-12));
      REQUIRE((tangent ? kacanov_diagonal_tangent : kacanov_diagonal)(op.get(), n, got.data()) == KACANOV_OK);
      REQUIRE((tangent ? kacanov_block_diagonal_tangent : kacanov_block_diagonal)(
                  op.get(), n * dim, blocks.data()) == KACANOV_OK);
      for (std::size_t i = 0; i < n; ++i) {
        CHECK(got[i] == doctest::Approx(want[i][i]).epsilon(1e-6));
        for (std::size_t c = 0; c < dim; ++c)
          CHECK(std::abs(blocks[i * dim + c] - want[i][i / dim * dim + c]) < 1e-6 * (1.0 + want[i][i]));
      }
      if (tangent) continue;
      Vector many(x), images(2 * n), sum(n, 1.0);
      many.insert(many.end(), u.begin(), u.end());
      REQUIRE(kacanov_apply_many(op.get(), n, 2, many.data(), images.data()) == KACANOV_OK);
      CHECK(distance(Vector(images.begin(), images.begin() + static_cast<std::ptrdiff_t>(n)), y) < 1e-13);
      CHECK(distance(Vector(images.begin() + static_cast<std::ptrdiff_t>(n), images.end()), times(want, u)) <
            1e-13);
      REQUIRE(kacanov_apply_add(op.get(), n, 2.0, x.data(), 0.5, sum.data()) == KACANOV_OK);
      for (std::size_t i = 0; i < n; ++i)
        CHECK(sum[i] == doctest::Approx(2.0 * y[i] + 0.5).epsilon(1e-10).scale(10.0));
      const std::vector<float> single(x.begin(), x.end());
      std::vector<float> image(n);
      REQUIRE(kacanov_apply_float(op.get(), n, single.data(), image.data()) == KACANOV_OK);
      CHECK(distance(Vector(image.begin(), image.end()), y) < 1e-5);
    }
  }
}

TEST_CASE("conjugate gradients find the dense solution, of secant and tangent, with and without multigrid") {
  for (const std::int32_t element : all_elements) {
    CAPTURE(element);
    const Example example(element);
    const Handle op = example.create();
    const std::size_t n = example.n();
    const Vector u = random_vector(n, 1, 0.05), b = random_vector(n, 2);
    REQUIRE(kacanov_update_tangent(op.get(), n, u.data()) == KACANOV_OK);
    hold(op, example.mesh);
    const MultigridHandle multigrid = multigrid_of(op);
    for (const bool tangent : {false, true}) {
      CAPTURE(tangent);
      const Vector want = solved(dense(op, n, tangent ? u.data() : nullptr), b);
      Vector x = random_vector(n, 3), y(n, 0.0);
      const kacanov_cg_result by_cycles = solve(op, multigrid, b, x, 1e-10, tangent),
                              by_diagonal = solve(op, nullptr, b, y, 1e-10, tangent);
      CHECK(by_cycles.converged == 1);
      CHECK(by_diagonal.converged == 1);
      CHECK(by_cycles.residual <= 1e-10 * by_cycles.first_residual);
      CHECK(distance(x, want) < 1e-6);
      CHECK(distance(y, want) < 1e-6);
    }
  }
}

TEST_CASE("a cycle is symmetric and positive, is the solver's, and does not mind units") {
  for (const std::int32_t element : all_elements) {
    CAPTURE(element);
    Example example(element, element == KACANOV_TET10 ? 3 : 6);
    const Handle op = example.create();
    const std::size_t n = example.n();
    const Vector u = random_vector(n, 1, 0.05);
    REQUIRE(kacanov_update(op.get(), n, u.data()) == KACANOV_OK);
    hold(op, example.mesh);
    const MultigridHandle multigrid = multigrid_of(op);
    const Vector r = random_vector(n, 2), s = random_vector(n, 3), z = preconditioned(multigrid, r),
                 w = preconditioned(multigrid, s);
    CHECK(std::abs(dot(r, w) - dot(s, z)) < 1e-5 * std::sqrt(dot(r, z) * dot(s, w)));
    CHECK(dot(r, z) > 0.0);
    const auto held = bottom(example.mesh);
    for (const std::int32_t i : held) CHECK(z[i] == r[i]);

    // The same multigrid, built directly with the kernels' C++ classes.
    std::vector<kacanov::Law> laws(2);
    for (kacanov::Law& law : laws) law = kacanov::elastic_law(2.0, 0.3);
    kacanov::IndexMap map;
    map.owned = static_cast<std::int32_t>(example.mesh.nodes());
    map.starts = {0, map.owned};
    std::vector<std::uint8_t> mask(n, 0);
    for (const std::int32_t i : held) mask[i] = 1;
    const kacanov::MultigridBody body{
        {{static_cast<kacanov::ElementType>(element), example.mesh.coordinates, example.mesh.connectivity},
         laws,
         example.law_of_element},
        &map,
        mask};
    kacanov::Multigrid plain(body, {});
    auto about = sized<kacanov_information>();
    REQUIRE(kacanov_inspect(op.get(), &about) == KACANOV_OK);
    Vector g(about.elements * static_cast<std::size_t>(about.points_per_element)), expected(n);
    REQUIRE(kacanov_secant(op.get(), g.size(), g.data()) == KACANOV_OK);
    const Springs springs(example.mesh);
    std::vector<kacanov::NodeBlock> blocks;
    const std::size_t size = example.mesh.dim * example.mesh.dim;
    for (std::size_t k = 0; k < springs.node.size(); ++k) {
      blocks.push_back({springs.node[k], {}});
      std::copy_n(&springs.block[k * size], size, blocks.back().value.begin());
    }
    plain.setup(g, blocks, {});
    plain.apply(r, expected);
    for (const std::int32_t i : held) expected[i] = r[i];
    CHECK(distance(z, expected) < 1e-4);

    // The same problem in other units: moduli times 1e18, forces times 1e-60.
    for (kacanov_law& law : example.laws) {
      law.bulk *= 1e18;
      law.shear *= 1e18;
    }
    const Handle stiff = example.create();
    REQUIRE(kacanov_update(stiff.get(), n, u.data()) == KACANOV_OK);
    Springs scaled(example.mesh);
    for (double& v : scaled.block) v *= 1e18;
    REQUIRE(kacanov_constrain(stiff.get(), held.size(), held.data()) == KACANOV_OK);
    REQUIRE(kacanov_set_blocks(stiff.get(), 3, scaled.node.data(), scaled.block.data()) == KACANOV_OK);
    Vector small = r;
    for (double& v : small) v *= 1e-60;
    Vector in_units = preconditioned(multigrid_of(stiff), small);
    for (double& v : in_units) v *= 1e78;
    for (const std::int32_t i : held) in_units[i] = z[i];
    CHECK(distance(in_units, z) < 1e-4);  // scaled moduli round differently
  }
}

TEST_CASE("one and two threads make the same cycle, which takes few iterations") {
  Example example(KACANOV_TET4, 18);
  const std::size_t n = example.n();
  const Vector b = random_vector(n, 2);
  Vector before;
  int iterations = 0;
  for (const int threads : {1, 2}) {
    CAPTURE(threads);
    example.description.threads = threads;
    const Handle op = example.create();
    hold(op, example.mesh);
    const MultigridHandle multigrid = multigrid_of(op);
    const Vector z = preconditioned(multigrid, b);
    if (threads == 2) CHECK(distance(z, before) < 1e-4);
    before = z;
    Vector x(n, 0.0), y(n, 0.0);
    const int its = solve(op, multigrid, b, x, 1e-8).iterations;
    CHECK(its <= 30);
    if (threads == 2) CHECK(std::abs(its - iterations) <= 1);
    iterations = its;
    if (threads == 1) CHECK(solve(op, nullptr, b, y, 1e-8).iterations > 2 * its);
    auto about = sized<kacanov_multigrid_information>();
    REQUIRE(kacanov_multigrid_inspect(multigrid.get(), &about) == KACANOV_OK);
    CHECK(about.levels >= 2);
    CHECK(about.bytes > 40 * n);
    CHECK(about.bytes < 400 * n);
  }
}

TEST_CASE("a multigrid follows its operator when it is updated, and not before") {
  Example example(KACANOV_HEX8, 5);
  const std::size_t n = example.n();
  const Vector r = random_vector(n, 2), u = random_vector(n, 3, 0.3);
  const Handle op = example.create();
  hold(op, example.mesh);
  const MultigridHandle multigrid = multigrid_of(op);
  const Vector first = preconditioned(multigrid, r);
  REQUIRE(kacanov_update(op.get(), n, u.data()) == KACANOV_OK);
  REQUIRE(kacanov_constrain(op.get(), 6, bottom(example.mesh).data()) == KACANOV_OK);
  CHECK(preconditioned(multigrid, r) == first);
  REQUIRE(kacanov_multigrid_update(multigrid.get()) == KACANOV_OK);
  // The aggregates remain those of the first g, so the result is close to a new multigrid's but differs.
  const Vector second = preconditioned(multigrid, r);
  CHECK(second != first);
  Vector x(n, 0.0), y(n, 0.0);
  const int kept = solve(op, multigrid, r, x, 1e-8).iterations,
            anew = solve(op, multigrid_of(op), r, y, 1e-8).iterations;
  CHECK(kept <= anew + 5);
  CHECK(distance(x, y) < 1e-5);
  // Other laws, and fewer of them: the update rebuilds everything.
  REQUIRE(kacanov_set_laws(op.get(), 1, &example.laws[1], example.mesh.elements(), nullptr) == KACANOV_OK);
  CHECK(preconditioned(multigrid, r) == second);
  REQUIRE(kacanov_multigrid_update(multigrid.get()) == KACANOV_OK);
  CHECK(preconditioned(multigrid, r) == preconditioned(multigrid_of(op), r));
}

TEST_CASE("handles may be destroyed in any order") {
  const Example example(KACANOV_TET4, 3);
  const Vector r = random_vector(example.n(), 2);
  Handle op = example.create();
  hold(op, example.mesh);
  const MultigridHandle multigrid = multigrid_of(op);
  const Vector z = preconditioned(multigrid, r);
  op.reset();
  CHECK(preconditioned(multigrid, r) == z);
  REQUIRE(kacanov_multigrid_update(multigrid.get()) == KACANOV_OK);
  CHECK(preconditioned(multigrid, r) == z);
  kacanov_multigrid_destroy(nullptr);
}

TEST_CASE("nodes of no element do not disturb a multigrid") {
  Example example(KACANOV_TET4, 3);
  const std::size_t n = example.n(), lone = 5;
  auto coordinates = example.mesh.coordinates;  // unreferenced nodes before and after
  coordinates.insert(coordinates.begin(), {9, 9, 9, 8, 8, 8});
  coordinates.insert(coordinates.end(), {7, 7, 7, 6, 6, 6, 5, 5, 5});
  auto connectivity = example.mesh.connectivity;
  for (std::int32_t& node : connectivity) node += 2;
  const Handle plain = example.create();
  hold(plain, example.mesh);
  example.description.coordinates = coordinates.data();
  example.description.nodes += lone;
  example.description.connectivity = connectivity.data();
  example.description.orphans = KACANOV_ORPHANS_UNIT;
  const Handle op = example.create();
  auto list = bottom(example.mesh);
  for (std::int32_t& i : list) i += 6;
  list.push_back(1);  // an unreferenced node, whose row is the identity anyway
  Springs springs(example.mesh);
  for (std::int32_t& node : springs.node) node += 2;
  REQUIRE(kacanov_constrain(op.get(), list.size(), list.data()) == KACANOV_OK);
  REQUIRE(kacanov_set_blocks(op.get(), 3, springs.node.data(), springs.block.data()) == KACANOV_OK);
  const Vector r = random_vector(n + 3 * lone, 2);
  const Vector inner(r.begin() + 6, r.begin() + 6 + static_cast<std::ptrdiff_t>(n));
  const Vector z = preconditioned(multigrid_of(op), r);
  CHECK(distance(Vector(z.begin() + 6, z.begin() + 6 + static_cast<std::ptrdiff_t>(n)),
                 preconditioned(multigrid_of(plain), inner)) < 1e-5);
  for (const std::size_t i : {0, 1, 5}) CHECK(z[i] == r[i]);
  CHECK(z.back() == r.back());
  Vector y(r.size());
  double product = 0.0;
  REQUIRE(kacanov_apply_dot(op.get(), r.size(), r.data(), y.data(), &product) == KACANOV_OK);
  CHECK(product == doctest::Approx(dot(r, y)).epsilon(1e-12));
}

TEST_CASE("bad input of constraints, multigrid and solves is named") {
  const Example example;
  const std::size_t n = example.n();
  const Handle op = example.create(), other = example.create();
  const auto says = [&](const std::string& word) {
    return std::string(kacanov_message(op.get())).find(word) != std::string::npos;
  };
  const std::int32_t beyond[] = {0, static_cast<std::int32_t>(n)}, node[] = {-1}, first[] = {0};
  CHECK(kacanov_constrain(op.get(), 2, beyond) == KACANOV_ERROR_VALUE);
  CHECK(says("unknown[1]"));
  CHECK(kacanov_constrain(op.get(), 2, nullptr) == KACANOV_ERROR_NULL);
  CHECK(kacanov_constrain(nullptr, 0, nullptr) == KACANOV_ERROR_NULL);
  Vector block(9, 0.0);
  CHECK(kacanov_set_blocks(op.get(), 1, node, block.data()) == KACANOV_ERROR_VALUE);
  CHECK(says("node[0]"));
  block[1] = 1.0;
  CHECK(kacanov_set_blocks(op.get(), 1, first, block.data()) == KACANOV_ERROR_VALUE);
  CHECK(says("block[0] is not symmetric"));
  block[1] = nan_value;
  CHECK(kacanov_set_blocks(op.get(), 1, first, block.data()) == KACANOV_ERROR_VALUE);
  block[1] = 0.0;
  block[0] = -1.0;
  CHECK(kacanov_set_blocks(op.get(), 1, first, block.data()) == KACANOV_ERROR_VALUE);
  CHECK(says("negative"));
  CHECK(kacanov_set_blocks(op.get(), 1, first, nullptr) == KACANOV_ERROR_NULL);

  kacanov_multigrid* made = nullptr;
  CHECK(kacanov_multigrid_create(op.get(), nullptr, nullptr) == KACANOV_ERROR_NULL);
  CHECK(kacanov_multigrid_create(nullptr, nullptr, &made) == KACANOV_ERROR_NULL);
  auto options = sized<kacanov_multigrid_options>();
  options.aggregate = 1.0;
  CHECK(kacanov_multigrid_create(op.get(), &options, &made) == KACANOV_ERROR_VALUE);
  CHECK(says("options.aggregate"));
  CHECK(made == nullptr);
  options.struct_size = 3;
  CHECK(kacanov_multigrid_create(op.get(), &options, &made) == KACANOV_ERROR_SIZE);
  CHECK(kacanov_multigrid_update(nullptr) == KACANOV_ERROR_NULL);
  CHECK(std::string(kacanov_multigrid_message(nullptr)) != "");

  hold(op, example.mesh);
  const MultigridHandle multigrid = multigrid_of(op);
  Vector b(n, 1.0), x(n, 0.0);
  CHECK(kacanov_multigrid_apply(multigrid.get(), n - 1, b.data(), x.data()) == KACANOV_ERROR_SIZE);
  CHECK(std::string(kacanov_multigrid_message(multigrid.get())).find("n: expected") == 0);
  CHECK(kacanov_multigrid_apply(multigrid.get(), n, b.data(), b.data()) == KACANOV_ERROR_SIZE);
  CHECK(kacanov_multigrid_apply(multigrid.get(), n, nullptr, x.data()) == KACANOV_ERROR_NULL);
  auto result = sized<kacanov_cg_result>();
  auto cg = sized<kacanov_cg_options>();
  const auto solve_with = [&] {
    return kacanov_cg(op.get(), multigrid.get(), &cg, n, b.data(), x.data(), &result);
  };
  CHECK(kacanov_cg(other.get(), multigrid.get(), nullptr, n, b.data(), x.data(), &result) ==
        KACANOV_ERROR_VALUE);
  CHECK(kacanov_cg(op.get(), multigrid.get(), nullptr, n, b.data(), x.data(), nullptr) == KACANOV_ERROR_NULL);
  cg.relative = -1.0;
  CHECK(solve_with() == KACANOV_ERROR_VALUE);
  CHECK(says("options.relative"));
  cg = sized<kacanov_cg_options>();
  cg.tangent = 1;
  CHECK(solve_with() == KACANOV_ERROR_STATE);
  CHECK(says("kacanov_update_tangent"));
  cg.tangent = 0;
  cg.most_iterations = 1;
  CHECK(solve_with() == KACANOV_OK);
  CHECK(result.iterations == 1);
  CHECK(result.converged == 0);
  b[3] = nan_value;
  CHECK(solve_with() == KACANOV_ERROR_VALUE);
  CHECK(says("b[3] is not finite"));
}
