# SPDX-License-Identifier: BSD-3-Clause
"""The operator from numpy: against its own matrix and differences, with scipy and petsc4py if available, and rejected
input."""
import importlib.util
import pathlib
import subprocess
import sys
import threading
import unittest

import kacanov as kc
import numpy as np
from support import hexahedra

LAW = kc.Material(young=1.0, poisson=0.3, law=kc.Logarithmic(x0=0.01))


def have(module):
    return importlib.util.find_spec(module) is not None


class Products(unittest.TestCase):
    def setUp(self):
        self.points, self.cells = hexahedra(3)
        self.op = kc.Operator(self.points, self.cells, "hex8", law=LAW)
        rng = np.random.default_rng(1)
        self.u = 0.02 * rng.standard_normal(self.points.shape)
        self.x, self.y = rng.standard_normal((2, self.op.shape[0]))

    def test_rigid_motions_cost_nothing(self):
        turned = np.cross(self.points, (1.0, 2.0, 3.0))
        self.assertLess(np.abs(self.op @ turned).max(), 1e-13)
        self.assertEqual((self.op @ turned).shape, self.points.shape)

    def test_what_a_square_is_of(self):
        points, cells = np.array([[1.0, 0], [2, 0], [2, 1], [1, 1]]), np.array([[0, 1, 2, 3]], dtype=np.int32)
        pulled = np.array([[0.0, 0], [0.01, 0], [0.01, 0], [0, 0]])

        def force(plane):
            return (kc.Operator(points, cells, "quad4", young=200, poisson=0.3, plane=plane) @ pulled)[1:3, 0].sum()

        self.assertAlmostEqual(force("strain"), 200 * 0.7 / (1.3 * 0.4) * 0.01, places=12)
        self.assertAlmostEqual(force("stress"), 200 / 0.91 * 0.01, places=12)
        self.assertGreater(force("axisymmetric"), 2 * np.pi * 1.5 * force("strain"))
        with self.assertRaisesRegex(kc.InputError, "plane: expected"):
            force("flat")

    def test_symmetry(self):
        self.op.update(self.u)
        self.assertAlmostEqual(self.y @ (self.op @ self.x), self.x @ (self.op @ self.y), places=11)

    @unittest.skipUnless(have("scipy"), "no scipy")
    def test_products_are_those_of_the_matrix(self):
        self.op.update(self.u)
        matrix = self.op.matrix()
        np.testing.assert_allclose(self.op @ self.x, matrix @ self.x, rtol=0, atol=1e-12)
        np.testing.assert_allclose(self.op.diagonal(), matrix.diagonal(), rtol=1e-12)
        both = np.stack([self.x, self.y], axis=1)
        np.testing.assert_allclose(self.op @ both, matrix @ both, rtol=0, atol=1e-12)
        tangent = self.op.tangent(self.u)
        np.testing.assert_allclose(tangent @ self.x, self.op.matrix(self.u) @ self.x, rtol=0, atol=1e-6)

    def test_residual_is_the_slope_of_the_energy_and_the_tangent_that_of_the_residual(self):
        direction = self.x.reshape(self.points.shape)
        step = 1e-6
        ahead, behind = self.u + step * direction, self.u - step * direction
        slope = (self.op.energy(ahead) - self.op.energy(behind)) / (2 * step)
        self.assertAlmostEqual(slope / np.vdot(self.op.residual(self.u), direction), 1.0, places=6)
        slopes = (self.op.residual(ahead) - self.op.residual(behind)) / (2 * step)
        product = self.op.tangent(self.u) @ direction
        self.assertLess(np.abs(product - slopes).max(), 1e-5 * np.abs(slopes).max())

    def test_the_secant_at_a_displacement_gives_its_residual(self):
        self.op.update(self.u)
        np.testing.assert_allclose(self.op @ self.u, self.op.residual(self.u), rtol=0, atol=1e-13)
        g = self.op.secant
        self.op.secant = 2 * g
        self.op.secant = g
        np.testing.assert_allclose(self.op @ self.u, self.op.residual(self.u), rtol=0, atol=1e-13)

    def test_nothing_is_copied(self):
        out = np.empty_like(self.x)
        self.assertIs(self.op.matvec(self.x, out), out)
        np.testing.assert_array_equal(out, self.op @ self.x)

    def test_what_is_only_read_may_be_protected(self):
        for array in (self.points, self.cells, self.u, self.x):
            array.flags.writeable = False
        op = kc.Operator(self.points, self.cells, "hex8", law=LAW)
        op.update(self.u)
        op.stress(self.u), op.energy(self.u), op.tangent(self.u) @ self.x
        np.testing.assert_array_equal(op @ self.x, self.op_at(self.u) @ self.x)
        np.testing.assert_array_equal(op.residual(self.u), self.op.residual(self.u))
        if have("scipy"):
            self.assertEqual(op.matrix(self.u).nnz, op.matrix().nnz)

    def op_at(self, u):
        self.op.update(u)
        return self.op

    def test_arrays_in_fortrans_order_and_in_vtks(self):
        columns = kc.Operator(np.asfortranarray(self.points), self.cells, "hex8", law=LAW)
        np.testing.assert_allclose(columns @ self.x, self.op @ self.x, rtol=0, atol=1e-14)
        corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
        edges = [(0, 1), (1, 2), (2, 0), (3, 0), (2, 3), (1, 3)]  # Gmsh's
        points = np.array([*corners, *(corners[[a, b]].mean(axis=0) for a, b in edges)])
        gmsh = np.arange(10, dtype=np.int32)[None, :]
        x = np.random.default_rng(2).standard_normal(points.shape)
        ours = kc.Operator(points, gmsh, "tet10", law=LAW) @ x
        vtk = np.ascontiguousarray(gmsh[:, [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]])
        np.testing.assert_array_equal(kc.Operator(points, vtk, "tet10", order="vtk", law=LAW) @ x, ours)

    def test_single_precision(self):
        op = kc.Operator(self.points, self.cells, "hex8", law=LAW, single=True)
        product = op @ self.x.astype(np.float32)
        self.assertEqual(product.dtype, np.float32)
        np.testing.assert_allclose(product, op @ self.x, rtol=0, atol=1e-5)

    def test_stress_of_uniform_strain(self):
        fields = self.op.stress(np.ascontiguousarray(1e-3 * self.points * (1.0, 0.0, 0.0)))
        expected = 1e-3 / (1.3 * 0.4) * np.array([0.7, 0.3, 0.3, 0, 0, 0])
        np.testing.assert_allclose(fields["stress"], np.tile(expected, (27, 1)), rtol=0, atol=1e-15)
        self.assertFalse(fields["plastic"].any())


