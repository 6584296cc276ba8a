// SPDX-License-Identifier: BSD-3-Clause
// Choice of threads by the environment (the library's own or OpenMP's), with identical results.
#include "operator/threads.hpp"

#include <doctest/doctest.h>

#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

#include <kacanov/operator.hpp>
#include "bodies.hpp"

using namespace kacanov;

namespace {

/// Sets KACANOV_THREADS for the lifetime of the object, then restores its value and the choice of threads.
class ChoiceOfThreads {
 public:
  explicit ChoiceOfThreads(const char* value) {
    if (const char* now = std::getenv(name)) before_ = now;
    setenv(name, value, 1);
  }
  ~ChoiceOfThreads() {
    if (before_) {
      setenv(name, before_->c_str(), 1);
    } else {
      unsetenv(name);
    }
    start_team(1);
  }
  ChoiceOfThreads(const ChoiceOfThreads&) = delete;
  ChoiceOfThreads& operator=(const ChoiceOfThreads&) = delete;

 private:
  static constexpr const char* name = "KACANOV_THREADS";
  std::optional<std::string> before_;
};

struct Products {
  std::vector<double> y, diagonal;
  double dot = 0.0;
  bool operator==(const Products&) const = default;
};

Products products(const Body& body, int threads) {
  Operator op(body, {threads, {}});
  const auto u = test::random_vector(body.unknowns(), 3);
  op.update(u);
  Products out{std::vector<double>(u.size()), std::vector<double>(u.size()), 0.0};
  out.dot = op.apply_dot(u, out.y);
  op.diagonal(out.diagonal);
  return out;
}

}  // namespace

TEST_CASE("the same bits on the library's own threads and on OpenMP's") {
  auto mesh = meshes::box(ElementType::tet4, {12, 9, 9}, {2, 1, 1});
  meshes::jitter(mesh, 0.1, 1);
  const auto owned = test::with_every_law(std::move(mesh), 2);
  const Body body = owned.body();
  for (const int threads : {1, 2, 3, 7}) {
    CAPTURE(threads);
    std::optional<Products> own;
    for (const char* whose : {"own", "openmp", ""}) {
      CAPTURE(whose);
      const ChoiceOfThreads choice(whose);
      const Products now = products(body, threads);
      if (!own) own = now;
      CHECK(now == *own);
    }
  }
}

TEST_CASE("each of OpenMP's threads does its own share, round after round") {
  const ChoiceOfThreads choice("openmp");
  start_team(3);
  std::vector<std::thread::id> first(3);
  in_team(3, [&](int t) { first[t] = std::this_thread::get_id(); });
  CHECK(first[0] == std::this_thread::get_id());
  CHECK(first[1] != first[0]);
  CHECK(first[2] != first[0]);
  CHECK(first[2] != first[1]);
  std::vector<int> done(3, 0), elsewhere(3, 0);
  for (int round = 0; round < 100; ++round)
    in_team(3, [&](int t) {
      ++done[t];
      elsewhere[t] += std::this_thread::get_id() != first[t];
    });
  CHECK(done == std::vector<int>(3, 100));
  CHECK(elsewhere == std::vector<int>(3, 0));
}

TEST_CASE("a choice of threads that does not exist is refused, whatever their number") {
  const auto owned = test::small_body(ElementType::tet4, 1);
  for (const int threads : {1, 2}) {
    const ChoiceOfThreads choice("OpenMP");
    CHECK_THROWS_WITH_AS(Operator(owned.body(), {threads, {}}),
                         doctest::Contains("expected own or openmp, got \"OpenMP\""), std::invalid_argument);
  }
}
