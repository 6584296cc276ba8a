#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The C interface from Python: ctypes on numpy arrays, nothing to compile.

usage: ctypes_numpy.py libkacanov.so
"""
import ctypes as ct
import sys

import numpy as np

Doubles = ct.POINTER(ct.c_double)


class Law(ct.Structure):  # kacanov_law
    _fields_ = [
        ("struct_size", ct.c_size_t), ("kind", ct.c_int32), ("squared", ct.c_int32),
        ("bulk", ct.c_double), ("shear", ct.c_double), ("x0", ct.c_double),
        ("gamma", ct.c_double), ("n", ct.c_double), ("q", ct.c_double),
        ("table_size", ct.c_size_t), ("table_x", Doubles), ("table_s", Doubles),
        ("mean_dilatation", ct.c_int32), ("reserved", ct.c_int32)]


class Description(ct.Structure):  # kacanov_description
    _fields_ = [
        ("struct_size", ct.c_size_t), ("element", ct.c_int32), ("threads", ct.c_int32),
        ("nodes", ct.c_size_t), ("coordinates", Doubles),
        ("node_stride", ct.c_size_t), ("component_stride", ct.c_size_t),
        ("elements", ct.c_size_t), ("connectivity", ct.POINTER(ct.c_int32)),
        ("element_stride", ct.c_size_t), ("index_base", ct.c_int32), ("borrow", ct.c_int32), ("single", ct.c_int32),
        ("laws", ct.c_size_t), ("law", ct.POINTER(Law)), ("law_of_element", ct.POINTER(ct.c_uint16)),
        ("instruction_set", ct.c_char_p), ("node_order", ct.c_char_p), ("turn_inverted", ct.c_int32),
        ("orphans", ct.c_int32)]


class CgResult(ct.Structure):  # kacanov_cg_result
    _fields_ = [("struct_size", ct.c_size_t), ("iterations", ct.c_int32), ("converged", ct.c_int32),
                ("first_residual", ct.c_double), ("residual", ct.c_double)]


class Operator:
    """Vectors are float64 arrays of nodes * 3 entries, interleaved."""

    def __init__(self, library, points, tetrahedra, young, poisson, threads=1):
        self.library, self.handle = library, ct.c_void_p()
        # A caller's own layout: one array per component, as is common in numpy.
        columns = np.ascontiguousarray(points.T, dtype=np.float64)
        tetrahedra = np.ascontiguousarray(tetrahedra, dtype=np.int32)
        law = Law(struct_size=ct.sizeof(Law))
        if library.kacanov_elastic_law(ct.c_double(young), ct.c_double(poisson), ct.byref(law)):
            raise ValueError("Young's modulus or Poisson's ratio is out of range")
        body = Description(
            struct_size=ct.sizeof(Description), element=1, threads=threads,
            nodes=len(points), coordinates=columns.ctypes.data_as(Doubles),
            node_stride=1, component_stride=len(points), elements=len(tetrahedra),
            connectivity=tetrahedra.ctypes.data_as(ct.POINTER(ct.c_int32)), laws=1, law=ct.pointer(law))
        message = ct.create_string_buffer(256)
        if library.kacanov_create(ct.byref(body), ct.byref(self.handle), message, ct.c_size_t(len(message))):
            raise ValueError(message.value.decode())
        self.size = points.size

    def __del__(self):
        self.library.kacanov_destroy(self.handle)

    def call(self, name, *arrays):
        """Calls kacanov_NAME(handle, n, array...); raises ValueError with its message."""
        for a in arrays:
            if a.dtype != np.float64 or not a.flags.c_contiguous:
                raise TypeError("expected contiguous float64 arrays")
        pointers = [a.ctypes.data_as(Doubles) for a in arrays]
        if getattr(self.library, "kacanov_" + name)(self.handle, ct.c_size_t(arrays[0].size), *pointers):
            raise ValueError(self.library.kacanov_message(self.handle).decode())

    def apply(self, x):
        y = np.empty_like(x)
        self.call("apply", x, y)
        return y

    def energy(self, u):
        value = np.zeros(1)
        self.call("energy", u, value)
        return value[0]

    def constrain(self, unknowns):
        unknowns = np.ascontiguousarray(unknowns, dtype=np.int32)
        if self.library.kacanov_constrain(self.handle, ct.c_size_t(len(unknowns)),
                                          unknowns.ctypes.data_as(ct.POINTER(ct.c_int32))):
            raise ValueError(self.library.kacanov_message(self.handle).decode())


class Multigrid:
    """z = M r for the present operator: `apply` fits scipy's LinearOperator and PETSc's PCSHELL."""

    def __init__(self, op):
        self.op, self.library, self.handle = op, op.library, ct.c_void_p()
        if self.library.kacanov_multigrid_create(op.handle, None, ct.byref(self.handle)):
            raise ValueError(self.library.kacanov_message(op.handle).decode())

    def __del__(self):
        self.library.kacanov_multigrid_destroy(self.handle)

    def apply(self, r):
        r = np.ascontiguousarray(r, dtype=np.float64)
        z = np.empty_like(r)
        if self.library.kacanov_multigrid_apply(self.handle, ct.c_size_t(r.size), r.ctypes.data_as(Doubles),
                                                z.ctypes.data_as(Doubles)):
            raise ValueError(self.library.kacanov_multigrid_message(self.handle).decode())
        return z

    def solve(self, b):
        """Solves with the library's conjugate gradients; returns x and the number of iterations."""
        x, result = np.zeros_like(b), CgResult(struct_size=ct.sizeof(CgResult))
        if self.library.kacanov_cg(self.op.handle, self.handle, None, ct.c_size_t(b.size), b.ctypes.data_as(Doubles),
                                   x.ctypes.data_as(Doubles), ct.byref(result)):
            raise ValueError(self.library.kacanov_message(self.op.handle).decode())
        return x, result.iterations