class Solves(unittest.TestCase):
    def setUp(self):
        self.points, cells = hexahedra(6)
        self.op = kc.Operator(self.points, cells, "hex8", law=LAW, threads=2)
        self.held = np.repeat(self.points[:, 2] == 0.0, 3)
        self.op.constrain(self.held)
        self.b = np.where(self.held, 0.0, np.random.default_rng(3).standard_normal(self.op.shape[0]))

    def solved(self, x):
        return np.linalg.norm(self.op @ x - self.b) / np.linalg.norm(self.b)

    def test_multigrid_saves_iterations(self):
        multigrid = self.op.multigrid()
        x, with_it = self.op.cg(self.b, M=multigrid)
        self.assertTrue(with_it.converged)
        self.assertLess(self.solved(x), 1e-7)
        _, without = self.op.cg(self.b)
        self.assertLess(2 * with_it.iterations, without.iterations)
        self.assertGreater(multigrid.bytes, 0)

    def test_a_tangent_is_solved_with_the_multigrid_of_its_secant(self):
        u = np.where(self.held, 0.0, 0.002 * self.b).reshape(-1, 3)
        multigrid = self.op.multigrid()
        tangent = self.op.tangent(u)
        multigrid.update()
        x, result = tangent.cg(self.b, M=multigrid)
        self.assertTrue(result.converged)
        self.assertLess(np.linalg.norm(tangent @ x - self.b), 1e-7 * np.linalg.norm(self.b))
        self.op.tangent(0 * u)
        with self.assertRaisesRegex(kc.StateError, "stale"):
            tangent @ x

    def test_penalties_hold_instead_of_constraints(self):
        self.op.constrain([])
        nodes = np.flatnonzero(self.points[:, 2] == 0.0).astype(np.int32)
        self.op.set_blocks(nodes, np.tile(1e3 * np.eye(3), (len(nodes), 1, 1)))
        x, result = self.op.cg(self.b, M=self.op.multigrid())
        self.assertTrue(result.converged)
        self.assertLess(np.abs(x[self.held]).max(), 0.05)

    @unittest.skipUnless(have("scipy"), "no scipy")
    def test_scipy_takes_both_as_they_are(self):
        from scipy.sparse.linalg import cg
        x, code = cg(self.op, self.b, M=self.op.multigrid(), tol=1e-9, atol=0.0)
        self.assertEqual(code, 0)
        self.assertLess(self.solved(x), 1e-8)

    @unittest.skipUnless(have("petsc4py"), "no petsc4py")
    def test_petsc_takes_both(self):
        from petsc4py import PETSc
        mat = self.op.petsc_mat()
        ksp = PETSc.KSP().create(PETSc.COMM_SELF)
        ksp.setOperators(mat)
        ksp.setType("cg")
        ksp.setPC(self.op.petsc_pc())
        ksp.setTolerances(rtol=1e-9)
        x, b = mat.createVecs()
        b.setArray(self.b)
        ksp.solve(b, x)
        self.assertGreater(ksp.getConvergedReason(), 0)
        self.assertLess(self.solved(x.getArray()), 1e-7)
        self.assertLess(ksp.getIterationNumber(), 25)


    @unittest.skipUnless(have("petsc4py"), "no petsc4py")
    def test_a_program_ends_well_that_keeps_petscs_objects_to_its_end(self):
        program = "from support import *; from petsc4py import PETSc; points, cells = hexahedra(2); " \
                  "op = kc.Operator(points, cells, 'hex8', young=1.0, poisson=0.3); op.constrain(np.arange(9)); " \
                  "mat = op.petsc_mat(); pc = op.petsc_pc(); ksp = PETSc.KSP().create(PETSc.COMM_SELF); ksp.setPC(pc); " \
                  "pressed_beam().solve()"
        run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False,
                             cwd=pathlib.Path(__file__).parent)
        self.assertEqual((run.returncode, run.stderr), (0, ""))


