// SPDX-License-Identifier: BSD-3-Clause
// Triad and fused multiply-add loops, best of several.
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
    for (std::ptrdiff_t i = 0; i < size; ++i)
      a[static_cast<std::size_t>(i)] = b[static_cast<std::size_t>(i)] + 3.0 * c[static_cast<std::size_t>(i)];
  });
  return 24.0 * static_cast<double>(size) / seconds;
}

double fma_flops_per_second(int threads) {
  constexpr int chains = 10, rounds = 2'000'000;
  const double seconds = best_of(3, [&] {
#pragma omp parallel num_threads(threads)
    {
      V a[chains];
      for (int i = 0; i < chains; ++i) a[i] = static_cast<double>(i) - V{};
      V factor = 0.999 - V{}, term = 1e-9 - V{};
      for (int r = 0; r < rounds; ++r) {
        for (int i = 0; i < chains; ++i) a[i] = a[i] * factor + term;
        asm volatile("" : "+m"(a) : : "memory");  // keeps the loop; the vectors stay where they are
      }
    }
  });
  const double lanes = vector_bytes / 8;
  return 2.0 * lanes * chains * rounds * threads / seconds;
}

}  // namespace kacanov::perf
