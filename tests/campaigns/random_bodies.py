# SPDX-License-Identifier: BSD-3-Clause
"""Bodies for the random cases of hard_cases: lattices of cells, deformed, divided into elements, written for Gmsh."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "perf" / "runs"))
from lattice_mesh import FLAT, TET_EDGES, Body, lattice  # noqa: E402, F401


def join(first, second):
    """Returns two pieces as one mesh; the names of the second get a prime."""
    offset = len(first.nodes)
    joined = Body(first.element, first.nodes + second.nodes,
                  first.elements + [[n + offset for n in e] for e in second.elements], dict(first.facets))
    for name, facets in second.facets.items():
        joined.facets[name + "'"] = [[n + offset for n in f] for f in facets]
    return joined


def cells_for(size, element, most, rng):
    """Returns the cells along each side, about as long as wide, for at most about `most` nodes."""
    per_cell = {"tri3": 1, "quad4": 1, "tet4": 1, "hex8": 1, "tet10": 8}[element]
    target = rng.uniform(0.25, 1.0) * most / per_cell
    h = (math.prod(size) / target) ** (1 / len(size))
    return [max(1 if element == "tet10" else 2, round(s / h)) for s in size]


def block(size, element, most, rng, distorted=False):
    """Returns a box; distorted: sheared, tapered, with wavy inner lines. The bottom does not change."""
    cells = cells_for(size, element, most, rng)
    lean, taper, wave = (rng.uniform(-0.25, 0.25) for _ in range(3)) if distorted else (0.0, 0.0, 0.0)

    def place(*s):
        up = s[-1]
        x = [0.5 + (c - 0.5) * (1 + taper * up) for c in s[:-1]]
        x[0] += lean * up + 0.3 * wave * math.sin(math.pi * up) * math.sin(2 * math.pi * s[0])
        return [*(c * length for c, length in zip(x, size)), (up + 0.2 * wave * up * (1 - up) * math.cos(3 * s[0])) * size[-1]]
    return lattice(cells, element, place)


def half_ball(radius, element, most, rng):
    """Returns half a ball (half a disc in 2D), lowest point at the origin; facets `round` and `flat`."""
    dim = 2 if element in FLAT else 3
    n = cells_for([2.0] * (dim - 1) + [1.0], element, most, rng)
    n = [max(2, c + c % 2) for c in n[:-1]] + [n[-1]]

    def finer(s):
        return math.copysign(abs(2 * s - 1) ** 1.3, s - 0.5)

    def place(*s):
        flat, z = [finer(c) for c in s[:-1]], s[-1] ** 1.3 - 1
        if dim == 2:
            x, = flat
            return [radius * x * math.sqrt(1 - z * z / 2), radius * (1 + z * math.sqrt(1 - x * x / 2))]
        def stretch(a, b):
            return math.sqrt(1 - a * a / 2 - b * b / 2 + a * a * b * b / 3)
        x, y = flat
        return [radius * x * stretch(y, z), radius * y * stretch(z, x), radius * (1 + z * stretch(x, y))]
    return lattice(n, element, place, name=lambda side: "flat" if side == "top" else "round")


def wedge(width, height, depth, slope, element, most, rng):
    """Returns a trapezium symmetric about x = 0, `width` wide at its bottom, wider by `slope` per height on each side
    above."""
    size = [width, height] if element in FLAT else [width, depth, height]
    cells = cells_for(size, element, most, rng)

    def place(*s):
        x = (2 * s[0] - 1) * (0.5 * width + slope * height * s[-1])
        return [x, *(c * length for c, length in zip(s[1:-1], size[1:-1])), s[-1] * height]
    return lattice(cells, element, place)


def bracket(size, element, most, rng):
    """Returns an L: a foot along x and an upright at x = 0, each a third of the size thick."""
    cells = cells_for(size, element, most * 1.8, rng)
    for axis in (0, -1):
        cells[axis] = max(3, round(cells[axis] / 3) * 3)
    return lattice(cells, element, lambda *s: [c * length for c, length in zip(s, size)],
                   keep=lambda *cell: cell[0] < cells[0] // 3 or cell[-1] < cells[-1] // 3)


def hook(radius, thickness, element, most, rng):
    """Returns part of a ring about the origin, from the top (`end`) over the right; facets `inside`, `outside`,
    `tip`."""
    angle = rng.uniform(0.6, 1.3) * math.pi
    size = [radius * angle, thickness] if element in FLAT else [radius * angle, rng.uniform(0.5, 1.5) * thickness, thickness]
    cells = cells_for(size, element, most, rng)

    def place(*s):
        r, a = radius + (s[-1] - 0.5) * thickness, 0.5 * math.pi - angle * s[0]
        return [r * math.cos(a), *(c * length for c, length in zip(s[1:-1], size[1:-1])), r * math.sin(a)]
    names = {"left": "end", "right": "tip", "bottom": "inside", "top": "outside"}
    return lattice(cells, element, place, name=lambda side: names.get(side, side))
