# SPDX-License-Identifier: BSD-3-Clause
"""Meshes: generated boxes, files, and arrays, which are passed to the solver as the content of a Gmsh file."""
from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import InputError
from .words import Word

# By element: dimension, Gmsh type number, and Gmsh type of its facets by number of nodes. Node k in another
# order is our node ORDERS[order][element][k].
ELEMENTS = {"tri3": (2, 2, {2: 1}), "quad4": (2, 3, {2: 1}), "tet4": (3, 4, {3: 2}),
            "tet10": (3, 11, {3: 2, 6: 9}), "hex8": (3, 5, {4: 3})}
NODES = {"tri3": 3, "quad4": 4, "tet4": 4, "tet10": 10, "hex8": 8}
ORDERS: dict[str, dict[str, list[int]]] = {
    "gmsh": {}, "kacanov": {}, "vtk": {"tet10": [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]},
    "basix": {"quad4": [0, 1, 3, 2], "hex8": [0, 1, 3, 2, 4, 5, 7, 6], "tet10": [0, 1, 2, 3, 8, 9, 5, 7, 6, 4]}}
# meshio cell names of bodies.
MESHIO = {"triangle": "tri3", "quad": "quad4", "tetra": "tet4", "tetra10": "tet10", "hexahedron": "hex8"}


class BoxMesh(Word):
    """The body [0, size] divided into cells, with the sides left, right, front, back, bottom and top."""

    def __init__(self, size: Sequence[float], cells: Sequence[int], element: str | None = None) -> None:
        self.size, self.cells, self.element = tuple(size), tuple(cells), element

    def json(self) -> dict[str, Any]:
        words = {"size": self.size, "cells": self.cells, "element": self.element}
        return {"box": {key: value for key, value in words.items() if value is not None}}


class MeshFile(Word):
    """A Gmsh file, read when the case is solved."""

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = os.path.abspath(path)

    def json(self) -> dict[str, Any]:
        return {"file": self.path}


class Mesh:
    """A body of one element type, given as arrays.

    points: (nodes, 2 or 3); cells: (elements, nodes per element), from 0; order: node order of `cells`, "gmsh",
    "kacanov" (the same), "vtk" or "basix". `facets` names parts of the boundary, each as (count, nodes per facet) with
    the corners first, in any order; `parts` names sets of element indices, `nodes` sets of nodes.
    """

    def __init__(self, points: npt.ArrayLike, cells: npt.ArrayLike, element: str, *, order: str = "gmsh",
                 facets: Mapping[str, npt.ArrayLike] | None = None, parts: Mapping[str, npt.ArrayLike] | None = None,
                 nodes: Mapping[str, npt.ArrayLike] | None = None) -> None:
        if element not in ELEMENTS:
            raise InputError(f"element: expected {', '.join(ELEMENTS)}, got \"{element}\"")
        if order not in ORDERS:
            raise InputError(f"order: expected {', '.join(ORDERS)}, got \"{order}\"")
        self.element = element
        dim = ELEMENTS[element][0]
        self.points = np.ascontiguousarray(points, dtype=np.float64)
        if self.points.ndim != 2 or self.points.shape[1] not in (dim, 3):
            raise InputError(f"points: expected an array of shape (any, {dim}), got {self.points.shape}")
        self.cells = self._indices("cells", cells, NODES[element], len(self.points))
        ours = ORDERS[order].get(element)
        if ours is not None:
            self.cells = np.ascontiguousarray(self.cells[:, np.argsort(ours)])
        self.facets = {}
        for name, group in (facets or {}).items():
            array = np.asarray(group)
            widths = ELEMENTS[element][2]
            if array.ndim != 2 or array.shape[1] not in widths:
                raise InputError(f"facets[{name!r}]: expected an array of shape (any, {' or '.join(map(str, widths))}), "
                                 f"got {array.shape}")
            self.facets[name] = self._indices(f"facets[{name!r}]", array, array.shape[1], len(self.points))
        self.parts = {name: self._indices(f"parts[{name!r}]", group, 0, len(self.cells))
                      for name, group in (parts or {}).items()}
        self.nodes = {name: self._indices(f"nodes[{name!r}]", group, 0, len(self.points))
                      for name, group in (nodes or {}).items()}
        for name in (*self.facets, *self.parts, *self.nodes):
            if not name or any(c in name for c in '"\n\r'):
                raise InputError(f"name of a group: expected text without quotes and line ends, got {name!r}")

    @staticmethod
    def _indices(name: str, values: npt.ArrayLike, width: int, end: int) -> npt.NDArray[np.int32]:
        """Returns the values as int32; width 0: one per row."""
        array = np.asarray(values)
        if array.size and array.dtype.kind not in "iu":
            raise InputError(f"{name}: expected whole numbers, got {array.dtype}")
        shape = "(any,)" if width == 0 else f"(any, {width})"
        if array.ndim != (2 if width else 1) or (width and array.shape[1] != width):
            raise InputError(f"{name}: expected an array of shape {shape}, got {array.shape}")
        if array.size and (array.min() < 0 or array.max() >= end):
            raise InputError(f"{name}: expected numbers from 0 to {end - 1}, got {array.min()} to {array.max()}")
        return np.ascontiguousarray(array, dtype=np.int32)

    def msh(self) -> bytes:
        """Returns the mesh as a binary Gmsh file of version 2.2, with the groups as physical names."""
        dim, own, facet_types = ELEMENTS[self.element]
        names = [(dim - 1, name) for name in self.facets] + [(dim, name) for name in self.parts]
        names += [(0, name) for name in self.nodes]
        out = [b"$MeshFormat\n2.2 1 8\n", np.int32(1).tobytes(), b"\n$EndMeshFormat\n$PhysicalNames\n",
               f"{len(names)}\n".encode()]
        out += [f'{at} {i + 1} "{name}"\n'.encode() for i, (at, name) in enumerate(names)]
        node = np.zeros(len(self.points), dtype=[("tag", "<i4"), ("x", "<f8", 3)])
        node["tag"] = np.arange(1, len(node) + 1)
        node["x"][:, :self.points.shape[1]] = self.points
        out += [f"$EndPhysicalNames\n$Nodes\n{len(node)}\n".encode(), node.tobytes(), b"\n$EndNodes\n$Elements\n"]
        # Version 2.2 has one group per element, so elements are repeated for each further group.
        group_of = np.zeros(len(self.cells), dtype=np.int32)
        tag = len(self.facets)
        for members in self.parts.values():
            tag += 1
            if np.any(group_of[members]):
                raise InputError("parts: expected every element in one of them at most")
            group_of[members] = tag
        blocks = [(own, group_of, self.cells)]
        blocks += [(facet_types[group.shape[1]], np.full(len(group), i + 1), group)
                   for i, group in enumerate(self.facets.values())]
        blocks += [(15, np.full(len(group), tag + 1 + i), group[:, None])
                   for i, group in enumerate(self.nodes.values())]
        blocks = [block for block in blocks if len(block[2])]
        out.append(f"{sum(len(block[2]) for block in blocks)}\n".encode())
        first = 1
        for kind, groups, members in blocks:
            rows = np.zeros((len(members), 3 + members.shape[1]), dtype="<i4")
            rows[:, 0] = np.arange(first, first + len(members))
            rows[:, 1] = rows[:, 2] = groups
            rows[:, 3:] = members + 1
            first += len(members)
            out += [np.array([kind, len(members), 2], dtype="<i4").tobytes(), rows.tobytes()]
        return b"".join([*out, b"\n$EndElements\n"])


