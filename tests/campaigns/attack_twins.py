# SPDX-License-Identifier: BSD-3-Clause
"""Twins of a case: the same problem rotated, renumbered, in other units, with idle entries, on other ranks,
restarted."""
import copy
import itertools
import math
import random
from dataclasses import dataclass

import attack_bodies as bodies
from attack_cases import Case, random_turn


@dataclass
class Twin:
    """A case, how it is run, and the map from the original case's numbers to its own."""
    kind: str
    case: Case
    ranks: int = 1
    cut: int = 0                    # outer steps before a restart
    turn: list = None               # rows of the rotation
    length: float = 1.0
    force: float = 1.0

    def vector(self, v, factor):
        return [factor * c for c in (rotated(self.turn, v) if self.turn else v)]


def rotated(turn, v):
    return [sum(a * b for a, b in zip(row, v)) for row in turn]


def axis_turns(dim):
    """Returns the rotations that map axes to axes."""
    found = []
    for axes in itertools.permutations(range(dim)):
        for signs in itertools.product((1.0, -1.0), repeat=dim):
            parity = math.prod(signs) * (-1) ** sum(axes[i] > axes[j] for i in range(dim) for j in range(i + 1, dim))
            if parity > 0:
                found.append([[signs[i] if axes[i] == j else 0.0 for j in range(dim)] for i in range(dim)])
    return found


class Turning:
    """Rotates and shifts a case."""

    def __init__(self, turn, shift):
        self.turn, self.shift = turn, shift

    def way(self, v):
        return rotated(self.turn, v)

    def place(self, x):
        return [a + b for a, b in zip(rotated(self.turn, x), self.shift)]

    def along(self, v):
        """Rotates unsigned values per axis, such as springs under rotations that map axes to axes."""
        return [sum(abs(a) * b for a, b in zip(row, v)) for row in self.turn]

    def case(self, case):
        made = copy.deepcopy(case)
        made.box = None
        made.mesh.nodes = [tuple(self.place(x)) for x in made.mesh.nodes]
        if made.triangles:
            made.triangles = [[self.place(x) for x in t] for t in made.triangles]
        document = made.document
        for entry in document["boundary"]:
            self.boundary(entry)
        for entry in document.get("contact", []):
            self.contact(entry)
        return made

    def boundary(self, entry):
        for key in ("traction", "body_force", "total_force", "acceleration", "node_force"):
            if key in entry:
                entry[key] = self.way(entry[key])
        if "displacement" in entry:
            dim = len(self.turn)
            axes = entry.get("frame", [[float(i == j) for j in range(dim)] for i in range(dim)])
            entry["frame"] = [self.way(axis) for axis in axes]
        for key in ("spring", "node_spring"):
            if isinstance(entry.get(key), list):
                entry[key] = entry[key] if len(set(entry[key])) == 1 else self.along(entry[key])
        warmth = entry.get("temperature")
        if isinstance(warmth, dict) and "gradient" in warmth:
            warmth["gradient"] = self.way(warmth["gradient"])
            warmth["point"] = self.place(warmth["point"])

    def contact(self, entry):
        for kind, parts in entry["obstacle"].items():
            if kind == "height_map":
                parts["lower"] = [a + b for a, b in zip(parts["lower"], self.shift)]
                parts["upper"] = [a + b for a, b in zip(parts["upper"], self.shift)]
                parts["offset"] += self.shift[2]
                continue
            if kind == "gap":
                continue
            for key in ("point", "centre", "apex", "lower", "upper"):
                if key in parts:
                    parts[key] = self.place(parts[key])
            for key in ("normal", "direction", "axis"):
                if key in parts:
                    parts[key] = self.way(parts[key])
            if kind == "box":
                dim = len(self.turn)
                axes = parts.get("frame", [[float(i == j) for j in range(dim)] for i in range(dim)])
                parts["frame"] = [self.way(axis) for axis in axes]
        if "force_controlled" in entry:
            entry["force_controlled"]["direction"] = self.way(entry["force_controlled"]["direction"])
        if "motion" in entry:
            motion = entry["motion"]
            motion["centre"] = self.place(motion.get("centre", [0.0] * len(self.turn)))
            for pose in motion["path"]:
                pose["translation"] = self.way(pose["translation"])
                if isinstance(pose.get("rotation"), list):
                    pose["rotation"] = self.way(pose["rotation"])


