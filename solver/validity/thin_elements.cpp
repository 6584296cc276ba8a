// SPDX-License-Identifier: BSD-3-Clause
// Whether elements are so thin that rounding and linear solves suffer.
#include <algorithm>
#include <span>

#include "operator/element_maps.hpp"
#include "validity/checks.hpp"

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
