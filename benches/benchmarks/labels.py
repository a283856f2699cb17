"""Where labels of points go, so that they cover neither points nor lines nor each other.

Christensen, Marks and Shieber, "An Empirical Study of Algorithms for Point-Feature Label Placement", ACM Transactions
on Graphics 14(3), 1995: their discrete gradient descent. Each label has a choice of places around its point,
and goes to the one that costs least while the others stay, until none does. Departures: places at several distances,
for crowds of points with long labels, and labels in turns rather than the best move of all, which is enough for some
dozens. All lengths are in one unit, pixels say.
"""

import itertools
import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

Point = tuple[float, float]

DIRECTIONS = 24
DISTANCES = (3.0, 8.0, 16.0, 28.0, 44.0, 64.0)
"""Of a label from the box of its marker."""
MARGIN = 2.0
"""That labels keep to what they may not cover."""
ROUNDS = 20
"""Labels settle in far fewer; but two might give way to each other forever."""


class Box(NamedTuple):
    left: float
    bottom: float
    right: float
    top: float

    def grown(self, by: float) -> "Box":
        return Box(self.left - by, self.bottom - by, self.right + by, self.top + by)

    def overlap(self, other: "Box") -> float:
        """The area that both cover."""
        width = min(self.right, other.right) - max(self.left, other.left)
        height = min(self.top, other.top) - max(self.bottom, other.bottom)
        return max(0.0, width) * max(0.0, height)

    def outside(self, frame: "Box") -> float:
        """By how much it sticks out of the frame."""
        sides = (frame.left - self.left, frame.bottom - self.bottom, self.right - frame.right, self.top - frame.top)
        return sum(max(0.0, side) for side in sides)

    def crossed(self, a: Point, b: Point) -> bool:
        """Whether the segment from `a` to `b` enters it (Liang and Barsky's clipping)."""
        enters, leaves = 0.0, 1.0
        for low, high, begin, end in ((self.left, self.right, a[0], b[0]), (self.bottom, self.top, a[1], b[1])):
            if begin == end:
                if not low < begin < high:
                    return False
                continue
            first, last = sorted(((low - begin) / (end - begin), (high - begin) / (end - begin)))
            enters, leaves = max(enters, first), min(leaves, last)
        return enters < leaves


def place(markers: Sequence[Box], sizes: Sequence[Point], line: Sequence[Point], frame: Box) -> list[Box]:
    """A box of its size (width, height) for each marker's label: in the frame, beside markers and labels, and across
    the line and the ways from other labels to their markers only where there is no other place."""
    choices = [list(_around(marker, size)) for marker, size in zip(markers, sizes, strict=True)]
    boxes = [its[0] for its in choices]
    for _ in range(ROUNDS):
        moved = False
        for label, places in enumerate(choices):
            costs = [_cost(label, box, boxes, markers, line, frame) for box in places]
            best = places[costs.index(min(costs))]
            moved |= best != boxes[label]
            boxes[label] = best
        if not moved:
            break
    return boxes


def spread(heights: Sequence[float], step: float, top: float) -> list[float]:
    """Heights in the same, ascending order, `step` apart at the least and none above `top`: pushed up where they
    crowd, and down again from the top."""
    spread: list[float] = []
    for height in heights:
        spread.append(max(height, spread[-1] + step) if spread else height)
    ceiling = top
    for place in reversed(range(len(spread))):
        spread[place] = min(spread[place], ceiling)
        ceiling = spread[place] - step
    return spread


def nearest(box: Box, point: Point) -> Point:
    """The point of the box that is nearest."""
    return min(max(point[0], box.left), box.right), min(max(point[1], box.bottom), box.top)


def middle(box: Box) -> Point:
    return (box.left + box.right) / 2, (box.bottom + box.top) / 2


def _around(marker: Box, size: Point) -> Iterator[Box]:
    """Boxes in all directions, to the right first, that touch a grown marker from outside."""
    x, y = middle(marker)
    width, height = size
    for distance in DISTANCES:
        grown = marker.grown(distance)
        across = (grown.right - grown.left + width) / 2
        up = (grown.top - grown.bottom + height) / 2
        for direction in range(DIRECTIONS):
            angle = 2 * math.pi * direction / DIRECTIONS
            # On the edges of the box around the marker on which the middle of a label that touches it lies.
            scale = min(_over(across, abs(math.cos(angle))), _over(up, abs(math.sin(angle))))
            left = x + scale * math.cos(angle) - width / 2
            bottom = y + scale * math.sin(angle) - height / 2
            yield Box(left, bottom, left + width, bottom + height)


def _over(length: float, share: float) -> float:
    return length / share if share > 1e-9 else math.inf


def _cost(
    label: int, box: Box, boxes: Sequence[Box], markers: Sequence[Box], line: Sequence[Point], frame: Box
) -> float:
    """In units of length: what a place is worth going out of the way for."""
    point = middle(markers[label])
    end = nearest(box, point)
    cost = math.dist(point, end) + 100.0 * box.outside(frame)
    wide = box.grown(MARGIN)
    for other, (marker, placed) in enumerate(zip(markers, boxes, strict=True)):
        overlap = wide.overlap(marker)
        if other != label:
            overlap += wide.overlap(placed)
            # Its way to its point past this label, and this one's past it and its marker.
            there = middle(marker)
            ways = wide.crossed(there, nearest(placed, there)) + placed.crossed(point, end)
            cost += 60.0 * ways + 30.0 * marker.crossed(point, end)
        if overlap > 0.0:
            cost += 200.0 + overlap
    for a, b in itertools.pairwise(line):
        cost += 90.0 * wide.crossed(a, b)
    return cost
