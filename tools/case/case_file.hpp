// SPDX-License-Identifier: BSD-3-Clause
// The case file: one JSON object that says what to solve.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <kacanov/mesh.hpp>
#include <kacanov/model.hpp>

namespace kacanov {

/// `mesh.adapt`: where the mesh is refined by what its solution says (theory: bisection).
struct Adaptivity {
  double error = 0.0;  ///< aim: Discretisation::energy
  std::int64_t most_unknowns = 2'000'000;
  int most_meshes = 12;
};

/// Numbers at nodes that the case file only names: temperatures.
struct NodeValueFile {
  std::string path;                 ///< of its key, for messages; the name among Mesh::node_fields
  std::string name;                 ///< relative ones taken from the case file's folder
  std::optional<double> otherwise;  ///< of nodes that are not in it
};

/// Where the mesh comes from: exactly one of file and box is set.
struct MeshSource {
  std::optional<std::string> file;  ///< path, relative ones taken from the case file's folder
  std::string folder = {};          ///< that one; messages show no words of files outside of it
  std::optional<BoxSpec> box;
  std::vector<std::string> coarser = {};  ///< files of the same body to solve on first, coarsest first
  int order = 1;   ///< 2: quadratic elements are made of the file's linear ones; a box has them already
  int refine = 0;  ///< times that the mesh of the file is refined; a box has its cells cut already
  /// What is in the file, where a caller has it in memory: then the file is not opened.
  std::shared_ptr<const std::string> content = {};
  /// Of nodes as they are numbered before the mesh of a file is refined.
  std::vector<NodeValueFile> node_values = {};
  std::optional<Adaptivity> adapt = {};
  /// On the first rank, once it is adapted: the mesh itself.
  std::shared_ptr<const Mesh> adapted = {};
};

/// What colours the picture, and the page to begin with.
enum class Quantity { von_mises, displacement, contact_pressure, plastic };

struct OutputOptions {
  bool fields = true;  ///< `fields`: "vtu" or "none"
  bool steps = true;   ///< fields of the load steps before the last, too
  bool report = true;  ///< pictures
  double scale = 0.0;  ///< of displacements in pictures; 0: chosen so that they can be seen
  Vector3 view{};      ///< from the body to the eye, any length; zero: chosen. 3D only
  Quantity quantity = Quantity::von_mises;
  bool checkpoint = true;
};

/// Where an obstacle is that the case file only names.
struct ObstacleFile {
  std::size_t contact = 0;  ///< index into Model::contact
  std::string path;         ///< of its key, for messages
  std::string name;         ///< relative ones taken from the case file's folder
  std::string group;        ///< of a surface: the physical group; empty: all facets
  /// Of a height map: where its corners lie, and z = offset + scale · value.
  std::array<double, 2> lower{}, upper{};
  double scale = 1.0, offset = 0.0;
};

/// A vector of the case file, whose number of entries can be checked only once the mesh is known.
struct VectorEntry {
  std::string path;
  std::size_t length = 0;   ///< 2 or 3
  bool third_zero = false;  ///< 3 entries, the last 0 or null: fits a plane mesh too
};

struct Case {
  std::string name;  ///< of the file, without folder and extension
  std::string file;  ///< where it was read from; empty: nowhere
  MeshSource mesh;
  Model model;
  OutputOptions output;
  std::vector<ObstacleFile> obstacle_files;
  std::vector<VectorEntry> vectors;
  std::vector<std::string> warnings;
  nlohmann::json document;  ///< what it was read from, --set included
};

/// Makes a Case of a JSON object. `folder` is where relative mesh files are looked for. Throws InputError
/// naming the path of the key that is unknown, missing or wrong, and what was expected there.
Case parse_case(const nlohmann::json& document, const std::string& folder);

/// What a case file says, read once: others who need it are handed the text, as the file may change.
struct CaseText {
  std::string path, text;
};

/// Reads a file or a pipe to its end. Throws InputError naming the file if there is none, if it cannot be
/// read, or if it is larger than 64 MiB.
CaseText read_case_text(const std::string& path);

/// Applies `overrides` ("solver.tolerance=1e-8") to a case and parses it.
Case parse_case(const CaseText& text, std::span<const std::string> overrides);

/// Sets the value at a path in the document: `key.key[index].key=value`, the value being JSON or else a
/// string. Missing objects on the way are made; whether the keys mean anything is for parse_case to say.
void apply_override(nlohmann::json& document, const std::string& assignment);

/// Throws InputError naming the vectors that do not fit a mesh of this dimension.
void check_dimension(const Case& input, int dim);

}  // namespace kacanov
