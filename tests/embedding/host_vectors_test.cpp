// SPDX-License-Identifier: BSD-3-Clause
// Options for distributed hosts and other layouts: interface nodes, empty parts, one array per component.
#include "c_example.hpp"

namespace {

/// A callback that records the values at the interface nodes and then changes them.
struct Early {
  std::vector<std::int32_t> nodes;
  Vector seen;
  int calls = 0;
  static void look(void* data, double* y) {
    auto& self = *static_cast<Early*>(data);
    ++self.calls;
    for (const std::int32_t node : self.nodes) {
      for (std::int32_t c = 0; c < 3; ++c) self.seen.push_back(y[3 * node + c]);
      y[3 * node] = 7.0;
    }
  }
};

}  // namespace

TEST_CASE("values at early nodes are final when the callback sees them, and stay as it leaves them") {
  Example example(KACANOV_TET4, 14);
  const Vector x = random_vector(example.n(), 3);
  Early early;
  for (std::int32_t node = 0; node < 225; node += 2) early.nodes.push_back(node);
  example.description.early = early.nodes.data();
  example.description.early_count = early.nodes.size();
  for (const int threads : {1, 2})
    for (const int tangent : {0, 1}) {
      CAPTURE(threads);
      CAPTURE(tangent);
      example.description.threads = threads;
      const Handle op = example.create();
      early.seen.clear(), early.calls = 0;
      Vector want(x.size()), y(x.size());
      double dot = 0.0, want_dot = 0.0;
      if (tangent == 1) {
        CHECK(kacanov_apply_early(op.get(), x.size(), 1, x.data(), y.data(), &dot, Early::look, &early) ==
              KACANOV_ERROR_STATE);
        REQUIRE(kacanov_update_tangent(op.get(), x.size(), random_vector(x.size(), 5, 0.02).data()) ==
                KACANOV_OK);
        REQUIRE(kacanov_apply_tangent_dot(op.get(), x.size(), x.data(), want.data(), &want_dot) ==
                KACANOV_OK);
      } else {
        REQUIRE(kacanov_apply_dot(op.get(), x.size(), x.data(), want.data(), &want_dot) == KACANOV_OK);
      }
      REQUIRE(kacanov_apply_early(op.get(), x.size(), tangent, x.data(), y.data(), &dot, Early::look,
                                  &early) == KACANOV_OK);
      CHECK(early.calls == 1);
      CHECK(dot == want_dot);
      for (std::size_t i = 0; i < early.nodes.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) {
          const std::size_t at = 3 * static_cast<std::size_t>(early.nodes[i]) + c;
          CHECK(early.seen[3 * i + c] == want[at]);
          if (c == 0) {
            CHECK(y[at] == 7.0);
            want[at] = 7.0;
          }
        }
      CHECK(y == want);
      const std::int32_t held = 0;
      REQUIRE(kacanov_constrain(op.get(), 1, &held) == KACANOV_OK);
      CHECK(kacanov_apply_early(op.get(), x.size(), 0, x.data(), y.data(), nullptr, Early::look, &early) ==
            KACANOV_ERROR_STATE);
    }
  std::string text;
  early.nodes[3] = 1 << 20;
  CHECK(example.fault(text) == KACANOV_ERROR_VALUE);
  CHECK(text.find("early") != std::string::npos);
}

TEST_CASE("a process may have no elements where it says so, and no nodes") {
  for (const std::int32_t element : all_elements)
    for (const bool nodes : {true, false}) {
      CAPTURE(element);
      CAPTURE(nodes);
      Example example(element, 12);
      example.description.elements = 0;
      example.description.connectivity = nullptr;
      example.description.law_of_element = nullptr;
      example.description.threads = 2;
      example.description.single = 1;
      if (!nodes) example.description.nodes = 0, example.description.coordinates = nullptr;
      std::string text;
      CHECK(example.fault(text) != KACANOV_OK);
      example.description.may_be_empty = 1;
      const Handle op = example.create();
      const std::size_t n = nodes ? example.n() : 0;
      const Vector x = random_vector(n, 1);
      Vector y(n, 1.0);
      double dot = 1.0, energy = 1.0;
      CHECK(kacanov_update(op.get(), n, x.data()) == KACANOV_OK);
      CHECK(kacanov_update_tangent(op.get(), n, x.data()) == KACANOV_OK);
      CHECK(kacanov_apply_dot(op.get(), n, x.data(), y.data(), &dot) == KACANOV_OK);
      CHECK(y == Vector(n, 0.0));
      CHECK(dot == 0.0);
      y.assign(n, 1.0);
      CHECK(kacanov_apply_tangent(op.get(), n, x.data(), y.data()) == KACANOV_OK);
      CHECK(y == Vector(n, 0.0));
      CHECK(kacanov_apply_early(
                op.get(), n, 0, x.data(), y.data(), &dot, [](void*, double*) {}, nullptr) == KACANOV_OK);
      CHECK(kacanov_residual_energy_update(op.get(), n, x.data(), y.data(), &energy) == KACANOV_OK);
      CHECK(energy == 0.0);
      CHECK(kacanov_diagonal(op.get(), n, y.data()) == KACANOV_OK);
      CHECK(kacanov_diagonal_tangent(op.get(), n, y.data()) == KACANOV_OK);
      const std::vector<float> single(n, 1.0F);
      std::vector<float> image(n, 1.0F);
      CHECK(kacanov_apply_tangent_float(op.get(), n, single.data(), image.data()) == KACANOV_OK);
      CHECK(image == std::vector<float>(n, 0.0F));
      CHECK(kacanov_points(op.get(), 0, nullptr, nullptr) == KACANOV_OK);
      auto fields = sized<kacanov_fields>();
      CHECK(kacanov_stress(op.get(), n, x.data(), &fields) == KACANOV_OK);
      std::size_t entries = 1;
      CHECK(kacanov_matrix_entries(op.get(), n, &entries) == KACANOV_OK);
      kacanov_multigrid* multigrid = nullptr;
      CHECK(kacanov_multigrid_create(op.get(), nullptr, &multigrid) == KACANOV_ERROR_STATE);
      kacanov_information about = sized<kacanov_information>();
      CHECK(kacanov_inspect(op.get(), &about) == KACANOV_OK);
      CHECK(about.elements == 0);
    }
}

