// SPDX-License-Identifier: BSD-3-Clause
// The C interface's calls in single precision.
#include <kacanov/kacanov.h>

#include <vector>

#include "c/handle.hpp"
#include "c/rows.hpp"

namespace k = kacanov;
using namespace kacanov::c_api;

namespace {

/// Runs `work` on the operator in single precision, whose g it first brings up to date.
template <class Work>
int on_single(kacanov_operator* op, std::size_t n, Work&& work) noexcept {
  return on(op, [&](k::Operator& fast) {
    if (!op->single)
      throw Fault(KACANOV_ERROR_STATE,
                  "the operator was made without single precision: see kacanov_description.single");
    require_size(n, op->unknowns(), "n");
    if (!op->single_is_current) {
      std::vector<double> g(op->body().secant_count());
      fast.secant(g);
      op->single->set_secant(g);
      op->single_is_current = true;
    }
    work(*op->single);
  });
}

}  // namespace

int kacanov_apply_float(kacanov_operator* op, size_t n, const float* x, float* y) {
  return on_single(op, n, [&](k::FloatOperator& single) {
    const auto in = input(x, n, "x");
    const auto out = output(y, n, "y");
    require_disjoint(in, out, "x and y");
    apply_rows(*op, in, out, [&](auto from, auto to) { return single.apply(from, to), 0.0; });
  });
}

int kacanov_apply_dot_float(kacanov_operator* op, size_t n, const float* x, float* y, double* dot) {
  return on_single(op, n, [&](k::FloatOperator& single) {
    const auto in = input(x, n, "x");
    const auto out = output(y, n, "y");
    require(dot, "dot");
    require_disjoint(in, out, "x and y");
    *dot = apply_rows(*op, in, out, [&](auto from, auto to) { return single.apply_dot(from, to); });
  });
}

int kacanov_apply_many_float(kacanov_operator* op, size_t n, int32_t vectors, const float* x, float* y) {
  return on_single(op, n, [&](k::FloatOperator& single) {
    if (vectors < 1) throw Fault(KACANOV_ERROR_VALUE, "vectors: expected at least 1");
    const auto in = input(x, n * vectors, "x");
    const auto out = output(y, in.size(), "y");
    require_disjoint(in, out, "x and y");
    apply_rows(*op, in, out, [&](auto from, auto to) { return single.apply_many(from, to, vectors), 0.0; });
  });
}

int kacanov_diagonal_float(kacanov_operator* op, size_t n, float* diagonal) {
  return on_single(op, n, [&](k::FloatOperator& single) {
    const auto out = output(diagonal, n, "diagonal");
    single.diagonal(out);
    diagonal_rows(*op, out);
  });
}
