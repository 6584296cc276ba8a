// SPDX-License-Identifier: BSD-3-Clause
// Creation and destruction of the C interface's handles, and conversion of the caller's mesh: node orders
// from the table of cells, inverted elements.
#include <kacanov/kacanov.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <kacanov/cells.hpp>
#include <kacanov/mesh_view.hpp>
#include "c/handle.hpp"
#include "c/laws.hpp"
#include "c/sized.hpp"
#include "operator/checks.hpp"

namespace kacanov::c_api {
namespace {

std::vector<std::int8_t> mirror_image(const Cell& cell) {
  std::vector<std::int8_t> of(cell.nodes);
  for (int a = 0; a < cell.nodes; ++a)
    for (int b = 0; b < cell.nodes; ++b) {
      const auto &p = cell.reference[a], &q = cell.reference[b];
      if (std::abs(p[0] - q[1]) + std::abs(p[1] - q[0]) + std::abs(p[2] - q[2]) < 1e-9)
        of[a] = static_cast<std::int8_t>(b);
    }
  return of;
}

/// Returns the permutation of nodes: the caller's node k of an element is node order[k] here; empty for the
/// identity. Throws Fault for an unknown name, and for an order that does not exist for the element.
std::vector<std::int8_t> node_order(const char* name, ElementType type) {
  if (name == nullptr) return {};
  const std::string_view wanted = name;
  const Cell& facts = cell(type);
  const auto list = [](std::span<const std::int8_t> order) {
    return std::vector<std::int8_t>(order.begin(), order.end());
  };
  if (wanted == "gmsh") return {};
  if (wanted == "vtk") return list(facts.vtk_order);
  if (wanted == "basix") return list(facts.basix_order);
  if (wanted == "dealii") {
    if (facts.order != 1)
      throw Fault(KACANOV_ERROR_VALUE,
                  "node_order: deal.II's cells have their vertices only, not the nodes of " +
                      std::string(facts.name));
    return list(facts.basix_order);  // both are lexicographic
  }
  throw Fault(KACANOV_ERROR_VALUE, "node_order: expected gmsh, vtk, basix or dealii, got '" +
                                       std::string(wanted.substr(0, 40)) + "'");
}

/// Renumbers the nodes of elements that are inverted at all points. Indices must have been checked.
void turn_inverted(const MeshView& mesh, std::span<std::int32_t> connectivity) {
  const auto mirror = mirror_image(cell(mesh.type));
  std::array<std::int32_t, most_nodes> turned{};
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    if (!is_inverted(mesh, e)) continue;
    const auto nodes = connectivity.subspan(e * mirror.size(), mirror.size());
    for (std::size_t a = 0; a < mirror.size(); ++a) turned[a] = nodes[mirror[a]];
    std::copy_n(turned.begin(), mirror.size(), nodes.begin());
  }
}

/// Nodes that belong to no element, ascending.
std::vector<std::int32_t> orphans(const MeshView& mesh) {
  std::vector<char> used(mesh.node_count(), 0);
  for (const std::int32_t node : mesh.connectivity) used[node] = 1;
  std::vector<std::int32_t> result;
  for (std::size_t i = 0; i < used.size(); ++i)
    if (used[i] == 0) result.push_back(static_cast<std::int32_t>(i));
  return result;
}

}  // namespace
}  // namespace kacanov::c_api

namespace k = kacanov;
using namespace kacanov::c_api;

