// SPDX-License-Identifier: BSD-3-Clause
// The C interface's multigrid and conjugate gradients: those of the solver, on the threads of one process.
#include <kacanov/kacanov.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <kacanov/error.hpp>
#include "c/handle.hpp"
#include "c/rows.hpp"
#include "c/sized.hpp"
#include "c/vectors.hpp"
#include "multigrid/cg.hpp"
#include "multigrid/multigrid.hpp"
#include "operator/threads.hpp"

/// A multigrid's copies of an operator's data, so that the operator may get other laws. Coordinates and
/// connectivity are the operator's unless some nodes belong to no element: these are left out.
struct kacanov_multigrid {
  kacanov_operator* op = nullptr;  ///< shared with the caller
  kacanov::MultigridOptions options;
  std::vector<std::int32_t>
      used;  ///< nodes with elements, if some nodes have none; the multigrid contains only these
  std::vector<std::int32_t> number;  ///< number of each node among them, or -1
  std::vector<double> coordinates;   ///< of these nodes
  std::vector<std::int32_t> connectivity;
  std::vector<kacanov::Law> laws;  ///< linear ones, divided by `unit`
  std::vector<std::uint16_t> law_of_element;
  double unit = 1.0;           ///< a power of two near the moduli, so that single precision holds them
  std::uint64_t laws_set = 0;  ///< the operator's value at the last update
  std::vector<std::uint8_t> held;
  std::vector<std::int32_t> unit_rows;  ///< unknowns where z = r
  kacanov::IndexMap node_map;           ///< of one process
  std::optional<kacanov::Multigrid> cycle;
  std::vector<double> r, z;  ///< of the used nodes, if some are not used
  std::atomic<bool> busy = false;
  char message[512] = "";
};

namespace kacanov::c_api {

/// z = M r for all of the operator's unknowns.
void apply_multigrid(kacanov_multigrid& multigrid, std::span<const double> r, std::span<double> z);

}  // namespace kacanov::c_api

namespace k = kacanov;
using namespace kacanov::c_api;

