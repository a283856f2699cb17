"""Who is beaten by nobody in both of two measures, and means over meshes that make measures comparable."""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from .rows import Row


@dataclass(frozen=True)
class Standing:
    """Where a contender stands over all meshes: geometric means."""

    contender: str
    microseconds: float
    """Of a triangle of the input."""
    error: float
    """A multiple of the least on each mesh, among those that reached the count."""
    cores: int
    complete: bool
    """Whether it reached the count on every mesh. Otherwise the means are over those on which it gave anything."""


def front(points: Sequence[tuple[float, float]]) -> list[int]:
    """The places of the points to which no other is better in one coordinate and at least as good in the other,
    from the least first coordinate to the greatest. Of equal points the first stands for all."""
    best = math.inf
    places = []
    for place in sorted(range(len(points)), key=lambda place: (points[place], place)):
        if points[place][1] < best:
            best = points[place][1]
            places.append(place)
    return places


def geometric_mean(values: Iterable[float]) -> float:
    logarithms = [math.log(value) for value in values]
    return math.exp(sum(logarithms) / len(logarithms))


def standings(rows: Sequence[Row], error: Callable[[Row], float | None]) -> list[Standing]:
    """The contenders' standings on the meshes of `rows`, each mesh once, in the rows' order. Meshes on which nobody
    reached the count, or somebody made no error at all, say nothing about ratios and are left out."""
    best: dict[str, float] = {}
    for row in rows:
        value = error(row)
        if row.reached and value is not None:
            best[row.case.mesh] = min(value, best.get(row.case.mesh, math.inf))
    best = {mesh: value for mesh, value in best.items() if value > 0}

    measured: dict[str, list[Row]] = {}
    for row in rows:
        if row.case.mesh in best and row.failure is None and error(row) is not None:
            measured.setdefault(row.contender, []).append(row)
    return [
        Standing(
            contender,
            geometric_mean(row.microseconds_per_triangle for row in its),
            geometric_mean(error(row) / best[row.case.mesh] for row in its),
            its[0].cores,
            sum(row.reached for row in its) == len(best),
        )
        for contender, its in measured.items()
    ]


def front_of(standings: Sequence[Standing]) -> list[Standing]:
    """Those on the front of time and error, of the complete ones on one core: two cores are another race."""
    racing = [standing for standing in standings if standing.complete and standing.cores == 1]
    return [racing[place] for place in front([(one.microseconds, one.error) for one in racing])]
