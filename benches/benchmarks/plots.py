"""The plots, as SVG: the same bytes for the same rows."""

import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import matplotlib

matplotlib.use("svg")

from matplotlib import pyplot
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.text import Annotation, Text
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from . import labels
from .contenders import Contender
from .pareto import Standing, front_of, standings
from .rows import Row, Setting

OURS = "decimesh"
STYLES = {
    OURS: ("#0072b2", "o"),
    "meshoptimizer": ("#d55e00", "s"),
    "CGAL": ("#009e73", "^"),
    "OpenMesh": ("#c2578f", "v"),
    "MeshLab": ("#7f3b08", "D"),
    "fast-simplification": ("#6a51a3", "P"),
    "pyfqmr": ("#882255", "X"),
    "VTK": ("#2b8cbe", "<"),
    "Open3D": ("#666666", ">"),
    "libigl": ("#b8860b", "p"),
    "MeshLib": ("#1b1b1b", "h"),
}
"""Colour and marker of a family: told apart by either, since not everybody sees every colour."""
OTHER = ("#444444", "*")

LOWER_EDGE = 0.85
"""As a multiple of the least error: where those are drawn that missed the count and were closer still."""

MARKER = 8.0
"""Points from side to side."""

TEXT = "#222222"
QUIET = "#8a8a8a"

matplotlib.rcParams.update(
    {
        "font.size": 9,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.edgecolor": QUIET,
        "axes.labelcolor": TEXT,
        "axes.titlesize": 10.5,
        "xtick.color": TEXT,
        "ytick.color": TEXT,
        "text.color": TEXT,
        "grid.color": "#e6e6e6",
        "figure.facecolor": "white",
        "savefig.facecolor": "white",
        "svg.hashsalt": "decimesh",
    }
)


class Panel(NamedTuple):
    """A panel whose labels have no places yet."""

    axes: Axes
    texts: list[Text]
    line: list[labels.Point]

    def place_labels(self) -> None:
        """To be called once the layout of the figure stands."""
        to_pixels = self.axes.transData
        to_data = to_pixels.inverted()
        self.axes.autoscale(False)
        points = [tuple(to_pixels.transform(text.get_position())) for text in self.texts]
        half = 0.5 * MARKER * self.axes.figure.dpi / 72
        boxes = [labels.Box(x - half, y - half, x + half, y + half) for x, y in points]
        sizes = [(extent.width, extent.height) for extent in (text.get_window_extent() for text in self.texts)]
        line = [tuple(to_pixels.transform(point)) for point in self.line]
        placed = labels.place(boxes, sizes, line, labels.Box(*self.axes.bbox.extents))
        for text, point, box in zip(self.texts, points, placed, strict=True):
            text.set_position(to_data.transform((box.left, box.bottom)))
            end = labels.nearest(box, point)
            if math.dist(end, point) > 3 * half:
                way = to_data.transform([point, end])
                self.axes.plot(way[:, 0], way[:, 1], color=QUIET, linewidth=0.6, zorder=1)


def draw(setting: Setting, rows: Sequence[Row], contenders: Sequence[Contender], directory: Path) -> None:
    """Writes the plots of `page.PLOTS`."""
    directory.mkdir(parents=True, exist_ok=True)
    families = {contender.name: contender.family for contender in contenders}
    errors = [row for row in rows if row.case.series == "errors"]
    sizes = [row for row in rows if row.case.series == "sizes" and row.failure is None]
    note = f"{setting['date']}, {setting['processor']}; decimesh at {setting['commit']}"
    _draw_errors(errors, families, lambda row: row.rms, "RMS distance", note, directory / "time-rms.svg")
    _draw_errors(errors, families, lambda row: row.maximum, "maximum distance", note, directory / "time-maximum.svg")
    _draw_sizes(sizes, families, note, directory / "sizes.svg")
    _draw_memory(sizes, families, note, directory / "memory.svg")


def _draw_errors(
    rows: Sequence[Row],
    families: dict[str, str],
    error: Callable[[Row], float | None],
    what: str,
    note: str,
    path: Path,
) -> None:
    percents = sorted({row.case.percent for row in rows}, reverse=True)
    figure, panels = pyplot.subplots(
        len(percents), 1, figsize=(8.6, 5.4 * len(percents)), layout="constrained", squeeze=False
    )
    drawn = []
    for panel, percent in zip(panels[:, 0], percents, strict=True):
        standing = standings([row for row in rows if row.case.percent == percent], error)
        panel.set_title(f"To {percent:g} % of the triangles", loc="left")
        panel.set_xlabel("microseconds per triangle")
        panel.set_ylabel(f"{what}, as a multiple of the least")
        drawn.append(_draw_standings(panel, standing, families))
    _settle(figure, note)
    for panel in drawn:
        panel.place_labels()
    _save(figure, path)


def _draw_standings(panel: Axes, standing: Sequence[Standing], families: dict[str, str]) -> Panel:
    panel.set(xscale="log", yscale="log")
    best = front_of(standing)
    panel.plot([one.microseconds for one in best], [one.error for one in best], color=QUIET, linewidth=1.2, zorder=1)
    texts = []
    for one in standing:
        colour, marker = STYLES.get(families[one.contender], OTHER)
        # Whoever left too many triangles may be far closer than all others: that says nothing, and takes no room.
        point = (one.microseconds, one.error if one.complete else max(one.error, LOWER_EDGE))
        fill = colour if one.complete else "white"
        panel.plot(
            *point, marker=marker, markersize=MARKER, color=colour, markerfacecolor=fill, linestyle="none", zorder=2
        )
        text = one.contender if one.complete else f"{one.contender} (missed)"
        weight = "bold" if one in best else "normal"
        label = panel.text(*point, text, color=colour, weight=weight, size=8.5, va="bottom")
        # Where it stands for now shall not make room for it.
        label.set_in_layout(False)
        texts.append(label)
    panel.margins(0.12)
    _plain_ticks(panel.xaxis)
    _plain_ticks(panel.yaxis)
    panel.grid(True, which="both", linewidth=0.5)
    panel.set_axisbelow(True)
    return Panel(panel, texts, [(one.microseconds, one.error) for one in best])


