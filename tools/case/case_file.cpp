// SPDX-License-Identifier: BSD-3-Clause
// Parses a case file, one JSON object, into a Case.
#include "case/case_file.hpp"

#include <algorithm>
#include <filesystem>

#include <kacanov/error.hpp>
#include <kacanov/refine.hpp>
#include "case/case_material.hpp"
#include "case/case_obstacle.hpp"
#include "case/case_schema.hpp"
#include "case/case_words.hpp"
#include "case/json_node.hpp"
#include "formats/text_bytes.hpp"
#include "mesh/classic_locale_stream.hpp"
#include "problem/input_errors.hpp"

namespace kacanov {
namespace {

constexpr int most_cells = 1 << 30;
constexpr std::size_t largest_case = std::size_t{64} << 20;

/// Reads a case that satisfies case_schema(), and records every vector for check_dimension().
class CaseParser {
 public:
  explicit CaseParser(std::string folder) : folder_(std::move(folder)) {}

  Case parse(const nlohmann::json& document) {
    result_.mesh.folder = folder_;
    const Node whole(document, "");
    check(whole, case_schema());
    const Object top(whole);
    parse_mesh(top.required("mesh"));
    if (const auto plane = top.optional("plane")) result_.model.plane = value_of(*plane, words::plane);
    if (const auto thickness = top.optional("thickness")) result_.model.thickness = thickness->number();
    for (const Node& node : top.required("material").entries()) parse_material(node);
    if (const auto list = top.optional("boundary"))
      for (const Node& node : list->entries()) parse_boundary(node);
    if (const auto list = top.optional("contact"))
      for (const Node& node : list->entries()) parse_contact(node);
    if (const auto list = top.optional("steps")) parse_steps(*list);
    if (const auto node = top.optional("solver")) parse_solver(*node);
    if (const auto list = top.optional("probe"))
      for (const Node& node : list->entries()) result_.model.probes.push_back(vector(node));
    if (const auto node = top.optional("output")) parse_output(*node);
    validate_model();
    return std::move(result_);
  }

 private:
  /// Returns the entries of a vector, which is 2 or 3 long, and records it.
  std::vector<Node> vector_entries(const Node& node) {
    std::vector<Node> entries = node.entries();
    const auto is_zero = [](const nlohmann::json& v) {
      return v.is_null() || (v.is_number() && v.get<double>() == 0.0);
    };
    result_.vectors.push_back(
        {node.path(), entries.size(), entries.size() == 3 && is_zero(entries[2].value())});
    return entries;
  }

  Vector3 vector(const Node& node) {
    Vector3 v{};
    const std::vector<Node> entries = vector_entries(node);
    for (std::size_t c = 0; c < entries.size(); ++c) v[c] = entries[c].number();
    return v;
  }

  /// Returns the path, with relative ones starting at the folder of the case file.
  std::string in_folder(const std::string& name) const {
    const std::filesystem::path file = name;
    return file.is_absolute() ? file.string() : (std::filesystem::path(folder_) / file).string();
  }

  Selector selector(const Node& node) {
    Selector on;
    if (node.value().is_string()) {
      on.name = node.text();
      on.kind = on.name == "all" ? Selector::Kind::all : Selector::Kind::name;
      return on;
    }
    const Node box = Object(node).required("box");
    const std::vector<Node> corners = box.entries();
    on.kind = Selector::Kind::box;
    on.lower = vector(corners[0]);
    on.upper = vector(corners[1]);
    if (corners[0].value().size() != corners[1].value().size()) box.expected("two corners of equal length");
    return on;
  }

  void parse_adapt(const Node& node) {
    const Object object(node);
    Adaptivity& adapt = result_.mesh.adapt.emplace();
    adapt.error = object.required("error").number();
    if (const auto most = object.optional("most_unknowns")) adapt.most_unknowns = most->integer(1);
    if (const auto most = object.optional("most_meshes")) adapt.most_meshes = most->integer(1);
  }

