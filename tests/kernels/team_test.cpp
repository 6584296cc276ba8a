// SPDX-License-Identifier: BSD-3-Clause
// Teams of threads that share work: each share is done exactly once, and waiting threads release their cores.
#include "operator/team.hpp"

#include <doctest/doctest.h>

#include <csignal>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <stdexcept>
#include <string>

#include "operator/threads.hpp"

using namespace kacanov;

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
