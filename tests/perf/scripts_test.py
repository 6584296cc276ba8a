#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests the scripts of perf/ on made-up results.

usage: scripts_test.py ROOT
"""
import json
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

ROOT = pathlib.Path(sys.argv.pop(1))


def entry(**changes):
    return {"element": "tet4", "mesh": "box", "form": "apply", "unknowns": 1000, "precision": "double", "threads": 2,
            "unknowns_per_second": 1e8, "share_of_triad": 0.2, "share_of_fma_peak": 0.5, **changes}


def result(*entries):
    return {"triad_bytes_per_second": [1e10, 2e10], "fma_flops_per_second": [5e10, 1e11], "entries": list(entries)}


def run(name, *arguments, text=None):
    return subprocess.run([sys.executable, ROOT / name, *map(str, arguments)], input=text, text=True,
                          capture_output=True, check=False)


class Compare(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def build(self, name, entries_of_run):
        """Returns a build whose benchmark prints the n-th given result in its n-th run."""
        build = pathlib.Path(self.folder.name) / name
        (build / "perf").mkdir(parents=True)
        (build / "runs").write_text(json.dumps([result(*entries) for entries in entries_of_run]))
        bench = build / "perf" / "bench_operator"
        bench.write_text(f"""#!{sys.executable}
import json, pathlib, sys
assert "--json" in sys.argv
runs = pathlib.Path({str(build / 'runs')!r})
first, *rest = json.loads(runs.read_text())
runs.write_text(json.dumps(rest))
print(json.dumps(first))
""")
        bench.chmod(0o755)
        return build

    def compare(self, factor, noise, rounds=10):
        """Returns the verdict for speeds that drift together by half, scatter by `noise` and differ by `factor`."""
        rng = random.Random(4)
        drift = [1.5 if i > rounds / 2 else 1.0 for i in range(rounds)]
        speeds = [[[entry(unknowns_per_second=1e8 * f * d * (1 + noise * rng.uniform(-1, 1)))] for d in drift]
                  for f in (1.0, factor)]
        done = run("perf/compare_builds", self.build("old", speeds[0]), self.build("new", speeds[1]), "--rounds", rounds, "--json")
        self.assertIn(done.returncode, (0, 1), done.stderr)
        (only,) = json.loads(done.stdout).values()
        self.assertEqual(done.returncode, 1 if only["verdict"] == "worse" else 0)
        self.assertLessEqual(only["low"], only["ratio"])
        self.assertLessEqual(only["ratio"], only["high"])
        return only

    def test_faster_is_better_in_spite_of_drift(self):
        got = self.compare(1.1, 0.02)
        self.assertEqual(got["verdict"], "better")
        self.assertAlmostEqual(got["ratio"], 1.1, delta=0.03)

    def test_slower_is_worse(self):
        self.assertEqual(self.compare(0.9, 0.02)["verdict"], "worse")

    def test_noise_is_noise(self):
        self.assertEqual(self.compare(1.0, 0.1)["verdict"], "within noise")

    def test_what_is_certain_but_tiny_does_not_matter(self):
        self.assertEqual(self.compare(1.005, 0.0)["verdict"], "within noise")

    def test_nothing_in_common(self):
        old = self.build("old", [[entry()]] * 6)
        new = self.build("new", [[entry(element="hex8")]] * 6)
        done = run("perf/compare_builds", old, new, "--rounds", 6)
        self.assertEqual(done.returncode, 2)
        self.assertIn("in common", done.stderr)

    def test_missing_build_and_too_few_rounds(self):
        self.assertEqual(run("perf/compare_builds", "nowhere", "nowhere").returncode, 2)
        self.assertEqual(run("perf/compare_builds", "nowhere", "nowhere", "--rounds", 5).returncode, 2)


class Roofline(unittest.TestCase):
    def test_every_entry_wanted_is_drawn(self):
        entries = [entry(), entry(precision="float"), entry(form="csr"), entry(form="tangent"), entry(threads=1)]
        done = run("perf/roofline", text=json.dumps(result(*entries)))
        self.assertEqual(done.returncode, 0, done.stderr)
        picture = xml.etree.ElementTree.fromstring(done.stdout)
        titles = [t.text for t in picture.iter("{http://www.w3.org/2000/svg}title")]
        self.assertEqual(len(titles), 3)
        self.assertTrue(any(t.startswith("tet4 csr box") for t in titles), titles)
        everything = run("perf/roofline", "--form", "all", text=json.dumps(result(*entries)))
        self.assertEqual(everything.stdout.count("<title>"), 4)

    def test_a_point_on_the_roof_lies_on_the_roof(self):
        # At the peak and at the ridge's intensity, the marker lies where the two parts of the roof meet.
        done = run("perf/roofline", text=json.dumps(result(entry(share_of_triad=1.0, share_of_fma_peak=1.0))))
        picture = xml.etree.ElementTree.fromstring(done.stdout)
        marker = next(picture.iter("{http://www.w3.org/2000/svg}circle"))
        roof = [x for x in picture.iter("{http://www.w3.org/2000/svg}line") if x.get("stroke-width") == "2"]
        self.assertEqual((marker.get("cx"), marker.get("cy")), (roof[0].get("x2"), roof[0].get("y2")))

    def test_bad_input(self):
        for text in ("", "{}", "[]", json.dumps(result()), json.dumps(result(entry(share_of_triad=0)))):
            done = run("perf/roofline", text=text)
            self.assertEqual(done.returncode, 2, text)
            self.assertTrue(done.stderr.startswith("roofline: "), done.stderr)
        self.assertEqual(run("perf/roofline", "/nonexistent/result.json").returncode, 2)


class Choices(unittest.TestCase):
    """bench_choices with a stub of the program: Newton is cheap, `dual_admm` fails."""

    PROGRAM = """#!{python}