namespace {

/// Leaves out nodes that belong to no element: without couplings, each would become an aggregate.
void take_mesh(kacanov_multigrid& multigrid) {
  const k::MeshView& mesh = multigrid.op->mesh;
  const std::size_t dim = k::dimension(mesh.type);
  std::vector<std::int32_t> number(mesh.node_count(), -1);
  for (const std::int32_t node : mesh.connectivity) number[node] = 0;
  for (std::size_t n = 0; n < number.size(); ++n) {
    if (number[n] < 0) continue;
    number[n] = static_cast<std::int32_t>(multigrid.used.size());
    multigrid.used.push_back(static_cast<std::int32_t>(n));
  }
  if (multigrid.used.size() == number.size()) return std::vector<std::int32_t>().swap(multigrid.used);
  for (const std::int32_t node : multigrid.used)
    for (std::size_t c = 0; c < dim; ++c) multigrid.coordinates.push_back(mesh.coordinates[node * dim + c]);
  for (const std::int32_t node : mesh.connectivity) multigrid.connectivity.push_back(number[node]);
  multigrid.r.resize(multigrid.coordinates.size());
  multigrid.z.resize(multigrid.coordinates.size());
  multigrid.number.swap(number);
}

void take_laws(kacanov_multigrid& multigrid) {
  const kacanov_operator& op = *multigrid.op;
  multigrid.unit = std::exp2(std::round(std::log2(op.laws[0].shear)));
  multigrid.laws.clear();
  for (const k::Law& law : op.laws) {
    k::Law linear;
    linear.bulk = law.bulk / multigrid.unit;
    linear.shear = law.shear / multigrid.unit;
    linear.mean_dilatation = law.mean_dilatation;
    multigrid.laws.push_back(linear);
  }
  multigrid.law_of_element.assign(op.law_of_element.begin(), op.law_of_element.end());
  multigrid.laws_set = op.laws_set;
}

k::MultigridBody body_of(const kacanov_multigrid& multigrid) {
  k::MeshView mesh = multigrid.op->mesh;
  if (!multigrid.used.empty()) mesh = {mesh.type, multigrid.coordinates, multigrid.connectivity};
  return {{mesh, multigrid.laws, multigrid.law_of_element},
          &multigrid.node_map,
          multigrid.held,
          multigrid.used.empty() ? &*multigrid.op->fast : nullptr};
}

/// Sets constraints in the multigrid's numbering, and the unknowns with z = r.
void take_constraints(kacanov_multigrid& multigrid) {
  const kacanov_operator& op = *multigrid.op;
  const std::size_t dim = k::dimension(op.mesh.type);
  std::fill(multigrid.held.begin(), multigrid.held.end(), std::uint8_t{0});
  multigrid.unit_rows = op.constrained;
  for (std::size_t n = 0; n < multigrid.number.size(); ++n)
    if (multigrid.number[n] < 0)
      for (std::size_t c = 0; c < dim; ++c)
        multigrid.unit_rows.push_back(static_cast<std::int32_t>(n * dim + c));
  for (const std::int32_t unknown : op.constrained) {
    const std::size_t node = unknown / dim, c = unknown % dim;
    const std::int32_t to = multigrid.used.empty() ? static_cast<std::int32_t>(node) : multigrid.number[node];
    if (to >= 0) multigrid.held[to * dim + c] = 1;
  }
}

/// Sets up for the present operator. The caller must have locked both handles.
void set_up(kacanov_multigrid& multigrid) {
  const kacanov_operator& op = *multigrid.op;
  const std::size_t dim = k::dimension(op.mesh.type);
  if (!multigrid.cycle || multigrid.laws_set != op.laws_set) {
    multigrid.cycle.reset();
    take_laws(multigrid);
    const std::size_t nodes = multigrid.used.empty() ? op.mesh.node_count() : multigrid.used.size();
    multigrid.held.assign(nodes * dim, 0);
    multigrid.node_map.owned = static_cast<std::int32_t>(nodes);
    multigrid.node_map.starts = {0, multigrid.node_map.owned};
    multigrid.cycle.emplace(body_of(multigrid), multigrid.options);
  }
  take_constraints(multigrid);
  std::vector<k::NodeBlock> blocks;
  for (k::NodeBlock block : op.blocks) {
    if (!multigrid.used.empty()) block.node = multigrid.number[block.node];
    for (double& v : block.value) v /= multigrid.unit;
    if (block.node >= 0) blocks.push_back(block);
  }
  std::vector<double> g(op.body().secant_count());
  op.fast->secant(g);
  for (double& v : g) v /= multigrid.unit;
  try {
    multigrid.cycle->setup(g, blocks, {});
  } catch (const k::InternalError&) {
    multigrid.cycle.reset();
    throw Fault(
        KACANOV_ERROR_VALUE,
        "the operator with its constraints and blocks is not positive definite: see its g and blocks");
  }
}

void require_set_up(const kacanov_multigrid& multigrid) {
  if (!multigrid.cycle)
    throw Fault(KACANOV_ERROR_STATE, "the last update failed: kacanov_multigrid_update first");
}

}  // namespace

void k::c_api::apply_multigrid(kacanov_multigrid& multigrid, std::span<const double> r, std::span<double> z) {
  require_set_up(multigrid);
  const int threads = multigrid.options.threads;
  std::vector<double> most(threads, 0.0);
  k::in_team(threads, [&](int t) {
    const std::size_t share = t, team = threads;
    double largest = 0.0;
    for (std::size_t i = r.size() * share / team; i < r.size() * (share + 1) / team; ++i)
      largest = std::max(largest, std::abs(r[i]));
    most[share] = largest;
  });
  const double largest = *std::max_element(most.begin(), most.end());
  // Powers of two are exact; single precision has a small exponent range.
  const bool usual = largest > 1e-290 && largest < 1e290;
  const double in = usual ? std::exp2(-std::ilogb(largest)) : 1.0, out = 1.0 / in / multigrid.unit;
  if (multigrid.used.empty()) {
    multigrid.cycle->apply(r, z, {in, out});
  } else {
    const std::size_t dim = k::dimension(multigrid.op->mesh.type);
    for (std::size_t n = 0; n < multigrid.used.size(); ++n)
      for (std::size_t c = 0; c < dim; ++c) multigrid.r[n * dim + c] = r[multigrid.used[n] * dim + c];
    multigrid.cycle->apply(multigrid.r, multigrid.z, {in, out});
    for (std::size_t n = 0; n < multigrid.used.size(); ++n)
      for (std::size_t c = 0; c < dim; ++c) z[multigrid.used[n] * dim + c] = multigrid.z[n * dim + c];
  }
  for (const std::int32_t unknown : multigrid.unit_rows) z[unknown] = r[unknown];
}