def turned(case, rng):
    """Rotated randomly and shifted; by right angles if springs have axes, only shifted with heights or an axis of
    revolution."""
    dim = case.mesh.dim
    springs = [e[k] for e in case.document["boundary"] for k in ("spring", "node_spring") if isinstance(e.get(k), list)]
    still = [[float(i == j) for j in range(dim)] for i in range(dim)]
    size = max(max(map(abs, x)) for x in case.mesh.nodes)
    shift = [rng.uniform(-1, 1) * size for _ in range(dim)]
    if case.document.get("plane") == "axisymmetric":
        turn, shift = still, [0.0] + shift[1:]
        if any("gradient" in e.get("temperature", {}) for e in case.document["boundary"]
               if isinstance(e.get("temperature"), dict)):
            return None
    elif case.heights:
        turn = still
    elif any(len(set(s)) > 1 for s in springs):
        turn = rng.choice(axis_turns(dim))
    else:
        turn = random_turn(dim, rng)
    return Twin("turned", Turning(turn, shift).case(case), turn=turn)


def renumbered(case, rng):
    """Other numbers, other orders of elements and entries."""
    made = copy.deepcopy(case)
    made.box = None
    made.mesh = bodies.renumbered(made.mesh, rng)
    for key in ("material", "boundary", "contact"):  # materials of this campaign do not overlap
        rng.shuffle(made.document.get(key, []))
    return Twin("renumbered", made)


POWERS = {  # exponents of length and force in the unit of each key
    "young": (-2, 1), "yield_stress": (-2, 1), "sigma0": (-2, 1), "tangent_modulus": (-2, 1),
    "traction": (-2, 1), "pressure": (-2, 1), "body_force": (-3, 1), "total_force": (0, 1), "node_force": (0, 1),
    "density": (-3, 1), "displacement": (1, 0), "normal": (1, 0), "node_spring": (-1, 1), "spring": (-3, 1),
    "tresca": (-2, 1), "gap": (1, 0), "centre": (1, 0), "radius": (1, 0), "tube": (1, 0), "apex": (1, 0),
    "lower": (1, 0), "upper": (1, 0), "offset": (1, 0), "translation": (1, 0), "force": (0, 1), "thickness": (1, 0),
    "point": (1, 0),
}


