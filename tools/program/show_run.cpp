// SPDX-License-Identifier: BSD-3-Clause
// Visible output of a run: boundary fields, pictures and obstacles, with reasons for missing ones.
#include "program/show_run.hpp"

#include <algorithm>
#include <cmath>

#include "problem/vector3.hpp"
#include "program/solve_case.hpp"

namespace kacanov {
namespace {

/// Euclidean lengths of vectors with `dim` entries.
std::vector<double> lengths(const std::vector<double>& vectors, std::size_t dim) {
  std::vector<double> all;
  for (std::size_t i = 0; i < vectors.size(); i += dim) {
    double square = 0.0;
    for (std::size_t c = 0; c < dim; ++c) square += vectors[i + c] * vectors[i + c];
    all.push_back(std::sqrt(square));
  }
  return all;
}

/// View direction onto the contact surface: from the obstacle side, slightly oblique and from above.
Vector3 towards_contact(const Problem& problem) {
  Vector3 sum{};
  for (const ContactPoint& point : problem.contact) sum = sum + point.mass * point.normal;
  const double length = norm(sum);
  if (!(length > 0.0)) return {};
  const Vector3 view = (1.0 / length) * sum;
  return view + Vector3{0.35, -0.5, view[2] < -0.5 ? 0.0 : 0.35};
}

std::array<std::string, 2> lines_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::von_mises: break;
    case Quantity::displacement: return {"displace-", "ment"};
    case Quantity::contact_pressure: return {"contact", "pressure"};
    case Quantity::plastic: return {"plastic", "share"};
  }
  return {"von Mises", "stress"};
}

}  // namespace

ShownRun show_run(const Case& input, const Problem& problem, const ContactFields& contact,
                  const std::vector<double>& von_mises, const std::vector<double>& plastic,
                  double largest_von_mises) {
  ShownRun shown;
  const auto dim = static_cast<std::size_t>(problem.mesh.dim());
  const std::vector<double> pressure = nodal_pressure(problem, input.model, contact);
  const bool touches = std::any_of(pressure.begin(), pressure.end(), [](double p) { return p > 0.0; });
  const auto add = [&](Quantity quantity, const char* name, std::vector<double> values) {
    if (quantity == input.output.quantity) shown.first = shown.fields.size();
    shown.fields.push_back({name, std::move(values)});
  };
  const auto leave_out = [&](Quantity quantity, const std::string& why) {
    const bool wanted = quantity == input.output.quantity;
    shown.not_shown.push_back(why +
                              (wanted ? " (output.quantity): von Mises stress is shown instead." : "."));
  };
  add(Quantity::von_mises, "von Mises stress", von_mises);
  add(Quantity::displacement, "displacement", lengths(contact.displacement, dim));
  if (touches)
    add(Quantity::contact_pressure, "contact pressure", pressure);
  else
    leave_out(Quantity::contact_pressure, problem.contact.empty()
                                              ? "The case has no contact, and so no contact pressure"
                                              : "Nothing touches: there is no contact pressure");
  if (!plastic.empty())
    add(Quantity::plastic, "plastic share", plastic);
  else
    leave_out(Quantity::plastic, "No element is beyond yield: there is no plastic share");
  int missing = 0;
  shown.obstacles = obstacle_facets(problem, input.model, contact, missing);
  if (missing > 0)
    shown.not_shown.push_back("Obstacles of " + std::to_string(missing) +
                              " contact entries are not drawn: no whole facet faces them.");

  PictureContent content{shown.fields[shown.first].values};
  if (shown.first > 0) content.quantity = lines_of(input.output.quantity);
  content.obstacles = shown.obstacles;
  shown.picture = deformed_picture(input, problem.mesh, contact.displacement, content, largest_von_mises);
  if (touches) {
    content = {pressure, lines_of(Quantity::contact_pressure), {}, towards_contact(problem), false};
    shown.pressure_picture =
        deformed_picture(input, problem.mesh, contact.displacement, content, largest_von_mises);
  }
  return shown;
}

}  // namespace kacanov
