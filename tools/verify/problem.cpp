// SPDX-License-Identifier: BSD-3-Clause
// Reads laws, loads and supports of a case.
#include "verify/problem.hpp"

#include <algorithm>

#include "verify/node_values.hpp"

namespace kacanov::verify {
namespace {

/// Reads plane state and thickness of a 2D mesh.
void read_plane(const nlohmann::json& document, Mesh& mesh) {
  const std::string plane = document.value("plane", "strain");
  if (plane != "strain" && plane != "stress" && plane != "axisymmetric")
    throw Failure("plane: the verifier knows no plane " + plane);
  mesh.is_round = plane == "axisymmetric";
  mesh.is_free_across = plane == "stress";
  mesh.thickness = document.value("thickness", 1.0);
  const Real reach = 1e-12L * mesh.size();
  for (Vec& x : mesh.nodes)
    if (mesh.is_round && std::abs(x[0]) <= reach) x[0] = 0;
}

constexpr std::size_t no_entry = static_cast<std::size_t>(-1);  // for supports on the axis

/// Fixes the radial displacement of nodes on the axis.
void hold_axis(Problem& problem) {
  for (std::size_t n = 0; n < problem.mesh.nodes.size() && problem.mesh.is_round; ++n)
    if (problem.mesh.nodes[n][0] == 0) {
      problem.held[n][0] = true;
      problem.supports[static_cast<Index>(n)].push_back({{1, 0, 0}, no_entry, 0, 0, true});
    }
}

void add_surface_load(Problem& problem, const nlohmann::json& entry, Real factor) {
  const std::vector<std::size_t> facets = select_facets(problem.mesh, entry.at("on"));
  Real area = 0;
  for (const std::size_t f : facets)
    for (const Real share : consistent(problem.mesh, problem.mesh.facets[f]).area) area += share;
  for (const std::size_t f : facets) {
    const Indices& facet = problem.mesh.facets[f];
    const FacetIntegrals integrals = consistent(problem.mesh, facet);
    for (std::size_t k = 0; k < facet.size(); ++k) {
      Vec& load = problem.load[facet[k]];
      if (entry.contains("traction"))
        load = load + factor * integrals.area[k] * read_vector(entry.at("traction"));
      else if (entry.contains("total_force"))
        load = load + factor / area * integrals.area[k] * read_vector(entry.at("total_force"));
      else
        load = load - factor * Real(entry.at("pressure").get<double>()) * integrals.normal[k];
    }
  }
}

/// Derivatives of the position with respect to the reference coordinates; in 2D the third is the unit normal.
std::array<Vec, 3> along_at(const Mesh& mesh, const Indices& element, const Functions& f) {
  const auto dim = static_cast<std::size_t>(mesh.dim());
  std::array<Vec, 3> along{};
  if (dim == 2) along[2] = {0, 0, 1};
  for (std::size_t a = 1; a < f.value.size(); ++a) {
    const Vec side = mesh.nodes[element[a]] - mesh.nodes[element[0]];
    for (std::size_t k = 0; k < dim; ++k) along[k] = along[k] + f.gradient[a][k] * side;
  }
  return along;
}

void add_body_force(Problem& problem, const nlohmann::json& entry, Real factor) {
  const Mesh& mesh = problem.mesh;
  const bool weight = entry.contains("density");
  const Vec force =
      weight ? factor * Real(entry.at("density").get<double>()) * read_vector(entry.at("acceleration"))
             : factor * read_vector(entry.at("body_force"));
  for (const std::size_t e : select_elements(mesh, entry.at("on")))
    for (const QuadraturePoint& point : load_rule(mesh.shape, mesh.is_round)) {
      const Functions f = functions(mesh.shape, point.at);
      const std::array<Vec, 3> along = along_at(mesh, mesh.elements[e], f);
      const Real volume =
          mesh.depth(mesh.elements[e], f) * point.weight * dot(along[0], cross(along[1], along[2]));
      for (std::size_t a = 0; a < f.value.size(); ++a) {
        Vec& load = problem.load[mesh.elements[e][a]];
        load = load + volume * f.value[a] * force;
      }
    }
}

/// Adds springs; elastic foundations use the contact weights (theory: springs).
void add_spring(Problem& problem, const nlohmann::json& entry, std::size_t number) {
  const auto dim = static_cast<std::size_t>(problem.mesh.dim());
  const auto put = [&](Index node, Real weight, const nlohmann::json& stiffness) {
    Spring& spring = problem.each_spring.emplace_back(Spring{node, number, {}});
    for (std::size_t c = 0; c < dim; ++c)
      spring.stiffness[c][c] = weight * Real(stiffness.at(c).get<double>());
  };
  if (entry.contains("node_spring")) {
    for (const Index node : select_nodes(problem.mesh, entry.at("on"))) put(node, 1, entry.at("node_spring"));
    return;
  }
  const nlohmann::json& stiffness = entry.at("spring");
  for (const std::size_t f : select_facets(problem.mesh, entry.at("on"))) {
    const Indices& facet = problem.mesh.facets[f];
    const FacetIntegrals weights = contact_weights(problem.mesh, facet);
    for (std::size_t k = 0; k < facet.size(); ++k) {
      if (stiffness.is_array()) {
        put(facet[k], weights.area[k], stiffness);
        continue;
      }
      const Vec& normal = weights.normal[k];
      if (norm(normal) == 0) continue;
      const Real each = Real(stiffness.get<double>()) * weights.area[k] / dot(normal, normal);
      Spring& spring = problem.each_spring.emplace_back(Spring{facet[k], number, {}});
      for (std::size_t r = 0; r < dim; ++r)
        for (std::size_t c = 0; c < dim; ++c) spring.stiffness[r][c] = each * normal[r] * normal[c];
    }
  }
}

}  // namespace

Real expansion_stress(const Law& law) {
  const Real mu = law.secant(0), lame = law.bulk - 2 * mu / 3;
  return 2 * mu * (3 * lame + 2 * mu) / (lame + 2 * mu);
}

namespace {

/// Temperature rise ΔT at the corners of elements.
class Warmth {
 public:
  Warmth(const Mesh& mesh, const nlohmann::json& given, const std::filesystem::path& folder)
      : mesh_(mesh), given_(given) {
    if (given.is_object() && given.contains("file"))
      nodes_ = read_node_values(folder / given.at("file").get<std::string>(), given, mesh);
  }

