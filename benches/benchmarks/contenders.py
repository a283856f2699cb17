"""Who competes. A new contender is a row here, and what it calls: in `peers/`, or in C++ beside
`cpp-tests/comparisons/peers.cpp`, under the same name."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Contender:
    """A library's function with its settings."""

    name: str
    """What it is called here, by the worker and in the report."""
    family: str
    """Whose it is: the report draws a family in one colour."""
    call: str
    """What is called, and with what."""
    module: str | None = None
    """The module of `peers/` that calls it; otherwise the C++ program does."""
    cores: int = 1


CONTENDERS = (
    Contender("decimesh, 1 thread", "decimesh", "`decimesh_simplify`, defaults"),
    Contender("decimesh, 2 threads", "decimesh", "`decimesh_simplify`, defaults", cores=2),
    Contender("meshoptimizer simplify", "meshoptimizer", "`meshopt_simplify`: keeps the vertices where they are"),
    Contender("meshoptimizer simplifyWithUpdate", "meshoptimizer", "`meshopt_simplifyWithUpdate`"),
    Contender("meshoptimizer simplifySloppy", "meshoptimizer", "`meshopt_simplifySloppy`: clusters, any topology"),
    Contender("CGAL Lindstrom-Turk", "CGAL", "`edge_collapse`, default cost and placement"),
    Contender("CGAL Garland-Heckbert", "CGAL", "`edge_collapse`, `GarlandHeckbert_plane_policies`"),
    Contender("OpenMesh quadric", "OpenMesh", "`DecimaterT`, `ModQuadricT`"),
    Contender("OpenMesh multiple choice", "OpenMesh", "`McDecimaterT`, `ModQuadricT`"),
    Contender("MeshLab", "MeshLab", "`meshing_decimation_quadric_edge_collapse`, defaults", "meshlab"),
    Contender("fast-simplification", "fast-simplification", "`simplify`, defaults (`agg=7`)", "fast_simplification"),
    Contender(
        "fast-simplification, agg 3",
        "fast-simplification",
        "`simplify`, `agg=3`: closer; stops at an error that depends on the unit of length",
        "fast_simplification",
    ),
    Contender("pyfqmr", "pyfqmr", "`simplify_mesh`, defaults (`aggressiveness=7`)", "pyfqmr"),
    Contender(
        "pyfqmr, aggressiveness 3",
        "pyfqmr",
        "`simplify_mesh`, `aggressiveness=3`, `preserve_border=True`; stops likewise",
        "pyfqmr",
    ),
    Contender("VTK quadric", "VTK", "`vtkQuadricDecimation`, defaults", "vtk"),
    Contender("VTK DecimatePro", "VTK", "`vtkDecimatePro`, defaults", "vtk"),
    Contender("Open3D", "Open3D", "`simplify_quadric_decimation`, defaults", "open3d"),
    Contender("libigl qslim", "libigl", "`qslim`", "libigl"),
    Contender("libigl decimate", "libigl", "`decimate`: shortest edges, midpoints", "libigl"),
    Contender("MeshLib", "MeshLib", "`decimateMesh`, `MinimizeError`, no limit of error", "meshlib"),
)
