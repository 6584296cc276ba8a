// SPDX-License-Identifier: BSD-3-Clause
// The C interface's calls on a handle: they check the arguments, then call Operator or the reference.
#include <kacanov/kacanov.h>

#include <algorithm>
#include <span>
#include <string>

#include <kacanov/locality.hpp>
#include "c/handle.hpp"
#include "c/laws.hpp"
#include "c/rows.hpp"
#include "c/sized.hpp"
#include "c/vectors.hpp"

#define KACANOV_TEXT_OF(number) #number
#define KACANOV_TEXT(number) KACANOV_TEXT_OF(number)

namespace k = kacanov;
using namespace kacanov::c_api;

const char* kacanov_message(const kacanov_operator* op) {
  return op == nullptr ? "op: null pointer" : op->message;
}

int kacanov_update(kacanov_operator* op, size_t n, const double* u) {
  return on(op, [&](k::Operator& fast) {
    CallVectors call(*op);
    const auto at = call.state(n, u);
    if (op->has_own_laws())
      fast.set_secant(ask_laws(*op, at, {}).secant);
    else
      fast.update(at);
    op->single_is_current = false;
  });
}

int kacanov_secant(kacanov_operator* op, size_t count, double* g) {
  return on(op, [&](k::Operator& fast) {
    require_size(count, op->body().secant_count(), "count");
    fast.secant(output(g, count, "g"));
  });
}

int kacanov_set_secant(kacanov_operator* op, size_t count, const double* g) {
  return on(op, [&](k::Operator& fast) {
    require_size(count, op->body().secant_count(), "count");
    const auto values = input(g, count, "g");
    require_finite(values, "g");
    for (std::size_t i = 0; i < count; ++i)
      if (values[i] < 0.0) throw Fault(KACANOV_ERROR_VALUE, "g[" + std::to_string(i) + "] is negative");
    fast.set_secant(values);
    op->single_is_current = false;
  });
}

int kacanov_apply(kacanov_operator* op, size_t n, const double* x, double* y) {
  return on(op, [&](k::Operator& fast) {
    CallVectors call(*op);
    require_size(n, op->unknowns(), "n");
    const auto in = call.in(x, n, "x");
    const auto out = call.out(y, n, "y");
    require_disjoint(in, out, "x and y");
    apply_rows(*op, in, out, [&](auto from, auto to) { return fast.apply(from, to), 0.0; });
  });
}

int kacanov_apply_dot(kacanov_operator* op, size_t n, const double* x, double* y, double* dot) {
  return on(op, [&](k::Operator& fast) {
    CallVectors call(*op);
    require_size(n, op->unknowns(), "n");
    const auto in = call.in(x, n, "x");
    const auto out = call.out(y, n, "y");
    require(dot, "dot");
    require_disjoint(in, out, "x and y");
    *dot = apply_rows(*op, in, out, [&](auto from, auto to) { return fast.apply_dot(from, to); });
  });
}

int kacanov_apply_add(kacanov_operator* op, size_t n, double alpha, const double* x, double beta, double* y) {
  return on(op, [&](k::Operator& fast) {
    CallVectors call(*op);
    require_size(n, op->unknowns(), "n");
    const auto in = call.in(x, n, "x");
    const auto out = call.in_out(y, n, "y");
    require_disjoint(in, out, "x and y");
    std::vector<double>& image = op->image;
    image.resize(n);
    apply_rows(*op, in, std::span(image), [&](auto from, auto to) { return fast.apply(from, to), 0.0; });
    for (std::size_t i = 0; i < n; ++i) out[i] = alpha * image[i] + (beta == 0.0 ? 0.0 : beta * out[i]);
  });
}

int kacanov_apply_many(kacanov_operator* op, size_t n, int32_t vectors, const double* x, double* y) {
  return on(op, [&](k::Operator& fast) {
    CallVectors call(*op);
    require_size(n, op->unknowns(), "n");
    if (vectors < 1) throw Fault(KACANOV_ERROR_VALUE, "vectors: expected at least 1");
    const auto in = call.in(x, n * vectors, "x");
    const auto out = call.out(y, in.size(), "y");
    require_disjoint(in, out, "x and y");
    apply_rows(*op, in, out, [&](auto from, auto to) { return fast.apply_many(from, to, vectors), 0.0; });
  });
}

int kacanov_update_tangent(kacanov_operator* op, size_t n, const double* u) {
  return on(op, [&](k::Operator& fast) {
    CallVectors call(*op);
    const auto at = call.state(n, u);
    if (op->has_own_laws())
      fast.update_tangent(at, ask_laws(*op, at, {.derivative = true}).moduli());
    else
      fast.update_tangent(at);
    op->single_is_current = false;
    op->has_tangent = true;
    op->single_has_tangent = false;
  });
}

