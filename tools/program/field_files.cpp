// SPDX-License-Identifier: BSD-3-Clause
// Writes solution fields for ParaView: the body and the contact surface.
#include "program/field_files.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "formats/vtu_writer.hpp"
#include "problem/selection.hpp"
#include "problem/vector3.hpp"
#include "program/shared_grid.hpp"

namespace kacanov {

namespace {

std::string step_mark(std::size_t step) { return step == 0 ? "" : "_step_" + std::to_string(step); }
std::string surface_file(std::size_t step) { return "contact" + step_mark(step) + ".vtu"; }

/// Returns the name without the extension of a field file; empty if it has none.
std::string_view stem(std::string_view name) {
  for (const std::string_view ending : {".vtu", ".pvtu"})
    if (name.ends_with(ending)) return name.substr(0, name.size() - ending.size());
  return {};
}

}  // namespace

std::string_view without_number(std::string_view name, std::string_view mark) {
  const std::size_t last = name.find_last_not_of("0123456789");
  if (last == std::string_view::npos || last + 1 == name.size() || !name.substr(0, last + 1).ends_with(mark))
    return name;
  return name.substr(0, last + 1 - mark.size());
}

std::string body_file(std::size_t step) { return "body" + step_mark(step) + ".vtu"; }

bool is_step_file(std::string_view name) {
  const std::string_view whole = stem(name);
  for (const std::string_view field : {"body", "contact"})
    for (const std::string_view one : {whole, without_number(whole, "_")})
      if (const std::string_view step = without_number(one, "_step_"); step != one && step == field)
        return true;
  return false;
}

bool is_field_file(std::string_view name) {
  return name == "result.pvd" || name == "body.pvtu" || name == "contact.vtu" || is_step_file(name) ||
         (name.ends_with(".vtu") && without_number(stem(name), "_") == "body");
}

namespace {

/// The user's numbers, computed while they are written.
template <typename Tag>
Values<std::int64_t> tags(std::size_t count, const Tag& tag) {
  return {count, [tag](std::size_t first, std::span<std::int64_t> out) {
            for (std::size_t i = 0; i < out.size(); ++i) out[i] = tag(first + i);
          }};
}

/// Facets of one contact entry with nodal values.
struct DrawnSurface {
  std::vector<double> points, gap, pressure, traction, normal, displacement;
  std::vector<std::int32_t> cells, nodes;  ///< `nodes`: mesh node of each point
  std::vector<std::int64_t> status, entry, node_id;
};

/// Status of nodes that are not contact points (supported, or not facing the obstacle); their fields are
/// zero.
constexpr std::int64_t no_contact_point = -1;

/// Corners of quadratic facets are not contact points (theory: contact-mass): their values are extrapolated
/// linearly from the mid-side nodes and averaged over the facets, and the status is the most frequent one of
/// the adjacent mid-side nodes. `entry`: facets of an entry as point indices of the surface.
class CornerValues {
 public:
  explicit CornerValues(DrawnSurface& surface) : surface_(surface) {}

  void spread(std::span<const std::int32_t> entry, const Cell& facet) {
    if (facet.order == 1) return;
    const std::size_t nodes = facet.nodes;
    for (std::size_t f = 0; f < entry.size(); f += nodes)
      for (std::int8_t corner = 0; corner < facet.corners; ++corner)
        add(entry.subspan(f, nodes), facet, corner);
    for (const auto& [corner, sums] : corners_) set(corner, sums);
  }

 private:
  struct Sums {
    int facets = 0;
    double gap = 0.0, pressure = 0.0;
    Vector3 traction{}, normal{};
    std::array<int, 3> status{};  ///< number of adjacent mid-side nodes that are open, stick, slip
  };