class Refusals(unittest.TestCase):
    def setUp(self):
        self.points, self.cells = hexahedra(2)
        self.op = kc.Operator(self.points, self.cells, "hex8", law=LAW)

    def refused(self, error, words, *arguments, **options):
        with self.assertRaisesRegex(error, words):
            kc.Operator(*arguments, **options)

    def test_arrays_of_another_kind(self):
        n = self.op.shape[0]
        with self.assertRaisesRegex(TypeError, r"x: expected a C-contiguous float64 array of shape \(81,\).*got list"):
            self.op @ [0.0] * n
        with self.assertRaisesRegex(TypeError, r"got float32 of shape \(81,\)"):
            self.op @ np.zeros(n, dtype=np.float32)
        with self.assertRaisesRegex(kc.InputError, r"got float64 of shape \(80,\)"):
            self.op @ np.zeros(n - 1)
        with self.assertRaisesRegex(kc.InputError, "not C-contiguous"):
            self.op @ np.zeros(2 * n)[::2]
        fixed = np.zeros(n)
        fixed.flags.writeable = False
        with self.assertRaisesRegex(kc.InputError, "out: expected a writable"):
            self.op.matvec(np.zeros(n), fixed)
        with self.assertRaises(TypeError):
            self.op @ np.zeros(n, dtype=">f8")

    def test_bodies(self):
        self.refused(kc.InputError, "element: expected .*hex8.*got \"hex9\"", self.points, self.cells, "hex9", law=LAW)
        self.refused(TypeError, "cells: expected a int32 array .*got int64", self.points, self.cells.astype(int), "hex8", law=LAW)
        self.refused(kc.InputError, r"cells: .*\(any, 4\)", self.points, self.cells, "tet4", law=LAW)
        self.refused(kc.InputError, "connectivity", self.points, self.cells + 5, "hex8", law=LAW)
        self.refused(kc.InputError, "node_order", self.points, self.cells, "hex8", order="abaqus", law=LAW)
        broken = self.points.copy()
        broken[3, 1] = np.nan
        self.refused(kc.InputError, "not finite", broken, self.cells, "hex8", law=LAW)

    def test_laws(self):
        here = (self.points, self.cells, "hex8")
        self.refused(kc.InputError, r"law\[0\].young: expected a number > 0.*got -1", *here, young=-1.0, poisson=0.3)
        self.refused(kc.InputError, r"law\[0\].law.*x0", *here, young=1.0, poisson=0.3, law=kc.Logarithmic())
        self.refused(kc.InputError, r"law\[0\].young: expected a finite number", *here, young=np.inf, poisson=0.3)
        self.refused(kc.InputError, "law: expected a Material", *here)
        self.refused(kc.InputError, "there is no law 1", *here, law=[LAW], law_of_element=np.ones(8, dtype=np.uint16))

    def test_codes_are_kept(self):
        with self.assertRaises(kc.InputError) as caught:
            self.op.update(np.full(self.op.shape[0], np.nan))
        self.assertEqual(caught.exception.code, 5)
        with self.assertRaisesRegex(kc.InputError, "unknowns: expected numbers from 0 to 80"):
            self.op.constrain([81])
        self.op.constrain(np.arange(9))
        with self.assertRaisesRegex(kc.InputError, "M: expected a multigrid of this operator"):
            self.op.cg(np.zeros(81), M=kc.Operator(self.points, self.cells, "hex8", law=LAW).multigrid())

    def test_a_second_thread_is_refused_or_waits_its_turn(self):
        points, cells = hexahedra(24)
        op = kc.Operator(points, cells, "hex8", law=LAW)
        x = np.ones(op.shape[0])
        right, outcomes = op @ x, []

        def work():
            for _ in range(20):
                try:
                    outcomes.append(bool(np.array_equal(op @ x, right)))
                except kc.StateError as error:
                    outcomes.append("in use" in str(error))

        threads = [threading.Thread(target=work) for _ in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(outcomes, [True] * 40)


if __name__ == "__main__":
    unittest.main()
