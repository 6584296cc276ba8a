#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The comparison of two builds and the roofline picture, on made-up results.

usage: scripts_test.py FOLDER-OF-THE-SCRIPTS
"""
import json
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

SCRIPTS = pathlib.Path(sys.argv.pop(1))


def entry(**changes):
    return {"element": "tet4", "mesh": "box", "form": "apply", "unknowns": 1000, "precision": "double", "threads": 2,
            "unknowns_per_second": 1e8, "share_of_triad": 0.2, "share_of_fma_peak": 0.5, **changes}


def result(*entries):
    return {"triad_bytes_per_second": [1e10, 2e10], "fma_flops_per_second": [5e10, 1e11], "entries": list(entries)}


def run(name, *arguments, text=None):
    return subprocess.run([sys.executable, SCRIPTS / name, *map(str, arguments)], input=text, text=True,
                          capture_output=True, check=False)


class Compare(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def build(self, name, entries_of_run):
        """A build whose benchmark prints the n-th of the given results at its n-th run."""
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
        """The verdict when speeds drift together by half, scatter by `noise`, and differ by `factor`."""
        rng = random.Random(4)
        drift = [1.5 if i > rounds / 2 else 1.0 for i in range(rounds)]
        speeds = [[[entry(unknowns_per_second=1e8 * f * d * (1 + noise * rng.uniform(-1, 1)))] for d in drift]
                  for f in (1.0, factor)]
        done = run("compare_builds", self.build("old", speeds[0]), self.build("new", speeds[1]), "--rounds", rounds, "--json")
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
        done = run("compare_builds", old, new, "--rounds", 6)
        self.assertEqual(done.returncode, 2)
        self.assertIn("in common", done.stderr)

    def test_missing_build_and_too_few_rounds(self):
        self.assertEqual(run("compare_builds", "nowhere", "nowhere").returncode, 2)
        self.assertEqual(run("compare_builds", "nowhere", "nowhere", "--rounds", 5).returncode, 2)


class Roofline(unittest.TestCase):
    def test_every_entry_wanted_is_drawn(self):
        entries = [entry(), entry(precision="float"), entry(form="csr"), entry(form="tangent"), entry(threads=1)]
        done = run("roofline", text=json.dumps(result(*entries)))
        self.assertEqual(done.returncode, 0, done.stderr)
        picture = xml.etree.ElementTree.fromstring(done.stdout)
        titles = [t.text for t in picture.iter("{http://www.w3.org/2000/svg}title")]
        self.assertEqual(len(titles), 3)
        self.assertTrue(any(t.startswith("tet4 csr box") for t in titles), titles)
        everything = run("roofline", "--form", "all", text=json.dumps(result(*entries)))
        self.assertEqual(everything.stdout.count("<title>"), 4)

    def test_a_point_on_the_roof_lies_on_the_roof(self):
        # All of the peak at the intensity of the ridge: the marker is where the two parts of the roof meet.
        done = run("roofline", text=json.dumps(result(entry(share_of_triad=1.0, share_of_fma_peak=1.0))))
        picture = xml.etree.ElementTree.fromstring(done.stdout)
        marker = next(picture.iter("{http://www.w3.org/2000/svg}circle"))
        roof = [x for x in picture.iter("{http://www.w3.org/2000/svg}line") if x.get("stroke-width") == "2"]
        self.assertEqual((marker.get("cx"), marker.get("cy")), (roof[0].get("x2"), roof[0].get("y2")))

    def test_bad_input(self):
        for text in ("", "{}", "[]", json.dumps(result()), json.dumps(result(entry(share_of_triad=0)))):
            done = run("roofline", text=text)
            self.assertEqual(done.returncode, 2, text)
            self.assertTrue(done.stderr.startswith("roofline: "), done.stderr)
        self.assertEqual(run("roofline", "/nonexistent/result.json").returncode, 2)


if __name__ == "__main__":
    unittest.main()
