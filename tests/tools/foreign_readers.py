#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Do other readers open what a run writes, and does the program read what they write?

usage: foreign_readers.py PROGRAM meshio|vtk

Runs a small block on a plane; opens body.vtu and contact.vtu; compares points, cells and displacements with what
result.json says. With meshio the body comes back as a mesh, in every format that the program reads.
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

CASE = {
    "mesh": {"box": {"size": [2, 1, 1], "cells": [4, 2, 2], "element": "tet10"}},
    "material": [{"on": "all", "young": 200.0, "poisson": 0.3}],
    "boundary": [{"on": "left", "displacement": [0, 0, 0]}, {"on": "top", "pressure": 0.1}],
    "contact": [{"on": "bottom", "obstacle": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}}],
    "probe": [[2, 1, 1]],
}
BODY = {"displacement": 3, "node_id": 1, "nodal_stress": 6, "nodal_von_mises": 1}
CONTACT = {"gap": 1, "pressure": 1, "tangential_traction": 3, "status": 1, "node_id": 1}


def by_meshio(path):
    import meshio  # here, because only one of the two may be installed
    grid = meshio.read(path)
    return grid.points, sum(len(block.data) for block in grid.cells), grid.point_data


def by_vtk(path):
    from vtk.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    data = grid.GetPointData()
    arrays = {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}
    return vtk_to_numpy(grid.GetPoints().GetData()), grid.GetNumberOfCells(), arrays


def run(program, folder, *words):
    done = subprocess.run([program, *words], cwd=folder, capture_output=True, text=True, check=False, env=dict(os.environ))
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(words)}: {done.stderr}")


def same(what, found, expected):
    if found != expected:
        raise SystemExit(f"{what}: expected {expected}, got {found}")


def read_back(program, folder, result):
    """meshio writes the body in each format; the program finds the same points and cells."""
    import meshio
    grid = meshio.read(folder / "out" / "body.vtu")
    plain = meshio.Mesh(grid.points, grid.cells)
    for name, options in {"gmsh22.msh": {"file_format": "gmsh22"}, "gmsh.msh": {"file_format": "gmsh"},
                          "text.msh": {"file_format": "gmsh22", "binary": False}, "abaqus.inp": {}, "zlib.vtu": {},
                          "base64.vtu": {"compression": None}, "ascii.vtu": {"binary": False}}.items():
        plain.write(folder / name, **options)
        run(program, folder, "init", name, f"{name}.json", "--force")
        run(program, folder, "run", f"{name}.json", "--output", "again", "--set", "output.fields=none")
        mesh = json.loads((folder / "again" / "result.json").read_text())["mesh"]
        for key in ("element", "nodes", "elements", "boundary_facets"):
            same(f"{name}: {key}", mesh[key], result["mesh"][key])


def main():
    program, library = os.path.abspath(sys.argv[1]), sys.argv[2]
    reader = {"meshio": by_meshio, "vtk": by_vtk}[library]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "case.json").write_text(json.dumps(CASE))
        run(program, folder, "run", "case.json", "--output", "out", "--ranks", "1")
        result = json.loads((folder / "out" / "result.json").read_text())
        for file, arrays in (("body.vtu", BODY), ("contact.vtu", CONTACT)):
            points, cells, data = reader(folder / "out" / file)
            for array, components in arrays.items():
                same(f"{file}: shape of {array}", data[array].reshape(len(points), -1).shape, (len(points), components))
            if file == "body.vtu":
                same("points", len(points), result["mesh"]["nodes"])
                same("cells", cells, result["mesh"]["elements"])
                corner = next(i for i, x in enumerate(points) if tuple(x) == (2.0, 1.0, 1.0))
                same("probe", [float(x) for x in data["displacement"][corner]], result["probe"][0])
            else:
                same("pressure", abs(float(data["pressure"].max()) - result["max_contact_pressure"]) <= 1e-12, True)
        if library == "meshio":
            read_back(program, folder, result)
    return 0


if __name__ == "__main__":
    sys.exit(main())