import json, pathlib, sys
command, case, _, output, *_ = sys.argv[1:]
solver = json.loads(pathlib.Path(case).read_text())["solver"]
output = pathlib.Path(output)
output.mkdir(exist_ok=True)
if solver.get("contact") == "dual_admm":
    sys.exit("kacanov: error: no such luck")
count = {{None: 100, "active_set": 200}}.get(solver.get("contact"), 1000 if solver.get("r") == "paper" else 400)
r, contact = solver.get("r", "auto"), count // 10
if isinstance(r, float):  # a sweep
    contact, count = (40 if r < 3 else 32 if r < 20 else 10), 300
(output / "result.json").write_text(json.dumps(dict(status="converged" if r == "auto" or r == "paper" or r < 20 else "not_converged",
    unknowns=10, contact_nodes=2, outer_iterations=3, contact_iterations=contact, operator_applications=count,
    applications=dict(spectrum=count // 20), seconds=dict(total=0.5), r=[2.0], r_active=2.0, contact_force=[0.0, 1.0])))
"""

    def test_ratios_totals_and_a_failure(self):
        with tempfile.TemporaryDirectory() as folder:
            program, results = pathlib.Path(folder) / "kacanov", pathlib.Path(folder) / "results.json"
            program.write_text(self.PROGRAM.format(python=sys.executable))
            program.chmod(0o755)
            done = run("perf/runs/bench_choices", program, "--case", "beam2d 16 gap 0 smooth *", "--sweep", 7, "--json", results)
            entries = json.loads(results.read_text()) if results.exists() else self.fail(done.stderr)
        self.assertEqual(done.returncode, 1, done.stderr)  # dual_admm failed
        self.assertEqual(set(entries), {"beam2d 16 gap 0 smooth linear", "beam2d 16 gap 0 smooth log"})
        for entry in entries.values():
            self.assertIn("no such luck", entry["runs"]["dual_admm"]["status"])
            self.assertEqual(entry["sweep"]["contact"], 32)
            self.assertAlmostEqual(entry["sweep"]["r"], 2.0 * 10**0.5)
        cells = [[c.strip() for c in line.split("|")[1:-1]] for line in done.stdout.splitlines() if line.startswith("|")]
        default = next(c for c in cells if c[:2] == ["beam2d 16 gap 0 smooth log", "default"])
        self.assertEqual(default[2:], ["3", "10", "100", "5.0 %", "0.50", "0.10", ""])
        solved = {c[0].split("`")[1]: c[1] for c in cells if c[0].startswith("`")}
        self.assertEqual(solved, {"default": "2 of 2", "paper": "2 of 2", "admm": "2 of 2", "dual_admm": "0 of 2",
                                  "active_set": "2 of 2"})
        self.assertIn(["beam2d 16 gap 0 smooth log", "40", "32", "6.32", "1.25", "1.33"], cells)

    def test_bad_usage(self):
        self.assertEqual(run("perf/runs/bench_choices", "nowhere").returncode, 2)
        done = run("perf/runs/bench_choices", "nowhere", "--case", "no such case")
        self.assertEqual(done.returncode, 2)
        self.assertIn("--list", done.stderr)


class Runs(unittest.TestCase):
    """bench_run with a stub of the program that fails for the linear beam."""

    PROGRAM = """#!{python}
import json, pathlib, sys
command, path, *options = sys.argv[1:]
case = json.loads(pathlib.Path(path).read_text())
cells = case["mesh"]["box"]["cells"]
if command == "check":
    print("  estimate       2.5 MB of memory, 1 s on 1 rank")
elif case["material"][0]["law"]["type"] == "linear":
    sys.exit("kacanov: error: no such luck")
else:
    n = 3 * (cells[0] + 1) * (cells[1] + 1) * (cells[2] + 1)
    (pathlib.Path(options[1]) / "result.json").write_text(json.dumps(dict(status="converged", unknowns=n, outer_iterations=3, cg_iterations=9,
        operator_applications=20, peak_memory_bytes=100 * n, seconds=dict(total=2e-6 * n, solve=1e-6 * n, preconditioner_setup=5e-7 * n),
        nested=[dict(seconds=1e-7 * n), dict(seconds=2e-7 * n)],
        certificate=dict(equilibrium=1e-8, tension=0.0))))
"""

    def test_sizes_and_a_failure(self):
        with tempfile.TemporaryDirectory() as folder:
            program, results = pathlib.Path(folder) / "kacanov", pathlib.Path(folder) / "results.json"
            program.write_text(self.PROGRAM.format(python=sys.executable))
            program.chmod(0o755)
            done = run("perf/runs/bench_run", program, "--problem", "beam3d", "--problem", "beam3d-linear", "--unknowns", 20000,
                       "--unknowns", 100000, "--json", results, "--output", pathlib.Path(folder) / "out")
            entries = json.loads(results.read_text())["entries"] if results.exists() else self.fail(done.stderr)
            self.assertTrue((pathlib.Path(folder) / "out/beam3d-20000/log.txt").exists())
        self.assertEqual(done.returncode, 1, done.stderr)
        for entry, wanted in zip(entries, (20000, 100000)):
            self.assertLess(abs(entry["unknowns"] - wanted), 0.2 * wanted)
            self.assertEqual(entry["expected_memory_bytes"], 2.5e6)
        self.assertIn("no such luck", entries[2]["status"])
        first = [c.strip() for c in done.stdout.splitlines()[2].split("|")[1:-1]]
        self.assertEqual(first[3:6] + [first[7], first[8], first[10]], ["3", "9", "20", "2.0", "25 %", "100"])
        titles, _, *rows = [[c.strip() for c in line.split("|")[1:-1]] for line in done.stdout.split("an unknown:\n\n")[1].splitlines()]
        self.assertEqual(len(rows), 2)  # failed runs have no phases
        phases = dict(zip(titles, rows[0]))
        self.assertEqual([phases[k] for k in ("read", "coarser meshes", "solve", "setups in it")], ["0.00", "0.30", "1.00", "0.50"])

    def test_bad_usage(self):
        self.assertEqual(run("perf/runs/bench_run", "nowhere").returncode, 2)
        self.assertEqual(run("perf/runs/bench_run", "nowhere", "--problem", "cake").returncode, 2)


class HardCases(unittest.TestCase):
    def test_list_and_bad_usage(self):
        names = run("tests/campaigns/hard_cases", "--list").stdout.splitlines()
        self.assertEqual((len(names), len(set(names))), (216, 216))
        self.assertEqual(run("tests/campaigns/hard_cases", "nowhere").returncode, 2)
        with tempfile.NamedTemporaryFile() as program:
            done = run("tests/campaigns/hard_cases", program.name, "--case", "no such case")
        self.assertEqual(done.returncode, 2)
        self.assertIn("no case", done.stderr)

    def test_what_does_not_converge_is_named(self):
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder) / "kacanov"
            program.write_text("""#!{python}
import json, pathlib, sys
case, output = json.loads(pathlib.Path(sys.argv[2]).read_text()), pathlib.Path(sys.argv[4])
output.mkdir()
linear = case["material"][0]["law"]["type"] == "linear"
(output / "result.json").write_text(json.dumps(dict(status="converged" if linear else "not_converged", message="so it goes",
    outer_iterations=3, operator_applications=20, unknowns=600)))
""".format(python=sys.executable))
            program.chmod(0o755)
            done = run("tests/campaigns/hard_cases", program, "--case", "drag smooth *")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertEqual(done.stdout.count("so it goes"), 5)
        self.assertIn("1 of 6 converged, 18 outer steps, 120 operator applications", done.stdout)


class Paper(unittest.TestCase):
    """paper/run --check with a stub of the program that knows the committed figures."""

    PROGRAM = """#!{python}
import json, pathlib, sys
command, path, *options = sys.argv[1:]
case = json.loads(pathlib.Path(path).read_text())
load, friction = -case["boundary"][1]["traction"][1], "Tresca" if "friction" in case["contact"][0] else "none"
results = pathlib.Path({scripts!r}) / "paper" / "results"
rows = [row for n in (1, 2) for row in json.loads((results / f"paper-table-{{n}}.json").read_text())["rows"]]
row = next(r for r in rows if (r["load"], r["friction"], r["h"]) == (load, friction, "1/16"))
if command == "spectrum":
    print(json.dumps(dict(r_star={r_star} * row["r_star"])))
    sys.exit()
printed = case["solver"]["r"] == row["printed_r"]
output = pathlib.Path(options[options.index("--output") + 1])
output.mkdir()
(output / "result.json").write_text(json.dumps(dict(status="not_converged", outer_iterations=row["outer"], operator_applications=9,
    contact_iterations=row["iterations_at_printed" if printed else "iterations"] + {more}, certificate=dict(tension=1e-4), r=[1.0],
    r_active=0.0)))
sys.exit(1)
"""

    def check(self, **figures):
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder) / "kacanov"
            program.write_text(self.PROGRAM.format(python=sys.executable, scripts=str((ROOT / "perf").resolve()), **figures))
            program.chmod(0o755)
            return run("perf/paper/run", program, "--check")

    def test_the_committed_figures_agree_with_themselves(self):
        done = self.check(r_star=1.005, more=1)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(done.stdout.count("iterations_at_printed"), 3)

    def test_other_figures_are_named(self):
        done = self.check(r_star=1.02, more=0)
        self.assertEqual(done.returncode, 1)
        self.assertIn("16 tresca 0.05: r_star is", done.stderr)
        done = self.check(r_star=1, more=-2)
        self.assertEqual(done.returncode, 1)
        self.assertIn("16 smooth 0.005: iterations is", done.stderr)

    def test_bad_usage(self):
        self.assertEqual(run("perf/paper/run", "/nonexistent").returncode, 2)


class PenaltyRules(unittest.TestCase):
    """penalties/run with a stub: the balanced penalties take 10 iterations, OSQP 20, residual balancing fails."""

    PROGRAM = """#!{python}
import json, pathlib, sys
command, path, *options = sys.argv[1:]
r = json.loads(pathlib.Path(path).read_text())["solver"].get("r")
if command == "sweep":
    print("r* = 1, r_A = 4.5\\n")
    sys.exit()
output = pathlib.Path(options[options.index("--output") + 1])
output.mkdir()
count = {{"auto": 10, "osqp": 20, 4.5: 5}}.get(r, 40)
(output / "result.json").write_text(json.dumps(dict(status="not_converged" if r == "residual_balancing" else "converged",
    contact_iterations=count, operator_applications=3 * count, r=[2.0])))
"""

    def test_rules_are_compared_with_the_balanced_one(self):
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder) / "kacanov"
            program.write_text(self.PROGRAM.format(python=sys.executable))
            program.chmod(0o755)
            done = run("perf/penalties/run", program, "--case", "*beam2d 16 gap 0 smooth linear", "--tolerance", "1e-6")
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = {c[2]: c for line in done.stdout.splitlines() if line.startswith("|")
                for c in [[c.strip() for c in line.split("|")[1:-1]]]}
        self.assertEqual(rows["balanced"][3:], ["1", "1", "1.00", "1.00", "2.00", "1"])
        self.assertEqual(rows["OSQP"][3:], ["1", "1", "2.00", "2.00", "4.00", "1"])
        self.assertEqual(rows["r_A of the solution"][3:], ["1", "1", "0.50", "0.50", "1.00", "0"])
        self.assertEqual(rows["residuals"][3:], ["1", "0", "", "", "", "0"])

    def test_bad_usage(self):
        self.assertEqual(run("perf/penalties/run", "/nonexistent").returncode, 2)


if __name__ == "__main__":
    unittest.main()
