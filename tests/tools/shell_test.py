#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks the manual page and the bash completion against --help, groff and bash.

usage: shell_test.py PROGRAM
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM = os.path.abspath(sys.argv.pop())


def said(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, check=True, timeout=60).stdout


COMMANDS = re.findall(r"^  ([a-z]+) {2,}\S", said("--help").split("Subcommands:")[1], flags=re.MULTILINE)


def options(command):
    return set(re.findall(r"(?<![\w-])--?[a-z][a-z-]*", said(command, "--help").split("Options:")[1].split("Exit codes:")[0]))


class Manual(unittest.TestCase):
    def test_it_has_every_command_and_option(self):
        page = said("man").replace("\\-", "-")
        self.assertGreater(len(COMMANDS), 8)
        for command in COMMANDS:
            section = re.search(rf'^\.SS "{command}\b.*?(?=^\.S)', page, flags=re.MULTILINE | re.DOTALL)
            self.assertTrue(section, command)
            self.assertEqual({name for name in options(command) - {"-h", "--help"} if name not in section[0]}, set())

    @unittest.skipIf(shutil.which("groff") is None, "groff is not installed")
    def test_groff_has_no_complaint(self):
        run = subprocess.run(["groff", "-man", "-Tutf8", "-ww", "-rLL=78n", "-P-cbou"], input=said("man"), capture_output=True,
                             text=True, check=True)
        self.assertEqual(run.stderr, "")
        self.assertIn("EXIT STATUS", run.stdout)


class Completion(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        for name in ("a case.json", "mesh.msh", "note.txt"):
            (self.folder / name).touch()
        (self.folder / "sub").mkdir()

    def completed(self, *words):
        """Returns bash's completions of the last word."""
        script = ('source <("$1" completion); shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _kacanov; '
                  'printf "%s\\n" "${COMPREPLY[@]}"')
        run = subprocess.run(["bash", "-c", script, "bash", PROGRAM, "kacanov", *words], cwd=self.folder,
                             capture_output=True, text=True, check=True)
        self.assertEqual(run.stderr, "")
        return {line for line in run.stdout.splitlines() if line}

    def test_commands_and_options(self):
        self.assertEqual(self.completed("") - {"--help", "--version", "-h"}, set(COMMANDS))
        self.assertEqual(self.completed("sp"), {"spectrum"})
        for command in COMMANDS:
            self.assertEqual(self.completed(command, "-"), options(command), command)

    def test_files_by_what_a_command_reads(self):
        self.assertEqual(self.completed("run", ""), {"a case.json", "sub"})
        self.assertEqual(self.completed("init", ""), {"a case.json", "mesh.msh", "note.txt", "sub"})
        self.assertEqual(self.completed("run", "a case.json", "-o", ""), {"sub"})
        self.assertEqual(self.completed("run", "a case.json", "--ranks", ""), set())

    def test_keys_of_the_case(self):
        self.assertEqual(self.completed("run", "a case.json", "--set", "solver.max_c"), {"solver.max_cg=", "solver.max_contact="})
        self.assertEqual(self.completed("run", "a case.json", "--set", "output.f"), {"output.fields="})


if __name__ == "__main__":
    unittest.main()