def _draw_sizes(rows: Sequence[Row], families: dict[str, str], note: str, path: Path) -> None:
    figure, panel = pyplot.subplots(figsize=(8.6, 6.2), layout="constrained")
    panel.set(xscale="log", yscale="log", xlabel="triangles of the input", ylabel="microseconds per triangle")
    panel.set_title("Statues to 10 % of their triangles", loc="left")
    ends = []
    for name, its in _by_contender(rows).items():
        colour, marker = STYLES.get(families[name], OTHER)
        its = sorted(its, key=lambda row: row.case.triangles_in)
        x = [row.case.triangles_in for row in its]
        y = [row.microseconds_per_triangle for row in its]
        panel.plot(x, y, color=colour, linewidth=2 if families[name] == OURS else 1.2)
        for row in its:
            fill = colour if row.reached else "white"
            at = (row.case.triangles_in, row.microseconds_per_triangle)
            panel.plot(*at, marker=marker, markersize=5, color=colour, markerfacecolor=fill)
        weight = "bold" if families[name] == OURS else "normal"
        text = panel.annotate(
            _name(its[-1]),
            (x[-1], y[-1]),
            xytext=(1.03, 0.5),
            textcoords="axes fraction",
            color=colour,
            weight=weight,
            size=8.5,
            va="center",
            arrowprops={"arrowstyle": "-", "color": colour, "linewidth": 0.5, "alpha": 0.6, "relpos": (0.0, 0.5)},
            annotation_clip=False,
        )
        ends.append(text)
    panel.grid(True, which="both", linewidth=0.5)
    panel.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,.0f}"))
    panel.xaxis.set_minor_formatter(NullFormatter())
    _plain_ticks(panel.yaxis)
    _label_ends(panel, ends)
    _settle(figure, note)
    _save(figure, path)


def _label_ends(panel: Axes, ends: Sequence[Annotation]) -> None:
    """Names at the right, in the order of the lines' ends, as near to them as they can be without overlap."""
    # Limits are found when they are asked for; what is drawn from here on shall not change them.
    panel.set(xlim=panel.get_xlim(), ylim=panel.get_ylim())
    to_axes = panel.transData + panel.transAxes.inverted()
    upward = sorted((to_axes.transform(end.xy)[1], place) for place, end in enumerate(ends))
    heights = labels.spread([height for height, _ in upward], step=0.036, top=1.0)
    for (_, place), height in zip(upward, heights, strict=True):
        ends[place].set_position((1.03, height))


def _draw_memory(rows: Sequence[Row], families: dict[str, str], note: str, path: Path) -> None:
    largest = [max(its, key=lambda row: row.case.triangles_in) for its in _by_contender(rows).values()]
    bars = sorted((row for row in largest if row.bytes_per_triangle), key=lambda row: -row.bytes_per_triangle)
    figure, panel = pyplot.subplots(figsize=(8.6, 0.29 * len(bars) + 1.3), layout="constrained")
    names = [_name(row) for row in bars]
    values = [row.bytes_per_triangle for row in bars]
    drawn = panel.barh(
        names, values, height=0.72, color=[STYLES.get(families[row.contender], OTHER)[0] for row in bars]
    )
    largest_size = max((row.case.triangles_in for row in bars), default=0)
    panel.set_title(f"On a statue of {largest_size:,} triangles, or the largest that was done", loc="left")
    sizes = ["" if row.case.triangles_in == largest_size else f" (of {row.case.triangles_in:,})" for row in bars]
    texts = [f"{value:,.0f}{size}" for value, size in zip(values, sizes, strict=True)]
    panel.bar_label(drawn, texts, padding=4, size=8.5)
    panel.set_xlabel("bytes per triangle of the input, beyond the input")
    panel.set_xlim(0, 1.22 * max(values, default=1.0))
    panel.tick_params(axis="y", length=0)
    panel.grid(True, axis="x", linewidth=0.5)
    panel.set_axisbelow(True)
    panel.spines["left"].set_visible(False)
    _settle(figure, note)
    _save(figure, path)


def _name(row: Row) -> str:
    return row.contender if row.reached else f"{row.contender} (missed)"


def _by_contender(rows: Sequence[Row]) -> dict[str, list[Row]]:
    groups: dict[str, list[Row]] = {}
    for row in rows:
        groups.setdefault(row.contender, []).append(row)
    return groups


def _plain_ticks(axis: Axis) -> None:
    """Numbers as people write them, at 1, 2 and 5."""
    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def _settle(figure: Figure, note: str) -> None:
    """Adds the note, and lets the layout stand as it is from here on."""
    figure.supxlabel(note, size=7.5, color=QUIET, x=0.01, ha="left")
    # Text is a little wider in the file than on the screen that the layout is made for.
    figure.get_layout_engine().set(w_pad=0.12)
    figure.draw_without_rendering()
    figure.set_layout_engine("none")


def _save(figure: Figure, path: Path) -> None:
    figure.savefig(path, metadata={"Date": None})
    pyplot.close(figure)
