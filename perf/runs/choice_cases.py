# SPDX-License-Identifier: BSD-3-Clause
"""The cases of bench_choices: case files as dictionaries, and the mesh of the half ball."""
import math
import pathlib

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "tools" / "examples"


def law(kind, x0):
    return {"type": "linear"} if kind == "linear" else {"type": "logarithmic", "x0": x0}


def plane(dim, gap, friction, on):
    entry = {"on": on, "obstacle": {"plane": {"point": [0] * (dim - 1) + [-gap], "normal": [0] * (dim - 1) + [1]}}}
    if friction:
        entry["friction"] = {"tresca": friction}
    return entry


def beam(dim, n, gap, friction, kind):
    """Returns the paper's beam with h = 1/n; in 3D of depth 1."""
    size, cells = ([4, 1], [4 * n, n]) if dim == 2 else ([4, 1, 1], [4 * n, n, n])
    top = [[2, 1], [4, 1]] if dim == 2 else [[2, 0, 1], [4, 1, 1]]
    return {"mesh": {"box": {"size": size, "cells": cells, "element": "tri3" if dim == 2 else "tet4"}},
            "material": [{"on": "all", "young": 1.0, "poisson": 0.3, "law": law(kind, 0.01)}],
            "boundary": [{"on": "left", "displacement": [0] * dim},
                         {"on": {"box": top}, "traction": [0] * (dim - 1) + [-0.05]}],
            "contact": [plane(dim, gap, 0.01 if friction else 0, "bottom")]}


def rocker(gap, friction, kind):
    """Returns the case of tools/examples/rocker.msh; with friction it is also pushed sideways."""
    push = [0.004, 0.003, -0.02] if friction else [0, 0, -0.02]
    return {"mesh": {"file": str(EXAMPLES / "rocker.msh")},
            "material": [{"on": "all", "young": 1.0, "poisson": 0.3, "law": law(kind, 0.005)}],
            "boundary": [{"on": "clamp", "displacement": [0, 0, 0]}, {"on": "top", "traction": push}],
            "contact": [plane(3, gap, 0.003 if friction else 0, "base")]}


def half_ball(n, gap, friction, kind, folder):
    """Returns Hertz's problem: a half ball of radius 1, its flat face pressed down by 0.05 (and sideways by 0.005 with
    friction) on a plane at distance `gap`."""
    mesh = pathlib.Path(folder) / f"half_ball_{n}.msh"
    if not mesh.exists():
        mesh.write_text(half_ball_mesh(n))
    return {"mesh": {"file": str(mesh)},
            "material": [{"on": "all", "young": 1.0, "poisson": 0.3, "law": law(kind, 0.01), "bbar": False}],
            "boundary": [{"on": "flat", "displacement": [0.005 if friction else 0, 0, -0.05 - gap]}],
            "contact": [plane(3, gap, 0.01 if friction else 0, "round")]}


def step42(n):
    """Returns deal.II's step-42: a rigid sphere pressed into a cube with linear hardening, gamma = 0.01."""
    sides = [{"on": name, "displacement": [0, 0, None]} for name in ("left", "right", "front", "back")]
    x0 = 400.0 / (2 * 2e5 / 2.6)
    return {"mesh": {"box": {"size": [1, 1, 1], "cells": [n, n, n], "element": "hex8"}},
            "material": [{"on": "all", "young": 2e5, "poisson": 0.3,
                          "law": {"type": "linear_hardening", "x0": x0, "gamma": 0.01}, "bbar": False}],
            "boundary": [{"on": "bottom", "displacement": [0, 0, 0]}] + sides,
            "contact": [{"on": "top", "obstacle": {"sphere": {"centre": [0.5, 0.5, 1.59], "radius": 0.6,
                                                              "direction": [0, 0, 1]}}}]}


def half_ball_mesh(n):
    """Returns a Gmsh 2.2 mesh: 2n × 2n × n hexahedra in the lower half of the unit ball around (0, 0, 1), finer towards
    the origin.

    The box [-1, 1]² × [-1, 0] is mapped by the smooth map x sqrt(1 - y²/2 - z²/2 + y²z²/3) and its permutations.
    """
    across = [math.copysign(abs(i / n - 1) ** 1.5, i - n) for i in range(2 * n + 1)]
    down = [(k / n) ** 1.5 - 1 for k in range(n + 1)]

    def point(x, y, z):
        def stretch(a, b):
            return math.sqrt(1 - a * a / 2 - b * b / 2 + a * a * b * b / 3)
        return x * stretch(y, z), y * stretch(z, x), 1 + z * stretch(x, y)

    def node(i, j, k):
        return 1 + i + (2 * n + 1) * (j + (2 * n + 1) * k)

    nodes = [point(x, y, z) for z in down for y in across for x in across]
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "3", '2 1 "round"', '2 2 "flat"',
             '3 3 "body"', "$EndPhysicalNames", "$Nodes", str(len(nodes))]
    lines += [f"{i} {x:.17g} {y:.17g} {z:.17g}" for i, (x, y, z) in enumerate(nodes, 1)]
    elements = []
    for i in range(2 * n):
        for j in range(2 * n):
            for group, k in ((1, 0), (2, n)):
                elements.append((3, group, [node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k), node(i, j + 1, k)]))
            for k in range(n):
                face = [node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k), node(i, j + 1, k)]
                elements.append((5, 3, face + [m + (2 * n + 1) ** 2 for m in face]))
    lines += ["$EndNodes", "$Elements", str(len(elements))]
    lines += [f"{e} {kind} 2 {group} {group} " + " ".join(map(str, corners))
              for e, (kind, group, corners) in enumerate(elements, 1)]
    return "\n".join(lines) + "\n$EndElements\n"


def suite(folder):
    """Returns {name: case}; generated meshes are written to `folder`."""
    cases = {}

    def add(name, gap, friction, kind, case):
        cases[f"{name} gap {gap:g} {'tresca' if friction else 'smooth'} {kind}"] = case

    for kind in ("linear", "log"):
        for friction in (False, True):
            for n in (16, 32, 64):
                for gap in (0, 0.01, 0.05, 0.3):
                    add(f"beam2d {n}", gap, friction, kind, beam(2, n, gap, friction, kind))
            for n in (8, 16):
                for gap in (0, 0.3):
                    add(f"beam3d {n}", gap, friction, kind, beam(3, n, gap, friction, kind))
            for gap in (0, 0.05):
                add("rocker", gap, friction, kind, rocker(gap, friction, kind))
            for n, gap in ((6, 0), (12, 0), (12, 0.3)):
                add(f"hertz {n}", gap, friction, kind, half_ball(n, gap, friction, kind, folder))
    for n in (8, 16, 32):
        cases[f"step42 {n}"] = step42(n)
    for case in cases.values():
        case["solver"] = {"tolerance": 1e-6}
        case["output"] = {"fields": "none", "report": False}
    return cases


QUICK = ("beam2d 16 gap 0 *", "beam3d 8 gap 0 *", "rocker gap 0 *", "hertz 6 gap 0 *", "step42 8")