int kacanov_apply_tangent(kacanov_operator* op, size_t n, const double* x, double* y) {
  return on(op, [&](k::Operator& fast) {
    CallVectors call(*op);
    require_tangent(*op);
    require_size(n, op->unknowns(), "n");
    const auto in = call.in(x, n, "x");
    const auto out = call.out(y, n, "y");
    require_disjoint(in, out, "x and y");
    apply_rows(*op, in, out, [&](auto from, auto to) { return fast.apply_tangent(from, to), 0.0; });
  });
}

int kacanov_apply_tangent_dot(kacanov_operator* op, size_t n, const double* x, double* y, double* dot) {
  return on(op, [&](k::Operator& fast) {
    CallVectors call(*op);
    require_tangent(*op);
    require_size(n, op->unknowns(), "n");
    const auto in = call.in(x, n, "x");
    const auto out = call.out(y, n, "y");
    require(dot, "dot");
    require_disjoint(in, out, "x and y");
    *dot = apply_rows(*op, in, out, [&](auto from, auto to) { return fast.apply_tangent_dot(from, to); });
  });
}

int kacanov_apply_tangent_many(kacanov_operator* op, size_t n, int32_t vectors, const double* x, double* y) {
  return on(op, [&](k::Operator& fast) {
    CallVectors call(*op);
    require_tangent(*op);
    require_size(n, op->unknowns(), "n");
    if (vectors < 1) throw Fault(KACANOV_ERROR_VALUE, "vectors: expected at least 1");
    const auto in = call.in(x, n * vectors, "x");
    const auto out = call.out(y, in.size(), "y");
    require_disjoint(in, out, "x and y");
    apply_rows(*op, in, out,
               [&](auto from, auto to) { return fast.apply_tangent_many(from, to, vectors), 0.0; });
  });
}

int kacanov_diagonal(kacanov_operator* op, size_t n, double* diagonal) {
  return on(op, [&](k::Operator& fast) {
    CallVectors call(*op);
    require_size(n, op->unknowns(), "n");
    const auto out = call.out(diagonal, n, "diagonal");
    fast.diagonal(out);
    diagonal_rows(*op, out);
  });
}

int kacanov_block_diagonal(kacanov_operator* op, size_t count, double* blocks) {
  return on(op, [&](k::Operator& fast) {
    require_size(count, op->unknowns() * k::dimension(op->mesh.type), "count");
    const auto out = output(blocks, count, "blocks");
    fast.block_diagonal(out);
    block_rows(*op, out);
  });
}

int kacanov_diagonal_tangent(kacanov_operator* op, size_t n, double* diagonal) {
  return on(op, [&](k::Operator& fast) {
    CallVectors call(*op);
    require_tangent(*op);
    require_size(n, op->unknowns(), "n");
    const auto out = call.out(diagonal, n, "diagonal");
    fast.diagonal_tangent(out);
    diagonal_rows(*op, out);
  });
}

int kacanov_block_diagonal_tangent(kacanov_operator* op, size_t count, double* blocks) {
  return on(op, [&](k::Operator& fast) {
    require_tangent(*op);
    require_size(count, op->unknowns() * k::dimension(op->mesh.type), "count");
    const auto out = output(blocks, count, "blocks");
    fast.block_diagonal_tangent(out);
    block_rows(*op, out);
  });
}

int kacanov_residual(kacanov_operator* op, size_t n, const double* u, double* f) {
  return on(op, [&](k::Operator& fast) {
    CallVectors call(*op);
    const auto at = call.state(n, u);
    const auto out = call.out(f, n, "f");
    require_disjoint(at, out, "u and f");
    if (op->has_own_laws())
      fast.residual_energy(at, ask_laws(*op, at, {}).moduli(), out);
    else
      fast.residual(at, out);
  });
}

int kacanov_energy(kacanov_operator* op, size_t n, const double* u, double* energy) {
  return on(op, [&](k::Operator& fast) {
    CallVectors call(*op);
    const auto at = call.state(n, u);
    require(energy, "energy");
    *energy = op->has_own_laws() ? fast.residual_energy(at, ask_laws(*op, at, {.energy = true}).moduli(), {})
                                 : fast.energy(at);
  });
}

