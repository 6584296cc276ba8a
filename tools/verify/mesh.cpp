// SPDX-License-Identifier: BSD-3-Clause
// Finds the boundary of a mesh, and the parts of it that `on` selects.
#include "verify/mesh.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "verify/finer.hpp"

namespace kacanov::verify {
namespace {

Indices sorted_corners(const Indices& cell, int corners) {
  Indices key(cell.begin(), cell.begin() + corners);
  std::sort(key.begin(), key.end());
  return key;
}

void find_boundary(Mesh& mesh) {
  const std::vector<std::vector<int>> sides = facets(mesh.shape);
  const int corners = corner_count(facet_shape(mesh.shape));
  std::map<Indices, Indices> once;  // facets by their sorted corners
  for (const Indices& element : mesh.elements)
    for (const std::vector<int>& side : sides) {
      Indices facet;
      for (const int place : side) facet.push_back(element[place]);
      const Indices key = sorted_corners(facet, corners);
      if (!once.emplace(key, facet).second) once.erase(key);
    }
  for (auto& [key, facet] : once) mesh.facets.push_back(std::move(facet));
}

const std::string* name_of(const nlohmann::json& on) {
  return on.is_string() ? &on.get_ref<const std::string&>() : nullptr;
}

/// Returns the cells that lie in the closed box with all their nodes.
std::vector<std::size_t> in_box(const Mesh& mesh, const nlohmann::json& on,
                                const std::vector<Indices>& cells) {
  const nlohmann::json& corners = on.at("box");
  const Real slack = 1e-9L * mesh.size();
  const std::size_t dim = mesh.dim();
  const auto inside = [&](Index node) {
    for (std::size_t c = 0; c < dim; ++c) {
      const Real x = mesh.nodes[node][c];
      if (x < corners.at(0).at(c).get<double>() - slack || x > corners.at(1).at(c).get<double>() + slack)
        return false;
    }
    return true;
  };
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (std::all_of(cells[i].begin(), cells[i].end(), inside)) chosen.push_back(i);
  return chosen;
}

}  // namespace

Real Mesh::depth(const Indices& cell, const Functions& at) const {
  if (!is_round) return thickness;
  Real radius = 0;
  for (std::size_t k = 0; k < cell.size(); ++k) radius += at.value[k] * nodes[cell[k]][0];
  return 2 * std::acos(Real(-1)) * radius;
}

Real Mesh::size() const {
  Vec low = nodes.at(0), high = low;
  for (const Vec& x : nodes)
    for (std::size_t c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], x[c]);
      high[c] = std::max(high[c], x[c]);
    }
  return norm(high - low);
}

Mesh load_mesh(const nlohmann::json& source, const std::filesystem::path& folder) {
  Mesh mesh;
  const int refine = source.value("refine", 0), order = source.value("order", 1);
  const bool one = source.contains("file"), read = one || source.contains("files");
  if (source.contains("box")) {
    nlohmann::json box = source.at("box");
    for (auto& cells : box.at("cells")) cells = cells.get<int>() << refine;
    if (order > 1) box["element"] = "tet10";
    mesh = make_box(box);
  } else if (read) {
    // With several files, the last is the mesh; the others only provide initial guesses.
    const std::string file = (one ? source.at("file") : source.at("files").back()).get<std::string>();
    if (file.ends_with(".inp") || file.ends_with(".vtu"))
      throw Failure("mesh.file: the verifier reads Gmsh files: kacanov convert makes one of it");
    mesh = read_gmsh(folder / file);
    for (int time = 0; time < refine; ++time) mesh = halved(mesh);
    if (order > 1 && mesh.shape == Shape::tet4) mesh = raised(mesh);
  } else {
    throw Failure("mesh: the verifier knows `file`, `files` and `box` only");
  }
  find_boundary(mesh);
  return mesh;
}

std::vector<std::size_t> select_facets(const Mesh& mesh, const nlohmann::json& on) {
  const std::string* name = name_of(on);
  if (!name) return in_box(mesh, on, mesh.facets);
  std::vector<std::size_t> chosen(mesh.facets.size());
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  if (*name == "all") return chosen;
  const int corners = corner_count(facet_shape(mesh.shape));
  std::set<Indices> wanted;
  for (const NamedGroup& group : mesh.groups)
    if (group.name == *name && group.dimension == mesh.dim() - 1)
      for (const Indices& cell : group.cells) wanted.insert(sorted_corners(cell, corners));
  std::erase_if(chosen,
                [&](std::size_t f) { return !wanted.contains(sorted_corners(mesh.facets[f], corners)); });
  return chosen;
}

std::vector<std::size_t> select_elements(const Mesh& mesh, const nlohmann::json& on) {
  const std::string* name = name_of(on);
  if (!name) return in_box(mesh, on, mesh.elements);
  std::vector<std::size_t> chosen;
  if (*name == "all") {
    chosen.resize(mesh.elements.size());
    std::iota(chosen.begin(), chosen.end(), std::size_t{0});
    return chosen;
  }
  for (const NamedGroup& group : mesh.groups)
    if (group.name == *name && group.dimension == mesh.dim())
      for (const Indices& cell : group.cells) chosen.push_back(cell[0]);
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  return chosen;
}

Indices nodes_of(const Mesh& mesh, const std::vector<std::size_t>& facets) {
  std::set<Index> nodes;
  for (const std::size_t f : facets) nodes.insert(mesh.facets[f].begin(), mesh.facets[f].end());
  return {nodes.begin(), nodes.end()};
}

Indices select_nodes(const Mesh& mesh, const nlohmann::json& on) {
  Indices nodes = nodes_of(mesh, select_facets(mesh, on));
  const std::string* name = name_of(on);
  if (!name || *name == "all") return nodes;
  std::set<Index> all(nodes.begin(), nodes.end());
  for (const NamedGroup& group : mesh.groups)
    if (group.name == *name && group.dimension < mesh.dim() - 1)
      for (const Indices& cell : group.cells) all.insert(cell.begin(), cell.end());
  return {all.begin(), all.end()};
}

}  // namespace kacanov::verify
