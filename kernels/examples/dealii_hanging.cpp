// SPDX-License-Identifier: BSD-3-Clause
// A deal.II mesh refined towards a corner, with deal.II's AffineConstraints for hanging nodes and boundary
// around the library's operator.
//
// With P from the free unknowns to all of them, SolverCG solves PᵀBP v = Pᵀf: distribute() is P, condense()
// is Pᵀ. The preconditioner is the library's multigrid on the unconstrained mesh, in which hanging nodes are
// free; their values in its result are discarded. They stay close to those of the adjacent nodes, because
// cells connect both, so that it takes about twice the iterations of a mesh without hanging nodes, for any
// size.
//
// usage: dealii_hanging [CYCLES [HALVINGS]]; checks a linear displacement prescribed on the boundary, which
// the solution must reproduce inside, and a load, whose solution must equal that of deal.II's own condensed
// matrix.
#include <deal.II/base/function.h>
#include <deal.II/base/point.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/numerics/vector_tools.h>

#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>

#include "dealii_operator.hpp"

namespace {

using Constraints = dealii::AffineConstraints<double>;
using DoFs = dealii::DoFHandler<3>;

/// The unit cube, halved `halvings` times along each axis; each cycle then refines near a corner.
void refine(dealii::Triangulation<3>& mesh, int cycles, unsigned halvings) {
  dealii::GridGenerator::hyper_cube(mesh);
  mesh.refine_global(halvings);
  for (int cycle = 0; cycle < cycles; ++cycle) {
    for (const auto& cell : mesh.active_cell_iterators())
      if (cell->center().norm() < 0.6 / (1 << cycle)) cell->set_refine_flag();
    mesh.execute_coarsening_and_refinement();
  }
}

/// Uses deal.II's numbering: unknowns 3 i, 3 i + 1, 3 i + 2 belong to node i.
Operator make_operator(const DoFs& dofs, const kacanov_law& law) {
  std::vector<std::int32_t> connectivity;
  std::vector<dealii::Point<3>> points(dofs.n_dofs() / 3);
  for (const auto& cell : dofs.active_cell_iterators())
    for (const unsigned v : cell->vertex_indices()) {
      const unsigned node = cell->vertex_dof_index(v, 0) / 3;
      for (unsigned c = 0; c < 3; ++c)
        if (cell->vertex_dof_index(v, c) != 3 * node + c)
          throw std::runtime_error("the unknowns of a node do not follow each other");
      points[node] = cell->vertex(v);
      connectivity.push_back(static_cast<std::int32_t>(node));
    }
  kacanov_description body{};
  body.struct_size = sizeof body;
  body.element = KACANOV_HEX8;
  body.node_order = "dealii";
  body.threads = 2;
  body.nodes = points.size();
  body.coordinates = &points[0][0];
  body.elements = connectivity.size() / 8;
  body.connectivity = connectivity.data();
  body.laws = 1;
  body.law = &law;
  return Operator(body);
}

/// PᵀBP, and the identity at constrained unknowns.
class Condensed {
 public:
  Condensed(const Operator& op, const Constraints& constraints) : op_(op), constraints_(constraints) {}

  void vmult(Vector& y, const Vector& x) const {
    all_ = x;
    constraints_.distribute(all_);
    op_.vmult(y, all_);
    constraints_.condense(y);
    for (const auto& line : constraints_.get_lines()) y[line.index] = x[line.index];
  }

 private:
  const Operator& op_;
  const Constraints& constraints_;
  mutable Vector all_;
};

/// The multigrid, with zero at hanging nodes.
class Preconditioner {
 public:
  Preconditioner(const Multigrid& multigrid, const Constraints& hanging)
      : multigrid_(multigrid), hanging_(hanging) {}

  void vmult(Vector& z, const Vector& r) const {
    multigrid_.vmult(z, r);
    hanging_.set_zero(z);
  }

