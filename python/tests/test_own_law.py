# SPDX-License-Identifier: BSD-3-Clause
"""User-defined laws: compared with the built-in law of the same formula, on one thread and two; rejected results."""
import gc
import threading
import unittest
import weakref

import kacanov as kc
import numpy as np
from support import hexahedra

YOUNG, POISSON, X0, N = 1.0, 0.3, 0.01, 0.4
SHEAR = YOUNG / (2 * (1 + POISSON))


def power(x, element, point, x0=X0):
    """μ (x/x0)^(n−1) beyond x0."""
    beyond = x > x0
    ratio = np.where(beyond, x, x0) / x0
    g = SHEAR * ratio ** (N - 1)
    slope = np.where(beyond, (N - 1) * g / (ratio * x0), 0.0)
    energy = SHEAR * np.where(beyond, x0 ** 2 * (0.5 + (ratio ** (N + 1) - 1) / (N + 1)), 0.5 * x ** 2)
    return g, slope, energy


class Body(unittest.TestCase):
    def setUp(self):
        self.points, self.cells = hexahedra(3)
        rng = np.random.default_rng(4)
        self.u = 0.01 * rng.standard_normal(self.points.shape)
        self.x = rng.standard_normal(self.points.size)

    def operator(self, law, **options):
        return kc.Operator(self.points, self.cells, "hex8", law=law, young=YOUNG, poisson=POISSON, **options)


class AsTheBuiltIn(Body):
    def compare(self, own, built_in, u, x):
        def near(a, b):
            np.testing.assert_allclose(a, b, rtol=0, atol=1e-12 * np.abs(b).max())

        for op in (own, built_in):
            op.update(u)
        near(own.secant, built_in.secant)
        near(own @ x, built_in @ x)
        near(own.residual(u), built_in.residual(u))
        near(own.energy(u), built_in.energy(u))
        near(own.tangent(u) @ x, built_in.tangent(u) @ x)
        ours, theirs = own.stress(u), built_in.stress(u)
        for key in ("stress", "von_mises", "dev_strain", "secant"):
            near(ours[key], theirs[key])
        np.testing.assert_array_equal(ours["plastic"], theirs["plastic"])
        self.assertTrue(ours["plastic"].any() and not ours["plastic"].all())

    def test_a_power_law(self):
        points, cells = hexahedra(13)
        rng = np.random.default_rng(2)
        u = 1.2e-3 * (0.3 + points[:, :1]) * rng.standard_normal(points.shape)
        x = rng.standard_normal(points.size)
        for threads in (1, 2):
            with self.subTest(threads=threads):
                made = [kc.Operator(points, cells, "hex8", young=YOUNG, poisson=POISSON, threads=threads, law=law)
                        for law in (kc.OwnLaw(power, yield_strain=X0), kc.Power(x0=X0, n=N))]
                self.assertEqual([op.info["threads"] for op in made], [threads, threads])
                self.compare(*made, u, x)

    def test_a_law_that_differs_from_place_to_place_and_one_beside_it(self):
        yields = np.linspace(0.5 * X0, 2 * X0, len(self.cells))
        middle = len(self.cells) // 2
        of_element = np.repeat([0, 1], [middle, len(self.cells) - middle]).astype(np.uint16)
        seen = []

        def own(x, element, point):
            seen.append((element, point))
            return power(x, element, point, yields[element])

        mixed = kc.Operator(self.points, self.cells, "hex8", law_of_element=of_element, law=[
            kc.Material(YOUNG, POISSON, law=kc.Power(x0=X0, n=N)), {"young": YOUNG, "poisson": POISSON, "law": own}])
        apart = kc.Operator(self.points, self.cells, "hex8", law_of_element=np.arange(len(self.cells), dtype=np.uint16), law=[
            kc.Material(YOUNG, POISSON, law=kc.Power(x0=X0 if e < middle else x0, n=N)) for e, x0 in enumerate(yields)])
        np.testing.assert_allclose(mixed.residual(self.u), apart.residual(self.u), rtol=0, atol=1e-14)
        element, point = (np.concatenate(part) for part in zip(*seen, strict=True))
        np.testing.assert_array_equal(element, np.repeat(np.arange(middle, len(self.cells)), 8))
        np.testing.assert_array_equal(point, np.tile(np.arange(8), len(self.cells) - middle))

    def test_products_do_not_ask(self):
        calls = []

        def own(x, element, point):
            calls.append(len(x))
            return power(x, element, point)

        op = self.operator(own)
        op.update(self.u)
        calls.clear()
        free = np.arange(self.x.size) >= 48
        op.constrain(~free)
        op.cg(op @ (self.x * free), M=op.multigrid())
        self.assertEqual(calls, [])


