// SPDX-License-Identifier: BSD-3-Clause
// The C handle of a solved case and its arrays.
#include "embedding/solution.hpp"

#include <cstddef>
#include <numeric>
#include <span>

#include <kacanov/cells.hpp>
#include "c/handle.hpp"
#include "c/sized.hpp"

using kacanov::ElementType;
using kacanov::Mesh;
namespace c = kacanov::c_api;

static_assert(int(ElementType::tri3) == KACANOV_TRI3 && int(ElementType::tet4) == KACANOV_TET4 &&
              int(ElementType::tet10) == KACANOV_TET10 && int(ElementType::hex8) == KACANOV_HEX8 &&
              int(ElementType::quad4) == KACANOV_QUAD4);

namespace {

constexpr std::size_t information_bytes =
    offsetof(kacanov_solution_information, message) + sizeof(const char*);

/// Returns the numbers of the mesh file, or 1, 2, ... if it has none.
std::vector<std::int64_t> numbers(const std::vector<std::int64_t>& tags, std::size_t count) {
  if (!tags.empty()) return tags;
  std::vector<std::int64_t> all(count);
  std::iota(all.begin(), all.end(), std::int64_t{1});
  return all;
}

kacanov_status status_of(kacanov::Status status) {
  switch (status) {
    case kacanov::Status::converged: return KACANOV_CONVERGED;
    case kacanov::Status::limited_by_rounding: return KACANOV_LIMITED_BY_ROUNDING;
    case kacanov::Status::interrupted: return KACANOV_INTERRUPTED;
    case kacanov::Status::not_converged: break;
  }
  return KACANOV_NOT_CONVERGED;
}

void make_elements(const kacanov_solution& solution) {
  const std::size_t count = solution.solved.problem.mesh.element_count();
  kacanov::embedding::ElementArrays made{std::vector<double>(6 * count),
                                         std::vector<double>(count),
                                         std::vector<double>(count),
                                         std::vector<double>(count),
                                         {}};
  std::vector<std::uint8_t> plastic(count);
  kacanov::element_fields(solution.solved,
                          {made.stress, made.von_mises, made.dev_strain, made.secant, plastic});
  made.plastic.assign(plastic.begin(), plastic.end());
  solution.elements = std::move(made);
}

const kacanov::embedding::ElementArrays& elements_of(const kacanov_solution& solution) {
  std::call_once(solution.elements_made, [&] {
    if (solution.solved.problem.mesh.element_count() > 0) make_elements(solution);
  });
  return solution.elements;
}

std::span<const double> field_of(const kacanov_solution& solution, std::int32_t field) {
  const kacanov::SolvedCase& solved = solution.solved;
  switch (field) {
    case KACANOV_FIELD_COORDINATES: return solved.problem.mesh.coordinates;
    case KACANOV_FIELD_DISPLACEMENT: return solved.displacement;
    case KACANOV_FIELD_STRESS: return solved.nodal_stress;
    case KACANOV_FIELD_VON_MISES: return solved.recovered_von_mises;
    case KACANOV_FIELD_ELEMENT_STRESS: return elements_of(solution).stress;
    case KACANOV_FIELD_ELEMENT_VON_MISES: return elements_of(solution).von_mises;
    case KACANOV_FIELD_ELEMENT_DEV_STRAIN: return elements_of(solution).dev_strain;
    case KACANOV_FIELD_ELEMENT_SECANT: return elements_of(solution).secant;
    case KACANOV_FIELD_CONTACT_NORMAL: return solution.contact.normal;
    case KACANOV_FIELD_CONTACT_GAP: return solved.contact.gap;
    case KACANOV_FIELD_CONTACT_PRESSURE: return solved.contact.pressure;
    case KACANOV_FIELD_CONTACT_TRACTION: return solved.contact.traction;
    default: return {};
  }
}

std::span<const std::int32_t> indices_of(const kacanov_solution& solution, std::int32_t index) {
  switch (index) {
    case KACANOV_INDEX_CONNECTIVITY: return solution.solved.problem.mesh.elements;
    case KACANOV_INDEX_CONTACT_NODE: return solution.contact.node;
    case KACANOV_INDEX_CONTACT_ENTRY: return solution.contact.entry;
    case KACANOV_INDEX_CONTACT_STATUS: return solution.contact.status;
    case KACANOV_INDEX_PLASTIC: return elements_of(solution).plastic;
    default: return {};
  }
}

/// Returns the array; null if it is empty or cannot be allocated.
template <class T, class Find>
const T* handed_out(const kacanov_solution* solution, std::size_t* count, const Find& find) noexcept {
  std::span<const T> array;
  if (solution != nullptr) c::guarded(nullptr, 0, [&] { array = find(*solution); });
  if (count != nullptr) *count = array.size();
  return array.empty() ? nullptr : array.data();
}

}  // namespace

kacanov_solution::kacanov_solution(kacanov::SolvedCase of) : solved(std::move(of)) {
  using Handler = nlohmann::ordered_json::error_handler_t;
  json = solved.json.dump(2, ' ', false, Handler::replace) + "\n";  // names of files need not be UTF-8
  const Mesh& mesh = solved.problem.mesh;
  node_numbers = numbers(mesh.node_tags, mesh.node_count());
  element_numbers = numbers(mesh.element_tags, mesh.element_count());
  for (std::size_t i = 0; i < solved.problem.contact.size(); ++i) {
    const kacanov::ContactPoint& point = solved.problem.contact[i];
    contact.node.push_back(point.node);
    contact.entry.push_back(point.entry);
    contact.status.push_back(static_cast<std::int32_t>(solved.contact.status[i]));
    contact.normal.insert(contact.normal.end(), point.normal.begin(), point.normal.end());
  }
}

void kacanov_solution_destroy(kacanov_solution* solution) { delete solution; }

int kacanov_solution_inspect(const kacanov_solution* solution, kacanov_solution_information* information) {
  return c::guarded(nullptr, 0, [&] {
    c::require(solution, "solution");
    c::require(information, "information");
    const kacanov::SolvedCase& solved = solution->solved;
    const Mesh& mesh = solved.problem.mesh;
    kacanov_solution_information about{};
    about.status = status_of(solved.result.status);
    about.worst_residual = solved.result.certificate.worst();
    about.message = solved.result.message.c_str();
    if (!mesh.coordinates.empty()) {
      about.nodes = mesh.node_count();
      about.elements = mesh.element_count();
      about.contact_points = solved.problem.contact.size();
      about.element = static_cast<std::int32_t>(mesh.type);
      about.dimension = mesh.dim();
      about.nodes_per_element = kacanov::nodes_per_element(mesh.type);
    }
    c::write_sized(about, information, information_bytes, "information.", "kacanov_solution_information");
  });
}

const char* kacanov_solution_json(const kacanov_solution* solution) {
  return solution == nullptr ? "" : solution->json.c_str();
}

const double* kacanov_solution_field(const kacanov_solution* solution, int32_t field, size_t* count) {
  return handed_out<double>(solution, count, [&](const auto& of) { return field_of(of, field); });
}

const int32_t* kacanov_solution_indices(const kacanov_solution* solution, int32_t index, size_t* count) {
  return handed_out<std::int32_t>(solution, count, [&](const auto& of) { return indices_of(of, index); });
}

const int64_t* kacanov_solution_numbers(const kacanov_solution* solution, int32_t elements, size_t* count) {
  return handed_out<std::int64_t>(solution, count, [&](const auto& of) {
    return std::span(elements != 0 ? of.element_numbers : of.node_numbers);
  });
}
