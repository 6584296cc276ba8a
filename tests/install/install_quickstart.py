#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""install_quickstart.py SOURCE BUILD: checks that `cmake --install` works after `tools/quickstart run`: the
quickstart's
target builds everything that is both built and installed."""
import re
import subprocess
import sys
from pathlib import Path


def ninja(build, *words):
    return subprocess.run(["ninja", "-C", str(build), "-t", *words], capture_output=True, text=True, check=True).stdout


def main():
    source, build = Path(sys.argv[1]), Path(sys.argv[2])
    target = re.search(r"\n  build (kacanov[a-z_]*)\n", (source / "tools/quickstart").read_text())
    if not target:
        sys.exit("tools/quickstart run builds no target of the project")
    built = set(re.split(r"[; \n\"]+", ninja(build, "commands", target[1])))
    targets = {line.rsplit(": ", 1)[0] for line in ninja(build, "targets", "all").splitlines()}

    installed = set()
    for script in build.rglob("cmake_install.cmake"):
        installed.update(re.findall(rf'"({re.escape(str(build))}/[^"]+)"', script.read_text()))
    # Files that exist right after configuring are not targets.
    made = sorted(name for name in (str(Path(file).relative_to(build)) for file in installed) if name in targets)
    missing = [name for name in made if name not in built and str(build / name) not in built]
    if missing:
        sys.exit(f"installed but not built by tools/quickstart run: {', '.join(missing)}")
    if len(made) < 6:
        sys.exit(f"only {len(made)} of what is built are installed")


if __name__ == "__main__":
    main()
