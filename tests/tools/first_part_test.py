#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks the numbers of the ball on a block on the user guide's first page against a run and against Hertz.

usage: first_part_test.py PROGRAM FOLDER-OF-THE-PROJECT
"""
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(sys.argv.pop()).resolve()
PROGRAM = os.path.abspath(sys.argv.pop())
PAGE = (ROOT / "docs" / "user-guide" / "first-part.md").read_text(encoding="utf-8")
CASE = ROOT / "tools" / "examples" / "ball" / "ball.json"
PLASTIC = "material[0].plastic=[[300, 0], [500, 0.1]]"


def result(*changes):
    with tempfile.TemporaryDirectory() as folder:
        options = [word for change in changes for word in ("--set", change)]
        subprocess.run([PROGRAM, "run", CASE, "--ranks", "1", "-o", folder, "--set", "output.report=false", *options],
                       check=True, stdout=subprocess.DEVNULL, timeout=120)
        return json.loads((pathlib.Path(folder) / "result.json").read_text())


class FirstPart(unittest.TestCase):
    def test_the_case_on_the_page_is_the_example(self):
        on_page = re.search(r'```json\n(\{\n  "title".*?)```', PAGE, re.DOTALL)[1]
        self.assertEqual(json.loads(on_page), json.loads(CASE.read_text()))

    def test_hertz_by_hand_and_by_the_run(self):
        radius, force, modulus = 300.0, 1000.0, 210000 / (1 - 0.3**2)
        a = (0.75 * force * radius / modulus) ** (1 / 3)
        peak, approach = 1.5 * force / (math.pi * a**2), a**2 / radius
        run = result()
        ball = run["contact"]["ball"]
        found = math.sqrt(4 * ball["area"] / math.pi)
        rows = {"radius": (f"{a:.3f} mm", f"{found:.3f} mm"),
                "greatest pressure": (f"{peak:.1f} MPa", f"{ball['max_pressure']:.1f} MPa"),
                "greatest von Mises": (f"{0.62 * peak:.0f} MPa", f"{run['max_von_mises_nodal']:.1f} MPa"),
                "approach": (f"{approach:.5f} mm", f"{-run['probe'][0][2]:.5f} mm")}
        for name, (by_hand, by_run) in rows.items():
            row = next(line for line in PAGE.splitlines() if line.startswith("|") and name in line)
            self.assertIn(by_hand, row.split("|")[2])
            self.assertIn(by_run, row.split("|")[3])
        self.assertLess(abs(ball["max_pressure"] / peak - 1), 0.01)
        self.assertLess(abs(run["max_von_mises_nodal"] / (0.62 * peak) - 1), 0.01)
        self.assertAlmostEqual(ball["force"][2], -force / 4, delta=1e-3)
        self.assertAlmostEqual(run["reaction"]["table"]["force"][2], force / 4, delta=1e-3)

    def test_beyond_yield(self):
        self.assertEqual(result(PLASTIC)["plastic_elements"], 1)
        more = result(PLASTIC, "contact[0].force_controlled.force=500")
        elastic = result("contact[0].force_controlled.force=500")
        self.assertIn(f"pressure is {more['max_contact_pressure']:.0f} MPa in place of "
                      f"{elastic['max_contact_pressure']:.0f}", " ".join(PAGE.split()))
        self.assertGreater(-more["probe"][0][2], -elastic["probe"][0][2])
        most = result("contact[0].force_controlled.force=1000")
        self.assertEqual(most["active_nodes"], most["contact_nodes"])


if __name__ == "__main__":
    unittest.main()
