// SPDX-License-Identifier: BSD-3-Clause
// Lengths and volumes of a body.
#include "nonlinear/body_measures.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include <kacanov/error.hpp>

namespace kacanov {

double body_extent(const Part& part) {
  const std::size_t dim = part.dim();
  double extent = 0.0;
  for (std::size_t c = 0; c < dim; ++c) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (std::size_t i = c; i < part.coordinates.size(); i += dim) {
      low = std::min(low, part.coordinates[i]);
      high = std::max(high, part.coordinates[i]);
    }
    extent = std::max(extent, part.halo.max_all(high) + part.halo.max_all(-low));
  }
  return extent;
}

Vector lumped_volume(const Part& part) {
  Vector volume(part.nodes(), 0.0), element(part.element_count());
  reference::volumes(part.body(), element);
  const std::size_t npe = nodes_per_element(part.type);
  for (std::size_t k = 0; k < part.elements.size(); ++k)
    volume[part.elements[k]] += element[k / npe] / static_cast<double>(npe);
  part.halo.sum(volume, 1);
  return volume;
}

void refuse_beyond_floats(const Part& part, std::span<const float> diagonal) {
  constexpr double most = 1e30, least = 1e-30;  // products of some eight digits more are to fit as well
  double stiffest = 0.0, softest = HUGE_VAL, load = 0.0, moved = 0.0;
  for (const float d : diagonal) {
    stiffest = std::max(stiffest, static_cast<double>(d));
    softest = std::min(softest, static_cast<double>(d));
  }
  for (const auto& entry : part.load) load = std::max(load, std::abs(entry.value));
  for (const auto& entry : part.prescribed) moved = std::max(moved, std::abs(entry.value));
  stiffest = part.halo.max_all(stiffest);
  softest = -part.halo.max_all(-softest);
  const auto refuse = [](const std::string& key, const char* what, double value) {
    std::ostringstream text;
    text << key << ": " << what << " comes to " << value << ", expected between " << least << " and " << most
         << ", which single precision holds: take other units of length or force";
    throw InputError(text.str());
  };
  if (!(stiffest <= most)) refuse("material", "the stiffness of a node (modulus times width)", stiffest);
  if (!(softest >= least)) refuse("material", "the stiffness of a node (modulus times width)", softest);
  load = part.halo.max_all(load);
  if (!(load <= most)) refuse("boundary", "the load of a node", load);
  moved = part.halo.max_all(moved);
  if (!(moved * stiffest <= most))
    refuse("boundary", "a prescribed displacement times the stiffness of a node", moved * stiffest);
}

}  // namespace kacanov
