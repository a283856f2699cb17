"""What is measured on: files that anybody can get, made ready for every contender.

All contenders read the same file: binary PLY of positions and triangles alone, welded, since half of them know no
seams. Files that are there already are taken as they are, so that a run that goes on sees the same.
"""

import subprocess
import tarfile
from dataclasses import dataclass
from pathlib import Path

ARCHIVE = Path("/usr/share/doc/libcgal-dev/data.tar.gz")
"""Of Debian's package libcgal-demo."""


@dataclass(frozen=True)
class Mesh:
    name: str
    path: Path
    triangles: int


@dataclass(frozen=True)
class Tools:
    """What the meshes are made by."""

    decimesh: Path
    peers: Path


class Cabinet:
    """The directory of the meshes. What goes wrong in it is raised as `OSError` or `CalledProcessError`."""

    def __init__(self, directory: Path, tools: Tools) -> None:
        self.directory = directory
        self.tools = tools
        directory.mkdir(parents=True, exist_ok=True)

    def archived(self, name: str) -> Mesh:
        """A mesh of the archive: `name`.off."""
        source = self.directory / f"{name}.off"
        ready = self.directory / f"{name}.ready.ply"
        # What an interruption left half unpacked is unpacked again.
        if not ready.exists():
            with tarfile.open(ARCHIVE) as archive:
                member = archive.extractfile(f"data/meshes/{source.name}")
                if member is None:
                    raise OSError(f"{ARCHIVE} has no {source.name}")
                source.write_bytes(member.read())
        return self._welded(name, source, ready)

    def statue(self, triangles: int) -> Mesh:
        """The statue of `decimesh demo`, of about so many triangles."""
        directory = self.directory / f"statue-{triangles}"
        if not (directory / "demo.png").exists():
            command = [
                self.tools.decimesh,
                "demo",
                directory,
                "--triangles",
                str(triangles),
                "--width",
                "100",
                "--quiet",
            ]
            subprocess.run(command, check=True)
        return self._welded(directory.name, directory / "statue.ply", directory / "statue.ready.ply")

    def given(self, path: Path) -> Mesh:
        """A file of the caller's, of any format that decimesh knows. Made ready anew: it may have changed."""
        ready = self.directory / "given" / f"{path.stem}.ply"
        ready.parent.mkdir(exist_ok=True)
        ready.unlink(missing_ok=True)
        return self._welded(path.stem, path, ready)

    def _welded(self, name: str, source: Path, path: Path) -> Mesh:
        if not path.exists():
            command = [self.tools.peers, "--weld", source, path]
            run = subprocess.run(command, capture_output=True, text=True, check=False)
            if run.returncode != 0:
                raise OSError(f"{source}: {run.stdout.strip() or run.stderr.strip()}")
        return Mesh(name, path, _triangles(path))


def _triangles(path: Path) -> int:
    with path.open("rb") as file:
        for line in file:
            if line.startswith(b"element face "):
                return int(line.split()[-1])
            if line == b"end_header\n":
                break
    raise OSError(f"{path} has no faces")
