// SPDX-License-Identifier: BSD-3-Clause
// The C interface's multigrid: that of the solver, for one process.
#include "c/multigrid.hpp"

#include <kacanov/kacanov.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include <kacanov/error.hpp>
#include "c/rows.hpp"
#include "c/sized.hpp"
#include "c/vectors.hpp"
#include "operator/threads.hpp"

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
    multigrid.cycle->build(g, blocks, {});
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
