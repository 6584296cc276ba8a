// SPDX-License-Identifier: BSD-3-Clause
// Warnings about input and results that can be computed but look mistaken, before and after the solve.
#include <kacanov/validity.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "mesh/classic_locale_stream.hpp"
#include "operator/element_maps.hpp"
#include "problem/conditions.hpp"
#include "problem/integration.hpp"
#include "problem/selection.hpp"
#include "problem/vector3.hpp"
#include "problem/warnings.hpp"

namespace kacanov::validity {

void no_load(const Problem& problem, const Model& model, Warnings& warnings) {
  if (any_moves(model)) return;
  const auto is_zero = [](double value) { return value == 0.0; };
  if (!std::all_of(problem.load.begin(), problem.load.end(), is_zero)) return;
  if (!std::all_of(problem.forces.begin(), problem.forces.end(),
                   [&](const EntryForce& force) { return is_zero(force.value); }))
    return;
  if (!std::all_of(problem.prescribed.begin(), problem.prescribed.end(), is_zero)) return;
  if (std::any_of(problem.directions.begin(), problem.directions.end(),
                  [](const HeldDirection& held) { return held.value != 0.0; }))
    return;
  if (std::any_of(problem.contact.begin(), problem.contact.end(),
                  [](const ContactPoint& point) { return point.gap < 0.0; }))
    return;
  warnings.push_back(
      "nothing acts on the body: there is no load, no prescribed displacement other than zero and no "
      "obstacle "
      "that presses in");
}

}  // namespace kacanov::validity

namespace kacanov::validity {
namespace {

// Metals and polymers yield at strains of 1e-4 to 0.1. A factor of 1000, as between MPa and GPa or Pa and
// kPa, leads out of this range.
constexpr double least_yield_strain = 1e-5, most_yield_strain = 0.3;
// Relative to Young's modulus: a larger load crushes any body, a smaller one is a millionth of a load that
// has a visible effect.
constexpr double least_load = 1e-9, most_load = 0.1;
// Relative to the yield stress: detects kN given for N, for loads of at least 2 % of it.
constexpr double most_over_yield = 20.0;

/// Yield stress in tension.
double yield_stress(const Law& law) {
  const double x = law.proof_strain();
  return std::sqrt(1.5) * 2.0 * law.secant(x) * x;
}

void check_material(const Law& law, const std::string& path, Warnings& warnings) {
  if (law.linear() || !std::isfinite(law.proof_strain())) return;
  const double strain = yield_stress(law) / young_modulus(law);
  if (strain >= least_yield_strain && strain <= most_yield_strain) return;
  warnings.push_back(path + ": it yields at a stress of " + rounded(yield_stress(law)) + ", which is " +
                     rounded(strain) + " of its Young's modulus " + rounded(young_modulus(law)) +
                     ": are both in the same units?");
}

double area(const Mesh& mesh, const std::vector<std::int32_t>& facets) {
  double sum = 0.0;
  for (const std::int32_t f : facets)
    for (const double weight : consistent_weights(mesh, f).area) sum += weight;
  return sum;
}

/// Stress of a load; 0 for a displacement. For a body force, that of the weight of the whole body above.
double stress_of(const BoundaryEntry& entry, std::size_t index, const Selection& selection, const Mesh& mesh,
                 double size) {
  if (entry.traction) return norm(*entry.traction);
  if (entry.pressure) return std::abs(*entry.pressure);
  if (entry.body_force) return norm(*entry.body_force) * size;
  if (entry.node_force)
    return norm(*entry.node_force) *
           static_cast<double>(selection.nodes(entry.on, entry_name(entry, index)).size()) /
           std::pow(size, mesh.dim() - 1);
  if (entry.total_force)
    return norm(*entry.total_force) / area(mesh, selection.facets(entry.on, entry_name(entry, index)));
  return 0.0;
}

}  // namespace

void mixed_units(const Problem& problem, const Model& model, Warnings& warnings) {
  double softest = std::numeric_limits<double>::max(), stiffest = 0.0, strongest = 0.0;
  for (std::size_t i = 0; i < problem.laws.size(); ++i) {
    check_material(problem.laws[i], "material[" + std::to_string(i) + "]", warnings);
    softest = std::min(softest, young_modulus(problem.laws[i]));
    stiffest = std::max(stiffest, young_modulus(problem.laws[i]));
    const bool yields = !problem.laws[i].linear() && std::isfinite(problem.laws[i].proof_strain());
    strongest = std::max(strongest, yields ? yield_stress(problem.laws[i]) : HUGE_VAL);
  }
  const Selection selection(problem.mesh);
  const double size = extent(problem.mesh).size;
  double largest = 0.0;
  for (std::size_t i = 0; i < model.boundary.size(); ++i) {
    const double stress = stress_of(model.boundary[i], i, selection, problem.mesh, size);
    largest = std::max(largest, stress);
    const std::string comes =
        entry_name(model.boundary[i], i) + ": it comes to a stress of " + rounded(stress);
    if (stress > most_load * stiffest)
      warnings.push_back(comes + ", more than a tenth of Young's modulus " + rounded(stiffest) +
                         ": are both in the same units?");
    else if (stress > most_over_yield * strongest)
      warnings.push_back(comes + ", " + rounded(stress / strongest) + " times the stress " +
                         rounded(strongest) + " at which the body yields: are both in the same units?");
  }
  if (largest > 0.0 && largest < least_load * softest)
    warnings.push_back("boundary: the largest load comes to a stress of " + rounded(largest) +
                       ", less than a billionth of Young's modulus " + rounded(softest) +
                       ": are both in the same units?");
}

}  // namespace kacanov::validity

