"""What was measured: a file of JSON lines, the setting first, then a row for each contender and case."""

import json
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path
from typing import Any

Setting = dict[str, Any]

MOST_ABOVE = 0.01
MOST_BELOW = 0.1
"""By how much of the triangles wanted a result may be off and still count as what was asked for. Whoever leaves more
has it easier; whoever leaves fewer has it harder, and gains nothing by it."""


@dataclass(frozen=True)
class Case:
    """A mesh, and how many triangles shall be left of it."""

    mesh: str
    triangles_in: int
    wanted: int
    series: str
    """`"errors"`: for the comparison of errors; `"sizes"`: one of the sizes of one shape."""
    percent: float
    """Of the triangles: what `wanted` is."""


@dataclass(frozen=True)
class Row:
    """What a contender did in a case. A contender that failed has no more than the failure."""

    case: Case
    contender: str
    cores: int = 1
    failure: str | None = None
    library: str | None = None
    load_seconds: list[float] = field(default_factory=list)
    """Of each run: from positions and indices to the library's own form of the mesh."""
    simplify_seconds: list[float] = field(default_factory=list)
    """Of each run: the call alone."""
    unload_seconds: list[float] = field(default_factory=list)
    """Of each run: back to positions and indices."""
    peak_bytes: int | None = None
    """Resident memory that loading and the call added to the process at their highest, where that can be told."""
    triangles: int | None = None
    rms: float | None = None
    """Two-sided, over the diagonal, as all distances here."""
    maximum: float | None = None

    @property
    def seconds(self) -> float:
        """The fastest call."""
        return min(self.simplify_seconds)

    @property
    def conversion_seconds(self) -> float:
        """The fastest way there and back."""
        return min(self.load_seconds) + min(self.unload_seconds)

    @property
    def microseconds_per_triangle(self) -> float:
        return 1e6 * self.seconds / self.case.triangles_in

    @property
    def bytes_per_triangle(self) -> float | None:
        return None if self.peak_bytes is None else self.peak_bytes / self.case.triangles_in

    @property
    def reached(self) -> bool:
        """Whether the result has the triangles that were wanted, and could be measured."""
        if self.triangles is None or self.rms is None:
            return False
        return (
            (1 - MOST_BELOW) * self.case.wanted
            <= self.triangles
            <= max(self.case.wanted + 2, (1 + MOST_ABOVE) * self.case.wanted)
        )


class RowFile:
    """The file, written row by row: what an interruption leaves can be gone on with."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def begin(self, setting: Setting) -> None:
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self.path.write_text(json.dumps({"setting": setting}) + "\n")

    def append(self, row: Row) -> None:
        with self.path.open("a") as file:
            file.write(json.dumps(asdict(row)) + "\n")

    def read(self) -> tuple[Setting, list[Row]]:
        """Raises `ValueError` where it is not such a file. A last line that was cut off is left out, and cut off
        in the file too."""
        text = self.path.read_text()
        whole = text[: text.rfind("\n") + 1]
        if whole != text:
            self.path.write_text(whole)
        lines = [json.loads(line) for line in whole.splitlines()]
        if not lines or "setting" not in lines[0]:
            raise ValueError(f"{self.path} does not begin with the setting of a benchmark")
        return lines[0]["setting"], [_row(line) for line in lines[1:]]


def _row(values: dict[str, Any]) -> Row:
    known = {one.name for one in fields(Row)}
    unknown = values.keys() - known
    if unknown:
        raise ValueError(f"a row with unknown fields: {', '.join(sorted(unknown))}")
    return Row(**{**values, "case": Case(**values["case"])})
