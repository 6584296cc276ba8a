// SPDX-License-Identifier: BSD-3-Clause
// The fields of a solution as files for ParaView: the body in one piece a rank, the contact surface in one.
#include "program/field_files.hpp"

#include <algorithm>
#include <array>
#include <map>

#include <kacanov/element_fields.hpp>
#include "formats/vtu_writer.hpp"
#include "problem/selection.hpp"

namespace kacanov {

namespace {

std::string step_mark(std::size_t step) { return step == 0 ? "" : "_step_" + std::to_string(step); }
std::string whole_body(int ranks, std::size_t step) {
  return ranks == 1 ? body_file(0, 1, step) : "body" + step_mark(step) + ".pvtu";
}
std::string surface_file(std::size_t step) { return "contact" + step_mark(step) + ".vtu"; }

/// Without the ending of a file of fields; empty where it has none.
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

std::string body_file(int rank, int ranks, std::size_t step) {
  return "body" + step_mark(step) + (ranks == 1 ? "" : "_" + std::to_string(rank)) + ".vtu";
}

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

/// Names and types of the body's fields; the values are filled in by the caller.
Grid body_grid(ElementType type) {
  using Real = Values<double>;
  using Number = Values<std::int64_t>;
  using Flag = Values<std::uint8_t>;
  const int dim = dimension(type);
  Grid grid;
  grid.dim = dim;
  grid.cell = &cell(type);
  grid.point_fields = {{"displacement", dim, Real()},
                       {"node_id", 1, Number()},
                       {"nodal_stress", 6, Real()},
                       {"nodal_von_mises", 1, Real()}};
  grid.cell_fields = {{"stress", 6, Real()}, {"von_mises", 1, Real()}, {"dev_strain", 1, Real()},
                      {"g", 1, Real()},      {"plastic", 1, Flag()},   {"element_id", 1, Number()},
                      {"error", 1, Real()}};
  return grid;
}

/// The user's numbers, worked out while they are written.
template <typename Tag>
Values<std::int64_t> tags(std::size_t count, const Tag& tag) {
  return {count, [tag](std::size_t first, std::span<std::int64_t> out) {
            for (std::size_t i = 0; i < out.size(); ++i) out[i] = tag(first + i);
          }};
}

/// The facets of one contact entry with values at their nodes.
struct DrawnSurface {
  std::vector<double> points, gap, pressure, traction;
  std::vector<std::int32_t> cells, nodes;  ///< `nodes` of the mesh, in the order of the points
  std::vector<std::int64_t> status, node_id;
};

/// Nodes that are no contact points (held, or missing the obstacle) have this status and zero fields.
constexpr std::int64_t no_contact_point = -1;

/// Corners of quadratic facets are no contact points (theory: contact-mass): values run on linearly from the
/// three mid-sides of each facet, the mean of the facets round a corner is taken, and the status that most of
/// the mid-sides beside it have. `entry`: the facets of an entry in places of the surface.
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
    Vector3 traction{};
    std::array<int, 3> status{};  ///< how many mid-sides beside it are open, stick, slip
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
    for (std::size_t c = 0; c < 3; ++c) surface_.traction[3 * corner + c] = sums.traction[c] / sums.facets;
  }

  DrawnSurface& surface_;
  std::map<std::int32_t, Sums> corners_;
};

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
      // The entry's own point, or the one it was merged with.
      auto chosen = problem.contact.end();
      for (auto p = point; p != problem.contact.end() && p->node == node; ++p) {
        if (chosen == problem.contact.end() || p->entry == static_cast<std::int32_t>(entry)) chosen = p;
      }
      const bool there = chosen != problem.contact.end();
      const std::size_t i = chosen - problem.contact.begin();
      surface.gap.push_back(there ? fields.gap[i] : 0.0);
      surface.pressure.push_back(there ? fields.pressure[i] : 0.0);
      surface.status.push_back(there ? static_cast<std::int64_t>(fields.status[i]) : no_contact_point);
      for (std::size_t c = 0; c < 3; ++c)
        surface.traction.push_back(there ? fields.traction[3 * i + c] : 0.0);
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

void write_surface(const std::filesystem::path& file, const DrawnSurface& surface, const Mesh& mesh) {
  Grid grid;
  grid.dim = mesh.dim();
  grid.cell = &cell(mesh.type).facet();
  grid.points = surface.points;
  grid.cells = surface.cells;
  grid.point_fields = {{"gap", 1, surface.gap},
                       {"pressure", 1, surface.pressure},
                       {"tangential_traction", 3, surface.traction},
                       {"status", 1, surface.status},
                       {"node_id", 1, surface.node_id}};
  write_vtu(file.string(), grid);
}

}  // namespace

