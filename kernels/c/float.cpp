// SPDX-License-Identifier: BSD-3-Clause
// Single-precision calls of the C interface.
#include <kacanov/kacanov.h>

#include <vector>

#include "c/handle.hpp"
#include "c/rows.hpp"
#include "c/vectors.hpp"

namespace k = kacanov;
using namespace kacanov::c_api;

namespace {

void require_single(const kacanov_operator& op, std::size_t n) {
  if (!op.single)
    throw Fault(KACANOV_ERROR_STATE,
                "the operator was made without single precision: see kacanov_description.single");
  require_size(n, op.unknowns(), "n");
}

/// Runs `work` on the single-precision operator after updating its g.
template <class Work>
int on_single(kacanov_operator* op, std::size_t n, Work&& work) noexcept {
  return on(op, [&](k::Operator& fast) {
    require_single(*op, n);
    if (!op->single_is_current) {
      std::vector<double> g(op->body().secant_count());
      fast.secant(g);
      op->single->set_secant(g);
      op->single_is_current = true;
    }
    work(*op->single);
  });
}

/// The same for the tangent.
template <class Work>
int on_single_tangent(kacanov_operator* op, std::size_t n, Work&& work) noexcept {
  return on(op, [&](k::Operator& fast) {
    require_single(*op, n);
    require_tangent(*op);
    if (!op->single_has_tangent) op->single->take_tangent(fast);
    op->single_has_tangent = true;
    work(*op->single);
  });
}

void require_vectors(std::int32_t vectors) {
  if (vectors < 1) throw Fault(KACANOV_ERROR_VALUE, "vectors: expected at least 1");
}

}  // namespace

int kacanov_apply_float(kacanov_operator* op, size_t n, const float* x, float* y) {
  return on_single(op, n, [&](k::FloatOperator& single) {
    CallVectors call(*op);
    const auto in = call.in(x, n, "x");
    const auto out = call.out(y, n, "y");
    require_disjoint(in, out, "x and y");
    apply_rows(*op, in, out, [&](auto from, auto to) { return single.apply(from, to), 0.0; });
  });
}

int kacanov_apply_dot_float(kacanov_operator* op, size_t n, const float* x, float* y, double* dot) {
  return on_single(op, n, [&](k::FloatOperator& single) {
    CallVectors call(*op);
    const auto in = call.in(x, n, "x");
    const auto out = call.out(y, n, "y");
    require(dot, "dot");
    require_disjoint(in, out, "x and y");
    *dot = apply_rows(*op, in, out, [&](auto from, auto to) { return single.apply_dot(from, to); });
  });
}

int kacanov_apply_many_float(kacanov_operator* op, size_t n, int32_t vectors, const float* x, float* y) {
  return on_single(op, n, [&](k::FloatOperator& single) {
    CallVectors call(*op);
    require_vectors(vectors);
    const auto in = call.in(x, n * vectors, "x");
    const auto out = call.out(y, in.size(), "y");
    require_disjoint(in, out, "x and y");
    apply_rows(*op, in, out, [&](auto from, auto to) { return single.apply_many(from, to, vectors), 0.0; });
  });
}

int kacanov_diagonal_float(kacanov_operator* op, size_t n, float* diagonal) {
  return on_single(op, n, [&](k::FloatOperator& single) {
    CallVectors call(*op);
    const auto out = call.out(diagonal, n, "diagonal");
    single.diagonal(out);
    diagonal_rows(*op, out);
  });
}

int kacanov_apply_tangent_float(kacanov_operator* op, size_t n, const float* x, float* y) {
  return on_single_tangent(op, n, [&](k::FloatOperator& single) {
    CallVectors call(*op);
    const auto in = call.in(x, n, "x");
    const auto out = call.out(y, n, "y");
    require_disjoint(in, out, "x and y");
    apply_rows(*op, in, out, [&](auto from, auto to) { return single.apply_tangent(from, to), 0.0; });
  });
}

int kacanov_apply_tangent_dot_float(kacanov_operator* op, size_t n, const float* x, float* y, double* dot) {
  return on_single_tangent(op, n, [&](k::FloatOperator& single) {
    CallVectors call(*op);
    const auto in = call.in(x, n, "x");
    const auto out = call.out(y, n, "y");
    require(dot, "dot");
    require_disjoint(in, out, "x and y");
    *dot = apply_rows(*op, in, out, [&](auto from, auto to) { return single.apply_tangent_dot(from, to); });
  });
}

int kacanov_apply_tangent_many_float(kacanov_operator* op, size_t n, int32_t vectors, const float* x,
                                     float* y) {
  return on_single_tangent(op, n, [&](k::FloatOperator& single) {
    CallVectors call(*op);
    require_vectors(vectors);
    const auto in = call.in(x, n * vectors, "x");
    const auto out = call.out(y, in.size(), "y");
    require_disjoint(in, out, "x and y");
    apply_rows(*op, in, out,
               [&](auto from, auto to) { return single.apply_tangent_many(from, to, vectors), 0.0; });
  });
}

int kacanov_diagonal_tangent_float(kacanov_operator* op, size_t n, float* diagonal) {
  return on_single_tangent(op, n, [&](k::FloatOperator& single) {
    CallVectors call(*op);
    const auto out = call.out(diagonal, n, "diagonal");
    single.diagonal_tangent(out);
    diagonal_rows(*op, out);
  });
}
