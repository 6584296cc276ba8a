#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Computes the include graph of the source folders and fails where an include points upwards.

usage: include_graph.py ROOT [--dot FILE] [--short]

Each folder is a room: it may include itself and the rooms of the levels before its own. Also checks, file by file: that
public headers include public headers only, that included files exist, the SPDX line, the sentence that describes the
file, the number of lines, that solver/ has no loose code, and that streams in code loaded by a host do not depend on
the host's locale. Files below 50 lines need a reason (short_files.txt); --short prints those that have none.
"""
import argparse
import collections
import pathlib
import posixpath
import re
import statistics
import sys

# From the lowest level up; rooms of one level do not include each other.
LEVELS = [
    ["kernels/cells", "tools/verify"],  # which must not include anything that it verifies
    ["kernels/law"],
    ["kernels/reference", "kernels/simd", "kernels/parallel"],
    ["kernels/operator"],
    ["kernels/multigrid"],
    ["kernels/multigrid/aggregation", "kernels/multigrid/octree"],
    ["kernels/multigrid/mixed"],
    ["kernels/multigrid/choice"],
    ["kernels/c"],
    ["kernels/examples"],
    ["solver/mesh"],
    ["solver/problem"],
    ["solver/partition"],
    ["solver/linear"],
    ["solver/amg", "solver/contact"],
    ["solver/spectrum"],
    ["solver/recovery"],
    ["solver/results"],
    ["solver/nonlinear"],
    ["solver/solve"],
    ["solver/moving"],
    ["tools/formats"],
    ["tools/case"],
    ["tools/pictures"],
    ["tools/program"],
    ["tools/embedding"],
    ["perf/benchmarks", "python/src"],
    ["tests"],  # what test programs share
    ["tests/kernels", "tests/embedding"],
    ["tests/solver"],
    ["tests/tools", "tests/cases", "tests/campaigns", "tests/install/consumer"],
    ["tests/fuzz"],
]
# The first folder counts too: what stands further right includes what stands further left.
TOPS = ["kernels", "solver", "tools", ("perf", "python"), "tests"]
PUBLIC = ["kernels/include/kacanov", "solver/include/kacanov", "tools/include/kacanov"]
# Folders searched for "room/file.hpp", after the including file's own folder.
INCLUDE_FOLDERS = ["kernels", "solver", "tools", "tests/solver"]

# A public header belongs to the room of the source file with its name; these have none, or one of another name.
HEADER_ROOMS = {
    "kacanov.h": "kernels/c",
    "kacanov_solve.h": "tools/embedding",
    "mesh_view.hpp": "kernels/cells",
    "error.hpp": "kernels/cells",
    "transport.hpp": "kernels/parallel",
    "vector3.hpp": "kernels/cells",
    "model.hpp": "solver/problem",
    "constraint_rows.hpp": "solver/problem",
    "result.hpp": "solver/problem",
    "totals.hpp": "solver/problem",
    "corner_dilatation.hpp": "solver/linear",
    "raise_order.hpp": "solver/mesh",
    "index_runs.hpp": "solver/partition",
    "part.hpp": "solver/partition",
    "rules.hpp": "solver/problem",
    "validity.hpp": "solver/problem",
    "run_options.hpp": "solver/nonlinear",
}

SHORT_FILES = "tests/structure/short_files.txt"
TO_MERGE = "to merge"  # short files of the past; no new ones

PLAIN_STREAMS = "solver/mesh/classic_locale_stream.hpp"
MOST_LINES = 800
LEAST_LINES = 50
# Reasons for files below LEAST_LINES; all others are listed in short_files.txt.
SHORT_CLASSES = {
    "public header": lambda path, lengths: str(pathlib.PurePath(path).parent) in [*PUBLIC, "kernels/include"],
    "instruction set": lambda path, lengths: re.fullmatch(r"kernels/simd/\w+_(avx2|avx512|plain)\.cpp", path),
    "fuzz target": lambda path, lengths: re.fullmatch(r"tests/fuzz/\w+_fuzz\.cpp", path),
    "header of a source file": lambda path, lengths: path.endswith(".hpp") and
        lengths.get(path, 0) + lengths.get(path[:-4] + ".cpp", 0) >= 150,
}
# Upward includes that still exist: (room, included room). An unnecessary entry is an error.
KNOWN_BACKWARD = set()

CODE = {".cpp", ".hpp", ".h", ".c", ".py"}


def source_files(root):
    """Returns the project's source files: everything that is compiled, build files and scripts."""
    tops = sorted({room.split("/")[0] for level in LEVELS for room in level})
    found = [root / "CMakeLists.txt", root / ".ci/full", root / ".ci/run"]
    for top in tops:
        for path in sorted((root / top).rglob("*")):
            if not path.is_file() or "build" in path.parts or "__pycache__" in path.parts:
                continue
            if path.suffix in CODE | {".cmake"} or path.name == "CMakeLists.txt":
                found.append(path)
            elif not path.suffix and path.open("rb").read(2) == b"#!":
                found.append(path)
    return [path for path in found if path.exists()]