namespace {

/// Minimum number of unknowns per thread: with fewer, waking and waiting (about 5 µs) costs more than it
/// saves.
constexpr std::size_t unknowns_a_thread = 3000;

k::PlaneState plane_state(std::int32_t plane) {
  switch (plane) {
    case KACANOV_PLANE_STRESS: return k::PlaneState::stress;
    case KACANOV_AXISYMMETRIC: return k::PlaneState::axisymmetric;
    default: return k::PlaneState::strain;
  }
}

k::ElementType element_type(std::int32_t element) {
  if (element < 0 || static_cast<std::size_t>(element) >= k::element_types().size())
    throw Fault(KACANOV_ERROR_VALUE, "element: there is no element type " + std::to_string(element));
  return static_cast<k::ElementType>(element);
}

void check_description(const kacanov_description& d) {
  constexpr std::size_t most = std::numeric_limits<std::int32_t>::max();
  if (d.threads < 0 || d.threads > 4096)
    throw Fault(KACANOV_ERROR_VALUE, "threads: expected 0 to 4096, got " + std::to_string(d.threads));
  if (d.index_base != 0 && d.index_base != 1) throw Fault(KACANOV_ERROR_VALUE, "index_base: expected 0 or 1");
  if (d.borrow != 0 && d.borrow != 1) throw Fault(KACANOV_ERROR_VALUE, "borrow: expected 0 or 1");
  if (d.single != 0 && d.single != 1) throw Fault(KACANOV_ERROR_VALUE, "single: expected 0 or 1");
  if (d.turn_inverted != 0 && d.turn_inverted != 1)
    throw Fault(KACANOV_ERROR_VALUE, "turn_inverted: expected 0 or 1");
  if (d.orphans < KACANOV_ORPHANS_ZERO || d.orphans > KACANOV_ORPHANS_UNIT)
    throw Fault(KACANOV_ERROR_VALUE, "orphans: expected a kacanov_orphans, got " + std::to_string(d.orphans));
  if (d.may_be_empty != 0 && d.may_be_empty != 1)
    throw Fault(KACANOV_ERROR_VALUE, "may_be_empty: expected 0 or 1");
  if (d.component_vectors != 0 && d.component_vectors != 1)
    throw Fault(KACANOV_ERROR_VALUE, "component_vectors: expected 0 or 1");
  if (d.plane < KACANOV_PLANE_STRAIN || d.plane > KACANOV_AXISYMMETRIC)
    throw Fault(KACANOV_ERROR_VALUE, "plane: expected a kacanov_plane, got " + std::to_string(d.plane));
  if (d.reserved_plane != 0) throw Fault(KACANOV_ERROR_VALUE, "reserved_plane: expected 0");
  const bool empty = d.may_be_empty != 0 && d.elements == 0;
  if (!empty || d.nodes > 0) require(d.coordinates, "coordinates");
  if (!empty) require(d.connectivity, "connectivity");
  if (d.laws > 0) require(d.law, "law");
  if (d.early_count > 0) require(d.early, "early");
  const auto check_count = [](std::size_t count, bool least, std::size_t largest, const char* name) {
    if (count < static_cast<std::size_t>(least) || count > largest)
      throw Fault(KACANOV_ERROR_SIZE, std::string(name) + ": expected " + (least ? "1" : "0") + " to " +
                                          std::to_string(largest) + " (32-bit indices)");
  };
  check_count(d.nodes, !empty, most / 3, "nodes");
  check_count(d.elements, !empty, most / 10, "elements");
}

/// Fills the mesh of the handle with copies, or with the caller's arrays if they are borrowed.
void take_mesh(const kacanov_description& d, kacanov_operator& op) {
  const k::ElementType type = element_type(d.element);
  const std::size_t dim = k::dimension(type);
  const std::size_t per_element = k::nodes_per_element(type);
  const std::size_t node_stride = d.node_stride == 0 ? dim : d.node_stride;
  const std::size_t component_stride = d.component_stride == 0 ? 1 : d.component_stride;
  const std::size_t element_stride = d.element_stride == 0 ? per_element : d.element_stride;
  if (element_stride < per_element)
    throw Fault(KACANOV_ERROR_SIZE, "element_stride: expected at least " + std::to_string(per_element));
  const auto order = node_order(d.node_order, type);
  if (d.borrow != 0) {
    if (node_stride != dim || component_stride != 1 || element_stride != per_element || d.index_base != 0 ||
        !order.empty() || d.turn_inverted != 0)
      throw Fault(KACANOV_ERROR_VALUE,
                  "borrow: needs default strides, index_base 0, Gmsh's node order and no turning");
    op.mesh = {type,
               {d.coordinates, d.nodes * dim},
               {d.connectivity, d.elements * per_element},
               plane_state(d.plane)};
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
      const std::size_t to = order.empty() ? a : order[a];
      op.connectivity[e * per_element + to] = node < 0 ? node : node - d.index_base;
    }
  op.mesh = {type, op.coordinates, op.connectivity, plane_state(d.plane)};
  if (d.turn_inverted != 0 && k::arrays_fault(op.mesh).empty()) turn_inverted(op.mesh, op.connectivity);
}

/// Applies the caller's option for nodes that belong to no element.
void take_orphans(std::int32_t wanted, kacanov_operator& op) {
  if (wanted == KACANOV_ORPHANS_ZERO) return;
  op.unit_nodes = orphans(op.mesh);
  if (wanted == KACANOV_ORPHANS_REFUSED && !op.unit_nodes.empty())
    throw Fault(KACANOV_ERROR_MESH, "node " + std::to_string(op.unit_nodes[0]) +
                                        " belongs to no element, as do " +
                                        std::to_string(op.unit_nodes.size() - 1) + " others");
}

/// Gives the handle `count` laws and creates the operator; on an error the handle is unchanged.
void take_laws(kacanov_operator& op, std::size_t count, const kacanov_law* laws,
               const std::uint16_t* law_of_element, bool borrow) {
  std::vector<k::Law> checked = checked_laws(count, laws);
  std::vector<OwnLaw> own_laws = k::c_api::own_laws(count, laws);
  for (std::size_t i = 0; i < checked.size(); ++i) {
    const std::string where = "law[" + std::to_string(i) + "].";
    if (checked[i].mean_dilatation && op.mesh.plane == k::PlaneState::stress)
      throw Fault(KACANOV_ERROR_LAW, where + "mean_dilatation: is not for plane stress, which does not lock");
    if (own_laws[i].evaluate != nullptr && op.mesh.plane != k::PlaneState::strain)
      throw Fault(KACANOV_ERROR_LAW,
                  where + "evaluate: laws of the caller's own are for plane strain and 3D");
    if (checked[i].mean_dilatation && !k::cell(op.mesh.type).mean_dilatation)
      throw Fault(KACANOV_ERROR_LAW, where + "mean_dilatation: is for " + k::bbar_names() + " only");
  }
  std::vector<std::uint16_t> own;
  std::span<const std::uint16_t> of_element;
  if (law_of_element != nullptr) {
    of_element = {law_of_element, op.mesh.element_count()};
    if (!borrow) {
      own.assign(of_element.begin(), of_element.end());
      of_element = own;
    }
  }
  k::c_api::check_law_of_element(of_element, checked.size());

  k::Operator made({op.mesh, checked, of_element}, op.options);
  std::optional<k::FloatOperator> single;
  if (op.wants_single) single.emplace(k::Body{op.mesh, checked, of_element}, op.options, made);
  std::string got(made.instruction_set());
  op.fast.emplace(std::move(made));
  op.instruction_set.swap(got);
  op.options.instruction_set = op.instruction_set;
  op.laws.swap(checked);
  op.own_laws.swap(own_laws);
  op.own_law_of_element.swap(own);  // keeps the address to which `of_element` may point
  op.law_of_element = of_element;
  op.single = std::move(single);
  op.single_is_current = true;  // both start with g = mu
  op.has_tangent = op.single_has_tangent = false;
  ++op.laws_set;
}

}  // namespace

