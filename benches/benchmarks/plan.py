"""What is measured, and how thoroughly: everything that decides about how long it takes."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from .meshes import Cabinet, Mesh
from .rows import Case

LIBCGAL_DEMO = ("refined_elephant", "bunny00", "armadillo", "fandisk_large", "mannequin-devil")
SIZES = (62_500, 250_000, 1_000_000, 4_000_000)


@dataclass(frozen=True)
class Plan:
    archived: Sequence[str]
    """Meshes of the archive to compare errors on."""
    percents: Sequence[float]
    """What to leave of them."""
    sizes: Sequence[int]
    """Triangles of the statues to see the time of a triangle grow on, to a tenth."""
    runs: int
    """Of a contender in a case, at most ..."""
    seconds: float
    """... and not once more after these."""
    limit: float
    """Seconds that a contender may take for a case, reading and writing included."""
    samples: int
    """Of the distance, a side."""


FULL = Plan(LIBCGAL_DEMO, (10.0, 1.0), SIZES, runs=5, seconds=1.5, limit=60.0, samples=200_000)
QUICK = Plan(LIBCGAL_DEMO[-1:], (10.0,), (20_000,), runs=1, seconds=0.0, limit=60.0, samples=50_000)


def cases(plan: Plan, cabinet: Cabinet, given: Sequence[Mesh]) -> Iterator[tuple[Mesh, Case]]:
    """In their order: small meshes tell what large ones will take."""
    for mesh in [*map(cabinet.archived, plan.archived), *given]:
        for percent in plan.percents:
            yield mesh, _case(mesh, "errors", percent)
    for size in plan.sizes:
        mesh = cabinet.statue(size)
        yield mesh, _case(mesh, "sizes", 10.0)


def _case(mesh: Mesh, series: str, percent: float) -> Case:
    return Case(mesh.name, mesh.triangles, max(1, int(mesh.triangles * percent / 100)), series, percent)
