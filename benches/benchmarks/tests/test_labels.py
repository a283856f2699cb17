"""Places of labels, and the geometry that they are judged by."""

import itertools
import random
import unittest

from benchmarks.labels import Box, middle, nearest, place, spread

FRAME = Box(0.0, 0.0, 800.0, 500.0)


def marker(x: float, y: float) -> Box:
    return Box(x, y, x, y).grown(5.0)


class Geometry(unittest.TestCase):
    def test_a_segment_crosses_a_box_where_one_of_its_points_is_inside(self) -> None:
        draw = random.Random(1)
        box = Box(2.0, 3.0, 5.0, 4.0)
        seen = {True: 0, False: 0}
        for _ in range(2000):
            # Few places, so that segments along sides and through corners come up.
            a, b = ((draw.randrange(8), draw.randrange(8)) for _ in range(2))
            points = [(a[0] + (b[0] - a[0]) * k / 840, a[1] + (b[1] - a[1]) * k / 840) for k in range(841)]
            inside = any(box.left < x < box.right and box.bottom < y < box.top for x, y in points)
            self.assertEqual(box.crossed(a, b), inside, (a, b))
            seen[inside] += 1
        self.assertGreater(min(seen.values()), 100)

    def test_overlap_is_an_area(self) -> None:
        box = Box(0.0, 0.0, 4.0, 4.0)
        self.assertEqual(box.overlap(Box(3.0, 2.0, 9.0, 9.0)), 2.0)
        self.assertEqual(box.overlap(Box(4.0, 0.0, 9.0, 4.0)), 0.0)

    def test_outside_is_how_far(self) -> None:
        self.assertEqual(Box(-1.0, 1.0, 3.0, 502.0).outside(FRAME), 3.0)
        self.assertEqual(FRAME.outside(FRAME), 0.0)


class Placing(unittest.TestCase):
    def test_covers_nothing_where_there_is_room(self) -> None:
        for seed in range(4):
            draw = random.Random(seed)
            markers = [marker(draw.uniform(10, 790), draw.uniform(10, 490)) for _ in range(15)]
            sizes = [(draw.uniform(30, 150), 12.0) for _ in markers]
            placed = place(markers, sizes, [], FRAME)
            for box, (width, height) in zip(placed, sizes, strict=True):
                self.assertAlmostEqual(box.right - box.left, width)
                self.assertAlmostEqual(box.top - box.bottom, height)
                self.assertEqual(box.outside(FRAME), 0.0)
                self.assertTrue(all(box.overlap(other) == 0.0 for other in markers), seed)
            for one, other in itertools.combinations(placed, 2):
                self.assertEqual(one.overlap(other), 0.0, seed)

    def test_keeps_off_a_line_that_passes_the_point(self) -> None:
        markers = [marker(400.0, 250.0)]
        line = [(100.0, 250.0), (700.0, 250.0)]
        (box,) = place(markers, [(100.0, 12.0)], line, FRAME)
        self.assertFalse(box.crossed(*line))

    def test_stays_near_a_point_that_is_alone(self) -> None:
        (box,) = place([marker(400.0, 250.0)], [(100.0, 12.0)], [], FRAME)
        x, y = nearest(box, middle(marker(400.0, 250.0)))
        self.assertLess(abs(x - 400.0) + abs(y - 250.0), 10.0)


class Spreading(unittest.TestCase):
    def test_keeps_apart_and_below_the_top(self) -> None:
        draw = random.Random(2)
        for _ in range(200):
            heights = sorted(draw.random() for _ in range(draw.randrange(12)))
            placed = spread(heights, step=0.05, top=1.0)
            self.assertEqual(len(placed), len(heights))
            self.assertTrue(all(height <= 1.0 for height in placed))
            for low, high in itertools.pairwise(placed):
                self.assertGreaterEqual(high - low, 0.05 - 1e-12)

    def test_leaves_alone_what_has_room(self) -> None:
        self.assertEqual(spread([0.1, 0.5, 0.9], step=0.05, top=1.0), [0.1, 0.5, 0.9])


if __name__ == "__main__":
    unittest.main()