namespace kacanov::validity {
namespace {

/// Cosine between outer normal and contact direction below which a facet faces away: three degrees beyond a
/// right angle.
constexpr double turned = -0.05;
constexpr const char* look_away = "facets look away from the obstacle";

/// Sum of the contact directions of an entry's contact points at a facet's nodes; zero if it has none there.
Vector3 direction_at(const ConstraintRows& contact, std::span<const std::int32_t> nodes, std::int32_t entry) {
  Vector3 sum{};
  for (const std::int32_t node : nodes) {
    auto point = std::lower_bound(contact.begin(), contact.end(), node,
                                  [](const ContactPoint& p, std::int32_t n) { return p.node < n; });
    for (; point != contact.end() && point->node == node; ++point)
      if (point->entry == entry) sum = sum + point->normal;
  }
  return sum;
}

Vector3 normal_of(const Mesh& mesh, std::int32_t facet) {
  Vector3 sum{};
  for (const Vector3& part : consistent_weights(mesh, facet).normal) sum = sum + part;
  return sum;
}

}  // namespace

void facet_orientation(const Problem& problem, const Model& model, Warnings& warnings) {
  const Mesh& mesh = problem.mesh;
  const Selection selection(mesh);
  for (std::size_t i = 0; i < model.contact.size(); ++i) {
    const ContactEntry& entry = model.contact[i];
    // An entry on the whole boundary includes facets that face away on purpose: the gap decides which can
    // touch.
    if (entry.on.kind == Selector::Kind::all) continue;
    const std::string name = entry_name(entry, i);
    const std::vector<std::int32_t> facets = selection.facets(entry.on, name);
    std::size_t away = 0;
    std::int64_t first = 0;
    for (const std::int32_t f : facets) {
      const Vector3 towards = direction_at(problem.contact, mesh.facet(f), static_cast<std::int32_t>(i));
      const Vector3 normal = normal_of(mesh, f);
      if (!(dot(towards, normal) < turned * norm(towards) * norm(normal))) continue;
      const std::size_t element = mesh.facet_element[f];
      if (++away == 1) first = mesh.element_tag(element);
    }
    if (away == 0) continue;
    warnings.push_back(name + ": " + std::to_string(away) + " of its " + std::to_string(facets.size()) + " " +
                       look_away + ", the first that of element " + std::to_string(first) +
                       ": is the obstacle's normal or direction the right way round?");
  }
}

}  // namespace kacanov::validity

std::string kacanov::likely_cause(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings)
    if (warning.find(validity::look_away) != std::string::npos) return warning;
  return {};
}

namespace kacanov::validity {
namespace {

void check_group(const Mesh& mesh, const Selector& on, const std::string& entry, Warnings& warnings) {
  if (on.kind != Selector::Kind::name) return;
  for (const Group& group : mesh.groups) {
    if (group.name != on.name || group.inner == 0) continue;
    warnings.push_back(entry + ": " + std::to_string(group.inner) + " facets of \"" + group.name +
                       "\" are not on the boundary of the body and are left out; " +
                       std::to_string(group.members.size()) + " are on it");
  }
}

}  // namespace

void inner_facets(const Problem& problem, const Model& model, Warnings& warnings) {
  for (std::size_t i = 0; i < model.boundary.size(); ++i)
    check_group(problem.mesh, model.boundary[i].on, entry_name(model.boundary[i], i), warnings);
  for (std::size_t i = 0; i < model.contact.size(); ++i)
    check_group(problem.mesh, model.contact[i].on, entry_name(model.contact[i], i), warnings);
}

}  // namespace kacanov::validity

