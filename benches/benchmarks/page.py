"""The page: what was measured, on what and how, with plots and all figures."""

import textwrap
from collections.abc import Sequence

from . import tables
from .contenders import Contender
from .rows import MOST_ABOVE, MOST_BELOW, Row, Setting

PLOTS = {
    "time-rms.svg": "Time against RMS distance, geometric means over the meshes",
    "time-maximum.svg": "Time against maximum distance, geometric means over the meshes",
    "sizes.svg": "Microseconds per triangle against the size of the mesh",
    "memory.svg": "Peak memory added by a call, per triangle",
}
"""The plots of the page, and what they show."""


def page(setting: Setting, rows: Sequence[Row], contenders: Sequence[Contender], plots: str) -> str:
    """`plots` is the directory of the plots, seen from the page."""
    errors = [row for row in rows if row.case.series == "errors"]
    sizes = [row for row in rows if row.case.series == "sizes"]
    parts = [
        "# Benchmarks",
        _introduction(setting),
        "## Time against error",
        _errors_text(errors),
        _picture("time-rms.svg", plots),
        _picture("time-maximum.svg", plots),
        "## Linear time",
        _paragraph(
            "One shape in several sizes, the statue of `decimesh demo`, to a tenth of its triangles. Hollow: missed "
            "the count. A line that ends early would have gone past the limit of time."
        ),
        _picture("sizes.svg", plots),
        "Microseconds per triangle of the input:",
        tables.by_size(sizes, contenders, lambda row: row.microseconds_per_triangle, digits=2),
        "## Memory",
        _paragraph(
            "The same runs on the largest statue that a contender did. Peak of resident memory that loading and the "
            "call add to the process, beyond the input's own positions and indices, which are 18 bytes a triangle."
        ),
        _picture("memory.svg", plots),
        _paragraph(
            "Bytes per triangle of the input. Where the mesh is small, pages that have little to do with it count too:"
        ),
        tables.by_size(sizes, contenders, lambda row: row.bytes_per_triangle, digits=0),
        "## Contenders",
        _contenders_text(),
        tables.calls(rows, contenders),
        "## All figures",
        _paragraph(
            "RMS and maximum are shares of the diagonal. Bold: nobody who reached the count on one core is as "
            "fast and as close."
        ),
    ]
    for case in dict.fromkeys(row.case for row in rows):
        parts.append(f"### {case.mesh}: {case.triangles_in:,} to {case.wanted:,}")
        parts.append(tables.results([row for row in rows if row.case == case]))
    return "\n\n".join(parts) + "\n"


def _paragraph(text: str) -> str:
    return textwrap.fill(text, 120, break_long_words=False, break_on_hyphens=False)


def _introduction(setting: Setting) -> str:
    plan = setting["plan"]
    quick = " A quick run: it shows that all works, not how fast." if setting["quick"] else ""
    paragraphs = [
        "`scripts/benchmarks.sh` installs the libraries, runs them all, and writes this page, its plots and "
        "[all rows](benchmarks/rows.jsonl). `--quick` does so with one small mesh; further meshes can be given as "
        "files.",
        f"decimesh at {setting['commit']}, {setting['date']}; {setting['processor']}, {setting['cores']} cores, "
        f"{setting['gibibytes']} GiB, {setting['system']}, Python {setting['python']}. The machine's load was "
        f"{setting['load']} when it began.{quick}",
        "Each contender works on each mesh in a process of its own, on one core (decimesh with two threads: on two), "
        f"after a small mesh to warm up. Times are those of the fastest of up to {plan['runs']} calls, none begun "
        f"after {plan['seconds']:g} s; a process is stopped after {plan['limit']:g} s. They are times of the call "
        "alone: what it takes to bring positions and indices into the library's own form and back is *conversion*, "
        "and left out of all plots, in favour of those who have such a form.",
        "Distances are those of `decimesh compare` for everybody: two-sided, of the original's and the result's "
        f"surface, {plan['samples']:,} samples a side and all vertices, over the diagonal of the original's box. The "
        f"count is missed by more than {100 * MOST_ABOVE:.0f} % too many triangles, or {100 * MOST_BELOW:.0f} % too "
        "few.",
    ]
    return "\n\n".join(map(_paragraph, paragraphs))


def _errors_text(rows: Sequence[Row]) -> str:
    meshes = dict.fromkeys(f"{row.case.mesh} ({row.case.triangles_in:,} triangles)" for row in rows)
    return _paragraph(
        f"On {', '.join(meshes)}: errors as multiples of the least on each mesh, and geometric means of those and of "
        "the times over the meshes. Lower and further left is better. On the line are those to whom nobody on one "
        "core comes as near in as little time. Hollow: missed the count on a mesh, or did not do it, and so is not "
        "on the line; whoever seems closer than all others by leaving more triangles stands at the lower edge."
    )


def _contenders_text() -> str:
    return _paragraph(
        "CGAL (in double precision) and OpenMesh (in single) are Debian's; meshoptimizer is that of the crate "
        "`meshopt`; the others are wheels from PyPI. Debian's OpenMesh is built with its assertions, which compare "
        "type names at each access to a status: built without, its quadric decimater takes about a fifth of the "
        "time given here, the multiple choice one a quarter."
    )


def _picture(name: str, plots: str) -> str:
    return f"![{PLOTS[name]}]({plots}/{name})"
