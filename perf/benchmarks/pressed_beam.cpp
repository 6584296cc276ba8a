// SPDX-License-Identifier: BSD-3-Clause
// The body of the benchmarks of solves: a pressed beam.
#include "pressed_beam.hpp"

#include <cmath>

#include "formats/gmsh_reader.hpp"
#include "problem/selection.hpp"

using namespace kacanov;

Problem make_pressed_beam(const PressedBeam& options) {
  Mesh mesh;
  if (options.mesh.empty()) {
    BoxSpec box;
    box.type = *element_type(options.element);
    const bool flat = dimension(box.type) == 2;
    box.size = {4.0 * options.aspect, 1.0, 1.0};
    box.cells = {4 * options.cells, options.cells, flat ? 1 : options.cells};
    mesh = make_box(box);
  } else {
    mesh = read_gmsh(options.mesh);
  }
  const std::size_t dim = mesh.dim();
  const Extent box = extent(mesh);
  const auto side = [&, low = box.lower, high = box.upper](std::size_t axis, bool upper, double from_x) {
    Selector on;
    on.kind = Selector::Kind::box;
    on.lower = low;
    on.upper = high;
    for (std::size_t c = 0; c < 3; ++c) {
      const double slack = 1e-6 * (dim > c ? high[c] - low[c] : 1.0);
      on.lower[c] -= slack;
      on.upper[c] += slack;
    }
    const double slack = 1e-6 * (high[axis] - low[axis]);
    (upper ? on.lower : on.upper)[axis] = (upper ? high : low)[axis] + (upper ? -slack : slack);
    if (from_x > 0.0) on.lower[0] = low[0] + from_x * (high[0] - low[0]);
    return on;
  };
  const std::size_t up = dim - 1;
  Model model;
  MaterialEntry material;
  material.law.bulk = 1.0 / (3.0 * (1.0 - 2.0 * options.poisson));
  material.law.shear = 1.0 / (2.0 * (1.0 + options.poisson));
  if (options.mixed) material.formulation = MaterialEntry::Formulation::mixed;
  model.materials.push_back(material);
  BoundaryEntry held, loaded;
  held.on = side(0, false, 0.0);
  held.displacement = std::array<std::optional<double>, 3>{0.0, 0.0, 0.0};
  loaded.on = side(up, true, 0.5);
  Vector3 traction{};
  traction[up] = -1e-3;
  loaded.traction = traction;
  model.boundary = {held, loaded};
  ContactEntry contact;
  contact.on = side(up, false, 0.0);
  Plane plane;
  plane.point = box.lower;
  plane.normal[up] = 1.0;
  contact.obstacle = plane;
  model.contact.push_back(contact);
  return build_problem(std::move(mesh), model);
}

std::vector<double> varied_secant(const Part& part, double jump) {
  const Body body = part.body();
  const std::size_t npe = nodes_per_element(part.type);
  const std::size_t points = points_per_element(part.type);
  const std::size_t dim = part.dim();
  std::vector<double> g(body.secant_count());
  for (std::size_t e = 0; e < body.mesh.element_count(); ++e) {
    double wave = 1.0;
    for (std::size_t c = 0; c < dim; ++c)
      wave *=
          std::sin(6.0 * part.coordinates[static_cast<std::size_t>(part.elements[e * npe]) * dim + c] + 1.0);
    for (std::size_t q = 0; q < points; ++q)
      g[e * points + q] = body.law(e).shear * std::pow(jump, -0.5 - 0.5 * wave);
  }
  return g;
}
