// SPDX-License-Identifier: BSD-3-Clause
// The case file: one JSON object that describes the problem to solve.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <kacanov/mesh.hpp>
#include <kacanov/model.hpp>
#include "case/preset.hpp"

namespace kacanov {

/// `mesh.adapt`: adaptive refinement by bisection, driven by an error estimate (theory: bisection).
struct Adaptivity {
  double error = 0.0;  ///< target value of Discretisation::energy
  std::int64_t most_unknowns = 2'000'000;
  int most_meshes = 12;
};

/// Nodal values (temperatures) that the case reads from a file.
struct NodeValueFile {
  std::string path;                 ///< case key, for messages; also the name in Mesh::node_fields
  std::string name;                 ///< file name; relative to the folder of the case file
  std::optional<double> otherwise;  ///< value of nodes that the file does not list
};

/// Source of the mesh: exactly one of `file` and `box` is set.
struct MeshSource {
  std::optional<std::string> file;  ///< path; relative to the folder of the case file
  std::string folder = {};          ///< folder of the case file; messages quote no words of files outside it
  std::optional<BoxSpec> box;
  std::vector<std::string> coarser = {};  ///< coarser meshes to solve on first, coarsest first
  int order = 1;   ///< 2: the linear elements of the file become quadratic; a box is generated with them
  int refine = 0;  ///< number of uniform refinements of the file's mesh; a box already has the finer cells
  /// Content of the mesh file if the caller has it in memory; the file is then not opened.
  std::shared_ptr<const std::string> content = {};
  /// Node numbers refer to the mesh of the file before refinement.
  std::vector<NodeValueFile> node_values = {};
  std::optional<Adaptivity> adapt = {};
  /// The adapted mesh; on the first rank only.
  std::shared_ptr<const Mesh> adapted = {};
};

/// Quantity that colours the picture; also the one that the report page shows first.
enum class Quantity { von_mises, displacement, contact_pressure, plastic };

struct OutputOptions {
  bool fields = true;  ///< `fields`: "vtu" or "none"
  bool steps = true;   ///< also write the fields of intermediate load steps
  bool report = true;  ///< write pictures and the report page
  double scale = 0.0;  ///< displacement scale in pictures; 0: chosen automatically
  Vector3 view{};      ///< from the body to the eye, any length; zero: chosen automatically. 3D only
  Quantity quantity = Quantity::von_mises;
  bool checkpoint = true;
};

/// Obstacle whose geometry the case reads from a file.
struct ObstacleFile {
  std::size_t contact = 0;  ///< index into Model::contact
  std::string path;         ///< path of the case key, for messages
  std::string name;         ///< file name; relative to the folder of the case file
  std::string group;        ///< physical group of a surface; empty: all facets
  /// For a height map: the corners of its rectangle; z = offset + scale · value.
  std::array<double, 2> lower{}, upper{};
  double scale = 1.0, offset = 0.0;
};

/// A vector of the case file; its number of components is checked once the mesh is known.
struct VectorEntry {
  std::string path;
  std::size_t length = 0;   ///< 2 or 3
  bool third_zero = false;  ///< 3 entries, the last 0 or null: valid in 2D too
};

struct Case {
  std::string name;  ///< name of the file without folder and extension
  std::string file;  ///< path of the case file; empty: not read from a file
  MeshSource mesh;
  Model model;
  OutputOptions output;
  ChosenPreset preset;
  std::vector<ObstacleFile> obstacle_files;
  std::vector<VectorEntry> vectors;
  std::vector<std::string> warnings;
  nlohmann::json document;  ///< JSON that the case was parsed from, including --set
};

/// Parses a JSON object. Relative mesh paths start at `folder`. Throws InputError naming the path of the key
/// that is unknown, missing or wrong, and what was expected there.
Case parse_case(const nlohmann::json& document, const std::string& folder);

/// Text of a case file, read once and passed on, because the file may change during the run.
struct CaseText {
  std::string path, text;
};

/// Reads a file or a pipe to its end. Throws InputError naming the file if it does not exist, cannot be read,
/// or is larger than 64 MiB.
CaseText read_case_text(const std::string& path);

/// Applies `overrides` ("solver.tolerance=1e-8") to a case and parses it.
Case parse_case(const CaseText& text, std::span<const std::string> overrides);

/// Sets the value at a path in the document: `key.key[index].key=value`, where the value is JSON or else a
/// string. Creates missing objects on the way; parse_case() checks whether the keys are valid.
void apply_override(nlohmann::json& document, const std::string& assignment);

/// Throws InputError naming the vectors that do not fit a mesh of this dimension.
void check_dimension(const Case& input, int dim);

}  // namespace kacanov
