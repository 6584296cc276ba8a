// SPDX-License-Identifier: BSD-3-Clause
// The C interface's quadrature points: positions, strains, and averages over elements.
#include <kacanov/kacanov.h>

#include <algorithm>
#include <span>

#include "c/handle.hpp"
#include "c/laws.hpp"
#include "c/sized.hpp"
#include "c/vectors.hpp"

namespace k = kacanov;
using namespace kacanov::c_api;

namespace {

/// An optional array of the caller; empty if it is null.
template <class T>
std::span<T> optional_span(T* data, std::size_t size) {
  return {data, data == nullptr ? 0 : size};
}

/// Marks an element of a user-defined law as plastic if any of its points is beyond the law's x0.
void mark_plastic(const kacanov_operator& op, const PointValues& values, std::span<std::uint8_t> plastic) {
  const std::size_t points = k::points_per_element(op.mesh.type);
  const k::Body body = op.body();
  for (std::size_t e = 0; e < plastic.size(); ++e) {
    const OwnLaw& own = op.own_laws[body.law_index(e)];
    if (own.evaluate == nullptr) continue;
    const auto x = std::span(values.x).subspan(e * points, points);
    const double largest = *std::max_element(x.begin(), x.end());
    plastic[e] = own.yield > 0.0 && largest > own.yield ? 1 : 0;
  }
}

}  // namespace

int kacanov_stress(kacanov_operator* op, size_t n, const double* u, const kacanov_fields* fields) {
  return on(op, [&](k::Operator&) {
    CallVectors call(*op);
    const auto at = call.state(n, u);
    require(fields, "fields");
    const auto wanted = read_sized<kacanov_fields>(fields, fields_bytes, "fields.", "kacanov_fields");
    const std::size_t elements = op->mesh.element_count();
    require_size(wanted.elements, elements, "fields.elements");
    const k::reference::ElementFields out{.stress = optional_span(wanted.stress, 6 * elements),
                                          .von_mises = optional_span(wanted.von_mises, elements),
                                          .dev_strain = optional_span(wanted.dev_strain, elements),
                                          .secant = optional_span(wanted.secant, elements),
                                          .plastic = optional_span(wanted.plastic, elements)};
    k::Body body = op->body();
    if (!op->has_own_laws()) return k::reference::fields(body, at, out);
    const PointValues values = ask_laws(*op, at, {});
    const k::PointModuli moduli = values.moduli();
    body.moduli = &moduli;
    k::reference::fields(body, at, out);
    mark_plastic(*op, values, out.plastic);
  });
}

int kacanov_points(kacanov_operator* op, size_t count, double* position, double* weight) {
  return on(op, [&](k::Operator&) {
    const k::Body body = op->body();
    require_size(count, body.secant_count(), "count");
    const std::size_t dim = k::dimension(op->mesh.type);
    k::reference::points(body, optional_span(position, count * dim), optional_span(weight, count));
  });
}

int kacanov_strain(kacanov_operator* op, size_t n, const double* u, size_t count, double* strain, double* x) {
  return on(op, [&](k::Operator& fast) {
    CallVectors call(*op);
    const auto at = call.state(n, u);
    require_size(count, op->body().secant_count(), "count");
    if (strain != nullptr) k::reference::strains(op->body(), at, {strain, 6 * count});
    if (x != nullptr) fast.strain(at, {x, count});
  });
}
