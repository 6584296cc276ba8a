// SPDX-License-Identifier: BSD-3-Clause
// kacanov init: writes a starting case for a mesh, with its groups and comments.
#include <algorithm>
#include <filesystem>
#include <iostream>

#include <kacanov/error.hpp>
#include "formats/atomic_file.hpp"
#include "formats/mesh_file.hpp"
#include "formats/printable.hpp"
#include "problem/selection.hpp"
#include "problem/vector3.hpp"
#include "program/case_text.hpp"
#include "program/commands.hpp"

namespace kacanov {
namespace {

/// Returns the name as a JSON string.
std::string shown(const std::string& name) { return nlohmann::json(name).dump(); }

/// Lists the non-empty groups of the given dimensions, for a comment.
std::string list_of(const Mesh& mesh, int lowest, int highest, const std::string& what) {
  std::string text;
  for (const Group& group : mesh.groups)
    if (group.dimension >= lowest && group.dimension <= highest && !group.members.empty())
      text +=
          (text.empty() ? "" : ", ") + shown(group.name) + " (" + std::to_string(group.members.size()) + ")";
  return what + ": " + (text.empty() ? "none has a name" : comment_text(text));
}

/// Returns a vector with one entry per dimension of the mesh.
std::string along(const Mesh& mesh, const char* last) {
  return std::string(mesh.dim() == 3 ? "[0, 0, " : "[0, ") + last + "]";
}

/// Returns selectors of a supported and a loaded side: the first two facet groups, or two ends of the
/// bounding box if there are none.
std::array<std::string, 2> two_sides(const Mesh& mesh) {
  std::vector<std::string> names;
  for (const Group& group : mesh.groups)
    if (group.dimension == mesh.dim() - 1 && !group.members.empty()) names.push_back(shown(group.name));
  const auto [lower, upper, size] = extent(mesh);
  const auto corner = [&](const Vector3& v) {
    nlohmann::json list = nlohmann::json::array();
    for (int c = 0; c < mesh.dim(); ++c) list.push_back(v[static_cast<std::size_t>(c)]);
    return list.dump();
  };
  Vector3 left = upper, right = lower;
  left[0] = lower[0];
  right[0] = upper[0];
  const std::string low = "{\"box\": [" + corner(lower) + ", " + corner(left) + "]}",
                    high = "{\"box\": [" + corner(right) + ", " + corner(upper) + "]}";
  return {names.empty() ? low : names[0], names.size() > 1 ? names[1] : high};
}

std::string case_for(const Mesh& mesh, const std::string& file, const std::string& title) {
  const auto [lower, upper, size] = extent(mesh);
  const auto [held, loaded] = two_sides(mesh);
  const std::string zeros = along(mesh, "0");
  std::string text =
      "// A case to start from, by kacanov init. What stands behind // is left out; every key is in the\n"
      "// user guide, docs/user-guide/case-file.md. kacanov check FILE shows what each entry selects.\n";
  text +=
      "{\n  // \"$schema\": \"case.schema.json\",  // for editors: kacanov schema > case.schema.json\n"
      "  \"title\": " +
      shown(title) + ",\n";
  text += "  // " + std::to_string(mesh.element_count()) + " " + std::string(cell(mesh.type).name) +
          " elements, " + std::to_string(mesh.node_count()) + " nodes, from " + to_text(lower, mesh.dim()) +
          " to " + to_text(upper, mesh.dim()) + "\n";
  text += "  \"mesh\": {\"file\": " + shown(file) +
          (mesh.type == ElementType::tet4 ? ", \"order\": 2},  // order 2: tet10, far better than tet4\n"
                                          : "},\n");
  text += "  // " + list_of(mesh, mesh.dim(), mesh.dim(), "groups of elements, for \"on\"") + "\n";
  text +=
      "  // Units are yours, and have to fit each other: with mm and N, moduli and stresses are in MPa.\n";
  text +=
      "  \"material\": [\n    {\"on\": \"all\", \"young\": 210000, \"poisson\": 0.3\n"
      "     // , \"plastic\": [[235, 0], [360, 0.2]]  // true stress and plastic strain in tension\n    }\n  "
      "],\n";
  text += "  // " + list_of(mesh, mesh.dim() - 1, mesh.dim() - 1, "groups of facets") + "\n";
  text += "  // " + list_of(mesh, 0, mesh.dim() - 2, "groups of nodes") + "\n";
  text += "  \"boundary\": [\n    {\"on\": " + held + ", \"displacement\": " + zeros +
          "},  // null leaves a component free\n    {\"on\": " + loaded +
          ", \"pressure\": 1}\n    // , {\"on\": " + loaded + ", \"total_force\": " + along(mesh, "-1000") +
          "}\n    // , {\"on\": \"all\", \"density\": 7.85e-9, "
          "\"acceleration\": " +
          along(mesh, "-9810") + "}\n  ],\n";
  text += "  // \"contact\": [{\"on\": " + loaded + ", \"obstacle\": {\"plane\": {\"point\": " + zeros +
          ", \"normal\": " + along(mesh, "1") + "}}, \"friction\": {\"coulomb\": 0.2}}],\n";
  text += "  // \"probe\": [" + zeros + "],  // points whose displacement is reported\n";
  text += "  \"solver\": {\"tolerance\": 1e-6}\n}\n";
  return text;
}

}  // namespace

int init_command(const Command& command) {
  const std::filesystem::path from = command.from;
  const std::filesystem::path to = command.to.empty() ? std::filesystem::path(from.stem().string() + ".json")
                                                      : std::filesystem::path(command.to);
  if (to.extension() != ".json") throw InputError(to.string() + ": expected a name that ends with .json");
  if (!is_plain_line(command.from))
    throw InputError(
        command.from +
        ": expected a name in UTF-8 without control characters, as a case cannot hold another one");
  refuse_existing(to.string(), command.force);
  const Mesh mesh = read_mesh(command.from);
  check_mesh(mesh);
  for (const std::string& warning : mesh.warnings)
    std::cerr << "kacanov: warning: " + printable(warning) + "\n";
  // Relative to the folder of the case, as paths in a case are.
  const auto folder = std::filesystem::absolute(to).parent_path();
  const auto relative = std::filesystem::absolute(from).lexically_relative(folder);
  const std::string file = from.is_absolute() || relative.empty() ? from.string() : relative.string();
  write_file(to.string(), case_for(mesh, file, from.stem().string()));
  std::cout << printable(to.string()) +
                   ": a case to start from; kacanov check shows what its entries select\n";
  return exit_converged;
}

}  // namespace kacanov
