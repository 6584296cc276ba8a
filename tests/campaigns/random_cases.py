# SPDX-License-Identifier: BSD-3-Clause
"""The random cases of hard_cases: typical friction problems of engineers, small enough to be solved instantly."""
import math
import random

import random_bodies as bodies

ELEMENTS = ("tri3", "tet4", "tet4", "hex8", "hex8", "tet10")
MOST_NODES = 900
TABLE = [[0, 0], [0.00125, 204.0], [0.005, 260.0], [0.02, 330.0], [0.2, 500.0]]
STEEL = 250.0  # yield stress


def laws(unit):
    """Returns eight laws; those of unit bodies yield at a stress of 1 with a Young's modulus of 800."""
    stress = 1.0 if unit else STEEL
    scale = stress / STEEL
    return {
        "linear": {"type": "linear"},
        "log": {"type": "logarithmic", "yield_stress": stress},
        "hardening": {"type": "linear_hardening", "yield_stress": stress, "gamma": 0.05},
        "flat": {"type": "linear_hardening", "yield_stress": stress, "gamma": 0.002},
        "power": {"type": "power", "yield_stress": stress, "n": 0.3},
        "flat power": {"type": "power", "yield_stress": stress, "n": 0.1},
        "saturating": {"type": "saturating", "yield_stress": stress, "q": 10.0},
        "table": {"type": "table", "points": [[x, s * scale] for x, s in TABLE]},
    }


class Draw:
    """Random generator of one case, with the parts that its kinds share."""

    def __init__(self, seed):
        self.rng = rng = random.Random(seed)
        self.element = rng.choice(ELEMENTS)
        self.dim = 2 if self.element == "tri3" else 3
        if self.dim == 2:  # a separate generator, so that cases of earlier seeds do not change
            self.element = random.Random(f"{seed} element").choice(("tri3", "quad4"))
        self.unit = rng.random() < 0.3
        self.scale = 1.0 if self.unit else rng.choice((1.0, 10.0, 40.0))
        self.stress = 1.0 if self.unit else STEEL
        self.young = 800.0 if self.unit else 210000.0
        self.law = rng.choice(sorted(laws(self.unit)))
        self.load = self.stress * 0.5 * 12 ** rng.random()  # half to six times the yield load
        self.mu = 0.0 if rng.random() < 0.15 else rng.choice((0.05, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0, 1.5))
        self.tresca = rng.random() < 0.12 and self.mu > 0

    def vector(self, along, up, across=0.0):
        """Returns x, (y,) z."""
        return [along, up] if self.dim == 2 else [along, across, up]

    def size(self, *slenderness):
        """Returns length and height, each between its limits; and a depth in 3D."""
        length, height = (self.scale * self.rng.uniform(*limits) for limits in slenderness)
        return [length, height] if self.dim == 2 else [length, self.scale * self.rng.uniform(0.4, 1.2), height]

    def fixed(self):
        return [0.0] * self.dim

    def only(self, **given):
        """Returns a displacement with these components prescribed."""
        names = "xz" if self.dim == 2 else "xyz"
        return [given.get(name) for name in names]

    def gap(self, size):
        """Returns 0 in half of the cases, otherwise up to the body's size."""
        return 0.0 if self.rng.random() < 0.5 else size * 10 ** self.rng.uniform(-3, 0)

    def contact(self, on, point, normal, mu=None):
        mu = self.mu if mu is None else mu
        entry = {"on": on, "obstacle": {"plane": {"point": point, "normal": normal}}}
        return self.with_friction(entry, mu)

    def ball(self, on, centre, radius):
        return self.with_friction({"on": on, "obstacle": {"sphere": {"centre": centre, "radius": radius}}}, self.mu)

    def with_friction(self, entry, mu):
        if mu > 0:
            entry["friction"] = {"tresca": mu * self.load * self.rng.uniform(0.2, 1)} if self.tresca else {"coulomb": mu}
        return entry

    def guides(self):
        """Returns guides that support a frictionless body tangentially, on sides that may slide up and down."""
        guides = [{"on": "left", "displacement": self.only(x=0.0)}]
        return guides + ([{"on": "front", "displacement": self.only(y=0.0)}] if self.dim == 3 else [])

    def sideways(self, most, size):
        """Returns shear over pressure: mostly what friction can carry (values near the limit are hardest), without
        tipping over."""
        share = self.rng.choice((0.0, 0.3, 0.6, 0.9, 0.97))
        if self.rng.random() < 0.06:
            share = self.rng.uniform(1.05, 2.0)
        return min(share * most, 0.25 * min(size[0], size[-2] if self.dim == 3 else size[0]) / size[-1])


