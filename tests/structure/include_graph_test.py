#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests include_graph.py on made-up projects of a few files."""
import unittest

import include_graph as graph

TABLE = {f"kernels/include/kacanov/{name}": "" for name in graph.HEADER_ROOMS if name != "kacanov.h"}
TABLE["kernels/include/kacanov/kacanov.h"] = ""


def complaints(files):
    """Returns the complaints about the includes of these files, without the real project's exceptions."""
    arrows, found = graph.draw(TABLE | files)
    return found + [c for c in graph.backward(arrows) if not c.startswith("KNOWN_BACKWARD")]


class Arrows(unittest.TestCase):
    def test_down_is_right(self):
        self.assertEqual([], complaints({
            "kernels/law/law.cpp": "#include <kacanov/law.hpp>\n",
            "kernels/include/kacanov/law.hpp": "",
            "solver/amg/level.cpp": '#include "linear/space.hpp"\n#include "amg/level.hpp"\n#include <kacanov/law.hpp>\n',
            "solver/amg/level.hpp": "",
            "solver/linear/space.hpp": "#include <vector>\n",
            "tests/solver/level_test.cpp": '#include "amg/level.hpp"\n#include "../../perf/benchmarks/meshes.hpp"\n',
            "perf/benchmarks/meshes.hpp": "",
        }))

    def test_up_runs_back(self):
        found = complaints({"solver/linear/space.hpp": '#include "amg/level.hpp"\n', "solver/amg/level.hpp": ""})
        self.assertEqual(["solver/linear → solver/amg runs back: solver/linear/space.hpp includes amg/level.hpp"], found)

    def test_top_folders_have_an_order_of_their_own(self):
        found = complaints({"kernels/law/a.hpp": '#include "verify/b.hpp"\n', "tools/verify/b.hpp": ""})
        self.assertEqual(["kernels/law → tools/verify runs back: kernels/law/a.hpp includes verify/b.hpp"], found)

    def test_every_subfolder_is_a_room(self):
        files = {"kernels/law/deep/a.hpp": '#include "../b.hpp"\n', "kernels/law/b.hpp": ""}
        self.assertIn("kernels/law/deep: no such room", complaints(files)[0])

    def test_rooms_of_one_level_do_not_know_each_other(self):
        self.assertEqual(1, len(complaints({"solver/contact/a.hpp": '#include "amg/b.hpp"\n', "solver/amg/b.hpp": ""})))

    def test_public_header_is_in_the_room_of_its_source(self):
        files = {"solver/solve.cpp": "", "solver/include/kacanov/solve.hpp": "",
                 "solver/mesh/mesh.cpp": "# include <kacanov/solve.hpp>\n"}
        self.assertEqual(1, len(complaints(files)))

    def test_public_header_includes_public_ones(self):
        files = {"kernels/law/law.cpp": "", "kernels/law/inner.hpp": "",
                 "kernels/include/kacanov/law.hpp": '#include "law/inner.hpp"\n'}
        self.assertIn("is installed, and includes law/inner.hpp, which is not", complaints(files)[0])

    def test_what_is_not_there(self):
        self.assertEqual(2, len(complaints({"solver/amg/a.cpp": '#include "amg/b.hpp"\n#include <kacanov/b.hpp>\n'})))

    def test_header_without_room(self):
        self.assertEqual(1, len(complaints({"solver/include/kacanov/lonely.hpp": ""})))

    def test_unknown_room(self):
        self.assertEqual(1, len(complaints({"solver/attic/a.cpp": '#include "amg/b.hpp"\n', "solver/amg/b.hpp": ""})))


class Files(unittest.TestCase):
    head = "// SPDX-License-Identifier: BSD-3-Clause\n"

    def check(self, text, expected):
        found = list(graph.file_complaints("solver/amg/a.cpp", text))
        self.assertEqual(expected, len(found), found)

    def test_head(self):
        self.check(self.head + "// Adds what is there.\n#include <vector>\n", 0)
        self.check(self.head + "// A sentence that takes\n// two lines.\n", 0)
        self.check("#!/usr/bin/env python3\n" + self.head.replace("//", "#") + '"""Adds what is there.\n', 0)
        self.check(self.head + "int main() { return 0; }\n// Adds what is there.\n", 1)
        self.check("// Adds what is there.\n", 1)

    def test_streams_of_the_hosts_locale(self):
        said = self.head + "// Describes what is there.\n"
        self.check(said + "std::ostringstream text;\n", 1)
        self.check(said + "std::ifstream in(path);\nstd::stringstream both;\n", 2)
        self.check(said + "PlainText text;\nstd::ostream& out;\n", 0)

    def test_loose_code(self):
        text = self.head + "// Adds what is there.\n"
        self.assertEqual([], list(graph.file_complaints("solver/solve.cpp", text)))
        self.assertEqual(1, len(list(graph.file_complaints("solver/more.cpp", text))))

    def test_short_files(self):
        short, long = "int a;\n" * 10, "int a;\n" * 200
        texts = {"solver/amg/a.hpp": short, "solver/amg/a.cpp": long, "solver/amg/b.hpp": short, "solver/amg/b.cpp": short,
                 "kernels/include/kacanov/c.hpp": short, "kernels/simd/d_avx2.cpp": short, "solver/amg/CMakeLists.txt": short,
                 "solver/mesh/e.cpp": short, "solver/mesh/f.cpp": short}
        reasons = graph.reasons_of_short_files("# comment\nsolver/amg/b.hpp: a reason\nsolver/old/e.cpp: to merge\n")
        found = graph.short_files(texts, reasons)
        self.assertEqual({"solver/amg/a.hpp": "header of a source file", "solver/amg/b.hpp": "a reason",
                          "solver/amg/b.cpp": None, "kernels/include/kacanov/c.hpp": "public header",
                          "kernels/simd/d_avx2.cpp": "instruction set", "solver/mesh/e.cpp": "to merge",
                          "solver/mesh/f.cpp": None}, found)

    def test_length(self):
        self.check(self.head + "// Adds what is there.\n" + "int a;\n" * (graph.MOST_LINES - 2), 0)
        self.check(self.head + "// Adds what is there.\n" + "int a;\n" * (graph.MOST_LINES - 1), 1)


if __name__ == "__main__":
    unittest.main()