def box(size: Sequence[float], cells: Sequence[int], element: str | None = None) -> BoxMesh:
    """Returns the generated box [0, size]. Default element: tri3 or tet4."""
    return BoxMesh(size, cells, element)


def read(path: str | os.PathLike[str]) -> MeshFile:
    """Returns the mesh of a Gmsh .msh file, version 2.2 or 4.1."""
    if not os.path.isfile(path):
        raise InputError(f"{os.fspath(path)}: there is no such file")
    return MeshFile(path)


def from_meshio(mesh: Any) -> Mesh:
    """Converts a meshio.Mesh: cells of the highest dimension form the body; cell sets or physical groups name parts."""
    dims = {kind: ELEMENTS[element][0] for kind, element in MESHIO.items()}
    bodies = [block for block in mesh.cells if block.type in dims]
    top = max((dims[block.type] for block in bodies), default=0)
    kinds = {block.type for block in bodies if dims[block.type] == top}
    if len(kinds) != 1:
        raise InputError(f"mesh: expected cells of one type of {', '.join(MESHIO)}, got "
                         f"{', '.join(sorted(kinds)) or 'none of them'}")
    kind = kinds.pop()
    element = MESHIO[kind]
    dim, _, facet_types = ELEMENTS[element]
    cells = np.concatenate([block.data for block in bodies if block.type == kind])
    if dim == 3 and mesh.points.shape[1] != 3:
        raise InputError(f"mesh: expected points in 3 dimensions, got {mesh.points.shape[1]}")
    facets: dict[str, list[npt.NDArray[Any]]] = {}
    parts: dict[str, list[npt.NDArray[Any]]] = {}
    for name, members in _sets(mesh):
        first = 0
        for block, chosen in zip(mesh.cells, members, strict=True):
            if block.type == kind:
                if chosen is not None and len(chosen):
                    parts.setdefault(name, []).append(np.asarray(chosen) + first)
                first += len(block.data)
            elif chosen is not None and len(chosen) and block.data.shape[1] in facet_types:
                facets.setdefault(name, []).append(block.data[chosen])
    return Mesh(mesh.points, cells, element, order="vtk",
                facets={name: np.concatenate(all_) for name, all_ in facets.items()},
                parts={name: np.concatenate(all_) for name, all_ in parts.items()},
                nodes={name: np.asarray(group) for name, group in (mesh.point_sets or {}).items()})


def _sets(mesh: Any) -> list[tuple[str, list[Any]]]:
    """Returns, by name, the selected cells of every block: cell sets, or else Gmsh's physical groups."""
    if mesh.cell_sets:
        return [(name, members) for name, members in mesh.cell_sets.items() if not name.startswith("gmsh:")]
    groups = []
    physical = mesh.cell_data.get("gmsh:physical")
    for name, (tag, _) in (mesh.field_data or {}).items():
        if physical is not None:
            groups.append((name, [np.flatnonzero(np.asarray(data) == tag) for data in physical]))
    return groups
