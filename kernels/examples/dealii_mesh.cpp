// SPDX-License-Identifier: BSD-3-Clause
// A deal.II program: it passes its mesh of a ball as arrays, and its SolverCG solves with the library's
// operator and multigrid. With a linear displacement prescribed on the boundary, the solution inside is the
// same field.
//
// usage: dealii_mesh [REFINEMENTS [with_matrix]]; with_matrix: compares with deal.II's SparseMatrix and
// Jacobi, on one thread; times are processor seconds.
#include <deal.II/base/point.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/lac/solver_cg.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "dealii_operator.hpp"

namespace {

/// Uses the mesh's vertices in place.
Operator make_operator(const dealii::Triangulation<3>& mesh, const kacanov_law& law, int threads) {
  std::vector<std::int32_t> connectivity;
  for (const auto& cell : mesh.active_cell_iterators())
    for (const unsigned v : cell->vertex_indices())
      connectivity.push_back(static_cast<std::int32_t>(cell->vertex_index(v)));
  kacanov_description body{};
  body.struct_size = sizeof body;
  body.element = KACANOV_HEX8;
  body.node_order = "dealii";
  body.threads = threads;
  body.nodes = mesh.n_vertices();
  body.coordinates = &mesh.get_vertices()[0][0];  // one dealii::Point per node
  body.node_stride = sizeof(dealii::Point<3>) / sizeof(double);
  body.elements = mesh.n_active_cells();
  body.connectivity = connectivity.data();
  body.laws = 1;
  body.law = &law;
  return Operator(body);
}

/// Processor time.
double seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Solves with `solve`, prints the cost, and returns the largest relative error.
template <class Solve>
double report(const std::string& name, const Vector& lifted, const Vector& exact, const Solve& solve) {
  Vector v(exact.size());
  double ready = 0.0;
  const double start = seconds();
  const unsigned iterations = solve(v, ready);
  const double end = seconds();
  v += lifted;
  v -= exact;
  const double error = v.linfty_norm() / exact.linfty_norm();
  std::cout << name << ": " << exact.size() << " unknowns, " << iterations << " iterations, setup "
            << ready - start << " s, solve " << end - ready << " s, largest relative error " << error << "\n";
  return error;
}

int run(unsigned refinements, bool with_matrix) {
  dealii::Triangulation<3> mesh;
  dealii::GridGenerator::hyper_ball(mesh);
  mesh.refine_global(refinements);
  kacanov_law law{};
  law.struct_size = sizeof law;
  if (kacanov_elastic_law(1.0, 0.3, &law) != KACANOV_OK) return EXIT_FAILURE;
  Operator op = make_operator(mesh, law, with_matrix ? 1 : 2);

  Vector exact(3 * mesh.n_vertices());
  for (unsigned i = 0; i < mesh.n_vertices(); ++i) {
    const dealii::Point<3>& p = mesh.get_vertices()[i];
    exact[3 * i] = 0.01 * p[0] + 0.02 * p[1];
    exact[3 * i + 1] = -0.03 * p[1] + 0.01 * p[2];
    exact[3 * i + 2] = 0.02 * p[2] - 0.01 * p[0];
  }
  std::vector<bool> on_boundary(mesh.n_vertices(), false);
  for (const auto& cell : mesh.active_cell_iterators())
    for (const auto& face : cell->face_iterators())
      for (unsigned v = 0; face->at_boundary() && v < 4; ++v) on_boundary[face->vertex_index(v)] = true;
  std::vector<std::int32_t> held;
  for (unsigned i = 0; i < exact.size(); ++i)
    if (on_boundary[i / 3]) held.push_back(static_cast<std::int32_t>(i));
  // u = lifted + v, with v = 0 at constrained unknowns and B v = −B lifted elsewhere.
  Vector lifted(exact.size()), right(exact.size());
  for (const std::int32_t i : held) lifted[static_cast<unsigned>(i)] = exact[static_cast<unsigned>(i)];
  op.vmult(right, lifted);
  right *= -1.0;
  for (const std::int32_t i : held) right[static_cast<unsigned>(i)] = 0.0;
  op.constrain(held);

  const double relative = with_matrix ? 1e-8 : 1e-12;
  const auto solve = [&](const auto& matrix, const auto& preconditioner, Vector& v) {
    dealii::SolverControl control(5000, relative * right.l2_norm());
    dealii::SolverCG<Vector> solver(control);
    solver.solve(matrix, v, right, preconditioner);
    return control.last_step();
  };
  double error = report("operator and multigrid", lifted, exact, [&](Vector& v, double& ready) {
    const Multigrid multigrid(op);
    ready = seconds();
    return solve(op, multigrid, v);
  });
  if (with_matrix)
    error = std::max(error, report("matrix and Jacobi", lifted, exact, [&](Vector& v, double& ready) {
                       const Matrix matrix(op, exact.size());
                       dealii::PreconditionJacobi<> jacobi;
                       jacobi.initialize(matrix.get());
                       ready = seconds();
                       return solve(matrix.get(), jacobi, v);
                     }));
  return error < (with_matrix ? 1e-5 : 1e-10) ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc > 1 ? static_cast<unsigned>(std::atoi(argv[1])) : 3,
               argc > 2 && std::string(argv[2]) == "with_matrix");
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return EXIT_FAILURE;
  }
}