class WhatGoesWrong(Body):
    def test_what_the_function_raises_is_raised_and_the_operator_lives_on(self):
        class Told(Exception):
            pass

        wrong = [Told("no such steel")]

        def own(x, element, point):
            if wrong:
                raise wrong[0]
            return power(x, element, point)

        for threads in (1, 2):
            op = self.operator(own, threads=threads)
            wrong[:] = [Told("no such steel"), KeyboardInterrupt()]
            while wrong:
                for call in (op.update, op.tangent, op.residual, op.energy, op.stress):
                    with self.assertRaises(type(wrong[0])) as raised:
                        call(self.u)
                    self.assertIs(raised.exception, wrong[0])
                wrong.pop(0)
            np.testing.assert_allclose(op.residual(self.u), self.operator(kc.Power(x0=X0, n=N)).residual(self.u), atol=1e-14)

    def test_what_is_no_answer(self):
        good = power(np.full(8 * len(self.cells), 2 * X0), None, None)
        answers = [
            (None, TypeError, r"law\[0\]: expected the function to return \(g, slope, energy\), got NoneType"),
            (good[:2], TypeError, r"expected the function to return"),
            ((good[0], None, good[2]), TypeError, r"law\[0\]: slope: expected a float64 array of shape \(216,\), got NoneType"),
            ((good[0][1:], *good[1:]), kc.InputError, r"law\[0\]: g: expected .* \(216,\), got float64 of shape \(215,\)"),
            ((good[0].astype(np.float32), *good[1:]), TypeError, "got float32"),
            ((-good[0], *good[1:]), kc.InputError, "element 0, point 0: expected a number > 0"),
            ((good[0], good[1] * np.nan, good[2]), kc.InputError, "slope is .*nan at element 0, point 0")]
        for answer, error, words in answers:
            with self.subTest(words):
                op = self.operator(lambda x, element, point, answer=answer: answer)
                with self.assertRaisesRegex(error, words):
                    op.tangent(self.u)
        op = self.operator(lambda x, element, point: (good[0], None, None))
        op.update(self.u)  # needs g only
        with self.assertRaisesRegex(TypeError, "energy: expected"):
            op.energy(self.u)
        both = np.stack([good[0], good[0]], axis=1)
        self.operator(lambda x, element, point: (both[:, 1], good[1], good[2])).tangent(self.u)  # any stride is allowed

    def test_where_it_does_not_belong(self):
        with self.assertRaisesRegex(kc.InputError, "law: expected what a case file can say, got function"):
            kc.Case(kc.box((1, 1), (1, 1), "tri3")).material(young=1, poisson=0.3, law=power).check()
        with self.assertRaisesRegex(kc.InputError, r"law\[0\]"):
            kc.Operator(self.points, self.cells, "hex8", law=kc.Material(1.0, 0.3, law=power, yield_stress=2.0))
        with self.assertRaisesRegex(kc.InputError, r"law\[0\].x0: expected a number >= 0"):
            self.operator(kc.OwnLaw(power, yield_strain=-1.0))
        with self.assertRaises(kc.InputError):
            self.operator(3)

    def test_it_may_not_use_its_operator(self):
        op = self.operator(lambda x, element, point: op.update(self.u))
        with self.assertRaises(kc.StateError):
            op.update(self.u)

    def test_other_threads_go_on_meanwhile(self):
        inside, went_on = threading.Event(), threading.Event()

        def own(x, element, point):
            inside.set()
            self.assertTrue(went_on.wait(10))
            return power(x, element, point)

        op = self.operator(own)
        thread = threading.Thread(target=op.update, args=(self.u,))
        thread.start()
        self.assertTrue(inside.wait(10))
        with self.assertRaises(kc.StateError):
            op.update(self.u)
        went_on.set()
        thread.join()

    def test_a_law_that_knows_its_operator_is_collected(self):
        class Steel:
            def __init__(self, points, cells):
                self.op = kc.Operator(points, cells, "hex8", young=YOUNG, poisson=POISSON, law=self.law)

            def law(self, x, element, point):
                return power(x, element, point)

        steel = Steel(self.points, self.cells)
        multigrid, gone = steel.op.multigrid(), weakref.ref(steel)
        steel.op.update(self.u)
        del steel
        gc.collect()
        multigrid.update()
        self.assertIsNotNone(gone())  # the multigrid keeps its operator, which keeps the law
        del multigrid
        gc.collect()
        self.assertIsNone(gone())


if __name__ == "__main__":
    unittest.main()
