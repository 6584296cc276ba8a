# SPDX-License-Identifier: BSD-3-Clause
"""What a solve has found: the numbers of result.json, and fields as arrays."""
from __future__ import annotations

import functools
import json
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _kacanov

Array = npt.NDArray[Any]


class ElementMeans:
    """Means over the elements, made when the first is asked for."""

    @functools.cached_property
    def _elements(self) -> dict[str, Array]:
        raise NotImplementedError

    @property
    def stress(self) -> Array:
        """Means over the elements, (elements, 6): xx yy zz xy yz zx."""
        return self._elements["stress"]

    @property
    def von_mises(self) -> Array:
        """Means over the elements, (elements,)."""
        return self._elements["von_mises"]

    @property
    def dev_strain(self) -> Array:
        """Norm of the strain deviator, means over the elements."""
        return self._elements["dev_strain"]

    @property
    def g(self) -> Array:
        """Secant shear modulus, means over the elements."""
        return self._elements["g"]

    @property
    def plastic(self) -> Array:
        """Whether any point of an element is beyond yield."""
        return self._elements["plastic"]


class Step(ElementMeans):
    """The end of a load step: its line of result["load_steps"], and fields in the shapes of Solution. Read-only.

    factor: what the loads are multiplied by; with `steps` of the case the time.
    result: its numbers, as result["load_steps"] has them; empty where the run ended on the way to the next one.
    u: displacement, (nodes, dim).
    """

    def __init__(self, factor: float, result: dict[str, Any], u: Array, elements: Callable[[], dict[str, Array]],
                 contact: Callable[[], dict[str, Array]]) -> None:
        self.factor, self.result, self.u = factor, result, u
        self._make_elements, self._make_contact = elements, contact

    @functools.cached_property
    def _elements(self) -> dict[str, Array]:
        return self._make_elements()

    @functools.cached_property
    def contact(self) -> dict[str, Array]:
        """By contact point, as Solution.contact."""
        return self._make_contact()

    def __repr__(self) -> str:
        return f"<kacanov.Step: {self.factor:g}>"


