#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The inputs that the fuzz targets start from: those of seeds.txt, and those that a rule describes.

usage: tests/fuzz/seeds.py FOLDER                   writes each seed to FOLDER/TARGET/NAME
       tests/fuzz/seeds.py --add TARGET NAME FILE   appends the bytes of FILE to seeds.txt

In seeds.txt a line `== TARGET/NAME` starts a seed. Its lines follow, each with its end of line, unless a backslash ends
it. `\\\\` is a backslash, `\\xNN` a byte; all other characters are ASCII.
"""
import argparse
import pathlib
import re
import struct

TEXT = pathlib.Path(__file__).resolve().parent / "seeds.txt"
WIDTH = 104  # where a line is broken
SHARED = {"solve": ("case", ("all_zero", "every_law", "plane_tresca", "sphere_of_1e38", "stiffness_ratio"))}


def encode(content):
    """Returns the lines of seeds.txt for these bytes."""
    words = [chr(b) if b == 10 or (32 < b < 127 and b != 92) else f"\\x{b:02x}" if b != 92 else "\\\\" for b in content]
    lines, line = [], ""
    for word, after in zip(words, [*words[1:], "\n"]):
        if word == "\n":
            lines.append(line)
            line = ""
            continue
        if len(line) > WIDTH:
            lines.append(line + "\\")
            line = ""
        blank = word == "\\x20" and after != "\n" and line
        line += " " if blank else "\\x3d" if word == "=" and not line else word
    return "\n".join(lines + [line + "\\"] if line or not lines else lines) + "\n"


def decode(text):
    def byte(found):
        return {b"\\": b"\\", b"\n": b""}.get(found[1]) if len(found[1]) == 1 else bytes([int(found[1][1:], 16)])
    return re.sub(rb"\\(\\|\n|x[0-9a-f]{2})", byte, text.encode())


def written():
    """Yields target, name and bytes of the seeds in seeds.txt."""
    text = TEXT.read_text(encoding="utf-8")
    for found in re.finditer(r"^== (\w+)/(\w+)\n(.*?)(?=^== |\Z)", text, re.MULTILINE | re.DOTALL):
        yield found[1], found[2], decode(found[3])


def ruled():
    """Yields target, name and bytes of the seeds of which only a number differs, and of the long ones."""
    yield "c", "zeros", bytes(64)
    yield "case", "deep_brackets", 6000 * b"["
    yield "set", "deep_brackets", b"probe=" + 4000 * b"["
    nodes = b"".join(struct.pack("<i3d", *node) for node in ((1, 0, 0, 0), (2, 1, 0, 0), (3, 0, 1, 0)))
    triangles = b"".join(struct.pack("<8i", 2, 1, 1, 1, group, 1, 2, 3) for group in range(1, 1501))
    yield "gmsh", "an_element_in_many_groups", (
        b"$MeshFormat\n2.2 1 8\n" + struct.pack("<i", 1) + b"\n$EndMeshFormat\n$Nodes\n3\n" + nodes +
        b"\n$EndNodes\n$Elements\n1500\n" + triangles + b"\n$EndElements\n")
    for i in range(7):
        yield "part", f"large_index_{i}", struct.pack("<HBBi", 2000 + 9000 * i, i, 1, 0) + b"@"
        yield "part", f"negative_index_{i}", struct.pack("<HBBBi", 6000 + 9000 * i, i, 1, 0, -5)
    for i in range(8):
        yield "checkpoint", f"field_{i}_longer", bytes((1, 0, 0, 0, i, 0, 3, 0, 40, 0))
        yield "checkpoint", f"field_{i}_not_a_number", bytes((1, 0, 0, 0, i, 0, 2, 0, 3, 0, 0))
    for value, code, numbers in (("not_a_number", 0, (0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22)),
                                 ("negative", 10, (1, 5, 9, 13, 17, 21)), ("huge", 11, (0, 5, 10, 15, 20))):
        for i in numbers:
            yield "checkpoint", f"number_{i}_{value}", bytes((1, 0, i, 0, 0, 0, 0, 0, code))


def seeds():
    """Returns a dictionary from target and name to bytes."""
    found = {}
    for target, name, content in (*written(), *ruled()):
        if (target, name) in found:
            raise ValueError(f"{target}/{name} is there twice")
        found[target, name] = content
    for target, (source, names) in SHARED.items():
        found.update({(target, name): found[source, name] for name in names})
    return found


def write(folder):
    for (target, name), content in seeds().items():
        (folder / target).mkdir(parents=True, exist_ok=True)
        (folder / target / name).write_bytes(content)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path, nargs="?")
    parser.add_argument("--add", nargs=3, metavar=("TARGET", "NAME", "FILE"))
    arguments = parser.parse_args()
    if (arguments.folder is None) == (arguments.add is None):
        parser.error("expected FOLDER, or --add TARGET NAME FILE")
    if arguments.folder:
        write(arguments.folder)
        return
    target, name, file = arguments.add
    if (target, name) in seeds() or not re.fullmatch(r"\w+", name):
        parser.error(f"{target}/{name}: this name is taken, or has other characters than letters, digits and _")
    with TEXT.open("a", encoding="utf-8") as text:
        text.write(f"== {target}/{name}\n" + encode(pathlib.Path(file).read_bytes()))


if __name__ == "__main__":
    main()