  void add(std::span<const std::int32_t> facet, const Cell& type, std::int8_t corner) {
    if (surface_.status[facet[corner]] != no_contact_point) return;
    const bool whole = std::all_of(type.edges.begin(), type.edges.end(), [&](const CellEdge& edge) {
      return surface_.status[facet[edge.middle]] != no_contact_point;
    });
    Sums sums = corners_[facet[corner]];
    for (const CellEdge& edge : type.edges) {
      const std::size_t middle = facet[edge.middle];
      const std::int64_t status = surface_.status[middle];
      const bool beside = edge.a == corner || edge.b == corner;
      if (beside && status != no_contact_point) ++sums.status[status];
      for (std::size_t c = 0; c < 3 && beside; ++c) sums.normal[c] += surface_.normal[3 * middle + c];
      if (!whole) continue;
      const double share = beside ? 1.0 : -1.0;
      sums.gap += share * surface_.gap[middle];
      sums.pressure += share * surface_.pressure[middle];
      for (std::size_t c = 0; c < 3; ++c) sums.traction[c] += share * surface_.traction[3 * middle + c];
    }
    if (whole) ++sums.facets;
    corners_[facet[corner]] = sums;
  }

  void set(std::size_t corner, const Sums& sums) {
    if (sums.facets == 0) return;
    const auto most = std::max_element(sums.status.begin(), sums.status.end());
    surface_.status[corner] = most - sums.status.begin();
    surface_.gap[corner] = sums.gap / sums.facets;
    surface_.pressure[corner] = std::max(0.0, sums.pressure / sums.facets);
    const double length = norm(sums.normal);
    for (std::size_t c = 0; c < 3; ++c) {
      surface_.traction[3 * corner + c] = sums.traction[c] / sums.facets;
      surface_.normal[3 * corner + c] = length > 0.0 ? sums.normal[c] / length : 0.0;
    }
  }

