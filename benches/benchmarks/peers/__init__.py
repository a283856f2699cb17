"""Simplifiers with an interface in Python, a module for each library.

Each module has `DISTRIBUTION`, the name of its package, and `SIMPLIFIERS`, which are known by the names of
`contenders.py`. `python -m benchmarks.peers` runs one of them in a process of its own.
"""

from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

Positions = NDArray[np.float32]
"""A row of three coordinates for each vertex."""
Triangles = NDArray[np.int32]
"""A row of three vertices for each triangle."""


class Simplifier(Protocol):
    """What a library does, in the three steps that are timed apart."""

    def load(self, positions: Positions, triangles: Triangles) -> Any:
        """The library's own form of the mesh."""

    def simplify(self, held: Any, count: int) -> Any:
        """Leaves `count` triangles, or what the library gets to. May change `held`."""

    def unload(self, held: Any) -> tuple[NDArray[Any], NDArray[Any]]:
        """Positions and triangles of what `simplify` returned."""
