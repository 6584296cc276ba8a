// SPDX-License-Identifier: BSD-3-Clause
// User-defined laws, compared with the same built-in laws, and the points at which they are evaluated.
#include <atomic>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include "c_example.hpp"

namespace {

constexpr double yield = 0.01, exponent = 0.3;

/// A host's power law that records the points at which it is evaluated.
struct PowerLaw {
  double shear = 0.0;
  std::mutex mutex;
  std::map<std::pair<std::int32_t, std::int32_t>, double> seen;
  std::size_t largest_batch = 0;
  std::set<const void*> asked;

  static int evaluate(void* data, const kacanov_law_points* points) {
    auto& self = *static_cast<PowerLaw*>(data);
    const double mu = self.shear;
    for (std::size_t i = 0; i < points->count; ++i) {
      const double x = points->x[i], t = x / yield, n = exponent;
      const bool elastic = x <= yield;
      points->g[i] = elastic ? mu : mu * std::pow(t, n - 1.0);
      if (points->slope != nullptr)
        points->slope[i] = elastic ? 0.0 : mu * (n - 1.0) / yield * std::pow(t, n - 2.0);
      if (points->energy != nullptr)
        points->energy[i] = elastic ? 0.5 * mu * x * x
                                    : mu * yield * yield * (0.5 + (std::pow(t, n + 1.0) - 1.0) / (n + 1.0));
    }
    const std::lock_guard lock(self.mutex);
    self.largest_batch = std::max(self.largest_batch, points->count);
    for (std::size_t i = 0; i < points->count; ++i)
      self.seen[{points->element[i], points->point[i]}] = points->x[i];
    return 0;
  }
};

kacanov_law power() {
  kacanov_law law = logarithmic();
  law.kind = KACANOV_POWER;
  law.x0 = yield;
  law.n = exponent;
  return law;
}

kacanov_law own(PowerLaw& host) {
  kacanov_law law = power();
  law.kind = KACANOV_USER;
  law.evaluate = PowerLaw::evaluate;
  law.data = &host;
  host.shear = law.shear;
  return law;
}

/// The vector and the number that a call returns.
struct Answer {
  Vector vector;
  double number = 0.0;
};

/// Returns everything that depends on the law, at the displacement u.
std::map<std::string, Answer> answers(const Handle& op, const Vector& u, const Vector& p) {
  const std::size_t n = u.size();
  kacanov_information about = sized<kacanov_information>();
  REQUIRE(kacanov_inspect(op.get(), &about) == KACANOV_OK);
  const std::size_t points = about.elements * about.points_per_element;
  std::map<std::string, Answer> all;
  const auto vector = [&](const char* name, std::size_t size) -> double* {
    all[name].vector.resize(size);
    return all[name].vector.data();
  };
  const auto run = [](int code) { REQUIRE(code == KACANOV_OK); };
  run(kacanov_residual(op.get(), n, u.data(), vector("residual", n)));
  run(kacanov_energy(op.get(), n, u.data(), &all["energy"].number));
  run(kacanov_apply(op.get(), n, p.data(), vector("apply before", n)));
  run(kacanov_update(op.get(), n, u.data()));
  run(kacanov_secant(op.get(), points, vector("secant", points)));
  run(kacanov_apply(op.get(), n, p.data(), vector("apply", n)));
  run(kacanov_update_tangent(op.get(), n, u.data()));
  run(kacanov_apply_tangent(op.get(), n, p.data(), vector("apply_tangent", n)));
  run(kacanov_apply_tangent_dot(op.get(), n, p.data(), vector("dot", n), &all["dot"].number));
  run(kacanov_diagonal_tangent(op.get(), n, vector("diagonal_tangent", n)));
  run(kacanov_block_diagonal_tangent(op.get(), n * about.dimension, vector("block", n * about.dimension)));
  run(kacanov_diagonal(op.get(), n, vector("diagonal", n)));
  const Vector half = [&] {
    Vector v = u;
    for (double& x : v) x *= 0.5;
    return v;
  }();
  Answer& both = all["both"];
  both.vector.resize(n);
  run(kacanov_residual_energy_update(op.get(), n, half.data(), both.vector.data(), &both.number));
  run(kacanov_apply(op.get(), n, p.data(), vector("apply at half", n)));
  std::vector<float> single(p.begin(), p.end()), image(n);
  run(kacanov_apply_float(op.get(), n, single.data(), image.data()));
  all["apply_float"].vector.assign(image.begin(), image.end());
  std::size_t entries = 0;
  run(kacanov_matrix_entries(op.get(), n, &entries));
  run(kacanov_matrix(op.get(), n, u.data(), entries, nullptr, nullptr, vector("matrix", entries)));
  auto fields = sized<kacanov_fields>();
  std::vector<std::uint8_t> plastic(about.elements);
  fields.elements = about.elements;
  fields.stress = vector("stress", 6 * about.elements);
  fields.von_mises = vector("von_mises", about.elements);
  fields.secant = vector("mean secant", about.elements);
  fields.plastic = plastic.data();
  run(kacanov_stress(op.get(), n, u.data(), &fields));
  all["plastic"].vector.assign(plastic.begin(), plastic.end());
  return all;
}

void check_same(const std::map<std::string, Answer>& a, const std::map<std::string, Answer>& b) {
  for (const auto& entry : a) {
    const std::string& name = entry.first;
    INFO(name);
    const Answer& other = b.at(name);
    if (!entry.second.vector.empty()) CHECK(distance(other.vector, entry.second.vector) < 2e-13);
    CHECK(other.number == doctest::Approx(entry.second.number).epsilon(1e-13));
  }
}

}  // namespace