namespace {

/// Converts interleaved vectors to one array per component, or back.
template <class Real>
std::vector<Real> split(const std::vector<Real>& x, std::size_t dim, std::size_t n, bool back = false) {
  std::vector<Real> out(x.size());
  const std::size_t nodes = n / dim;
  for (std::size_t v = 0; v < x.size(); v += n)
    for (std::size_t i = 0; i < nodes; ++i)
      for (std::size_t c = 0; c < dim; ++c) {
        const std::size_t whole = v + i * dim + c, part = v + c * nodes + i;
        out[back ? whole : part] = x[back ? part : whole];
      }
  return out;
}

}  // namespace

TEST_CASE("vectors may have one array a component") {
  for (const std::int32_t element : {KACANOV_TET4, KACANOV_QUAD4}) {
    CAPTURE(element);
    Example example(element, 6);
    example.description.single = 1;
    const Handle plain = example.create();
    example.description.component_vectors = 1;
    const Handle other = example.create();
    const std::size_t n = example.n(), dim = example.mesh.dim;
    const Vector u = random_vector(n, 2, 0.02), x = random_vector(3 * n, 3);
    // Checks that a call gives the same numbers on both handles, compared in interleaved form.
    const auto same = [&](const Vector& in, const auto& call) {
      Vector want(in.size(), 0.5), got(in.size());
      REQUIRE(call(plain.get(), in.data(), want.data()) == KACANOV_OK);
      got = split(Vector(in.size(), 0.5), dim, n);
      REQUIRE(call(other.get(), split(in, dim, n).data(), got.data()) == KACANOV_OK);
      CHECK(split(got, dim, n, true) == want);
    };
    const std::vector<std::int32_t> held = [&] {
      std::vector<std::int32_t> all;
      for (std::size_t i = 0; i < 7 * dim; ++i) all.push_back(static_cast<std::int32_t>(i));
      return all;
    }();
    for (const Handle* op : {&plain, &other})
      REQUIRE(kacanov_constrain(op->get(), held.size(), held.data()) == KACANOV_OK);
    same(u, [&](auto* op, const double* in, double* out) { return kacanov_residual(op, n, in, out); });
    same(u, [&](auto* op, const double* in, double*) { return kacanov_update_tangent(op, n, in); });
    const Vector one(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(n));
    same(one, [&](auto* op, const double* in, double* out) { return kacanov_apply(op, n, in, out); });
    same(one, [&](auto* op, const double* in, double* out) {
      return kacanov_apply_add(op, n, 2.0, in, -3.0, out);
    });
    same(one, [&](auto* op, const double* in, double* out) { return kacanov_apply_tangent(op, n, in, out); });
    same(one, [&](auto* op, const double*, double* out) { return kacanov_diagonal(op, n, out); });
    same(x, [&](auto* op, const double* in, double* out) { return kacanov_apply_many(op, n, 3, in, out); });
    same(x, [&](auto* op, const double* in, double* out) {
      const std::vector<float> single(in, in + 3 * n);
      std::vector<float> image(3 * n);
      const int code = kacanov_apply_tangent_many_float(op, n, 3, single.data(), image.data());
      std::copy(image.begin(), image.end(), out);
      return code;
    });
    same(one, [&](auto* op, const double* in, double* out) {
      kacanov_multigrid* multigrid = nullptr;
      int code = kacanov_multigrid_create(op, nullptr, &multigrid);
      if (code == KACANOV_OK) code = kacanov_multigrid_apply(multigrid, n, in, out);
      auto result = sized<kacanov_cg_result>();
      if (code == KACANOV_OK) code = kacanov_cg(op, multigrid, nullptr, n, in, out, &result);
      CHECK(result.converged == 1);
      kacanov_multigrid_destroy(multigrid);
      return code;
    });
    Vector sum(n, 0.5);
    CHECK(kacanov_apply_early(
              other.get(), n, 0, one.data(), sum.data(), nullptr, [](void*, double*) {}, nullptr) ==
          KACANOV_ERROR_STATE);
  }
}
