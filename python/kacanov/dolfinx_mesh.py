# SPDX-License-Identifier: BSD-3-Clause
"""Function spaces of DOLFINx as bodies, on one process or several."""
from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import InputError
from .mesh import ELEMENTS, Mesh

Array = npt.NDArray[Any]

# Element type by DOLFINx cell and number of nodes of the Lagrange element.
DOLFINX = {("triangle", 3): "tri3", ("quadrilateral", 4): "quad4", ("tetrahedron", 4): "tet4",
           ("tetrahedron", 10): "tet10", ("hexahedron", 8): "hex8"}
# Node order of the mirrored element; AXES: end nodes of the edges from the first node that give the
# orientation.
MIRRORED = {"tri3": [0, 2, 1], "quad4": [0, 3, 2, 1], "tet4": [0, 2, 1, 3], "hex8": [0, 3, 2, 1, 4, 7, 6, 5],
            "tet10": [0, 2, 1, 3, 6, 5, 4, 7, 9, 8]}
AXES = {"tri3": [1, 2], "quad4": [1, 3], "tet4": [1, 2, 3], "tet10": [1, 2, 3], "hex8": [1, 3, 4]}

Named = Mapping[str, npt.ArrayLike] | None


class DolfinxMesh(Mesh):
    """The body of a function space: whole on the first rank and empty on the others, or each rank's own part."""

    def __init__(self, comm: Any, numbers: list[Array] | None, arrays: dict[str, Any]) -> None:
        super().__init__(order="basix", **arrays)
        self._comm, self._numbers = comm, numbers  # node numbers of each rank, on the first rank
        corners = self.points[self.cells]
        wrong = np.linalg.det(corners[:, AXES[self.element]] - corners[:, :1]) < 0
        self.cells[wrong] = self.cells[wrong][:, MIRRORED[self.element]]

    def local(self, field: npt.ArrayLike) -> Array:
        """Distributes a nodal field (nodes, ...) of the first rank, such as `sol.u`: returns its values at the nodes of
        each rank, ghosts included: u.x.array[:] = body.local(sol.u).ravel(). `field` is ignored on other ranks.
        Collective."""
        pieces, failed = None, None
        if self._comm.rank == 0:
            values = np.asarray(field)
            if self._numbers is None or values.shape[:1] != self.points.shape[:1]:
                failed = f"field: expected one of all {len(self.points)} nodes of a whole body, got shape {values.shape}"
            else:
                pieces = [values[numbers] for numbers in self._numbers]
        failed = self._comm.bcast(failed)
        if failed is not None:
            raise InputError(failed)
        return self._comm.scatter(pieces)


def from_dolfinx(space: Any, facets: Named = None, parts: Named = None, *, part: bool = False) -> DolfinxMesh:
    """Returns the nodes and cells of a DOLFINx function space of displacements.

    space: Lagrange of degree 1, or 2 on tetrahedra, with one component per dimension of the mesh. Nodes are numbered as
    in the space: on one process `u.x.array.reshape(mesh.points.shape)` is a displacement here, and vice versa.
    `facets` and `parts` name facets and cells by DOLFINx' indices, as MeshTags.find returns them, on each rank its own.
    Inverted cells are reoriented.

    On several processes the first one gets the whole body, in DOLFINx' global numbering, for
    Case(...).solve(comm=...); `local` returns fields to the ranks. `part`: each rank gets its own cells instead, in
    local numbering including ghosts; results must then be summed over the ranks. Collective.
    """
    element = _element_of(space)
    comm = space.mesh.comm
    try:
        arrays, failed = _own(space, element, facets, parts), None
    except InputError as error:
        arrays, failed = {}, str(error)
    for rank, text in enumerate(comm.allgather(failed)):
        if text is not None:
            raise InputError(text if comm.size == 1 else f"rank {rank}: {text}")
    if part:
        return DolfinxMesh(comm, None, arrays)
    numbers = space.dofmap.index_map.local_to_global(np.arange(len(arrays["points"]), dtype=np.int32))
    return _whole(space, arrays, numbers)


