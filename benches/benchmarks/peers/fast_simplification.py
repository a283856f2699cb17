"""fast-simplification. It takes and gives arrays: there is nothing to load."""

from dataclasses import dataclass

import fast_simplification

from . import Positions, Triangles

DISTRIBUTION = "fast-simplification"
Arrays = tuple[Positions, Triangles]


@dataclass(frozen=True)
class FastQuadric:
    aggressiveness: float

    def load(self, positions: Positions, triangles: Triangles) -> Arrays:
        return positions, triangles

    def simplify(self, held: Arrays, count: int) -> Arrays:
        return fast_simplification.simplify(*held, target_count=count, agg=self.aggressiveness)

    def unload(self, held: Arrays) -> Arrays:
        return held


SIMPLIFIERS = {"fast-simplification": FastQuadric(7.0), "fast-simplification, agg 3": FastQuadric(3.0)}
