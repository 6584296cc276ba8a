#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks the documents against each other and the code: links, anchors, labels of the theory, tables of figures.

usage: documents_test.py FOLDER-OF-THE-PROJECT
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(sys.argv.pop(1)).resolve()
DOCS = ROOT / "docs"
RENDER = ROOT / "perf" / "render_tables"
CODE = {".cpp", ".hpp", ".c", ".h", ".py", ".cmake", ".txt"}
CITATION = re.compile(r"\btheory:\s+(?:(?://+|\*|#)\s*)?([a-z][a-z0-9-]*[a-z0-9])")  # a line may end before the label
ROOMS = ("kernels", "solver", "tools", "tests", "perf", "python")


def prose(path):
    """Returns the text without code blocks and code spans."""
    text = re.sub(r"^```.*?^```", "", path.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE)
    return re.sub(r"`[^`\n]*`", "", text)


def slug(heading):
    return re.sub(r"[-\s]+", "-", re.sub(r"[^\w\s-]", "", heading.strip().lower()))


def anchors(path):
    found = set()
    for line in prose(path).splitlines():
        if heading := re.match(r"#+ (.*?)(?: *\{#([\w-]+)\})?$", line):
            found.add(heading[2] or slug(heading[1]))
    return found


def links(path):
    for target in re.findall(r"\]\(([^)\s]+)\)", prose(path)):
        if not re.match(r"[a-z]+:", target):
            yield target


def documents():
    outside = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md"]
    for room in ROOMS:
        outside += (ROOT / room).rglob("README.md")
    return [path for path in [*DOCS.glob("*.md"), *DOCS.glob("user-guide/*.md"), *outside] if path.is_file()]


class Links(unittest.TestCase):
    def test_every_link_leads_somewhere(self):
        lost = []
        for path in documents():
            for target in links(path):
                file, _, anchor = target.partition("#")
                to = (path.parent / file).resolve() if file else path
                if not to.exists() or (anchor and to.suffix == ".md" and anchor not in anchors(to)):
                    lost.append(f"{path.relative_to(ROOT)}: {target}")
        self.assertEqual(lost, [])


STRING = re.compile(r'"((?:\\.|[^"\\])*)"')


class Warnings(unittest.TestCase):
    """Every warning has its own row in the user guide."""

    def setUp(self):
        guide = (DOCS / "user-guide" / "results.md").read_text(encoding="utf-8")
        section = guide[guide.index("{#warnings}"):guide.index("## The certificate")]
        rows = [row.split(" | ")[0].replace("\\*", "@") for row in section.splitlines() if row.startswith("| *")]
        found = [phrase.replace("@", "*") for row in rows for phrase in re.findall(r"\*([^*]+)\*", row)]
        self.phrases = [[part.strip() for part in phrase.split("…") if part.strip()] for phrase in found]
        self.sources = {path: path.read_text(encoding="utf-8") for room in ("solver", "tools")
                        for path in (ROOT / room).rglob("*.[ch]pp") if "verify" not in path.relative_to(ROOT).parts}

    @staticmethod
    def words(code):
        return "".join(STRING.findall(code)).replace('\\"', '"')

    def body_of(self, function):
        """Returns the body of the function's definition, from the file that has it."""
        definition = re.compile(rf"std::string {function}\([^)]*\) {{(.*?)\n}}\n", re.DOTALL)
        return next(found[1] for text in self.sources.values() if (found := definition.search(text)))

    def warnings(self):
        """Yields pairs of the place that issues a warning and the warning's text."""
        made = re.compile(r'(?:warnings|remarks_)\.push_back\((.*?)\);\n|"kacanov: (?:warning|note): .*?;\n', re.DOTALL)
        passed_on = re.compile(r"[\w:.+ ()]*\b(?:warning|what\(\)|remark)\b\)*", re.DOTALL)
        for path, text in self.sources.items():
            for match in made.finditer(text):
                code = match[0]
                if function := re.search(r"\b(\w+_message)\(", code):
                    code = self.body_of(function[1])
                elif "text.str()" in code:
                    code = text[text.rindex("PlainText", 0, match.start()):match.end()]
                elif not re.search("[a-z]{3}", self.words(code.replace("kacanov: warning: ", ""))) and passed_on.search(code):
                    continue
                yield f"{path.relative_to(ROOT)}: {code[:60]}", self.words(code)

    def test_every_warning_is_explained(self):
        made = dict(self.warnings())
        self.assertGreater(len(made), 25)
        self.assertEqual([place for place, words in made.items()
                          if not any(all(part in words for part in phrase) for phrase in self.phrases)], [])

    def test_every_explanation_is_of_words_that_are_said(self):
        said = "".join(self.words(text) for text in self.sources.values())
        self.assertEqual([phrase for phrase in self.phrases if not all(part in said for part in phrase)], [])


