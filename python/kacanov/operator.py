# SPDX-License-Identifier: BSD-3-Clause
"""The matrix-free operator, its tangent and its multigrid as linear operators on numpy arrays."""
from __future__ import annotations

import atexit
import functools
import json
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _kacanov
from .errors import InputError, StateError
from .words import Evaluate, Law, Linear, Material, OwnLaw, plain

Array = npt.NDArray[Any]


class CgResult(NamedTuple):
    """How conjugate gradients ended; residuals are 2-norms over the unknowns that are not constrained."""

    iterations: int
    converged: bool
    first_residual: float
    residual: float


class Symmetric:
    """What scipy takes for a linear operator: scipy.sparse.linalg.cg(op, b, M=M) works as it is."""

    dtype = np.dtype(np.float64)
    shape: tuple[int, int]

    def matvec(self, x: Array, out: Array | None = None) -> Array:
        """The product, into `out` where given."""
        raise NotImplementedError

    def rmatvec(self, x: Array) -> Array:
        """The same: it is symmetric."""
        return self.matvec(x)

    def matmat(self, x: Array) -> Array:
        """Of the columns of x, one by one."""
        return np.stack([self.matvec(np.ascontiguousarray(column)) for column in x.T], axis=1)

    def __matmul__(self, x: Array) -> Array:
        n = self.shape[0]
        if isinstance(x, np.ndarray) and x.ndim == 2 and x.shape[0] == n and x.shape[1] != 1:
            return self.matmat(x)
        return self.matvec(x)

    def __call__(self, x: Array) -> Array:
        return self @ x

    def petsc_mat(self, comm: Any = None) -> Any:
        """A PETSc.Mat of type python that applies this operator; needs petsc4py. On one process."""
        from petsc4py import PETSc
        _end_petsc_before_python()
        mat = PETSc.Mat().createPython((self.shape, self.shape), _PetscMat(self), comm=comm or PETSc.COMM_SELF)
        mat.setOption(PETSc.Mat.Option.SYMMETRIC, True)
        mat.setUp()
        return mat