int kacanov_create(const kacanov_description* description, kacanov_operator** op, char* message,
                   size_t message_size) {
  copy_message("", message, message_size);
  if (op != nullptr) *op = nullptr;
  return guarded(message, message_size, [&] {
    require(description, "description");
    require(op, "op");
    const auto d = read_sized<kacanov_description>(description, description_bytes, "", "kacanov_description");
    check_description(d);
    auto made = std::make_unique<kacanov_operator>();
    take_mesh(d, *made);
    if (const std::string fault = k::mesh_fault(made->mesh); !fault.empty())
      throw Fault(KACANOV_ERROR_MESH, fault);
    take_orphans(d.orphans, *made);
    const std::size_t worth = std::max<std::size_t>(made->unknowns() / unknowns_a_thread, 1);
    made->options.threads = static_cast<int>(std::clamp<std::size_t>(d.threads, 1, worth));
    made->early.assign(d.early, d.early + d.early_count);
    made->options.early = made->early;
    if (d.instruction_set != nullptr) made->instruction_set = d.instruction_set;
    made->options.instruction_set = made->instruction_set;
    made->split_vectors = d.component_vectors != 0;
    made->wants_single = d.single != 0;
    if (d.laws > 0) take_laws(*made, d.laws, d.law, d.law_of_element, d.borrow != 0);
    *op = made.release();
  });
}

void kacanov_destroy(kacanov_operator* op) { let_go(op); }

int kacanov_set_laws(kacanov_operator* op, size_t laws, const kacanov_law* law, size_t elements,
                     const uint16_t* law_of_element) {
  return alone(op, [&] {
    require(law, "law");
    if (laws == 0) throw Fault(KACANOV_ERROR_SIZE, "laws: expected at least 1");
    require_size(elements, op->mesh.element_count(), "elements");
    take_laws(*op, laws, law, law_of_element, false);
  });
}