def press(d):
    """A body on the floor that only friction supports, under pressure and shear."""
    size = d.size((0.8, 3.0), (0.3, 1.2))
    body = bodies.block(size, d.element, MOST_NODES, d.rng, distorted=d.rng.random() < 0.5)
    p, turn = d.load, d.rng.uniform(0, 2 * math.pi)
    shear = d.sideways(d.mu, size) * p if d.mu else 0.1 * p
    boundary = [{"on": "top", "traction": d.vector(shear * (1 if d.dim == 2 else math.cos(turn)), -p, shear * math.sin(turn))}]
    if d.mu == 0 or d.tresca or d.rng.random() < 0.25:
        boundary += d.guides()
    return body, boundary, [d.contact("bottom", d.fixed(), d.vector(0, 1))]


def press_distant(d):
    """Pushed or pressed onto a floor at a distance, along guides or by its top."""
    size = d.size((0.6, 3.0), (0.4, 1.5))
    body = bodies.block(size, d.element, MOST_NODES, d.rng, distorted=d.rng.random() < 0.3)
    gap = d.gap(size[-1])
    floor = [d.contact("bottom", d.vector(0, -gap), d.vector(0, 1))]
    way = d.rng.randrange(3)
    if way == 0:
        strain = d.load / d.young * d.rng.uniform(1, 5)
        down = gap + strain * size[-1]
        boundary = [{"on": "top", "displacement": d.vector(d.rng.uniform(-1, 1) * strain * size[-1], -down, 0.0)}]
    elif way == 1:
        boundary = [{"on": "top", "displacement": [0.0] * (d.dim - 1) + [None]}, {"on": "top", "traction": d.vector(0, -d.load)}]
    else:
        boundary = d.guides() + [{"on": "top", "traction": d.vector(d.load * d.rng.uniform(-0.1, 0.1), -d.load)}]
    return body, boundary, floor


def ball_on_floor(d):
    """Half a ball, moved by its flat face or pushed by a pressure on it."""
    radius = d.scale * d.rng.uniform(0.5, 2)
    body = bodies.half_ball(radius, d.element, MOST_NODES, d.rng)
    gap = d.gap(2 * radius) if d.rng.random() < 0.5 else 0.0
    aside = d.rng.choice((0.0, 0.1, 0.5, 1.5))
    if d.rng.random() < 0.5:
        depth = radius * 10 ** d.rng.uniform(-3, -1.2)
        boundary = [{"on": "flat", "displacement": d.vector(aside * depth, -gap - depth, 0.0)}]
    else:
        boundary = [{"on": "flat", "displacement": [0.0] * (d.dim - 1) + [None]},
                    {"on": "flat", "traction": d.vector(0, -0.2 * d.load)}]
    return body, boundary, [d.contact("round", d.vector(0, -gap), d.vector(0, 1))]


def cantilever(d):
    """Clamped at the left, bent onto a floor or lying on it, pulled and pushed along."""
    size = d.size((2.0, 6.0), (0.4, 1.0))
    body = bodies.block(size, d.element, MOST_NODES, d.rng, distorted=d.rng.random() < 0.3)
    length, height = size[0], size[-1]
    q = d.load * (height / length) ** 2 / 3  # yields at the clamp: 3 q (l/h)²
    boundary = [{"on": "left", "displacement": d.fixed()},
                {"on": "top", "traction": d.vector(q * d.rng.uniform(-1, 1), -q, q * d.rng.choice((0.0, 0.3)))}]
    sag = q * length**4 / (8 * d.young * height**3 / 12)
    gap = d.rng.choice((0.0, 0.0, 0.1, 0.5, 0.9, 3.0)) * sag
    return body, boundary, [d.contact("bottom", d.vector(0, -gap), d.vector(0, 1))]


