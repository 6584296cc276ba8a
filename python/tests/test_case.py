# SPDX-License-Identifier: BSD-3-Clause
"""Cases from Python: their documents, solutions in this process compared with those of the program, and rejected
input."""
import json
import locale
import math
import os
import pathlib
import signal
import threading
import unittest

import kacanov as kc
import numpy as np
from support import PROGRAM, hexahedra, pressed_beam, program_result, temporary_folder, use_german_locale

# Entries of result.json that do not describe the solution.
OF_THE_RUN = {"seconds", "peak_memory_bytes", "case"}


def differences(ours, theirs, path=""):
    """Returns the differences between two JSON values, numbers relative to 1e-12 of their size."""
    if isinstance(ours, dict) and isinstance(theirs, dict) and ours.keys() == theirs.keys():
        return [d for key in ours for d in differences(ours[key], theirs[key], f"{path}.{key}")
                if key not in OF_THE_RUN]
    if isinstance(ours, list) and isinstance(theirs, list) and len(ours) == len(theirs):
        return [d for i, pair in enumerate(zip(ours, theirs, strict=True)) for d in differences(*pair, f"{path}[{i}]")]
    if isinstance(ours, float) and isinstance(theirs, float) and math.isclose(ours, theirs, rel_tol=1e-12, abs_tol=1e-300):
        return []
    return [] if ours == theirs else [f"{path}: {ours} {theirs}"]


@unittest.skipUnless(PROGRAM, "KACANOV_PROGRAM names no program")
class AsTheProgram(unittest.TestCase):
    def compare(self, case):
        folder = temporary_folder(self)
        case.to_json(folder / "case.json")
        run, theirs = program_result(folder / "case.json", folder / "out")
        self.assertEqual(run.returncode, 0, run.stderr)
        sol = case.solve(threads=1)
        self.assertEqual(differences({k: v for k, v in sol.result.items() if k != "mesh"},
                                     {k: v for k, v in theirs.items() if k != "mesh"}), [])
        again = kc.Case.from_json(folder / "case.json").solve(threads=1)
        np.testing.assert_array_equal(again.u, sol.u)
        return sol

    def test_a_box(self):
        self.compare(pressed_beam())

    def test_a_box_that_is_solved_on_coarser_meshes_first(self):
        sol = self.compare(pressed_beam("tet4", (32, 12, 16)))
        self.assertEqual(len(sol.result["nested"]), 2)

    def test_obstacles_that_move(self):
        case = pressed_beam()
        case.set("contact[0].motion", {"path": [{"time": 1, "translation": [0.1, 0, 0.05]}]})
        self.compare(case.solver(load_steps=2))

    def test_arrays_go_through_the_file_they_would_be(self):
        points, cells = hexahedra(3)
        floor = points[:, 2] == 0.0
        sides = np.array([cell[[0, 1, 2, 3]] for cell in cells if floor[cell[:4]].all()])
        mesh = kc.Mesh(points, cells, "hex8", facets={"floor": sides}, parts={"soft": np.arange(9), "hard": np.arange(9, 27)},
                       nodes={"corner": [0]})
        case = kc.Case(mesh).material(1.0, 0.3, on="soft").material(2.0, 0.3, on="hard")
        case.body_force((0.01, 0, -0.1)).fix("corner", (0.0, None, None)).fix(kc.Box((0, 0, 0), (0, 1, 1)), (None, 0.0, None))
        case.contact("floor", kc.Plane((0, 0, 0), (0, 0, 1)), coulomb=0.5).fix("corner", (None, 0.0, None))
        sol = self.compare(case)
        np.testing.assert_array_equal(sol.points, points)
        np.testing.assert_array_equal(sol.cells, cells)


