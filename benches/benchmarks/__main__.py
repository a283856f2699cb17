"""Measures all contenders on all meshes, and writes the page.

Called by `scripts/benchmarks.sh`, which installs and builds what is needed.
"""

import argparse
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

from .contenders import CONTENDERS
from .measuring import Bench
from .meshes import Cabinet, Tools
from .page import page
from .plan import FULL, QUICK, Plan, cases
from .plots import draw
from .rows import Row, RowFile, Setting
from .setting import same, setting


def main() -> None:
    # Ended from outside as by hand: the contender that runs is ended too.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        run(parse())
    except (OSError, ValueError, subprocess.CalledProcessError) as error:
        sys.exit(f"error: {error}")
    except KeyboardInterrupt:
        sys.exit("interrupted; --resume goes on")


def parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="scripts/benchmarks.sh", description=__doc__)
    parser.add_argument("--quick", action="store_true", help="one small mesh, one run: whether it works, not how fast")
    parser.add_argument("--resume", action="store_true", help="go on after an interruption: keep the rows there are")
    parser.add_argument("--out", type=Path, metavar="DIR", help="where benchmarks.md and benchmarks/ go")
    parser.add_argument("files", type=Path, nargs="*", metavar="FILE", help="a mesh of any format that decimesh knows")
    parser.add_argument("--root", type=Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--decimesh", type=Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--peers", type=Path, required=True, help=argparse.SUPPRESS)
    return parser.parse_args()


def run(arguments: argparse.Namespace) -> None:
    out = arguments.out or (arguments.root / ("build/benchmarks/quick" if arguments.quick else "docs"))

    file = RowFile(out / "benchmarks" / "rows.jsonl")
    plan = QUICK if arguments.quick else FULL
    here = setting(arguments.root, plan, arguments.quick)
    if arguments.resume and file.path.exists():
        before, rows = file.read()
        if not same(before, here):
            raise ValueError(f"{file.path} is of another machine, plan or decimesh: --resume does not go on with it")
        here = before
    else:
        rows = []
        file.begin(here)

    tools = Tools(arguments.decimesh, arguments.peers)
    cabinet = Cabinet(arguments.root / "build/benchmarks/meshes", tools)
    measure(plan, tools, cabinet, arguments.files, file, rows)
    report(here, rows, out)


def measure(plan: Plan, tools: Tools, cabinet: Cabinet, files: Sequence[Path], file: RowFile, rows: list[Row]) -> None:
    """Adds to `rows` and to the file what is not there yet."""
    given = [cabinet.given(path) for path in files]
    names = [*plan.archived, *(mesh.name for mesh in given)]
    twice = {name for name in names if names.count(name) > 1}
    if twice:
        raise ValueError(f"several meshes are called {', '.join(sorted(twice))}")
    done = {(row.case, row.contender) for row in rows}
    begin = time.monotonic()
    with tempfile.TemporaryDirectory() as directory:
        bench = Bench(tools, plan, Path(directory))
        for mesh, case in cases(plan, cabinet, given):
            print(f"\n{case.mesh}: {case.triangles_in:,} to {case.wanted:,}", flush=True)
            for contender in CONTENDERS:
                if (case, contender.name) in done:
                    continue
                row = bench.measure(contender, mesh, case, rows)
                rows.append(row)
                file.append(row)
                print(f"  {time.monotonic() - begin:6.0f} s  {line(row)}", flush=True)


def line(row: Row) -> str:
    """A row for whoever watches."""
    if row.failure is not None:
        return f"{row.contender:34} {row.failure}"
    missed = "" if row.reached else "  missed"
    memory = "" if row.bytes_per_triangle is None else f"{row.bytes_per_triangle:,.0f} B/tri"
    return (
        f"{row.contender:34} {row.triangles:9,} {1e3 * row.seconds:10,.1f} ms "
        f"{memory:>12}  {row.rms:.2e}  {row.maximum:.2e}{missed}"
    )


def report(here: Setting, rows: Sequence[Row], out: Path) -> None:
    draw(here, rows, CONTENDERS, out / "benchmarks")
    path = out / "benchmarks.md"
    path.write_text(page(here, rows, CONTENDERS, "benchmarks"))
    print(f"\n{os.path.relpath(path)} is written, plots and rows are in {os.path.relpath(out / 'benchmarks')}")


main()
