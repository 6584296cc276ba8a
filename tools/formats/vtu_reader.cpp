// SPDX-License-Identifier: BSD-3-Clause
// Reads the mesh of a VTK file: its grid, and the numbers and groups stored in arrays.
#include "formats/vtu_reader.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "formats/mesh_maker.hpp"
#include "formats/node_index.hpp"
#include "formats/vtu_arrays.hpp"

namespace kacanov {
namespace {

/// Returns the numbers of points or cells; 1, 2, ... if the file has none.
std::vector<std::int64_t> numbers(const VtuFile& file, const char* section, const char* name,
                                  std::size_t count) {
  std::vector<std::int64_t> tags(count);
  for (std::size_t i = 0; i < count; ++i) tags[i] = static_cast<std::int64_t>(i) + 1;
  if (!file.has(section, name)) return tags;
  tags = file.integers(section, name, count);
  if (std::any_of(tags.begin(), tags.end(), [](std::int64_t tag) { return tag <= 0; }))
    file.fail(std::string("the array ") + name + ": expected positive numbers");
  if (const auto twice = NodeIndex().assign(tags))
    file.fail(std::string("the array ") + name + ": the number " + std::to_string(*twice) +
              " is there twice");
  return tags;
}

std::size_t cell_of(const VtuFile& file, std::int64_t type, std::size_t number) {
  for (std::size_t c = 0; c < cells().size(); ++c)
    if (cells()[c].vtk == type) return c;
  file.fail("cell " + std::to_string(number) + " is of VTK's type " + std::to_string(type) +
            ", which is not supported: bodies are made of " +
            element_names([](const Cell& c) { return element_type(c).has_value(); }));
}

}  // namespace

Mesh read_vtu(const SourceFile& name, std::string_view bytes) {
  const VtuFile file(name, bytes);
  const std::size_t points = file.points(), count = file.cells();
  if (points == 0 || count == 0) file.fail("expected points and cells, the grid has none");
  MeshContent content;
  content.coordinates = file.reals("Points", "Points", 3 * points);
  for (const double x : content.coordinates)
    if (!std::isfinite(x)) file.fail("expected points with finite coordinates");
  content.node_tags = numbers(file, "PointData", "node_id", points);
  const std::vector<std::int64_t> tags = numbers(file, "CellData", "element_id", count),
                                  types = file.integers("Cells", "types", count),
                                  offsets = file.integers("Cells", "offsets", count);
  std::vector<std::int64_t> groups(count, 0);
  if (file.has("CellData", "gmsh:physical")) groups = file.integers("CellData", "gmsh:physical", count);
  std::int64_t before = 0;
  for (std::size_t c = 0; c < count; ++c) {
    if (offsets[c] - before != cells()[cell_of(file, types[c], c + 1)].nodes)
      file.fail("the array offsets: cell " + std::to_string(c + 1) + " has not as many points as its type");
    before = offsets[c];
  }
  const std::vector<std::int64_t> connectivity =
      file.integers("Cells", "connectivity", static_cast<std::size_t>(before));
  std::map<std::int64_t, std::size_t> sets{{0, 0}};
  auto next = connectivity.begin();
  for (std::size_t c = 0; c < count; ++c) {
    const std::size_t place = cell_of(file, types[c], c + 1);
    const Cell& cell = cells()[place];
    ElementList& list = content.elements[place];
    const std::size_t first = list.nodes.size(), nodes = cell.nodes;
    list.nodes.resize(first + nodes);
    for (std::size_t k = 0; k < nodes; ++k, ++next) {
      if (*next < 0 || *next >= static_cast<std::int64_t>(points))
        file.fail("cell " + std::to_string(c + 1) + " refers to point " + std::to_string(*next) +
                  ", of which there are " + std::to_string(points));
      list.nodes[first + (cell.vtk_order.empty() ? k : cell.vtk_order[k])] = static_cast<std::int32_t>(*next);
    }
    list.tags.push_back(tags[c]);
    const std::int64_t group = groups[c];
    if (group < 0 || group > 1000000000) file.fail("the array gmsh:physical: expected numbers from 0 to 1e9");
    const auto [set, added] = sets.emplace(group, content.physicals.size());
    if (added) content.physicals.push_back({static_cast<int>(group)});
    list.assign_last(set->second);
  }
  return make_mesh(name.path, std::move(content));
}

}  // namespace kacanov
