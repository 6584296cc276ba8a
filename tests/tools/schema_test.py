#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks the JSON schema of case files against the program, its reader, the documents and all cases.

usage: schema_test.py PROGRAM FOLDER-OF-THE-PROJECT

Checks that need a schema validator are skipped if there is none (Debian: python3-jsonschema).
"""
import copy
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

try:
    from jsonschema import Draft202012Validator
except ImportError:
    Draft202012Validator = None

ROOT = pathlib.Path(sys.argv.pop()).resolve()
PROGRAM = sys.argv.pop()
GUIDE = ROOT / "docs" / "user-guide" / "case-file.md"
READERS = [ROOT / "tools" / "case" / f"case_{name}.cpp" for name in ("file", "material", "obstacle")]
READERS.append(ROOT / "tools" / "case" / "preset.cpp")
VECTOR = [0, 0, 1]
# A case with every kind of entry; `kacanov check` accepts it except for the missing files.
SAMPLE = {
    "title": "all keys", "$schema": "case.schema.json", "plane": "strain", "thickness": 1,
    "mesh": {"box": {"size": [2, 1, 1], "cells": [2, 1, 1], "element": "hex8"}, "refine": 0, "order": 1,
             "adapt": {"error": 0.05, "most_unknowns": 1000, "most_meshes": 3}},
    "material": [{"on": "all", "young": 200, "poisson": 0.3, "expansion": 1e-5, "bbar": True,
                  "law": {"type": "linear_hardening", "x0": 0.01, "gamma": 0.1, "argument": "norm"}},
                 {"on": {"box": [[0, 0, 0], [1, 1, 1]]}, "young": 100, "poisson": 0.2, "plastic": [[1, 0], [2, 0.1]],
                  "formulation": "mixed"},
                 {"on": {"box": [[1, 0, 0], [2, 1, 1]]}, "young": 100, "poisson": 0.2, "yield_stress": 1,
                  "tangent_modulus": 10}],
    "boundary": [{"on": "left", "name": "wall", "displacement": [0, None, 0], "frame": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]},
                 {"on": "top", "traction": VECTOR}, {"on": "right", "pressure": 1}, {"on": "all", "body_force": VECTOR},
                 {"on": "top", "total_force": VECTOR}, {"on": "all", "density": 1, "acceleration": VECTOR},
                 {"on": "front", "spring": 1}, {"on": "back", "spring": [0, 1, 0]}, {"on": "left", "node_spring": VECTOR},
                 {"on": "right", "node_force": VECTOR}, {"on": "all", "temperature": 1},
                 {"on": "all", "temperature": {"gradient": VECTOR, "value": 1, "point": VECTOR}}, {"on": "back", "normal": 0}],
    "contact": [{"on": "bottom", "name": "floor", "obstacle": {"plane": {"point": [0, 0, 0], "normal": VECTOR}},
                 "friction": {"coulomb": 0.2, "reference": "step"}, "relinearise": True,
                 "force_controlled": {"force": 1, "direction": VECTOR}},
                {"on": "top", "obstacle": {"sphere": {"centre": [1, 0.5, 9], "radius": 7, "direction": VECTOR}},
                 "friction": {"tresca": 0.1},
                 "motion": {"path": [{"time": 1, "translation": VECTOR, "rotation": 0}], "centre": VECTOR}},
                {"on": "front", "obstacle": {"gap": 0.1}}],
    "steps": [{"time": 1, "factors": {"wall": 1}}],
    "solver": {"preset": "paper", "tolerance": 1e-6, "outer": "auto", "contact": "auto", "r": 1, "stop": "kkt", "max_outer": 100,
               "max_contact": 100, "max_cg": 100, "coarse_amg": 5000, "spectrum_tolerance": 0.01, "relaxation": 1.5,
               "preconditioner": "multigrid", "nested": True},
    "probe": [[1, 0.5, 1]],
    "output": {"fields": "none", "steps": True, "report": False, "view": VECTOR, "quantity": "plastic",
               "checkpoint": True}}
LAWS = [{"type": "linear"}, {"type": "logarithmic", "yield_stress": 1}, {"type": "power", "x0": 0.1, "n": 0.5},
        {"type": "saturating", "x0": 0.1, "q": 2}, {"type": "table", "points": [[0, 0], [0.1, 15], [1, 20]]},
        {"type": "ramberg_osgood", "sigma0": 1, "alpha": 1, "n": 5}]
OBSTACLES = [{"cylinder": {"point": VECTOR, "axis": [1, 0, 0], "radius": 1, "inside": True}},
             {"cone": {"apex": [0, 0, -1], "axis": [0, 0, -1], "half_angle": 80}},
             {"torus": {"centre": [0, 0, -9], "axis": VECTOR, "radius": 3, "tube": 1}},
             {"box": {"lower": [0, 0, -2], "upper": [1, 1, -1], "frame": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}},
             {"surface": {"file": "a.stl", "group": "all"}},
             {"height_map": {"file": "a.csv", "lower": [0, 0], "upper": [1, 1], "scale": 1, "offset": 0, "body": "above"}}]


def run(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, check=False, timeout=60)


SCHEMA = json.loads(run("schema").stdout)


def without_comments(text):
    return re.sub(r'("(?:\\.|[^"\\])*")|//[^\n]*|/\*.*?\*/', lambda match: match[1] or "", text, flags=re.DOTALL)


# Alternative forms of entries of which the sample has one.
OTHERS = [{"on": "all", "temperature": {"file": "warm.csv", "otherwise": 20}}]


def samples():
    """Yields the sample, and small cases for the alternatives that it cannot contain."""
    yield SAMPLE
    small = {key: SAMPLE[key] for key in ("mesh", "material")}
    for law in LAWS:
        yield {**small, "material": [{"on": "all", "young": 200, "poisson": 0.3, "law": law}]}
    for obstacle in OBSTACLES:
        yield {**small, "contact": [{"on": "bottom", "obstacle": obstacle}]}
    for entry in OTHERS:
        yield {**small, "boundary": [entry]}
    for steps in (3, [0.5, 1]):
        yield {**small, "solver": {"load_steps": steps, "r": "paper"}}
    for rule in ("residual_balancing", "relative_balancing", "osqp", "spectral"):
        yield {**small, "solver": {"contact": "admm", "r": rule, "first_r": 1, "preconditioner": "cholesky"}}
    yield {**small, "mesh": {"file": "a.msh"}}
    yield {**small, "mesh": {"files": ["coarse.msh", "a.msh"]}}


def named_schemas(schema=SCHEMA):
    """Yields the name and the schema of each property at every level."""
    if isinstance(schema, dict):
        yield from schema.get("properties", {}).items()
        schema = list(schema.values())
    if isinstance(schema, list):
        for part in schema:
            yield from named_schemas(part)


def names():
    return {name for name, _ in named_schemas()}


def paths(value, path=()):
    if path:
        yield path
    entries = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, entry in entries:
        yield from paths(entry, path + (key,))


def at(value, path):
    for key in path:
        value = value[key]
    return value


def shown(path):
    """Returns the path as messages show it."""
    text = ""
    for key in path:
        text += f"[{key}]" if isinstance(key, int) else ("." if text else "") + key
    return text


def changed(case, path, value):
    case = copy.deepcopy(case)
    at(case, path[:-1])[path[-1]] = value
    return case


class Names(unittest.TestCase):
    def test_every_key_is_in_the_user_guide_and_the_guide_has_no_others(self):
        guide = GUIDE.read_text(encoding="utf-8")
        code = " ".join(re.findall(r"`[^`\n]+`", guide))
        self.assertEqual({name for name in names() if not re.search(rf"(?<![\w$]){re.escape(name)}\b", code)}, set())
        in_tables = set()
        for cell in re.findall(r"^\| ((?:`[\w.$]+`(?:, )?)+) \|", guide, flags=re.MULTILINE):
            in_tables |= {name.split(".")[-1] for name in re.findall(r"`([^`]+)`", cell)}
        values = {value for _, part in named_schemas() for value in [*part.get("enum", []), part.get("const")]}
        limits = guide.index("## Limits")
        self.assertGreater(len(in_tables), 50)
        self.assertEqual({name for name in in_tables if f"`{name}`" in guide[:limits]} - names() - values, set())

    def test_the_guide_has_each_key_once(self):
        for section in re.split(r"^##+ ", GUIDE.read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]:
            cells = re.findall(r"^\| ((?:`[^`]+`(?:, )?)+) \|", section, flags=re.MULTILINE)
            keys = [name for cell in cells for name in re.findall(r"`([^`]+)`", cell)]
            self.assertEqual(len(keys), len(set(keys)), section.splitlines()[0])

    def test_the_reader_asks_for_every_key(self):
        reading = "".join(path.read_text(encoding="utf-8") for path in READERS)
        reading = re.sub(r'\b(?:must|may)\(\s*"[^"]*"', "", reading)
        for_people = {"title", "$schema"}
        self.assertEqual({name for name in names() - for_people if f'"{name}"' not in reading}, set())

    def test_every_key_has_a_line_of_help(self):
        self.assertEqual({name for name, part in named_schemas() if len(part.get("description", "x" * 3)) < 3}, set())


@unittest.skipIf(Draft202012Validator is None, "python3-jsonschema is not installed")
class Cases(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.schema = Draft202012Validator(SCHEMA)

    def complaint(self, case):
        """Returns the message with which `kacanov check` rejects the case."""
        (self.folder / "case.json").write_text(json.dumps(case))
        outcome = run("check", str(self.folder / "case.json"))
        return outcome.stderr.removeprefix("kacanov: error: ") if outcome.returncode == 2 else ""

    def test_it_is_a_schema(self):
        Draft202012Validator.check_schema(SCHEMA)

    def test_all_cases_of_the_project_are_as_it_says(self):
        count = 0
        for room in ("tools", "tests", "perf", "python", "docs"):
            for path in (ROOT / room).rglob("*.json"):
                document = json.loads(without_comments(path.read_text(encoding="utf-8")))
                within = list(document.values()) if isinstance(document, dict) else document
                for case in [document, *(within if isinstance(within, list) else [])]:
                    if isinstance(case, dict) and "mesh" in case and "material" in case:
                        self.assertEqual([error.message for error in self.schema.iter_errors(case)], [], path)
                        count += 1
        self.assertGreater(count, 20)

    def test_all_snippets_of_the_documents_are_as_it_says(self):
        count = 0
        for path in [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]:
            for text in re.findall(r"^```json\n(.*?)^```", path.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE):
                text = without_comments(text)
                part = json.loads(text if text.lstrip().startswith("{") else "{" + text + "}")
                case = {**SAMPLE, **part} if part.keys() <= SCHEMA["properties"].keys() else {
                    **SAMPLE, "contact": [{**SAMPLE["contact"][1], **part}]}
                self.assertEqual([error.message for error in self.schema.iter_errors(case)], [], f"{path}: {text}")
                count += 1
        self.assertGreater(count, 4)

    def test_what_init_writes_is_as_it_says(self):
        target = self.folder / "made.json"
        self.assertEqual(run("init", str(ROOT / "tools/examples/rocker.msh"), str(target)).returncode, 0)
        self.schema.validate(json.loads(without_comments(target.read_text(encoding="utf-8"))))

    def test_samples_have_every_key_and_are_as_it_says(self):
        seen = set()
        for case in samples():
            self.assertEqual([error.message for error in self.schema.iter_errors(case)], [], case)
            seen |= {key for path in paths(case) for key in path if isinstance(key, str)}
        self.assertEqual(names() - seen, set())

    def test_the_program_takes_what_leaves_out_means(self):
        """Default values written explicitly are accepted."""
        for part in ("solver", "output"):
            keys = SCHEMA["properties"][part]["properties"]
            written = {key: value["default"] for key, value in keys.items() if "default" in value}
            case = {"mesh": SAMPLE["mesh"], "material": SAMPLE["material"][:1], part: written}
            self.assertNotIn("expected", self.complaint(case))

    def mutants(self, case):
        """Yields pairs of the path that the message must name and the invalid case."""
        for path in paths(case):
            value = at(case, path)
            if isinstance(value, dict) and "factors" not in path[-1:]:
                yield path + ("zzz",), changed(case, path + ("zzz",), 1)
            if not isinstance(path[-1], str) or path[-1] == "wall":
                continue
            less = copy.deepcopy(case)
            del at(less, path[:-1])[path[-1]]
            yield path[:-1], less
            for wrong in ({"zzz": 1}, [[]], 1e101, ""):
                yield path, changed(case, path, wrong)
            if isinstance(value, (int, float)) and not isinstance(value, bool):
                for wrong in (-1, 0, 0.5, 1, 2, 90, 1e10):
                    yield path, changed(case, path, wrong)

    def test_the_program_refuses_what_the_schema_refuses_and_names_the_place(self):
        refused = taken = 0
        for case in samples():
            for path, mutant in list(self.mutants(case))[:: 13 if case is SAMPLE else 11]:
                said = self.complaint(mutant)
                if self.schema.is_valid(mutant):
                    # Errors beyond the schema have other messages than errors of keys and ranges.
                    taken += 1
                    self.assertNotRegex(said, r": (unknown key|expected a number [>≥])", mutant)
                else:
                    refused += 1
                    lines = [line.strip() for line in said.splitlines()]  # one line per error
                    self.assertTrue(any(line.startswith(shown(path)) for line in lines), f"{mutant}\n{said}")
        self.assertGreater(min(refused, taken), 20)


if __name__ == "__main__":
    unittest.main()
