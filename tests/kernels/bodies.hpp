// SPDX-License-Identifier: BSD-3-Clause
// Fixtures of the kernels' tests: meshes with materials, random vectors, comparison of vectors.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include <kacanov/pressure_patches.hpp>
#include <kacanov/reference.hpp>
#include "../../perf/benchmarks/meshes.hpp"

namespace kacanov::test {

inline const std::span<const ElementType> all_types = element_types();

/// One law of each kind, all with monotone stress, E = 1, nu = 0.3.
inline std::vector<Law> every_law() {
  std::vector<Law> all(6, elastic_law(1.0, 0.3));
  all[1].form = laws::Logarithmic{0.01};
  all[2].form = laws::LinearHardening{0.01, 0.1};
  all[3].form = laws::Power{0.01, 0.3};
  all[4].form = laws::Saturating{0.01, 0.4};
  const double mu = all[5].shear;
  all[5].form = laws::Table{{0.0, 0.01, 0.02, 0.05}, {0.0, 0.02 * mu, 0.03 * mu, 0.04 * mu}};
  return all;
}

/// A stiffening material: g' > 0.
inline Law stiffening_law() {
  Law law = elastic_law(1.0, 0.3);
  law.form = laws::Table{{0.0, 0.01, 0.02, 0.05}, {0.0, 0.02 * law.shear, 0.05 * law.shear, 0.2 * law.shear}};
  return law;
}

struct OwnedBody {
  meshes::OwnedMesh mesh;
  std::vector<Law> laws;
  std::vector<std::uint16_t> law_of_element;
  std::vector<std::int64_t> pressure_patch = {};

  Body body() const {
    Body view{mesh.view(), laws, law_of_element};
    view.pressure_patch = pressure_patch;
    return view;
  }
  /// Computes the pressure patches over which the laws of tet4 elements average the dilatation.
  void make_patches() {
    IndexMap alone;
    alone.owned = static_cast<std::int32_t>(mesh.view().node_count());
    alone.starts = {0, alone.owned};
    pressure_patch = pressure_patches(body(), alone);
  }
};

inline OwnedBody with_one_law(meshes::OwnedMesh mesh, const Law& law) { return {std::move(mesh), {law}, {}}; }

/// A body with every law of `every_law` and the stiffening one, distributed over the elements. Every second
/// law averages the dilatation if the element supports that: at corners with two bulk moduli, for tet4 over
/// patches.
inline OwnedBody with_every_law(meshes::OwnedMesh mesh, unsigned seed) {
  OwnedBody body{std::move(mesh), every_law(), {}};
  body.laws.push_back(stiffening_law());
  const bool has_mean = cell(body.mesh.type).mean_dilatation || cell(body.mesh.type).corner_dilatation;
  for (std::size_t i = 1; has_mean && i < body.laws.size(); i += 2) body.laws[i].mean_dilatation = true;
  if (cell(body.mesh.type).corner_dilatation) body.laws[3].bulk *= 1.5;
  std::mt19937 random(seed);
  for (std::size_t e = 0; e < body.mesh.view().element_count(); ++e)
    body.law_of_element.push_back(static_cast<std::uint16_t>(random() % body.laws.size()));
  body.make_patches();
  return body;
}

inline std::vector<double> random_vector(std::size_t size, unsigned seed, double scale = 1.0) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-scale, scale);
  std::vector<double> v(size);
  for (double& value : v) value = uniform(random);
  return v;
}

/// Frozen secant moduli g between 0.1 and 0.4, one per quadrature point.
inline std::vector<double> some_secant(const Body& body, unsigned seed) {
  std::vector<double> g = random_vector(body.secant_count(), seed, 0.15);
  for (double& value : g) value += 0.25;
  return g;
}

/// Returns max |a − b| / max |b|.
template <class A, class B>
double difference(const A& a, const B& b) {
  double worst = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < b.size(); ++i) {
    const double d = std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i]));
    worst = d > worst || std::isnan(d) ? d : worst;
    largest = std::max(largest, std::abs(static_cast<double>(b[i])));
  }
  return largest > 0.0 ? worst / largest : worst;
}

inline double dot(std::span<const double> a, std::span<const double> b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// A small perturbed box whose displacements take about half of its quadrature points beyond yield.
inline OwnedBody small_body(ElementType type, unsigned seed) {
  meshes::OwnedMesh mesh = meshes::box(type, {3, 2, 2}, {1.5, 1.0, 1.0});
  meshes::jitter(mesh, cell(type).order == 2 ? 0.04 : 0.12, seed);
  return with_every_law(std::move(mesh), seed);
}

}  // namespace kacanov::test
