# SPDX-License-Identifier: BSD-3-Clause
"""Function spaces of DOLFINx as bodies: its own matrix against our operator. Skipped without DOLFINx."""
import importlib.util
import unittest

import kacanov as kc
import numpy as np

YOUNG, POISSON = 210e3, 0.3


def box(cell, degree, cells=(3, 2, 2), mirrored=False):
    mesh = dmesh.create_box(MPI.COMM_SELF, [np.zeros(3), np.array([4.0, 1, 1])], cells, cell)
    mesh.geometry.x[:, 1] += 0.1 * mesh.geometry.x[:, 0] * mesh.geometry.x[:, 2]
    if mirrored:
        mesh.geometry.x[:, 2] *= -1
    return fem.VectorFunctionSpace(mesh, ("Lagrange", degree))


def at_x(space, x):
    return dmesh.locate_entities_boundary(space.mesh, 2, lambda p: np.isclose(p[0], x))


@unittest.skipUnless(importlib.util.find_spec("dolfinx"), "DOLFINx is not there")
class Spaces(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        """Imports late: it starts MPI, and some other tests need a process without MPI."""
        global dmesh, fem, MPI, ufl
        import dolfinx.fem.petsc
        import ufl
        from dolfinx import fem
        from dolfinx import mesh as dmesh
        from mpi4py import MPI

    def test_the_matrix_is_that_of_dolfinx(self):
        for mirrored in (False, True):
            with self.subTest(mirrored=mirrored):
                self.compare_matrix(box(dmesh.CellType.tetrahedron, 2, mirrored=mirrored))

    def compare_matrix(self, space):
        mu, bulk = YOUNG / 2 / (1 + POISSON), YOUNG / 3 / (1 - 2 * POISSON)
        u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
        dev = lambda w: ufl.dev(ufl.sym(ufl.grad(w)))  # noqa: E731
        form = (bulk * ufl.div(u) * ufl.div(v) + 2 * mu * ufl.inner(dev(u), dev(v))) * ufl.dx
        theirs = fem.petsc.assemble_matrix(fem.form(form))
        theirs.assemble()
        mesh = kc.from_dolfinx(space)
        self.assertEqual(mesh.element, "tet10")
        op = kc.Operator(mesh.points, mesh.cells, mesh.element, young=YOUNG, poisson=POISSON)
        x = np.random.default_rng(1).standard_normal(op.shape[0])
        into, out = theirs.createVecs()
        into.array[:] = x
        theirs.mult(into, out)
        right = out.array
        np.testing.assert_allclose(op @ x, right, rtol=0, atol=1e-11 * np.abs(right).max())

    def test_a_field_is_the_same_there_and_here(self):
        for cell, degree, element, mirrored in (
                (dmesh.CellType.tetrahedron, 1, "tet4", False), (dmesh.CellType.hexahedron, 1, "hex8", False),
                (dmesh.CellType.tetrahedron, 2, "tet10", False), (dmesh.CellType.hexahedron, 1, "hex8", True)):
            with self.subTest(element=element, mirrored=mirrored):
                space = box(cell, degree, mirrored=mirrored)
                mesh = kc.from_dolfinx(space, facets={"ends": np.concatenate([at_x(space, 0), at_x(space, 4)])},
                                       parts={"all of it": np.arange(space.mesh.topology.index_map(3).size_local)})
                self.assertEqual(mesh.element, element)
                case = kc.Case(mesh).material(YOUNG, POISSON, on="all of it")
                case.fix("ends").body_force((0, 0, -1.0), on="all of it")
                sol = case.solve(threads=1)
                self.assertTrue(sol.converged)
                field = fem.Function(space)
                field.x.array[:] = sol.u.ravel()
                held = fem.locate_dofs_topological(space, 2, np.concatenate([at_x(space, 0), at_x(space, 4)]))
                np.testing.assert_array_equal(sol.u[held], 0)
                self.assertGreater(np.count_nonzero(sol.u), 0)
                np.testing.assert_allclose(sol.points, space.tabulate_dof_coordinates(), atol=1e-14)

    def test_what_is_not_a_body_is_refused(self):
        mesh = dmesh.create_unit_square(MPI.COMM_SELF, 2, 2)
        for space, words in ((fem.VectorFunctionSpace(mesh, ("Lagrange", 2)), "got 6 nodes a triangle"),
                             (fem.FunctionSpace(mesh, ("Lagrange", 1)), "expected 2 components, got 1"),
                             (fem.VectorFunctionSpace(mesh, ("DG", 1)), "continuous")):
            with self.assertRaisesRegex(kc.InputError, words):
                kc.from_dolfinx(space)
        with self.assertRaisesRegex(kc.InputError, "facets\\['x'\\]"):
            kc.from_dolfinx(fem.VectorFunctionSpace(mesh, ("Lagrange", 1)), facets={"x": [99]})


if __name__ == "__main__":
    unittest.main()