ContactFields gather_contact_fields(const Part& part, const Solution& solution) {
  std::vector<double> traction, status;
  for (const Vector3& t : solution.traction) traction.insert(traction.end(), t.begin(), t.end());
  for (const ContactStatus s : solution.contact_status) status.push_back(static_cast<double>(s));
  return {gather_contact(part, solution.gap, 1), gather_contact(part, solution.pressure, 1),
          gather_contact(part, status, 1), gather_contact(part, traction, 3)};
}

void write_body(const FieldPlace& place, const Part& part, const Solution& solution,
                const BodyFields& fields) {
  Grid grid = body_grid(part.type);
  grid.points = part.coordinates;
  grid.cells = part.elements;
  grid.point_fields[0].values = Values<double>(solution.displacement);
  grid.point_fields[1].values = tags(part.nodes(), [&part](std::size_t i) { return part.node_tag(i); });
  grid.point_fields[2].values = Values<double>(fields.nodal.stress);
  grid.point_fields[3].values = Values<double>(fields.nodal.von_mises);
  const auto element_field = [&](int components, std::span<double> reference::ElementFields::*which) {
    const std::size_t width = components;
    return Values<double>(part.element_count() * width,
                          [&part, &solution, which, width](std::size_t first, std::span<double> out) {
                            reference::ElementFields wanted;
                            wanted.*which = out;
                            element_fields(part, solution, first / width, out.size() / width, wanted);
                          });
  };
  using Fields = reference::ElementFields;
  grid.cell_fields[0].values = element_field(6, &Fields::stress);
  grid.cell_fields[1].values = element_field(1, &Fields::von_mises);
  grid.cell_fields[2].values = element_field(1, &Fields::dev_strain);
  grid.cell_fields[3].values = element_field(1, &Fields::secant);
  grid.cell_fields[4].values =
      Values<std::uint8_t>(part.element_count(), [&](std::size_t first, std::span<std::uint8_t> out) {
        reference::ElementFields wanted;
        wanted.plastic = out;
        element_fields(part, solution, first, out.size(), wanted);
      });
  grid.cell_fields[5].values =
      tags(part.element_count(), [&part](std::size_t e) { return part.element_tag(e); });
  grid.cell_fields[6].values = Values<double>(fields.error);
  write_vtu((place.folder / body_file(part.node_map.rank, part.node_map.ranks, place.step)).string(), grid);
}

void write_surroundings(const FieldPlace& place, const Problem& problem, const Model& model,
                        const ContactFields& contact, int ranks) {
  if (ranks > 1) {
    std::vector<std::string> pieces;
    for (int rank = 0; rank < ranks; ++rank) pieces.push_back(body_file(rank, ranks, place.step));
    write_pvtu((place.folder / whole_body(ranks, place.step)).string(), body_grid(problem.mesh.type), pieces);
  }
  if (!problem.contact.empty())
    write_surface(place.folder / surface_file(place.step), contact_surface(problem, model, contact),
                  problem.mesh);
}

std::vector<double> nodal_pressure(const Problem& problem, const Model& model, const ContactFields& contact) {
  std::vector<double> pressure(problem.mesh.node_count(), 0.0);
  if (problem.contact.empty()) return pressure;
  const DrawnSurface surface = contact_surface(problem, model, contact);
  for (std::size_t i = 0; i < surface.nodes.size(); ++i) pressure[surface.nodes[i]] = surface.pressure[i];
  return pressure;
}

void write_series(const std::filesystem::path& folder, const Problem& problem, const Result& result,
                  int ranks) {
  std::vector<PvdPart> parts;
  const auto add = [&](std::size_t step, double time) {
    parts.push_back({"body", whole_body(ranks, step), time, 0});
    if (!problem.contact.empty()) parts.push_back({"contact", surface_file(step), time, 1});
  };
  for (std::size_t k = 0; k < result.load_steps.size(); ++k) {
    const double time = result.load_steps[k].factor;
    // A run with another number of ranks, from a checkpoint of which this one goes on, has other names.
    if (time < result.load_factor && std::filesystem::exists(folder / whole_body(ranks, k + 1)))
      add(k + 1, time);
  }
  add(0, result.load_steps.empty() && !result.by_time ? 0.0 : result.load_factor);
  write_pvd((folder / "result.pvd").string(), parts);
}

}  // namespace kacanov
