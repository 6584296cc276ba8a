# SPDX-License-Identifier: BSD-3-Clause
"""The small cases of verify_answers: every law, element, obstacle and friction, all units, and ill-conditioned
cases."""
import math
import random

from random_bodies import TET_EDGES, block

ELEMENTS = ("tri3", "quad4", "tet4", "tet10", "hex8")
LAWS = ("linear", "logarithmic", "linear_hardening", "power", "saturating", "table")
OBSTACLES = ("none", "plane", "tilted plane", "sphere", "sphere with direction", "gap")
FRICTIONS = ("none", "tresca", "coulomb")
POISSON = (0.0, 0.2, 0.3, 0.3, 0.3, 0.45, 0.499, -0.4)


class Draw:
    """Random generator of one case. All lengths are multiples of `length`, all stresses of `stress`."""

    def __init__(self, seed, index):
        self.rng = rng = random.Random(f"{seed} {index}")
        # These cycle with the index, so that few cases cover all of them.
        self.element = ELEMENTS[index % len(ELEMENTS)]
        self.law = LAWS[index // 2 % len(LAWS)]
        self.obstacle = OBSTACLES[index // 3 % len(OBSTACLES)]
        self.friction = FRICTIONS[index // 5 % len(FRICTIONS)] if self.obstacle != "none" else "none"
        self.dim = 2 if self.element in ("tri3", "quad4") else 3
        self.length = 10 ** rng.uniform(-3, 3)
        self.young = 10 ** rng.uniform(-2, 11)
        self.strain = 10 ** rng.uniform(-5, -2.3)  # strain that the loads would cause in a bar
        self.size = [self.length * rng.uniform(*limits) for limits in ((1.0, 3.0), (0.5, 1.5), (0.5, 1.5))][:self.dim]
        self.poisson = rng.choice(POISSON)
        self.bbar = self.element in ("quad4", "hex8") and rng.random() < 0.5

    def vector(self, along, up, across=0.0):
        return [along, up] if self.dim == 2 else [along, across, up]

    def material(self):
        entry = {"on": "all", "young": self.young, "poisson": self.poisson}
        if self.bbar:
            entry["bbar"] = True
        rng, x0 = self.rng, self.strain * self.rng.uniform(0.3, 3.0)
        shear = self.young / (2 * (1 + self.poisson))
        law = {"type": self.law}
        squared = self.law != "linear" and rng.random() < 0.2
        if squared:  # far from the softening range
            law["argument"], x0 = "squared", (3 * x0) ** 2
        if self.law == "table":
            law["points"] = [[0, 0]] + [[x * x0, 2 * shear * s * x0] for x, s in ((1, 1), (2, 1.7), (5, 3.0), (50, 8.0))]
        elif self.law != "linear":
            if not squared and rng.random() < 0.3:
                law["yield_stress"] = 2 * shear * x0 * 1.5 ** 0.5
            else:
                law["x0"] = x0
            key, low, high = {"linear_hardening": ("gamma", 0.05, 0.5), "power": ("n", 0.3, 0.9),
                              "saturating": ("q", 3.0, 20.0), "logarithmic": (None, 0, 0)}[self.law]
            if key:
                law[key] = rng.uniform(low, high)
        if self.law != "linear" or rng.random() < 0.5:
            entry["law"] = law
        return entry

    def contact(self, on, gap):
        """Returns an obstacle under the body's bottom, at distance `gap`."""
        height = self.size[-1]
        middle = self.vector(*[0.5 * self.size[0], 0.0], *([0.5 * self.size[1]] if self.dim == 3 else []))
        radius = self.length * self.rng.uniform(1.0, 5.0)
        below = list(middle)
        below[-1] = -radius - gap
        kinds = {
            "plane": {"plane": {"point": self.vector(0.0, -gap), "normal": self.vector(0.0, 2.0)}},
            "tilted plane": {"plane": {"point": self.vector(0.0, -gap - 0.02 * height), "normal": self.vector(0.02, 1.0, 0.01)}},
            "sphere": {"sphere": {"centre": below, "radius": radius}},
            "sphere with direction": {"sphere": {"centre": below, "radius": radius, "direction": self.vector(0.0, -1.0)}},
            "gap": {"gap": gap},
        }
        entry = {"on": on, "obstacle": kinds[self.obstacle]}
        if self.friction == "tresca":
            entry["friction"] = {"tresca": self.strain * self.young * self.rng.uniform(0.02, 0.5)}
        if self.friction == "coulomb":
            entry["friction"] = {"coulomb": self.rng.uniform(0.1, 0.8)}
        return entry


def clamped(d):
    """Clamped at the left, pressed down onto its obstacle."""
    stress, rng = d.strain * d.young, d.rng
    bend = stress * (d.size[-1] / d.size[0]) ** 2
    boundary = [{"on": "left", "displacement": [0.0] * d.dim}]
    way = rng.randrange(3)
    if way == 0:
        boundary.append({"on": "top", "traction": d.vector(rng.uniform(-1, 1) * bend, -bend, 0.3 * bend)})
    elif way == 1:
        boundary.append({"on": "top", "pressure": bend})
    else:
        boundary.append({"on": "all", "body_force": d.vector(0.2 * bend / d.size[-1], -bend / d.size[-1])})
    return boundary, rng.choice((0.0, 0.1, 0.5)) * d.strain * d.size[-1]


def pressed(d):
    """Moved by its top onto its obstacle, and along it."""
    down = d.strain * d.size[-1]
    gap = d.rng.choice((0.0, 0.0, 1.0, 100.0)) * down
    aside = d.rng.uniform(-0.5, 0.5) * down
    return [{"on": "top", "displacement": d.vector(aside, -gap - down, 0.3 * aside)}], gap


def guided(d):
    """Under pressure between guides: only contact supports it in the normal direction."""
    stress = d.strain * d.young
    boundary = [{"on": "top", "traction": d.vector(0.0, -stress)}, {"on": "left", "displacement": [0.0] + [None] * (d.dim - 1)}]
    if d.dim == 3:
        boundary.append({"on": "front", "displacement": [None, 0.0, None]})
    return boundary, 0.0


def add_plane(case, d, body, rng):
    """Draws plane state and thickness of a 2D case from a separate generator."""
    if d.dim == 3:
        return ""
    plane = rng.choice(("strain", "stress", "axisymmetric"))
    if plane == "axisymmetric" and body and min(x[0] for x in body.nodes) < 0:  # the body extends beyond the axis
        plane = "stress"
    if plane != "strain":
        case["plane"] = plane
    if plane == "stress":
        case["material"][0].pop("bbar", None)
    if plane == "axisymmetric":
        for entry in case["boundary"]:  # fix nodes on the axis
            if entry["on"] == "top" and "displacement" in entry:
                entry["displacement"][0] = 0.0
    elif rng.random() < 0.5:
        case["thickness"] = d.length * 10 ** rng.uniform(-2, 1)
    return plane


def add_conditions(case, d, rng):
    """Adds springs and temperature from a separate generator, so that the rest of the case does not change."""
    stiffness = d.young / d.size[-1]
    kinds = rng.sample(("bed", "normal bed", "node springs", "warmth", "warm part", "slant"), rng.randint(1, 3))
    for kind in kinds:
        if kind == "bed":
            case["boundary"].append({"on": rng.choice(("right", "top")), "spring": [
                stiffness * rng.choice((0.0, 0.01, 1.0, 30.0)) for _ in d.size[1:]] + [stiffness * 0.1]})
        elif kind == "normal bed":
            case["boundary"].append({"on": rng.choice(("right", "top", "all")), "spring": stiffness * 10 ** rng.uniform(-2, 2)})
        elif kind == "slant":  # oblique support, only with no other on the top
            turn = rng.uniform(0.1, 1.4)
            c, s = math.cos(turn), math.sin(turn)
            frame = [[c, s], [-s, c]] if d.dim == 2 else [[c, 0.6 * s, 0.8 * s], [-s, 0.6 * c, 0.8 * c], [0.0, -0.8, 0.6]]
            if not any(entry["on"] == "top" and "displacement" in entry for entry in case["boundary"]):
                case["boundary"].append({"on": "right", "frame": frame, "displacement": [
                    d.size[0] * d.strain * rng.choice((0.0, -0.5, 0.5))] + [None] * (d.dim - 1)})
        elif kind == "node springs":
            case["boundary"].append({"on": "right", "node_spring": [stiffness * d.size[0] * rng.uniform(0, 1) for _ in d.size]})
        else:
            case["material"][0]["expansion"] = rng.choice((-1e-5, 1e-5))
            on = "all" if kind == "warmth" else {"box": [[-d.length] * d.dim, [0.6 * d.size[0]] + [2 * s for s in d.size[1:]]]}
            rise = rng.uniform(-2, 2) * d.strain * 1e5
            if rng.random() < 0.5:
                rise = {"value": rise, "gradient": [rise * rng.uniform(-2, 2) / length for length in d.size],
                        "point": [length * rng.uniform(0, 1) for length in d.size]}
            case["boundary"].append({"on": on, "temperature": rise})
    return " ".join(kinds)


def add_history(case, d, rng):
    """Adds load steps with slip references and moving, pushed or relinearised obstacles, from a separate generator."""
    count = rng.randint(2, 4)
    flat = case.get("plane") == "axisymmetric"
    steps, displacement = [], 0.0
    for k in range(count):
        displacement = rng.choice((1.0, rng.uniform(-0.3, 1.0)))
        steps.append({"time": k + 1, "factors": {}})
        for i, entry in enumerate(case["boundary"]):
            if "spring" not in entry and "node_spring" not in entry:
                held = "displacement" in entry or "normal" in entry
                steps[-1]["factors"][f"boundary[{i}]"] = displacement if held else rng.uniform(0.2, 1.0)
    words = []
    for i, entry in enumerate(case.get("contact", [])):
        if rng.random() < 0.8:
            entry["friction"] = rng.choice(({"coulomb": rng.uniform(0.05, 0.6)},
                                            {"tresca": d.strain * d.young * rng.uniform(0.01, 0.3)}))
            entry["friction"]["reference"] = rng.choice(("start", "step", "step"))
        reach = d.strain * d.size[-1]
        aside = 0.0 if flat else rng.uniform(-0.5, 0.5)
        movement = "rest" if "gap" in entry["obstacle"] else rng.choice(("rest", "rest", "motion", "pushed"))
        if movement == "motion":
            entry["motion"] = {"path": [{"time": time, "translation": d.vector(aside * reach * time / count, reach * rng.uniform(-0.5, 1.0))}
                                        for time in sorted({1, count})]}
            if d.dim == 2 and not flat and rng.random() < 0.3:
                entry["motion"]["path"][-1]["rotation"] = d.strain * rng.uniform(-1, 1)
        if movement == "pushed":
            side = d.vector(-1.0, aside) if entry["on"] == "right" else d.vector(aside, 1.0)
            entry["force_controlled"] = {"force": d.strain * d.young * d.size[0] ** (d.dim - 1) * rng.uniform(0.01, 0.3), "direction": side}
            for step in steps:
                step["factors"][f"contact[{i}]"] = rng.choice((0.0, 1.0, 1.0, rng.uniform(0.3, 1.0)))
            steps[0]["factors"][f"contact[{i}]"] = 1.0
        if "gap" not in entry["obstacle"] and rng.random() < 0.3:
            entry["relinearise"] = True
            movement += "+relinearise"
        words.append(movement + " " + entry.get("friction", {}).get("reference", "frictionless"))
    case["solver"].pop("load_steps", None)
    case["steps"] = steps
    return f"{count} steps: " + ", ".join(words)


def oracle_case(seed, index, conditions=False, history=False):
    """Returns name, case, and a body to be written as a mesh file or None; the same for the same seed and index."""
    d = Draw(seed, index)
    kind = d.rng.choice((clamped, clamped, pressed, guided) if d.obstacle in ("plane", "gap") else (clamped, pressed)
                        if d.obstacle != "none" else (clamped,))
    boundary, gap = kind(d)
    body = None
    if d.element == "quad4" or d.rng.random() < 0.4:
        most = 3 if d.element == "tet10" else 4
        mesh = {"box": {"size": d.size, "cells": [d.rng.randint(2, most + 2), *(d.rng.randint(1, most) for _ in d.size[1:])],
                        "element": d.element}}
    else:
        body = block(d.size, d.element, 120, d.rng, distorted=d.rng.random() < 0.7)
        mesh = {"file": "body.msh"}
    solver = {"tolerance": 10.0 ** d.rng.choice((-4, -6, -6, -8, -9)), "max_outer": 200}
    if d.rng.random() < 0.15:
        solver["load_steps"] = d.rng.randint(2, 4)
    case = {"mesh": mesh, "material": [d.material()], "boundary": boundary, "solver": solver,
            "output": {"report": False, "checkpoint": False}}
    if d.obstacle != "none":
        case["contact"] = [d.contact("bottom", gap)]
        if kind is clamped and d.rng.random() < 0.3:  # nodes of the edge are in both entries
            case["contact"].append({"on": "right", "obstacle": {"plane": {
                "point": d.vector(d.size[0] * (1 + 0.3 * d.strain), 0.0), "normal": d.vector(-1.0, 0.0)}}})
    name = f"{index} {kind.__name__} {d.element} {d.law} {d.obstacle} {d.friction}"
    name += (" " + add_plane(case, d, body, random.Random(f"{seed} {index} plane"))).rstrip()
    if conditions:
        name += " " + add_conditions(case, d, random.Random(f"{seed} {index} conditions"))
    if history:
        name += " " + add_history(case, d, random.Random(f"{seed} {index} history"))
    return name, case, body


def beam(element, **changes):
    """A clamped bar bent onto a floor."""
    dim = 2 if element in ("tri3", "quad4") else 3
    size, cells = ([4, 1], [8, 3]) if dim == 2 else ([4, 1, 1], [6, 2, 2])
    down = [0.0] * dim
    down[-1] = -0.001
    return {"mesh": {"box": {"size": size, "cells": cells, "element": element}},
            "material": [{"on": "all", "young": 1.0, "poisson": 0.3}],
            "boundary": [{"on": "left", "displacement": [0.0] * dim}, {"on": "top", "traction": down}],
            "contact": [{"on": "bottom", "obstacle": {"gap": 0.01}}],
            "output": {"report": False, "checkpoint": False}, **changes}


def graded(element, ratio, rng_seed=1):
    """The bar with cells that grow by `ratio` from one end to the other along x and z."""
    body = block([4.0, 1.0] if element == "tri3" else [4.0, 1.0, 1.0], element, 150, random.Random(rng_seed))

    def spread(s):
        return (ratio ** s - 1) / (ratio - 1)
    body.nodes = [(4 * spread(x[0] / 4), *x[1:-1], spread(x[-1])) for x in body.nodes]
    if element == "tet10":
        for nodes in body.elements:
            for (a, b), middle in zip(TET_EDGES, nodes[4:]):
                body.nodes[middle] = tuple((p + q) / 2 for p, q in zip(body.nodes[nodes[a]], body.nodes[nodes[b]]))
    return body


def straining_cases():
    """Yields name, case, body or None, and whether rounding may limit it: stiffness and Poisson's ratios, graded
    meshes."""
    for element in ELEMENTS:
        dim = 2 if element in ("tri3", "quad4") else 3
        half = {"box": [[2.0] + [0.0] * (dim - 1), [4.0] + [1.0] * (dim - 1)]}
        for power in range(16):
            yield (f"ratio 1e{power} {element}", beam(element, material=[
                {"on": "all", "young": 1.0, "poisson": 0.3}, {"on": half, "young": 10.0 ** power, "poisson": 0.3}]), None)
        for nines in (2, 4, 6, 8, 9):
            poisson = float("0.4" + "9" * nines)
            for bbar in ((False, True) if element in ("quad4", "hex8") else (False,)):
                material = {"on": "all", "young": 1.0, "poisson": poisson, **({"bbar": True} if bbar else {})}
                yield f"poisson {poisson} {element}{' bbar' if bbar else ''}", beam(element, material=[material]), None
    for power in range(2, 32, 2):
        size = 10.0 ** power
        below = [2.0, 0.5, -size - 0.01]
        for name, obstacle in (("sphere", {"sphere": {"centre": below, "radius": size}}),
                               ("bore", {"sphere": {"centre": [2.0, 0.5, size - 0.01], "radius": size, "inside": True}}),
                               ("met sphere", {"sphere": {"centre": below, "radius": size, "direction": [0, 0, -1]}}),
                               ("cylinder", {"cylinder": {"point": below, "axis": [0, 1, 0], "radius": size}}),
                               ("torus", {"torus": {"centre": below, "axis": [0, 1, 0], "radius": 0.75 * size, "tube": 0.25 * size}}),
                               ("cone", {"cone": {"apex": [-size, 0.3, -size - 0.01], "axis": [1, 0, 0], "half_angle": 45}}),
                               ("plane", {"plane": {"point": [size, -3 * size, -0.01], "normal": [0, 0, 1]}}),
                               ("box", {"box": {"lower": [-size] * 3, "upper": [size, size, -0.01]}}),
                               ("turned box", {"box": {"lower": [-size] * 3, "upper": [size, size, -0.01],
                                                       "frame": [[4, 3, 0], [-3, 4, 0], [0, 0, 1]]}})):
            yield (f"size 1e{power} {name}", beam("hex8", contact=[{"on": "bottom", "obstacle": obstacle}]), None)
    for element in ("tri3", "tet4", "tet10", "hex8"):
        for ratio in (1e2, 1e3, 1e4):
            yield f"graded {ratio:g} {element}", beam(element, mesh={"file": "body.msh"}), graded(element, ratio)
