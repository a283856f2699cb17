"""Rows to test with."""

from benchmarks.rows import Case, Row


def case(mesh: str = "bunny", triangles_in: int = 1000, wanted: int = 100, series: str = "errors") -> Case:
    return Case(mesh, triangles_in, wanted, series, 10.0)


def row(contender: str, seconds: float, rms: float, maximum: float | None = None, **values: object) -> Row:
    its = {"case": case(), "triangles": 100, "peak_bytes": 50_000, "library": f"{contender} 1.0"} | values
    return Row(
        contender=contender,
        load_seconds=[0.25],
        simplify_seconds=[2 * seconds, seconds],
        unload_seconds=[0.5],
        rms=rms,
        maximum=10 * rms if maximum is None else maximum,
        **its,
    )