  void parse_mesh(const Node& node) {
    const Object object(node);
    if (const auto adapt = object.optional("adapt")) parse_adapt(*adapt);
    if (const auto order = object.optional("order")) result_.mesh.order = order->integer(1);
    if (const auto times = object.optional("refine")) result_.mesh.refine = times->integer(0);
    if (const auto file = object.optional("file")) {
      result_.mesh.file = in_folder(file->text());
      return;
    }
    if (const auto files = object.optional("files")) {
      for (const Node& file : files->entries()) result_.mesh.coarser.push_back(in_folder(file.text()));
      result_.mesh.file = result_.mesh.coarser.back();
      result_.mesh.coarser.pop_back();
      if (result_.mesh.adapt)
        object.required("adapt").expected(
            "no \"files\" beside it: the meshes that are made take their place");
      return;
    }
    const Object box(object.required("box"));
    const std::vector<Node> size = box.required("size").entries();
    const std::vector<Node> cells = box.required("cells").entries();
    BoxSpec spec;
    spec.type = size.size() == 2 ? ElementType::tri3 : ElementType::tet4;
    if (const auto element = box.optional("element")) spec.type = *element_type(element->text());
    if (result_.mesh.order > cell(spec.type).order) spec.type = raised(spec.type);
    const std::size_t dim = dimension(spec.type);
    const std::string count = std::to_string(dim) + " entries (one a dimension)";
    if (size.size() != dim) box.required("size").expected(count);
    if (cells.size() != dim) box.required("cells").expected(count);
    for (std::size_t c = 0; c < dim; ++c) {
      spec.size[c] = size[c].number();
      spec.cells[c] = cells[c].integer(1);
    }
    for (; result_.mesh.refine > 0; --result_.mesh.refine)
      for (std::size_t c = 0; c < dim; ++c) {
        if (spec.cells[c] > most_cells / 2)
          cells[c].expected("at most " + std::to_string(most_cells) + " cells once mesh.refine has cut them");
        spec.cells[c] *= 2;
      }
    result_.mesh.box = spec;
  }

  void parse_material(const Node& node) {
    const Object object(node);
    MaterialEntry entry;
    entry.on = selector(object.required("on"));
    entry.law = parse_material_law(object, result_.warnings);
    if (const auto bbar = object.optional("bbar")) entry.bbar = bbar->boolean();
    if (const auto word = object.optional("formulation"))
      entry.formulation = word->text() == "mixed" ? MaterialEntry::Formulation::mixed
                                                  : MaterialEntry::Formulation::displacement;
    if (const auto expansion = object.optional("expansion")) entry.expansion = expansion->number();
    result_.model.materials.push_back(entry);
  }

  Temperature temperature(const Node& node) {
    if (node.value().is_number()) return node.number();
    const Object object(node);
    Temperature rise;
    if (const auto file = object.optional("file")) {
      NodeValueFile values{node.path(), in_folder(file->text()), {}};
      if (const auto rest = object.optional("otherwise")) values.otherwise = rest->number();
      result_.mesh.node_values.push_back(values);
      rise.nodes = node.path();
      return rise;
    }
    rise.gradient = vector(object.required("gradient"));
    if (const auto value = object.optional("value")) rise.value = value->number();
    if (const auto point = object.optional("point")) rise.point = vector(*point);
    return rise;
  }

  void parse_boundary(const Node& node) {
    const Object object(node);
    BoundaryEntry entry;
    entry.on = selector(object.required("on"));
    if (const auto name = object.optional("name")) entry.name = name->text();
    const auto take_vector = [&](const char* key, std::optional<Vector3>& into) {
      if (const auto value = object.optional(key)) into = vector(*value);
    };
    const auto take_number = [&](const char* key, std::optional<double>& into) {
      if (const auto value = object.optional(key)) into = value->number();
    };
    take_vector("traction", entry.traction);
    take_vector("total_force", entry.total_force);
    take_vector("body_force", entry.body_force);
    take_vector("node_spring", entry.node_spring);
    take_vector("node_force", entry.node_force);
    take_number("pressure", entry.pressure);
    take_number("normal", entry.normal);
    if (const auto value = object.optional("temperature")) entry.temperature = temperature(*value);
    if (const auto value = object.optional("displacement")) {
      entry.displacement.emplace();
      const std::vector<Node> entries = vector_entries(*value);
      for (std::size_t c = 0; c < entries.size(); ++c)
        if (!entries[c].value().is_null()) (*entry.displacement)[c] = entries[c].number();
    }
    if (const auto spring = object.optional("spring"); spring && spring->value().is_number())
      entry.normal_spring = spring->number();
    else
      take_vector("spring", entry.spring);
    if (const auto density = object.optional("density")) {
      Vector3 force = vector(object.required("acceleration"));
      for (double& component : force) component *= density->number();
      entry.body_force = force;
    }
    if (const auto frame = object.optional("frame"))
      entry.frame = parse_axes(*frame, [this](const Node& v) { return vector(v); });
    result_.model.boundary.push_back(entry);
  }

