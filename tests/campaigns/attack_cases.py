# SPDX-License-Identifier: BSD-3-Clause
"""Draws the random cases of the attack: all kinds of body, material, support, load, obstacle, friction, motion and
step."""
import json
import math
import random
from dataclasses import dataclass, field

import attack_bodies as bodies

ELEMENTS = ("tri3", "quad4", "tet4", "tet10", "hex8", "hex8")
POISSON = (0.0, 0.2, 0.3, 0.3, 0.3, 0.45, 0.49, 0.499, -0.3)
OBSTACLES_2D = ("plane", "tilted plane", "sphere", "met sphere", "socket", "cylinder", "cone", "box", "gap")
OBSTACLES_3D = OBSTACLES_2D + ("bore", "torus", "surface", "height map")
HOLDS = ("clamped", "clamped", "clamped", "slanted", "pressed", "pressed", "guided", "springs", "rollers", "loose")


@dataclass
class Case:
    """A case without its mesh section, the mesh, and further files."""
    name: str
    document: dict
    mesh: bodies.Mesh
    box: dict = None                             # box of a generated mesh, otherwise the mesh is written
    regions: dict = field(default_factory=dict)  # box selectors by group name, for generated meshes
    options: dict = field(default_factory=dict)  # refine, order, adapt
    triangles: list = None                       # of a surface obstacle
    heights: dict = None                         # rows, first and last corner of a height map
    warmth: dict = None                          # temperature by node index
    traits: set = field(default_factory=set)     # properties that twins depend on

    def write(self, folder):
        """Writes case.json and the files that it names."""
        document = dict(self.document)
        if self.box:
            document["mesh"] = {"box": self.box, **self.options}
            for key in ("material", "boundary", "contact"):
                document[key] = [{**e, "on": self.regions.get(e["on"], e["on"])} for e in document.get(key, [])]
        else:
            document["mesh"] = {"file": "body.msh", **self.options}
            self.mesh.write(folder / "body.msh")
        if self.triangles:
            lines = ["solid tool"]
            for triangle in self.triangles:
                lines += ["facet normal 0 0 0", "outer loop"]
                lines += ["vertex " + " ".join(repr(float(c)) for c in x) for x in triangle] + ["endloop", "endfacet"]
            (folder / "tool.stl").write_text("\n".join(lines) + "\nendsolid tool\n")
        if self.heights:
            (folder / "heights.csv").write_text("\n".join(",".join(map(repr, row)) for row in self.heights) + "\n")
        if self.warmth:
            tags = self.mesh.tags()
            (folder / "warmth.csv").write_text("".join(f"{tags[n]}, {t!r}\n" for n, t in self.warmth.items()))
        (folder / "case.json").write_text(json.dumps(document, indent=1) + "\n")


class Draw:
    """Random generator of one case. All lengths are multiples of `length`, all stresses of `young`."""

    def __init__(self, seed, index):
        self.rng = rng = random.Random(f"{seed} {index}")
        self.element = ELEMENTS[index % len(ELEMENTS)]
        self.dim = 2 if self.element in bodies.FLAT else 3
        self.length = 10 ** rng.uniform(-3, 3)
        self.young = 10 ** rng.uniform(-2, 8)
        self.strain = 10 ** rng.uniform(-5, -2.3)  # strain that the loads would cause in a bar
        self.size = [self.length * rng.uniform(*limits) for limits in ((1.0, 4.0), (0.5, 1.5), (0.5, 1.5))][:self.dim]
        if self.dim == 2:
            self.size = self.size[:1] + [self.length * rng.uniform(0.5, 1.5)]
        self.plane = rng.choice(("strain", "strain", "stress", "axisymmetric")) if self.dim == 2 else "strain"
        self.hold = rng.choice([h for h in HOLDS if self.plane != "axisymmetric" or h in ("clamped", "pressed", "springs")])
        self.traits = set()

    def chance(self, share):
        return self.rng.random() < share

    def vector(self, along, up, across=0.0):
        return [along, up] if self.dim == 2 else [along, across, up]

    def up(self, by):
        return self.vector(0.0, by)


def axis_turn(d, about, angle):
    """Returns a rotation about a coordinate axis as rows."""
    c, s = math.cos(angle), math.sin(angle)
    if d.dim == 2:
        return [[c, s], [-s, c]]
    a, b = [k for k in range(3) if k != about]
    axes = [[float(i == j) for j in range(3)] for i in range(3)]
    axes[a][a], axes[a][b], axes[b][a], axes[b][b] = c, s, -s, c
    return axes


