# SPDX-License-Identifier: BSD-3-Clause
"""Function spaces of DOLFINx on several ranks: mpiexec -n 2 python3 mpi_dolfinx.py. Not run by discovery."""
import faulthandler
import unittest

import dolfinx.fem.petsc
import kacanov as kc
import numpy as np
import ufl
from dolfinx import cpp, fem
from dolfinx import mesh as dmesh
from mpi4py import MPI
from petsc4py import PETSc

WORLD = MPI.COMM_WORLD
LAST = WORLD.size - 1
YOUNG, POISSON = 210e3, 0.3
DX = ufl.dx(metadata={"quadrature_degree": 3})  # two points per axis on hexahedra; exact on tetrahedra
KINDS = [(dmesh.CellType.tetrahedron, 1), (dmesh.CellType.tetrahedron, 2), (dmesh.CellType.hexahedron, 1)]
GHOSTS = [cpp.mesh.GhostMode.none, cpp.mesh.GhostMode.shared_facet]


def spaces():
    for cell, degree in KINDS:
        for ghosts in GHOSTS:
            mesh = dmesh.create_box(WORLD, [np.zeros(3), np.array([4.0, 1, 1])], (6, 2, 2), cell, ghost_mode=ghosts)
            mesh.geometry.x[:, 1] += 0.1 * mesh.geometry.x[:, 0] * mesh.geometry.x[:, 2]
            yield fem.VectorFunctionSpace(mesh, ("Lagrange", degree))


def at_x(space, x):
    return dmesh.locate_entities_boundary(space.mesh, 2, lambda p: np.isclose(p[0], x))


def stiffness(u, v):
    mu, bulk = YOUNG / 2 / (1 + POISSON), YOUNG / 3 / (1 - 2 * POISSON)
    dev = lambda w: ufl.dev(ufl.sym(ufl.grad(w)))  # noqa: E731
    return (bulk * ufl.div(u) * ufl.div(v) + 2 * mu * ufl.inner(dev(u), dev(v))) * DX


def assembled(form):
    vector = fem.petsc.assemble_vector(fem.form(form))
    vector.ghostUpdate(addv=PETSc.InsertMode.ADD, mode=PETSc.ScatterMode.REVERSE)
    return vector


class Ranks(unittest.TestCase):
    def test_a_case_of_all_ranks_meets_dolfinx_own_equations(self):
        for space in spaces():
            with self.subTest(nodes=space.dofmap.dof_layout.num_dofs, cells=space.mesh.topology.index_map(3).num_ghosts):
                known = space.mesh.topology.index_map(3)
                body = kc.from_dolfinx(space, facets={"left": at_x(space, 0)},
                                       parts={"all of it": np.arange(known.size_local + known.num_ghosts)})
                self.assertEqual(len(body.points), space.dofmap.index_map.size_global if WORLD.rank == 0 else 0)
                self.assertEqual(len(body.cells), known.size_global if WORLD.rank == 0 else 0)
                case = kc.Case(body).material(YOUNG, POISSON, on="all of it").fix("left")
                sol = case.body_force((0, 0, -1.0)).solver(tolerance=1e-10).solve(comm=WORLD)
                self.assertTrue(sol.converged)
                u = fem.Function(space)
                u.x.array[:] = body.local(sol.u).ravel()
                v = ufl.TestFunction(space)
                load = ufl.inner(fem.Constant(space.mesh, (0.0, 0.0, -1.0)), v) * DX
                force, residual = assembled(load), assembled(stiffness(u, v) - load)
                held = fem.locate_dofs_topological(space, 2, at_x(space, 0))
                rows = (3 * held[:, None] + np.arange(3)).ravel()
                residual.array[rows[rows < len(residual.array)]] = 0.0
                self.assertLess(residual.norm(), 1e-7 * force.norm())
                self.assertEqual(np.abs(u.x.array[rows]).max(initial=0.0), 0.0)

    def test_products_of_own_cells_add_up(self):
        for space in spaces():
            part = kc.from_dolfinx(space, part=True)
            op = kc.Operator(part.points, part.cells, part.element, young=YOUNG, poisson=POISSON)
            u = fem.Function(space)
            u.interpolate(lambda p: np.sin(np.array([3 * p[0] + p[1], p[1] * p[2], p[0] - p[2]])))
            product = u.vector.duplicate()
            with product.localForm() as local:
                local.array[:] = op @ u.x.array
            product.ghostUpdate(addv=PETSc.InsertMode.ADD, mode=PETSc.ScatterMode.REVERSE)
            product.axpy(-1.0, assembled(stiffness(u, ufl.TestFunction(space))))
            self.assertLess(product.norm(), 1e-10 * YOUNG)

    def test_what_is_wrong_on_one_is_raised_on_all(self):
        space = next(spaces())
        with self.assertRaisesRegex(kc.InputError, rf"(rank {LAST}: )?facets\['x'\]: expected numbers"):
            kc.from_dolfinx(space, facets={"x": [10**6] if WORLD.rank == LAST else []})
        with self.assertRaisesRegex(kc.InputError, "the same names on all ranks"):
            kc.from_dolfinx(space, parts={f"of {WORLD.rank}": []})
        body = kc.from_dolfinx(space)
        with self.assertRaisesRegex(kc.InputError, "field: expected one of all"):
            body.local(np.zeros((1, 3)))
        with self.assertRaisesRegex(kc.InputError, "field: expected one of all 0 nodes|of a whole body"):
            kc.from_dolfinx(space, part=True).local(np.zeros((1, 3)))


if __name__ == "__main__":
    faulthandler.dump_traceback_later(600, exit=True)  # a hanging rank prints its stack, and the job ends
    unittest.main(verbosity=0)