TEST_CASE("a power law of the caller's own does what the built-in one does") {
  for (const std::int32_t element : all_elements)
    for (const int dilatation : {0, 1}) {
      if (dilatation == 1 && element != KACANOV_HEX8 && element != KACANOV_QUAD4) continue;
      CAPTURE(element);
      CAPTURE(dilatation);
      Example example(element, 3);
      example.description.single = 1;
      example.laws[1] = power();  // the other law stays logarithmic
      for (kacanov_law& law : example.laws) law.mean_dilatation = dilatation;
      const Vector u = random_vector(example.n(), 3, 0.02), p = random_vector(example.n(), 4);
      const auto built_in = answers(example.create(), u, p);
      PowerLaw host;
      example.laws[1] = own(host);
      example.laws[1].mean_dilatation = dilatation;
      const Handle op = example.create();
      check_same(built_in, answers(op, u, p));

      // It was evaluated for its own elements only, at each of their points, with the current strain.
      kacanov_information about = sized<kacanov_information>();
      REQUIRE(kacanov_inspect(op.get(), &about) == KACANOV_OK);
      const std::size_t points = about.points_per_element, count = about.elements * points;
      CHECK(host.seen.size() == about.elements / 2 * points);
      REQUIRE(kacanov_update(op.get(), u.size(), u.data()) == KACANOV_OK);
      Vector x(count), strain(6 * count);
      REQUIRE(kacanov_strain(op.get(), u.size(), u.data(), count, strain.data(), x.data()) == KACANOV_OK);
      for (const auto& entry : host.seen) {
        CHECK(entry.first.first % 2 == 1);
        CHECK(entry.second == x[entry.first.first * points + entry.first.second]);
      }
      for (std::size_t k = 0; k < count; ++k) {
        const double* e = &strain[6 * k];
        const double mean = (e[0] + e[1] + e[2]) / 3.0;
        double square = 2.0 * (e[3] * e[3] + e[4] * e[4] + e[5] * e[5]);
        for (int c = 0; c < 3; ++c) square += (e[c] - mean) * (e[c] - mean);
        CHECK(x[k] == doctest::Approx(std::sqrt(square)).epsilon(1e-12));
      }
    }
}

TEST_CASE("batches are large, and threads ask at once only where they may") {
  Example example(KACANOV_TET4, 14);
  example.description.law_of_element = nullptr;
  example.description.laws = 1;
  example.description.threads = 2;
  example.laws[0] = power();
  example.description.single = 1;
  const Vector u = random_vector(example.n(), 3, 0.02), p = random_vector(example.n(), 4);
  const auto built_in = answers(example.create(), u, p);
  for (const int parallel : {0, 1}) {
    CAPTURE(parallel);
    PowerLaw host;
    example.laws[0] = own(host);
    example.laws[0].parallel = parallel;
    check_same(built_in, answers(example.create(), u, p));
    CHECK(host.largest_batch > 1000);
    CHECK(host.seen.size() == example.mesh.elements());
  }
}