def rescaled(case, rng):
    """In other units of length, force and temperature."""
    base = rng.choice((2.0, 10.0))
    length, force, warmth = (base ** rng.randint(-4, 4) for _ in range(3))
    made = copy.deepcopy(case)

    def scale(value, factor):
        if isinstance(value, list):
            return [scale(v, factor) for v in value]
        return value if value is None else value * factor

    def walk(node, within=""):
        for key, value in list(node.items()) if isinstance(node, dict) else []:
            if key == "temperature" or key == "expansion":
                continue
            if key == "plastic" and isinstance(value, list):
                node[key] = [[s * force / length ** 2, e] for s, e in value]
            elif key == "points":
                node[key] = [[x, s * force / length ** 2] for x, s in value]
            elif key == "normal" and within == "plane":
                continue
            elif key in POWERS:
                of_length, of_force = POWERS[key]
                node[key] = scale(value, length ** of_length * force ** of_force)
            elif isinstance(value, dict):
                walk(value, key)
            elif isinstance(value, list):
                for v in value:
                    walk(v, key)

    for key in ("material", "boundary", "contact"):
        for entry in made.document.get(key, []):
            walk(entry)
    if case.mesh.dim == 2 and made.document.get("plane") != "axisymmetric":
        made.document["thickness"] = made.document.get("thickness", 1.0) * length
    for entry in made.document["material"]:
        if "expansion" in entry:
            entry["expansion"] /= warmth
    for entry in made.document["boundary"]:
        rise = entry.get("temperature")
        if isinstance(rise, dict) and "gradient" in rise:
            rise["value"] *= warmth
            rise["gradient"] = scale(rise["gradient"], warmth / length)
            rise["point"] = scale(rise["point"], length)
        elif rise is not None and not isinstance(rise, dict):
            entry["temperature"] = rise * warmth
    if made.warmth:
        made.warmth = {n: t * warmth for n, t in made.warmth.items()}
    made.mesh.nodes = [tuple(c * length for c in x) for x in made.mesh.nodes]
    if made.box:
        made.box = {**made.box, "size": scale(made.box["size"], length)}
    made.regions = {name: {"box": scale(region["box"], length)} for name, region in made.regions.items()}
    if made.triangles:
        made.triangles = scale(made.triangles, length)
    if made.heights:
        made.heights = scale(made.heights, length)
    return Twin("rescaled", made, length=length, force=force)


def idle(case, rng):
    """With entries without effect: cancelling loads, a zero load, a distant obstacle that may move."""
    made = copy.deepcopy(case)
    document, dim = made.document, case.mesh.dim
    held = {e["on"] for e in document["boundary"] if "displacement" in e or "normal" in e}
    used = {e["on"] for e in document.get("contact", [])}
    stress = 10 ** rng.uniform(-2, 2) * min(m["young"] for m in document["material"]) * 1e-5
    pair = [stress * rng.uniform(-1, 1) for _ in range(dim)]
    on = "right" if "right" not in held else "top"
    document["boundary"] += [{"on": on, "name": "i0", "traction": pair}, {"on": "all", "name": "i2", "body_force": [0.0] * dim},
                             {"on": on, "name": "i1", "traction": [-c for c in pair]}]
    if "right" not in used | held and "patch" not in held and document.get("plane") != "axisymmetric":
        size = max(max(map(abs, x)) for x in case.mesh.nodes)
        far = {"on": "right", "name": "i3", "obstacle": {"plane": {
            "point": [5 * size, *[0.0] * (dim - 1)], "normal": [-1.0, *[0.0] * (dim - 1)]}}}
        if rng.random() < 0.5:
            far["motion"] = {"path": [{"time": 1.0, "translation": [0.01 * size, *[0.0] * (dim - 1)]}]}
        document.setdefault("contact", []).append(far)
    return Twin("idle", made)


def draw_twins(case, seed, index):
    """Returns all twins of the case, by kind."""
    def dice(kind):
        return random.Random(f"{seed} {index} {kind}")

    def ranks(kind, *numbers):  # no rank is empty
        return min(dice(kind).choice(numbers), max(1, len(case.mesh.elements) // 2))

    traits, options = case.traits, case.options
    same_mesh = not options and "mixed tet4" not in traits  # results independent of the numbering
    twins = {"renumbered": renumbered(case, dice("renumbered")) if same_mesh else None,
             "turned": turned(case, dice("turned")) if same_mesh else None,
             "rescaled": rescaled(case, dice("rescaled")),
             "idle": idle(case, dice("idle")),
             "ranks": Twin("ranks", case, ranks=ranks("ranks", 2, 3, 4)),
             "restarted": None if "moving" in traits else Twin(
                 "restarted", case, cut=dice("cut").randint(1, 6), ranks=ranks("restarted", 1, 1, 2)),
             "parted": None if "adapt" in options else Twin("parted", case, ranks=ranks("parted", 1, 2, 3))}
    return {kind: twin for kind, twin in twins.items() if twin}
