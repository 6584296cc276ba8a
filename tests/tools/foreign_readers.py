#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks that other readers open the files of a run, and that the program reads the files that they write.

usage: foreign_readers.py PROGRAM meshio|vtk

Runs a small block on a plane, on one rank and on two; opens body.vtu and contact.vtu; compares points, cells and
displacements with result.json. With meshio it also writes the body as a mesh in every format that the program
reads, and reads every number from files of small bodies, in which offsets of arrays can be confused.
"""
import json
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import zlib

CASE = {
    "mesh": {"box": {"size": [2, 1, 1], "cells": [4, 2, 2], "element": "tet10"}},
    "material": [{"on": "all", "young": 200.0, "poisson": 0.3}],
    "boundary": [{"on": "left", "displacement": [0, 0, 0]}, {"on": "top", "pressure": 0.1}],
    "contact": [{"on": "bottom", "obstacle": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}}],
    "probe": [[2, 1, 1]],
}
BODY = {"displacement": 3, "node_id": 1, "nodal_stress": 6, "nodal_von_mises": 1}
CELLS = {"stress": 6, "von_mises": 1, "strain": 6, "dev_strain": 1, "g": 1, "plastic": 1, "material": 1, "set": 1,
         "element_id": 1, "error": 1}
CONTACT = {"gap": 1, "pressure": 1, "tangential_traction": 3, "normal": 3, "displacement": 3, "status": 1, "entry": 1,
           "node_id": 1}


def by_meshio(path):
    import meshio  # imported here because only one of the two may be installed
    grid = meshio.read(path)
    return (grid.points, sum(len(block.data) for block in grid.cells), grid.point_data,
            {name: values[0] for name, values in grid.cell_data.items()})


def by_vtk(path):
    from vtk.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    point_data, cell_data = ({data.GetArrayName(i): vtk_to_numpy(data.GetArray(i))
                              for i in range(data.GetNumberOfArrays())}
                             for data in (grid.GetPointData(), grid.GetCellData()))
    return vtk_to_numpy(grid.GetPoints().GetData()), grid.GetNumberOfCells(), point_data, cell_data


def plainly(path):
    """Returns the bytes of every array by name, located by their offsets."""
    raw = path.read_bytes()
    head = raw[:raw.index(b"<AppendedData")]
    data = raw.index(b"_", len(head)) + 1
    arrays = {}
    for tag in re.findall(rb"<DataArray [^>]*>", head):
        at = data + int(re.search(rb'offset="(\d+)"', tag)[1])
        blocks = struct.unpack_from("<Q", raw, at)[0]
        lengths = struct.unpack_from(f"<{blocks}Q", raw, at + 24)
        at += 8 * (3 + blocks)
        found = b""
        for length in lengths:
            found += zlib.decompress(raw[at:at + length])
            at += length
        arrays[re.search(rb'Name="([^"]*)"', tag)[1].decode()] = found
    return arrays


def run(program, folder, *words):
    done = subprocess.run([program, *words], cwd=folder, capture_output=True, text=True, check=False, env=dict(os.environ))
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(words)}: {done.stderr}")


def same(what, found, expected):
    if found != expected:
        raise SystemExit(f"{what}: expected {expected}, got {found}")


def check_fields(reader, folder, result):
    for file, at_points, in_cells in (("body.vtu", BODY, CELLS), ("contact.vtu", CONTACT, {})):
        points, cells, point_data, cell_data = reader(folder / file)
        same(f"arrays of {file}", (sorted(point_data), sorted(cell_data)), (sorted(at_points), sorted(in_cells)))
        for data, arrays, count in ((point_data, at_points, len(points)), (cell_data, in_cells, cells)):
            for array, components in arrays.items():
                same(f"{file}: shape of {array}", data[array].reshape(count, -1).shape, (count, components))
        if file == "body.vtu":
            body = point_data
            same("points", len(points), result["mesh"]["nodes"])
            same("cells", cells, result["mesh"]["elements"])
            corner = next(i for i, x in enumerate(points) if tuple(x) == (2.0, 1.0, 1.0))
            same("probe", [float(x) for x in point_data["displacement"][corner]], result["probe"][0])
        else:
            most = float(point_data["pressure"].max())
            same("pressure", abs(most - result["max_contact_pressure"]) <= 1e-12, True)
            known = point_data["status"].reshape(-1) >= 0
            same("normals", abs(point_data["normal"][known] - [0, 0, -1]).max() <= 1e-12, True)
            of_node = {int(n): tuple(u) for n, u in zip(body["node_id"].reshape(-1), body["displacement"])}
            same("displacement", [of_node[int(n)] for n in point_data["node_id"].reshape(-1)],
                 [tuple(u) for u in point_data["displacement"]])


def read_back(program, folder, result):
    """Writes the body in each format with meshio and checks that the program finds the same points and cells."""
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


def read_small(program, folder):
    """Reads bodies for which meshio would confuse arrays if they were in the order of the XML."""
    for cells in ([1, 1], [1, 2], [2, 3], [3, 5], [7, 2]):
        case = {"mesh": {"box": {"size": [2, 1], "cells": cells, "element": "tri3"}}, "material": CASE["material"],
                "boundary": [{"on": "left", "displacement": [0, 0]}, {"on": "top", "traction": [0.01, -0.1]}]}
        (folder / "small.json").write_text(json.dumps(case))
        run(program, folder, "run", "small.json", "--output", "small")
        _, _, point_data, cell_data = by_meshio(folder / "small" / "body.vtu")
        expected = plainly(folder / "small" / "body.vtu")
        for name, values in {**point_data, **cell_data}.items():
            same(f"{cells}: {name}", values.tobytes() == expected[name], True)


def main():
    program, library = os.path.abspath(sys.argv[1]), sys.argv[2]
    reader = {"meshio": by_meshio, "vtk": by_vtk}[library]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "case.json").write_text(json.dumps(CASE))
        for ranks in ("2", "1"):
            run(program, folder, "run", "case.json", "--output", "out", "--ranks", ranks)
            result = json.loads((folder / "out" / "result.json").read_text())
            check_fields(reader, folder / "out", result)
        if library == "meshio":
            read_back(program, folder, result)
            read_small(program, folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
