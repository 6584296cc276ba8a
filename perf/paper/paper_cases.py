# SPDX-License-Identifier: BSD-3-Clause
"""The beam of the paper's section 5 as case files, its printed figures, and the settings of its algorithm."""

PRINTED = {  # key: r*, contact iterations, CPU seconds of tables 1 and 2
    "16 smooth 0.005": (4.3143, 34, 7.3906),
    "16 smooth 0.05": (4.3143, 34, 7.5469),
    "32 smooth 0.05": (5.9999, 74, 159.7969),
    "16 tresca 0.05": (4.3143, 51, 8.1875),
}
# Algorithm 1 in Kacanov's steps, from rest, without over-relaxation.
ALGORITHM = {"outer": "kacanov", "contact": "admm", "relaxation": 1, "nested": False}
BY_STEP = {**ALGORITHM, "stop": "paper", "tolerance": 1e-5}  # the criterion (15)
BY_KKT = {**ALGORITHM, "stop": "kkt", "tolerance": 1e-6}
AUTOMATIC = {"outer": "kacanov", "contact": "admm", "nested": False, "stop": "kkt", "tolerance": 1e-6, "r": "auto"}
DEFAULT = {"tolerance": 1e-6}


def beam(n, load, friction, dim=2, argument="squared"):
    """Returns the beam with h = 1/n. `argument`: "squared" is the law as the paper prints it, g(‖dev ε‖²); "norm" is the
    one with which stress always grows, and with which the body yields under a load of 0.05."""
    size, cells = ([4, 1], [4 * n, n]) if dim == 2 else ([4, 1, 1], [4 * n, n, n])
    top = [[2, 1], [4, 1]] if dim == 2 else [[2, 0, 1], [4, 1, 1]]
    up = [0] * (dim - 1) + [1]
    contact = {"on": "bottom", "obstacle": {"plane": {"point": [0] * dim, "normal": up}}}
    if friction:
        contact["friction"] = {"tresca": 0.2 * load}  # the paper's coefficient of 0.2 times the load
    law = {"type": "logarithmic", "x0": 0.01, "argument": argument}
    return {"mesh": {"box": {"size": size, "cells": cells, "element": "tri3" if dim == 2 else "tet4"}},
            "material": [{"on": "all", "young": 1.0, "poisson": 0.3, "law": law}],
            "boundary": [{"on": "left", "displacement": [0] * dim},
                         {"on": {"box": top}, "traction": [-load * x for x in up]}],
            "contact": [contact]}


def name(n, load, friction, dim=2):
    return f"{n} {'tresca' if friction else 'smooth'} {load:g}" + (" 3d" if dim == 3 else "")
