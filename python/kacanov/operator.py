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
    """Result of conjugate gradients; residuals are 2-norms over the unconstrained unknowns."""

    iterations: int
    converged: bool
    first_residual: float
    residual: float


class Symmetric:
    """A symmetric linear operator with scipy's interface: scipy.sparse.linalg.cg(op, b, M=M) works directly."""

    dtype = np.dtype(np.float64)
    shape: tuple[int, int]

    def matvec(self, x: Array, out: Array | None = None) -> Array:
        """Returns the product, in `out` if given."""
        raise NotImplementedError

    def rmatvec(self, x: Array) -> Array:
        """Same as matvec: the operator is symmetric."""
        return self.matvec(x)

    def matmat(self, x: Array) -> Array:
        """Returns the products with the columns of x, one by one."""
        return np.stack([self.matvec(np.ascontiguousarray(column)) for column in x.T], axis=1)

    def __matmul__(self, x: Array) -> Array:
        n = self.shape[0]
        if isinstance(x, np.ndarray) and x.ndim == 2 and x.shape[0] == n and x.shape[1] != 1:
            return self.matmat(x)
        return self.matvec(x)

    def __call__(self, x: Array) -> Array:
        return self @ x

    def petsc_mat(self, comm: Any = None) -> Any:
        """Returns a PETSc.Mat of type python that applies this operator; needs petsc4py. On one process."""
        from petsc4py import PETSc
        _end_petsc_before_python()
        mat = PETSc.Mat().createPython((self.shape, self.shape), _PetscMat(self), comm=comm or PETSc.COMM_SELF)
        mat.setOption(PETSc.Mat.Option.SYMMETRIC, True)
        mat.setUp()
        return mat


