// SPDX-License-Identifier: BSD-3-Clause
// One tetrahedron through the installed C++ kernels.
#include <kacanov/operator.hpp>

#include <cmath>
#include <vector>

int main() {
  const std::vector<double> coordinates{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::vector<std::int32_t> connectivity{0, 1, 2, 3};
  const std::vector<kacanov::Law> laws{kacanov::elastic_law(1.0, 0.25)};
  const std::vector<std::uint16_t> law_of_element{0};
  kacanov::Operator op({{kacanov::ElementType::tet4, coordinates, connectivity}, laws, law_of_element});
  std::vector<double> force(12);
  const double twice_energy = op.apply_dot(coordinates, force);  // u = x: tr ε = 3, dev ε = 0
  return std::abs(twice_energy - laws[0].bulk * 9.0 / 6.0) < 1e-14 ? 0 : 1;
}
