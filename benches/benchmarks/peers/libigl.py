"""libigl. It takes and gives matrices, in double precision."""

from collections.abc import Callable
from dataclasses import dataclass

import igl
import numpy as np

from . import Positions, Triangles

DISTRIBUTION = "libigl"
Matrices = tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True)
class Decimation:
    function: Callable[..., tuple]

    def load(self, positions: Positions, triangles: Triangles) -> Matrices:
        return np.asfortranarray(positions, np.float64), np.asfortranarray(triangles)

    def simplify(self, held: Matrices, count: int) -> Matrices:
        positions, triangles, *_births = self.function(*held, count)
        return positions, triangles

    def unload(self, held: Matrices) -> Matrices:
        return held


SIMPLIFIERS = {"libigl qslim": Decimation(igl.qslim), "libigl decimate": Decimation(igl.decimate)}
