// SPDX-License-Identifier: BSD-3-Clause
// Triad and fused multiply-add loops; the best of several measurements counts.
#include "machine.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <limits>
#include <vector>

namespace kacanov::perf {
namespace {

#if defined(__AVX512F__)
constexpr int vector_bytes = 64;
#elif defined(__AVX__)
constexpr int vector_bytes = 32;
#else
constexpr int vector_bytes = 16;
#endif
typedef double V __attribute__((vector_size(vector_bytes)));

/// Makes the compiler assume that `v` is read and written here, in its register.
[[gnu::always_inline]] inline void keep(V& v) {
#if defined(__AVX512F__)
  asm volatile("" : "+v"(v));
#elif defined(__x86_64__)
  asm volatile("" : "+x"(v));
#else
  asm volatile("" : "+w"(v));  // Arm
#endif
}

template <class Run>
double best_of(int repetitions, Run&& run) {
  double best = std::numeric_limits<double>::max();
  for (int i = 0; i < repetitions; ++i) {
    const double start = now();
    run();
    best = std::min(best, now() - start);
  }
  return best;
}

}  // namespace

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double triad_bytes_per_second(int threads) {
  constexpr std::ptrdiff_t size = 20'000'000;
  std::vector<double> a(size), b(size, 1.0), c(size, 2.0);
  const double seconds = best_of(5, [&] {
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::ptrdiff_t i = 0; i < size; ++i) a[i] = b[i] + 3.0 * c[i];
  });
  return 24.0 * static_cast<double>(size) / seconds;
}

double fma_flops_per_second(int threads) {
  constexpr int chains = 12, rounds = 10'000'000;  // two units of latency four need eight
  const double seconds = best_of(5, [&] {
#pragma omp parallel num_threads(threads)
    {
      const V factor = 0.999 - V{}, term = 1e-9 - V{};
      // Separate variables keep the chains in registers; an array would be stored and loaded in each round,
      // and the loop would measure that.
      V a0{}, a1{}, a2{}, a3{}, a4{}, a5{}, a6{}, a7{}, a8{}, a9{}, a10{}, a11{};
      const auto step = [&](auto&... a) __attribute__((always_inline)) {
        static_assert(sizeof...(a) == chains);
        ((a = a * factor + term), ...);
        (keep(a), ...);
      };
      for (int r = 0; r < rounds; ++r) step(a0, a1, a2, a3, a4, a5, a6, a7, a8, a9, a10, a11);
    }
  });
  const double lanes = vector_bytes / 8;
  return 2.0 * lanes * chains * rounds * threads / seconds;
}

}  // namespace kacanov::perf