int kacanov_residual_energy_update(kacanov_operator* op, size_t n, const double* u, double* f,
                                   double* energy) {
  return on(op, [&](k::Operator& fast) {
    CallVectors call(*op);
    const auto at = call.state(n, u);
    const auto out = call.out(f, n, "f");
    require(energy, "energy");
    require_disjoint(at, out, "u and f");
    if (op->has_own_laws()) {
      const PointValues values = ask_laws(*op, at, {.energy = true});
      *energy = fast.residual_energy(at, values.moduli(), out);
      fast.set_secant(values.secant);
    } else {
      *energy = fast.residual_energy_update(at, out);
    }
    op->single_is_current = false;
  });
}

int kacanov_inspect(kacanov_operator* op, kacanov_information* information) {
  return on(op, [&](k::Operator& fast) {
    require(information, "information");
    const k::MeshView& mesh = op->mesh;
    const kacanov_information found{.struct_size = sizeof(kacanov_information),
                                    .unknowns = op->unknowns(),
                                    .nodes = mesh.node_count(),
                                    .elements = mesh.element_count(),
                                    .dimension = k::dimension(mesh.type),
                                    .nodes_per_element = k::nodes_per_element(mesh.type),
                                    .points_per_element = k::points_per_element(mesh.type),
                                    .threads = op->options.threads,
                                    .applications = fast.applications(),
                                    .bytes = fast.bytes() + (op->single ? op->single->bytes() : 0) +
                                             (op->coordinates.size() + op->image.size()) * sizeof(double) +
                                             op->connectivity.size() * sizeof(std::int32_t) +
                                             op->own_law_of_element.size() * sizeof(std::uint16_t) +
                                             op->constrained.size() * sizeof(std::int32_t) +
                                             op->blocks.size() * sizeof(k::NodeBlock),
                                    .instruction_set = op->instruction_set.c_str()};
    write_sized(found, information, information_bytes, "information.", "kacanov_information");
  });
}

int kacanov_locality_order(kacanov_operator* op, size_t nodes, int32_t* node_order, size_t elements,
                           int32_t* element_order) {
  return on(op, [&](k::Operator&) {
    require_size(nodes, op->mesh.node_count(), "nodes");
    require_size(elements, op->mesh.element_count(), "elements");
    const k::LocalityOrder order = k::locality_order(op->mesh);
    if (node_order != nullptr) std::copy(order.nodes.begin(), order.nodes.end(), node_order);
    if (element_order != nullptr) std::copy(order.elements.begin(), order.elements.end(), element_order);
  });
}

int kacanov_elastic_law(double young, double poisson, kacanov_law* law) {
  if (law == nullptr) return KACANOV_ERROR_NULL;
  if (!(young > 0.0 && young < 1e300 && poisson > -1.0 && poisson < 0.5)) return KACANOV_ERROR_LAW;
  const k::Law made = k::elastic_law(young, poisson);
  kacanov_law linear{};
  linear.kind = KACANOV_LINEAR;
  linear.bulk = made.bulk;
  linear.shear = made.shear;
  return guarded(nullptr, 0, [&] { write_sized(linear, law, law_bytes, "law.", "kacanov_law"); });
}

const char* kacanov_code_text(int code) {
  switch (code) {
    case KACANOV_OK: return "no error";
    case KACANOV_ERROR_NULL: return "a required pointer is null";
    case KACANOV_ERROR_SIZE:
      return "an array or a struct has another size than expected, or two arrays overlap";
    case KACANOV_ERROR_MESH: return "the mesh has an index, an element or a coordinate that cannot be";
    case KACANOV_ERROR_LAW: return "a law, or a parameter of one, is missing or out of range";
    case KACANOV_ERROR_VALUE: return "an option or an entry of a vector is out of range or not finite";
    case KACANOV_ERROR_STATE:
      return "another call has to come first, or the handle is in use by another thread";
    case KACANOV_ERROR_MEMORY: return "out of memory";
    case KACANOV_ERROR_INTERNAL: return "a defect of the library";
    case KACANOV_ERROR_CASE: return "the case, or a file that it names, is wrong";
    default: return "not a code of this library";
  }
}

const char* kacanov_version(void) {
  return KACANOV_TEXT(KACANOV_VERSION_MAJOR) "." KACANOV_TEXT(KACANOV_VERSION_MINOR) "." KACANOV_TEXT(
      KACANOV_VERSION_PATCH);
}

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
    const auto on_interface_ready = [&] { callback(data, y); };
    const double product = tangent == 1 ? fast.apply_tangent_dot(in, out, on_interface_ready)
                                        : fast.apply_dot(in, out, on_interface_ready);
    if (dot != nullptr) *dot = product;
  });
}
