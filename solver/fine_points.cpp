// SPDX-License-Identifier: BSD-3-Clause
// The points of the finer rule, with what shape functions have there.
#include "fine_points.hpp"

#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>

#include "finer_rule.hpp"

namespace kacanov {
namespace {

/// Of the cell with straight edges and the same corners.
const Cell& straight(const Cell& type) {
  for (const Cell& other : cells())
    if (other.dim == type.dim && other.corners == type.corners && other.order == 1) return other;
  throw std::logic_error("no straight cell for " + std::string(type.name));
}

}  // namespace

std::vector<FinePoint> fine_points(const Cell& type) {
  std::vector<FinePoint> all;
  for (const QuadraturePoint& point : finer_rule(type)) {
    FinePoint one{point.weight, std::vector<double>(static_cast<std::size_t>(type.nodes * type.dim)),
                  std::vector<double>(static_cast<std::size_t>(type.nodes)),
                  std::vector<double>(static_cast<std::size_t>(type.corners))};
    type.gradients(point.xi.data(), one.gradient.data());
    type.values(point.xi.data(), one.value.data());
    straight(type).values(point.xi.data(), one.corner_share.data());
    all.push_back(std::move(one));
  }
  return all;
}

}  // namespace kacanov
