"""Open3D."""

import numpy as np
import open3d

from . import Positions, Triangles

DISTRIBUTION = "open3d-cpu"
TriangleMesh = open3d.geometry.TriangleMesh


class Quadric:
    def load(self, positions: Positions, triangles: Triangles) -> TriangleMesh:
        return TriangleMesh(
            open3d.utility.Vector3dVector(positions.astype(np.float64)), open3d.utility.Vector3iVector(triangles)
        )

    def simplify(self, held: TriangleMesh, count: int) -> TriangleMesh:
        return held.simplify_quadric_decimation(count)

    def unload(self, held: TriangleMesh) -> tuple[np.ndarray, np.ndarray]:
        return np.asarray(held.vertices), np.asarray(held.triangles)


SIMPLIFIERS = {"Open3D": Quadric()}