def corner(d):
    """In a corner of floor and wall: nodes of the edge are in both entries."""
    size = d.size((0.6, 1.5), (0.6, 1.5))
    body = bodies.block(size, d.element, MOST_NODES, d.rng, distorted=False)
    p = d.load
    boundary = [{"on": "top", "traction": d.vector(-p * d.rng.choice((0.0, 0.2, 0.5, 1.0)), -p, -p * d.rng.choice((0.0, 0.1, 0.3)))}]
    if d.dim == 3 and (d.mu == 0 or d.tresca or d.rng.random() < 0.7):
        boundary.append({"on": "front", "displacement": d.only(y=0.0)})
    walls = [d.contact("bottom", d.fixed(), d.vector(0, 1)),
             d.contact("left", d.fixed(), d.vector(1, 0), d.mu if d.rng.random() < 0.7 else 0.0)]
    if d.dim == 3 and boundary[-1]["on"] != "front":
        walls.append(d.contact("front", d.fixed(), [0, 1, 0]))
    if d.rng.random() < 0.3:
        boundary.append({"on": "right", "pressure": 0.5 * p})
    return body, boundary, walls


def incline(d):
    """A block on an incline under its weight."""
    d.mu, d.tresca = d.mu or 0.3, False
    size = d.size((1.0, 2.5), (0.3, 0.8))
    body = bodies.block(size, d.element, MOST_NODES, d.rng)
    steep = d.mu * (d.rng.uniform(0.1, 0.98) if d.rng.random() < 0.9 else d.rng.uniform(1.02, 2))
    steep = min(steep, 0.7 * size[0] / size[-1])
    angle, weight = math.atan(steep), d.load / size[-1]
    return body, [{"on": "all", "body_force": d.vector(weight * math.sin(angle), -weight * math.cos(angle))}], [
        d.contact("bottom", d.fixed(), d.vector(0, 1))]


def notch(d):
    """A wedge pressed into a notch of two slopes."""
    slope = d.rng.uniform(0.2, 1.2)
    width, height, depth = (d.scale * d.rng.uniform(0.5, 1.5) for _ in range(3))
    body = bodies.wedge(width, height, depth, slope, d.element, MOST_NODES, d.rng)
    p, half = d.load * 0.5, 0.5 * width
    boundary = [{"on": "top", "traction": d.vector(p * d.rng.choice((0.0, 0.05, 0.2)), -p)}]
    if d.dim == 3 and (d.mu == 0 or d.rng.random() < 0.5):
        boundary.append({"on": "front", "displacement": d.only(y=0.0)})
    gap = d.rng.choice((0.0, 0.0, 0.01)) * width
    return body, boundary, [d.contact("left", d.vector(-half - gap, 0), d.vector(1, slope)),
                            d.contact("right", d.vector(half + gap, 0), d.vector(-1, slope))]


def bracket(d):
    """An L on its foot, its back to the wall, pulled at the upright or at the foot's end."""
    size = d.size((1.2, 2.5), (1.2, 2.5))
    body = bodies.bracket(size, d.element, MOST_NODES, d.rng)
    q = d.load * d.rng.choice((0.05, 0.2))
    contact = [d.contact("bottom", d.fixed(), d.vector(0, 1))]
    pull = {"on": "right", "traction": d.vector(q * d.rng.choice((-0.3, 0.0, 0.2)), -q)}
    way = d.rng.randrange(3)
    if way == 0:
        return body, [{"on": "left", "displacement": d.fixed()}, {"on": "right", "traction": d.vector(0.1 * q, -0.2 * q)}], contact
    contact.append(d.contact("left", d.fixed(), d.vector(1, 0)))
    pull["traction"][0] = -abs(pull["traction"][0]) - 0.1 * q
    boundary = [pull, {"on": "top", "traction": d.vector(-0.3 * q, -q)}]
    if d.dim == 3 and (way == 1 or d.mu == 0 or d.tresca):
        boundary.append({"on": "front", "displacement": d.only(y=0.0)})
    return body, boundary, contact


