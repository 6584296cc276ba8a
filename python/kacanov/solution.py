# SPDX-License-Identifier: BSD-3-Clause
"""The solution of a case: the numbers of result.json, and fields as arrays."""
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
    """Element means, computed when the first one is accessed."""

    @functools.cached_property
    def _elements(self) -> dict[str, Array]:
        raise NotImplementedError

    @property
    def stress(self) -> Array:
        """Element means of the stress, (elements, 6): xx yy zz xy yz zx."""
        return self._elements["stress"]

    @property
    def von_mises(self) -> Array:
        """Element means of the von Mises stress, (elements,)."""
        return self._elements["von_mises"]

    @property
    def dev_strain(self) -> Array:
        """Element means of the norm of the strain deviator."""
        return self._elements["dev_strain"]

    @property
    def g(self) -> Array:
        """Element means of the secant shear modulus."""
        return self._elements["g"]

    @property
    def plastic(self) -> Array:
        """True for elements with any quadrature point beyond yield."""
        return self._elements["plastic"]


class Step(ElementMeans):
    """The end of a load step: its entry in result["load_steps"], and fields in the shapes of Solution. Read-only.

    factor: load factor; the time if the case has `steps`.
    result: its numbers, as in result["load_steps"]; empty if the run ended before the next step was complete.
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
        """Contact fields per contact point, as Solution.contact."""
        return self._make_contact()

    def __repr__(self) -> str:
        return f"<kacanov.Step: {self.factor:g}>"


class Solution(ElementMeans):
    """Numbers and fields of a solve. Arrays are read-only, in the numbering of the mesh, and created on access.

    `result` has all numbers under the names of result.json (docs/user-guide/results.md).
    """

    def __init__(self, solved: _kacanov.Solved) -> None:
        self._solved = solved

    @functools.cached_property
    def result(self) -> dict[str, Any]:
        """Content of result.json."""
        return json.loads(self._solved.json)

    @property
    def status(self) -> str:
        """converged, limited_by_rounding, not_converged or interrupted."""
        return self.result["status"]

    @property
    def converged(self) -> bool:
        """True if all KKT residuals are within the tolerance."""
        return self.status == "converged"

    @property
    def message(self) -> str:
        """Reason why the run ended, in one sentence."""
        return self.result["message"]

    @property
    def warnings(self) -> list[str]:
        """Warnings about possible errors in the case or the results."""
        return self.result["warnings"]

    @property
    def certificate(self) -> dict[str, Any]:
        """The relative KKT residuals, and under `rounding` the round-off of each."""
        return self.result["certificate"]

    @property
    def contact_force(self) -> Array:
        """Sum of the normal forces of the obstacles on the body."""
        return np.array(self.result["contact_force"], dtype=float)

    @property
    def friction_force(self) -> Array:
        """Sum of the friction forces of the obstacles on the body."""
        return np.array(self.result["friction_force"], dtype=float)

    @property
    def probe(self) -> Array:
        """Displacements at the probe points, (points, dim)."""
        return np.array(self.result["probe"], dtype=float)

    # ---- mesh of the solve, with the order and refinement of the case

    @functools.cached_property
    def _mesh(self) -> dict[str, Any]:
        return self._solved.mesh()

    @property
    def element(self) -> str:
        """Name of the element type."""
        return self._mesh["element"]

    @property
    def points(self) -> Array:
        """Node coordinates, (nodes, dim)."""
        return self._mesh["points"]

    @property
    def cells(self) -> Array:
        """(elements, nodes per element), from 0, in Gmsh's order."""
        return self._mesh["cells"]

    @property
    def node_id(self) -> Array:
        """Number of each node in the mesh file."""
        return self._mesh["node_id"]

    @property
    def element_id(self) -> Array:
        """Number of each element in the mesh file."""
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
        """Von Mises stress of the recovered stress, (nodes,)."""
        return self._nodal["nodal_von_mises"]

    @property
    def error(self) -> Array:
        """Contribution of each element to the estimated mesh error, (elements,); the squares sum to the square of
        result["discretisation"]["energy"]."""
        return self._solved.error()

    @functools.cached_property
    def contact(self) -> dict[str, Array]:
        """Contact fields per contact point: `node` and `entry` (indices from 0), `normal` towards the obstacle, `gap`,
        `pressure`, tangential `traction` on the body, `status` (0 open, 1 stick, 2 slip)."""
        return self._solved.contact_fields()

    @functools.cached_property
    def steps(self) -> tuple[Step, ...]:
        """The ends of the converged load steps, and last the end of the run: the series that the program writes. Only
        the end if the case has one load step, or if its `output.steps` is false."""
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

    # ---- output

    def summary(self) -> str:
        """Status, residual, sizes, forces and warnings in a few lines."""
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
