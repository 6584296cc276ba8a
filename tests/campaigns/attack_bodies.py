# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of the random cases: boxes of cells, deformed, with groups, written for Gmsh with arbitrary numbering."""
import itertools
import math
import pathlib
import sys
from dataclasses import dataclass, field

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "perf" / "runs"))
from lattice_mesh import CUBE, KINDS, TET_EDGES, lattice  # noqa: E402

POINT = 15  # Gmsh's number of the element that is a node
FLAT = ("tri3", "quad4")


@dataclass
class Mesh:
    """Nodes and elements by index; named groups of elements (one per element), of facets and of nodes."""
    element: str
    nodes: list
    elements: list
    parts: dict                                  # name: indices of elements
    facets: dict                                 # name: lists of node indices
    points: dict = field(default_factory=dict)   # name: node indices
    node_tags: list = None
    element_order: list = None                   # order in which elements are written

    @property
    def dim(self):
        return 2 if self.element in FLAT else 3

    def tags(self):
        return self.node_tags or list(range(1, len(self.nodes) + 1))

    def write(self, path):
        """Writes Gmsh 2.2; elements of two groups are written once per group."""
        tag, dim = self.tags(), self.dim
        kind, facet_kind = KINDS[self.element]
        groups = [(dim, name, kind, [(i, self.elements[i]) for i in places]) for name, places in self.parts.items()]
        groups += [(dim - 1, name, facet_kind, [(None, f) for f in facets]) for name, facets in self.facets.items()]
        groups += [(0, name, POINT, [(None, [n]) for n in places]) for name, places in self.points.items()]
        lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(groups))]
        lines += [f'{d} {g} "{name}"' for g, (d, name, _, _) in enumerate(groups, 1)]
        lines += ["$EndPhysicalNames", "$Nodes", str(len(self.nodes))]
        order = sorted(range(len(tag)), key=lambda n: tag[n])
        lines += [f"{tag[n]} " + " ".join(repr(float(c)) for c in (*self.nodes[n], 0.0)[:3]) for n in order]
        entries = [(i, k, g, ns) for g, (_, _, k, members) in enumerate(groups, 1) for i, ns in members]
        if self.element_order:
            place = {e: p for p, e in enumerate(self.element_order)}
            entries.sort(key=lambda entry: len(place) if entry[0] is None else place[entry[0]])
        lines += ["$EndNodes", "$Elements", str(len(entries))]
        lines += [f"{i} {k} 2 {g} {g} " + " ".join(str(tag[n]) for n in ns)
                  for i, (_, k, g, ns) in enumerate(entries, 1)]
        path.write_text("\n".join(lines) + "\n$EndElements\n")

    def surface(self, name):
        """Returns the node indices of a group of facets."""
        return sorted({n for facet in self.facets[name] for n in facet})


def make(size, cells, element, keep=lambda *cell: True):
    """Returns the box [0, size] of those lattice cells for which `keep` returns true."""
    body = lattice(cells, element, lambda *s: [c * length for c, length in zip(s, size)], keep=keep)
    return Mesh(element, body.nodes, body.elements, {}, dict(body.facets))


def centre(mesh, nodes):
    corners = nodes[:{"tet10": 4}.get(mesh.element, len(nodes))]
    return [sum(mesh.nodes[n][c] for n in corners) / len(corners) for c in range(mesh.dim)]


def within(mesh, nodes, lower, upper, slack):
    return all(low - slack <= mesh.nodes[n][c] <= high + slack
               for n in nodes for c, (low, high) in enumerate(zip(lower, upper)))


def twice(mesh, offset):
    """Returns the mesh with a copy of it beside it, in the same groups."""
    count = len(mesh.nodes)
    copies = [tuple(a + b for a, b in zip(x, offset)) for x in mesh.nodes]
    def moved(lists):
        return [[n + count for n in ns] for ns in lists]
    facets = {name: fs + moved(fs) for name, fs in mesh.facets.items()}
    return Mesh(mesh.element, mesh.nodes + copies, mesh.elements + moved(mesh.elements), {}, facets)


def warped(mesh, move):
    mesh.nodes = [tuple(move(list(x))) for x in mesh.nodes]


def shaken(mesh, by, rng):
    """Moves interior corners randomly, by at most `by` along each axis; mid-side nodes follow."""
    still = {n for facets in mesh.facets.values() for f in facets for n in f}
    quadratic = mesh.element == "tet10"
    corners = {n for e in mesh.elements for n in e[:4]} if quadratic else set(range(len(mesh.nodes)))
    mesh.nodes = [tuple(c + rng.uniform(-by, by) for c in x) if n in corners and n not in still else x
                  for n, x in enumerate(mesh.nodes)]
    if quadratic:
        for e in mesh.elements:
            for (a, b), middle in zip(TET_EDGES, e[4:]):
                if middle not in still:
                    mesh.nodes[middle] = tuple((p + q) / 2 for p, q in zip(mesh.nodes[e[a]], mesh.nodes[e[b]]))


def turns_of_cube():
    """Returns the orders of a hexahedron's corners that are rotations of it."""
    def number(x):
        return CUBE.index(tuple(int(c > 0) for c in x))
    found = []
    for axes in itertools.permutations(range(3)):
        for signs in itertools.product((1, -1), repeat=3):
            parity = math.prod(signs) * (-1) ** sum(axes[i] > axes[j] for i in range(3) for j in range(i + 1, 3))
            if parity > 0:
                found.append([number([signs[k] * (2 * CUBE[n][axes[k]] - 1) for k in range(3)]) for n in range(8)])
    return found


def reordered(element, nodes, rng):
    """Returns the same element with its corners in another order of the same orientation."""
    if element in ("tri3", "quad4"):
        k = rng.randrange(len(nodes))
        return nodes[k:] + nodes[:k]
    if element == "hex8":
        return [nodes[i] for i in rng.choice(turns_of_cube())]
    even = [p for p in itertools.permutations(range(4))
            if sum(p[i] > p[j] for i in range(4) for j in range(i + 1, 4)) % 2 == 0]
    order = rng.choice(even)
    corners = [nodes[i] for i in order]
    if element == "tet4":
        return corners
    middle = {frozenset((nodes[a], nodes[b])): n for (a, b), n in zip(TET_EDGES, nodes[4:])}
    return corners + [middle[frozenset((corners[a], corners[b]))] for a, b in TET_EDGES]


def renumbered(mesh, rng):
    """Returns the same mesh with other tags with gaps, and with elements and their corners in another order."""
    tags = rng.sample(range(1, 3 * len(mesh.nodes) + 1), len(mesh.nodes))
    elements = [reordered(mesh.element, e, rng) for e in mesh.elements]
    order = list(range(len(elements)))
    rng.shuffle(order)
    return Mesh(mesh.element, mesh.nodes, elements, mesh.parts, mesh.facets, mesh.points, tags, order)

