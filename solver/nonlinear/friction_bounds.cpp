// SPDX-License-Identifier: BSD-3-Clause
// The friction bound ψ of every contact point.
#include "nonlinear/friction_bounds.hpp"

#include <algorithm>
#include <cmath>

namespace kacanov {

bool has_friction(const Part& part) {
  return part.node_map.any(std::any_of(part.contact.begin(), part.contact.end(),
                                       [](const ContactPoint& point) { return point.tangents > 0; }));
}

bool has_slip_history(const Part& part) {
  return part.node_map.any(std::any_of(part.contact.begin(), part.contact.end(),
                                       [](const ContactPoint& point) { return point.since_step; }));
}

double follow_pressure(const Part& part, const Vector& pressure, Vector& bound) {
  double change = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < part.contact.size(); ++i) {
    const double now = part.contact[i].friction_bound(pressure[i]);
    change = std::max(change, std::abs(now - bound[i]));
    largest = std::max(largest, pressure[i]);
    bound[i] = now;
  }
  change = part.node_map.max_all(change);
  largest = part.node_map.max_all(largest);
  return largest > 0.0 ? change / largest : 0.0;
}

}  // namespace kacanov