class Operator(Symmetric):
    """y = B(g) x, the matrix-free operator of a body, with g frozen at a displacement by `update`.

    points: float64 (nodes, dim); cells: int32 (elements, nodes of an element), from 0, in the node order `order`
    ("gmsh", the same as "kacanov", "vtk", "basix", "dealii"). law: a Material, a list of them with `law_of_element`
    (uint16 an element), or a Law beside `young` and `poisson`; left out: linear. A law may be a function: see OwnLaw.
    plane: what a mesh in 2D is of, "strain", "stress" or "axisymmetric".
    Vectors are float64 and C-contiguous, of shape (n,) or (nodes, dim), with n = nodes × dim; nothing is copied.
    Python's lock is let go in every call; one thread at a time may use an operator.
    """

    def __init__(self, points: Array, cells: Array, element: str, *, order: str = "gmsh",
                 law: Material | Law | OwnLaw | Evaluate | Mapping[str, Any] | Sequence[Material | Mapping[str, Any]] |
                 None = None,
                 young: float | None = None, poisson: float | None = None, law_of_element: Array | None = None,
                 threads: int = 1, single: bool = False, turn_inverted: bool = False, orphans: str = "zero",
                 plane: str = "strain", instruction_set: str | None = None) -> None:
        materials, self._own_laws = _materials(law, young, poisson)
        self._op = _kacanov.Operator({
            "points": points, "cells": cells, "element": element, "order": order,
            "laws": json.dumps(materials), "own_laws": self._own_laws, "law_of_element": law_of_element,
            "threads": threads, "single": single, "turn_inverted": turn_inverted, "orphans": orphans, "plane": plane,
            "instruction_set": instruction_set})
        size = self._op.information()
        self.nodes, self.elements, self.dimension = size["nodes"], size["elements"], size["dimension"]
        self.shape = (size["unknowns"], size["unknowns"])
        self._single = single
        self._tangents = 0

    @property
    def info(self) -> dict[str, Any]:
        """unknowns, threads, bytes, applications, instruction_set and so on, as they are now."""
        return self._op.information()

    # ---- applied

    def matvec(self, x: Array, out: Array | None = None) -> Array:
        """B(g) x. float32 vectors need `single`."""
        if self._single and isinstance(x, np.ndarray) and x.dtype == np.float32:
            return self._op.apply_float(x, out)
        return self._op.apply(x, out)

    def matmat(self, x: Array) -> Array:
        """B(g) of the columns of x, all at once; no copy where x is in Fortran's order."""
        return self._op.apply_many(np.ascontiguousarray(x.T)).T

    def tangent(self, u: Array) -> Tangent:
        """The consistent tangent at u, which also freezes g there. It is the operator's only one: it is stale, and
        refuses to be applied, from the next call on."""
        self._op.update_tangent(u)
        self._tangents += 1
        return Tangent(self, self._tangents)

    # ---- the state

    def update(self, u: Array) -> None:
        """Freezes g at the displacement u."""
        self._op.update(u)

    @property
    def secant(self) -> Array:
        """The frozen g, (elements, points of an element); may be set."""
        return self._op.secant()

    @secant.setter
    def secant(self, g: Array) -> None:
        self._op.set_secant(g)

    def constrain(self, unknowns: npt.ArrayLike) -> None:
        """Makes rows and columns of these unknowns (node · dim + component) those of the identity, in everything but
        residual, energy and stress. Replaces those given before. A mask of n entries will do as well."""
        array = np.asarray(unknowns)
        if array.dtype == np.bool_:
            if array.size != self.shape[0]:
                raise InputError(f"unknowns: expected a mask of {self.shape[0]} entries, got {array.size}")
            array = np.flatnonzero(array)
        if array.size and array.dtype.kind not in "iu":
            raise TypeError(f"unknowns: expected whole numbers or a mask, got {array.dtype}")
        if array.size and (array.min() < 0 or array.max() >= self.shape[0]):
            raise InputError(f"unknowns: expected numbers from 0 to {self.shape[0] - 1}, "
                             f"got {array.min()} to {array.max()}")
        self._op.constrain(np.ascontiguousarray(array.ravel(), dtype=np.int32))

    def set_blocks(self, nodes: Array, blocks: Array) -> None:
        """Adds to the diagonal block of each of these nodes (int32) a (dim, dim) block: penalties."""
        self._op.set_blocks(nodes, blocks)

    # ---- what else there is to know

    def diagonal(self) -> Array:
        """Of B(g), (n,)."""
        return self._op.diagonal()

    def blocks(self) -> Array:
        """Diagonal blocks of B(g), (nodes, dim, dim)."""
        return self._op.blocks()

    def residual(self, u: Array, out: Array | None = None) -> Array:
        """Internal force of the true law at u."""
        return self._op.residual(u, out)

    def energy(self, u: Array) -> float:
        """Stored energy of the true law at u."""
        return self._op.energy(u)

    def stress(self, u: Array) -> dict[str, Array]:
        """Means over the elements at u: stress (elements, 6), von_mises, dev_strain, secant, plastic."""
        return self._op.stress(u)

    def matrix(self, u: Array | None = None) -> Any:
        """B(g), or the tangent at u, as a scipy.sparse.csr_array: costs some hundred applications."""
        from scipy.sparse import csr_array
        return csr_array(self._op.matrix(u), shape=self.shape)

    def locality_order(self) -> tuple[Array, Array]:
        """The orders of nodes and of elements that the operator likes best."""
        return self._op.locality_order()

    # ---- solved

    def multigrid(self, aggregate: float = 0) -> Multigrid:
        """A preconditioner: near the inverse of B(g) with its constraints. `aggregate`: nodes of an aggregate, 0: chosen."""
        return Multigrid(self, aggregate)

    def cg(self, b: Array, x0: Array | None = None, *, M: Multigrid | None = None, rtol: float = 1e-8,  # noqa: N803
           atol: float = 0.0, maxiter: int = 2000) -> tuple[Array, CgResult]:
        """Solves B(g) x = b by conjugate gradients, preconditioned by `M` or by the diagonal."""
        return self._cg(b, x0, M, {"rtol": rtol, "atol": atol, "maxiter": maxiter, "tangent": False})

    def _cg(self, b: Array, x0: Array | None, multigrid: Multigrid | None,
            options: dict[str, Any]) -> tuple[Array, CgResult]:
        if multigrid is not None and multigrid.operator is not self:
            raise InputError("M: expected a multigrid of this operator")
        x = np.zeros_like(b) if x0 is None else np.array(x0, order="C")
        return x, CgResult(*self._op.cg(None if multigrid is None else multigrid._multigrid, b, x, options))

    def petsc_pc(self, comm: Any = None) -> Any:
        """A PETSc.PC of the multigrid: op.multigrid().petsc_pc()."""
        return self.multigrid().petsc_pc(comm)