def load(path):
    library = ct.CDLL(path)
    library.kacanov_message.restype = ct.c_char_p
    library.kacanov_message.argtypes = [ct.c_void_p]
    library.kacanov_destroy.restype = None
    library.kacanov_destroy.argtypes = [ct.c_void_p]
    library.kacanov_multigrid_message.restype = ct.c_char_p
    library.kacanov_multigrid_message.argtypes = [ct.c_void_p]
    library.kacanov_multigrid_destroy.restype = None
    library.kacanov_multigrid_destroy.argtypes = [ct.c_void_p]
    return library


def unit_cube(n):
    """Returns the points and tetrahedra of n^3 cubes, six tetrahedra per cube."""
    side = np.linspace(0.0, 1.0, n + 1)
    z, y, x = np.meshgrid(side, side, side, indexing="ij")
    points = np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1)
    index = np.arange((n + 1) ** 3).reshape(n + 1, n + 1, n + 1)
    corner = [index[c >> 2:n + (c >> 2), c >> 1 & 1:n + (c >> 1 & 1), c & 1:n + (c & 1)].ravel() for c in range(8)]
    round_diagonal = [1, 3, 2, 6, 4, 5, 1]
    tetrahedra = [np.stack([corner[0], corner[a], corner[b], corner[7]], axis=1)
                  for a, b in zip(round_diagonal, round_diagonal[1:])]
    return points, np.concatenate(tetrahedra)


def main():
    library = load(sys.argv[1])
    points, tetrahedra = unit_cube(8)
    young, poisson = 2.0, 0.3
    op = Operator(library, points, tetrahedra, young, poisson, threads=2)

    # Uniform strain: the energy is known, inner nodes are in equilibrium.
    strain = np.array([[0.010, 0.002, 0.0], [0.002, -0.004, 0.001], [0.0, 0.001, 0.003]])
    u = (points @ strain).ravel()
    lame = young * poisson / ((1 + poisson) * (1 - 2 * poisson))
    exact = 0.5 * lame * np.trace(strain) ** 2 + young / (2 * (1 + poisson)) * np.sum(strain**2)
    assert abs(op.energy(u) - exact) < 1e-12 * exact
    force = op.apply(u).reshape(-1, 3)
    inside = np.all((points > 0) & (points < 1), axis=1)
    assert np.abs(force[inside]).max() < 1e-14 * np.abs(force).max() * 100
    assert abs(u @ force.ravel() - 2 * exact) < 1e-12 * exact

    # Symmetry, and zero response to rigid motions.
    rng = np.random.default_rng(0)
    a, b = rng.standard_normal((2, op.size))
    assert abs(a @ op.apply(b) - b @ op.apply(a)) < 1e-10 * abs(a @ op.apply(a))
    rotation = np.cross([0.3, -0.2, 0.5], points).ravel()
    assert np.abs(op.apply(rotation)).max() < 1e-13

    # Fixed at the bottom, pulled at the top: with multigrid, in the library and, if installed, in scipy.
    op.constrain(np.flatnonzero(np.repeat(points[:, 2] == 0, 3)))
    pull = np.zeros_like(points)
    pull[points[:, 2] == 1, 2] = 1e-4
    multigrid = Multigrid(op)
    x, iterations = multigrid.solve(pull.ravel())
    assert np.linalg.norm(pull.ravel() - op.apply(x)) < 1e-7 * np.linalg.norm(pull)
    print(f"multigrid: {iterations} iterations")
    try:
        from scipy.sparse.linalg import LinearOperator, cg
    except ImportError:
        print("without scipy")
    else:
        shape = (op.size, op.size)
        by_scipy, code = cg(LinearOperator(shape, matvec=op.apply), pull.ravel(), atol=1e-10 * np.linalg.norm(pull),
                            M=LinearOperator(shape, matvec=multigrid.apply))
        assert code == 0 and np.abs(by_scipy - x).max() < 1e-4 * np.abs(x).max()

    # Errors are exceptions with the library's message.
    try:
        op.energy(np.full(op.size, np.nan))
    except ValueError as error:
        print("as it should:", error)
    else:
        raise AssertionError("a displacement that is not a number was accepted")
    print(f"{op.size} unknowns, energy {op.energy(u):.12e}, exact {exact:.12e}")


if __name__ == "__main__":
    main()
