"""What the figures were measured on."""

import datetime
import json
import os
import platform
import subprocess
from dataclasses import asdict
from pathlib import Path

from .plan import Plan
from .rows import Setting

MEASURED = ("src", "Cargo.toml", "Cargo.lock", "cpp-tests/comparisons", "benches/benchmarks/peers")
"""What the figures depend on, in the checkout: a page that is written anew makes no new figures."""


def setting(root: Path, plan: Plan, quick: bool) -> Setting:
    """Of this machine, now. `root` is the checkout that is measured."""
    return {
        "date": datetime.date.today().isoformat(),
        "commit": _commit(root),
        "processor": _processor(),
        "cores": len(os.sched_getaffinity(0)),
        "gibibytes": round(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30),
        "system": _system(),
        "python": platform.python_version(),
        "load": round(os.getloadavg()[0], 2),
        "quick": quick,
        # As it comes back from a file: with lists for tuples.
        "plan": json.loads(json.dumps(asdict(plan))),
    }


def same(one: Setting, other: Setting) -> bool:
    """Whether rows of both may stand in one table."""
    keys = ("commit", "processor", "cores", "quick", "plan")
    return all(one.get(key) == other.get(key) for key in keys)


def _commit(root: Path) -> str:
    """The last one that changed what the figures depend on, with a `+` where that differs from it."""
    try:
        last = _git(root, "log", "-1", "--format=%h", "--", *MEASURED)
        return last + ("+" if _git(root, "status", "--porcelain", "--", *MEASURED) else "")
    except (OSError, subprocess.CalledProcessError):
        return "unknown"


def _git(root: Path, *words: str) -> str:
    return subprocess.run(["git", "-C", str(root), *words], check=True, capture_output=True, text=True).stdout.strip()


def _processor() -> str:
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        key, _, value = line.partition(":")
        if key.strip() == "model name":
            return value.strip()
    return platform.machine()


def _system() -> str:
    try:
        return platform.freedesktop_os_release()["PRETTY_NAME"]
    except OSError:
        return platform.system()
