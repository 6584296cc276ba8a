// SPDX-License-Identifier: BSD-3-Clause
// Element types of Abaqus and CalculiX: the cell of each, and remarks about differences.
#include "formats/deck_elements.hpp"

#include <algorithm>
#include <array>

#include <kacanov/cells.hpp>

namespace kacanov {
namespace {

struct Entry {
  std::string_view name;
  DeckElementType type;
};

constexpr std::string_view hybrid = "pressure has no unknowns of its own here";
constexpr std::string_view modified = "the plain quadratic tetrahedron is taken in its place";
constexpr std::string_view reduced = "all points are integrated here, with B-bar where the body is plastic";
constexpr std::string_view incompatible = "there are no incompatible modes here: stiffer in bending";
constexpr std::string_view all_points = "all points are integrated here";
constexpr PlaneState stress = PlaneState::stress, axes = PlaneState::axisymmetric;
constexpr std::string_view thin = "shells, membranes and beams are not solved: model the body in 3D";
constexpr std::string_view tri6 = "quadratic triangles are no bodies here: write linear ones";

constexpr auto entries = std::to_array<Entry>({
    {"C3D4", {"tet4", "", ""}},
    {"C3D4H", {"tet4", hybrid, ""}},
    {"C3D10", {"tet10", "", ""}},
    {"C3D10H", {"tet10", hybrid, ""}},
    {"C3D10HS", {"tet10", modified, ""}},
    {"C3D10I", {"tet10", modified, ""}},
    {"C3D10M", {"tet10", modified, ""}},
    {"C3D10MH", {"tet10", modified, ""}},
    {"C3D10T", {"tet10", modified, ""}},
    {"C3D8", {"hex8", "", ""}},
    {"C3D8H", {"hex8", hybrid, ""}},
    {"C3D8I", {"hex8", incompatible, ""}},
    {"C3D8IH", {"hex8", incompatible, ""}},
    {"C3D8R", {"hex8", reduced, ""}},
    {"C3D8RH", {"hex8", reduced, ""}},
    {"CPE3", {"tri3", "", ""}},
    {"CPE3H", {"tri3", hybrid, ""}},
    {"CPE4", {"quad4", "", ""}},
    {"CPE4H", {"quad4", hybrid, ""}},
    {"CPE4I", {"quad4", incompatible, ""}},
    {"CPE4IH", {"quad4", incompatible, ""}},
    {"CPE4R", {"quad4", reduced, ""}},
    {"CPE4RH", {"quad4", reduced, ""}},
    // Types that mesh generators write for the facets of a body, and types that bodies cannot consist of.
    {"CPE6", {"tri6", "", tri6}},
    {"CPS3", {"tri3", "", "", stress}},
    {"CPS4", {"quad4", "", "", stress}},
    {"CPS4R", {"quad4", all_points, "", stress}},
    {"CPS4I", {"quad4", incompatible, "", stress}},
    {"CPS6", {"tri6", "", tri6}},
    {"CAX3", {"tri3", "", "", axes}},
    {"CAX3H", {"tri3", hybrid, "", axes}},
    {"CAX4", {"quad4", "", "", axes}},
    {"CAX4H", {"quad4", hybrid, "", axes}},
    {"CAX4I", {"quad4", incompatible, "", axes}},
    {"CAX4R", {"quad4", reduced, "", axes}},
    {"CAX6", {"tri6", "", tri6}},
    {"DS3", {"tri3", "", thin}},
    {"DS4", {"quad4", "", thin}},
    {"M3D3", {"tri3", "", thin}},
    {"M3D4", {"quad4", "", thin}},
    {"M3D4R", {"quad4", "", thin}},
    {"M3D6", {"tri6", "", thin}},
    {"R3D3", {"tri3", "", thin}},
    {"R3D4", {"quad4", "", thin}},
    {"S3", {"tri3", "", thin}},
    {"S3R", {"tri3", "", thin}},
    {"S4", {"quad4", "", thin}},
    {"S4R", {"quad4", "", thin}},
    {"S6", {"tri6", "", thin}},
    {"SFM3D3", {"tri3", "", thin}},
    {"SFM3D4", {"quad4", "", thin}},
    {"STRI3", {"tri3", "", thin}},
    {"STRI65", {"tri6", "", thin}},
    {"B21", {"line2", "", thin}},
    {"B31", {"line2", "", thin}},
    {"B32", {"line3", "", thin}},
    {"T2D2", {"line2", "", thin}},
    {"T2D3", {"line3", "", thin}},
    {"T3D2", {"line2", "", thin}},
    {"T3D3", {"line3", "", thin}},
});

using Corners = std::array<std::int8_t, 4>;

/// Faces of each element as in Abaqus' manual, by corner; −1 pads shorter ones.
constexpr std::array<Corners, 3> triangle{{{0, 1, -1, -1}, {1, 2, -1, -1}, {2, 0, -1, -1}}};
constexpr std::array<Corners, 4> quadrilateral{
    {{0, 1, -1, -1}, {1, 2, -1, -1}, {2, 3, -1, -1}, {3, 0, -1, -1}}};
constexpr std::array<Corners, 4> tetrahedron{{{0, 1, 2, -1}, {0, 3, 1, -1}, {1, 3, 2, -1}, {2, 3, 0, -1}}};
constexpr std::array<Corners, 6> hexahedron{
    {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1}, {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}}};

std::span<const Corners> sides_of(const Cell& cell) {
  if (!element_type(cell)) return {};
  if (cell.dim == 2) return cell.simplex ? std::span<const Corners>(triangle) : quadrilateral;
  return cell.simplex ? std::span<const Corners>(tetrahedron) : hexahedron;
}

}  // namespace

std::optional<DeckElementType> deck_element_type(std::string_view type) {
  const auto found =
      std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return e.name == type; });
  return found == entries.end() ? std::nullopt : std::optional(found->type);
}

std::string_view why_not_known(std::string_view type) {
  if (type.starts_with("C3D20") || type.starts_with("C3D27"))
    return "there are no quadratic hexahedra here: mesh the body with C3D10 or C3D8";
  if (type.starts_with("C3D"))
    return "there are no wedges or pyramids here: mesh the body with C3D10 or C3D8";
  if (type.starts_with("CPE")) return "mesh the body with CPE3 or CPE4";
  if (type.starts_with("CPS")) return "mesh the body with CPS3 or CPS4";
  if (type.starts_with("CAX")) return "mesh the body with CAX3 or CAX4";
  if (type.starts_with("S") || type.starts_with("B") || type.starts_with("M3D")) return thin;
  return "bodies are made of C3D4, C3D10, C3D8, CPE3, CPE4, CPS3, CPS4, CAX3 or CAX4";
}

std::size_t deck_sides(std::size_t cell) { return sides_of(cells()[cell]).size(); }

std::span<const std::int8_t> deck_side(std::size_t place, std::size_t side) {
  const Cell& cell = cells()[place];
  const auto sides = sides_of(cell);
  if (side >= sides.size()) return {};
  const std::size_t nodes = cell.facet().nodes, corners = cell.facet().corners;
  for (std::size_t f = 0; f < cell.facet_nodes.size(); f += nodes) {
    const auto facet = cell.facet_nodes.subspan(f, nodes);
    if (std::is_permutation(facet.begin(), facet.begin() + static_cast<std::ptrdiff_t>(corners),
                            sides[side].begin(), sides[side].begin() + static_cast<std::ptrdiff_t>(corners)))
      return facet;
  }
  return {};
}

}  // namespace kacanov
