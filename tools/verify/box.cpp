// SPDX-License-Identifier: BSD-3-Clause
// Generates boxes: nodes on a lattice, x fastest, and cells split as the user guide describes.
#include <algorithm>

#include "verify/mesh.hpp"

namespace kacanov::verify {
namespace {

using Triple = std::array<int, 3>;

Shape shape_of(const nlohmann::json& box) {
  const std::string name = box.value("element", box.at("size").size() == 2 ? "tri3" : "tet4");
  static const std::pair<const char*, Shape> names[] = {{"tri3", Shape::tri3},
                                                        {"quad4", Shape::quad4},
                                                        {"tet4", Shape::tet4},
                                                        {"tet10", Shape::tet10},
                                                        {"hex8", Shape::hex8}};
  for (const auto& [known, shape] : names)
    if (name == known) return shape;
  throw Failure("mesh.box.element: the verifier knows no " + name);
}

/// Corners of the elements in the unit cell.
std::vector<std::vector<Triple>> elements_of_cell(Shape shape) {
  const std::vector<Triple> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  if (shape == Shape::quad4) return {square};
  if (shape == Shape::tri3) return {{square[0], square[1], square[2]}, {square[0], square[2], square[3]}};
  if (shape == Shape::hex8) {
    std::vector<Triple> cube = square;
    for (Triple corner : square) cube.push_back({corner[0], corner[1], 1});
    return {cube};
  }
  // Six tetrahedra around the diagonal: one per permutation of the axes.
  std::vector<std::vector<Triple>> six;
  Triple axes{0, 1, 2};
  do {
    std::vector<Triple> corners{{0, 0, 0}};
    for (const int axis : axes) {
      corners.push_back(corners.back());
      ++corners.back()[axis];
    }
    const bool odd = (axes[0] > axes[1]) != ((axes[0] > axes[2]) != (axes[1] > axes[2]));
    if (odd) std::swap(corners[2], corners[3]);
    six.push_back(corners);
  } while (std::next_permutation(axes.begin(), axes.end()));
  return six;
}

void add_middles(Shape shape, std::vector<Triple>& corners) {
  if (shape != Shape::tet10) return;
  constexpr std::array<std::pair<int, int>, 6> edges{{{0, 1}, {1, 2}, {2, 0}, {3, 0}, {3, 2}, {3, 1}}};
  for (const auto& [a, b] : edges) {
    const Triple &p = corners[a], &q = corners[b];
    corners.push_back({(p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2});
  }
}

}  // namespace

Mesh make_box(const nlohmann::json& box) {
  Mesh mesh;
  mesh.shape = shape_of(box);
  const auto dim = static_cast<std::size_t>(mesh.dim());
  const int step = mesh.shape == Shape::tet10 ? 2 : 1;
  Triple cells{1, 1, 0}, points{1, 1, 1};
  std::array<double, 3> size{};
  for (std::size_t c = 0; c < dim; ++c) {
    cells[c] = box.at("cells").at(c);
    points[c] = step * cells[c] + 1;
    size[c] = box.at("size").at(c).get<double>();
  }
  const auto number = [&](const Triple& at) {
    return static_cast<Index>(at[0] + points[0] * (at[1] + points[1] * at[2]));
  };
  for (int z = 0; z < points[2]; ++z)
    for (int y = 0; y < points[1]; ++y)
      for (int x = 0; x < points[0]; ++x) {
        const Triple at{x, y, z};
        Vec node{};
        // Rounded to double as in the program.
        for (std::size_t c = 0; c < dim; ++c)
          node[c] = static_cast<double>(Real(size[c]) * at[c] / (points[c] - 1));
        mesh.nodes.push_back(node);
        mesh.tags.push_back(static_cast<std::int64_t>(mesh.nodes.size()));
      }
  for (int z = 0; z < std::max(cells[2], 1); ++z)
    for (int y = 0; y < cells[1]; ++y)
      for (int x = 0; x < cells[0]; ++x)
        for (std::vector<Triple> corners : elements_of_cell(mesh.shape)) {
          for (Triple& corner : corners)
            corner = {step * (x + corner[0]), step * (y + corner[1]), step * (z + corner[2])};
          add_middles(mesh.shape, corners);
          Indices& element = mesh.elements.emplace_back();
          for (const Triple& corner : corners) element.push_back(number(corner));
        }
  const char* names[3][2] = {{"left", "right"}, {"front", "back"}, {"bottom", "top"}};
  const int corners = corner_count(facet_shape(mesh.shape));
  for (std::size_t c = 0; c < dim; ++c)
    for (const bool end : {false, true}) {
      NamedGroup side{names[dim == 2 && c == 1 ? 2 : c][end ? 1 : 0], mesh.dim() - 1, {}};
      const Real plane = end ? Real(size[c]) : Real(0);
      for (const Indices& element : mesh.elements)
        for (const std::vector<int>& facet : facets(mesh.shape)) {
          Indices nodes;
          for (const int place : facet) nodes.push_back(element[place]);
          if (std::all_of(nodes.begin(), nodes.begin() + corners,
                          [&](Index n) { return mesh.nodes[n][c] == plane; }))
            side.cells.push_back(std::move(nodes));
        }
      mesh.groups.push_back(std::move(side));
    }
  return mesh;
}

}  // namespace kacanov::verify