int kacanov_multigrid_create(kacanov_operator* op, const kacanov_multigrid_options* options,
                             kacanov_multigrid** multigrid) {
  if (multigrid != nullptr) *multigrid = nullptr;
  return on(op, [&](k::Operator&) {
    require(multigrid, "multigrid");
    kacanov_multigrid_options wanted{};
    if (options != nullptr)
      wanted = read_sized<kacanov_multigrid_options>(options, multigrid_options_bytes, "options.",
                                                     "kacanov_multigrid_options");
    if (wanted.aggregate != 0.0 && !(wanted.aggregate >= 4.0 && wanted.aggregate <= 1000.0))
      throw Fault(KACANOV_ERROR_VALUE, "options.aggregate: expected 4 to 1000, or 0");
    if (op->mesh.connectivity.empty())
      throw Fault(KACANOV_ERROR_STATE, "a body without elements has no multigrid");
    auto made = std::make_unique<kacanov_multigrid>();
    made->op = op;
    made->options.threads = op->options.threads;
    made->options.instruction_set = op->instruction_set;
    if (wanted.aggregate != 0.0)
      made->options.fine_size = wanted.aggregate, made->options.grid_contrast = 0.0;
    take_mesh(*made);
    set_up(*made);
    op->owners.fetch_add(1, std::memory_order_relaxed);
    *multigrid = made.release();
  });
}

int kacanov_multigrid_update(kacanov_multigrid* multigrid) {
  return alone(multigrid, [&] {
    const int code = alone(multigrid->op, [&] { set_up(*multigrid); });
    if (code == KACANOV_ERROR_STATE)
      throw Fault(KACANOV_ERROR_STATE, "the operator is in use by another thread");
    if (code != KACANOV_OK) throw Fault(static_cast<kacanov_code>(code), multigrid->op->message);
  });
}

int kacanov_multigrid_apply(kacanov_multigrid* multigrid, size_t n, const double* r, double* z) {
  return alone(multigrid, [&] {
    CallVectors call(*multigrid->op);
    require_size(n, multigrid->op->unknowns(), "n");
    const auto in = call.in(r, n, "r");
    const auto out = call.out(z, n, "z");
    require_disjoint(in, out, "r and z");
    apply_multigrid(*multigrid, in, out);
  });
}

void kacanov_multigrid_destroy(kacanov_multigrid* multigrid) {
  if (multigrid == nullptr) return;
  kacanov_operator* const op = multigrid->op;
  delete multigrid;
  let_go(op);
}

const char* kacanov_multigrid_message(const kacanov_multigrid* multigrid) {
  return multigrid == nullptr ? "multigrid: null pointer" : multigrid->message;
}

int kacanov_multigrid_inspect(kacanov_multigrid* multigrid, kacanov_multigrid_information* information) {
  return alone(multigrid, [&] {
    require(information, "information");
    require_set_up(*multigrid);
    const auto count = [](const auto&... lists) { return ((lists.capacity() * sizeof(lists[0])) + ...); };
    const std::size_t own =
        count(multigrid->used, multigrid->number, multigrid->coordinates, multigrid->connectivity,
              multigrid->law_of_element, multigrid->held, multigrid->unit_rows, multigrid->r, multigrid->z);
    const kacanov_multigrid_information found{.struct_size = sizeof(kacanov_multigrid_information),
                                              .bytes = own + multigrid->cycle->bytes(),
                                              .levels = multigrid->cycle->levels(),
                                              .reserved = 0};
    write_sized(found, information, multigrid_information_bytes, "information.",
                "kacanov_multigrid_information");
  });
}

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

kacanov_cg_result solve(kacanov_operator& op, kacanov_multigrid* multigrid, std::span<const double> b,
                        std::span<double> x, const Wanted& wanted) {
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
  return {.struct_size = sizeof(kacanov_cg_result),
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
      found = solve(*op, nullptr, in, out, wanted);
    else
      code = alone(multigrid, [&] { found = solve(*op, multigrid, in, out, wanted); });
    if (code == KACANOV_ERROR_STATE && multigrid->cycle)
      throw Fault(KACANOV_ERROR_STATE, "multigrid: is in use by another thread");
    if (code != KACANOV_OK) throw Fault(static_cast<kacanov_code>(code), multigrid->message);
    write_sized(found, result, cg_result_bytes, "result.", "kacanov_cg_result");
  });
}
