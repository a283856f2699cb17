"""Rows as tables in Markdown."""

from collections.abc import Callable, Sequence

from .contenders import Contender
from .pareto import front
from .rows import Row


def table(header: Sequence[str], lines: Sequence[Sequence[str]], numbers_from: int = 1) -> str:
    """Columns from `numbers_from` on are aligned to the right."""
    alignment = ["---" if place < numbers_from else "--:" for place in range(len(header))]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in [header, alignment, *lines])


def results(rows: Sequence[Row]) -> str:
    """All contenders of one case. Errors on the front of time and error are bold: of those that reached the count,
    on one core."""
    racing = [row for row in rows if row.reached and row.cores == 1]
    by_rms = {racing[place].contender for place in front([(row.seconds, row.rms) for row in racing])}
    by_maximum = {racing[place].contender for place in front([(row.seconds, row.maximum) for row in racing])}
    header = ["", "triangles", "ms", "conversion ms", "Mtri/s", "bytes/tri", "RMS", "maximum"]
    lines = []
    for row in rows:
        if row.failure is not None:
            lines.append([row.contender, f"*{row.failure}*", *[""] * 6])
            continue
        lines.append(
            [
                row.contender,
                f"{row.triangles:,}" + ("" if row.reached else " *missed*"),
                f"{1e3 * row.seconds:,.1f}",
                f"{1e3 * row.conversion_seconds:,.1f}",
                f"{1 / row.microseconds_per_triangle:.2f}",
                _rounded(row.bytes_per_triangle),
                _bold(f"{row.rms:.2e}", row.contender in by_rms),
                _bold(f"{row.maximum:.2e}", row.contender in by_maximum),
            ]
        )
    return table(header, lines)


def by_size(
    rows: Sequence[Row], contenders: Sequence[Contender], value: Callable[[Row], float | None], digits: int
) -> str:
    """A value of each contender on each size of a shape."""
    sizes = sorted({row.case.triangles_in for row in rows})
    found = {(row.contender, row.case.triangles_in): row for row in rows}
    lines = []
    for contender in contenders:
        cells = []
        for size in sizes:
            row = found.get((contender.name, size))
            number = None if row is None or row.failure is not None else value(row)
            missed = "" if number is None or row.reached else " *missed*"
            cells.append("" if number is None else f"{number:,.{digits}f}{missed}")
        lines.append([contender.name, *cells])
    return table(["", *[f"{size:,}" for size in sizes]], lines)


def calls(rows: Sequence[Row], contenders: Sequence[Contender]) -> str:
    """What each contender is, and what it did not do."""
    lines = []
    for contender in contenders:
        its = [row for row in rows if row.contender == contender.name]
        libraries = {row.library for row in its if row.library is not None}
        lines.append([contender.name, ", ".join(sorted(libraries)) or "-", contender.call, _troubles(its)])
    return table(["", "version", "call", "did not"], lines, numbers_from=4)


def _troubles(rows: Sequence[Row]) -> str:
    """Failures, each once, with the meshes; then how often the count was missed."""
    meshes: dict[str, list[str]] = {}
    for row in rows:
        if row.failure is not None:
            its = meshes.setdefault(row.failure, [])
            if row.case.mesh not in its:
                its.append(row.case.mesh)
    whole = {row.case.mesh for row in rows}
    troubles = [failure if set(its) == whole else f"{', '.join(its)}: {failure}" for failure, its in meshes.items()]
    missed = sum(row.failure is None and not row.reached for row in rows)
    if missed:
        troubles.append(f"missed the count in {missed} of {len(rows)} cases")
    return "; ".join(troubles)


def _rounded(value: float | None) -> str:
    return "" if value is None else f"{value:,.0f}"


def _bold(text: str, bold: bool) -> str:
    return f"**{text}**" if bold else text