  DrawnSurface& surface_;
  std::map<std::int32_t, Sums> corners_;
};

/// Returns whether a contact point belongs to the entry, alone or merged with others.
bool is_of(const Problem& problem, std::ptrdiff_t point, std::size_t entry) {
  const auto index = static_cast<std::int32_t>(point), number = static_cast<std::int32_t>(entry);
  if (problem.contact[static_cast<std::size_t>(point)].entry == number) return true;
  const auto& shares = problem.contact_shares;
  auto share = std::lower_bound(shares.begin(), shares.end(), index,
                                [](const PointShare& s, std::int32_t p) { return s.point < p; });
  for (; share != shares.end() && share->point == index; ++share)
    if (share->entry == number) return true;
  return false;
}

DrawnSurface contact_surface(const Problem& problem, const Model& model, const ContactFields& fields) {
  const Mesh& mesh = problem.mesh;
  const std::size_t dim = mesh.dim();
  DrawnSurface surface;
  const Selection selection(mesh);
  for (std::size_t entry = 0; entry < model.contact.size(); ++entry) {
    const auto facets = selection.facets(model.contact[entry].on, "contact[" + std::to_string(entry) + "]");
    const auto nodes = nodes_of_facets(mesh, facets);
    const auto first = static_cast<std::int32_t>(surface.node_id.size());
    auto point = problem.contact.begin();
    for (const std::int32_t node : nodes) {
      for (std::size_t c = 0; c < dim; ++c) {
        surface.points.push_back(mesh.coordinates[node * dim + c]);
      }
      surface.nodes.push_back(node);
      surface.node_id.push_back(mesh.node_tag(node));
      while (point != problem.contact.end() && point->node < node) ++point;
      // The point of this entry, or the one it was merged with.
      auto chosen = problem.contact.end();
      for (auto p = point; p != problem.contact.end() && p->node == node; ++p) {
        if (chosen == problem.contact.end() || is_of(problem, p - problem.contact.begin(), entry)) chosen = p;
      }
      const bool there = chosen != problem.contact.end();
      const std::size_t i = chosen - problem.contact.begin();
      surface.gap.push_back(there ? fields.gap[i] : 0.0);
      surface.pressure.push_back(there ? fields.pressure[i] : 0.0);
      surface.status.push_back(there ? static_cast<std::int64_t>(fields.status[i]) : no_contact_point);
      surface.entry.push_back(static_cast<std::int64_t>(entry));
      for (std::size_t c = 0; c < 3; ++c) {
        surface.traction.push_back(there ? fields.traction[3 * i + c] : 0.0);
        surface.normal.push_back(there ? problem.contact[i].normal[c] : 0.0);
        surface.displacement.push_back(
            c < dim && !fields.displacement.empty() ? fields.displacement[node * dim + c] : 0.0);
      }
    }
    const std::size_t cells_before = surface.cells.size();
    for (const std::int32_t f : facets) {
      for (const std::int32_t node : mesh.facet(f)) {
        surface.cells.push_back(
            first +
            static_cast<std::int32_t>(std::lower_bound(nodes.begin(), nodes.end(), node) - nodes.begin()));
      }
    }
    CornerValues(surface).spread(std::span(surface.cells).subspan(cells_before), cell(mesh.type).facet());
  }
  return surface;
}

}  // namespace

ContactFields gather_contact_fields(const Part& part, const Solution& solution) {
  std::vector<double> traction, status;
  for (const Vector3& t : solution.traction) traction.insert(traction.end(), t.begin(), t.end());
  for (const ContactStatus s : solution.contact_status) status.push_back(static_cast<double>(s));
  return {gather_contact(part, solution.gap, 1),
          gather_contact(part, solution.pressure, 1),
          gather_contact(part, status, 1),
          gather_contact(part, traction, 3),
          {}};
}

void write_body(const FieldPlace& place, const Part& part, const Solution& solution, const BodyFields& fields,
                const MpiSession& mpi) {
  const int dim = part.dim();
  const std::size_t owned = part.owned_nodes(), elements = part.element_count();
  const auto nodal = [owned](const std::vector<double>& all, int components) {
    return Values<double>(std::span(all).first(owned * static_cast<std::size_t>(components)));
  };
  const Values<double> stress(6 * elements, [&](std::size_t first, std::span<double> out) {
    reference::ElementFields wanted;
    wanted.stress = out;
    element_fields(part, solution, first / 6, out.size() / 6, wanted);
  });
  const Values<double> strain(6 * elements, [&](std::size_t first, std::span<double> out) {
    element_strains(part, solution, first / 6, out.size() / 6, out);
  });
  const auto material = [&part](std::size_t e) {
    return std::int64_t{part.law_of_element.empty() ? std::uint16_t{0} : part.law_of_element[e]};
  };
  const auto set = [&fields](std::size_t e) {
    return fields.sets.empty() ? std::int64_t{0} : std::int64_t{fields.sets[fields.sets.size() == 1 ? 0 : e]};
  };
  Grid grid;
  grid.dim = dim;
  grid.cell = &cell(part.type);
  grid.points = std::span(part.coordinates).first(part.owned_unknowns());
  grid.cells = part.elements;
  grid.number_of_point = [&part](std::int32_t node) {
    return part.node_number(static_cast<std::size_t>(node));
  };
  grid.point_fields = {{"displacement", dim, nodal(solution.displacement, dim)},
                       {"node_id", 1, tags(owned, [&part](std::size_t i) { return part.node_tag(i); })},
                       {"nodal_stress", 6, nodal(fields.nodal.stress, 6)},
                       {"nodal_von_mises", 1, nodal(fields.nodal.von_mises, 1)}};
  if (part.has_patches())
    grid.point_fields.push_back(
        {"pressure_patch", 1, tags(owned, [&part](std::size_t i) { return part.pressure_patch[i]; })});
  grid.cell_fields = {
      {"stress", 6, stress},
      {"von_mises", 1, Values<double>(fields.numbers.von_mises)},
      {"strain", 6, strain},
      {"dev_strain", 1, Values<double>(fields.numbers.dev_strain)},
      {"g", 1, Values<double>(fields.numbers.secant)},
      {"plastic", 1, Values<std::uint8_t>(fields.numbers.plastic)},
      {"material", 1, tags(elements, material)},
      {"set", 1, tags(elements, set)},
      {"element_id", 1, tags(elements, [&part](std::size_t e) { return part.element_tag(e); })},
      {"error", 1, Values<double>(fields.error)}};
  write_shared_vtu((place.folder / body_file(place.step)).string(), grid, mpi);
}

void write_surface(const FieldPlace& place, const Problem& problem, const Model& model,
                   const ContactFields& contact) {
  if (problem.contact.empty()) return;
  const DrawnSurface surface = contact_surface(problem, model, contact);
  Grid grid;
  grid.dim = problem.mesh.dim();
  grid.cell = &cell(problem.mesh.type).facet();
  grid.points = surface.points;
  grid.cells = surface.cells;
  grid.point_fields = {{"gap", 1, surface.gap},
                       {"pressure", 1, surface.pressure},
                       {"tangential_traction", 3, surface.traction},
                       {"normal", 3, surface.normal},
                       {"displacement", 3, surface.displacement},
                       {"status", 1, surface.status},
                       {"entry", 1, surface.entry},
                       {"node_id", 1, surface.node_id}};
  write_vtu((place.folder / surface_file(place.step)).string(), grid);
}

std::vector<double> nodal_pressure(const Problem& problem, const Model& model, const ContactFields& contact) {
  std::vector<double> pressure(problem.mesh.node_count(), 0.0);
  if (problem.contact.empty()) return pressure;
  const DrawnSurface surface = contact_surface(problem, model, contact);
  for (std::size_t i = 0; i < surface.nodes.size(); ++i) pressure[surface.nodes[i]] = surface.pressure[i];
  return pressure;
}

std::vector<DeformedPicture::ObstacleFacet> obstacle_facets(const Problem& problem, const Model& model,
                                                            const ContactFields& contact, int& missing) {
  missing = 0;
  std::vector<DeformedPicture::ObstacleFacet> facets;
  if (problem.contact.empty()) return facets;
  const DrawnSurface surface = contact_surface(problem, model, contact);
  const Cell& facet = cell(problem.mesh.type).facet();
  const std::size_t dim = problem.mesh.dim();
  std::vector<std::array<std::int8_t, 3>> pattern(facet.triangles.begin(), facet.triangles.end());
  if (dim == 2) pattern = {{0, 1, 1}};
  std::vector<bool> drawn(model.contact.size(), false);
  for (std::size_t first = 0; first < surface.cells.size(); first += facet.nodes) {
    const auto entry = static_cast<std::size_t>(surface.entry[surface.cells[first]]);
    const ContactEntry& of = model.contact[entry];
    if (std::holds_alternative<Plane>(of.obstacle) && !of.moves()) {
      drawn[entry] = true;
      continue;
    }
    for (const auto& corners : pattern) {
      DeformedPicture::ObstacleFacet out;
      bool faces = true;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t i = surface.cells[first + static_cast<std::size_t>(corners[k])];
        faces = faces && surface.status[i] != no_contact_point;
        double along = surface.gap[i];
        for (std::size_t c = 0; c < dim; ++c)
          along += surface.normal[3 * i + c] * surface.displacement[3 * i + c];
        for (std::size_t c = 0; c < dim; ++c) {
          out.corners[k][c] = surface.points[i * dim + c] + along * surface.normal[3 * i + c];
          out.normal[c] -= surface.normal[3 * i + c] / 3.0;
        }
      }
      if (!faces) continue;
      drawn[entry] = true;
      facets.push_back(out);
    }
  }
  missing = static_cast<int>(std::count(drawn.begin(), drawn.end(), false));
  return facets;
}

void write_series(const std::filesystem::path& folder, const Problem& problem, const Result& result) {
  std::vector<PvdPart> parts;
  const auto add = [&](std::size_t step, double time) {
    parts.push_back({"body", body_file(step), time, 0});
    if (!problem.contact.empty()) parts.push_back({"contact", surface_file(step), time, 1});
  };
  for (std::size_t k = 0; k < result.load_steps.size(); ++k) {
    const double time = result.load_steps[k].factor;
    if (time < result.load_factor && std::filesystem::exists(folder / body_file(k + 1))) add(k + 1, time);
  }
  add(0, result.load_steps.empty() && !result.by_time ? 0.0 : result.load_factor);
  write_pvd((folder / "result.pvd").string(), parts);
}

}  // namespace kacanov