TEST_CASE("a law of the caller's own is checked, and so is what it says") {
  PowerLaw host;
  Example example;
  std::string text;
  const auto refused = [&](const char* words) {
    const int code = example.fault(text);
    CHECK(text.find(words) != std::string::npos);
    return code;
  };
  example.laws[1] = own(host);
  example.laws[1].evaluate = nullptr;
  CHECK(refused("law[1].evaluate") == KACANOV_ERROR_NULL);
  example.laws[1] = own(host);
  example.laws[1].squared = 1;
  CHECK(refused("law[1].squared") == KACANOV_ERROR_LAW);
  example.laws[1] = own(host);
  example.laws[1].shear = 0.0;
  CHECK(refused("law[1].shear") == KACANOV_ERROR_LAW);
  example.laws[1] = own(host);
  example.laws[1].parallel = 2;
  CHECK(refused("law[1].parallel") == KACANOV_ERROR_LAW);
  example.laws[1] = own(host);
  example.laws[1].x0 = -1.0;
  CHECK(refused("law[1].x0") == KACANOV_ERROR_LAW);
  example.laws[1] = power();
  example.laws[1].evaluate = PowerLaw::evaluate;
  CHECK(refused("law[1].evaluate") == KACANOV_ERROR_LAW);

  static double said = 0.0;
  static int code = 0;
  example.laws[1] = own(host);
  example.laws[1].evaluate = [](void*, const kacanov_law_points* points) {
    for (std::size_t i = 0; i < points->count; ++i) {
      points->g[i] = 1.0;
      if (points->slope != nullptr) points->slope[i] = 0.0;
      if (points->energy != nullptr) points->energy[i] = 0.0;
    }
    points->g[0] = said;
    if (points->slope != nullptr) points->slope[0] = said;
    return code;
  };
  const Handle op = example.create();
  const Vector u(example.n(), 0.0);
  Vector f(example.n());
  for (const double g : {0.0, -1.0, nan_value}) {
    said = g;
    CHECK(kacanov_update(op.get(), u.size(), u.data()) == KACANOV_ERROR_LAW);
    CHECK(std::string(kacanov_message(op.get())).find("at element 1, point 0: expected a number > 0") !=
          std::string::npos);
    CHECK(kacanov_residual(op.get(), u.size(), u.data(), f.data()) == KACANOV_ERROR_LAW);
  }
  said = 1.0;
  CHECK(kacanov_update_tangent(op.get(), u.size(), u.data()) == KACANOV_OK);
  code = 5;
  CHECK(kacanov_update(op.get(), u.size(), u.data()) == KACANOV_ERROR_LAW);
  CHECK(std::string(kacanov_message(op.get())).find("returned 5") != std::string::npos);
}

TEST_CASE("points: weights add up to volumes, and each lies next to its corner") {
  for (const std::int32_t element : all_elements) {
    CAPTURE(element);
    Example example(element, 2);
    const Handle op = example.create();
    kacanov_information about = sized<kacanov_information>();
    REQUIRE(kacanov_inspect(op.get(), &about) == KACANOV_OK);
    const std::size_t points = about.points_per_element, count = about.elements * points,
                      dim = about.dimension;
    Vector position(count * dim), weight(count);
    REQUIRE(kacanov_points(op.get(), count, position.data(), weight.data()) == KACANOV_OK);
    CHECK(kacanov_points(op.get(), count + 1, position.data(), weight.data()) == KACANOV_ERROR_SIZE);

    // u = x: twice the energy is the bulk modulus (in 2D the plane one) times the volume, for any mesh.
    kacanov_law law = logarithmic();
    const Vector& u = example.mesh.coordinates;
    Vector f(u.size());
    double work = 0.0, volume = 0.0;
    REQUIRE(kacanov_apply_dot(op.get(), u.size(), u.data(), f.data(), &work) == KACANOV_OK);
    for (const double w : weight) volume += w;
    const double pressure = dim == 3 ? 9.0 * law.bulk : 4.0 * law.bulk + 4.0 / 3.0 * law.shear;
    CHECK(work == doctest::Approx(pressure * volume).epsilon(1e-12));

    for (std::size_t k = 0; k < count && points > 1; ++k) {
      std::vector<double> distances;
      for (std::size_t corner = 0; corner < points; ++corner) {
        const std::size_t node = example.mesh.connectivity[k / points * example.mesh.per_element + corner];
        double square = 0.0;
        for (std::size_t c = 0; c < dim; ++c)
          square += std::pow(position[k * dim + c] - example.mesh.coordinates[node * dim + c], 2);
        distances.push_back(square);
      }
      const auto nearest = std::min_element(distances.begin(), distances.end());
      CHECK(nearest - distances.begin() == static_cast<std::ptrdiff_t>(k % points));
    }
  }
}