namespace kacanov::validity {
namespace {

constexpr double thinnest = 1e-6;

}  // namespace

void thin_elements(const Problem& problem, Warnings& warnings) {
  const Mesh& mesh = problem.mesh;
  std::size_t thin = 0, first_thin = 0;
  double worst = thinnest;
  visit_element_maps(mesh.view(), [&](std::size_t first, std::span<const ElementMap> maps) {
    for (std::size_t k = 0; k < maps.size(); ++k) {
      if (!(maps[k].thinness < thinnest)) continue;
      if (thin++ == 0) first_thin = first + k;
      worst = std::min(worst, maps[k].thinness);
    }
  });
  if (thin == 0) return;
  warnings.push_back(std::to_string(thin) + (thin == 1 ? " element is" : " elements are") +
                     " thinner than a millionth of their size, down to " + rounded(worst) +
                     ", the first element " + std::to_string(mesh.element_tag(first_thin)) +
                     ": linear solves are slow on them or fail, and digits are lost; mesh them anew");
}

}  // namespace kacanov::validity

namespace kacanov::validity {
namespace {

/// Maximum node displacement by coordinate rounding, relative to an element's size, that causes no warning.
constexpr double unnoticed = 1e-9;

double farthest_coordinate(const Mesh& mesh, std::size_t element) {
  const std::size_t count = nodes_per_element(mesh.type);
  double far = 0.0;
  for (const std::int32_t node : std::span(mesh.elements).subspan(element * count, count))
    for (const double x : position(mesh, node)) far = std::max(far, std::abs(x));
  return far;
}

}  // namespace

void far_from_origin(const Problem& problem, Warnings& warnings) {
  const Mesh& mesh = problem.mesh;
  double worst = 0.0;
  std::size_t element = 0;
  visit_element_maps(mesh.view(), [&](std::size_t first, std::span<const ElementMap> maps) {
    for (std::size_t k = 0; k < maps.size(); ++k) {
      const double size = std::pow(maps[k].volume, 1.0 / mesh.dim());
      const double moved =
          0.5 * std::numeric_limits<double>::epsilon() * farthest_coordinate(mesh, first + k);
      if (!(moved > worst * size)) continue;
      worst = moved / size;
      element = first + k;
    }
  });
  if (!(worst > unnoticed)) return;
  warnings.push_back(
      "the body lies so far from the origin that reading its coordinates in double precision "
      "has moved nodes by up to " +
      rounded(worst) + " of the size of an element, first at element " +
      std::to_string(mesh.element_tag(element)) +
      ": the numbers are those of the body as it was read; shift it to the origin");
}

}  // namespace kacanov::validity

namespace kacanov::validity {

void locking(const Problem& problem, const Model& model, Warnings& warnings) {
  for (std::size_t i = 0; i < model.materials.size(); ++i) {
    const MaterialEntry& entry = model.materials[i];
    if (entry.bbar.value_or(true) || !locks_without_bbar(entry.law, problem.mesh.type)) continue;
    warnings.push_back("material[" + std::to_string(i) + "].bbar: it is false, and " +
                       std::string(cell(problem.mesh.type).name) +
                       " elements of a plastic or nearly incompressible body are too stiff without");
  }
}

}  // namespace kacanov::validity

namespace kacanov::validity {
namespace {

/// Larger strains or rotations cause errors of about their own size in stress and equilibrium.
constexpr double small_enough = 0.05;

std::string place(const Extreme& extreme, const Result& result) {
  return " (element " + std::to_string(extreme.tag) + " at " + to_text(extreme.at, result.body.dim) + ")";
}

}  // namespace

void large_strain(const Result& result, Warnings& warnings) {
  const Extreme &strain = result.max_strain, &rotation = result.max_rotation;
  if (strain.value > small_enough)
    warnings.push_back("strains reach " + rounded(strain.value) + place(strain, result) +
                       ": this is a theory of small strains, good to some percent up to 0.05");
  if (rotation.value > small_enough)
    warnings.push_back("rotations reach " + rounded(rotation.value) + " radians" + place(rotation, result) +
                       ": this is a theory of small rotations, good to some percent up to 0.05");
}

}  // namespace kacanov::validity

namespace kacanov::validity {

/// Beyond this value a beam with 421,443 unknowns is a few per cent too stiff, and coarser ones more.
constexpr double much_flow = 10.0;

void tet4_locking(const Result& result, const Model& model, Warnings& warnings) {
  if (result.element != ElementType::tet4 || !(result.max_flow.value > much_flow)) return;
  if (std::all_of(model.materials.begin(), model.materials.end(), [](const MaterialEntry& entry) {
        return entry.formulation == MaterialEntry::Formulation::mixed;
      }))
    return;
  warnings.push_back("strains reach " + rounded(result.max_flow.value) + " times those at yield (element " +
                     std::to_string(result.max_flow.tag) + " at " +
                     to_text(result.max_flow.at, result.body.dim) +
                     "): tet4 is too stiff where bodies flow; with \"formulation\": \"mixed\" in material it "
                     "is much less so, "
                     "and \"order\": 2 in mesh makes tet10 of it, which is not");
}

}  // namespace kacanov::validity