 private:
  const Multigrid& multigrid_;
  const Constraints& hanging_;
};

template <class Matrix, class Inverse>
Vector solve(const std::string& name, const Matrix& matrix, const Inverse& inverse, const Vector& right) {
  Vector v(right.size());
  dealii::SolverControl control(5000, 1e-12 * right.l2_norm());
  dealii::SolverCG<Vector>(control).solve(matrix, v, right, inverse);
  std::cout << name << ": " << control.last_step() << " iterations\n";
  return v;
}

double difference(Vector a, const Vector& b) {
  a -= b;
  return a.linfty_norm() / b.linfty_norm();
}

Vector linear_field(const DoFs& dofs) {
  Vector u(dofs.n_dofs());
  for (const auto& cell : dofs.active_cell_iterators())
    for (const unsigned v : cell->vertex_indices()) {
      const dealii::Point<3>& p = cell->vertex(v);
      u[cell->vertex_dof_index(v, 0)] = 0.01 * p[0] + 0.02 * p[1];
      u[cell->vertex_dof_index(v, 1)] = -0.03 * p[1] + 0.01 * p[2];
      u[cell->vertex_dof_index(v, 2)] = 0.02 * p[2] - 0.01 * p[0];
    }
  return u;
}

int run(int cycles, unsigned halvings) {
  dealii::Triangulation<3> mesh;
  refine(mesh, cycles, halvings);
  DoFs dofs(mesh);
  dofs.distribute_dofs(dealii::FESystem<3>(dealii::FE_Q<3>(1), 3));
  Constraints hanging, all;
  dealii::DoFTools::make_hanging_node_constraints(dofs, hanging);
  all.copy_from(hanging);
  dealii::VectorTools::interpolate_boundary_values(dofs, 0, dealii::Functions::ZeroFunction<3>(3), all);
  hanging.close();
  all.close();
  std::cout << mesh.n_active_cells() << " cells, " << dofs.n_dofs() << " unknowns, "
            << hanging.n_constraints() << " of them of hanging nodes\n";

  kacanov_law law{};
  law.struct_size = sizeof law;
  if (kacanov_elastic_law(1.0, 0.3, &law) != KACANOV_OK) return EXIT_FAILURE;
  Operator op = make_operator(dofs, law);

  // u = lifted + P v, with v = 0 on the boundary: PᵀBP v = −PᵀB lifted.
  const Vector exact = linear_field(dofs);
  Vector lifted(exact.size()), right(exact.size()), load(exact.size());
  std::vector<std::int32_t> held;
  for (const auto& line : all.get_lines()) {
    if (hanging.is_constrained(line.index)) continue;
    held.push_back(static_cast<std::int32_t>(line.index));
    lifted[line.index] = exact[line.index];
  }
  hanging.distribute(lifted);
  op.vmult(right, lifted);
  right *= -1.0;
  all.condense(right);
  for (unsigned i = 2; i < load.size(); i += 3) load[i] = -1.0;
  all.condense(load);

  const Matrix matrix(op, exact.size(),
                      &all);  // before op gets the boundary constraints, which deal.II applies here
  dealii::PreconditionJacobi<> jacobi;
  jacobi.initialize(matrix.get());
  op.constrain(held);
  const Multigrid multigrid(op);
  const Condensed condensed(op, all);
  const Preconditioner inverse(multigrid, hanging);

  Vector u = solve("linear field, operator and multigrid", condensed, inverse, right);
  hanging.distribute(u);
  u += lifted;
  Vector ours = solve("load, operator and multigrid", condensed, inverse, load);
  Vector theirs = solve("load, deal.II's condensed matrix and Jacobi", matrix.get(), jacobi, load);
  all.distribute(ours);
  all.distribute(theirs);
  const double error = difference(u, exact), apart = difference(ours, theirs);
  std::cout << "largest relative error of the linear field " << error << ", solutions apart by " << apart
            << "\n";
  return error < 1e-10 && apart < 1e-8 ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc > 1 ? std::atoi(argv[1]) : 3, argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 3);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return EXIT_FAILURE;
  }
}
