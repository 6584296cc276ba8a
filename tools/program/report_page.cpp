// SPDX-License-Identifier: BSD-3-Clause
// Embeds the data of a run in report.html.
#include "program/report_page.hpp"

#include <cmath>
#include <limits>
#include <variant>

#include <kacanov/error.hpp>
#include "formats/xml.hpp"
#include "pictures/png.hpp"
#include "pictures/surface.hpp"
#include "problem/selection.hpp"

namespace kacanov {
namespace {

using nlohmann::ordered_json;

/// JSON in which no name can contain "</script>".
std::string embedded(const ordered_json& json) {
  std::string text;
  for (const char c : json.dump(-1, ' ', false, ordered_json::error_handler_t::replace))
    if (c == '<')
      text += "\\u003c";
    else
      text += c;
  return text;
}

template <typename T>
std::string packed(const std::vector<T>& values) {
  return base64({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
}

/// Converts to single precision; non-finite values become 0, as in the picture.
float shown_value(double value) { return std::isfinite(value) ? static_cast<float>(value) : 0.0F; }

std::string packed_values(std::span<const double> values) {
  std::vector<float> single;
  single.reserve(values.size());
  for (const double v : values) single.push_back(shown_value(v));
  return packed(single);
}

/// Three entries per node, relative to `centre`.
std::string packed_vectors(std::span<const double> values, std::size_t dim, const Vector3& centre) {
  std::vector<float> single;
  for (std::size_t i = 0; i < values.size(); i += dim)
    for (std::size_t k = 0; k < 3; ++k)
      single.push_back(k < dim ? shown_value(values[i + k] - centre[k]) : 0.0F);
  return packed(single);
}

const char* kind_of(const BoundaryEntry& entry) {
  return entry.is_support() ? "support" : entry.is_spring() ? "spring" : "load";
}

/// Nodes of the entries to be marked; volume loads and inner nodes have no marks.
ordered_json marks_json(const ReportPage& page) {
  const Selection selection(*page.mesh);
  const Model& model = page.input->model;
  ordered_json marks = ordered_json::array();
  const auto add = [&](const std::string& name, const char* kind, const Selector& on) {
    ordered_json mark{{"name", name}, {"kind", kind}, {"nodes", nullptr}};
    try {
      mark["nodes"] = packed(selection.nodes(on, name));
    } catch (const InputError&) {  // inner nodes are not in the boundary mesh; the page mentions it
    }
    marks.push_back(mark);
  };
  for (std::size_t i = 0; i < model.boundary.size(); ++i) {
    const BoundaryEntry& entry = model.boundary[i];
    if (!entry.body_force && !entry.temperature)
      add(entry_name(entry, static_cast<std::int32_t>(i)), kind_of(entry), entry.on);
  }
  for (std::size_t i = 0; i < model.contact.size(); ++i)
    add(entry_name(model.contact[i], static_cast<std::int32_t>(i)), "contact", model.contact[i].on);
  return marks;
}

ordered_json vector_json(const Vector3& v, const Vector3& origin) {
  return {v[0] - origin[0], v[1] - origin[1], v[2] - origin[2]};
}

/// Planes at rest.
ordered_json planes_json(const Model& model, const Vector3& centre) {
  ordered_json planes = ordered_json::array();
  for (const ContactEntry& entry : model.contact) {
    const auto* plane = std::get_if<Plane>(&entry.obstacle);
    if (plane != nullptr && !entry.moves())
      planes.push_back(
          {{"point", vector_json(plane->point, centre)}, {"normal", vector_json(plane->normal, {})}});
  }
  return planes;
}

/// Corners of triangles; end points of segments in 2D.
std::string packed_obstacles(const std::vector<DeformedPicture::ObstacleFacet>& facets, std::size_t dim,
                             const Vector3& centre) {
  std::vector<float> all;
  for (const DeformedPicture::ObstacleFacet& facet : facets)
    for (std::size_t corner = 0; corner < dim; ++corner)
      for (std::size_t c = 0; c < 3; ++c) all.push_back(shown_value(facet.corners[corner][c] - centre[c]));
  return packed(all);
}

std::string image(const char* title, const char* alt, const std::string& svg) {
  if (svg.empty()) return {};
  return std::string("<h2>") + title + "</h2>\n<img alt=\"" + alt + "\" src=\"data:image/svg+xml;base64," +
         base64(svg) + "\">\n";
}

ordered_json scene_json(const ReportPage& page) {
  const Mesh& mesh = *page.mesh;
  const std::size_t dim = mesh.dim();
  const auto triangles = surface_triangles(mesh);
  ordered_json scene{{"dim", dim}, {"nodes", mesh.node_count()}, {"triangles", triangles.size()}};
  scene["most"] = page.most_triangles;
  scene["not_shown"] = page.shown->not_shown;
  if (triangles.size() > page.most_triangles) return scene;
  const Extent box = extent(mesh);
  Vector3 centre{};
  for (std::size_t k = 0; k < dim; ++k) centre[k] = (box.lower[k] + box.upper[k]) / 2;
  scene["size"] = box.size;
  // As in the picture, the axis is omitted if it is farther from the body than the body is wide.
  if (mesh.plane == PlaneState::axisymmetric && box.lower[0] < box.upper[0] - box.lower[0])
    scene["axis"] = {{"x", -centre[0]}, {"reach", 0.6 * (box.upper[1] - box.lower[1])}};
  scene["scale"] = page.input->output.scale;
  scene["corners"] = packed(triangles);
  scene["points"] = packed_vectors(mesh.coordinates, dim, centre);
  scene["displacement"] = packed_vectors(page.displacement, dim, {});
  scene["fields"] = ordered_json::array();
  for (const ShownRun::Field& field : page.shown->fields)
    scene["fields"].push_back({{"name", field.name}, {"values", packed_values(field.values)}});
  scene["marks"] = marks_json(page);
  scene["first"] = page.shown->first;
  const Vector3& view = page.input->output.view;
  if (view != Vector3{}) scene["view"] = view;
  scene["planes"] = planes_json(page.input->model, centre);
  scene["obstacles"] = packed_obstacles(page.shown->obstacles, dim, centre);
  return scene;
}

std::string data_block(const char* id, const ordered_json& json) {
  return std::string("<script type=\"application/json\" id=\"") + id + "\">" + embedded(json) + "</script>\n";
}

}  // namespace

std::string report_html(const ReportPage& page) {
  const std::size_t nodes = page.mesh->node_count();
  bool fits = page.displacement.size() == page.mesh->coordinates.size();
  for (const ShownRun::Field& field : page.shown->fields) fits = fits && field.values.size() == nodes;
  if (!fits) throw InternalError("report: a field does not fit the mesh");
  const std::string title = xml_escape(page.input->name);
  std::string html = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  html +=
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
      "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n";
  html += "<title>" + title + "</title>\n<style>" + report_style + "</style>\n</head>\n<body>\n";
  html += "<h1>" + title + "</h1>\n<noscript><p>This page needs JavaScript.</p></noscript>\n";
  html += "<div id=\"verdict\"></div>\n<div id=\"view\"></div>\n";
  html += image("Deformed body", "The deformed body", page.shown->picture);
  html += image("Contact pressure", "The contact pressure, seen from the obstacles",
                page.shown->pressure_picture);
  html += "<div id=\"convergence\"></div>\n<div id=\"numbers\"></div>\n";
  html += data_block("result", *page.result) + data_block("scene", scene_json(page)) +
          data_block("history", page.history);
  html += std::string("<script>") + report_script + report_view + "</script>\n</body>\n</html>\n";
  return html;
}

}  // namespace kacanov
