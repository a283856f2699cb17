"""Contenders that do all that a process can do, played by shell scripts."""

import dataclasses
import json
import tempfile
import unittest
from pathlib import Path

from benchmarks.contenders import Contender
from benchmarks.measuring import Bench
from benchmarks.meshes import Mesh, Tools
from benchmarks.plan import QUICK
from benchmarks.rows import Row

from .examples import case, row

CONTENDER = Contender("one", "family", "`call`")
VALUES = {
    "library": "one 1.0",
    "load_seconds": [0.1],
    "simplify_seconds": [0.2],
    "unload_seconds": [0.3],
    "peak_bytes": None,
    "triangles": 100,
}
MEASURED = {"rms_rel": 1e-3, "max_rel": 1e-2, "other": 1}


class Measuring(unittest.TestCase):
    def setUp(self) -> None:
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.directory = Path(directory.name)

    def measure(self, peers: str, decimesh: str = f"echo '{json.dumps(MEASURED)}'", limit: float = 60.0) -> Row:
        """With these scripts as the programs."""
        tools = Tools(self.directory / "decimesh", self.directory / "peers")
        for path, script in [(tools.peers, peers), (tools.decimesh, decimesh)]:
            path.write_text(f"#!/bin/sh\n{script}\n")
            path.chmod(0o755)
        bench = Bench(tools, dataclasses.replace(QUICK, limit=limit), self.directory)
        return bench.measure(CONTENDER, Mesh("bunny", self.directory / "bunny.ply", 1000), case(), before=[])

    def failure(self, *scripts: str, limit: float = 60.0) -> str | None:
        its = self.measure(*scripts, limit=limit)
        self.assertEqual(its, Row(case(), "one", failure=its.failure))
        return its.failure

    def test_a_row_is_what_both_programs_say(self) -> None:
        found = self.measure(f"echo noise\necho '{json.dumps(VALUES)}'")
        self.assertEqual(found, Row(case(), "one", **VALUES, rms=1e-3, maximum=1e-2))

    def test_the_program_is_told_what_to_do(self) -> None:
        words = self.measure('echo "{\\"failure\\": \\"$*\\"}"').failure
        self.assertEqual(words, f"one {self.directory}/bunny.ply {self.directory}/result.ply 100 1 0.0")

    def test_what_goes_wrong_is_a_row(self) -> None:
        values = f"echo '{json.dumps(VALUES)}'"
        self.assertEqual(self.failure('echo \'{"failure": "will not"}\''), "will not")
        self.assertEqual(self.failure("kill -SEGV $$"), "ended by SIGSEGV")
        self.assertEqual(self.failure("echo first >&2; echo last >&2; exit 3"), "exit code 3: last")
        self.assertEqual(self.failure("exit 3"), "exit code 3: no message")
        self.assertEqual(self.failure("echo noise"), "said nothing")
        self.assertEqual(self.failure(values, "echo broken >&2; exit 1"), "cannot be measured: broken")
        self.assertEqual(self.failure("exec sleep 1000", limit=0.1), "stopped after 0.1 s")

    def test_who_would_take_too_long_is_not_run(self) -> None:
        bench = Bench(Tools(Path("/nowhere"), Path("/nowhere")), QUICK, self.directory)
        large = case("large", triangles_in=1_000_000)
        before = [
            row("one", QUICK.limit, 1.0, case=case("tiny", triangles_in=10)),
            row("other", QUICK.limit, 1.0),
            row("one", QUICK.limit / 900, 1.0),
        ]
        found = bench.measure(CONTENDER, Mesh("large", Path("large.ply"), 1_000_000), large, before)
        self.assertEqual(found, Row(large, "one", failure="not run: would take more than 60 s"))


if __name__ == "__main__":
    unittest.main()
