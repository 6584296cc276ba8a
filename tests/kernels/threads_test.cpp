// SPDX-License-Identifier: BSD-3-Clause
// Choice of threads by the environment, with identical results; teams that share work once and release
// waiting cores.
#include <doctest/doctest.h>

#include <csignal>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

#include <kacanov/operator.hpp>
#include "bodies.hpp"
#include "operator/team.hpp"
#include "operator/threads.hpp"

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

namespace {

/// Counts how often each share has been done.
struct Counts {
  std::vector<int> of;
  static void count(void* counts, int share) { ++static_cast<Counts*>(counts)->of[share]; }
};

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Sums in two parallel regions, the second of which reads the results of the first.
double sum_in_two_rounds(int threads, int n) {
  std::vector<double> parts(threads), sums(threads);
  in_team(threads, [&](int t) { parts[t] = t + n; });
  in_team(threads, [&](int t) { sums[t] = parts[t] + parts[(t + 1) % threads]; });
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

}  // namespace

TEST_CASE("every share of every round is done once, with fewer shares than a team could have, too") {
  for (const int most : {1, 2, 3, 7}) {
    Team team(most);
    CHECK(team.most_shares() == most);
    CHECK(team.threads() == most);
    for (int round = 0; round < 2000; ++round) {
      const int shares = 1 + round % most;
      Counts counts{std::vector<int>(most, 0)};
      team.run(shares, Counts::count, &counts);
      for (int t = 0; t < most; ++t) REQUIRE(counts.of[t] == (t < shares ? 1 : 0));
    }
  }
}

TEST_CASE("a round begins when all of the one before is done") {
  for (const int threads : {2, 5})
    for (int n = 0; n < 2000; ++n)
      REQUIRE(sum_in_two_rounds(threads, n) == threads * (threads - 1) + 2.0 * threads * n);
}

TEST_CASE("threads of the host have teams of their own") {
  std::vector<int> wrong(4, 0);
  {
    std::vector<std::jthread> hosts;
    for (std::size_t i = 0; i < wrong.size(); ++i)
      hosts.emplace_back([&wrong, i] {
        for (int n = 0; n < 500; ++n) wrong[i] += sum_in_two_rounds(3, n) != 6.0 + 6.0 * n;
      });
  }
  CHECK(wrong == std::vector<int>(4, 0));
}

TEST_CASE("what is shared out within a share is done where it is") {
  std::vector<int> strangers(2, 0);
  in_team(2, [&](int t) {
    const auto here = std::this_thread::get_id();
    in_team(3, [&](int) { strangers[t] += std::this_thread::get_id() != here; });
  });
  CHECK(strangers == std::vector<int>(2, 0));
}

TEST_CASE("what a share throws is thrown once all are done") {
  std::vector<int> done(4, 0);
  const auto work = [&](int t) {
    done[t] = 1;
    if (t % 2 == 1) throw std::runtime_error("odd");
  };
  CHECK_THROWS_WITH(in_team(4, work), "odd");
  CHECK(done == std::vector<int>(4, 1));
  CHECK(sum_in_two_rounds(4, 0) == 12.0);
}

TEST_CASE("threads that wait take no time of the cores") {
  Team team(3);
  Counts counts{std::vector<int>(3, 0)};
  team.run(3, Counts::count, &counts);
  const double before = cpu_seconds();
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  CHECK(cpu_seconds() - before < 0.1);  // 0.6 s if the two helpers spun instead of sleeping
}

TEST_CASE("who has waited for long waits less long awake, and no longer than before where it helps") {
  Patience patience(1);
  const auto most = patience.now();
  REQUIRE(most > std::chrono::nanoseconds(0));
  patience.has_waited(most * 2);
  CHECK(patience.now() < most);
  for (int i = 0; i < 100; ++i) patience.has_waited(most * 100);
  CHECK(patience.now() > std::chrono::nanoseconds(0));
  CHECK(patience.now() < most / 10);
  patience.has_waited(most);
  CHECK(patience.now() == most);
  CHECK(Patience(100000).now() == std::chrono::nanoseconds(0));
}

TEST_CASE("helpers leave signals to the host's threads") {
  const std::filesystem::path tasks = "/proc/self/task";
  if (!std::filesystem::exists(tasks)) return;
  const auto blocked = [&] {
    int threads = 0;
    for (const auto& task : std::filesystem::directory_iterator(tasks)) {
      std::ifstream file(task.path() / "status");
      for (std::string line; std::getline(file, line);)
        if (line.starts_with("SigBlk:")) {
          const unsigned long long mask = std::stoull(line.substr(7), nullptr, 16);
          threads += ((mask >> (SIGINT - 1)) & 1) != 0 && ((mask >> (SIGTERM - 1)) & 1) != 0;
        }
    }
    return threads;
  };
  const int before = blocked();
  const Team team(4);
  CHECK(blocked() == before + team.threads() - 1);
}
