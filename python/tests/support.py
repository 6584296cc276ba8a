# SPDX-License-Identifier: BSD-3-Clause
"""Small bodies and cases for the tests, and the program to compare with."""
import itertools
import json
import locale
import os
import pathlib
import subprocess
import tempfile

import kacanov as kc
import numpy as np

PROGRAM = os.environ.get("KACANOV_PROGRAM", "")


def pressed_beam(element="hex8", cells=(8, 2, 2), **options):
    """A cantilever pressed onto a plane, with friction and hardening."""
    case = kc.Case(kc.box((4, 1, 1), cells, element), name="beam", **options)
    case.material(young=210e3, poisson=0.3, law=kc.Logarithmic(yield_stress=25))
    case.fix("left").traction((0, 0, -20), on=kc.Box((2, 0, 1), (4, 1, 1)))
    case.contact("bottom", kc.Plane(point=(0, 0, 0), normal=(0, 0, 1)), coulomb=0.3)
    return case.probe((4, 0.5, 1))


def hexahedra(n):
    """Returns the unit cube of n³ hexahedra in Gmsh's order: points and cells."""
    grid = np.linspace(0.0, 1.0, n + 1)
    points = np.array([(x, y, z) for z in grid for y in grid for x in grid])
    number = lambda i, j, k: i + (n + 1) * (j + (n + 1) * k)  # noqa: E731
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    cells = [[number(i + a, j + b, k + c) for a, b, c in corners]
             for k, j, i in itertools.product(range(n), repeat=3)]
    return points, np.array(cells, dtype=np.int32)


def program_result(case_file, folder):
    """Returns the result.json of the program for a case on one rank."""
    run = subprocess.run([PROGRAM, "run", case_file, "--ranks", "1", "--output", folder],
                         capture_output=True, text=True, check=False)
    return run, json.loads(pathlib.Path(folder, "result.json").read_text("utf-8"))


def temporary_folder(test):
    """Returns a folder that is removed after the test."""
    folder = tempfile.TemporaryDirectory()
    test.addCleanup(folder.cleanup)
    return pathlib.Path(folder.name)


def use_german_locale(test):
    """Sets a German locale until the test ends, the system's or one made by localedef; else skips the test."""
    name, folder = "de_DE.UTF-8", temporary_folder(test)
    test.addCleanup(locale.setlocale, locale.LC_ALL, locale.setlocale(locale.LC_ALL))
    try:
        locale.setlocale(locale.LC_ALL, name)
        return
    except locale.Error:
        pass
    try:
        subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", folder / name], capture_output=True, check=True)
        test.addCleanup(os.environ.pop, "LOCPATH", None)
        os.environ["LOCPATH"] = str(folder)
        locale.setlocale(locale.LC_ALL, name)
    except (OSError, subprocess.CalledProcessError, locale.Error) as error:
        test.skipTest(f"there is no {name}, and none can be made: {error}")
