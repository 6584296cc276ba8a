// SPDX-License-Identifier: BSD-3-Clause
// A deal.II program: its mesh of a ball is handed over as arrays, its SolverCG solves with our operator. With
// a linear displacement prescribed on the boundary, the solution inside has to be that same linear field.
#include <deal.II/base/point.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/vector.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <vector>

#include <kacanov/kacanov.h>

namespace {

using Vector = dealii::Vector<double>;

/// B on the unknowns that are not held, the identity on those that are: what SolverCG wants of a matrix.
class ConstrainedOperator {
 public:
  ConstrainedOperator(const dealii::Triangulation<3>& mesh, const kacanov_law& law) {
    // Node a of our hexahedron, in Gmsh's order, is this vertex of deal.II's, in lexicographic order.
    constexpr std::array<unsigned, 8> vertex{{0, 1, 3, 2, 4, 5, 7, 6}};
    held.assign(3 * mesh.n_vertices(), false);
    for (const auto& cell : mesh.active_cell_iterators()) {
      for (const unsigned v : vertex)
        connectivity.push_back(static_cast<std::int32_t>(cell->vertex_index(v)));
      for (const auto& face : cell->face_iterators())
        for (unsigned v = 0; face->at_boundary() && v < 4; ++v)
          std::fill_n(held.begin() + 3 * static_cast<std::ptrdiff_t>(face->vertex_index(v)), 3, true);
    }
    kacanov_description body{};
    body.struct_size = sizeof body;
    body.element = KACANOV_HEX8;
    body.threads = 2;
    body.nodes = mesh.n_vertices();
    body.coordinates = &mesh.get_vertices()[0][0];  // one dealii::Point a node
    body.node_stride = sizeof(dealii::Point<3>) / sizeof(double);
    body.elements = mesh.n_active_cells();
    body.connectivity = connectivity.data();
    body.laws = 1;
    body.law = &law;
    char message[256];
    kacanov_operator* made = nullptr;
    if (kacanov_create(&body, &made, message, sizeof message) != KACANOV_OK)
      throw std::runtime_error(message);
    op.reset(made);
    masked.reinit(static_cast<unsigned>(held.size()));
  }

  unsigned size() const { return masked.size(); }
  bool is_held(unsigned i) const { return held[i]; }

  /// y = B x, all unknowns.
  void apply(const Vector& x, Vector& y) const {
    if (kacanov_apply(op.get(), x.size(), x.begin(), y.begin()) != KACANOV_OK)
      throw std::runtime_error(kacanov_message(op.get()));
  }
  void vmult(Vector& y, const Vector& x) const {
    for (unsigned i = 0; i < size(); ++i) masked[i] = held[i] ? 0.0 : x[i];
    apply(masked, y);
    for (unsigned i = 0; i < size(); ++i)
      if (held[i]) y[i] = x[i];
  }

 private:
  struct Destroy {
    void operator()(kacanov_operator* handle) const { kacanov_destroy(handle); }
  };
  std::unique_ptr<kacanov_operator, Destroy> op;
  std::vector<std::int32_t> connectivity;
  std::vector<bool> held;
  mutable Vector masked;
};

}  // namespace

int main() {
  dealii::Triangulation<3> mesh;
  dealii::GridGenerator::hyper_ball(mesh);
  mesh.refine_global(3);
  kacanov_law law{};
  law.struct_size = sizeof law;
  if (kacanov_elastic_law(1.0, 0.3, &law) != KACANOV_OK) return EXIT_FAILURE;
  const ConstrainedOperator op(mesh, law);

  Vector exact(op.size());
  for (unsigned i = 0; i < mesh.n_vertices(); ++i) {
    const dealii::Point<3>& p = mesh.get_vertices()[i];
    exact[3 * i] = 0.01 * p[0] + 0.02 * p[1];
    exact[3 * i + 1] = -0.03 * p[1] + 0.01 * p[2];
    exact[3 * i + 2] = 0.02 * p[2] - 0.01 * p[0];
  }
  // u = lifted + v, with v = 0 where held and B v = −B lifted elsewhere.
  Vector lifted(op.size()), right(op.size()), v(op.size());
  for (unsigned i = 0; i < op.size(); ++i) lifted[i] = op.is_held(i) ? exact[i] : 0.0;
  op.apply(lifted, right);
  for (unsigned i = 0; i < op.size(); ++i) right[i] = op.is_held(i) ? 0.0 : -right[i];

  dealii::SolverControl control(1000, 1e-12 * right.l2_norm());
  dealii::SolverCG<Vector> solver(control);
  solver.solve(op, v, right, dealii::PreconditionIdentity());
  v += lifted;
  v -= exact;
  const double error = v.linfty_norm() / exact.linfty_norm();
  std::cout << op.size() << " unknowns, " << mesh.n_active_cells() << " cells: " << control.last_step()
            << " iterations, largest relative error " << error << "\n";
  return error < 1e-10 ? EXIT_SUCCESS : EXIT_FAILURE;
}
