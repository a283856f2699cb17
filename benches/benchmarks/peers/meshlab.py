"""MeshLab's filter, by pymeshlab."""

import numpy as np
import pymeshlab

from . import Positions, Triangles

DISTRIBUTION = "pymeshlab"


class Quadric:
    def load(self, positions: Positions, triangles: Triangles) -> pymeshlab.MeshSet:
        meshes = pymeshlab.MeshSet(verbose=False)
        meshes.add_mesh(pymeshlab.Mesh(positions.astype(np.float64), triangles))
        return meshes

    def simplify(self, held: pymeshlab.MeshSet, count: int) -> pymeshlab.MeshSet:
        held.meshing_decimation_quadric_edge_collapse(targetfacenum=count)
        return held

    def unload(self, held: pymeshlab.MeshSet) -> tuple[np.ndarray, np.ndarray]:
        mesh = held.current_mesh()
        return mesh.vertex_matrix(), mesh.face_matrix()


SIMPLIFIERS = {"MeshLab": Quadric()}