def room_of(path):
    """Returns the room of a file from its path relative to the root."""
    parts = path.split("/")
    if path == "solver/solve.cpp":
        return "solver/solve"
    if path == "kernels/multigrid/multigrid.cpp":
        return "kernels/multigrid/choice"  # of the hierarchy: the only one to know all
    return "/".join(parts[:-1])


def rooms_of_files(files):
    """Returns the room of each path, and complaints about public headers without a room."""
    sources = {}
    for path in files:
        if path.endswith(".cpp") and path.startswith(("kernels/", "solver/")):
            sources.setdefault(path.split("/")[0] + "/" + pathlib.PurePath(path).stem, []).append(room_of(path))
    rooms, complaints, used = {}, [], set()
    for path in files:
        header = pathlib.PurePath(path)
        if str(header.parent) not in PUBLIC:
            rooms[path] = "kernels/c" if path == "kernels/include/kacanov.h" else room_of(path)
            continue
        same_name = sources.get(path.split("/")[0] + "/" + header.stem, [])
        if header.name in HEADER_ROOMS:
            used.add(header.name)
            rooms[path] = HEADER_ROOMS[header.name]
        elif len(same_name) == 1:
            rooms[path] = same_name[0]
        else:
            complaints.append(f"{path}: no room has one source file of this name: name its room in HEADER_ROOMS")
    complaints += [f"HEADER_ROOMS: {name} is no public header" for name in HEADER_ROOMS.keys() - used]
    return rooms, complaints


