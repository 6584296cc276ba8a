#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks that a C library exports exactly the functions of its header, and those of the released header too.

usage: symbols.py LIBRARY HEADER [RELEASED_HEADER]
"""
import pathlib
import re
import subprocess
import sys

library, header, *released = sys.argv[1:]


def declared(path):
    return set(re.findall(r"KACANOV_API[^;(]*?(kacanov_\w+)\(", pathlib.Path(path).read_text()))


table = subprocess.run(["nm", "-D", "--defined-only", library], check=True, capture_output=True, text=True).stdout
shown = {line.split()[-1].split("@")[0] for line in table.splitlines()}
faults = [f"shown and not declared: {name}" for name in sorted(shown - declared(header))]
faults += [f"declared and not shown: {name}" for name in sorted(declared(header) - shown)]
for path in [header, *released]:
    faults += [f"released and gone: {name}" for name in sorted(declared(path) - shown) if path != header]
    if not declared(path):
        faults.append(f"{path} declares nothing")
print("\n".join(faults) if faults else f"{len(shown)} functions")
sys.exit(bool(faults))
