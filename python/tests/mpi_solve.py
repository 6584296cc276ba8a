# SPDX-License-Identifier: BSD-3-Clause
"""A solve on several ranks with mpi4py: mpiexec -n 2 python3 mpi_solve.py. Not run by discovery."""
import faulthandler
import os
import signal
import threading
import unittest

import kacanov as kc
import numpy as np
from mpi4py import MPI
from support import pressed_beam

WORLD = MPI.COMM_WORLD
LAST = WORLD.size - 1


class Together(unittest.TestCase):
    def test_all_ranks_solve_one_case(self):
        alone = pressed_beam().solve(threads=1)  # every rank by itself
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
        sol = pressed_beam().solver(load_steps=1000).solve(comm=WORLD, stop=lambda: WORLD.rank == LAST)
        self.assertEqual(sol.status, "interrupted")


class Raised(unittest.TestCase):
    """An exception on one rank ends the solve on all; no rank is left waiting, and they can solve again together."""

    def tearDown(self):
        self.assertEqual(WORLD.allreduce(1), WORLD.size)
        self.assertTrue(pressed_beam(cells=(4, 1, 1)).solve(comm=WORLD, threads=1).converged)

    def endless(self):
        return pressed_beam().solver(load_steps=1000)

    def assert_raised_by(self, rank, error, words):
        """Context in which the given rank raises the error, and the others report it."""
        if WORLD.rank == rank:
            return self.assertRaisesRegex(error, words)
        return self.assertRaisesRegex(kc.RankError, f"rank {rank}: .*{words}")

    def test_by_progress(self):
        def tell(step):
            if step["outer"] == 2:
                raise ValueError("enough")

        case = self.endless()
        with self.assert_raised_by(0, ValueError, "enough") as caught:
            case.solve(comm=WORLD, progress=tell)
        self.assertEqual(case.solution.status, "interrupted")
        if WORLD.rank != 0:
            self.assertEqual((caught.exception.rank, str(caught.exception)), (0, "rank 0: ValueError: enough"))

    def test_by_progress_of_the_last_step(self):
        def tell(step):
            if step["worst_residual"] < 1e-6:
                raise OSError("the disk is full")

        with self.assert_raised_by(0, OSError, "the disk is full"):
            pressed_beam().solver(tolerance=1e-6).solve(comm=WORLD, progress=tell)

    def test_by_the_question_whether_to_stop(self):
        def stop():
            if WORLD.rank == LAST:
                raise LookupError("lost")
            return False

        with self.assert_raised_by(LAST, LookupError, "lost"):
            self.endless().solve(comm=WORLD, stop=stop)

    def test_by_all_of_them(self):
        def stop():
            raise LookupError(f"lost on {WORLD.rank}")

        with self.assertRaisesRegex(LookupError, f"lost on {WORLD.rank}"):
            self.endless().solve(comm=WORLD, stop=stop)

    def test_ctrl_c_on_one(self):
        asked = threading.Event()

        def interrupt():
            asked.wait()
            os.kill(os.getpid(), signal.SIGINT)

        def stop():
            asked.set()
            return False

        if WORLD.rank == LAST:
            threading.Thread(target=interrupt).start()
        case = self.endless()
        with self.assertRaises(kc.Interrupted) as caught:
            case.solve(comm=WORLD, stop=stop)
        self.assertIs(caught.exception.solution, case.solution)
        self.assertEqual(case.solution.status, "interrupted")

    def test_ctrl_c_outdoes_other_things(self):
        def stop():
            if WORLD.rank == LAST:
                raise KeyboardInterrupt
            raise LookupError("lost")

        with self.assertRaises(kc.Interrupted if WORLD.rank == LAST else LookupError):
            self.endless().solve(comm=WORLD, stop=stop)

    def test_by_a_solve_within_a_callback(self):
        def tell(_):
            pressed_beam().solve(comm=WORLD)

        with self.assert_raised_by(0, kc.StateError, "callback"):
            self.endless().solve(comm=WORLD, progress=tell)

    def test_before_anything_is_solved(self):
        here = WORLD.rank == LAST
        with self.assert_raised_by(LAST, kc.InputError, "threads: expected"):
            pressed_beam().solve(comm=WORLD, threads=0 if here else 1)
        case = pressed_beam()
        if here:
            case.document["solver"] = {"tolerance": object()}
        with self.assert_raised_by(LAST, kc.InputError, "solver.tolerance: expected"):
            case.solve(comm=WORLD)
        with self.assert_raised_by(LAST, AttributeError, "_solved"):
            pressed_beam().solve(comm=WORLD, start="that one" if here else None)

    def test_the_case_is_the_first_ranks(self):
        sol = pressed_beam(cells=(4, 1, 1) if WORLD.rank == 0 else (8, 2, 2)).solve(comm=WORLD, threads=1)
        self.assertEqual(sol.result["mesh"]["elements"], 4)

    @unittest.skipIf(WORLD.size == 1, "one rank has the start of all")
    def test_a_start_on_one_alone(self):
        sol = pressed_beam().solve(comm=WORLD, threads=1)
        with self.assertRaisesRegex(kc.InputError, "start: expected a solution on all ranks"):
            pressed_beam().solve(comm=WORLD, start=sol if WORLD.rank == 0 else None)

    def test_no_ranks(self):
        with self.assertRaisesRegex(kc.InputError, "comm: MPI.COMM_NULL"):
            pressed_beam().solve(comm=MPI.COMM_NULL)


if __name__ == "__main__":
    faulthandler.dump_traceback_later(600, exit=True)  # a hanging rank prints its stack, and the job ends
    unittest.main(verbosity=0)
