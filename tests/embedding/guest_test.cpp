// SPDX-License-Identifier: BSD-3-Clause
// The C interface as a guest in the host's process: random numbers, threads and forks of the host.
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <thread>

#include "c_example.hpp"

namespace {

/// A body large enough for two threads.
struct Guest : Example {
  Guest() : Example(KACANOV_TET4, 14) { description.threads = 2; }
};

std::vector<int> drawn(int count) {
  std::vector<int> numbers;
  for (int i = 0; i < count; ++i) numbers.push_back(std::rand());
  return numbers;
}

/// Returns the exit status of a child process that runs `work`, or −1 after ten seconds.
template <class Work>
int in_child(const Work& work) {
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    alarm(10);
    _exit(work());
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

TEST_CASE("the host's random numbers go on as if no operator had been made") {
  const Guest guest;
  std::srand(7);
  const auto want = drawn(20);
  std::srand(7);
  auto got = drawn(10);
  guest.create();
  for (const int number : drawn(10)) got.push_back(number);
  CHECK(got == want);
}

TEST_CASE("operators made at the same time are the same") {
  const Guest guest;
  const Vector x = random_vector(guest.n(), 3);
  const Vector want = applied(guest.create(), x);
  std::vector<Vector> got(6);
  {
    std::vector<std::jthread> threads;
    for (Vector& y : got)
      threads.emplace_back([&guest, &x, &y] {
        kacanov_operator* op = nullptr;
        if (kacanov_create(&guest.description, &op, nullptr, 0) != KACANOV_OK) return;
        y.resize(x.size());
        kacanov_apply(op, x.size(), x.data(), y.data());
        kacanov_destroy(op);
      });
  }
  for (const Vector& y : got) CHECK(y == want);
}

TEST_CASE("a call on a handle in use is refused, and right where it is not") {
  const Guest guest;
  const Handle op = guest.create();
  const Vector x = random_vector(guest.n(), 5);
  const Vector want = applied(op, x);
  std::atomic<int> done = 0, refused = 0, wrong = 0;
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 2; ++t)
      threads.emplace_back([&] {
        Vector y(x.size());
        for (int i = 0; i < 200; ++i) {
          const int code = kacanov_apply(op.get(), x.size(), x.data(), y.data());
          if (code == KACANOV_ERROR_STATE)
            ++refused;
          else if (code == KACANOV_OK && y == want)
            ++done;
          else
            ++wrong;
        }
      });
  }
  CHECK(wrong == 0);
  CHECK(done + refused == 400);
  CHECK(done > 0);
  CHECK(applied(op, x) == want);  // the handle is free again
}

TEST_CASE("small bodies use fewer threads than they may") {
  Example small;
  small.description.threads = 2;
  auto about = sized<kacanov_information>();
  REQUIRE(kacanov_inspect(small.create().get(), &about) == KACANOV_OK);
  CHECK(about.threads == 1);
  const Guest guest;
  REQUIRE(kacanov_inspect(guest.create().get(), &about) == KACANOV_OK);
  CHECK(about.threads == 2);
}

TEST_CASE("a child made by fork solves with its parent's multigrid") {
  const Guest guest;
  const Handle op = guest.create();
  std::vector<std::int32_t> held;
  for (std::int32_t i = 0; i < 300; ++i) held.push_back(i);
  REQUIRE(kacanov_constrain(op.get(), held.size(), held.data()) == KACANOV_OK);
  kacanov_multigrid* multigrid = nullptr;
  REQUIRE(kacanov_multigrid_create(op.get(), nullptr, &multigrid) == KACANOV_OK);
  const Vector b = random_vector(guest.n(), 3);
  const auto solved = [&] {
    Vector x(b.size(), 0.0);
    auto result = sized<kacanov_cg_result>();
    const int code = kacanov_cg(op.get(), multigrid, nullptr, b.size(), b.data(), x.data(), &result);
    return code == KACANOV_OK && result.converged == 1 ? x : Vector();
  };
  const Vector want = solved();
  CHECK(want.size() == b.size());
  CHECK(in_child([&] { return solved() == want ? 0 : 1; }) == 0);
  CHECK(in_child([&] {
          return kacanov_multigrid_update(multigrid) == KACANOV_OK && solved() == want ? 0 : 1;
        }) == 0);
  CHECK(solved() == want);
  kacanov_multigrid_destroy(multigrid);
}

TEST_CASE("a child made by fork applies its parent's operators, and makes its own") {
  const Guest guest;
  const Vector x = random_vector(guest.n(), 3);
  const Handle op = guest.create();
  const Vector want = applied(op, x);
  CHECK(in_child([&] { return applied(op, x) == want ? 0 : 1; }) == 0);
  CHECK(in_child([&] { return applied(guest.create(), x) == want ? 0 : 1; }) == 0);
  CHECK(applied(op, x) == want);
}