def _element_of(space: Any) -> str:
    topology, dofmap, dim = space.mesh.topology, space.dofmap, space.mesh.geometry.dim
    name = topology.cell_name() if hasattr(topology, "cell_name") else topology.cell_type.name
    nodes = dofmap.dof_layout.num_dofs
    element = DOLFINX.get((name, nodes))
    if element is None or ELEMENTS[element][0] != dim:
        raise InputError(f"space: expected Lagrange of degree 1, or 2 on tetrahedra, got {nodes} nodes a {name} in "
                         f"{dim} dimensions")
    if space.element.basix_element.discontinuous:
        raise InputError("space: expected a continuous one")
    if dofmap.index_map_bs != dim:
        raise InputError(f"space: expected {dim} components, got {dofmap.index_map_bs}")
    return element


def _own(space: Any, element: str, facets: Named, parts: Named) -> dict[str, Any]:
    """Returns this rank's own cells, numbered over all nodes that it stores."""
    topology, dofmap, dim = space.mesh.topology, space.dofmap, space.mesh.geometry.dim
    table = dofmap.list
    if not isinstance(table, np.ndarray):  # before 0.7
        table = table.array.reshape(table.num_nodes, -1)
    own = topology.index_map(dim).size_local
    named = {}
    if facets:
        topology.create_connectivity(dim - 1, dim)
        topology.create_connectivity(dim, dim - 1)
        cells_of, facets_of = topology.connectivity(dim - 1, dim), topology.connectivity(dim, dim - 1)
        for key, group in facets.items():
            rows = []
            for facet in Mesh._indices(f"facets[{key!r}]", group, 0, cells_of.num_nodes):
                cell = cells_of.links(facet)[0]
                if cell < own:
                    local = int(np.flatnonzero(facets_of.links(cell) == facet)[0])
                    rows.append(table[cell][dofmap.dof_layout.entity_closure_dofs(dim - 1, local)])
            width = len(dofmap.dof_layout.entity_closure_dofs(dim - 1, 0))
            named[key] = np.array(rows, dtype=np.int32).reshape(len(rows), width)
    cells = {}
    for key, group in (parts or {}).items():
        known = Mesh._indices(f"parts[{key!r}]", group, 0, len(table))
        cells[key] = known[known < own]
    points = np.ascontiguousarray(space.tabulate_dof_coordinates()[:, :dim])
    return {"points": points, "cells": table[:own], "element": element, "facets": named, "parts": cells}


def _whole(space: Any, own: dict[str, Any], numbers: Array) -> DolfinxMesh:
    """Returns, on the first rank, the owned data of all ranks in rank order, which is DOLFINx' global order."""
    comm, dofmap = space.mesh.comm, space.dofmap
    first_cell = space.mesh.topology.index_map(space.mesh.geometry.dim).local_range[0]
    keys = [sorted(own[kind]) for kind in ("facets", "parts")]
    if any(other != keys for other in comm.allgather(keys)):
        raise InputError("facets, parts: expected the same names on all ranks")
    gathered = comm.gather((own["points"][:dofmap.index_map.size_local], numbers[own["cells"]],
                            {key: numbers[group] for key, group in own["facets"].items()},
                            {key: group + first_cell for key, group in own["parts"].items()}))
    all_numbers = comm.gather(numbers)
    if gathered is None:
        empty = {"points": own["points"][:0], "cells": own["cells"][:0], "element": own["element"]}
        return DolfinxMesh(comm, None, empty)
    points, cells, facets, parts = zip(*gathered, strict=True)
    return DolfinxMesh(comm, all_numbers, {
        "points": np.concatenate(points), "cells": np.concatenate(cells), "element": own["element"],
        "facets": {key: np.concatenate([group[key] for group in facets]) for key in keys[0]},
        "parts": {key: np.concatenate([group[key] for group in parts]) for key in keys[1]}})
