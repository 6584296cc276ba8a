// SPDX-License-Identifier: BSD-3-Clause
// The C interface over Operator and the reference: checks, copies, turns exceptions into codes.
#include "kacanov.h"

#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "c_laws.hpp"
#include "mesh_check.hpp"
#include "operator.hpp"
#include "reference.hpp"

#ifndef KACANOV_VERSION
#error "the build has to define KACANOV_VERSION"
#endif

namespace k = kacanov;
using k::c_api::Fault;

/// Everything a handle holds. The mesh stays for the recovery of stress and for new laws.
struct kacanov_operator {
  k::MeshView mesh;  ///< of the vectors below, or of the caller's arrays
  std::vector<double> coordinates;
  std::vector<std::int32_t> connectivity;
  std::vector<k::Law> laws;
  std::vector<std::uint16_t> own_law_of_element;
  std::span<const std::uint16_t> law_of_element;
  k::OperatorOptions options;
  std::string instruction_set;      ///< what options.instruction_set points to: as asked, then as got
  std::optional<k::Operator> fast;  ///< empty until there are laws
  bool has_tangent = false;
  char message[512] = "";

  std::size_t unknowns() const noexcept { return mesh.coordinates.size(); }
  k::Body body() const noexcept { return {mesh, laws, law_of_element}; }
};

namespace {

void copy_message(const char* text, char* to, std::size_t size) noexcept {
  if (to != nullptr && size > 0) std::snprintf(to, size, "%s", text);
}

/// Runs `work`; what it throws becomes a code and a message.
template <class Work>
int guarded(char* message, std::size_t size, Work&& work) noexcept {
  try {
    work();
    return KACANOV_OK;
  } catch (const Fault& fault) {
    copy_message(fault.what(), message, size);
    return fault.code();
  } catch (const std::invalid_argument& error) {
    copy_message(error.what(), message, size);
    return KACANOV_ERROR_VALUE;
  } catch (const std::bad_alloc&) {
    copy_message("out of memory", message, size);
    return KACANOV_ERROR_MEMORY;
  } catch (const std::length_error&) {
    copy_message("out of memory: a size is beyond any memory", message, size);
    return KACANOV_ERROR_MEMORY;
  } catch (const std::exception& error) {
    copy_message(error.what(), message, size);
    return KACANOV_ERROR_INTERNAL;
  } catch (...) {
    copy_message("unknown failure", message, size);
    return KACANOV_ERROR_INTERNAL;
  }
}

/// The same for calls on a handle that has laws.
template <class Work>
int on(kacanov_operator* op, Work&& work) noexcept {
  if (op == nullptr) return KACANOV_ERROR_NULL;
  return guarded(op->message, sizeof op->message, [&] {
    if (!op->fast) throw Fault(KACANOV_ERROR_STATE, "the operator has no laws yet: kacanov_set_laws first");
    work(*op->fast);
  });
}

void require(const void* pointer, const char* name) {
  if (pointer == nullptr) throw Fault(KACANOV_ERROR_NULL, std::string(name) + ": null pointer");
}

void require_size(std::size_t got, std::size_t expected, const char* name) {
  if (got != expected)
    throw Fault(KACANOV_ERROR_SIZE, std::string(name) + ": expected " + std::to_string(expected) + ", got " +
                                        std::to_string(got));
}

std::span<const double> input(const double* data, std::size_t n, const char* name) {
  require(data, name);
  return {data, n};
}

std::span<double> output(double* data, std::size_t n, const char* name) {
  require(data, name);
  return {data, n};
}

void require_disjoint(std::span<const double> x, std::span<const double> y, const char* names) {
  const std::less<> before;
  if (before(x.data(), y.data() + y.size()) && before(y.data(), x.data() + x.size()))
    throw Fault(KACANOV_ERROR_SIZE, std::string(names) + " overlap");
}

void require_finite(std::span<const double> values, const char* name) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      throw Fault(KACANOV_ERROR_VALUE, std::string(name) + "[" + std::to_string(i) + "] is not finite");
}

