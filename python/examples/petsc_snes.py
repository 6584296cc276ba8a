# SPDX-License-Identifier: BSD-3-Clause
"""A beam far beyond yield by PETSc's SNES: our residual, our tangent as a shell matrix, our multigrid.

usage: petsc_snes.py [--cells 8] [--load 20] [--threads 2] [--with-matrix] [--displacement FILE]

Newton's method with a line search that makes the residual orthogonal to the step ("cp": minimises the energy without
its round-off), and inexact CG with the tolerances of Eisenstat and Walker. --with-matrix repeats the solve with an
assembled tangent matrix and PETSc's Jacobi and GAMG with rigid-body modes. Times are processor seconds.
--displacement writes the displacement, (nodes, 3), for numpy.load.
"""
import argparse
import json
import sys
import time

import kacanov as kc
import numpy as np
from petsc4py import PETSc

STEEL = kc.Material(young=210e3, poisson=0.3, law=kc.Logarithmic(yield_stress=250), bbar=True)


def beam(n):
    """Returns a 4 x 1 x 1 beam of cubes, n across, in Gmsh's order, and the nodal forces of a unit body force."""
    shape = np.array([n, n, 4 * n])
    node = np.arange(np.prod(shape + 1)).reshape(shape + 1)  # indexed by z, y, x
    corners = [(0, 0, 0), (0, 0, 1), (0, 1, 1), (0, 1, 0), (1, 0, 0), (1, 0, 1), (1, 1, 1), (1, 1, 0)]
    cells = np.stack([node[z:z + n, y:y + n, x:x + 4 * n].ravel() for z, y, x in corners], axis=1)
    z, y, x = (axis.ravel() for axis in np.indices(shape + 1) / n)
    return np.stack([x, y, z], axis=1), cells.astype(np.int32), np.bincount(cells.ravel()) / (8 * n**3)


class Body:
    """Callbacks of SNES. Vectors include the constrained unknowns, whose equations are u = 0."""

    def __init__(self, options):
        start = time.process_time()
        points, cells, volume = beam(options.cells)
        self.points = points
        self.op = kc.Operator(points, cells, "hex8", law=STEEL, threads=options.threads)
        self.held = np.repeat(points[:, 0] == 0, 3)
        self.op.constrain(self.held)
        self.load = np.zeros(points.shape)
        self.load[:, 2] = -options.load * volume
        self.load.ravel()[self.held] = 0.0
        self.load = self.load.ravel()
        self.made_seconds = time.process_time() - start
        self.setup_seconds = 0.0  # of tangents and preconditioners

    def residual(self, _snes, x, f):
        u, out = x.getArray(readonly=True), f.getArray()
        self.op.residual(u, out=out)
        out -= self.load
        out[self.held] = u[self.held]

    def rigid_modes(self):
        coordinates = PETSc.Vec().createWithArray(self.points.ravel(), bsize=3)
        return PETSc.NullSpace().createRigidBody(coordinates)


def with_operator(body, snes):
    """Uses the tangent as a shell: only the frozen moduli are updated; the aggregates of the first step are kept."""
    start = time.process_time()
    multigrid = body.op.multigrid()
    shell = body.op.tangent(np.zeros(body.op.shape[0])).petsc_mat()
    snes.getKSP().setPC(multigrid.petsc_pc())
    body.setup_seconds += time.process_time() - start

    def tangent(_snes, x, matrix, _preconditioner):
        begin = time.process_time()
        matrix.getPythonContext().operator = body.op.tangent(x.getArray(readonly=True))
        multigrid.update()
        matrix.assemble()  # notifies PETSc of the change
        body.setup_seconds += time.process_time() - begin

    snes.setJacobian(tangent, shell)


def with_matrix(body, snes, preconditioner):
    start = time.process_time()
    rows = body.op.matrix(np.zeros(body.op.shape[0]))
    pattern = rows.indptr.astype(np.int32), rows.indices.astype(np.int32)
    matrix = PETSc.Mat().createAIJ(rows.shape, bsize=3, csr=(*pattern, rows.data), comm=PETSc.COMM_SELF)
    matrix.setNearNullSpace(body.rigid_modes())
    matrix.setOption(PETSc.Mat.Option.SPD, True)
    snes.getKSP().getPC().setType(preconditioner)
    # GAMG keeps the aggregates of the first step, as our multigrid does. By default it also keeps the
    # eigenvalue bounds, which are too low beyond yield: the smoother becomes indefinite and CG stops.
    PETSc.Options("beam_")["pc_gamg_use_sa_esteig"] = False
    body.setup_seconds += time.process_time() - start

    def tangent(_snes, x, matrix, _preconditioner):
        begin = time.process_time()
        matrix.setValuesCSR(*pattern, body.op.matrix(x.getArray(readonly=True)).data)
        matrix.assemble()
        snes.getKSP().setOperators(matrix)
        snes.getKSP().setUp()
        body.setup_seconds += time.process_time() - begin

    snes.setJacobian(tangent, matrix)


def solve(body, name, prepare):
    start, before = time.process_time(), body.setup_seconds
    snes = PETSc.SNES().create(PETSc.COMM_SELF)
    snes.setType("newtonls")
    snes.setFunction(body.residual, PETSc.Vec().createSeq(body.op.shape[0]))
    snes.setTolerances(rtol=1e-8, atol=0.0, stol=0.0, max_it=50)
    snes.setUseEW(True)
    snes.setOptionsPrefix("beam_")
    PETSc.Options("beam_")["snes_linesearch_type"] = "cp"
    ksp = snes.getKSP()
    ksp.setType("cg")
    ksp.setNormType(PETSc.KSP.NormType.UNPRECONDITIONED)
    ksp.setTolerances(max_it=20000)
    prepare(body, snes)
    snes.setFromOptions()
    u = PETSc.Vec().createSeq(body.op.shape[0])
    snes.solve(None, u)
    setup = body.setup_seconds - before
    seconds = time.process_time() - start - setup
    return u.getArray().copy(), {
        "name": name, "converged": snes.getConvergedReason() > 0, "newton_steps": snes.getIterationNumber(),
        "iterations": snes.getLinearSolveIterations(), "setup_seconds": body.made_seconds + setup,
        "solve_seconds": seconds}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cells", type=int, default=8, help="across a beam of 4 x 1 x 1")
    parser.add_argument("--load", type=float, default=20.0, help="downwards, a volume")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--with-matrix", action="store_true")
    parser.add_argument("--displacement", metavar="FILE")
    options = parser.parse_args()
    body = Body(options)
    u, row = solve(body, "operator, multigrid", with_operator)
    rows = [row]
    for kind, name in (("jacobi", "matrix, Jacobi"), ("gamg", "matrix, GAMG")) if options.with_matrix else ():
        theirs, row = solve(body, name, lambda *of, kind=kind: with_matrix(*of, kind))
        row["difference"] = float(np.abs(theirs - u).max() / np.abs(theirs).max())
        rows.append(row)
    if options.displacement:
        np.save(options.displacement, u.reshape(-1, 3))
    plastic = float(np.mean(body.op.stress(u)["plastic"]))
    print(json.dumps({"unknowns": len(u), "plastic": plastic, "entries": rows}, indent=1))
    return 0 if all(row["converged"] and row.get("difference", 0) < 1e-6 for row in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