namespace kacanov::validity {
namespace {

/// Relative to the body's size.
constexpr double large_share = 0.1;

}  // namespace

void large_displacement(const Result& result, Warnings& warnings) {
  const Extreme& extreme = result.max_displacement;
  if (!(extreme.value > large_share * result.body.size)) return;
  warnings.push_back("the body moves by " + rounded(extreme.value) + ", " +
                     rounded(extreme.value / result.body.size) + " of its size (node " +
                     std::to_string(extreme.tag) + " at " + to_text(extreme.at, result.body.dim) +
                     "): forces, gaps and normals are those of the undeformed body");
}

}  // namespace kacanov::validity

namespace kacanov::validity {
namespace {

/// Relative to the body's size: contact that is closed at rest.
constexpr double closed = 1e-6;

}  // namespace

void inactive_contact(const Result& result, const Model& model, Warnings& warnings) {
  for (const ContactTotals& contact : result.contact) {
    if (contact.sticking + contact.slipping > 0) continue;
    const std::size_t i = contact.entry;
    const std::string name = entry_name(model.contact[i], i);
    if (contact.first_gap <= closed * result.body.size)
      warnings.push_back(name +
                         ": the body touches this obstacle at rest, and the loads lift it off: no node "
                         "bears pressure, the least gap is " +
                         rounded(contact.least_gap));
    else
      warnings.push_back(name + ": nothing reaches this obstacle; of the least gap of " +
                         rounded(contact.first_gap) + " at rest " + rounded(contact.least_gap) + " is left");
  }
}

}  // namespace kacanov::validity

namespace kacanov::validity {
namespace {

/// Number of nodes under a ball that is smaller than the facets around it; in 2D the same for lines.
constexpr std::int64_t few_in_space = 3, few_in_plane = 1;
/// A face that is completely in contact does not indicate a coarse mesh.
constexpr std::int64_t many_open = 10;

}  // namespace

void coarse_contact(const Result& result, const Model& model, Warnings& warnings) {
  const std::int64_t few = result.body.dim == 2 ? few_in_plane : few_in_space;
  for (const ContactTotals& contact : result.contact) {
    const std::int64_t touching = contact.sticking + contact.slipping;
    if (touching == 0 || touching > few || contact.open < many_open) continue;
    const std::size_t i = contact.entry;
    warnings.push_back(
        entry_name(model.contact[i], i) + ": only " + std::to_string(touching) + " of " +
        std::to_string(touching + contact.open) +
        " nodes bear its pressure: its force is right in sum, but pressure and stress there are "
        "those of so coarse a mesh");
  }
}

}  // namespace kacanov::validity

namespace kacanov::validity {
namespace {

/// Share of an entry's friction that is negligible.
constexpr double little = 1e-3;

}  // namespace

void open_friction(const Result& result, const Model& model, Warnings& warnings) {
  for (const ContactTotals& contact : result.contact) {
    const std::size_t i = contact.entry;
    const ContactEntry& entry = model.contact[i];
    if (!entry.friction || entry.friction->tresca == 0.0 || !(contact.open_friction > little)) continue;
    warnings.push_back(entry_name(entry, i) + ".friction: " + rounded(100.0 * contact.open_friction) +
                       " % of it acts at nodes without pressure (" + std::to_string(contact.open) +
                       " are open), where Tresca's bound holds as well; Coulomb's asks for pressure");
  }
}

}  // namespace kacanov::validity

namespace kacanov {

std::vector<std::string> examine(const Problem& problem, const Model& model) {
  validity::Warnings warnings;
  validity::no_load(problem, model, warnings);
  validity::mixed_units(problem, model, warnings);
  validity::facet_orientation(problem, model, warnings);
  validity::inner_facets(problem, model, warnings);
  validity::cut_selections(problem, model, warnings);
  validity::unmerged_nodes(problem, warnings);
  validity::thin_elements(problem, warnings);
  validity::far_from_origin(problem, warnings);
  validity::locking(problem, model, warnings);
  return warnings;
}

std::vector<std::string> examine(const Result& result, const Model& model) {
  validity::Warnings warnings;
  validity::large_strain(result, warnings);
  validity::tet4_locking(result, model, warnings);
  validity::large_displacement(result, warnings);
  validity::inactive_contact(result, model, warnings);
  validity::coarse_contact(result, model, warnings);
  validity::open_friction(result, model, warnings);
  return warnings;
}

std::string validity::rounded(double value, int digits) {
  PlainText text;
  text.precision(digits);
  text << value;
  return text.str();
}

}  // namespace kacanov