/// A displacement: of the right length and finite.
std::span<const double> state(const kacanov_operator& op, std::size_t n, const double* omega) {
  require_size(n, op.unknowns(), "n");
  const auto span = input(omega, n, "omega");
  require_finite(span, "omega");
  return span;
}

k::ElementType element_type(std::int32_t element) {
  if (element < KACANOV_TRI3 || element > KACANOV_HEX8)
    throw Fault(KACANOV_ERROR_VALUE, "element: there is no element type " + std::to_string(element));
  return static_cast<k::ElementType>(element);
}

void check_description(const kacanov_description& d) {
  constexpr auto most = static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());
  if (d.threads < 0 || d.threads > 4096)
    throw Fault(KACANOV_ERROR_VALUE, "threads: expected 0 to 4096, got " + std::to_string(d.threads));
  if (d.index_base != 0 && d.index_base != 1) throw Fault(KACANOV_ERROR_VALUE, "index_base: expected 0 or 1");
  if (d.borrow != 0 && d.borrow != 1) throw Fault(KACANOV_ERROR_VALUE, "borrow: expected 0 or 1");
  require(d.coordinates, "coordinates");
  require(d.connectivity, "connectivity");
  if (d.laws > 0) require(d.law, "law");
  if (d.nodes == 0 || d.nodes > most / 3)
    throw Fault(KACANOV_ERROR_SIZE, "nodes: expected 1 to " + std::to_string(most / 3) + " (32-bit indices)");
  if (d.elements == 0 || d.elements > most / 10)
    throw Fault(KACANOV_ERROR_SIZE,
                "elements: expected 1 to " + std::to_string(most / 10) + " (32-bit indices)");
}

/// Fills the mesh of the handle with copies, or with the caller's arrays where they are borrowed.
void take_mesh(const kacanov_description& d, kacanov_operator& op) {
  const k::ElementType type = element_type(d.element);
  const auto dim = static_cast<std::size_t>(k::dimension(type));
  const auto per_element = static_cast<std::size_t>(k::nodes_per_element(type));
  const std::size_t node_stride = d.node_stride == 0 ? dim : d.node_stride;
  const std::size_t component_stride = d.component_stride == 0 ? 1 : d.component_stride;
  const std::size_t element_stride = d.element_stride == 0 ? per_element : d.element_stride;
  if (element_stride < per_element)
    throw Fault(KACANOV_ERROR_SIZE, "element_stride: expected at least " + std::to_string(per_element));
  if (d.borrow != 0) {
    if (node_stride != dim || component_stride != 1 || element_stride != per_element || d.index_base != 0)
      throw Fault(KACANOV_ERROR_VALUE, "borrow: needs default strides and index_base 0");
    op.mesh = {type, {d.coordinates, d.nodes * dim}, {d.connectivity, d.elements * per_element}};
    return;
  }
  op.coordinates.resize(d.nodes * dim);
  for (std::size_t i = 0; i < d.nodes; ++i)
    for (std::size_t c = 0; c < dim; ++c)
      op.coordinates[i * dim + c] = d.coordinates[i * node_stride + c * component_stride];
  op.connectivity.resize(d.elements * per_element);
  for (std::size_t e = 0; e < d.elements; ++e)
    for (std::size_t a = 0; a < per_element; ++a) {
      const std::int32_t node = d.connectivity[e * element_stride + a];
      op.connectivity[e * per_element + a] = node < 0 ? node : node - d.index_base;
    }
  op.mesh = {type, op.coordinates, op.connectivity};
}

