# SPDX-License-Identifier: BSD-3-Clause
"""Pictures: drawn with the installed backends, and rejected arguments."""
import importlib.util
import os
import unittest
import xml.etree.ElementTree

import kacanov as kc
import numpy as np
from support import pressed_beam, temporary_folder


def in_the_plane(element):
    case = kc.Case(kc.box((4, 1), (8, 2), element)).material(1.0, 0.3)
    return case.fix("left").traction((0, -0.01), "top").solve()


class Svg(unittest.TestCase):
    def test_the_programs_picture(self):
        sol = pressed_beam().solve()
        picture = sol.plot(backend="svg")
        self.assertTrue(xml.etree.ElementTree.fromstring(picture).tag.endswith("svg"))
        self.assertEqual(picture._repr_svg_(), sol._repr_svg_())
        file = temporary_folder(self) / "beam.svg"
        picture.save(file)
        self.assertEqual(file.read_text("utf-8"), picture)

    def test_what_there_is_not(self):
        sol = pressed_beam().solve()
        with self.assertRaisesRegex(kc.InputError, "backend: expected vtk or svg"):
            sol.plot(backend="matplotlib")
        with self.assertRaisesRegex(kc.InputError, "field: expected nodal_von_mises"):
            in_the_plane("tri3").plot("colour", backend="matplotlib")


@unittest.skipUnless(importlib.util.find_spec("matplotlib"), "no matplotlib")
class Matplotlib(unittest.TestCase):
    def setUp(self):
        import matplotlib
        matplotlib.use("agg")

    def test_triangles_carry_the_field(self):
        for element, field, split in (("tri3", "von_mises", 1), ("quad4", "von_mises", 2), ("quad4", "u", 1)):
            sol = in_the_plane(element)
            ax = sol.plot(field, scale=2.0)
            drawn = ax.collections[0]
            values = np.linalg.norm(sol.u, axis=1) if field == "u" else np.repeat(sol.von_mises, split)
            np.testing.assert_array_equal(drawn.get_array(), values)
            self.assertIn("× 2", ax.get_title())
            low, high = (sol.points + 2.0 * sol.u)[:, 1].min(), (sol.points + 2.0 * sol.u)[:, 1].max()
            self.assertLessEqual(drawn.get_datalim(ax.transData).y0, low + 1e-9)
            self.assertGreaterEqual(drawn.get_datalim(ax.transData).y1, high - 1e-9)


@unittest.skipUnless(importlib.util.find_spec("vtkmodules"), "no vtk")
class Vtk(unittest.TestCase):
    def test_the_grid_is_the_body(self):
        from kacanov.plot import vtk_grid
        from vtkmodules.util.numpy_support import vtk_to_numpy
        for element in ("tet10", "hex8"):
            sol = pressed_beam(element, (4, 1, 1)).solve()
            grid = vtk_grid(sol)
            self.assertEqual((grid.GetNumberOfCells(), grid.GetNumberOfPoints()), (len(sol.cells), len(sol.points)))
            np.testing.assert_array_equal(vtk_to_numpy(grid.GetPointData().GetArray("u")), sol.u)
            np.testing.assert_array_equal(vtk_to_numpy(grid.GetCellData().GetArray("von_mises")), sol.von_mises)
            volume = 0.0
            for i in range(grid.GetNumberOfCells()):
                bounds = grid.GetCell(i).GetBounds()
                volume += np.prod(np.diff(np.reshape(bounds, (3, 2)), axis=1)) / (6 if element == "tet10" else 1)
            self.assertAlmostEqual(volume, 4.0, places=9)

    def test_without_a_display_it_is_the_svg(self):
        sol = pressed_beam().solve()
        if not os.environ.get("DISPLAY"):
            self.assertTrue(sol.plot().startswith("<"))
            with self.assertRaisesRegex(kc.InputError, "display"):
                sol.plot(backend="vtk")
        else:
            image = sol.plot()
            self.assertEqual(image.shape[2], 3)
            self.assertGreater(len(np.unique(image.reshape(-1, 3), axis=0)), 10)


if __name__ == "__main__":
    unittest.main()