def hook(d):
    """A hook on a pin, held by its end and pulled, or its tip pressed on the ground."""
    radius, thickness = d.scale, d.scale * d.rng.uniform(0.2, 0.6)
    body = bodies.hook(radius, thickness, d.element, MOST_NODES, d.rng)
    inner = radius - 0.5 * thickness
    if d.rng.random() < 0.5:
        pin = inner * d.rng.uniform(0.7, 0.99)
        centre = d.vector(inner - pin - d.rng.choice((0.0, 0.01)) * inner, 0.0, 0.3 * thickness)
        move = radius * 10 ** d.rng.uniform(-3, -1.5)
        return body, [{"on": "end", "displacement": d.vector(-move, d.rng.uniform(-0.5, 0.5) * move, 0.0)}], [d.ball("inside", centre, pin)]
    low = min(x[-1] for x in body.nodes)
    move = radius * 10 ** d.rng.uniform(-3, -1.5)
    return body, [{"on": "end", "displacement": d.vector(d.rng.uniform(-0.5, 0.5) * move, -move, 0.0)}], [
        d.contact("outside", d.vector(0, low), d.vector(0, 1))]


def dent(d):
    """A clamped block with a ball pressed into its top."""
    size = d.size((1.5, 3.0), (0.7, 1.2))
    body = bodies.block(size, d.element, MOST_NODES, d.rng)
    radius, depth = size[0] * d.rng.uniform(0.3, 1.5), size[-1] * 10 ** d.rng.uniform(-3, -1)
    centre = d.vector(size[0] * d.rng.uniform(0.4, 0.6), size[-1] + radius - depth, 0.5 * size[1])
    return body, [{"on": "bottom", "displacement": d.fixed()}], [d.ball("top", centre, radius)]


def drag(d):
    """Pressed by its top on a floor, and dragged along."""
    size = d.size((1.0, 3.0), (0.5, 1.2))
    body = bodies.block(size, d.element, MOST_NODES, d.rng, distorted=d.rng.random() < 0.5)
    down = size[-1] * 10 ** d.rng.uniform(-3.3, -1.3)
    boundary = [{"on": "top", "displacement": d.vector(down * d.rng.choice((0.2, 1.0, 5.0)), -down, down * d.rng.choice((0.0, 0.5)))}]
    return body, boundary, [d.contact("bottom", d.fixed(), d.vector(d.rng.uniform(-0.1, 0.1), 1))]


def two_pieces(d):
    """Two blocks on one floor, one of them under guides."""
    size = d.size((0.8, 2.0), (0.4, 1.0))
    first = bodies.block(size, d.element, MOST_NODES // 2, d.rng)
    second = bodies.block(size, d.element, MOST_NODES // 2, d.rng)
    second.nodes = [(x[0] + 1.5 * size[0], *x[1:]) for x in second.nodes]
    body = bodies.join(first, second)
    shear = d.sideways(d.mu, size) * d.load
    boundary = [{"on": "top", "traction": d.vector(shear, -d.load)}, {"on": "top'", "displacement": d.vector(0, -1e-3 * size[-1])}]
    if d.mu == 0 or d.tresca:
        boundary += d.guides()
    return body, boundary, [d.contact("bottom", d.fixed(), d.vector(0, 1)), d.contact("bottom'", d.fixed(), d.vector(0, 1))]


def lifted(d):
    """Pulled off its only contact: there is no equilibrium."""
    size = d.size((0.8, 2.0), (0.4, 1.0))
    body = bodies.block(size, d.element, MOST_NODES, d.rng)
    return body, d.guides() + [{"on": "top", "traction": d.vector(0, d.load * 10 ** d.rng.uniform(-4, 0))}], [
        d.contact("bottom", d.fixed(), d.vector(0, 1))]


KINDS = {press: 6, press_distant: 5, ball_on_floor: 4, cantilever: 5, corner: 6, incline: 3, notch: 3, bracket: 4, hook: 4,
         dent: 3, drag: 4, two_pieces: 2, lifted: 0.5}


def random_case(seed, index):
    """Returns name, case without the mesh's file, body; the same for the same seed and index."""
    d = Draw(f"{seed} {index}")
    kind = d.rng.choices(list(KINDS), list(KINDS.values()))[0]
    body, boundary, contact = kind(d)
    friction = "tresca" if d.tresca else f"mu {d.mu:g}" if d.mu else "smooth"
    name = f"{index} {kind.__name__} {d.element} {friction} {d.law} {'unit' if d.unit else 'steel'}"
    law = laws(d.unit)[d.law]
    return name, {"mesh": {"file": "random.msh"}, "material": [{"on": "all", "young": d.young, "poisson": 0.3, "law": law}],
                  "boundary": boundary, "contact": contact}, body
