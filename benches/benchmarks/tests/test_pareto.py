"""Fronts and means, beside what their words say done naively."""

import itertools
import random
import unittest

from benchmarks.pareto import front, front_of, geometric_mean, standings
from benchmarks.rows import Row

from .examples import case, row


class Front(unittest.TestCase):
    def test_is_what_nobody_dominates(self) -> None:
        draw = random.Random(5)
        for count in range(8):
            for _ in range(200):
                # Few values, so that there are ties.
                points = [(draw.randrange(4), draw.randrange(4)) for _ in range(count)]
                found = [points[place] for place in front(points)]
                better = {
                    point: any(o != point and o[0] <= point[0] and o[1] <= point[1] for o in points) for point in points
                }
                self.assertEqual(found, sorted(point for point, is_beaten in better.items() if not is_beaten))

    def test_goes_down_from_left_to_right(self) -> None:
        draw = random.Random(6)
        points = [(draw.random(), draw.random()) for _ in range(100)]
        line = [points[place] for place in front(points)]
        for left, right in itertools.pairwise(line):
            self.assertLess(left[0], right[0])
            self.assertGreater(left[1], right[1])

    def test_takes_the_first_of_equals(self) -> None:
        self.assertEqual(front([(2, 1), (1, 1), (1, 1)]), [1])


class Means(unittest.TestCase):
    def test_are_geometric(self) -> None:
        self.assertAlmostEqual(geometric_mean([1.0, 4.0, 16.0]), 4.0)


class Standings(unittest.TestCase):
    def rms(self, row: Row) -> float | None:
        return row.rms

    def test_are_multiples_of_the_best_on_each_mesh(self) -> None:
        bunny, fandisk = case("bunny"), case("fandisk", triangles_in=4000)
        rows = [
            row("fast", 1e-3, 4.0, case=bunny),
            row("close", 9e-3, 1.0, case=bunny),
            row("fast", 1e-3, 2.0, case=fandisk),
            row("close", 4e-3, 2.0, case=fandisk),
        ]
        fast, close = standings(rows, self.rms)
        self.assertEqual([fast.contender, close.contender], ["fast", "close"])
        self.assertAlmostEqual(fast.error, 2.0)
        self.assertAlmostEqual(fast.microseconds, 0.5)
        self.assertAlmostEqual(close.error, 1.0)
        self.assertAlmostEqual(close.microseconds, 3.0)
        self.assertEqual(front_of([fast, close]), [fast, close])

    def test_who_misses_the_count_is_no_measure_and_not_on_the_front(self) -> None:
        rows = [row("cheat", 1e-4, 0.5, triangles=900), row("honest", 1e-3, 1.0)]
        cheat, honest = standings(rows, self.rms)
        self.assertFalse(cheat.complete)
        self.assertAlmostEqual(honest.error, 1.0)
        self.assertEqual(front_of([cheat, honest]), [honest])

    def test_two_cores_are_not_on_the_front(self) -> None:
        one, two = standings([row("one", 2e-3, 1.0), row("two", 1e-3, 1.0, cores=2)], self.rms)
        self.assertEqual(front_of([one, two]), [one])

    def test_who_fails_on_a_mesh_is_not_on_the_front(self) -> None:
        rows = [
            row("one", 1e-3, 1.0),
            row("other", 1e-3, 1.0),
            row("one", 1e-3, 1.0, case=case("fandisk")),
            row("other", 1e-3, 1.0, case=case("fandisk"), failure="stopped"),
        ]
        self.assertEqual([one.complete for one in standings(rows, self.rms)], [True, False])

    def test_meshes_without_error_are_left_out(self) -> None:
        rows = [row("one", 1e-3, 0.0, case=case("plane")), row("one", 1e-3, 2.0)]
        (one,) = standings(rows, self.rms)
        self.assertEqual((one.error, one.complete), (1.0, True))


if __name__ == "__main__":
    unittest.main()
