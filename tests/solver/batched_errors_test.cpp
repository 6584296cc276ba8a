// SPDX-License-Identifier: BSD-3-Clause
// The batched error estimator against the loop over single elements, for any number of elements, curved
// elements and all laws, alone and in one pass with the stress recovery.
#include <doctest/doctest.h>

#include <cmath>

#include <kacanov/part.hpp>
#include <kacanov/discretisation.hpp>
#include "recovery/spr_patches.hpp"
#include "support.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

/// A bent block of two materials; with `means` the softer one uses B-bar or the mixed formulation.
Problem bent_block(ElementType type, bool means) {
  Mesh mesh = box_mesh(type, {2.0, 1.0, 1.0}, 3);
  map_nodes(mesh, [](const Vector3& x) {
    return Vector3{x[0] + 0.1 * std::sin(3.0 * x[1]), x[1] + 0.05 * x[0] * x[2], 1.2 * x[2]};
  });
  Model model;
  model.materials.push_back({everything(), logarithmic_law(0.002)});
  if (means && type == ElementType::hex8) model.materials[0].bbar = true;
  if (means && type != ElementType::hex8) model.materials[0].formulation = MaterialEntry::Formulation::mixed;
  model.materials.push_back({box({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}), elastic_law(3.0, 0.2)});
  model.boundary.push_back(moved(named("left"), 3));
  return build_problem(mesh, model);
}

std::vector<double> wavy(const Part& part) {
  return nodal_field(part, [](const Vector3& x) {
    return Vector3{0.01 * x[0] * x[1], 0.02 * std::sin(2.0 * x[0]), 0.01 * x[2] * x[0] * x[1]};
  });
}

}  // namespace

TEST_CASE("batched errors are those of the reference loop") {
  for (const ElementType type : {ElementType::tet4, ElementType::tet10, ElementType::hex8})
    for (const bool means : {false, true}) {
      CAPTURE(cell(type).name);
      CAPTURE(means);
      const Problem problem = bent_block(type, means);
      const Part part = over_all_ranks(problem);
      const std::vector<double> u = wavy(part), dilatation = corner_dilatation(part, u);
      const BodyState state(u, {}, dilatation);
      const std::size_t elements = part.element_count(), points = points_per_element(type);
      const Patches patches(part);
      for (std::int32_t batch = 0; batch < patches.batches(); ++batch) {
        PatchFits fits = patches.fits(1);
        std::vector<double> trace(elements);
        visit_points(part, state, PointValues::all_but_stress, [&](const PointRun& run) {
          for (std::size_t k = 0; k < run.volume.size(); k += points) {
            const std::size_t e = run.first + k / points;
            const double* strain = &run.strain[6 * k];
            trace[e] = strain[0] + strain[1] + strain[2];
            if (patches.is_in(e, batch))
              patches.add(fits, e, {std::span(run.position).subspan(k, points), {strain}});
          }
        });
        patches.solve(fits);
        const Smoothing of{part, state, patches, fits, 0, trace, {}};
        std::vector<double> found(elements), expected(elements);
        batched_errors(of, batch, found);
        reference_errors(of, batch, expected);
        double largest = 0.0;
        for (const double energy : expected) largest = std::max(largest, energy);
        for (std::size_t e = 0; e < elements; ++e) {
          CHECK(std::abs(found[e] - expected[e]) <= 1e-10 * largest);
          CHECK((patches.is_in(e, batch) || found[e] == 0.0));
        }
      }
    }
}

TEST_CASE("stress and error out of one pass are what they are alone") {
  for (const ElementType type : element_types()) {
    CAPTURE(cell(type).name);
    Model model;
    model.materials.push_back({everything(), logarithmic_law(0.002)});
    model.boundary.push_back(moved(named("left"), dimension(type)));
    const Problem problem = build_problem(box_mesh(type), model);
    const Part part = over_all_ranks(problem);
    const std::vector<double> u = wavy(part);
    const Recovered both = recover_and_estimate(part, u);
    CHECK(both.nodal.stress == recover_stress(part, u).stress);
    CHECK(both.error.element == estimate_error(part, u).element);
    CHECK(both.error.relative == estimate_error(part, u).relative);
  }
}
