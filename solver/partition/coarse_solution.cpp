// SPDX-License-Identifier: BSD-3-Clause
// The solution of the same body on a coarser mesh, used as initial guess on a finer one.
#include <kacanov/coarse_solution.hpp>

#include <algorithm>
#include <array>

#include "partition/part_fields.hpp"
#include "problem/point_location.hpp"
#include "problem/shapes.hpp"
#include "problem/vector3.hpp"

namespace kacanov {
namespace {

/// Broadcasts rank 0's entries.
template <class T>
void broadcast(std::vector<T>& values, const Communicator& ranks) {
  if (ranks.ranks == 1) return;
  ranks.expect_all_here();
  std::uint64_t count = values.size();
  MPI_Bcast(&count, sizeof count, MPI_BYTE, 0, mpi_of(ranks));
  values.resize(count);
  char* at = reinterpret_cast<char*>(values.data());
  for (std::size_t left = count * sizeof(T); left > 0;) {
    const std::size_t piece = std::min(left, longest_message);
    MPI_Bcast(at, static_cast<int>(piece), MPI_BYTE, 0, mpi_of(ranks));
    at += piece;
    left -= piece;
  }
}

/// Interpolation weights of a fine node in its coarse element.
struct Weights {
  std::span<const std::int32_t> nodes;     ///< of the coarse element
  std::array<double, most_nodes> value{};  ///< of its shape functions
};

Weights weights_at(const CoarseSolution& coarse, const PointLocator& locator, const Vector3& x) {
  const PointLocator::Place place = locator.find(x);
  const Cell& type = cell(coarse.type);
  const auto npe = static_cast<std::size_t>(type.nodes);
  return {std::span(coarse.elements).subspan(static_cast<std::size_t>(place.element) * npe, npe),
          shapes_at(type, place.at).value};
}

}  // namespace

bool CoarseSolution::at_rest() const noexcept {
  return std::all_of(displacement.begin(), displacement.end(), [](double u) { return u == 0.0; }) &&
         std::all_of(contact.begin(), contact.end(), [](const auto& point) { return point.pressure == 0.0; });
}

CoarseSolution whole_solution(const Part& part, const Problem* problem, const Solution& solution) {
  CoarseSolution coarse;
  coarse.type = part.type;
  coarse.lambda_max = solution.result.lambda_max;
  coarse.displacement = gather_nodal(part, solution.displacement, part.dim());
  const std::vector<double> pressure = gather_contact(part, solution.pressure, 1);
  std::vector<double> traction(3 * solution.traction.size());
  for (std::size_t i = 0; i < traction.size(); ++i) traction[i] = solution.traction[i / 3][i % 3];
  traction = gather_contact(part, traction, 3);
  if (problem != nullptr) {
    coarse.coordinates = problem->mesh.coordinates;
    coarse.elements = problem->mesh.elements;
    for (std::size_t i = 0; i < pressure.size(); ++i) {
      const ContactPoint& point = problem->contact[i];
      const double* friction = &traction[3 * i];
      coarse.contact.push_back(
          {point.node, point.entry, pressure[i], {friction[0], friction[1], friction[2]}});
    }
    std::stable_sort(coarse.contact.begin(), coarse.contact.end(),
                     [](const auto& a, const auto& b) { return a.node < b.node; });
  }
  share(coarse, part.node_map);
  return coarse;
}

void share(CoarseSolution& coarse, const Communicator& ranks) {
  std::vector<double> numbers{static_cast<double>(coarse.type), coarse.lambda_max};
  for (std::vector<double>* values : {&numbers, &coarse.coordinates, &coarse.displacement})
    broadcast(*values, ranks);
  broadcast(coarse.elements, ranks);
  broadcast(coarse.contact, ranks);
  coarse.type = static_cast<ElementType>(numbers[0]);
  coarse.lambda_max = numbers[1];
}

Start interpolate(const CoarseSolution& coarse, const Part& part) {
  const PointLocator locator(coarse.view());
  const std::size_t dim = part.dim();
  const MeshView mesh = part.body().mesh;
  Start start;
  start.lambda_max = coarse.lambda_max;
  start.displacement.resize(part.unknowns());
  for (std::size_t n = 0; n < part.nodes(); ++n) {
    const Weights weights = weights_at(coarse, locator, position(mesh, static_cast<std::int32_t>(n)));
    for (std::size_t a = 0; a < weights.nodes.size(); ++a)
      for (std::size_t c = 0; c < dim; ++c)
        start.displacement[n * dim + c] +=
            weights.value[a] * coarse.displacement[static_cast<std::size_t>(weights.nodes[a]) * dim + c];
  }
  start.pressure.resize(part.contact.size());
  start.friction.resize(2 * part.contact.size());
  for (std::size_t i = 0; i < part.contact.size(); ++i) {
    const ContactPoint& point = part.contact[i];
    const Weights weights = weights_at(coarse, locator, position(mesh, point.node));
    // Coarse nodes without contact points, such as constrained nodes and corners of quadratic facets, are
    // skipped. If they carry almost all of the weight, the element's contact nodes count equally.
    double known = 0.0, pressure = 0.0;
    Vector3 friction{};
    for (const bool all : {false, true}) {
      if (known > 0.1) break;
      for (std::size_t a = 0; a < weights.nodes.size(); ++a) {
        const double weight = all ? 1.0 : std::max(weights.value[a], 0.0);
        auto at = std::lower_bound(coarse.contact.begin(), coarse.contact.end(), weights.nodes[a],
                                   [](const auto& entry, std::int32_t node) { return entry.node < node; });
        for (; at != coarse.contact.end() && at->node == weights.nodes[a]; ++at) {
          if (at->entry != point.entry) continue;
          known += weight;
          pressure += weight * at->pressure;
          friction = friction + weight * at->friction;
        }
      }
    }
    if (!(known > 0.1)) continue;
    start.pressure[i] = std::max(pressure / known, 0.0);
    for (std::size_t k = 0; k < static_cast<std::size_t>(point.tangents); ++k)
      start.friction[2 * i + k] = -dot(friction, point.tangent[k]) / known;
  }
  return start;
}

}  // namespace kacanov