def included_files(path, text, files):
    """Yields pairs of the name in each #include of the project's files and the included file, or None."""
    for bracket, name in re.findall(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', text, re.MULTILINE):
        if bracket == "<":
            candidates = [f"{top}/include/{name}" for top in ("kernels", "solver", "tools")]
            if not name.startswith("kacanov"):
                continue
        else:
            beside = posixpath.normpath(posixpath.join(posixpath.dirname(path), name))
            candidates = [beside] + [f"{top}/{name}" for top in INCLUDE_FOLDERS]
        yield name, next((c for c in candidates if c in files), None)


def top_of(room):
    """Returns the place of a room's first folder in TOPS."""
    first = room.split("/")[0]
    return next(number for number, top in enumerate(TOPS) if first == top or (isinstance(top, tuple) and first in top))


def draw(texts):
    """Returns arrows between rooms, each with the includes behind it, and complaints; `texts` maps paths to
    contents."""
    rooms, complaints = rooms_of_files(texts)
    arrows = {}
    for path, text in texts.items():
        if pathlib.PurePath(path).suffix not in CODE - {".py"} or path not in rooms:
            continue
        for name, target in included_files(path, text, texts):
            if target is None:
                complaints.append(f"{path}: includes {name}, which is not there")
            elif target in rooms:
                arrows.setdefault((rooms[path], rooms[target]), []).append(f"{path} includes {name}")
                if "/include/" in path and "/include/" not in target:
                    complaints.append(f"{path}: is installed, and includes {name}, which is not")
    return arrows, complaints


def backward(arrows):
    """Returns complaints about includes of rooms that are not on a lower level, and about unnecessary exceptions."""
    level_of = {room: number for number, level in enumerate(LEVELS) for room in level}
    complaints, met = [], set()
    for (room, target), includes in arrows.items():
        unknown = [r for r in (room, target) if r not in level_of]
        complaints += [f"{r}: no such room in LEVELS: {includes[0]}" for r in unknown]
        if unknown or room == target or (level_of[target] < level_of[room] and top_of(target) <= top_of(room)):
            continue
        met.add((room, target))
        if (room, target) not in KNOWN_BACKWARD:
            complaints += [f"{room} → {target} runs back: {include}" for include in includes]
    complaints += [f"KNOWN_BACKWARD: {a} → {b} is gone: strike it" for a, b in KNOWN_BACKWARD - met]
    return complaints


def opening(text):
    """Returns the comment below the SPDX line as plain text."""
    lines = text.splitlines()
    if lines and lines[0].startswith("#!"):
        lines = lines[1:]
    comment = r'\s*(//|/?\*|# )'
    below = lines[1:4]
    if not below or not re.match(comment + '|"""', below[0]):
        return ""
    kept = [line for line in below if below[0].startswith('"""') or re.match(comment, line)]
    return " ".join(line.strip(' /*#"') for line in kept)


def file_complaints(path, text):
    """Yields complaints about the first lines and the length of one file."""
    lines = text.splitlines()
    head = lines[1:2] if lines and lines[0].startswith("#!") else lines[:1]
    if not head or "SPDX-License-Identifier: BSD-3-Clause" not in head[0]:
        yield f"{path}: no SPDX line at its top"
    elif not re.search(r"\w+ .*[\w)][.:;]", opening(text)):
        yield f"{path}: no sentence below the SPDX line that says what it is for"
    if len(lines) > MOST_LINES:
        yield f"{path}: {len(lines)} lines, more than {MOST_LINES}: it holds two subjects"
    if re.fullmatch(r"solver/[^/]+\.[ch](pp)?", path) and path != "solver/solve.cpp":
        yield f"{path}: loose code in solver/: put it into a folder"
    if path.startswith(("solver/", "tools/")) and not path.startswith("tools/verify/") and path != PLAIN_STREAMS:
        for number, line in enumerate(lines, 1):
            if found := re.search(r"std::[io]?(string|f)stream\b", line):
                yield f"{path}:{number}: {found[0]} writes as the host's locale says: take one of {PLAIN_STREAMS}"


def reasons_of_short_files(text):
    """Returns a dictionary from path to reason of the lines `PATH: REASON` of short_files.txt."""
    return dict(line.split(": ", 1) for line in text.splitlines() if line and not line.startswith("#"))


def short_files(texts, reasons):
    """Returns a dictionary from each code file below LEAST_LINES to its reason, None if it has none."""
    lengths = {path: len(text.splitlines()) for path, text in texts.items() if pathlib.PurePath(path).suffix in CODE}
    moved = {pathlib.PurePath(path).name for path in reasons if reasons[path] == TO_MERGE and path not in texts}
    found = {}
    for path, length in lengths.items():
        if length < LEAST_LINES:
            of_class = next((name for name, fits in SHORT_CLASSES.items() if fits(path, lengths)), None)
            kept = TO_MERGE if pathlib.PurePath(path).name in moved else None  # it moved to another folder
            found[path] = of_class or reasons.get(path) or kept
    return found


def print_drawing(arrows):
    for level in LEVELS:
        for room in level:
            targets = [r for lower in LEVELS for r in lower if (room, r) in arrows and r != room]
            print(f"  {room:<18}" + (f" → {', '.join(targets)}" if targets else ""))


def write_dot(arrows, path):
    lines = ["digraph rooms {", "  rankdir=BT; node [shape=box, fontname=sans];"]
    lines += [f'  {{ rank=same; {" ".join(chr(34) + room + chr(34) + ";" for room in level)} }}' for level in LEVELS]
    lines += [f'  "{a}" -> "{b}";' for a, b in sorted(arrows) if a != b]
    path.write_text("\n".join(lines + ["}"]) + "\n", encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("root", type=pathlib.Path)
    parser.add_argument("--dot", type=pathlib.Path, metavar="FILE", help="write the drawing for Graphviz")
    parser.add_argument("--short", action="store_true", help="print only the short files without a reason")
    arguments = parser.parse_args()
    texts = {path.relative_to(arguments.root).as_posix(): path.read_text(encoding="utf-8")
             for path in source_files(arguments.root)}
    arrows, complaints = draw(texts)
    complaints += backward(arrows)
    for path, text in texts.items():
        complaints += file_complaints(path, text)
    reasons = reasons_of_short_files((arguments.root / SHORT_FILES).read_text(encoding="utf-8"))
    short = short_files(texts, reasons)
    without = [path for path, reason in short.items() if reason is None]
    if arguments.short:
        print("\n".join(without))
        return 1 if without else 0
    complaints += [f"{path}: below {LEAST_LINES} lines: merge it, or add it with a reason to {SHORT_FILES}" for path in without]
    complaints += [f"{SHORT_FILES}: {path} is not short, or its reason is a class: strike it" for path in reasons
                   if reasons[path] != TO_MERGE and reasons[path] != short.get(path)]

    print_drawing(arrows)
    if arguments.dot:
        write_dot(arrows, arguments.dot)
    lengths = {path: len(text.splitlines()) for path, text in texts.items() if pathlib.PurePath(path).suffix in CODE}
    largest = max(lengths, key=lengths.get)
    print(f"{len(lengths)} source files, {sum(lengths.values())} lines; "
          f"median {statistics.median(lengths.values()):g}, "
          f"90th percentile {statistics.quantiles(lengths.values(), n=10)[-1]:g}, "
          f"largest {largest} with {lengths[largest]}")
    counts = collections.Counter(reason if reason in (*SHORT_CLASSES, TO_MERGE) else "other reasons" for reason in short.values())
    print(f"{len(short)} files below {LEAST_LINES} lines: " + ", ".join(f"{reason} {n}" for reason, n in counts.most_common()))
    for complaint in complaints:
        print(complaint, file=sys.stderr)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