  void parse_contact(const Node& node) {
    const Object object(node);
    ContactEntry entry;
    entry.on = selector(object.required("on"));
    if (const auto name = object.optional("name")) entry.name = name->text();
    std::optional<ObstacleFile> file;
    const ReadVector read = [this](const Node& v) { return vector(v); };
    entry.obstacle = parse_obstacle(object.required("obstacle"), read, file);
    if (file) {
      file->contact = result_.model.contact.size();
      file->name = in_folder(file->name);
      result_.obstacle_files.push_back(*file);
    }
    if (const auto motion = object.optional("motion")) entry.motion = parse_motion(*motion, read);
    if (const auto anew = object.optional("relinearise")) entry.relinearise = anew->boolean();
    if (const auto force = object.optional("force_controlled"))
      entry.force_controlled = parse_force_control(*force, read);
    if (const auto friction = object.optional("friction")) {
      const Object parts(*friction);
      entry.friction.emplace();
      if (const auto bound = parts.optional("tresca")) entry.friction->tresca = bound->number();
      if (const auto bound = parts.optional("coulomb")) entry.friction->coulomb = bound->number();
      if (const auto from = parts.optional("reference"))
        entry.friction->reference = value_of(*from, words::reference);
    }
    result_.model.contact.push_back(entry);
  }

  void parse_steps(const Node& node) {
    for (const Node& step : node.entries()) {
      const Object object(step);
      LoadStage stage;
      stage.time = object.required("time").number();
      const Node factors = object.required("factors");
      for (const auto& [name, value] : factors.value().items())
        stage.factors[name] = Node(value, factors.path() + "[\"" + name + "\"]").number();
      result_.model.steps.push_back(std::move(stage));
    }
  }

  /// A refusal of solver keys also says which of them a preset has set.
  void validate_model() const {
    try {
      validate(result_.model);
    } catch (const InputError& error) {
      const std::string text = error.what();
      if (result_.preset.values.empty() || text.find("solver.") == std::string::npos) throw;
      throw InputError(text + "; solver.preset is " + result_.preset.text());
    }
  }

  void parse_solver(const Node& node) {
    const nlohmann::json values = with_preset(node.value(), result_.preset);
    const Object object(Node(values, node.path()));
    SolverOptions& options = result_.model.solver;
    if (const auto v = object.optional("tolerance")) options.tolerance = v->number();
    if (const auto v = object.optional("spectrum_tolerance")) options.spectrum_tolerance = v->number();
    if (const auto v = object.optional("outer")) options.outer = value_of(*v, words::outer);
    if (const auto v = object.optional("contact")) options.contact = value_of(*v, words::contact);
    if (const auto v = object.optional("stop")) options.stop = value_of(*v, words::stop);
    if (const auto v = object.optional("r")) parse_penalty(*v);
    if (const auto v = object.optional("first_r")) {
      if (!adapts(options.penalty)) v->expected("no first_r with an r that does not change");
      options.r = v->number();
    }
    if (const auto v = object.optional("preconditioner"))
      options.preconditioner = value_of(*v, words::preconditioner);
    if (const auto v = object.optional("coarse_amg")) options.coarse_amg = v->integer(0);
    if (const auto v = object.optional("max_outer")) options.max_outer = v->integer(1);
    if (const auto v = object.optional("max_contact")) options.max_contact = v->integer(1);
    if (const auto v = object.optional("max_cg")) options.max_cg = v->integer(1);
    if (const auto v = object.optional("load_steps")) parse_load_steps(*v);
    if (const auto v = object.optional("nested")) options.nested = v->boolean();
    if (const auto v = object.optional("relaxation")) options.relaxation = v->number();
  }

