"""pyfqmr."""

from dataclasses import dataclass

import numpy as np
import pyfqmr

from . import Positions, Triangles

DISTRIBUTION = "pyfqmr"


@dataclass(frozen=True)
class FastQuadric:
    aggressiveness: float
    preserve_border: bool

    def load(self, positions: Positions, triangles: Triangles) -> pyfqmr.Simplify:
        mesh = pyfqmr.Simplify()
        mesh.setMesh(positions.astype(np.float64), triangles)
        return mesh

    def simplify(self, held: pyfqmr.Simplify, count: int) -> pyfqmr.Simplify:
        held.simplify_mesh(
            target_count=count,
            aggressiveness=self.aggressiveness,
            preserve_border=self.preserve_border,
            verbose=False,
        )
        return held

    def unload(self, held: pyfqmr.Simplify) -> tuple[np.ndarray, np.ndarray]:
        positions, triangles, _normals = held.getMesh()
        return positions, triangles


SIMPLIFIERS = {
    "pyfqmr": FastQuadric(7, preserve_border=False),
    "pyfqmr, aggressiveness 3": FastQuadric(3, preserve_border=True),
}
