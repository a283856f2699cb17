"""MeshLib."""

import numpy as np
from meshlib import mrmeshnumpy, mrmeshpy

from . import Positions, Triangles

DISTRIBUTION = "meshlib-core"


class Decimation:
    def load(self, positions: Positions, triangles: Triangles) -> mrmeshpy.Mesh:
        return mrmeshnumpy.meshFromFacesVerts(triangles, positions)

    def simplify(self, held: mrmeshpy.Mesh, count: int) -> mrmeshpy.Mesh:
        settings = mrmeshpy.DecimateSettings()
        settings.strategy = mrmeshpy.DecimateStrategy.MinimizeError
        settings.maxDeletedFaces = held.topology.numValidFaces() - count
        # The count is what shall stop it, not the distance that is its default.
        settings.maxError = float(np.finfo(np.float32).max)
        settings.packMesh = True
        mrmeshpy.decimateMesh(held, settings)
        return held

    def unload(self, held: mrmeshpy.Mesh) -> tuple[np.ndarray, np.ndarray]:
        return mrmeshnumpy.getNumpyVerts(held), mrmeshnumpy.getNumpyFaces(held.topology)


SIMPLIFIERS = {"MeshLib": Decimation()}
