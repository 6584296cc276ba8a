#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The presets of the solver reach the default's answer: every element, dimension and friction, and on ranks.

usage: presets_test.py PROGRAM FOLDER-OF-THE-PROJECT
"""
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(sys.argv.pop()).resolve()
PROGRAM = sys.argv.pop()
EXAMPLES = ROOT / "tools" / "examples"
FRICTIONS = {"none": None, "tresca": {"tresca": 0.005}, "coulomb": {"coulomb": 0.2}}
AGREE = 1e-5
KEYS = {"outer": "kacanov", "contact": "admm", "r": "paper", "preconditioner": "elasticity"}
SMALL = ["solver.tolerance=1e-7", "mesh.box.cells=[8,2]"]


def box(element):
    """Returns the example with a coarse mesh of the element, and its changes."""
    flat = element in ("tri3", "quad4")
    cells = "[8,2]" if flat else "[4,2,2]" if element == "tet4" else "[3,1,1]" if element == "tet10" else "[4,1,1]"
    return f"beam{2 if flat else 3}d.json", [f"mesh.box.element={element}", f"mesh.box.cells={cells}"]


def start(folder, case, changes, *options):
    sets = [word for change in changes for word in ("--set", change)]
    return subprocess.run(
        [PROGRAM, options[0], str(EXAMPLES / case), *sets, *options[1:]],
        cwd=folder, capture_output=True, text=True, timeout=600)


def distance(a, b):
    """Returns the largest difference of two lists, relative to the largest entry of the first."""
    return max(map(abs, (x - y for x, y in zip(a, b)))) / max(max(map(abs, a)), 1e-300)


class Presets(unittest.TestCase):
    def setUp(self):
        self.place = tempfile.TemporaryDirectory()
        self.addCleanup(self.place.cleanup)

    def run_case(self, case, changes, preset, ranks=1):
        out = pathlib.Path(self.place.name) / f"{preset}{ranks}"
        done = start(self.place.name, case, [*changes, "output.fields=none", "output.checkpoint=false"], "run",
                     "--preset", preset, "--ranks", str(ranks), "--output", str(out))
        self.assertEqual(done.returncode, 0, f"{case} {changes} {preset}: {done.stdout[-600:]} {done.stderr}")
        return json.loads((out / "result.json").read_text(encoding="utf-8")), done.stdout

    def agree(self, case, changes, preset="paper", ranks=1, standard=None):
        standard = standard or self.run_case(case, changes, "default")[0]
        result = self.run_case(case, changes, preset, ranks)[0]
        self.assertGreater(result["r_star"], 0.0)
        for key in ("probe", "contact_force"):
            flat = [sum(r[key], []) if key == "probe" else r[key] for r in (standard, result)]
            self.assertLess(distance(*flat), AGREE, f"{case} {changes} {preset}: {key}")
        # Relative to all forces of contact: friction may be at rounding level.
        size = math.hypot(*standard["contact_force"])
        for a, b in zip(standard["friction_force"], result["friction_force"]):
            self.assertLess(abs(a - b), AGREE * size, f"{case} {changes} {preset}: friction_force")
        return standard

    def test_elements_and_friction(self):
        for element in ("tri3", "quad4", "tet4", "tet10", "hex8"):
            case, mesh = box(element)
            for name, friction in FRICTIONS.items():
                with self.subTest(element=element, friction=name):
                    changes = [*mesh, "solver.tolerance=1e-7"]
                    changes += ["contact[0].friction=" + json.dumps(friction)] if friction else []
                    if not friction and case == "beam3d.json":
                        changes.append('contact[0]={"on": "bottom", "obstacle": {"plane": '
                                       '{"point": [0, 0, 0], "normal": [0, 0, 1]}}}')
                    standard = self.agree(case, changes)
                    self.agree(case, changes, "dual", standard=standard)

    def test_formulations(self):
        for element in ("tri3", "quad4", "tet4", "tet10", "hex8"):
            case, mesh = box(element)
            for formulation in ("displacement", "mixed"):
                if element == "tri3" and formulation == "mixed":
                    continue
                with self.subTest(element=element, formulation=formulation):
                    self.agree(case, [*mesh, "solver.tolerance=1e-7", f"material[0].formulation={formulation}"])

    def test_planes(self):
        for plane in ("stress", "axisymmetric"):
            with self.subTest(plane=plane):
                self.agree("beam2d.json", [*SMALL, "plane=" + plane] + (
                    ["boundary[0].displacement=[0, null]", "material[0].law.x0=1"] if plane != "stress" else []))

    def test_examples(self):
        for case in ("rocker.json", "rocker_tresca.json", "bracket/bracket.json"):
            with self.subTest(case=case):
                self.agree(case, ["solver.tolerance=2e-7"])

    def test_ranks(self):
        # Twice the elements across: four ranks need work each.
        for case, changes in (box("tri3"), box("tet4")):
            changes = [*changes, "material[0].law={\"type\": \"linear\"}"]
            for ranks in (2, 4):
                with self.subTest(case=case, ranks=ranks):
                    self.agree(case, changes, ranks=ranks)

    def test_a_step_of_the_paper_stops(self):
        result, _ = self.run_case("beam2d.json", ["mesh.box.cells=[8,2]", "solver.stop=paper", "solver.tolerance=1e-8"],
                                  "paper")
        self.assertEqual(result["case"]["solver"]["preset"], "paper")

    def test_what_a_preset_stands_for_is_shown(self):
        changes = [*SMALL, "solver.r=0.5"]
        check = start(self.place.name, "beam2d.json", changes, "check", "--preset", "paper")
        self.assertEqual(check.returncode, 0, check.stderr)
        _, run = self.run_case("beam2d.json", changes, "paper")
        for text in (check.stdout, run):
            words = " ".join(text.split())
            for key, value in KEYS.items():
                self.assertIn("r 0.5 (not paper)" if key == "r" else f"{key} {value}", words)

    def test_refusals_name_the_preset(self):
        done = start(self.place.name, "beam2d.json", ["solver.outer=newton"], "check", "--preset", "paper")
        self.assertEqual(done.returncode, 2)
        for word in ("solver.outer", "solver.preset is paper", "contact admm"):
            self.assertIn(word, done.stderr)
        done = start(self.place.name, "beam2d.json", ["solver.preset=papr"], "check")
        self.assertEqual(done.returncode, 2)
        self.assertIn("solver.preset", done.stderr)


if __name__ == "__main__":
    unittest.main()
