# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of solutions: matplotlib in 2D, vtk in 3D if available, else the program's SVG."""
from __future__ import annotations

import importlib.util
import os
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import InputError

if TYPE_CHECKING:
    from .solution import Solution

TRIANGLES = {"tri3": [[0, 1, 2]], "quad4": [[0, 1, 2], [0, 2, 3]]}


class Svg(str):
    """A picture as SVG text, which notebooks display."""

    def _repr_svg_(self) -> str:
        return str(self)

    def save(self, path: str) -> None:
        """Writes the picture to a file."""
        with open(path, "w", encoding="utf-8") as file:
            file.write(self)


def _values(solution: Solution, field: str) -> np.ndarray:
    names = ("nodal_von_mises", "von_mises", "dev_strain", "g", "plastic", "u")
    if field not in names:
        raise InputError(f"field: expected {', '.join(names)}, got \"{field}\"")
    values = getattr(solution, field)
    return np.linalg.norm(values, axis=1) if field == "u" else np.asarray(values, dtype=float)


def _scale(solution: Solution) -> float:
    """Returns a scale that shows the largest displacement as a tenth of the body size, at least 1."""
    size = np.linalg.norm(np.ptp(solution.points, axis=0))
    largest = np.abs(solution.u).max()
    return float(max(1.0, 0.1 * size / largest)) if largest > 0 else 1.0


def plot(solution: Solution, field: str = "nodal_von_mises", *, scale: float | None = None, ax: Any = None,
         backend: str | None = None) -> Any:
    """Draws the deformed body coloured by a field: nodal_von_mises, von_mises, dev_strain, g, plastic or u.

    scale: displacement scale, None: automatic. backend: None for the best available one of "matplotlib" (2D; draws into
    `ax` and returns the axes), "vtk" (3D, needs a display; renders off-screen and returns an image as an array) and
    "svg" (the program's picture, with its own field and scale).
    """
    dim = solution.points.shape[1]
    best = "matplotlib" if dim == 2 else "vtk"
    # Debian's vtk aborts the process without a display, even for off-screen rendering.
    display = best != "vtk" or bool(os.environ.get("DISPLAY"))
    if backend is None:
        module = "vtkmodules" if best == "vtk" else best
        backend = best if display and importlib.util.find_spec(module) else "svg"
    if backend == "svg":
        return Svg(solution.svg())
    if backend != best:
        raise InputError(f"backend: expected {best} or svg for a body in {dim} dimensions, got \"{backend}\"")
    if not display:
        raise InputError("backend: vtk needs a display (DISPLAY is not set; xvfb-run gives one)")
    values = _values(solution, field)
    scale = _scale(solution) if scale is None else scale
    return _matplotlib(solution, field, values, scale, ax) if dim == 2 else _vtk(solution, field, values, scale)


def _matplotlib(solution: Solution, field: str, values: np.ndarray, scale: float, ax: Any) -> Any:
    from matplotlib import pyplot
    if ax is None:
        ax = pyplot.figure(layout="constrained").add_subplot()
    split = np.array(TRIANGLES[solution.element])
    triangles = solution.cells[:, split].reshape(-1, 3)
    at = solution.points + scale * solution.u
    if len(values) == len(solution.points):
        drawn = ax.tripcolor(at[:, 0], at[:, 1], triangles, values, shading="gouraud")
    else:
        drawn = ax.tripcolor(at[:, 0], at[:, 1], triangles, facecolors=np.repeat(values, len(split)))
    ax.triplot(solution.points[:, 0], solution.points[:, 1], triangles, color="0.8", linewidth=0.3, zorder=0)
    ax.set_aspect("equal")
    ax.set_title(f"{field}, displacement × {scale:.3g}")
    ax.figure.colorbar(drawn, ax=ax, shrink=0.7)
    return ax


def vtk_grid(solution: Solution) -> Any:
    """Returns the body as a vtkUnstructuredGrid with u, nodal_von_mises and von_mises."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkUnstructuredGrid
    mesh = solution._mesh
    cells = solution.cells[:, mesh["vtk_order"]]
    grid, points, array = vtkUnstructuredGrid(), vtkPoints(), vtkCellArray()
    points.SetData(numpy_to_vtk(np.pad(solution.points, ((0, 0), (0, 3 - solution.points.shape[1]))), deep=True))
    offsets = np.arange(0, cells.size + 1, cells.shape[1], dtype=np.int64)
    array.SetData(numpy_to_vtkIdTypeArray(offsets, deep=True),
                  numpy_to_vtkIdTypeArray(cells.ravel().astype(np.int64), deep=True))
    grid.SetPoints(points)
    grid.SetCells(mesh["vtk_type"], array)
    for name in ("u", "nodal_von_mises"):
        data = numpy_to_vtk(np.ascontiguousarray(getattr(solution, name)), deep=True)
        data.SetName(name)
        grid.GetPointData().AddArray(data)
    data = numpy_to_vtk(np.ascontiguousarray(solution.von_mises), deep=True)
    data.SetName("von_mises")
    grid.GetCellData().AddArray(data)
    return grid


def _vtk(solution: Solution, field: str, values: np.ndarray, scale: float) -> np.ndarray:
    import vtkmodules.vtkRenderingOpenGL2  # noqa: F401, registers the renderer of the classes below
    from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkLookupTable
    from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter
    from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
    from vtkmodules.vtkRenderingCore import (vtkActor, vtkDataSetMapper, vtkRenderer, vtkRenderWindow,
                                             vtkWindowToImageFilter)
    grid = vtk_grid(solution)
    data = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
    data.SetName(field)
    nodal = len(values) == len(solution.points)
    (grid.GetPointData() if nodal else grid.GetCellData()).SetScalars(data)
    grid.GetPoints().SetData(numpy_to_vtk(solution.points + scale * solution.u, deep=True))
    surface, mapper, actor = vtkDataSetSurfaceFilter(), vtkDataSetMapper(), vtkActor()
    surface.SetInputData(grid)
    mapper.SetInputConnection(surface.GetOutputPort())
    colours = vtkLookupTable()
    colours.SetHueRange(2 / 3, 0.0)  # from blue (low) to red
    mapper.SetLookupTable(colours)
    mapper.SetScalarRange(float(values.min()), float(values.max()))
    actor.SetMapper(mapper)
    bar, renderer, window, image = vtkScalarBarActor(), vtkRenderer(), vtkRenderWindow(), vtkWindowToImageFilter()
    bar.SetLookupTable(mapper.GetLookupTable())
    bar.SetTitle(f"{field}, displacement x {scale:.3g}")
    for text in (bar.GetTitleTextProperty(), bar.GetLabelTextProperty()):
        text.SetColor(0.0, 0.0, 0.0)
        text.SetShadow(0)
    renderer.AddActor(actor)
    renderer.AddActor2D(bar)
    renderer.SetBackground(1.0, 1.0, 1.0)
    window.SetOffScreenRendering(1)
    window.SetSize(900, 600)
    window.AddRenderer(renderer)
    camera = renderer.GetActiveCamera()
    camera.SetPosition(1.0, -2.0, 1.0)
    camera.SetViewUp(0.0, 0.0, 1.0)
    renderer.ResetCamera()
    window.Render()
    image.SetInput(window)
    image.Update()
    pixels = image.GetOutput()
    columns, rows, _ = pixels.GetDimensions()
    return vtk_to_numpy(pixels.GetPointData().GetScalars()).reshape(rows, columns, -1)[::-1]
