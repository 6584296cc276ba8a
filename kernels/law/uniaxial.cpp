// SPDX-License-Identifier: BSD-3-Clause
// Hencky laws from tensile test data (theory: uniaxial).
#include <algorithm>
#include <cmath>

#include <kacanov/law.hpp>

namespace kacanov {
namespace {

/// ‖dev τ‖ of a uniaxial stress.
double deviator(double stress) { return std::sqrt(2.0 / 3.0) * stress; }

}  // namespace

Law elastic_law(double young, double poisson) {
  Law law;
  law.bulk = young / (3.0 * (1.0 - 2.0 * poisson));
  law.shear = young / (2.0 * (1.0 + poisson));
  return law;
}

double young_modulus(const Law& law) { return 9.0 * law.bulk * law.shear / (3.0 * law.bulk + law.shear); }

laws::Table plastic_table(const Law& elastic, std::span<const std::array<double, 2>> rows) {
  const double slope = 2.0 * elastic.shear;
  laws::Table table{{0.0}, {0.0}};
  for (const auto& [stress, plastic_strain] : rows) {
    const double s = deviator(stress), x = s / slope + std::sqrt(1.5) * plastic_strain;
    // Lower bound of the stress: a plateau with a small slope.
    const double least =
        table.x.size() > 1 ? table.s.back() + plateau_slope * slope * (x - table.x.back()) : 0.0;
    table.x.push_back(x);
    table.s.push_back(std::max(s, least));
  }
  const double beyond = table.x[1];
  table.x.push_back(table.x.back() + beyond);
  table.s.push_back(table.s.back() + plateau_slope * slope * beyond);
  return table;
}

laws::LinearHardening bilinear(const Law& elastic, double yield_stress, double tangent) {
  const double young = young_modulus(elastic), plastic = young * tangent / (young - tangent);
  return {deviator(yield_stress) / (2.0 * elastic.shear), plastic / (plastic + 3.0 * elastic.shear)};
}

laws::RambergOsgood ramberg_osgood(const Law& elastic, double sigma0, double alpha, double n) {
  return {deviator(sigma0) / (2.0 * elastic.shear), 3.0 * elastic.shear * alpha / young_modulus(elastic), n};
}

}  // namespace kacanov
