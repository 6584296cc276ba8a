// SPDX-License-Identifier: BSD-3-Clause
// What the machine can do: the two ceilings of a roofline, measured.
#pragma once

namespace kacanov::perf {

/// Seconds since some moment.
double now();

/// Bytes a second of a = b + s c over arrays far beyond the caches (24 bytes an entry), `threads` threads.
double triad_bytes_per_second(int threads);

/// Double precision operations a second of independent fused multiply-adds in registers, `threads` threads.
double fma_flops_per_second(int threads);

}  // namespace kacanov::perf
