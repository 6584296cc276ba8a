# SPDX-License-Identifier: BSD-3-Clause
"""A case: the case file as a dict, methods that build it, and the solver in this process."""
from __future__ import annotations

import copy
import json
import os
import sys
from collections.abc import Callable, Mapping, Sequence
from typing import Any, TextIO

from . import _kacanov
from .errors import InputError, Interrupted, RankError
from .mesh import BoxMesh, Mesh, MeshFile
from .solution import Solution
from .words import Law, Obstacle, Word, plain

On = str | Word | Mapping[str, Any]
Vector = Sequence[float]


class Case:
    """The content of a case file. `document` is the case file as a dict and may be edited directly.

    Keys and error messages are those of the case file (docs/user-guide/case-file.md). `plane`: "strain", "stress" or
    "axisymmetric", for 2D meshes. Relative file names start at `folder`. A mesh given as arrays is in `arrays`; the
    document then names the file that `to_json` writes it to.
    """

    def __init__(self, mesh: BoxMesh | MeshFile | Mesh | Mapping[str, Any] | None = None, *, order: int | None = None,
                 refine: int | None = None, plane: str | None = None, thickness: float | None = None,
                 name: str = "case", folder: str | os.PathLike[str] = ".") -> None:
        self.name = name
        self.folder = os.path.abspath(folder)
        self.document: dict[str, Any] = {}
        self.arrays: Mesh | None = None
        self.solution: Solution | None = None
        if mesh is not None:
            self._take_mesh(mesh)
            more = {"order": order, "refine": refine}
            self.document["mesh"].update({key: value for key, value in more.items() if value is not None})
        for key, value in {"plane": plane, "thickness": thickness}.items():
            if value is not None:
                self.document[key] = value

    def _take_mesh(self, mesh: BoxMesh | MeshFile | Mesh | Mapping[str, Any]) -> None:
        if isinstance(mesh, Mesh):
            self.arrays = mesh
            self.document["mesh"] = {"file": f"{self.name}.msh"}
        elif isinstance(mesh, Word | Mapping):
            self.document["mesh"] = plain(mesh, "mesh")
        else:
            raise TypeError("mesh: expected kacanov.box, read or Mesh, or a dict as in a case file, "
                            f"got {type(mesh).__name__}")

    # ---- reading and writing case files

    @classmethod
    def from_json(cls, path: str | os.PathLike[str]) -> Case:
        """Returns the case described by a case file."""
        try:
            with open(path, encoding="utf-8") as file:
                text = file.read()
        except (OSError, UnicodeDecodeError) as error:
            raise InputError(f"{os.fspath(path)}: cannot be read: {error}") from error
        folder, name = os.path.split(os.path.abspath(path))
        case = cls(name=os.path.splitext(name)[0], folder=folder)
        # Not json.loads: rejects repeated keys and the like, as the program does.
        case.document = json.loads(_kacanov.normal(text, os.fspath(path)))
        return case

    @classmethod
    def from_dict(cls, document: Mapping[str, Any], *, name: str = "case",
                  folder: str | os.PathLike[str] = ".") -> Case:
        """Returns the case of a dict with the keys of a case file."""
        case = cls(name=name, folder=folder)
        case.document = plain(document)
        return case

    def to_json(self, path: str | os.PathLike[str] | None = None) -> str:
        """Returns the case file as text, and writes it to `path` if given, with a mesh of arrays beside it as a .msh.

        Relative file names become absolute if the file goes to another folder than the case's.
        """
        case = self.copy()
        if path is not None:
            folder, name = os.path.split(os.path.abspath(path))
            if folder != self.folder:
                case._make_absolute()
            if self.arrays is not None:
                mesh = os.path.splitext(name)[0] + ".msh"
                case.document["mesh"]["file"] = mesh
                with open(os.path.join(folder, mesh), "wb") as binary:
                    binary.write(self.arrays.msh())
        text = json.dumps(plain(case.document), indent=2) + "\n"
        if path is not None:
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
        return text

    def _make_absolute(self) -> None:
        holders = [self.document.get("mesh")] + [
            shape for entry in self.document.get("contact", []) if isinstance(entry, dict)
            for shape in (entry.get("obstacle") or {}).values()]
        for holder in holders:
            if isinstance(holder, dict) and isinstance(holder.get("file"), str):
                holder["file"] = os.path.join(self.folder, holder["file"])

    def copy(self) -> Case:
        """Returns a copy with its own document."""
        other = copy.copy(self)
        other.document = copy.deepcopy(self.document)
        return other

    def __repr__(self) -> str:
        return f"<kacanov.Case {self.name}: {', '.join(self.document)}>"

    # ---- building a case

    def _add(self, list_: str, **entry: Any) -> Case:
        entries = self.document.setdefault(list_, [])
        given = {key: value for key, value in entry.items() if value is not None}
        entries.append(plain(given, f"{list_}[{len(entries)}]"))
        return self

    def material(self, young: float, poisson: float, law: Law | Mapping[str, Any] | None = None, *, on: On = "all",
                 plastic: Sequence[Vector] | None = None, yield_stress: float | None = None,
                 tangent_modulus: float | None = None, bbar: bool | None = None,
                 formulation: str | None = None, expansion: float | None = None) -> Case:
        """Adds one material and returns the case, as all methods that add something do."""
        return self._add("material", on=on, young=young, poisson=poisson, law=law, plastic=plastic,
                         yield_stress=yield_stress, tangent_modulus=tangent_modulus, bbar=bbar,
                         formulation=formulation, expansion=expansion)

    def fix(self, on: On, displacement: Sequence[float | None] = (0.0, 0.0, 0.0), *,
            frame: Sequence[Vector] | None = None, name: str | None = None) -> Case:
        """Prescribes displacements, along the axes or those of `frame`; None leaves a component free."""
        return self._add("boundary", on=on, displacement=displacement, frame=frame, name=name)

    def symmetry(self, on: On, normal: float = 0.0, *, name: str | None = None) -> Case:
        """Prescribes the displacement along the outward normal of flat facets: 0 is a plane of symmetry."""
        return self._add("boundary", on=on, normal=normal, name=name)

    def traction(self, traction: Vector, on: On, *, name: str | None = None) -> Case:
        """Adds a force per area."""
        return self._add("boundary", on=on, traction=traction, name=name)

    def total_force(self, force: Vector, on: On, *, name: str | None = None) -> Case:
        """Adds a total force, distributed evenly over the facets."""
        return self._add("boundary", on=on, total_force=force, name=name)

    def pressure(self, pressure: float, on: On, *, name: str | None = None) -> Case:
        """Adds a pressure, which acts against the outward normal."""
        return self._add("boundary", on=on, pressure=pressure, name=name)

    def body_force(self, force: Vector, on: On = "all", *, name: str | None = None) -> Case:
        """Adds a force per volume."""
        return self._add("boundary", on=on, body_force=force, name=name)

    def gravity(self, density: float, acceleration: Vector, on: On = "all", *, name: str | None = None) -> Case:
        """Adds gravity, given by mass density and acceleration."""
        return self._add("boundary", on=on, density=density, acceleration=acceleration, name=name)

    def spring(self, stiffness: float | Vector, on: On, *, name: str | None = None) -> Case:
        """Adds an elastic foundation under facets: stiffness per area, along the normal or one per component."""
        return self._add("boundary", on=on, spring=stiffness, name=name)

    def node_spring(self, stiffness: Vector, on: On, *, name: str | None = None) -> Case:
        """Adds a spring at each node, with one stiffness per component."""
        return self._add("boundary", on=on, node_spring=stiffness, name=name)

    def node_force(self, force: Vector, on: On, *, name: str | None = None) -> Case:
        """Adds a force on each node of a selection."""
        return self._add("boundary", on=on, node_force=force, name=name)

    def temperature(self, difference: float | Mapping[str, Any], on: On = "all", *, name: str | None = None) -> Case:
        """Sets the temperature rise of elements over the stress-free state: a number, {"gradient", "value", "point"} of
        a linear field, or {"file", "otherwise"} of a CSV file of nodal values."""
        return self._add("boundary", on=on, temperature=difference, name=name)

    def contact(self, on: On, obstacle: Obstacle | Mapping[str, Any], *, coulomb: float | None = None,
                tresca: float | None = None, reference: str | None = None, name: str | None = None,
                motion: Mapping[str, Any] | None = None, relinearise: bool | None = None,
                force_controlled: Mapping[str, Any] | None = None) -> Case:
        """Adds contact with an obstacle, frictionless unless `coulomb` or `tresca` is given."""
        words = {"coulomb": coulomb, "tresca": tresca, "reference": reference}
        friction = {key: value for key, value in words.items() if value is not None}
        return self._add("contact", on=on, obstacle=obstacle, friction=friction or None, name=name, motion=motion,
                         relinearise=relinearise, force_controlled=force_controlled)

    def step(self, time: float, factors: Mapping[str, float]) -> Case:
        """Adds a load step of load curves."""
        return self._add("steps", time=time, factors=factors)

    def probe(self, *points: Vector) -> Case:
        """Adds points whose displacement is reported."""
        self.document.setdefault("probe", []).extend(plain(points, "probe"))
        return self

    def solver(self, **options: Any) -> Case:
        """Sets solver options: tolerance=1e-8, load_steps=4."""
        self.document.setdefault("solver", {}).update(plain(options, "solver"))
        return self

    def set(self, path: str, value: Any) -> Case:
        """Sets the value at a path of the document: set("contact[0].friction.coulomb", 0.2)."""
        assignment = f"{path}={json.dumps(plain(value, path))}"
        text = json.dumps(plain(self.document))
        self.document = json.loads(_kacanov.with_override(text, self.name, assignment))
        return self

    # ---- solving

    def _text(self) -> tuple[str, str, bytes | None]:
        mesh = None if self.arrays is None else self.arrays.msh()
        return json.dumps(plain(self.document)), os.path.join(self.folder, self.name + ".json"), mesh

    def check(self) -> dict[str, Any]:
        """Validates the case on its mesh without solving; returns sizes, warnings, and the estimated memory."""
        return _kacanov.check(*self._text())

    def solve(self, *, progress: bool | Callable[[dict[str, Any]], object] = False, start: Solution | None = None,
              stop: Callable[[], bool] | None = None, threads: int | None = None, comm: Any = None,
              memory_check: bool = True) -> Solution:
        """Solves the case in this process. Not converging is no error: check the solution's `status`.

        progress: True prints one line per step; a function is called with a dict for each step.
        start: initial guess, a solution of the same body on any mesh; it saves work and changes nothing else.
        stop: called up to fifty times per second; the solve ends as `interrupted` when it returns True.
        threads: None: one for small bodies, else one per core.
        comm: an mpi4py communicator: all its ranks solve together. The case is that of the first rank, which also gets
        progress and fields. If one rank raises, all do: the others RankError, or Interrupted after Ctrl-C.
        memory_check: refuse a case that does not fit into memory.
        Ctrl-C ends the solve with the state after its last complete outer step, in Interrupted.solution and in
        `self.solution`. An exception in a callback ends it likewise and is raised.
        """
        given: dict[str, Any] = {
            "progress": ProgressTable() if progress is True else progress or None, "stop": stop,
            "comm": _address_of(comm), "threads": threads, "memory_check": memory_check, "failed": None}
        try:
            given["text"], given["path"], given["mesh"] = self._text()
            given["start"] = None if start is None else start._solved
        except BaseException as error:
            if comm is None:
                raise
            given["failed"] = error  # report it to the other ranks
        solved, raised, elsewhere = _kacanov.solve(given)
        if solved is not None:
            self.solution = Solution(solved)
        if isinstance(raised, KeyboardInterrupt) or (raised is None and elsewhere is not None and elsewhere[1]):
            raise Interrupted(self.solution if solved is not None else None) from raised
        if raised is not None:
            raise raised
        if elsewhere is not None:
            raise RankError(f"rank {elsewhere[0]}: {elsewhere[2]}", elsewhere[0])
        assert self.solution is not None
        return self.solution


def _address_of(comm: Any) -> int:
    """Returns the address of mpi4py's communicator handle; 0 without a communicator."""
    if comm is None:
        return 0
    from mpi4py import MPI  # importing it determines which MPI this process uses
    if comm == MPI.COMM_NULL:
        raise InputError("comm: MPI.COMM_NULL")
    return MPI._addressof(comm)


class ProgressTable:
    """Prints one line per outer step, with a heading before the first."""

    def __init__(self, file: TextIO | None = None) -> None:
        self._headed = False
        self._file = file

    def __call__(self, step: Mapping[str, Any]) -> None:
        file = self._file or sys.stdout
        if not self._headed:
            print(f"{'step':>5}  {'phase':<12}{'contact':>8}{'CG':>8}{'residual':>12}{'seconds':>9}", file=file)
            self._headed = True
        print(f"{step['outer']:>5}  {step['phase']:<12}{step['contact_iterations']:>8}{step['cg_iterations']:>8}"
              f"{step['worst_residual']:>12.2e}{step['seconds']:>9.2f}", file=file, flush=True)
