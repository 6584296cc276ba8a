# SPDX-License-Identifier: BSD-3-Clause
"""kacanov: elastoplastic bodies in contact with rigid obstacles, solved in this process, and the underlying operator.

    import kacanov as kc
    case = kc.Case(kc.box((4, 1, 1), (16, 4, 4), "hex8"))
    case.material(young=210e3, poisson=0.3, law=kc.Logarithmic(yield_stress=250))
    case.fix("left").traction((0, 0, -20), on=kc.Box((2, 0, 1), (4, 1, 1)))
    case.contact("bottom", kc.Plane(point=(0, 0, 0), normal=(0, 0, 1)), coulomb=0.3)
    sol = case.solve(progress=True)
"""
from ._kacanov import version as __version__
from .case import Case, ProgressTable
from .dolfinx_mesh import from_dolfinx
from .errors import Error, InputError, InternalError, Interrupted, RankError, StateError
from .mesh import BoxMesh, Mesh, MeshFile, box, from_meshio, read
from .operator import CgResult, Multigrid, Operator, Tangent
from .solution import Solution, Step
from .words import (Block, Box, Cone, Cylinder, Gap, HeightMap, Law, Linear, LinearHardening, Logarithmic, Material,
                    Obstacle, OwnLaw, Plane, Power, RambergOsgood, Saturating, Sphere, Surface, Table, Torus)

__all__ = [
    "Block", "Box", "BoxMesh", "Case", "CgResult", "Cone", "Cylinder", "Error", "Gap", "HeightMap", "InputError",
    "InternalError", "Interrupted", "Law", "Linear", "LinearHardening", "Logarithmic", "Material", "Mesh", "MeshFile",
    "Multigrid", "Obstacle", "Operator", "OwnLaw", "Plane", "Power", "ProgressTable", "RambergOsgood", "RankError",
    "Saturating", "Solution", "Sphere", "StateError", "Step", "Surface", "Table", "Tangent", "Torus", "box",
    "from_dolfinx", "from_meshio", "read", "__version__"]