class Solutions(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.case = pressed_beam()
        cls.sol = cls.case.solve()

    def test_fields_fit_each_other(self):
        sol = self.sol
        self.assertTrue(sol.converged)
        self.assertLess(max(v for k, v in sol.certificate.items() if k != "rounding"), 1e-6)
        nodes, elements = len(sol.points), len(sol.cells)
        self.assertEqual((sol.u.shape, sol.stress.shape, sol.nodal_stress.shape), ((nodes, 3), (elements, 6), (nodes, 6)))
        self.assertEqual(sol.von_mises.max(), sol.result["max_von_mises"])
        self.assertEqual(sol.nodal_von_mises.max(), sol.result["max_von_mises_nodal"])
        self.assertEqual(int(sol.plastic.sum()), sol.result["plastic_elements"])
        self.assertAlmostEqual(np.linalg.norm(sol.error), sol.result["discretisation"]["energy"], delta=1e-12)
        self.assertEqual(sol.contact["pressure"].max(), sol.result["max_contact_pressure"])
        self.assertEqual(np.linalg.norm(sol.u, axis=1).max(), sol.result["max_displacement"]["value"])
        at = np.flatnonzero(np.all(sol.points == (4, 0.5, 1), axis=1))[0]
        np.testing.assert_allclose(sol.u[at], sol.probe[0], rtol=1e-12)
        with self.assertRaises(ValueError):
            sol.u[0] = 1.0
        stress = sol.stress[:, :3]
        self.assertEqual(sol.element_id[-1], elements)
        self.assertTrue(np.isfinite(stress).all())

    def test_fields_outlive_the_solution(self):
        u = pressed_beam().solve().u
        np.testing.assert_array_equal(u, self.sol.u)

    def test_equilibrium_by_the_operator(self):
        sol = self.sol
        op = kc.Operator(sol.points.copy(), sol.cells.copy(), sol.element,
                         law=kc.Material(210e3, 0.3, law=kc.Logarithmic(yield_stress=25), bbar=True))
        force = op.residual(np.ascontiguousarray(sol.u)).sum(axis=0)
        np.testing.assert_allclose(force, 0.0, atol=1e-6)
        np.testing.assert_allclose(op.stress(np.ascontiguousarray(sol.u))["stress"], sol.stress, rtol=1e-9, atol=1e-9)

    def test_a_study_starts_from_the_solution_before(self):
        case, start = self.case.copy(), self.sol
        for mu in (0.1, 0.4):
            case.set("contact[0].friction.coulomb", mu)
            afresh, on = case.solve(), case.solve(start=start)
            self.assertTrue(on.converged)
            np.testing.assert_allclose(on.u, afresh.u, rtol=0, atol=1e-5 * np.abs(afresh.u).max())
            self.assertLess(on.result["outer_iterations"], afresh.result["outer_iterations"])
        finer = pressed_beam(cells=(16, 4, 4)).solve(start=start)
        self.assertTrue(finer.converged)

    def test_the_same_again_with_threads(self):
        sol = self.case.solve(threads=2)
        self.assertEqual(sol.result["threads"], 2)
        np.testing.assert_allclose(sol.u, self.sol.u, rtol=0, atol=1e-5 * np.abs(self.sol.u).max())

    def test_what_does_not_converge_says_so(self):
        sol = self.case.copy().solver(max_outer=1).solve()
        self.assertEqual((sol.status, sol.converged), ("not_converged", False))
        self.assertIn("after 1 outer steps", sol.message)
        self.assertIn("not_converged", sol.summary())

    def test_warnings_are_the_programs(self):
        sol = self.case.copy().set("boundary[1].traction", [0, 0, -9e3]).solver(max_outer=2).solve()
        self.assertTrue(any("strains" in text or "moves by" in text for text in sol.warnings), sol.warnings)

    def test_progress_and_check(self):
        steps = []
        sol = self.case.solve(progress=steps.append)
        self.assertEqual(len(steps), sol.result["outer_iterations"])
        self.assertEqual([s["outer"] for s in steps], list(range(1, len(steps) + 1)))
        found = self.case.check()
        self.assertEqual((found["unknowns"], found["element"]), (243, "hex8"))

    def test_a_turned_block_is_a_plane_where_it_is_large(self):
        case = kc.Case(kc.box((2, 1, 1), (4, 2, 2), "hex8")).material(210e3, 0.3).fix("top", (0, 0, -0.01))
        of_plane = case.copy().contact("bottom", kc.Plane((0, 0, 0), (0.02, 0.02, 1))).solve()
        block = kc.Block((-1, -9, -9), (1, 9, -0.2), frame=[(1, 1, -0.04), (-1, 1, 0), (0.02, 0.02, 1)])
        self.assertEqual(block.json()["box"]["frame"][1], (-1, 1, 0))
        turned = case.contact("bottom", block).solve()
        np.testing.assert_allclose(turned.u, of_plane.u, rtol=0, atol=1e-9)

    def test_warmth_held_in_plane_stress_is_that_of_the_bar_in_tension(self):
        case = kc.Case(kc.box((4, 1), (8, 3), "quad4")).set("plane", "stress").temperature(300)
        case.material(200, 0.3, expansion=1e-5, yield_stress=0.2, tangent_modulus=20)
        case.fix("left", (0, None)).fix("right", (0, None)).fix("bottom", (None, 0))
        sol = case.solve()
        np.testing.assert_allclose(sol.stress, np.broadcast_to([-0.24, 0, 0, 0, 0, 0], sol.stress.shape), rtol=0, atol=1e-6)

    def test_warmth_that_nothing_hinders_strains_without_stress(self):
        case = kc.Case(kc.box((2, 1, 1), (4, 2, 2), "hex8")).material(210e3, 0.3, expansion=1e-5).temperature(100)
        case.fix("left", (None, 0, None), frame=[(0, 1, 0), (1, 0, 0), (0, 0, 1)])
        case.symmetry("front").symmetry("bottom")
        sol = case.solve()
        np.testing.assert_allclose(sol.u, 1e-3 * sol.points, rtol=0, atol=1e-8)
        for stress in (sol.stress, sol.nodal_stress):
            self.assertLess(np.abs(stress).max(), 1e-3)

    def test_warmth_that_grows_along_a_bar(self):
        case = kc.Case(kc.box((2, 1, 1), (4, 1, 1), "hex8")).material(210e3, 0.3, expansion=1e-5)
        sol = case.temperature({"gradient": (50, 0, 0), "value": 10}).fix("all").solve()
        warmer = 10 + 50 * (np.arange(4) + 0.5) / 2  # supports keep every node from moving
        np.testing.assert_allclose(sol.stress[:, 0], -210e3 * 1e-5 * warmer / 0.4, rtol=1e-9)

    def test_warmth_between_walls_presses(self):
        case = kc.Case(kc.box((2, 1, 1), (4, 2, 2), "hex8")).material(210e3, 0.3, expansion=1e-5).temperature(100)
        sol = case.fix("all").solve()
        pressure = 210e3 * 1e-3 / (1 - 2 * 0.3)
        np.testing.assert_allclose(sol.stress, np.tile([-pressure] * 3 + [0.0] * 3, (16, 1)), rtol=0, atol=1e-9)
        np.testing.assert_allclose(sol.nodal_stress[:, :3], -pressure, rtol=1e-9)

    def test_springs_warmth_and_symmetry(self):
        case = kc.Case(kc.box((1, 1, 1), (2, 2, 2), "hex8"))
        case.material(young=200, poisson=0.3, expansion=1e-5).temperature(100)
        case.symmetry("left").symmetry("front").spring((0, 0, 1e3), "bottom").node_spring((0, 0, 0.5), "bottom")
        sol = case.solve()
        self.assertTrue(sol.converged)
        np.testing.assert_allclose(sol.u, 1e-3 * np.array(sol.points), atol=1e-9)
        for stress in (sol.nodal_stress, sol.stress):
            np.testing.assert_allclose(stress, 0, atol=1e-6)

    def test_thickness_of_a_plate(self):
        case = kc.Case(kc.box((2, 1), (4, 2), "quad4"), plane="stress", thickness=5).material(young=200, poisson=0.3)
        sol = case.fix("bottom", (None, 0)).fix("left", (0, None)).total_force((10, 0), "right").solve()
        np.testing.assert_allclose(sol.stress[:, 0], 10 / 5, rtol=1e-8)
        np.testing.assert_allclose(sol.u[:, 0], sol.points[:, 0] * 2 / 200, rtol=1e-6, atol=1e-12)

    def test_plane_stress_and_bodies_of_revolution(self):
        def pulled(plane):
            case = kc.Case(kc.box((2, 1), (8, 4), "quad4"), plane=plane).material(young=200, poisson=0.3)
            return case.fix("bottom", (None, 0)).fix("left", (0, None)).traction((1, 0), "right").solve()

        sol = pulled("stress")
        np.testing.assert_allclose(sol.u[:, :2], sol.points[:, :2] * [1 / 200, -0.3 / 200], atol=1e-7)
        # Radial tension on a disc: (1 − ν)/E in the plane, −2ν/E along the axis.
        sol = pulled("axisymmetric")
        np.testing.assert_allclose(sol.u[:, :2], sol.points[:, :2] * [0.7 / 200, -0.6 / 200], atol=1e-7)
        with self.assertRaisesRegex(kc.InputError, "plane: expected"):
            pulled("flat")

    def test_in_the_plane(self):
        case = kc.Case(kc.box((4, 1), (16, 4))).material(1.0, 0.3, kc.LinearHardening(x0=0.01, gamma=0.2))
        case.fix("left").traction((0, -0.02), "top").contact("bottom", kc.Gap(0.01), tresca=0.01)
        sol = case.solve()
        self.assertTrue(sol.converged)
        self.assertEqual(sol.u.shape[1], 2)


class Stops(unittest.TestCase):
    def setUp(self):
        # A shell ignores SIGINT in background processes, and solve() would inherit that.
        before = signal.signal(signal.SIGINT, signal.default_int_handler)
        self.addCleanup(signal.signal, signal.SIGINT, before)

    def long(self):
        """Returns the case of a long run: one minute, many outer steps."""
        return pressed_beam("hex8", (24, 8, 8)).solver(load_steps=1000, tolerance=1e-9)

    def test_control_c_keeps_the_state(self):
        case, seen = self.long(), []

        def signal_after_a_step(step):
            if not seen:
                signal.raise_signal(signal.SIGINT)
            seen.append(step["outer"])

        with self.assertRaises(kc.Interrupted) as caught:
            case.solve(progress=signal_after_a_step)
        self.assertIsInstance(caught.exception, KeyboardInterrupt)
        sol = caught.exception.solution
        self.assertIs(case.solution, sol)
        self.assertEqual(sol.status, "interrupted")
        self.assertGreater(np.abs(sol.u).max(), 0.0)
        self.assertLess(len(seen), 5)

    def test_control_c_from_outside(self):
        timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
        case = self.long()
        with self.assertRaises(kc.Interrupted):
            case.solve(progress=lambda step: timer.start() if step["outer"] == 1 else None)
        timer.join()
        self.assertLess(case.solution.result["seconds"]["total"], 20)

    def test_what_a_callback_raises_is_raised(self):
        case = self.long()
        with self.assertRaisesRegex(ZeroDivisionError, "division"):
            case.solve(progress=lambda step: 1 / 0)
        self.assertEqual(case.solution.status, "interrupted")

    def test_a_stop_that_is_asked_for_is_a_status(self):
        self.assertEqual(self.long().solve(stop=lambda: True).status, "interrupted")

    def test_threads_take_turns_and_callbacks_do_not_solve(self):
        case = pressed_beam()
        alone, found = case.solve(threads=1).u, []
        threads = [threading.Thread(target=lambda: found.append(pressed_beam().solve(threads=1).u)) for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for u in found:
            np.testing.assert_array_equal(u, alone)
        self.assertEqual(len(found), 3)
        with self.assertRaisesRegex(kc.StateError, "callback"):
            case.solve(progress=lambda step: pressed_beam().solve())


class Files(unittest.TestCase):
    def test_there_and_back(self):
        folder = temporary_folder(self)
        case = pressed_beam().set("output.fields", "none")
        case.to_json(folder / "beam.json")
        back = kc.Case.from_json(folder / "beam.json")
        self.assertEqual(back.document, json.loads(json.dumps(case.document)))
        self.assertEqual((back.name, back.folder), ("beam", str(folder)))

    def test_relative_files_are_found_from_elsewhere(self):
        folder, other = temporary_folder(self), temporary_folder(self)
        points, cells = hexahedra(2)
        pathlib.Path(folder, "part.msh").write_bytes(kc.Mesh(points, cells, "hex8").msh())
        case = kc.Case.from_dict({"mesh": {"file": "part.msh"}, "material": [{"on": "all", "young": 1, "poisson": 0.3}],
                                  "boundary": [{"on": {"box": [[0, 0, 0], [0, 1, 1]]}, "displacement": [0, 0, 0]}]}, folder=folder)
        case.to_json(other / "case.json")
        self.assertEqual(kc.Case.from_json(other / "case.json").check()["elements"], 8)
        self.assertEqual(kc.Case(kc.read(folder / "part.msh")).document["mesh"]["file"], str(folder / "part.msh"))

    def test_meshio(self):
        class Block:
            def __init__(self, type_, data):
                self.type, self.data = type_, np.array(data)

        class Meshio:
            points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1.0]])
            cells = [Block("triangle", [[0, 1, 2]]), Block("tetra", [[0, 1, 2, 3]]), Block("tetra", [[1, 2, 3, 4]])]
            cell_sets = {}
            point_sets = {"tip": np.array([4])}
            cell_data = {"gmsh:physical": [np.array([7]), np.array([1]), np.array([2])]}
            field_data = {"floor": (7, 2), "lower": (1, 3), "upper": (2, 3)}

        mesh = kc.from_meshio(Meshio)
        case = kc.Case(mesh).material(1, 0.3, on="lower").material(2, 0.3, on="upper")
        found = case.fix("floor").fix("tip", (0.1, None, None)).check()
        self.assertEqual((found["element"], found["elements"], found["nodes"]), ("tet4", 2, 5))


