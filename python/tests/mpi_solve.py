# SPDX-License-Identifier: BSD-3-Clause
"""A solve of several ranks through mpi4py: mpiexec -n 2 python3 mpi_solve.py. Not a part of discovery: it needs mpiexec."""
import unittest

import kacanov as kc
import numpy as np
from mpi4py import MPI
from support import pressed_beam

WORLD = MPI.COMM_WORLD


class Together(unittest.TestCase):
    def test_all_ranks_solve_one_case(self):
        alone = pressed_beam().solve(threads=1)  # every rank its own
        sol = pressed_beam().solve(threads=1, comm=WORLD)
        self.assertEqual((alone.result["ranks"], sol.result["ranks"]), (1, WORLD.size))
        self.assertTrue(sol.converged)
        np.testing.assert_allclose(sol.contact_force, alone.contact_force, rtol=1e-4)
        on = pressed_beam(cells=(12, 3, 3)).solve(threads=1, comm=WORLD, start=sol)
        self.assertTrue(on.converged)
        if WORLD.rank == 0:
            np.testing.assert_allclose(sol.u, alone.u, rtol=0, atol=1e-5 * np.abs(alone.u).max())
            self.assertEqual(sol.stress.shape, (32, 6))
        else:
            self.assertEqual(len(sol.u), 0)

    def test_warmth_of_all_ranks_is_taken_off(self):
        case = kc.Case(kc.box((2, 1, 1), (4, 2, 2), "hex8")).material(210e3, 0.3, expansion=1e-5).temperature(100)
        sol = case.fix("all").solve(comm=WORLD)
        if WORLD.rank == 0:
            np.testing.assert_allclose(sol.stress[:, :3], -210e3 * 1e-3 / 0.4, rtol=1e-12)

    def test_steps_are_the_first_ranks(self):
        alone, sol = (pressed_beam().solver(load_steps=2).solve(threads=1, **comm) for comm in ({}, {"comm": WORLD}))
        self.assertEqual([step.factor for step in sol.steps], [0.5, 1.0])
        step, same = sol.steps[0], alone.steps[0]
        if WORLD.rank == 0:
            np.testing.assert_allclose(step.u, same.u, rtol=0, atol=1e-5 * np.abs(same.u).max())
            np.testing.assert_allclose(step.stress, same.stress, rtol=0, atol=1e-4 * np.abs(same.stress).max())
            self.assertEqual(step.contact["pressure"].shape, same.contact["pressure"].shape)
        else:
            self.assertEqual(len(step.u), 0)

    def test_what_is_wrong_is_raised_on_all(self):
        with self.assertRaisesRegex(kc.InputError, r"boundary\[2\].on: .*lid"):
            pressed_beam().pressure(1.0, "lid").solve(comm=WORLD)

    def test_one_that_wants_to_stop_stops_all(self):
        sol = pressed_beam().solver(load_steps=1000).solve(comm=WORLD, stop=lambda: WORLD.rank == WORLD.size - 1)
        self.assertEqual(sol.status, "interrupted")


if __name__ == "__main__":
    unittest.main(verbosity=0)
