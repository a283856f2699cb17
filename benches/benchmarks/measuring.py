"""One contender in one case, in a process of its own, and the distance of what it leaves."""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from .contenders import Contender
from .meshes import Mesh, Tools
from .plan import Plan
from .rows import Case, Row


class Failed(Exception):
    """Why there is no figure."""


class Bench:
    """Runs contenders. Results go through `directory`."""

    def __init__(self, tools: Tools, plan: Plan, directory: Path) -> None:
        self.tools = tools
        self.plan = plan
        self.result = directory / "result.ply"

    def measure(self, contender: Contender, mesh: Mesh, case: Case, before: Iterable[Row]) -> Row:
        """A row in any case. `before` are rows that tell how long it might take."""
        try:
            self._check_time(contender, case, before)
            values = self._run(contender, mesh, case)
            distance = self._distance(mesh)
        except Failed as failure:
            return Row(case, contender.name, contender.cores, failure=str(failure))
        return Row(
            case, contender.name, contender.cores, **values, rms=distance["rms_rel"], maximum=distance["max_rel"]
        )

    def _check_time(self, contender: Contender, case: Case, before: Iterable[Row]) -> None:
        """By the largest mesh that it did, of which a triangle says most about one of a larger mesh."""
        known = [row for row in before if row.contender == contender.name and row.failure is None]
        if known:
            largest = max(known, key=lambda row: row.case.triangles_in)
            if 1e-6 * largest.microseconds_per_triangle * case.triangles_in > self.plan.limit:
                raise Failed(f"not run: would take more than {self.plan.limit:g} s")

    def _run(self, contender: Contender, mesh: Mesh, case: Case) -> dict[str, Any]:
        self.result.unlink(missing_ok=True)
        if contender.module is None:
            command = [str(self.tools.peers), contender.name]
        else:
            command = [sys.executable, "-m", "benchmarks.peers", contender.module, contender.name]
        command += [str(mesh.path), str(self.result), str(case.wanted), str(self.plan.runs), str(self.plan.seconds)]
        output = self._within_limit(command, cores(contender.cores))
        lines = [line for line in output.splitlines() if line.startswith("{")]
        if not lines:
            raise Failed("said nothing")
        values = json.loads(lines[-1])
        if "failure" in values:
            raise Failed(values["failure"])
        return values

    def _within_limit(self, command: list[str], allowed: set[int]) -> str:
        """What the command prints."""
        threads = str(len(allowed))
        # Libraries that count the machine's cores rather than their own would start a thread for each.
        environment = os.environ | {"OMP_NUM_THREADS": threads, "OPENBLAS_NUM_THREADS": threads}
        with subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            errors="replace",
            env=environment,
            preexec_fn=lambda: os.sched_setaffinity(0, allowed),
        ) as process:
            try:
                output, errors = process.communicate(timeout=self.plan.limit)
            except subprocess.TimeoutExpired:
                raise Failed(f"stopped after {self.plan.limit:g} s") from None
            finally:
                process.kill()
        if process.returncode < 0:
            raise Failed(f"ended by {signal.Signals(-process.returncode).name}")
        if process.returncode > 0:
            last = errors.strip().splitlines()[-1:] or ["no message"]
            raise Failed(f"exit code {process.returncode}: {last[0][:120]}")
        return output

    def _distance(self, mesh: Mesh) -> dict[str, float]:
        """By `decimesh compare`, for all contenders."""
        command = [str(self.tools.decimesh), "compare", str(mesh.path), str(self.result)]
        command += ["--samples", str(self.plan.samples), "--json", "--quiet"]
        run = subprocess.run(command, capture_output=True, text=True, check=False)
        if run.returncode != 0:
            raise Failed(f"cannot be measured: {run.stderr.strip()[:120]}")
        return json.loads(run.stdout)


def cores(count: int) -> set[int]:
    """So many of those that this process may use: the last ones, since the system prefers the first."""
    available = sorted(os.sched_getaffinity(0))
    if count > len(available):
        raise Failed(f"needs {count} cores, and there are {len(available)}")
    return set(available[-count:])
