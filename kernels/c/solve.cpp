// SPDX-License-Identifier: BSD-3-Clause
// The C interface's conjugate gradients: those of the solver, on the threads of one process.
#include <kacanov/kacanov.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "c/multigrid.hpp"
#include "c/rows.hpp"
#include "c/sized.hpp"
#include "c/vectors.hpp"
#include "multigrid/cg.hpp"
#include "operator/threads.hpp"

namespace k = kacanov;
using namespace kacanov::c_api;

namespace {

/// Space of vectors that are zero at rows of the identity; see conjugate_gradients().
class FreeUnknowns {
 public:
  explicit FreeUnknowns(const kacanov_operator& op) : threads_(op.options.threads) {
    each_unit_row(op, [&](std::size_t i) { held_.push_back(i); });
  }
  void project(std::span<double> x) const {
    for (const std::size_t i : held_) x[i] = 0.0;
  }
  double sum_all(double share) const { return share; }
  double dot(std::span<const double> x, std::span<const double> y) const {
    return sum(x.size(), [&](std::size_t i) { return x[i] * y[i]; });
  }
  double norm(std::span<const double> x) const { return std::sqrt(dot(x, x)); }
  double residual_norm(std::span<const double> r) const { return norm(r); }
  double advance(double alpha, std::span<const double> p, std::span<const double> q, std::span<double> x,
                 std::span<double> r) const {
    return std::sqrt(sum(x.size(), [&](std::size_t i) {
      x[i] += alpha * p[i];
      r[i] -= alpha * q[i];
      return r[i] * r[i];
    }));
  }
  void turn(double beta, std::span<const double> z, std::span<double> p) const {
    k::in_shares(threads_, p.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) p[i] = beta == 0.0 ? z[i] : z[i] + beta * p[i];
    });
  }

 private:
  template <class Term>
  double sum(std::size_t n, const Term& term) const {
    return k::sum_shares(threads_, n, [&](std::size_t begin, std::size_t end) {
      return k::eight_sums(end - begin, [&](std::size_t i) { return term(begin + i); });
    });
  }
  int threads_;
  std::vector<std::size_t> held_;
};

struct Wanted {
  k::CgOptions cg;
  bool tangent = false;
};

Wanted wanted_of(const kacanov_cg_options* options) {
  kacanov_cg_options given{};
  if (options != nullptr)
    given = read_sized<kacanov_cg_options>(options, cg_options_bytes, "options.", "kacanov_cg_options");
  if (!(given.relative >= 0.0 && given.relative < 1.0))
    throw Fault(KACANOV_ERROR_VALUE, "options.relative: expected 0 to 1");
  if (!(given.absolute >= 0.0) || !std::isfinite(given.absolute))
    throw Fault(KACANOV_ERROR_VALUE, "options.absolute: expected 0 or more");
  if (given.most_iterations < 0)
    throw Fault(KACANOV_ERROR_VALUE, "options.most_iterations: expected 0 or more");
  if (given.tangent != 0 && given.tangent != 1)
    throw Fault(KACANOV_ERROR_VALUE, "options.tangent: expected 0 or 1");
  Wanted wanted;
  wanted.tangent = given.tangent != 0;
  wanted.cg.absolute = given.absolute;
  wanted.cg.relative = given.relative == 0.0 && given.absolute == 0.0 ? 1e-8 : given.relative;
  if (given.most_iterations > 0) wanted.cg.max_iterations = given.most_iterations;
  return wanted;
}

/// Returns 1 / diagonal, and 1 where the diagonal is not a positive number.
std::vector<double> inverse_diagonal(const kacanov_operator& op, bool tangent) {
  std::vector<double> d(op.unknowns());
  if (tangent)
    op.fast->diagonal_tangent(d);
  else
    op.fast->diagonal(d);
  diagonal_rows(op, std::span(d));
  for (double& v : d) v = v > 0.0 && std::isfinite(1.0 / v) ? 1.0 / v : 1.0;
  return d;
}

void solve(kacanov_operator& op, kacanov_multigrid* multigrid, std::span<const double> b, std::span<double> x,
           const Wanted& wanted, kacanov_cg_result& found) {
  k::Operator& fast = *op.fast;
  const auto product = [&](std::span<const double> from, std::span<double> to) {
    return wanted.tangent ? fast.apply_tangent_dot(from, to) : fast.apply_dot(from, to);
  };
  const FreeUnknowns space(op);
  k::CgWork work;
  work.resize(x.size());
  apply_rows(op, std::span<const double>(x), std::span(work.residual), product);
  k::in_shares(op.options.threads, x.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) work.residual[i] = b[i] - work.residual[i];
  });
  each_unit_row(op, [&](std::size_t i) { x[i] = b[i]; });
  // Directions are already zero at rows of the identity.
  const auto apply = [&](std::span<const double> p, std::span<double> q) {
    const double dot = product(p, q);
    return dot + add_blocks(op, p, q);
  };
  std::vector<double> scale;
  if (multigrid == nullptr) scale = inverse_diagonal(op, wanted.tangent);
  const auto precondition = [&](std::span<const double> r, std::span<double> z) {
    if (multigrid != nullptr) return apply_multigrid(*multigrid, r, z);
    for (std::size_t i = 0; i < r.size(); ++i) z[i] = scale[i] * r[i];
  };
  const k::CgResult cg = k::conjugate_gradients(space, apply, precondition, x, work, wanted.cg);
  found = {.struct_size = sizeof(kacanov_cg_result),
           .iterations = cg.iterations,
           .converged = cg.converged ? 1 : 0,
           .first_residual = cg.first_residual,
           .residual = cg.residual};
}

}  // namespace

int kacanov_cg(kacanov_operator* op, kacanov_multigrid* multigrid, const kacanov_cg_options* options,
               size_t n, const double* b, double* x, kacanov_cg_result* result) {
  return on(op, [&](k::Operator&) {
    CallVectors call(*op);
    require(result, "result");
    require_struct_size(result->struct_size, cg_result_bytes, "result.", "kacanov_cg_result");
    const Wanted wanted = wanted_of(options);
    if (wanted.tangent) require_tangent(*op);
    require_size(n, op->unknowns(), "n");
    const auto in = call.in(b, n, "b");
    const auto out = call.in_out(x, n, "x");
    require_disjoint(in, out, "b and x");
    require_finite(in, "b");
    require_finite(out, "x");
    if (multigrid != nullptr && multigrid->op != op)
      throw Fault(KACANOV_ERROR_VALUE, "multigrid: is that of another operator");
    kacanov_cg_result found{};
    int code = KACANOV_OK;
    if (multigrid == nullptr)
      solve(*op, nullptr, in, out, wanted, found);
    else
      code = alone(multigrid, [&] { solve(*op, multigrid, in, out, wanted, found); });
    if (code == KACANOV_ERROR_STATE && multigrid->cycle)
      throw Fault(KACANOV_ERROR_STATE, "multigrid: is in use by another thread");
    if (code != KACANOV_OK) throw Fault(static_cast<kacanov_code>(code), multigrid->message);
    write_sized(found, result, cg_result_bytes, "result.", "kacanov_cg_result");
  });
}