/// Gives the handle its laws and makes the operator; the handle changes only if all goes well.
void take_laws(kacanov_operator& op, std::span<const kacanov_law> laws, const std::uint16_t* law_of_element,
               bool borrow) {
  std::vector<k::Law> checked = k::c_api::checked_laws(laws);
  const std::size_t elements = op.mesh.element_count();
  std::vector<std::uint16_t> own;
  if (law_of_element == nullptr)
    own.assign(elements, 0);
  else if (!borrow)
    own.assign(law_of_element, law_of_element + elements);
  const std::span<const std::uint16_t> of_element =
      own.empty() ? std::span(law_of_element, elements) : std::span<const std::uint16_t>(own);
  k::c_api::check_law_of_element(of_element, checked.size());

  k::Operator made({op.mesh, checked, of_element}, op.options);
  std::string got(made.instruction_set());
  op.fast.emplace(std::move(made));
  op.instruction_set.swap(got);
  op.options.instruction_set = op.instruction_set;
  op.laws.swap(checked);
  op.own_law_of_element.swap(own);  // keeps the address `of_element` may point to
  op.law_of_element = of_element;
  op.has_tangent = false;
}

}  // namespace

int kacanov_create(const kacanov_description* description, kacanov_operator** op, char* message,
                   size_t message_size) {
  copy_message("", message, message_size);
  if (op != nullptr) *op = nullptr;
  return guarded(message, message_size, [&] {
    require(description, "description");
    require(op, "op");
    const kacanov_description& d = *description;
    check_description(d);
    auto made = std::make_unique<kacanov_operator>();
    take_mesh(d, *made);
    if (const std::string fault = k::mesh_fault(made->mesh); !fault.empty())
      throw Fault(KACANOV_ERROR_MESH, fault);
    made->options.threads = d.threads == 0 ? 1 : d.threads;
    if (d.instruction_set != nullptr) made->instruction_set = d.instruction_set;
    made->options.instruction_set = made->instruction_set;
    if (d.laws > 0) take_laws(*made, {d.law, d.laws}, d.law_of_element, d.borrow != 0);
    *op = made.release();
  });
}

void kacanov_destroy(kacanov_operator* op) { delete op; }

const char* kacanov_message(const kacanov_operator* op) {
  return op == nullptr ? "op: null pointer" : op->message;
}

int kacanov_set_laws(kacanov_operator* op, size_t laws, const kacanov_law* law, size_t elements,
                     const uint16_t* law_of_element) {
  if (op == nullptr) return KACANOV_ERROR_NULL;
  return guarded(op->message, sizeof op->message, [&] {
    require(law, "law");
    if (laws == 0) throw Fault(KACANOV_ERROR_SIZE, "laws: expected at least 1");
    require_size(elements, op->mesh.element_count(), "elements");
    take_laws(*op, {law, laws}, law_of_element, false);
  });
}

int kacanov_update(kacanov_operator* op, size_t n, const double* omega) {
  return on(op, [&](k::Operator& fast) { fast.update(state(*op, n, omega)); });
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
  });
}

int kacanov_apply(kacanov_operator* op, size_t n, const double* x, double* y) {
  return on(op, [&](k::Operator& fast) {
    require_size(n, op->unknowns(), "n");
    const auto in = input(x, n, "x");
    const auto out = output(y, n, "y");
    require_disjoint(in, out, "x and y");
    fast.apply(in, out);
  });
}

int kacanov_apply_dot(kacanov_operator* op, size_t n, const double* x, double* y, double* dot) {
  return on(op, [&](k::Operator& fast) {
    require_size(n, op->unknowns(), "n");
    const auto in = input(x, n, "x");
    const auto out = output(y, n, "y");
    require(dot, "dot");
    require_disjoint(in, out, "x and y");
    *dot = fast.apply_dot(in, out);
  });
}

int kacanov_update_tangent(kacanov_operator* op, size_t n, const double* omega) {
  return on(op, [&](k::Operator& fast) {
    fast.update_tangent(state(*op, n, omega));
    op->has_tangent = true;
  });
}

int kacanov_apply_tangent(kacanov_operator* op, size_t n, const double* x, double* y) {
  return on(op, [&](k::Operator& fast) {
    if (!op->has_tangent)
      throw Fault(KACANOV_ERROR_STATE, "no tangent is frozen yet: kacanov_update_tangent first");
    require_size(n, op->unknowns(), "n");
    const auto in = input(x, n, "x");
    const auto out = output(y, n, "y");
    require_disjoint(in, out, "x and y");
    fast.apply_tangent(in, out);
  });
}

