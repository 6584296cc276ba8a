#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The KKT residuals of an answer, recomputed from the case and the result files by an assembly that shares nothing with the program.

usage: perf/check_answer.py CASE RESULT_FOLDER

For meshes in Gmsh 2.2, loads on whole sides, planes and spheres without `direction`: what random_cases.py draws. Prints a line an entry.
"""
import collections
import json
import math
import pathlib
import re
import struct
import sys

TYPES = {"Float64": "d", "Int64": "q", "Int32": "i", "UInt8": "B"}
VOLUME = {2: "tri3", 4: "tet4", 11: "tet10", 5: "hex8"}
ROUNDING = 1e-9  # a smaller share of the stiffness times the displacement is none to measure forces by
EDGES = ((0, 1), (1, 2), (2, 0), (3, 0), (3, 2), (3, 1))
CORNERS = ((-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def length(a):
    return math.sqrt(dot(a, a))


def read_arrays(path):
    """The point data of a VTU file with raw appended arrays: {name: rows}."""
    data = path.read_bytes()
    head, _, tail = data.partition(b'<AppendedData encoding="raw">')
    tail = tail[tail.index(b"_") + 1:]
    block = head[head.index(b"<PointData>"):head.index(b"</PointData>")].decode()
    arrays = {}
    for entry in re.findall(r"<DataArray ([^>]*)/>", block):
        keys = dict(re.findall(r'(\w+)="([^"]*)"', entry))
        offset, width, letter = int(keys["offset"]), int(keys["NumberOfComponents"]), TYPES[keys["type"]]
        size, = struct.unpack_from("<Q", tail, offset)
        values = struct.unpack_from(f"<{size // struct.calcsize(letter)}{letter}", tail, offset + 8)
        arrays[keys["Name"]] = [values[i:i + width] for i in range(0, len(values), width)]
    return arrays


class Mesh:
    def __init__(self, path):
        lines = iter(path.read_text().splitlines())
        names, self.nodes, self.elements, self.facets = {}, [], [], collections.defaultdict(list)
        entries = []
        for line in lines:
            if line == "$PhysicalNames":
                for _ in range(int(next(lines))):
                    _, number, name = next(lines).split(None, 2)
                    names[number] = name.strip('"')
            elif line == "$Nodes":
                self.nodes = [[float(c) for c in next(lines).split()[1:]] for _ in range(int(next(lines)))]
            elif line == "$Elements":
                entries = [next(lines).split() for _ in range(int(next(lines)))]
        for _, kind, _, group, _, *nodes in entries:
            nodes = [int(n) - 1 for n in nodes]
            if names[group] == "body":
                self.type = VOLUME[int(kind)]
                self.elements.append(nodes)
            else:
                self.facets[names[group]].append(nodes)
        self.dim = 2 if self.type == "tri3" else 3


def shapes(kind, at):
    """Values and reference gradients of the shape functions."""
    if kind == "hex8":
        one = [[1 + c * x for c, x in zip(corner, at)] for corner in CORNERS]
        values = [f[0] * f[1] * f[2] / 8 for f in one]
        return values, [[c[0] * f[1] * f[2] / 8, f[0] * c[1] * f[2] / 8, f[0] * f[1] * c[2] / 8] for c, f in zip(CORNERS, one)]
    dim = len(at)
    l = [1 - sum(at), *at]
    g = [[-1] * dim] + [[int(i == j) for j in range(dim)] for i in range(dim)]
    if kind != "tet10":
        return l, g
    values = [(2 * x - 1) * x for x in l] + [4 * l[a] * l[b] for a, b in EDGES]
    gradients = [[(4 * l[i] - 1) * c for c in g[i]] for i in range(4)]
    return values, gradients + [[4 * (l[a] * p + l[b] * q) for p, q in zip(g[b], g[a])] for a, b in EDGES]


def rule(kind, exact=False):
    if kind == "hex8":
        p = 1 / math.sqrt(3)
        return [((x, y, z), 1.0) for x in (-p, p) for y in (-p, p) for z in (-p, p)]
    if kind == "tet10":
        a, b = (5 - math.sqrt(5)) / 20, (5 + 3 * math.sqrt(5)) / 20
        return [(x, 1 / 24) for x in ((a, a, a), (b, a, a), (a, b, a), (a, a, b))]
    if kind == "tri3":
        return [((1 / 3, 1 / 3), 0.5)] if not exact else [((a, b), 1 / 6) for a, b in ((1 / 6, 1 / 6), (2 / 3, 1 / 6), (1 / 6, 2 / 3))]
    return [((0.25, 0.25, 0.25), 1 / 6)]


def inverse(j):
    """Of a 2 × 2 or 3 × 3 matrix, and its determinant."""
    if len(j) == 2:
        det = j[0][0] * j[1][1] - j[0][1] * j[1][0]
        return [[j[1][1] / det, -j[0][1] / det], [-j[1][0] / det, j[0][0] / det]], det
    rows = [cross(j[1], j[2]), cross(j[2], j[0]), cross(j[0], j[1])]
    det = dot(j[0], rows[0])
    return [[rows[k][i] / det for k in range(3)] for i in range(3)], det


def secant(law, mu, x):
    """g at the strain norm x."""
    kind = law["type"]
    if kind == "table":
        points, left = law["points"], 1
        while left < len(points) - 1 and x > points[left][0]:
            left += 1
        (a, s), (b, t) = points[left - 1], points[left]
        return (s + (x - a) * (t - s) / (b - a)) / (2 * x) if x > 0 else t / (2 * b)
    if kind == "linear":
        return mu
    x0 = law["x0"] if "x0" in law else math.sqrt(2 / 3) * law["yield_stress"] / (2 * mu)
    if x <= x0:
        return mu
    if kind == "logarithmic":
        return mu * x0 / x * (math.log(x / x0) + 1)
    if kind == "linear_hardening":
        return mu * (law["gamma"] + (1 - law["gamma"]) * x0 / x)
    if kind == "power":
        return mu * (x / x0) ** (law["n"] - 1)
    return mu * x0 / x * (1 + law["q"] * (1 - math.exp(-(x - x0) / (law["q"] * x0))))


def internal_force(mesh, material, u):
    young, nu = material["young"], material["poisson"]
    bulk, mu = young / (3 * (1 - 2 * nu)), young / (2 * (1 + nu))
    """Nodal forces, and ‖diagonal of the stiffness ∘ u‖: a body that moves without strain has nothing else to be measured by."""
    force = [[0.0] * mesh.dim for _ in mesh.nodes]
    diagonal = [0.0] * len(mesh.nodes)
    for element in mesh.elements:
        x = [mesh.nodes[n][:mesh.dim] for n in element]
        for at, weight in rule(mesh.type):
            _, reference = shapes(mesh.type, at)
            jacobian = [[sum(x[a][i] * reference[a][j] for a in range(len(x))) for j in range(mesh.dim)] for i in range(mesh.dim)]
            back, det = inverse(jacobian)
            gradient = [[sum(g[j] * back[j][i] for j in range(mesh.dim)) for i in range(mesh.dim)] for g in reference]
            h = [[sum(u[n][i] * g[j] for n, g in zip(element, gradient)) for j in range(mesh.dim)] for i in range(mesh.dim)]
            strain = [[0.5 * (h[i][j] + h[j][i]) for j in range(mesh.dim)] for i in range(mesh.dim)]
            trace = sum(strain[i][i] for i in range(mesh.dim))
            deviator = [[strain[i][j] - (trace / 3 if i == j else 0) for j in range(mesh.dim)] for i in range(mesh.dim)]
            square = sum(v * v for row in deviator for v in row) + (trace * trace / 9 if mesh.dim == 2 else 0)
            g2 = 2 * secant(material["law"], mu, math.sqrt(square))
            stress = [[g2 * deviator[i][j] + (bulk * trace if i == j else 0) for j in range(mesh.dim)] for i in range(mesh.dim)]
            volume = weight * det
            for n, g in zip(element, gradient):
                diagonal[n] += volume * (bulk + 2 * mu) * dot(g, g)
                for i in range(mesh.dim):
                    force[n][i] += volume * dot(stress[i], g)
    return force, math.sqrt(sum((k * c) ** 2 for k, v in zip(diagonal, u) for c in v))


def facet_weights(mesh, facet):
    """(node, area, outer normal times area) of a facet, whose corners go round, for loads and contact alike."""
    x = [mesh.nodes[n] for n in facet]
    if mesh.dim == 2:
        along = minus(x[1], x[0])
        return [(n, 0.5 * length(along), [0.5 * along[1], -0.5 * along[0], 0.0]) for n in facet]
    if mesh.type == "hex8":
        p, out = 1 / math.sqrt(3), [[n, 0.0, [0.0] * 3] for n in facet]
        for s in (-p, p):
            for t in (-p, p):
                signs = ((-1, -1), (1, -1), (1, 1), (-1, 1))
                ds = [sum(a * (1 + b * t) / 4 * y[c] for (a, b), y in zip(signs, x)) for c in range(3)]
                dt = [sum(b * (1 + a * s) / 4 * y[c] for (a, b), y in zip(signs, x)) for c in range(3)]
                normal = cross(ds, dt)
                for entry, (a, b) in zip(out, signs):
                    value = (1 + a * s) * (1 + b * t) / 4
                    entry[1] += value * length(normal)
                    entry[2] = [v + value * c for v, c in zip(entry[2], normal)]
        return out
    third = [c / 6 for c in cross(minus(x[1], x[0]), minus(x[2], x[0]))]
    # Of tet10 with straight sides the middles of the edges have all.
    return [(n, length(third), third) for n in (facet[3:] if mesh.type == "tet10" else facet)]


def outward(mesh):
    """Facets are written either way round: the sign of each, by the element behind it."""
    behind = {}
    for element in mesh.elements:
        for n in element:
            behind.setdefault(n, []).append(element)
    signs = {}
    corners = 2 if mesh.dim == 2 else 4 if mesh.type == "hex8" else 3
    for facets in mesh.facets.values():
        for facet in facets:
            element = next(e for e in behind[facet[0]] if set(facet) <= set(e))
            middle = [sum(mesh.nodes[n][c] for n in element) / len(element) for c in range(3)]
            at = [sum(mesh.nodes[n][c] for n in facet[:corners]) / corners for c in range(3)]
            normal = [sum(w[2][c] for w in facet_weights(mesh, facet)) for c in range(3)]
            signs[tuple(facet)] = 1 if dot(normal, minus(at, middle)) > 0 else -1
    return signs


def loads_and_supports(mesh, boundary):
    signs = outward(mesh)
    load = [[0.0] * mesh.dim for _ in mesh.nodes]
    held = {}
    for entry in boundary:
        if "body_force" in entry:
            for element in mesh.elements:
                x = [mesh.nodes[n][:mesh.dim] for n in element]
                for at, weight in rule(mesh.type, True):
                    values, reference = shapes(mesh.type, at)
                    jacobian = [[sum(x[a][i] * reference[a][j] for a in range(len(x))) for j in range(mesh.dim)] for i in range(mesh.dim)]
                    volume = weight * inverse(jacobian)[1]
                    for n, value in zip(element, values):
                        for c in range(mesh.dim):
                            load[n][c] += volume * value * entry["body_force"][c]
            continue
        for facet in mesh.facets[entry["on"]]:
            for c, value in enumerate(entry.get("displacement", [])):
                if value is not None:
                    held.update({(n, c): value for n in facet})
            if "displacement" in entry:
                continue
            for n, area, normal in facet_weights(mesh, facet):
                for c in range(mesh.dim):
                    load[n][c] += area * entry["traction"][c] if "traction" in entry else (
                        -entry["pressure"] * signs[tuple(facet)] * normal[c])
    return load, held


def contact_points(mesh, contact):
    """Of every node of an entry, in the order of nodes, then entries: node, normal towards the obstacle, gap, mass, friction."""
    points = []
    for number, entry in enumerate(contact):
        mass = collections.Counter()
        for facet in mesh.facets[entry["on"]]:
            for n, area, _ in facet_weights(mesh, facet):
                mass[n] += area
        for n, area in mass.items():
            if "plane" in entry["obstacle"]:
                plane = entry["obstacle"]["plane"]
                size = length(plane["normal"])
                normal = [-c / size for c in plane["normal"]]
                gap = dot(minus(plane["point"], mesh.nodes[n][:mesh.dim]), normal)
            else:
                sphere = entry["obstacle"]["sphere"]
                away = minus(sphere["centre"], mesh.nodes[n][:mesh.dim])
                gap, normal = length(away) - sphere["radius"], [c / length(away) for c in away]
            points.append((n, number, normal, gap, area, entry.get("friction", {})))
    return sorted(points, key=lambda p: p[:2])


def residuals(case_file, folder):
    case = json.loads(pathlib.Path(case_file).read_text())
    mesh = Mesh(pathlib.Path(case_file).parent / case["mesh"]["file"])
    body, contact = read_arrays(folder / "body.vtu"), read_arrays(folder / "contact.vtu")
    u = [None] * len(mesh.nodes)
    for (node,), value in zip(body["node_id"], body["displacement"]):
        u[node - 1] = value[:mesh.dim]
    load, held = loads_and_supports(mesh, case["boundary"])
    internal, stiff = internal_force(mesh, case["material"][0], u)
    pressures = collections.defaultdict(list)
    for (node,), (pressure,), traction in zip(contact["node_id"], contact["pressure"], contact["tangential_traction"]):
        pressures[node - 1].append((pressure, traction[:mesh.dim]))
    obstacle = [[0.0] * mesh.dim for _ in mesh.nodes]  # its force on the body
    penetration = tension = cone = product = area = largest = 0.0
    for n, _, normal, gap, mass, friction in contact_points(mesh, case["contact"]):
        if all((n, c) in held for c in range(mesh.dim) if abs(normal[c]) > 1e-8):
            continue
        pressure, traction = pressures[n].pop(0)
        open_by = gap - dot(normal, u[n])
        bound = friction.get("tresca", 0.0) + friction.get("coulomb", 0.0) * pressure
        along = [u[n][c] - dot(normal, u[n]) * normal[c] for c in range(mesh.dim)]
        for c in range(mesh.dim):
            obstacle[n][c] += mass * (traction[c] - pressure * normal[c])
            if (n, c) in held:
                along[c] = 0.0
        penetration, tension = max(penetration, -open_by), max(tension, -pressure)
        largest, area = max(largest, pressure, length(traction)), area + mass
        product += mass * abs(pressure * open_by)
        if friction:
            cone = max(cone, length(traction) - bound)
            product += mass * abs(bound * length(along) + dot(traction, along))
    residual = reaction = force = pushed = 0.0
    for n in range(len(mesh.nodes)):
        for c in range(mesh.dim):
            left = load[n][c] + obstacle[n][c] - internal[n][c]
            if (n, c) in held:
                reaction += (load[n][c] - internal[n][c]) ** 2
            else:
                residual += left**2
                pushed += obstacle[n][c] ** 2
            force += load[n][c] ** 2
    scale = max(math.sqrt(max(reaction, force, pushed)), ROUNDING * stiff, 1e-300)
    size = max(max(map(abs, v)) for v in u) or 1e-300
    largest = largest or 1e-300
    supports = max([abs(u[n][c] - value) for (n, c), value in held.items()], default=0.0)
    return {"equilibrium": math.sqrt(residual) / scale, "penetration": penetration / size, "tension": tension / largest,
            "cone": cone / largest, "products": product / max(largest * size * area, 1e-300), "supports": supports / size}


if __name__ == "__main__":
    for key, value in residuals(sys.argv[1], pathlib.Path(sys.argv[2])).items():
        print(f"{key:12} {value:.2e}")
