// SPDX-License-Identifier: BSD-3-Clause
// The C interface's product for parallel hosts: interface values are computed first.
#include <kacanov/kacanov.h>

#include "c/handle.hpp"
#include "c/vectors.hpp"

namespace k = kacanov;
using namespace kacanov::c_api;

int kacanov_apply_early(kacanov_operator* op, size_t n, int32_t tangent, const double* x, double* y,
                        double* dot, kacanov_early_callback callback, void* data) {
  return on(op, [&](k::Operator& fast) {
    CallVectors call(*op);
    if (tangent != 0 && tangent != 1) throw Fault(KACANOV_ERROR_VALUE, "tangent: expected 0 or 1");
    if (tangent == 1) require_tangent(*op);
    require_size(n, op->unknowns(), "n");
    if (callback == nullptr) throw Fault(KACANOV_ERROR_NULL, "callback: null pointer");
    const auto in = call.in(x, n, "x");
    const auto out = call.out(y, n, "y");
    require_disjoint(in, out, "x and y");
    if (!op->constrained.empty() || !op->blocks.empty() || !op->unit_nodes.empty())
      throw Fault(KACANOV_ERROR_STATE,
                  "kacanov_apply_early: is for operators without constraints, blocks and unit rows");
    if (op->split_vectors)
      throw Fault(KACANOV_ERROR_STATE, "kacanov_apply_early: is for vectors that are interleaved");
    const auto when_early = [&] { callback(data, y); };
    const double product =
        tangent == 1 ? fast.apply_tangent_dot(in, out, when_early) : fast.apply_dot(in, out, when_early);
    if (dot != nullptr) *dot = product;
  });
}
