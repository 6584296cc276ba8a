# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of lattices of cells, placed by a function and divided into elements, written for Gmsh."""
import itertools
from dataclasses import dataclass, field

CUBE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
TET_EDGES = [(0, 1), (1, 2), (2, 0), (3, 0), (3, 2), (3, 1)]
FLAT = ("tri3", "quad4")
KINDS = {"tri3": (2, 1), "quad4": (3, 1), "tet4": (4, 2), "tet10": (11, 9), "hex8": (5, 3)}  # Gmsh's numbers: element, facet


@dataclass
class Body:
    element: str
    nodes: list = field(default_factory=list)     # coordinates
    elements: list = field(default_factory=list)  # zero-based node numbers
    facets: dict = field(default_factory=dict)    # name: lists of node numbers

    @property
    def dim(self):
        return 2 if self.element in FLAT else 3

    def write(self, path):
        """Writes Gmsh 2.2."""
        kind, facet_kind = KINDS[self.element]
        names = sorted(self.facets)
        lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names) + 1)]
        lines += [f'{self.dim - 1} {i} "{name}"' for i, name in enumerate(names, 1)]
        lines += [f'{self.dim} {len(names) + 1} "body"', "$EndPhysicalNames", "$Nodes", str(len(self.nodes))]
        lines += [f"{i} " + " ".join(f"{c:.17g}" for c in (*x, 0.0)[:3]) for i, x in enumerate(self.nodes, 1)]
        entries = [(facet_kind, i, f) for i, name in enumerate(names, 1) for f in self.facets[name]]
        entries += [(kind, len(names) + 1, e) for e in self.elements]
        lines += ["$EndNodes", "$Elements", str(len(entries))]
        lines += [f"{i} {k} 2 {g} {g} " + " ".join(str(n + 1) for n in ns) for i, (k, g, ns) in enumerate(entries, 1)]
        path.write_text("\n".join(lines) + "\n$EndElements\n")


def determinant(rows):
    (a, b, c), (d, e, f), (g, h, i) = rows
    return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)


def lattice(cells, element, place, keep=lambda *cell: True, name=None):
    """Returns a body of the cells for which `keep` returns true; `place` maps a lattice point in [0, 1]^dim to its
    position.
    Facets are named left, right, front, back, bottom, top, and `inner` plus that name if a missing cell exposes them;
    `name` renames them."""
    dim = len(cells)
    body, number = Body(element), {}
    sides = [("left", "right"), ("front", "back"), ("bottom", "top")] if dim == 3 else [("left", "right"), ("bottom", "top")]

    def node(point):
        if point not in number:
            number[point] = len(body.nodes)
            body.nodes.append(tuple(place(*(p / c for p, c in zip(point, cells)))))
        return number[point]

    kept = {cell for cell in itertools.product(*map(range, cells)) if keep(*cell)}
    for cell in sorted(kept):
        def corner(*offset):
            return node(tuple(a + b for a, b in zip(cell, offset)))
        if dim == 2:
            a, b, c, d = corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)
            body.elements += [[a, b, c, d]] if element == "quad4" else [[a, b, c], [a, c, d]]
        elif element == "hex8":
            body.elements.append([corner(*o) for o in CUBE])
        else:
            for order in itertools.permutations(range(3)):
                at, path = [0, 0, 0], [corner(0, 0, 0)]
                for axis in order:
                    at[axis] = 1
                    path.append(corner(*at))
                x = [body.nodes[n] for n in path]
                if determinant([[b - a for a, b in zip(x[0], x[k])] for k in (1, 2, 3)]) < 0:
                    path[1], path[2] = path[2], path[1]
                body.elements.append(path)
        for axis, end in itertools.product(range(dim), (0, 1)):
            beside = tuple(c + (2 * end - 1 if k == axis else 0) for k, c in enumerate(cell))
            if beside in kept:
                continue
            outer = cell[axis] == (cells[axis] - 1 if end else 0)
            side = sides[axis][end] if outer else f"inner {sides[axis][end]}"
            offsets = [o for o in itertools.product((0, 1), repeat=dim) if o[axis] == end]
            if dim == 3:
                offsets[2], offsets[3] = offsets[3], offsets[2]  # counter-clockwise
            around = [corner(*o) for o in offsets]
            facets = [around] if dim == 2 or element == "hex8" else [around[:3], [around[0], *around[2:]]]
            body.facets.setdefault(name(side) if name else side, []).extend(facets)
    if element == "tet10":
        add_middles(body)
    return body


def add_middles(body):
    middle = {}

    def between(a, b):
        key = (min(a, b), max(a, b))
        if key not in middle:
            middle[key] = len(body.nodes)
            body.nodes.append(tuple(0.5 * (p + q) for p, q in zip(body.nodes[a], body.nodes[b])))
        return middle[key]

    body.elements = [e + [between(e[a], e[b]) for a, b in TET_EDGES] for e in body.elements]
    for name, facets in body.facets.items():
        body.facets[name] = [f + [between(f[0], f[1]), between(f[1], f[2]), between(f[2], f[0])] for f in facets]