class Tangent(Symmetric):
    """B_T x, the consistent tangent of an operator at a displacement; see Operator.tangent."""

    def __init__(self, operator: Operator, number: int) -> None:
        self.operator, self._number, self.shape = operator, number, operator.shape

    def _raw(self) -> _kacanov.Operator:
        if self._number != self.operator._tangents:
            raise StateError("this tangent is stale: its operator has been asked for another one since")
        return self.operator._op

    def matvec(self, x: Array, out: Array | None = None) -> Array:
        """B_T x"""
        return self._raw().apply_tangent(x, out)

    def diagonal(self) -> Array:
        """(n,)"""
        return self._raw().diagonal_tangent()

    def blocks(self) -> Array:
        """Diagonal blocks, (nodes, dim, dim)."""
        return self._raw().blocks_tangent()

    def cg(self, b: Array, x0: Array | None = None, *, M: Multigrid | None = None, rtol: float = 1e-8,  # noqa: N803
           atol: float = 0.0, maxiter: int = 2000) -> tuple[Array, CgResult]:
        """Solves B_T x = b as Operator.cg."""
        self._raw()
        return self.operator._cg(b, x0, M, {"rtol": rtol, "atol": atol, "maxiter": maxiter, "tangent": True})


class Multigrid(Symmetric):
    """z = M r, the solver's multigrid over rigid-body modes; positive definite, so that any CG may have it."""

    def __init__(self, operator: Operator, aggregate: float = 0) -> None:
        self.operator, self.shape = operator, operator.shape
        self._multigrid = _kacanov.Multigrid(operator._op, aggregate)

    def matvec(self, x: Array, out: Array | None = None) -> Array:
        """M x"""
        return self._multigrid.apply(x, out)

    def update(self) -> None:
        """After g, constraints or blocks of the operator have changed; the aggregates are kept."""
        self._multigrid.update()

    @property
    def levels(self) -> int:
        """The body itself included."""
        return self._multigrid.information()[0]

    @property
    def bytes(self) -> int:
        """What it holds, the operator's not counted."""
        return self._multigrid.information()[1]

    def petsc_pc(self, comm: Any = None) -> Any:
        """A PETSc.PC of type python that applies it; needs petsc4py. On one process."""
        from petsc4py import PETSc
        pc = PETSc.PC().createPython(_PetscPc(self), comm=comm or PETSc.COMM_SELF)
        pc.setOperators(self.operator.petsc_mat(comm))
        pc.setUp()
        return pc


@functools.cache
def _end_petsc_before_python() -> None:
    """petsc4py 3.18 ends PETSc after Python, and then crashes where objects of type python are left: end it before."""
    from petsc4py import PETSc
    if hasattr(PETSc, "_finalize"):
        atexit.register(PETSc._finalize)


class _PetscMat:
    """A context of petsc4py's Mat."""

    def __init__(self, operator: Symmetric) -> None:
        self.operator = operator

    def mult(self, _mat: Any, x: Any, y: Any) -> None:
        self.operator.matvec(x.getArray(readonly=True), y.getArray())

    multTranspose = mult  # noqa: N815, as petsc4py calls it

    def getDiagonal(self, _mat: Any, d: Any) -> None:  # noqa: N802
        d.setArray(self.operator.diagonal())  # type: ignore[attr-defined]


class _PetscPc:
    """A context of petsc4py's PC."""

    def __init__(self, multigrid: Multigrid) -> None:
        self.multigrid = multigrid

    def apply(self, _pc: Any, r: Any, z: Any) -> None:
        self.multigrid.matvec(r.getArray(readonly=True), z.getArray())

    applyTranspose = apply  # noqa: N815


def _materials(law: Any, young: float | None, poisson: float | None) -> tuple[list[Any], list[tuple[int, OwnLaw]]]:
    """Materials in the words of the case file, which has none for laws of one's own: these, by index."""
    words, own = [], []
    for index, material in enumerate(_listed(law, young, poisson)):
        if isinstance(material, Material):
            material = material.json()
        said = material.get("law") if isinstance(material, Mapping) else None
        if callable(said):
            said = OwnLaw(said)
        if isinstance(said, OwnLaw):
            own.append((index, said))
            material = {**material, "law": Linear()}
        words.append(plain(material, f"law[{index}]"))
    return words, own


def _listed(law: Any, young: float | None, poisson: float | None) -> Sequence[Any]:
    if isinstance(law, Sequence):
        if young is not None or poisson is not None:
            raise InputError("young, poisson: expected within each material of a list")
        return law
    if isinstance(law, Material) or (isinstance(law, Mapping) and "young" in law):
        if young is not None or poisson is not None:
            raise InputError("young, poisson: expected within the material")
        return [law]
    if young is None or poisson is None:
        raise InputError("law: expected a Material, or young and poisson beside it")
    return [{"young": young, "poisson": poisson} | ({} if law is None else {"law": law})]
