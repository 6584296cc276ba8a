# SPDX-License-Identifier: BSD-3-Clause
"""Fields of load steps: compared with runs that end there, and those of a run that does not reach its end."""
import unittest

import kacanov as kc
import numpy as np
from support import pressed_beam


def yielding_beam(law=kc.Logarithmic(yield_stress=5), **options):
    return pressed_beam().set("material[0].law", law).solver(**options)


class Steps(unittest.TestCase):
    def same(self, step, sol):
        for name in ("u", "stress", "von_mises", "dev_strain", "g", "plastic"):
            np.testing.assert_array_equal(getattr(step, name), getattr(sol, name), name)
        self.assertEqual(step.contact.keys(), sol.contact.keys())
        for name, values in sol.contact.items():
            np.testing.assert_array_equal(step.contact[name], values, name)

    def test_each_is_the_end_of_a_run_to_there(self):
        def solved(steps):
            case = yielding_beam().set("boundary[1].name", "press").set("material[0].expansion", 1e-5)
            case.temperature({"gradient": [0, 0, 3]}, name="warmth")
            for time, factor in steps:
                case.step(time, {"press": factor, "warmth": factor})
            return case.solve(threads=1)

        way = [(0.5, 0.4), (2.0, 1.0), (3.0, 0.25)]
        sol = solved(way)
        self.assertEqual([step.factor for step in sol.steps], [0.5, 2.0, 3.0])
        for number, step in enumerate(sol.steps, 1):
            self.assertEqual(step.result, sol.result["load_steps"][number - 1])
            self.assertFalse(step.u.flags.writeable)
            self.same(step, solved(way[:number]))
        self.assertTrue(sol.steps[1].plastic.sum() > sol.steps[0].plastic.sum() > 0)

    def test_fields_outlive_the_solution(self):
        sol = yielding_beam(load_steps=3).solve()
        step, u = sol.steps[0], sol.steps[1].u
        kept = u.copy()
        del sol
        np.testing.assert_array_equal(u, kept)
        self.assertEqual(step.plastic.sum(), step.result["plastic_elements"])

    def test_obstacles_that_move(self):
        case = yielding_beam(load_steps=4)
        sol = case.set("contact[0].motion", {"path": [{"time": 1, "translation": [0.1, 0, 0.05]}]}).solve()
        self.assertEqual([step.factor for step in sol.steps], [0.25, 0.5, 0.75, 1.0])
        for step in sol.steps:
            self.assertAlmostEqual(step.contact["pressure"].max() / step.result["max_contact_pressure"], 1.0, places=12)
            self.assertEqual(step.plastic.sum(), step.result["plastic_elements"])
        self.same(sol.steps[-1], sol)

    def test_where_there_are_none(self):
        for case in (yielding_beam(), yielding_beam(load_steps=2).set("output.steps", False)):
            sol = case.solve()
            self.assertEqual([step.factor for step in sol.steps], [1.0])
            self.same(sol.steps[0], sol)

    def test_a_run_that_does_not_converge(self):
        sol = yielding_beam(kc.LinearHardening(yield_stress=5, gamma=1e-3), load_steps=[0.01, 0.5, 1], max_outer=6).solve()
        self.assertFalse(sol.converged)
        self.assertEqual([step.factor for step in sol.steps], [0.01, 0.5])
        self.same(sol.steps[-1], sol)

    def test_a_run_that_is_stopped_on_its_way(self):
        case = yielding_beam(load_steps=[0.01, 0.5, 1])
        first = case.solve().steps[0].result["outer_iterations"]
        seen = []

        def progress(line):
            seen.append(line["outer"])
            if len(seen) == first + 1:
                raise LookupError

        with self.assertRaises(LookupError):
            case.solve(progress=progress)
        sol = case.solution
        self.assertEqual(sol.status, "interrupted")
        self.assertEqual([(step.factor, bool(step.result)) for step in sol.steps], [(0.01, True), (0.5, False)])
        self.same(sol.steps[-1], sol)


if __name__ == "__main__":
    unittest.main()
