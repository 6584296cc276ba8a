// SPDX-License-Identifier: BSD-3-Clause
// Measures the two ceilings of the roofline model: memory bandwidth and peak floating-point performance.
#pragma once

namespace kacanov::perf {

/// Returns the seconds since an arbitrary fixed moment.
double now();

/// Returns bytes per second of a = b + s c over arrays far larger than the caches (24 bytes per entry).
double triad_bytes_per_second(int threads);

/// Returns double-precision operations per second of independent fused multiply-adds in registers.
double fma_flops_per_second(int threads);

}  // namespace kacanov::perf