int kacanov_diagonal(kacanov_operator* op, size_t n, double* diagonal) {
  return on(op, [&](k::Operator& fast) {
    require_size(n, op->unknowns(), "n");
    fast.diagonal(output(diagonal, n, "diagonal"));
  });
}

int kacanov_block_diagonal(kacanov_operator* op, size_t count, double* blocks) {
  return on(op, [&](k::Operator& fast) {
    require_size(count, op->unknowns() * static_cast<std::size_t>(k::dimension(op->mesh.type)), "count");
    fast.block_diagonal(output(blocks, count, "blocks"));
  });
}

int kacanov_residual(kacanov_operator* op, size_t n, const double* omega, double* f) {
  return on(op, [&](k::Operator& fast) {
    const auto at = state(*op, n, omega);
    const auto out = output(f, n, "f");
    require_disjoint(at, out, "omega and f");
    fast.residual(at, out);
  });
}

int kacanov_energy(kacanov_operator* op, size_t n, const double* omega, double* energy) {
  return on(op, [&](k::Operator& fast) {
    const auto at = state(*op, n, omega);
    require(energy, "energy");
    *energy = fast.energy(at);
  });
}

int kacanov_residual_energy_update(kacanov_operator* op, size_t n, const double* omega, double* f,
                                   double* energy) {
  return on(op, [&](k::Operator& fast) {
    const auto at = state(*op, n, omega);
    const auto out = output(f, n, "f");
    require(energy, "energy");
    require_disjoint(at, out, "omega and f");
    *energy = fast.residual_energy_update(at, out);
  });
}

int kacanov_stress(kacanov_operator* op, size_t n, const double* omega, const kacanov_fields* fields) {
  return on(op, [&](k::Operator&) {
    const auto at = state(*op, n, omega);
    require(fields, "fields");
    const std::size_t elements = op->mesh.element_count();
    require_size(fields->elements, elements, "fields.elements");
    const auto span = [&](auto* data, std::size_t per_element) {
      return std::span(data, data == nullptr ? 0 : per_element * elements);
    };
    k::reference::fields(op->body(), at,
                         {.stress = span(fields->stress, 6),
                          .von_mises = span(fields->von_mises, 1),
                          .dev_strain = span(fields->dev_strain, 1),
                          .secant = span(fields->secant, 1),
                          .plastic = span(fields->plastic, 1)});
  });
}

int kacanov_inspect(kacanov_operator* op, kacanov_information* information) {
  return on(op, [&](k::Operator& fast) {
    require(information, "information");
    const k::MeshView& mesh = op->mesh;
    *information = {.unknowns = op->unknowns(),
                    .nodes = mesh.node_count(),
                    .elements = mesh.element_count(),
                    .dimension = k::dimension(mesh.type),
                    .nodes_per_element = k::nodes_per_element(mesh.type),
                    .points_per_element = k::points_per_element(mesh.type),
                    .threads = op->options.threads,
                    .applications = fast.applications(),
                    .bytes = fast.bytes() + op->coordinates.size() * sizeof(double) +
                             op->connectivity.size() * sizeof(std::int32_t) +
                             op->own_law_of_element.size() * sizeof(std::uint16_t),
                    .instruction_set = op->instruction_set.c_str()};
  });
}

int kacanov_elastic_law(double young, double poisson, kacanov_law* law) {
  if (law == nullptr) return KACANOV_ERROR_NULL;
  if (!(young > 0.0 && young < 1e300 && poisson > -1.0 && poisson < 0.5)) return KACANOV_ERROR_LAW;
  const k::Law made = k::elastic_law(young, poisson);
  *law = {};
  law->kind = KACANOV_LINEAR;
  law->bulk = made.bulk;
  law->shear = made.shear;
  return KACANOV_OK;
}

const char* kacanov_version(void) { return KACANOV_VERSION; }