class Refusals(unittest.TestCase):
    def refused(self, words, work):
        with self.assertRaisesRegex(kc.InputError, words):
            work()

    def test_in_the_words_of_the_case_file(self):
        self.refused(r"contact\[0\].friction.coulomb: expected a number ≥ 0, got \"high\"",
                     pressed_beam().set("contact[0].friction.coulomb", "high").solve)
        self.refused("material: this key is missing", kc.Case(kc.box((1, 1), (2, 2))).solve)
        self.refused(r"boundary\[2\].on: .*\"lid\".*bottom", pressed_beam().pressure(1.0, "lid").solve)
        self.refused(r"boundary\[0\].displacement: expected 2 entries",
                     kc.Case(kc.box((1, 1), (2, 2))).material(1, 0).fix("left", (0, 0, 1.0)).solve)
        self.refused("no list in the case file", lambda: pressed_beam().set("mesh[0]", 1))
        self.refused("solver.tolerence: unknown key", pressed_beam().solver(tolerence=1e-3).solve)
        self.refused("threads: expected", lambda: pressed_beam().solve(threads=0))
        self.refused("start: expected a solution in 2 dimensions",
                     lambda: kc.Case(kc.box((1, 1), (2, 2))).material(1, 0).fix("left").traction((0, 1), "top").solve(
                         start=pressed_beam().solve()))

    def test_what_json_cannot_say(self):
        self.refused(r"boundary\[2\].pressure: expected a finite number, got nan",
                     lambda: pressed_beam().pressure(math.nan, "top"))
        self.refused(r"probe\[0\]\[1\]: expected what a case file can say, got set", lambda: pressed_beam().probe((1, set(), 0)))
        case = pressed_beam()
        case.document["solver"] = {"tolerance": np.float64(1e-5), "load_steps": np.array([0.5, 1.0])}
        self.assertTrue(case.solve().converged)

    def test_meshes(self):
        points, cells = hexahedra(2)
        self.refused("expected numbers from 0 to 26", lambda: kc.Mesh(points, cells + 1, "hex8"))
        self.refused(r"cells: expected an array of shape \(any, 4\)", lambda: kc.Mesh(points, cells, "tet4"))
        self.refused("facets\\['a'\\]: expected an array of shape", lambda: kc.Mesh(points, cells, "hex8", facets={"a": [1]}))
        self.refused("one of them at most", lambda: kc.Mesh(points, cells, "hex8", parts={"a": [0], "b": [0, 1]}).msh())
        inverted = kc.Mesh(points, cells[:, [4, 5, 6, 7, 0, 1, 2, 3]], "hex8")
        self.refused("element 1", kc.Case(inverted).material(1, 0).fix("all").check)
        self.refused("there is no such file", lambda: kc.read("nowhere.msh"))
        self.refused("nowhere.json", lambda: kc.Case.from_json("nowhere.json"))
        folder = temporary_folder(self)
        (folder / "broken.json").write_text('{"mesh": {},\n "mesh": {}}')
        self.refused("mesh: this key is there twice", lambda: kc.Case.from_json(folder / "broken.json"))
        with self.assertRaisesRegex(TypeError, "mesh: expected"):
            kc.Case(points)