class Labels(unittest.TestCase):
    def setUp(self):
        text = (DOCS / "theory.md").read_text(encoding="utf-8")
        self.defined = re.findall(r"\{#([\w-]+)\}", text)
        table = text[text.index("## Labels"):text.index("The paper's numbers")]
        self.listed = re.findall(r"\[`([\w-]+)`\]\(#\1\)", table)

    def test_labels_are_unique_and_listed(self):
        self.assertEqual(len(self.defined), len(set(self.defined)))
        self.assertEqual(set(self.defined) - set(self.listed), {"own", "references"})
        self.assertEqual(set(self.listed) - set(self.defined), set())

    def test_code_cites_labels_that_exist(self):
        wrong = []
        for room in ROOMS:
            for path in (ROOT / room).rglob("*"):
                if path.suffix not in CODE or not path.is_file() or path == pathlib.Path(__file__).resolve():
                    continue
                for label in CITATION.findall(path.read_text(encoding="utf-8")):
                    if label not in self.listed:
                        wrong.append(f"{path.relative_to(ROOT)}: {label}")
        self.assertEqual(wrong, [])


def render(root, *options):
    return subprocess.run([sys.executable, RENDER, "--root", root, *options], capture_output=True, text=True, check=False)


class Tables(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        (self.root / "perf" / "results").mkdir(parents=True)
        self.results = {
            "what": "Runs.", "machine": "two cores", "command": ["bench_run"],
            "columns": [{"key": "body", "title": "body"}, {"key": "unknowns", "title": "unknowns"},
                        {"key": "seconds", "title": "s", "format": ".1f"},
                        {"key": "each", "title": "µs", "quotient": ["seconds", "unknowns"], "factor": 1e6, "format": ".0f"},
                        {"key": "memory", "title": "memory", "format": "bytes"}],
            "rows": [{"body": "beam", "unknowns": 1000000, "seconds": [20, 30], "memory": [366e6, 2.86e9]},
                     {"body": "ball", "unknowns": 500, "memory": 14_377_000_000}]}
        self.write("a", "before\n<!-- table: runs -->\n<!-- end table -->\nafter\n")

    def write(self, name, text):
        (self.root / "perf" / "results" / "runs.json").write_text(json.dumps(self.results))
        (self.root / f"{name}.md").write_text(text)

    def text(self, name="a"):
        return (self.root / f"{name}.md").read_text()

    def test_the_documents_of_the_project_agree_with_its_figures(self):
        run = render(ROOT, "--check")
        self.assertEqual((run.returncode, run.stdout), (0, ""), run.stderr)

    def test_a_table_is_written_once_and_for_all(self):
        self.assertEqual(render(self.root, "--check").returncode, 1)
        self.assertEqual(render(self.root).returncode, 0)
        self.assertIn("| beam | 1,000,000 | 20.0–30.0 | 20–30 | 366 MB–2.9 GB |", self.text())
        self.assertIn("| ball | 500 |  |  | 14 GB |", self.text())
        self.assertIn("*two cores; `bench_run`*", self.text())
        self.assertTrue(self.text().startswith("before\n") and self.text().endswith("after\n"))
        before = self.text()
        self.assertEqual(render(self.root, "--check").returncode, 0)
        render(self.root)
        self.assertEqual(self.text(), before)

    def test_columns_can_be_chosen(self):
        self.write("a", "<!-- table: runs columns=memory,body -->\n<!-- end table -->\n")
        render(self.root)
        self.assertIn("| memory | body |\n|---:|---|\n| 366 MB–2.9 GB | beam |", self.text())

    def test_a_figure_changed_on_either_side_is_noticed(self):
        render(self.root)
        self.write("a", self.text().replace("1,000,000", "1,000,001"))
        self.assertEqual(render(self.root, "--check").returncode, 1)
        render(self.root)
        self.results["rows"][0]["unknowns"] += 1
        self.write("a", self.text())
        self.assertEqual(render(self.root, "--check").returncode, 1)

    def test_what_cannot_be_is_refused(self):
        for text in ("<!-- table: other -->\n<!-- end table -->\n", "<!-- table: runs -->\n",
                     "<!-- table: runs columns=nothing -->\n<!-- end table -->\n"):
            self.write("a", text)
            self.assertEqual(render(self.root).returncode, 2, text)
            self.assertEqual(self.text(), text)
        self.results["rows"][0]["secnds"] = 1
        self.write("a", "<!-- table: runs -->\n<!-- end table -->\n")
        self.assertEqual(render(self.root).returncode, 2)

    def test_figures_that_no_document_shows_are_noticed(self):
        self.write("a", "nothing\n")
        self.assertEqual(render(self.root, "--check").returncode, 1)


if __name__ == "__main__":
    unittest.main()
