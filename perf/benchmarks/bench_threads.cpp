// SPDX-License-Identifier: BSD-3-Clause
// Overhead of distributing small work over threads, on busy and on idle machines: the kernels' own threads
// and OpenMP's.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "operator/threads.hpp"

namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

struct Options {
  int threads = 2, regions = 300, busy = static_cast<int>(std::thread::hardware_concurrency());
  double work = 0.25;  ///< milliseconds per thread
  bool json = false;
};

double milliseconds(Clock::duration time) { return std::chrono::duration<double, std::milli>(time).count(); }

/// Computes `steps` dependent operations that a compiler cannot shorten.
double chain(long steps, double x) {
  for (long i = 0; i < steps; ++i) x = 1.0 / (0.5 + x);
  return x;
}

/// Returns the number of steps that take `time` milliseconds on a core, from the fastest of several tries.
long steps_in(double time) {
  constexpr long tried = 20000;
  double best = 1e300, x = 0.3;
  for (int i = 0; i < 50; ++i) {
    const auto start = Clock::now();
    x = chain(tried, x);
    best = std::min(best, milliseconds(Clock::now() - start));
  }
  return std::max(1L, static_cast<long>(tried * time / best * (x > 0 ? 1.0 : 0.0)));
}

/// Competing programs, simulated by threads of this one.
class Others {
 public:
  explicit Others(int count) {
    for (int i = 0; i < count; ++i)
      threads_.emplace_back([this] {
        double x = 0.3;
        while (!over_) x = chain(1000, x);
        sink_ = x;
      });
  }
  ~Others() { over_ = true; }
  Others(const Others&) = delete;
  Others& operator=(const Others&) = delete;

 private:
  std::atomic<bool> over_ = false;
  std::atomic<double> sink_ = 0.0;
  std::vector<std::jthread> threads_;
};

/// Like an operator application: every thread computes its share, and after a barrier a little more.
class Region {
 public:
  Region(int threads, long steps) : threads_(threads), steps_(steps), sums_(8 * threads, 0.3) {}

  void run() {
    kacanov::in_team(threads_, [&](int t) { share(t); });
    kacanov::in_team(threads_, [&](int t) { finish(t); });
  }
  const std::vector<double>& sums() const { return sums_; }

 private:
  void share(int t) { sums_[8 * t] = chain(steps_, sums_[8 * t] + t); }
  void finish(int t) { sums_[8 * t + 1] = sums_[8 * t] + sums_[8 * ((t + 1) % threads_)]; }

  int threads_;
  long steps_;
  std::vector<double> sums_;
};

struct Times {
  double mean = 0.0, median = 0.0, slow = 0.0;  ///< slow: 99th percentile
};

Times measure(const Options& options, const std::function<void()>& region) {
  std::this_thread::sleep_for(std::chrono::milliseconds(100));  // threads that still spin go to sleep
  std::vector<double> times;
  for (int i = 0; i < options.regions; ++i) {
    const auto start = Clock::now();
    region();
    times.push_back(milliseconds(Clock::now() - start));
  }
  std::sort(times.begin(), times.end());
  Times out;
  for (const double time : times) out.mean += time / static_cast<double>(times.size());
  out.median = times[times.size() / 2];
  out.slow = times[times.size() - 1 - times.size() / 100];
  return out;
}

Json json_of(const Times& times) {
  return {{"mean_ms", times.mean}, {"median_ms", times.median}, {"slow_ms", times.slow}};
}

int run(const Options& options) {
  const long steps = steps_in(options.work);
  Json out = {{"threads", options.threads}, {"work_ms", options.work}, {"others", options.busy}};
  Region openmp(options.threads, steps), own(options.threads, steps);
  const auto on = [&](const char* whose, Region& region) {
    setenv("KACANOV_THREADS", whose, 1);
    kacanov::start_team(options.threads);
    return json_of(measure(options, [&] { region.run(); }));
  };
  const auto both = [&](const char* when) {
    out["openmp"][when] = on("openmp", openmp);
    out["own"][when] = on("own", own);
  };
  both("free");
  {
    const Others others(options.busy);
    both("contended");
  }
  for (const char* who : {"openmp", "own"}) {
    Json& of = out[who];
    of["ratio"] = of["contended"]["mean_ms"].get<double>() / of["free"]["mean_ms"].get<double>();
  }
  if (options.json) {
    std::cout << out.dump(1) << "\n";
  } else {
    for (const char* who : {"openmp", "own"})
      for (const char* when : {"free", "contended"}) {
        const Json& of = out[who][when];
        std::printf("%-7s %-10s mean %7.3f ms, median %7.3f ms, one in a hundred over %7.3f ms\n", who, when,
                    of["mean_ms"].get<double>(), of["median_ms"].get<double>(), of["slow_ms"].get<double>());
      }
    for (const char* who : {"openmp", "own"})
      std::printf("%-7s contended / free %6.1f\n", who, out[who]["ratio"].get<double>());
  }
  return openmp.sums() == own.sums() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Small pieces of work on threads, on free cores and on contended ones");
  app.add_option("--threads", options.threads)->check(CLI::Range(1, 4096));
  app.add_option("--work", options.work, "milliseconds a thread and region")->check(CLI::PositiveNumber);
  app.add_option("--regions", options.regions, "how many")->check(CLI::Range(1, 1000000));
  app.add_option("--others", options.busy, "busy loops beside, left out: one a core")
      ->check(CLI::Range(0, 4096));
  app.add_flag("--json", options.json);
  CLI11_PARSE(app, argc, argv);
  return run(options);
}