  Real at_node(Index node) const {
    if (given_.is_number()) return given_.get<double>();
    if (!nodes_.empty() && std::isnan(nodes_[node]))
      throw Failure("boundary: the file of temperatures does not have node " +
                    std::to_string(mesh_.tags[node]));
    if (!nodes_.empty()) return nodes_[node];
    const Vec from = given_.contains("point") ? read_vector(given_.at("point")) : Vec{};
    return Real(given_.value("value", 0.0)) +
           dot(read_vector(given_.at("gradient")), mesh_.nodes[node] - from);
  }
  /// Interpolates linearly between the element's corners.
  Real at(const Indices& element, const Vec& xi) const {
    const Functions f = functions(corner_shape(mesh_.shape), xi);
    Real sum = 0;
    for (std::size_t a = 0; a < f.value.size(); ++a) sum += f.value[a] * at_node(element[a]);
    return sum;
  }

 private:
  const Mesh& mesh_;
  const nlohmann::json& given_;
  std::vector<Real> nodes_;
};

/// Applies the term −3 k₀ α ΔT div v as a load (theory: expansion); in plane stress E/(1 − ν) α ΔT div v, in
/// addition to the strain itself (theory: expansion-in-plane).
void add_temperature(Problem& problem, const nlohmann::json& document, const nlohmann::json& entry,
                     Real factor, const std::filesystem::path& folder) {
  const Mesh& mesh = problem.mesh;
  const auto dim = static_cast<std::size_t>(mesh.dim());
  const Warmth warmth(mesh, entry.at("temperature"), folder);
  problem.expansion.resize(mesh.elements.size());
  for (const std::size_t e : select_elements(mesh, entry.at("on"))) {
    const Indices& element = mesh.elements[e];
    const std::size_t law = problem.law_of_element[e];
    const Real expansion = factor * Real(document.at("material").at(law).value("expansion", 0.0));
    if (expansion == 0) continue;
    const Real stiffness =
        expansion * (mesh.is_free_across ? expansion_stress(problem.laws[law]) : 3 * problem.laws[law].bulk);
    Real mean = 0, whole = 0;
    for (const QuadraturePoint& point : stiffness_rule(mesh.shape)) {
      const Functions f = functions(mesh.shape, point.at);
      const std::array<Vec, 3> along = along_at(mesh, element, f);
      const Real volume = point.weight * mesh.depth(element, f) * dot(along[0], cross(along[1], along[2]));
      mean += volume * warmth.at(element, point.at);
      whole += volume;
    }
    mean /= whole;
    if (mesh.is_free_across) {
      problem.free_strain.resize(mesh.elements.size());
      problem.free_strain[e] += expansion * mean;
    }
    std::vector<Real>& expansion_of = problem.expansion[e];
    expansion_of.resize(stiffness_rule(mesh.shape).size());
    std::size_t number = 0;
    for (const QuadraturePoint& point : stiffness_rule(mesh.shape)) {
      const Functions f = functions(mesh.shape, point.at);
      const std::array<Vec, 3> along = along_at(mesh, element, f);
      const std::array<Vec, 3> dual{cross(along[1], along[2]), cross(along[2], along[0]),
                                    cross(along[0], along[1])};
      const Real pressure = stiffness * (mesh.shape == Shape::tet10 ? warmth.at(element, point.at) : mean);
      expansion_of[number++] += pressure;
      for (std::size_t a = 0; a < f.value.size(); ++a) {
        Vec& load = problem.load[element[a]];
        for (std::size_t k = 0; k < dim; ++k)
          load = load + mesh.depth(element, f) * point.weight * pressure * f.gradient[a][k] * dual[k];
        // The hoop term u/r has the weight 2π r.
        if (mesh.is_round)
          load[0] += 2 * std::acos(Real(-1)) * point.weight * pressure * f.value[a] * dot(along[0], dual[0]);
      }
    }
  }
}

/// Returns the load factor of an entry, or its load curve at that time: linear between steps, 0 before the
/// first step that names it, and 1 if no step names it (user guide: steps).
Factor factor_at(Real load, const nlohmann::json& document, const std::string& list, std::size_t index) {
  const auto steps = document.value("steps", nlohmann::json::array());
  if (steps.empty()) return {load, std::abs(load)};
  const std::string place = list + "[" + std::to_string(index) + "]";
  const std::string name = document.at(list).at(index).value("name", place);
  const auto names_it = [&](const nlohmann::json& step) {
    return step.at("factors").contains(name) || step.at("factors").contains(place);
  };
  if (std::none_of(steps.begin(), steps.end(), names_it)) return {};
  std::vector<std::pair<Real, Real>> curve{{0, 0}};  // (time, factor)
  Real largest = 0;
  for (const auto& step : steps) {
    const auto before = static_cast<double>(curve.back().second);
    const double factor = step.at("factors").value(name, step.at("factors").value(place, before));
    curve.emplace_back(step.at("time").get<double>(), factor);
    largest = larger(largest, std::abs(Real(factor)));
  }
  for (auto& [time, factor] : curve)
    if (std::abs(factor) < 1e-15L * largest) factor = 0;
  for (std::size_t i = 1; i < curve.size(); ++i) {
    const auto& [since, before] = curve[i - 1];
    const auto& [time, factor] = curve[i];
    if (load <= time) return {before + (load - since) / (time - since) * (factor - before), largest};
  }
  return {curve.back().second, largest};
}

}  // namespace

void add_force(Resultant& sum, const Vec& at, const Vec& force, Real size) {
  sum.force = sum.force + force;
  sum.moment = sum.moment + cross(at, force);
  sum.size += size;
  sum.arms += norm(at) * size;
  if (size > 0) sum.nodes += 1;
}

Vec read_vector(const nlohmann::json& list) {
  Vec v{};
  for (std::size_t c = 0; c < list.size() && c < 3; ++c) v[c] = list.at(c).get<double>();
  return v;
}

Vec normal_at(const Mesh& mesh, const Indices& facet, const Functions& at) {
  Vec along{}, across{};
  for (std::size_t k = 1; k < facet.size(); ++k) {
    const Vec side = mesh.nodes[facet[k]] - mesh.nodes[facet[0]];
    along = along + at.gradient[k][0] * side;
    across = across + at.gradient[k][1] * side;
  }
  return mesh.dim() == 2 ? Vec{along[1], -along[0], 0} : cross(along, across);
}

FacetIntegrals consistent(const Mesh& mesh, const Indices& facet) {
  FacetIntegrals out{std::vector<Real>(facet.size()), std::vector<Vec>(facet.size())};
  const Shape shape = facet_shape(mesh.shape);
  for (const QuadraturePoint& point : load_rule(shape)) {
    const Functions f = functions(shape, point.at);
    const Vec normal = mesh.depth(facet, f) * normal_at(mesh, facet, f);
    for (std::size_t k = 0; k < facet.size(); ++k) {
      out.area[k] += point.weight * f.value[k] * norm(normal);
      out.normal[k] = out.normal[k] + point.weight * f.value[k] * normal;
    }
  }
  return out;
}

Problem read_problem(const nlohmann::json& document, const std::filesystem::path& folder,
                     const LoadPoint& point) {
  Problem problem;
  problem.point = point;
  problem.time = point.load;
  problem.mesh = load_mesh(document.at("mesh"), folder);
  read_plane(document, problem.mesh);
  const std::size_t nodes = problem.mesh.nodes.size();
  problem.law_of_element.assign(problem.mesh.elements.size(), 0);
  problem.load.assign(nodes, {});
  problem.held.assign(nodes, {});
  problem.prescribed.assign(nodes, {});
  for (const auto& entry : document.at("material")) {
    for (const std::size_t e : select_elements(problem.mesh, entry.at("on")))
      problem.law_of_element[e] = problem.laws.size();
    problem.laws.push_back(
        read_law(entry, !problem.mesh.is_free_across &&
                            (problem.mesh.shape == Shape::quad4 || problem.mesh.shape == Shape::hex8)));
  }
  const auto boundary = document.value("boundary", nlohmann::json::array());
  std::vector<Vec> all(nodes);
  for (std::size_t i = 0; i < boundary.size(); ++i) {
    const nlohmann::json& entry = boundary.at(i);
    const Factor whole = factor_at(problem.time, document, "boundary", i);
    const Real factor = whole.value;
    if (entry.contains("displacement") || entry.contains("normal")) hold(problem, entry, i, whole);
    if (entry.contains("spring") || entry.contains("node_spring")) add_spring(problem, entry, i);
    if (entry.contains("temperature")) add_temperature(problem, document, entry, factor, folder);
    if (entry.contains("traction") || entry.contains("total_force") || entry.contains("pressure"))
      add_surface_load(problem, entry, factor);
    if (entry.contains("node_force"))
      for (const Index node : select_nodes(problem.mesh, entry.at("on")))
        problem.load[node] = problem.load[node] + factor * read_vector(entry.at("node_force"));
    if (entry.contains("body_force") || entry.contains("density")) add_body_force(problem, entry, factor);
    Resultant& applied = problem.applied.emplace_back();
    // Between two steps a factor may be a difference of larger ones and has their rounding error.
    const Real terms = factor != 0 ? whole.largest / std::abs(factor) : Real(1);
    for (std::size_t n = 0; n < nodes; ++n) {
      add_force(applied, problem.mesh.nodes[n], problem.load[n], terms * norm(problem.load[n]));
      all[n] = all[n] + problem.load[n];
    }
    problem.load.assign(nodes, {});
  }
  problem.load = all;
  if (!problem.each_spring.empty()) problem.springs.resize(nodes);
  for (const Spring& spring : problem.each_spring)
    for (std::size_t r = 0; r < 3; ++r)
      problem.springs[spring.node][r] = problem.springs[spring.node][r] + spring.stiffness[r];
  hold_axis(problem);
  find_directions(problem);
  const auto contact = document.value("contact", nlohmann::json::array());
  for (std::size_t i = 0; i < contact.size(); ++i)
    problem.contact_factor.push_back(factor_at(problem.time, document, "contact", i).value);
  if (document.contains("solver")) problem.tolerance = document.at("solver").value("tolerance", 1e-6);
  for (const auto& probe : document.value("probe", nlohmann::json::array()))
    problem.probes.push_back(read_vector(probe));
  return problem;
}

}  // namespace kacanov::verify
