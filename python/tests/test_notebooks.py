# SPDX-License-Identifier: BSD-3-Clause
"""The notebooks run from the first cell to the last, and are committed without outputs."""
import contextlib
import importlib.util
import io
import json
import pathlib
import unittest

NOTEBOOKS = pathlib.Path(__file__).resolve().parent.parent / "notebooks"


def cells(name):
    """Returns the code of a notebook's cells."""
    book = json.loads((NOTEBOOKS / name).read_text("utf-8"))
    return [(cell, "".join(cell["source"])) for cell in book["cells"] if cell["cell_type"] == "code"]


class Notebooks(unittest.TestCase):
    def run_notebook(self, name, *modules):
        """Runs the cells without Jupyter, which needs fifty packages: they contain only Python."""
        for module in modules:
            if not importlib.util.find_spec(module):
                self.skipTest(f"no {module}")
        if "matplotlib" in modules:
            import matplotlib
            matplotlib.use("agg")
        names = {"__name__": "__main__"}
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            for i, (_, code) in enumerate(cells(name)):
                exec(compile(code, f"{name}, cell {i + 1} of code", "exec"), names)
        return said.getvalue()

    def test_first_case(self):
        self.assertIn("converged", self.run_notebook("first_case.ipynb"))

    def test_friction_study(self):
        self.assertIn("open, stick, slip", self.run_notebook("friction_study.ipynb", "matplotlib"))

    def test_operator_and_multigrid(self):
        self.assertIn("multigrid", self.run_notebook("operator_and_multigrid.ipynb", "scipy"))

    def test_they_are_clean(self):
        found = sorted(path.name for path in NOTEBOOKS.glob("*.ipynb"))
        self.assertEqual(found, ["first_case.ipynb", "friction_study.ipynb", "operator_and_multigrid.ipynb"])
        for name in found:
            for cell, code in cells(name):
                self.assertEqual((cell["outputs"], cell["execution_count"]), ([], None), name)
                self.assertFalse(code.startswith(("%", "!")), code)


if __name__ == "__main__":
    unittest.main()
