// SPDX-License-Identifier: BSD-3-Clause
// Writes nodes, elements, sets and surfaces as a deck for Abaqus and CalculiX.
#include <algorithm>

#include "formats/deck_elements.hpp"
#include "formats/mesh_writer.hpp"
#include "formats/text_file.hpp"

namespace kacanov {
namespace {

/// Returns the side, from 1, of the facet's element that has the facet's corners.
std::int64_t side_of(const Mesh& mesh, std::size_t facet) {
  const auto type = static_cast<std::size_t>(mesh.type);
  const std::size_t n = nodes_per_element(mesh.type), corners = cell(mesh.type).facet().corners;
  const auto wanted = mesh.facet(facet).first(corners);
  const std::int32_t* element =
      mesh.elements.data() + static_cast<std::size_t>(mesh.facet_element[facet]) * n;
  for (std::size_t s = 0; s < deck_sides(type); ++s) {
    const auto side = deck_side(type, s).first(corners);
    if (std::all_of(side.begin(), side.end(), [&](std::int8_t k) {
          return std::find(wanted.begin(), wanted.end(), element[k]) != wanted.end();
        }))
      return static_cast<std::int64_t>(s) + 1;
  }
  return 0;
}

/// Abaqus accepts any name in quotes, CalculiX plain names only.
std::string in_a_deck(const std::string& name) {
  const bool plain = std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  return plain ? name : "\"" + name + "\"";
}

void write_group(TextFile& out, const Mesh& mesh, const Group& group) {
  const bool elements = group.dimension == mesh.dim(), facets = group.dimension == mesh.dim() - 1;
  const std::string name = in_a_deck(group.name) + "\n";
  out.text(elements ? "*ELSET, ELSET=" + name
           : facets ? "*SURFACE, TYPE=ELEMENT, NAME=" + name
                    : "*NSET, NSET=" + name);
  for (const std::int32_t m : group.members) {
    if (facets) {
      out.number(mesh.element_tag(mesh.facet_element[m]));
      out.text(", S");
      out.number(side_of(mesh, m));
    } else {
      out.number(elements ? mesh.element_tag(m) : mesh.node_tag(m));
    }
    out.text("\n");
  }
}

}  // namespace

void write_deck(const std::string& path, const Mesh& mesh) {
  TextFile out(path);
  const std::size_t dim = mesh.dim(), n = nodes_per_element(mesh.type);
  out.text("*NODE\n");
  for (std::size_t i = 0; i < mesh.node_count(); ++i) {
    out.number(mesh.node_tag(i));
    for (std::size_t c = 0; c < 3; ++c) {
      out.text(", ");
      out.number(c < dim ? mesh.coordinates[i * dim + c] : 0.0);
    }
    out.text("\n");
  }
  const Cell& type = cell(mesh.type);
  out.text("*ELEMENT, TYPE=" + std::string(type.abaqus) + "\n");
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    out.number(mesh.element_tag(e));
    for (std::size_t k = 0; k < n; ++k) {
      out.text(", ");
      out.number(mesh.node_tag(mesh.elements[e * n + (type.vtk_order.empty() ? k : type.vtk_order[k])]));
    }
    out.text("\n");
  }
  for (const Group& group : mesh.groups) write_group(out, mesh, group);
  out.commit();
}

}  // namespace kacanov
