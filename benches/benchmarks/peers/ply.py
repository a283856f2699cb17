"""Meshes from and to the binary PLY files that decimesh writes of bare meshes, and no others."""

from pathlib import Path

import numpy as np

from . import Positions, Triangles

_VERTEX = np.dtype("<f4")
_FACE = np.dtype([("count", "u1"), ("corners", "<i4", 3)])


def read(path: Path) -> tuple[Positions, Triangles]:
    """Raises `ValueError` where the file is any other PLY."""
    contents = path.read_bytes()
    head, _, body = contents.partition(b"end_header\n")
    lines = [line for line in head.decode("ascii").splitlines() if not line.startswith("comment")]
    counts = [int(line.split()[-1]) for line in lines if line.startswith("element")]
    if len(counts) != 2 or lines != _header(*counts):
        raise ValueError(f"{path} is no binary PLY of positions and triangles alone")
    vertices, faces = counts
    positions = np.frombuffer(body, _VERTEX, 3 * vertices).reshape(-1, 3)
    triangles = np.frombuffer(body, _FACE, faces, offset=positions.nbytes)["corners"]
    return positions.astype(np.float32), triangles.astype(np.int32)


def write(path: Path, positions: Positions, triangles: Triangles) -> None:
    faces = np.empty(len(triangles), _FACE)
    faces["count"] = 3
    faces["corners"] = triangles
    head = "\n".join([*_header(len(positions), len(triangles)), "end_header\n"])
    path.write_bytes(head.encode("ascii") + np.ascontiguousarray(positions, _VERTEX).tobytes() + faces.tobytes())


def _header(vertices: int, faces: int) -> list[str]:
    return [
        "ply",
        "format binary_little_endian 1.0",
        f"element vertex {vertices}",
        "property float x",
        "property float y",
        "property float z",
        f"element face {faces}",
        "property list uchar int vertex_indices",
    ]
