# SPDX-License-Identifier: BSD-3-Clause
"""Builds the compiled part with CMake, in build/python of the project or in the build that KACANOV_BUILD names."""
import os
import pathlib
import re
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent.parent
VERSION = re.search(r"^project\(kacanov VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text("utf-8"), re.MULTILINE)[1]


class CMakeBuild(build_ext):
    """Configures the module without unneeded parts, builds it, and copies it to its place."""

    def build_extension(self, ext):
        given = os.environ.get("KACANOV_BUILD")
        folder = pathlib.Path(given).resolve() if given else ROOT / "build" / "python"
        configure = ["cmake", "-S", str(ROOT), "-B", str(folder), "-DKACANOV_PYTHON=ON",
                     f"-DPYTHON_EXECUTABLE={sys.executable}"]
        if not (folder / "CMakeCache.txt").exists():
            configure += ["-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DKACANOV_TESTS=OFF", "-DKACANOV_INSTALL=OFF",
                          "-DCMAKE_UNITY_BUILD=ON"]
        subprocess.run(configure, check=True)
        subprocess.run(["cmake", "--build", str(folder), "--target", "kacanov_python", "--parallel",
                        str(os.cpu_count() or 1)], check=True)
        to = pathlib.Path(self.get_ext_fullpath(ext.name))
        to.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(folder / "python" / "kacanov" / to.name, to)


setup(version=VERSION, ext_modules=[Extension("kacanov._kacanov", sources=[])], cmdclass={"build_ext": CMakeBuild})
