// SPDX-License-Identifier: BSD-3-Clause
// Effectivity of the error estimate: estimated against true discretisation error.
#include <kacanov/discretisation.hpp>

#include <doctest/doctest.h>

#include "support.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

/// A block fixed at its left end with its right end displaced downwards: the potential energy is the strain
/// energy.
Run bent(ElementType type, int cells, const Law& law) {
  const int dim = dimension(type);
  Model model;
  model.materials.push_back({everything(), law});
  model.boundary.push_back(moved(named("left"), dim));
  Vector3 down{};
  down[static_cast<std::size_t>(dim) - 1] = -0.02;
  model.boundary.push_back(moved(named("right"), dim, down));
  model.solver.tolerance = 1e-8;
  return run_alone(make_box({{2.0, 1.0, 1.0}, {2 * cells, cells, dim == 3 ? cells : 1}, type}), model);
}

double stored_energy(const Run& run) { return reference::energy(run.part.body(), run.solution.displacement); }

}  // namespace

TEST_CASE("the estimate is the error, within a half and twice, elastic and beyond yield") {
  for (const Law& law : {elastic_law(1.0, 0.3), logarithmic_law(0.002)})
    for (const int dim : {2, 3}) {
      // Richardson extrapolation of the energies of finer meshes of the best element.
      const ElementType best = dim == 2 ? ElementType::quad4 : ElementType::tet10;
      const int fine = dim == 2 ? 64 : 8;
      const double half = stored_energy(bent(best, fine / 2, law)),
                   whole = stored_energy(bent(best, fine, law));
      const double exact = whole - (half - whole) / 2.0;
      for (const ElementType type : element_types()) {
        if (dimension(type) != dim) continue;
        CAPTURE(cell(type).name);
        CAPTURE(law.linear());
        const Run run = bent(type, cell(type).order == 1 ? 8 : 4, law);
        REQUIRE(run.result().status == Status::converged);
        const DiscretisationError error = estimate_error(run.part, run.solution);
        const double effectivity = std::sqrt(error.energy / (stored_energy(run) - exact));
        INFO("effectivity " << effectivity << " at " << error.relative);
        CHECK(effectivity > 0.5);
        CHECK(effectivity < 2.0);
      }
    }
}
