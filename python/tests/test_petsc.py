# SPDX-License-Identifier: BSD-3-Clause
"""PETSc's SNES example compared with a solve of the same case. Skipped without petsc4py."""
import importlib.util
import json
import pathlib
import subprocess
import sys
import unittest

import kacanov as kc
import numpy as np
from support import temporary_folder

EXAMPLE = pathlib.Path(__file__).resolve().parent.parent / "examples" / "petsc_snes.py"


def sorted_by_place(points, values):
    return values[np.lexsort(np.round(points.T, 9))]


@unittest.skipUnless(importlib.util.find_spec("petsc4py"), "no petsc4py")
class Newton(unittest.TestCase):
    def test_snes_comes_to_the_solvers_solution(self):
        field = temporary_folder(self) / "u.npy"
        run = subprocess.run([sys.executable, "-B", EXAMPLE, "--cells", "4", "--with-matrix", "--displacement", field],
                             capture_output=True, text=True, check=False)
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        said = json.loads(run.stdout)
        self.assertGreater(said["plastic"], 0.2)
        ours, jacobi, gamg = said["entries"]
        self.assertTrue(ours["converged"] and jacobi["converged"] and gamg["converged"])
        self.assertLess(ours["newton_steps"], 20)
        self.assertLess(3 * ours["iterations"], jacobi["iterations"])

        case = kc.Case(kc.box((4, 1, 1), (16, 4, 4), "hex8")).fix("left").body_force((0, 0, -20))
        sol = case.material(210e3, 0.3, law=kc.Logarithmic(yield_stress=250)).solver(tolerance=1e-9).solve()
        grid = np.indices((5, 5, 17)) / 4  # z, y, x as in the example
        points = np.stack([axis.ravel() for axis in grid[::-1]], axis=1)
        theirs = sorted_by_place(points, np.load(field))
        self.assertTrue(sol.converged)
        np.testing.assert_allclose(theirs, sorted_by_place(sol.points, sol.u), rtol=0, atol=1e-6 * np.abs(sol.u).max())


if __name__ == "__main__":
    unittest.main()