def random_turn(dim, rng):
    """Returns a random rotation as rows."""
    if dim == 2:
        a = rng.uniform(0, 2 * math.pi)
        return [[math.cos(a), -math.sin(a)], [math.sin(a), math.cos(a)]]
    q = [rng.gauss(0, 1) for _ in range(4)]
    n = math.sqrt(sum(c * c for c in q))
    w, x, y, z = (c / n for c in q)
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]


# The body --------------------------------------------------------------------------------------------------------

def draw_body(d, case_options):
    """Returns the mesh with groups left, right, …, A, B, C, `patch` and `spot`; the box of a generated mesh;
    regions."""
    rng, element = d.rng, d.element
    tiny = d.chance(0.12)  # meshes to be refined or adapted start with few elements
    most = {"tri3": (10, 6), "quad4": (10, 6), "tet4": (6, 4, 4), "tet10": (3, 2, 2), "hex8": (6, 3, 3)}[element]
    if tiny:
        most = tuple(min(m, 3) for m in most)
    cells = [rng.randint(min(2 if k == 0 else 1, m), m) for k, m in enumerate(most)]
    shape = rng.choice(("box", "box", "box", "bracket", "hole", "pieces")) if not tiny else "box"
    if shape == "bracket":
        cells = [max(cells[0], 3), *cells[1:-1], max(cells[-1], 2)]
        mesh = bodies.make(d.size, cells, element, lambda *c: c[0] < cells[0] // 3 + 1 or c[-1] < cells[-1] // 2)
    elif shape == "hole" and cells[0] > 2:
        cells = [cells[0], *cells[1:-1], max(cells[-1], 2)]
        hole = (cells[0] // 2, 0 if element == "tet10" else cells[-1] // 2)
        mesh = bodies.make(d.size, cells, element, lambda *c: (c[0], c[-1]) != hole)
    else:
        mesh = bodies.make(d.size, cells, element)
    if "top" not in mesh.facets or "right" not in mesh.facets or "bottom" not in mesh.facets:
        shape, mesh = "box", bodies.make(d.size, cells, element)
    slack = 1e-6 * d.length
    # Parts: ranges of cells along x, or layers.
    parts = rng.choice((1, 1, 2, 2, 3))
    axis = rng.choice((0, d.dim - 1))
    parts = min(parts, cells[axis])
    cuts = sorted(rng.sample(range(1, cells[axis]), parts - 1)) if parts > 1 else []
    step, walls = d.size[axis] / cells[axis], [c * d.size[axis] / cells[axis] for c in cuts]
    for i, nodes in enumerate(mesh.elements):
        mid = bodies.centre(mesh, nodes)[axis]
        mesh.parts.setdefault("ABC"[sum(mid > w for w in walls)], []).append(i)
    regions = {}
    for name, low, high in zip("ABC", [-step, *walls], [*walls, d.size[axis] + step]):
        lower, upper = [-d.length] * d.dim, [2 * s for s in d.size]
        lower[axis], upper[axis] = low, high
        regions[name] = {"box": [lower, upper]}
    # The half of the top with larger x, at cell boundaries.
    half = [d.size[0] * (cells[0] // 2) / cells[0], *[-d.length] * (d.dim - 2), d.size[-1]]
    ends = [2 * d.size[0], *[2 * s for s in d.size[1:-1]], d.size[-1]]
    patch = [f for f in mesh.facets["top"] if bodies.within(mesh, f, half, ends, slack)]
    if patch:
        mesh.facets["patch"] = patch
        regions["patch"] = {"box": [half, ends]}
    if shape == "pieces":
        mesh = second_piece(d, mesh)
    corner = [max(mesh.facets["top"], key=lambda f: sum(mesh.nodes[n][0] for n in f))]
    mesh.points["spot"] = [max(corner[0], key=lambda n: mesh.nodes[n][0])]
    warp = rng.choice(("none", "none", "lean", "dome", "wave", "shake")) if d.plane != "axisymmetric" else \
        rng.choice(("none", "dome", "ring", "shake"))
    box = None
    if shape == "box" and warp == "none" and d.chance(0.6):
        box = {"size": d.size, "cells": cells, "element": element}
        if element == ("tri3" if d.dim == 2 else "tet4") and d.chance(0.5):
            del box["element"]
    bend(d, mesh, warp, cells)
    if tiny:
        draw_options(d, case_options)
    d.traits.add(shape)
    d.traits.add(warp)
    return mesh, box, regions


def second_piece(d, mesh):
    count = len(mesh.elements)
    offset = [1.5 * d.size[0], *[0.0] * (d.dim - 1)]
    parts = mesh.parts
    both = bodies.twice(mesh, offset)
    split = len(parts) == 1 and d.chance(0.5)  # each piece has its own material
    both.parts = {name: places + ([] if split else [i + count for i in places]) for name, places in parts.items()}
    if split:
        both.parts["B"] = list(range(count, 2 * count))
    return both


def bend(d, mesh, warp, cells):
    """Deforms the box; x = 0 does not change, nor does z = 0 except for domes."""
    rng = d.rng
    if warp == "shake":
        bodies.shaken(mesh, 0.12 * min(s / c for s, c in zip(d.size, cells)), rng)
    if warp == "lean":
        lean, taper = rng.uniform(-0.3, 0.3), rng.uniform(-0.3, 0.3)
        bodies.warped(mesh, lambda x: [x[0] * (1 + taper * x[-1] / d.size[-1]) + lean * x[-1], *x[1:]])
    if warp == "dome":
        sag = rng.uniform(0.02, 0.2) * d.size[-1]
        def dome(x):
            r = sum(((c - 0.5 * s) / s) ** 2 for c, s in zip(x[:-1], d.size))
            return [*x[:-1], x[-1] + sag * 4 * min(r, 0.5) * (1 - x[-1] / d.size[-1])]
        if d.plane == "axisymmetric":  # lowest on the axis
            bodies.warped(mesh, lambda x: [x[0], x[1] + sag * (x[0] / d.size[0]) ** 2 * (1 - x[1] / d.size[1])])
        elif "pieces" not in d.traits:
            bodies.warped(mesh, dome)
    if warp == "wave":
        high, wide = rng.uniform(-0.15, 0.15), rng.uniform(-0.15, 0.15)
        bodies.warped(mesh, lambda x: [
            x[0] + wide * x[0] * math.sin(3 * x[-1] / d.size[-1]) * math.cos(2 * x[-2] / d.length),
            *x[1:-1], x[-1] * (1 + high * math.sin(4 * x[0] / d.size[0]) * math.cos(x[-2] / d.length))])
    if warp == "ring":
        offset = d.length * rng.uniform(0.2, 2)
        bodies.warped(mesh, lambda x: [x[0] + offset, *x[1:]])


def draw_options(d, options):
    way = d.rng.choice(("refine", "order", "both", "adapt"))
    if way in ("refine", "both"):
        options["refine"] = 1
    if way in ("order", "both") and d.element == "tet4":
        options["order"] = 2
    if way == "adapt" and d.element in ("tri3", "tet4", "tet10"):
        options["adapt"] = {"error": d.rng.choice((0.1, 0.3)), "most_unknowns": 1500, "most_meshes": 4}
        if d.element == "tet4" and d.chance(0.3):
            options["order"] = 2
    if options:
        d.traits.add("other mesh")  # has nodes that the case's mesh lacks


# Materials -------------------------------------------------------------------------------------------------------

def draw_law(d, young, poisson):
    rng, shear = d.rng, young / (2 * (1 + poisson))
    x0 = d.strain * 10 ** rng.uniform(-0.7, 0.7)
    stress = 2 * shear * x0 * 1.5 ** 0.5
    kind = rng.choice(("logarithmic", "linear_hardening", "power", "saturating", "table", "ramberg_osgood",
                       "plastic", "tangent"))
    if kind == "plastic":
        return {"plastic": [[stress, 0.0], [1.4 * stress, 3 * x0], [2.0 * stress, 30 * x0]]}
    if kind == "tangent":
        return {"yield_stress": stress, "tangent_modulus": young * 10 ** rng.uniform(-2.5, -0.3)}
    law = {"type": kind}
    if kind == "table":
        law["points"] = [[0, 0]] + [[x * x0, 2 * shear * s * x0] for x, s in ((1, 1), (2, 1.7), (5, 3.0), (50, 8.0))]
    elif kind == "ramberg_osgood":
        law.update(sigma0=stress, alpha=rng.uniform(0.1, 1.0), n=rng.uniform(2, 8))
    else:
        law["yield_stress" if rng.random() < 0.4 else "x0"] = None
        law = {k: (stress if k == "yield_stress" else x0) if v is None else v for k, v in law.items()}
        extra = {"linear_hardening": ("gamma", 0.02, 0.5), "power": ("n", 0.2, 0.9), "saturating": ("q", 3.0, 20.0)}
        if kind in extra:
            key, low, high = extra[kind]
            law[key] = rng.uniform(low, high)
        if "x0" in law and rng.random() < 0.1:  # far from the softening range
            law["argument"], law["x0"] = "squared", (4 * x0) ** 2
    return {"law": law}


def draw_materials(d, mesh):
    rng = d.rng
    spread = rng.choice((0.0, 0.5, 2.0, 6.0))
    materials, warm = [], d.chance(0.35)
    for name in sorted(mesh.parts):
        young = d.young * 10 ** rng.uniform(0, spread)
        poisson = rng.choice(POISSON)
        entry = {"on": name, "young": young, "poisson": poisson}
        if d.chance(0.5):
            entry.update(draw_law(d, young, poisson))
        formulation = rng.random()
        if d.element in ("quad4", "hex8") and d.plane != "stress":
            if formulation < 0.25:
                entry["bbar"] = rng.random() < 0.6
            elif formulation < 0.4:
                entry["formulation"] = rng.choice(("mixed", "displacement"))
        elif d.element in ("tet4", "tet10") and formulation < 0.35:
            entry["formulation"] = "mixed"
        if warm:
            entry["expansion"] = rng.choice((1e-5, 1e-4, -1e-5))
        materials.append(entry)
    if len(materials) == 1 and d.chance(0.5):
        materials[0]["on"] = "all"
    d.soft = min(m["young"] for m in materials)
    d.traits |= {"warm"} if warm else set()
    d.traits |= {"mixed tet4"} if d.element == "tet4" and any("formulation" in m for m in materials) else set()
    d.traits |= {"plastic"} if any(set(m) & {"law", "plastic", "tangent_modulus"} for m in materials) else set()
    return materials


# Supports and loads ----------------------------------------------------------------------------------------------

def draw_supports(d):
    """Returns the supports; sets d.gap, the distance of the obstacle, and d.loaded, the sides for loads."""
    rng, stress = d.rng, d.strain * d.soft
    fixed, height = [0.0] * d.dim, d.size[-1]
    d.gap = rng.choice((0.0, 0.0, 0.1, 0.5, -0.3)) * d.strain * height
    d.loaded, bed = ["top", "patch", "right"], d.soft / d.length
    straight = d.traits & {"none", "dome"}
    if d.hold == "clamped":
        if straight and d.plane != "axisymmetric" and d.chance(0.2):  # symmetry planes and springs
            d.traits.add("flat supports")
            sides = ["left"] + (["front"] if d.dim == 3 else [])
            return [{"on": s, "normal": 0} for s in sides] + [
                {"on": "top", "spring": [bed * 10 ** rng.uniform(-2, 1) for _ in fixed]}]
        return [{"on": "left", "displacement": fixed}]
    if d.hold == "slanted":
        frame = random_turn(d.dim, rng)
        if d.chance(0.5):
            return [{"on": "left", "frame": frame, "displacement": fixed}]
        return [{"on": "left", "frame": frame, "displacement": [0.0] + [None] * (d.dim - 1)},
                {"on": "right", "spring": [bed * 10 ** rng.uniform(-1, 1)] * d.dim}]
    if d.hold == "pressed":
        down = d.strain * height
        gap = d.gap = rng.choice((0.0, 0.0, 1.0, 30.0)) * down
        aside = rng.uniform(-0.5, 0.5) * down if d.plane != "axisymmetric" else 0.0
        d.loaded = ["right"]
        return [{"on": "top", "displacement": d.vector(aside, -gap - down, 0.3 * aside)}]
    if d.hold == "springs":
        entries = [{"on": "left", "spring": [bed * 10 ** rng.uniform(-1.5, 1.5) for _ in fixed]}]
        if d.chance(0.3):
            entries.append({"on": "right", "spring": bed * 10 ** rng.uniform(-2, 1)})
        if d.chance(0.3):
            entries.append({"on": "spot", "node_spring": [d.soft * d.length * rng.uniform(0, 1) for _ in fixed]})
        return entries
    guides = [{"on": "left", "displacement": [0.0] + [None] * (d.dim - 1)}]
    if d.dim == 3:
        guides.append({"on": "front", "displacement": [None, 0.0, None]})
    if d.hold == "rollers":
        return guides + [{"on": "top", "spring": bed * 10 ** rng.uniform(-1, 1)}] + (
            [{"on": "spot", "node_spring": [d.soft * d.length] * d.dim}] if d.chance(0.3) else [])
    d.gap = rng.choice((0.0, 0.0, 1.0)) * d.strain * height
    d.loaded = []
    if d.hold == "guided":
        return guides + [{"on": "top", "traction": d.up(-stress)}]
    aside = rng.choice((0.0, 0.05, 0.2))
    return [{"on": "top", "traction": d.vector(aside * stress, -stress, 0.5 * aside * stress)}]


def draw_loads(d, mesh):
    """Returns one to three loads; the first presses the body onto its obstacle."""
    rng, entries = d.rng, []
    if d.hold in ("pressed", "guided", "loose"):
        count = rng.choice((0, 0, 1)) if d.hold == "pressed" else 0
    else:
        count = rng.choice((1, 1, 2, 3))
    slender = (d.size[-1] / d.size[0]) ** 2 if d.hold in ("clamped", "slanted") else 1.0
    stress = d.strain * d.soft * slender
    area = math.prod(d.size) / d.size[-1]
    for number in range(count):
        on = rng.choice([s for s in d.loaded if s in mesh.facets])
        kind = rng.choice(("traction", "traction", "pressure", "body_force", "gravity", "total_force", "node_force"))
        push = stress if number == 0 else stress * rng.uniform(-0.5, 0.5)
        sideways = rng.uniform(-0.5, 0.5) * stress
        if kind == "traction":
            entries.append({"on": on, "traction": d.vector(sideways, -push, 0.3 * sideways)})
        elif kind == "pressure":
            entries.append({"on": on, "pressure": push})
        elif kind == "body_force":
            part = rng.choice(["all", *mesh.parts])
            entries.append({"on": part, "body_force": d.vector(0.2 * push / d.length, -push / d.length)})
        elif kind == "gravity":
            entries.append({"on": "all", "density": stress / d.length / 9.81, "acceleration": d.up(-9.81)})
        elif kind == "total_force":
            entries.append({"on": on, "total_force": d.vector(0.2 * push * area, -push * area)})
        elif "spot" in mesh.points:
            entries.append({"on": "spot", "node_force": d.vector(0.0, -0.3 * push * area)})
    if count and d.chance(0.12):  # two loads that cancel, exactly or almost
        on = rng.choice([s for s in d.loaded if s in mesh.facets])
        large, left = stress * 10 ** rng.uniform(0, 4), rng.choice((0.0, 1e-3))
        entries += [{"on": on, "traction": d.vector(large, -0.5 * large)},
                    {"on": on, "traction": d.vector(-(1 + left) * large, 0.5 * large)}]
        d.traits.add("cancelling")
    if "warm" in d.traits:
        entries.append(draw_temperature(d))
    if d.hold in ("clamped", "springs", "slanted") and d.chance(0.15) and d.plane != "axisymmetric" \
            and not any(e["on"] in ("right", "all") and "spring" in e for e in entries):
        entries.append({"on": "right", "displacement": [d.strain * d.size[0] * rng.uniform(-0.5, 0.5)]
                        + [None] * (d.dim - 1)})
        d.traits.add("drawn")
    return entries


def draw_temperature(d):
    rng = d.rng
    rise = rng.uniform(-2, 2) * d.strain * 10 ** rng.choice((4, 5))
    kind = rng.choice(("even", "even", "gradient", "file"))
    if kind == "gradient":
        return {"on": "all", "temperature": {"value": rise, "gradient": [rise * rng.uniform(-2, 2) / s for s in d.size],
                                             "point": [s * rng.uniform(0, 1) for s in d.size]}}
    if kind == "file":
        d.traits.add("warmth file")
        return {"on": "all", "temperature": {"file": "warmth.csv"}, "rise": rise}
    return {"on": "all", "temperature": rise}


# Contact ---------------------------------------------------------------------------------------------------------

def draw_obstacle(d, mesh, case):
    """Returns an obstacle under the bottom, at distance d.gap from its lowest point if that is in the middle."""
    rng, gap = d.rng, d.gap
    nodes = [mesh.nodes[n] for n in mesh.surface("bottom")]
    low = min(nodes, key=lambda x: x[-1])[-1]
    reach = [(min(x[k] for x in nodes), max(x[k] for x in nodes)) for k in range(d.dim - 1)]
    foot = [0.5 * (a + b) + 0.03 * rng.uniform(-1, 1) * (b - a) for a, b in reach] + [low]
    if d.plane == "axisymmetric":
        foot[0] = 0.0
        kinds = ("plane", "sphere", "gap", "met sphere")
    else:
        kinds = OBSTACLES_2D if d.dim == 2 else OBSTACLES_3D
    if d.hold in ("guided", "loose"):
        kinds = ("plane", "gap") if d.chance(0.8) else kinds
    kind = rng.choice(kinds)
    d.traits.add({"box": "block"}.get(kind, kind))
    wide = max(b - a for a, b in reach)
    radius = wide * rng.uniform(0.8, 5.0)
    def below(by):
        return [*foot[:-1], foot[-1] - by]
    if kind == "plane":
        return {"plane": {"point": [rng.uniform(-1, 1) * wide if d.plane != "axisymmetric" else 0.0, *below(gap)[1:]],
                          "normal": d.up(rng.uniform(0.5, 2))}}
    if kind == "tilted plane":
        tilt = 10 ** rng.uniform(-3, -1)
        normal = d.vector(tilt, 1.0, 0.3 * tilt)
        size = math.hypot(*normal)
        least = min(sum((a - b) * n for a, b, n in zip(x, foot, normal)) for x in nodes) / size
        point = [f + (least - gap) * n / size for f, n in zip(foot, normal)]
        return {"plane": {"point": point, "normal": normal}}
    if kind in ("sphere", "met sphere"):
        met = {"direction": d.up(-1.0)} if kind == "met sphere" else {}
        return {"sphere": {"centre": below(radius + gap), "radius": radius, **met}}
    if kind == "socket":
        centre = below(-wide * rng.uniform(1, 3))
        most = max(math.dist(x, centre) for x in nodes)
        return {"sphere": {"centre": centre, "radius": most + gap, "inside": True}}
    if kind == "cylinder":
        if d.dim == 2:
            return {"cylinder": {"point": below(radius + gap), "axis": [1, 0], "radius": radius}}
        turn = rng.uniform(-0.5, 0.5)
        met = {"direction": d.up(-1.0)} if d.chance(0.4) else {}
        return {"cylinder": {"point": below(radius + gap), "axis": [math.sin(turn), math.cos(turn), 0], "radius": radius, **met}}
    if kind == "bore":
        point = below(-wide * rng.uniform(1, 3))
        most = max(math.dist((x[0], x[2]), (point[0], point[2])) for x in nodes)
        return {"cylinder": {"point": point, "axis": [0, 1, 0], "radius": most + gap, "inside": True}}
    if kind == "cone":
        met = {"direction": d.up(-1.0)} if d.chance(0.5) else {}
        return {"cone": {"apex": below(abs(gap) + 0.3 * d.strain * wide * rng.random()), "axis": d.up(-1.0),
                         "half_angle": rng.uniform(60, 88), **met}}
    if kind == "torus":
        tube = wide * rng.uniform(0.2, 0.8)
        return {"torus": {"centre": below(tube + gap), "axis": [0, 0, 1], "radius": wide * rng.uniform(0.25, 0.6) + tube,
                          "tube": tube}}
    if kind == "box":
        half = [wide * rng.uniform(0.3, 1.2) for _ in range(d.dim - 1)] + [wide * rng.uniform(0.3, 1)]
        axes = axis_turn(d, 2, rng.uniform(-1, 1)) if d.dim == 3 else [[1.0, 0.0], [0.0, 1.0]]
        middle = below(half[-1] + gap)
        corner = [sum(half[k] * axes[k][c] for k in range(d.dim)) for c in range(d.dim)]
        block = {"lower": [m - c for m, c in zip(middle, corner)], "upper": [m + c for m, c in zip(middle, corner)]}
        if d.dim == 3:
            block["frame"] = axes
        return {"box": block}
    if kind == "gap":
        return {"gap": gap}
    count, rough = rng.randint(2, 6), rng.choice((0.0, 0.3)) * d.strain * wide
    (x0, x1), (y0, y1) = [(a - 0.3 * (b - a), b + 0.3 * (b - a)) for a, b in reach]
    rows = [[-rough * rng.random() for _ in range(count + 1)] for _ in range(count + 1)]
    if kind == "height map":
        case.heights = rows
        return {"height_map": {"file": "heights.csv", "lower": [x0, y0], "upper": [x1, y1], "offset": low - gap}}
    def point(i, j):
        return [x0 + (x1 - x0) * i / count, y0 + (y1 - y0) * j / count, low - gap + rows[j][i]]
    case.triangles = []
    for i in range(count):
        for j in range(count):
            a, b, c, e = point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)
            case.triangles += [[a, b, c], [a, c, e]]
    return {"surface": {"file": "tool.stl"}}


def draw_friction(d, slow):
    rng = d.rng
    kind = rng.choice(("none", "tresca", "coulomb", "coulomb")) if d.hold != "loose" else "coulomb"
    if kind == "none":
        return {}
    friction = {"tresca": d.strain * d.soft * rng.uniform(0.02, 0.5)} if kind == "tresca" else \
        {"coulomb": rng.choice((0.05, 0.1, 0.2, 0.3, 0.5, 0.8)) if d.hold != "loose" else rng.uniform(0.3, 0.8)}
    d.traits.add({"box": "block"}.get(kind, kind))
    if slow and d.chance(0.6):
        friction["reference"] = "step"
        d.traits.add("step reference")
    return {"friction": friction}


def draw_motion(d, times):
    """Moves up to the body and into it, then along it, possibly with a rotation."""
    rng, deep = d.rng, d.strain * d.size[-1]
    path = [{"time": times[0], "translation": d.up(max(d.gap, 0.0) + deep * rng.uniform(0.1, 0.8))}]
    if len(times) > 1:
        place = d.vector(rng.uniform(-2, 2) * deep, max(d.gap, 0.0) + deep * rng.uniform(-0.2, 0.8), rng.uniform(-1, 1) * deep)
        if d.plane == "axisymmetric":
            place[0] = 0.0
        path.append({"time": times[-1], "translation": place})
        if d.plane != "axisymmetric" and d.chance(0.4):
            angle = rng.uniform(-0.5, 0.5) * d.strain
            path[-1]["rotation"] = angle if d.dim == 2 else [0.3 * angle, angle, rng.uniform(-3, 3) * d.strain]
    motion = {"path": path}
    if d.plane != "axisymmetric":
        motion["centre"] = [0.5 * s for s in d.size]
    return {"motion": motion}


def draw_contact(d, mesh, case, times):
    rng = d.rng
    if d.hold not in ("guided", "loose") and d.chance(0.12):
        return []
    entry = {"on": "bottom", "obstacle": draw_obstacle(d, mesh, case)}
    way = rng.choice(("rest", "rest", "rest", "motion", "pushed")) if d.hold not in ("guided", "loose") else "rest"
    kind = next(iter(entry["obstacle"]))
    slow = len(times) > 1
    entry.update(draw_friction(d, slow))
    if way == "motion" and kind != "gap":
        entry.update(draw_motion(d, times))
        d.traits.add("moving")
    if way == "pushed" and kind != "gap" and "pieces" not in d.traits:
        area = math.prod(d.size) / d.size[-1]
        slender = (d.size[-1] / d.size[0]) ** 2 if d.hold in ("clamped", "slanted") else 1.0
        entry["force_controlled"] = {"force": 0.3 * d.strain * d.soft * slender * area, "direction": d.up(rng.uniform(0.5, 2))}
        if d.plane == "axisymmetric":
            entry["force_controlled"]["force"] *= 2 * math.pi * d.size[0]
        d.traits.add("moving")
    if d.chance(0.1) and kind != "gap":
        entry["relinearise"] = True
        d.traits |= {"moving", "relinearise"}
    entries = [entry]
    if d.hold in ("clamped", "springs", "guided") and "pieces" not in d.traits and d.plane != "axisymmetric" \
            and "drawn" not in d.traits and d.chance(0.25):  # nodes of the edge are in both entries
        far = max(mesh.nodes[n][0] for n in mesh.surface("right"))
        wall = {"on": "right", "obstacle": {"plane": {"point": d.vector(far + rng.choice((0.0, 0.2, 2)) * d.strain * d.size[0], 0.0),
                                                      "normal": d.vector(-1.0, 0.0)}}}
        wall.update(draw_friction(d, slow))
        entries.append(wall)
    return entries


# Steps and solver ------------------------------------------------------------------------------------------------

def draw_steps(d, document, count):
    """Returns load curves: factors of both signs on loads and prescribed displacements."""
    rng = d.rng
    times = sorted(rng.sample([0.25 * k for k in range(1, 13)], count))
    loads = [e["name"] for e in document["boundary"] if set(e) & {
        "traction", "pressure", "body_force", "total_force", "density", "node_force", "temperature"}]
    if d.hold == "pressed":
        loads += [e["name"] for e in document["boundary"] if e["on"] == "top" and "displacement" in e]
    chosen = [name for name in loads if d.chance(0.7)] or loads[:1]
    steps = []
    for i, time in enumerate(times):
        named = chosen if i == 0 else [name for name in chosen if d.chance(0.6)]
        low = (1.0, 1.0, 0.5) if i == 0 else (1.0, 0.5, 0.0, -0.3, -1.0, 1.5)
        steps.append({"time": time, "factors": {name: rng.choice(low) for name in named}})
    return steps


def draw_solver(d):
    rng, solver = d.rng, {}
    if d.chance(0.3):
        solver["tolerance"] = 10.0 ** rng.choice((-4, -5, -7, -8))
    if d.chance(0.15) and "moving" not in d.traits:
        way = rng.choice(("kacanov", "newton", "admm", "elasticity", "paper", "active_set"))
        key = {"kacanov": "outer", "newton": "outer", "elasticity": "preconditioner", "paper": "r"}.get(way, "contact")
        solver[key] = way
        d.traits.add("slow method" if way in ("kacanov", "admm", "paper") else "auto")
    if d.chance(0.05):
        solver["nested"] = False
    return solver


def draw_case(seed, index):
    """Returns the case of this seed and index, independent of all other draws."""
    d = Draw(seed, index)
    options = {}
    mesh, box, regions = draw_body(d, options)
    case = Case("", {}, mesh, box, regions, options)
    if box:
        mesh.points = {}
    materials = draw_materials(d, mesh)
    curves, count = d.chance(0.3), d.rng.randint(2, 4)
    grown = not curves and d.chance(0.25)
    boundary = draw_supports(d) + draw_loads(d, mesh)
    boundary = [e for e in boundary if e["on"] != "spot" or "spot" in mesh.points]
    for i, entry in enumerate(boundary):
        entry["name"] = f"b{i}"
    document = {"material": materials, "boundary": boundary}
    steps = draw_steps(d, document, count) if curves else []
    times = [s["time"] for s in steps] or ([(i + 1) / count for i in range(count)] if grown else [1.0])
    contact = draw_contact(d, mesh, case, times)
    for i, entry in enumerate(contact):
        entry["name"] = f"c{i}"
    for entry in boundary:
        rise = entry.pop("rise", None)
        if rise is not None and (box or options):  # node numbers of these meshes are not known here
            entry["temperature"] = rise
            d.traits.discard("warmth file")
        elif rise is not None:
            case.warmth = {n: rise * d.rng.uniform(0, 1) for n in range(len(mesh.nodes))}
    if contact:
        document["contact"] = contact
    if steps:
        document["steps"] = steps
        d.traits.add("steps")
    solver = draw_solver(d)
    if grown:
        solver["load_steps"] = count if d.chance(0.7) else times
        d.traits.add("grown")
    if solver:
        document["solver"] = solver
    if d.plane != "strain":
        document["plane"] = d.plane
    if d.dim == 2 and d.plane != "axisymmetric" and d.chance(0.5):
        document["thickness"] = d.length * 10 ** d.rng.uniform(-2, 1)
    document["output"] = {"report": False}
    case.document = document
    case.traits = d.traits
    case.name = " ".join([str(index), d.hold, d.element, *sorted(d.traits - {"none", "auto"}),
                          *(f"{k} {v}" for k, v in options.items() if k != "adapt"), *(["adapt"] if "adapt" in options else [])])
    return case