class Solution(ElementMeans):
    """Numbers and fields of a solve. Arrays are read-only, in the numbering of the mesh, and made when asked for.

    `result` has all numbers under the names of result.json (docs/user-guide/results.md).
    """

    def __init__(self, solved: _kacanov.Solved) -> None:
        self._solved = solved

    @functools.cached_property
    def result(self) -> dict[str, Any]:
        """What result.json says."""
        return json.loads(self._solved.json)

    @property
    def status(self) -> str:
        """converged, limited_by_rounding, not_converged or interrupted."""
        return self.result["status"]

    @property
    def converged(self) -> bool:
        """Whether all KKT residuals are within the tolerance."""
        return self.status == "converged"

    @property
    def message(self) -> str:
        """The verdict in a sentence."""
        return self.result["message"]

    @property
    def warnings(self) -> list[str]:
        """What may make the numbers less than they seem."""
        return self.result["warnings"]

    @property
    def certificate(self) -> dict[str, Any]:
        """The relative KKT residuals, and under `rounding` what can be known of each."""
        return self.result["certificate"]

    @property
    def contact_force(self) -> Array:
        """Sum of the normal forces that the obstacles do to the body."""
        return np.array(self.result["contact_force"], dtype=float)

    @property
    def friction_force(self) -> Array:
        """The same of friction."""
        return np.array(self.result["friction_force"], dtype=float)

    @property
    def probe(self) -> Array:
        """Displacements at the probe points, (points, dim)."""
        return np.array(self.result["probe"], dtype=float)

    # ---- the mesh as it was solved, raised and refined where the case says so

    @functools.cached_property
    def _mesh(self) -> dict[str, Any]:
        return self._solved.mesh()

    @property
    def element(self) -> str:
        """Name of the element type."""
        return self._mesh["element"]

    @property
    def points(self) -> Array:
        """(nodes, dim)"""
        return self._mesh["points"]

    @property
    def cells(self) -> Array:
        """(elements, nodes of an element), from 0, in Gmsh's order."""
        return self._mesh["cells"]

    @property
    def node_id(self) -> Array:
        """The mesh file's number of each node."""
        return self._mesh["node_id"]

    @property
    def element_id(self) -> Array:
        """The mesh file's number of each element."""
        return self._mesh["element_id"]

    # ---- fields

    @functools.cached_property
    def _nodal(self) -> dict[str, Array]:
        return self._solved.nodal_fields()

    @functools.cached_property
    def _elements(self) -> dict[str, Array]:
        return self._solved.element_fields()

    @property
    def u(self) -> Array:
        """Displacement, (nodes, dim)."""
        return self._nodal["u"]

    @property
    def nodal_stress(self) -> Array:
        """Recovered stress, (nodes, 6): xx yy zz xy yz zx."""
        return self._nodal["nodal_stress"]

    @property
    def nodal_von_mises(self) -> Array:
        """Of the recovered stress, (nodes,)."""
        return self._nodal["nodal_von_mises"]

    @property
    def error(self) -> Array:
        """Each element's part of the estimated error of the mesh, (elements,); squares add up to that of
        result["discretisation"]["energy"]."""
        return self._solved.error()

    @functools.cached_property
    def contact(self) -> dict[str, Array]:
        """By contact point: `node` and `entry` (indices from 0), `normal` towards the obstacle, `gap` that is open,
        `pressure`, tangential `traction` that the obstacle does to the body, `status` (0 open, 1 stick, 2 slip)."""
        return self._solved.contact_fields()

    @functools.cached_property
    def steps(self) -> tuple[Step, ...]:
        """The ends of the load steps that have converged, and the end of the run, which is the last one: the series that
        the program writes. Of a case with one load step, or whose `output.steps` is false, the end alone."""
        lines = self.result.get("load_steps", [])

        def factor(line: dict[str, Any]) -> float:
            return line["time"] if "time" in line else line["factor"]

        end = self.result["load_factor"]
        before = [Step(factor(lines[number - 1]), lines[number - 1], self._solved.step_displacement(index),
                       functools.partial(self._solved.element_fields, index),
                       functools.partial(self._solved.contact_fields, index))
                  for index, number in enumerate(self._solved.step_numbers()) if factor(lines[number - 1]) < end]
        last = lines[-1] if lines and factor(lines[-1]) == end else {}
        return (*before, Step(end, last, self.u, lambda: self._elements, lambda: self.contact))

    # ---- for people

    def summary(self) -> str:
        """Status, residual, sizes, forces and warnings in some lines."""
        result = self.result
        worst = max((abs(v) for k, v in self.certificate.items() if isinstance(v, float)), default=float("nan"))
        lines = [f"{self.status}: {self.message}",
                 f"{result['unknowns']} unknowns, {result['elements']} {self.element}, {result['outer_iterations']} "
                 f"outer steps, {result['cg_iterations']} CG, worst residual {worst:.1e}, "
                 f"{result['seconds']['total']:.2f} s",
                 f"contact force {self.contact_force}, friction {self.friction_force}, "
                 f"{result['active_nodes']} of {result['contact_nodes']} contact nodes touch",
                 f"largest von Mises stress {result['max_von_mises_nodal']:.6g}, {result['plastic_elements']} elements yield"]
        return "\n".join(lines + [f"warning: {text}" for text in self.warnings])

    def __repr__(self) -> str:
        return f"<kacanov.Solution: {self.status}, {self.result['unknowns']} unknowns>"

    def svg(self) -> str:
        """The program's picture: the deformed body coloured by von Mises stress."""
        return self._solved.svg()

    def _repr_svg_(self) -> str:
        return self.svg()

    def plot(self, field: str = "nodal_von_mises", *, scale: float | None = None, **options: Any) -> Any:
        """Draws the deformed body: see kacanov.plot.plot."""
        from .plot import plot
        return plot(self, field, scale=scale, **options)