class AsAGuest(unittest.TestCase):
    def test_the_environment_is_left_alone(self):
        import subprocess
        import sys
        command = "import kacanov as kc, subprocess; from support import *; before = subprocess.check_output('env'); " \
                  "pressed_beam().solve(); assert subprocess.check_output('env') == before; print('same')"
        run = subprocess.run([sys.executable, "-c", command], capture_output=True, text=True, check=False,
                             cwd=pathlib.Path(__file__).parent)
        self.assertEqual((run.stdout, run.stderr, run.returncode), ("same\n", "", 0))

    def test_a_locale_with_commas_changes_nothing(self):
        use_german_locale(self)
        commas = locale.localeconv()["decimal_point"]
        seen = set()

        def told():
            case, bad = pressed_beam("tet4", (8, 4, 4)), pressed_beam().set("probe[0]", [4.25, 0.5, 1.5])
            sol = case.solve(progress=lambda _: seen.add(locale.localeconv()["decimal_point"]))
            with self.assertRaises(kc.InputError) as refused:
                bad.check()
            return [sol.message, sol.warnings, sol.contact_force.tolist(), sol.u.tolist(), sol.svg(), str(refused.exception),
                    from_file.solve().points.tolist()]

        file = temporary_folder(self) / "tiny.msh"  # out of range of double: a separate code path
        file.write_text("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 1.5e-400 0 0\n2 1.5 0 0\n3 0 1.5 0\n$EndNodes\n"
                        "$Elements\n1\n1 2 2 1 1 1 2 3\n$EndElements\n", "utf-8")
        from_file = kc.Case(kc.read(file)).material(young=1.5, poisson=0.3).fix("all")
        there = told()
        self.assertEqual((commas, seen), (",", {","}))
        locale.setlocale(locale.LC_ALL, "C")
        self.assertEqual(there, told())


if __name__ == "__main__":
    unittest.main()