class Operator(Symmetric):
    """y = B(g) x, the matrix-free operator of a body, with g frozen at a displacement by `update`.

    points: float64 (nodes, dim); cells: int32 (elements, nodes per element), from 0, in the node order `order`
    ("gmsh", the same as "kacanov", "vtk", "basix", "dealii"). law: a Material, a list of them with `law_of_element`
    (uint16 per element), or a Law with `young` and `poisson`; default: linear. A law may be a function: see OwnLaw.
    plane: "strain", "stress" or "axisymmetric", for 2D meshes.
    Vectors are float64 and C-contiguous, of shape (n,) or (nodes, dim), with n = nodes × dim; nothing is copied.
    Every call releases the GIL; only one thread at a time may use an operator.
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
        """Current properties: unknowns, threads, bytes, applications, instruction_set and others."""
        return self._op.information()

    # ---- products

    def matvec(self, x: Array, out: Array | None = None) -> Array:
        """Returns B(g) x. float32 vectors need `single`."""
        if self._single and isinstance(x, np.ndarray) and x.dtype == np.float32:
            return self._op.apply_float(x, out)
        return self._op.apply(x, out)

    def matmat(self, x: Array) -> Array:
        """Returns B(g) times the columns of x, all at once; without a copy if x is in Fortran order."""
        return self._op.apply_many(np.ascontiguousarray(x.T)).T

    def tangent(self, u: Array) -> Tangent:
        """Returns the consistent tangent at u, and freezes g there. An operator has one tangent: the next call of this
        method makes the earlier object stale, and applying that raises an error."""
        self._op.update_tangent(u)
        self._tangents += 1
        return Tangent(self, self._tangents)

    # ---- state

    def update(self, u: Array) -> None:
        """Freezes g at the displacement u."""
        self._op.update(u)

    @property
    def secant(self) -> Array:
        """The frozen g, (elements, points per element); can be set."""
        return self._op.secant()

    @secant.setter
    def secant(self, g: Array) -> None:
        self._op.set_secant(g)

    def constrain(self, unknowns: npt.ArrayLike) -> None:
        """Replaces rows and columns of these unknowns (node · dim + component) by those of the identity, except in
        residual, energy and stress. Earlier constraints are dropped. Also accepts a mask of n entries."""
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
        """Adds a (dim, dim) block to the diagonal block of each of these nodes (int32), such as penalties."""
        self._op.set_blocks(nodes, blocks)

    # ---- further data

    def diagonal(self) -> Array:
        """Diagonal of B(g), (n,)."""
        return self._op.diagonal()

    def blocks(self) -> Array:
        """Diagonal blocks of B(g), (nodes, dim, dim)."""
        return self._op.blocks()

    def residual(self, u: Array, out: Array | None = None) -> Array:
        """Internal force of the nonlinear law at u."""
        return self._op.residual(u, out)

    def energy(self, u: Array) -> float:
        """Stored energy of the nonlinear law at u."""
        return self._op.energy(u)

    def stress(self, u: Array) -> dict[str, Array]:
        """Element means at u: stress (elements, 6), von_mises, dev_strain, secant, plastic."""
        return self._op.stress(u)

    def matrix(self, u: Array | None = None) -> Any:
        """Returns B(g), or the tangent at u, as a scipy.sparse.csr_array; costs a few hundred applications."""
        from scipy.sparse import csr_array
        return csr_array(self._op.matrix(u), shape=self.shape)

    def locality_order(self) -> tuple[Array, Array]:
        """Returns the orders of nodes and elements with the best memory locality for the operator."""
        return self._op.locality_order()

    # ---- solving

    def multigrid(self, aggregate: float = 0) -> Multigrid:
        """Returns a preconditioner for B(g) with its constraints. `aggregate`: nodes per aggregate, 0: automatic."""
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
        """Returns a PETSc.PC of the multigrid: op.multigrid().petsc_pc()."""
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
        """Returns B_T x."""
        return self._raw().apply_tangent(x, out)

    def diagonal(self) -> Array:
        """Diagonal of B_T, (n,)."""
        return self._raw().diagonal_tangent()

    def blocks(self) -> Array:
        """Diagonal blocks of B_T, (nodes, dim, dim)."""
        return self._raw().blocks_tangent()

    def cg(self, b: Array, x0: Array | None = None, *, M: Multigrid | None = None, rtol: float = 1e-8,  # noqa: N803
           atol: float = 0.0, maxiter: int = 2000) -> tuple[Array, CgResult]:
        """Solves B_T x = b, like Operator.cg."""
        self._raw()
        return self.operator._cg(b, x0, M, {"rtol": rtol, "atol": atol, "maxiter": maxiter, "tangent": True})


class Multigrid(Symmetric):
    """z = M r, the solver's multigrid with rigid-body coarse spaces; positive definite, so it works with any CG."""

    def __init__(self, operator: Operator, aggregate: float = 0) -> None:
        self.operator, self.shape = operator, operator.shape
        self._multigrid = _kacanov.Multigrid(operator._op, aggregate)

    def matvec(self, x: Array, out: Array | None = None) -> Array:
        """Returns M x."""
        return self._multigrid.apply(x, out)

    def update(self) -> None:
        """Updates the multigrid after changes of g, constraints or blocks of the operator; keeps the aggregates."""
        self._multigrid.update()

    @property
    def levels(self) -> int:
        """Number of levels, including the finest."""
        return self._multigrid.information()[0]

    @property
    def bytes(self) -> int:
        """Memory in bytes, without the operator."""
        return self._multigrid.information()[1]

    def petsc_pc(self, comm: Any = None) -> Any:
        """Returns a PETSc.PC of type python that applies it; needs petsc4py. On one process."""
        from petsc4py import PETSc
        pc = PETSc.PC().createPython(_PetscPc(self), comm=comm or PETSc.COMM_SELF)
        pc.setOperators(self.operator.petsc_mat(comm))
        pc.setUp()
        return pc


@functools.cache
def _end_petsc_before_python() -> None:
    """petsc4py 3.18 finalises PETSc after Python and crashes if python objects are left: finalise it earlier."""
    from petsc4py import PETSc
    if hasattr(PETSc, "_finalize"):
        atexit.register(PETSc._finalize)


class _PetscMat:
    """Context of a petsc4py Mat."""

    def __init__(self, operator: Symmetric) -> None:
        self.operator = operator

    def mult(self, _mat: Any, x: Any, y: Any) -> None:
        self.operator.matvec(x.getArray(readonly=True), y.getArray())

    multTranspose = mult  # noqa: N815, as petsc4py calls it

    def getDiagonal(self, _mat: Any, d: Any) -> None:  # noqa: N802
        d.setArray(self.operator.diagonal())  # type: ignore[attr-defined]


class _PetscPc:
    """Context of a petsc4py PC."""

    def __init__(self, multigrid: Multigrid) -> None:
        self.multigrid = multigrid

    def apply(self, _pc: Any, r: Any, z: Any) -> None:
        self.multigrid.matvec(r.getArray(readonly=True), z.getArray())

    applyTranspose = apply  # noqa: N815


def _materials(law: Any, young: float | None, poisson: float | None) -> tuple[list[Any], list[tuple[int, OwnLaw]]]:
    """Returns materials in case file syntax, and by index the user-defined laws, for which the syntax has no words."""
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