  void parse_load_steps(const Node& node) {
    std::vector<double>& factors = result_.model.solver.load_steps;
    if (node.value().is_array()) {
      for (const Node& factor : node.entries()) factors.push_back(factor.number());
      return;
    }
    const int steps = node.integer(1);
    for (int i = 1; i <= steps; ++i) factors.push_back(static_cast<double>(i) / steps);
  }

  void parse_penalty(const Node& node) {
    SolverOptions& options = result_.model.solver;
    if (node.value().is_number()) {
      options.penalty = SolverOptions::Penalty::fixed;
      options.r = node.number();
    } else {
      options.penalty = value_of(node, words::penalty);
    }
  }

  void parse_output(const Node& node) {
    const Object object(node);
    if (const auto v = object.optional("fields")) result_.output.fields = value_of(*v, words::fields);
    if (const auto v = object.optional("steps")) result_.output.steps = v->boolean();
    if (const auto v = object.optional("report")) result_.output.report = v->boolean();
    if (const auto v = object.optional("scale")) result_.output.scale = v->number();
    if (const auto v = object.optional("view")) {
      result_.output.view = vector(*v);
      if (result_.output.view == Vector3{}) v->expected("a direction that is not zero");
    }
    if (const auto v = object.optional("quantity")) result_.output.quantity = value_of(*v, words::quantity);
    if (const auto v = object.optional("checkpoint")) result_.output.checkpoint = v->boolean();
  }

  std::string folder_;
  Case result_;
};

}  // namespace

Case parse_case(const nlohmann::json& document, const std::string& folder) {
  return CaseParser(folder).parse(document);
}

CaseText read_case_text(const std::string& path) {
  if (std::filesystem::is_directory(path))
    throw InputError(path + ": this is a folder, expected a case file");
  PlainFile stream(path, std::ios::binary);
  if (!stream) {
    throw InputError(path + ": " +
                     (std::filesystem::exists(path) ? "cannot be read" : "there is no such file"));
  }
  // A pipe has no size that could be queried, so count the text while it is read.
  CaseText read{path, {}};
  for (std::string piece(std::size_t{1} << 16, '\0'); stream;) {
    stream.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    read.text.append(piece, 0, stream.gcount());
    if (read.text.size() > largest_case)
      throw InputError(path +
                       ": this is larger than 64 MiB, which no case is; meshes have files of their own");
  }
  if (stream.bad()) throw InputError(path + ": cannot be read to its end");
  return read;
}

Case parse_case(const CaseText& text, std::span<const std::string> overrides) {
  std::string_view start = text_start(text.path, text.text);
  start.remove_prefix(std::min(start.find_first_not_of(" \t\r\n"), start.size()));
  if (start.starts_with('*'))
    throw InputError(text.path + ": this is a deck, expected a case; kacanov convert makes one of it");
  if (start.starts_with("$MeshFormat"))
    throw InputError(text.path + ": this is a mesh, expected a case; kacanov init writes one for it");
  if (text.path.ends_with(".geo"))
    throw InputError(text.path +
                     ": this is a geometry, expected a case: gmsh -3 makes a mesh of it (-2 in the plane), "
                     "and kacanov init a case for the mesh");
  nlohmann::json document = parse_json(text.text, text.path);
  for (const std::string& assignment : overrides) apply_override(document, assignment);
  const std::filesystem::path file(text.path);
  Case input;
  naming_file(text.path, [&] { input = parse_case(document, file.parent_path().string()); });
  input.file = text.path;
  input.name = file.stem().string();
  // Results go into a folder of this name; ".." would be the parent folder (file name "...json").
  if (input.name.empty() || input.name == "." || input.name == "..") input.name = "case";
  input.document = std::move(document);
  return input;
}

void check_dimension(const Case& input, int dim) {
  Mistakes mistakes;
  for (const VectorEntry& vector : input.vectors) {
    if (vector.length == static_cast<std::size_t>(dim) || (dim == 2 && vector.third_zero)) continue;
    mistakes.note(vector.path + ": expected " + std::to_string(dim) + " entries, as the mesh has " +
                  std::to_string(dim) + " dimensions, got " + std::to_string(vector.length));
  }
  mistakes.raise();
}

}  // namespace kacanov
