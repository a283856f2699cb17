"""One contender on one mesh. What it took is printed as one line of JSON, the row that the contenders of C++ print
too (`cpp-tests/comparisons/peers.cpp`). A contender that fails is a row as well."""

import argparse
import importlib
import importlib.metadata
import json
import time
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from . import Positions, Simplifier, Triangles, memory, ply


class Run(NamedTuple):
    load_seconds: float
    simplify_seconds: float
    unload_seconds: float
    peak_bytes: int | None
    positions: Positions
    triangles: Triangles


def run(simplifier: Simplifier, positions: Positions, triangles: Triangles, count: int) -> Run:
    before = memory.begin_peak()
    begin = time.perf_counter()
    held = simplifier.load(positions, triangles)
    loaded = time.perf_counter()
    held = simplifier.simplify(held, count)
    simplified = time.perf_counter()
    # The pages of libraries and of threads come and go beside the counter: it may end below where it began.
    peak = None if before is None else max(0, memory.peak_bytes() - before)
    unloading = time.perf_counter()
    new_positions, new_triangles = simplifier.unload(held)
    end = time.perf_counter()
    return Run(
        loaded - begin,
        simplified - loaded,
        end - unloading,
        peak,
        np.array(new_positions, np.float32),
        np.array(new_triangles, np.int32),
    )


def warming() -> tuple[Positions, Triangles]:
    """Hills over a grid, small: code and tables come into memory when they are first used, which is nobody's price
    for the mesh that is measured."""
    cells = 16
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(cells + 1), np.arange(cells + 1)))
    positions = np.stack([x, y, np.sin(0.7 * x) * np.cos(0.5 * y)], axis=1).astype(np.float32)
    corner = (np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)).ravel()
    a, b, c, d = corner, corner + 1, corner + cells + 2, corner + cells + 1
    triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    return positions, triangles.astype(np.int32)


def measure(arguments: argparse.Namespace) -> dict[str, Any]:
    """The row; the result is in the file that the arguments name."""
    try:
        module = importlib.import_module(f"benchmarks.peers.{arguments.module}")
        version = importlib.metadata.version(module.DISTRIBUTION)
    except ImportError as error:
        return {"failure": f"not installed: {error}"}
    simplifier: Simplifier = module.SIMPLIFIERS[arguments.contender]
    grid = warming()
    run(simplifier, *grid, len(grid[1]) // 2)

    positions, triangles = ply.read(arguments.input)
    begin = time.perf_counter()
    runs = [run(simplifier, positions, triangles, arguments.triangles)]
    while len(runs) < arguments.runs and time.perf_counter() - begin < arguments.seconds:
        runs.append(run(simplifier, positions, triangles, arguments.triangles))
    # The first run's bytes: later ones find free memory that the first has left.
    first = runs[0]
    if len(first.triangles) == 0:
        return {"failure": "left no triangle"}
    ply.write(arguments.output, first.positions, first.triangles)
    return {
        "library": f"{module.DISTRIBUTION} {version}",
        "load_seconds": [round(run.load_seconds, 9) for run in runs],
        "simplify_seconds": [round(run.simplify_seconds, 9) for run in runs],
        "unload_seconds": [round(run.unload_seconds, 9) for run in runs],
        "peak_bytes": first.peak_bytes,
        "triangles": len(first.triangles),
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("module")
    parser.add_argument("contender")
    parser.add_argument("input", type=Path)
    parser.add_argument("output", type=Path)
    parser.add_argument("triangles", type=int)
    parser.add_argument("runs", type=int, help="at most")
    parser.add_argument("seconds", type=float, help="not once more after these")
    print(json.dumps(measure(parser.parse_args())))


main()
