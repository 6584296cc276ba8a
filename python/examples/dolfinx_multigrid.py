# SPDX-License-Identifier: BSD-3-Clause
"""A cantilever in DOLFINx: its space, its load and its conditions, our operator and multigrid in PETSc's CG.

usage: dolfinx_multigrid.py [--cells 8] [--degree 2] [--threads 2] [--with-matrix]

--with-matrix also assembles DOLFINx' own matrix and solves with PETSc's Jacobi and GAMG with rigid-body modes. Times
are processor seconds.
"""
import argparse
import gc
import json
import sys
import time

import dolfinx.fem.petsc
import kacanov as kc
import numpy as np
import ufl
from dolfinx import fem, mesh
from mpi4py import MPI
from petsc4py import PETSc

YOUNG, POISSON = 210e3, 0.3


def solve(matrix, preconditioner, b, name):
    """Solves by CG to 1e-8. preconditioner: a PC, or the name of one of PETSc's."""
    ksp = PETSc.KSP().create(MPI.COMM_SELF)
    start = time.process_time()
    ksp.setOperators(matrix)
    ksp.setType("cg")
    ksp.setNormType(PETSc.KSP.NormType.UNPRECONDITIONED)
    ksp.setTolerances(rtol=1e-8, max_it=20000)
    if isinstance(preconditioner, str):
        ksp.getPC().setType(preconditioner)
    else:
        ksp.setPC(preconditioner)
    ksp.setUp()
    ready = time.process_time()
    x = b.duplicate()
    ksp.solve(b, x)
    return x, {"name": name, "iterations": ksp.getIterationNumber(), "converged": ksp.getConvergedReason() > 0,
               "setup_seconds": ready - start, "solve_seconds": time.process_time() - ready}


def rigid_modes(space):
    """Returns the six rigid-body modes for GAMG, orthonormal."""
    x = space.tabulate_dof_coordinates()
    modes = np.zeros((6, len(x), 3))
    for k in range(3):
        modes[k, :, k] = 1.0
        modes[3 + k, :, (k + 1) % 3], modes[3 + k, :, (k + 2) % 3] = -x[:, (k + 2) % 3], x[:, (k + 1) % 3]
    q, _ = np.linalg.qr(modes.reshape(6, -1).T)
    return PETSc.NullSpace().create(vectors=[PETSc.Vec().createWithArray(np.ascontiguousarray(v)) for v in q.T])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cells", type=int, default=8, help="across a beam of 4 x 1 x 1")
    parser.add_argument("--degree", type=int, default=2, choices=(1, 2))
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--with-matrix", action="store_true")
    options = parser.parse_args()
    n = options.cells
    box = mesh.create_box(MPI.COMM_SELF, [np.zeros(3), np.array([4.0, 1, 1])], (4 * n, n, n), mesh.CellType.tetrahedron)
    space = fem.VectorFunctionSpace(box, ("Lagrange", options.degree))
    left = mesh.locate_entities_boundary(box, 2, lambda x: np.isclose(x[0], 0))
    nodes = fem.locate_dofs_topological(space, 2, left)
    v = ufl.TestFunction(space)
    b = fem.petsc.assemble_vector(fem.form(ufl.inner(fem.Constant(box, (0.0, 0.0, -1.0)), v) * ufl.dx))
    held = (3 * nodes[:, None] + np.arange(3)).ravel()
    b.array[held] = 0.0

    start = time.process_time()
    body = kc.from_dolfinx(space)
    op = kc.Operator(body.points, body.cells, body.element, young=YOUNG, poisson=POISSON, threads=options.threads)
    op.constrain(held)
    multigrid = op.multigrid()
    made = time.process_time() - start
    x, row = solve(op.petsc_mat(), multigrid.petsc_pc(), b, "operator, multigrid")
    row["setup_seconds"] += made
    rows = [row]
    if options.with_matrix:
        u = ufl.TrialFunction(space)
        mu, bulk = YOUNG / 2 / (1 + POISSON), YOUNG / 3 / (1 - 2 * POISSON)
        dev = lambda w: ufl.dev(ufl.sym(ufl.grad(w)))  # noqa: E731
        form = fem.form((bulk * ufl.div(u) * ufl.div(v) + 2 * mu * ufl.inner(dev(u), dev(v))) * ufl.dx)
        start = time.process_time()
        matrix = fem.petsc.assemble_matrix(form, [fem.dirichletbc(np.zeros(3), nodes, space)])
        matrix.assemble()
        matrix.setNearNullSpace(rigid_modes(space))
        assembled = time.process_time() - start
        for kind, name in (("jacobi", "matrix, Jacobi"), ("gamg", "matrix, GAMG")):
            theirs, row = solve(matrix, kind, b, name)
            row["setup_seconds"] += assembled
            row["difference"] = float(np.abs(theirs.array - x.array).max() / np.abs(theirs.array).max())
            rows.append(row)
    print(json.dumps({"unknowns": int(x.getSize()), "entries": rows}, indent=1))
    good = all(row["converged"] and row.get("difference", 0) < 1e-4 for row in rows)
    return 0 if good and np.abs(x.array).max() > 0 else 1


if __name__ == "__main__":
    code = main()
    gc.collect()  # DOLFINx meshes are reference cycles: free their MPI objects before MPI is finalised
    sys.exit(code)
