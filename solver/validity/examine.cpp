// SPDX-License-Identifier: BSD-3-Clause
// All checks of a problem, and all of a result.
#include <kacanov/validity.hpp>

#include "mesh/plain_stream.hpp"
#include "validity/checks.hpp"

namespace kacanov {

std::vector<std::string> examine(const Problem& problem, const Model& model) {
  validity::Warnings warnings;
  validity::no_load(problem, model, warnings);
  validity::mixed_units(problem, model, warnings);
  validity::looking_away(problem, model, warnings);
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
  validity::locked_flow(result, model, warnings);
  validity::large_displacement(result, warnings);
  validity::idle_contact(result, model, warnings);
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
