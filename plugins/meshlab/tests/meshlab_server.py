# SPDX-License-Identifier: GPL-3.0-or-later
"""MeshLab's programs, run with the plugin, and the meshes that go in and come out.

MeshLab looks for plugins beside its program. So that no test needs root, or changes what is installed, the program is
copied into a tree whose plugins are links to MeshLab's own, and ours.
"""

import collections
import os
import shutil
import struct
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as xml
from pathlib import Path

SIMPLIFY = "decimesh: simplify (HQMS)"
CHOOSE = "decimesh: simplify keeping vertices (multiple choice)"
LEVELS = "decimesh: levels of detail"
DEVIATION = "decimesh: deviation"
# MeshLab's own.
SELECT = "Conditional Face Selection"

# Seconds. It takes some to load its plugins.
PATIENCE = 120


def stage(root: Path, program: Path, libraries: Path, plugin: Path) -> Path:
    """A tree with the program, whose path is returned, MeshLab's plugins, and ours."""
    staged = root / "bin" / program.name
    staged.parent.mkdir(parents=True)
    shutil.copy(program, staged)
    # As Debian has it: lib/<architecture>/meshlab.
    library = root / Path(*libraries.parts[-3:])
    (library / "plugins").mkdir(parents=True)
    for file in (*libraries.glob("*.so*"), *libraries.glob("plugins/*.so"), plugin):
        place = library / ("plugins" if file.parent.name == "plugins" or file == plugin else "")
        (place / file.name).symlink_to(file)
    return staged


def script(path: Path, filters: list[tuple[str, dict]]) -> Path:
    """A filter script (.mlx). Values are bool, int, float, or (type, attributes); what is not said is as in DEFAULTS.

    meshlabserver ends itself over scripts that do not name all parameters, in their order.
    """
    root = xml.Element("FilterScript")
    for name, parameters in filters:
        element = xml.SubElement(root, "filter", name=name)
        for key, value in {**DEFAULTS[name], **parameters}.items():
            if isinstance(value, tuple):
                kind, attributes = value
            elif isinstance(value, bool):
                kind, attributes = "RichBool", {"value": str(value).lower()}
            else:
                kind, attributes = ("RichInt" if isinstance(value, int) else "RichFloat"), {"value": str(value)}
            xml.SubElement(element, "Param", type=kind, name=key, **attributes)
    path.write_text("<!DOCTYPE FilterScript>\n" + xml.tostring(root, encoding="unicode"))
    return path


def choice(value: int, choices: int) -> tuple:
    names = {f"enum_val{place}": str(place) for place in range(choices)}
    return "RichEnum", {"value": str(value), "enum_cardinality": str(choices), **names}


def length(value: float) -> tuple:
    return "RichAbsPerc", {"value": repr(value), "min": "0", "max": "1000"}


def layer(index: int) -> tuple:
    return "RichMesh", {"value": str(index)}


ENGINE = {"KeepTopology": False, "LockBoundary": False, "KeepSeams": True, "CrossSeams": False, "Refine": False,
          "NormalWeight": 0.0, "UVWeight": 0.0, "ColorWeight": 0.0, "Selection": choice(0, 2), "HeapRecords": 15,
          "SelectedVertices": choice(0, 4), "Threads": 0}
SCOPE = {"Normals": choice(0, 2), "SelectedFaces": False}
DEFAULTS = {
    SIMPLIFY: {"Target": choice(0, 4), "TargetFaces": 1000, "TargetVertices": 500, "Ratio": 0.5,
               "MaxError": length(0.01), "Certify": False, "Placement": choice(0, 2), **ENGINE, **SCOPE},
    CHOOSE: {"TargetFaces": 1000, "Candidates": 6, "Seed": 0, "LockSelectedVertices": False, **SCOPE},
    LEVELS: {"Levels": 4, "Ratio": 0.5, "Nested": False, "Certify": False, **ENGINE, **SCOPE},
    DEVIATION: {"Reference": layer(0), "Samples": 20000, "Seed": 0, "Bound": False, "Tolerance": 0.01,
                "Pieces": 5000000, "Threads": 0},
    SELECT: {},
}


def run(program: Path, home: Path, *arguments) -> subprocess.CompletedProcess:
    environment = {**os.environ, "HOME": str(home), "LIBGL_ALWAYS_SOFTWARE": "1", "QT_LOGGING_RULES": "*=false"}
    command = [str(program), *map(str, arguments)]
    return subprocess.run(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          errors="replace", timeout=PATIENCE, check=False)


def edges(surface) -> collections.Counter:
    """How many faces are at each edge of what Ply.surface gives."""
    return collections.Counter(tuple(sorted((face[corner - 1], face[corner]))) for face in surface
                               for corner in range(3))


class Staged(unittest.TestCase):
    """Tests of one of MeshLab's programs, on a mesh: `program`, `work`, a directory, and `mesh`, a PLY file.

    Takes from the environment: MESHLAB_LIBRARIES (MeshLab's), PLUGIN, DECIMESH (the command), and MESH, a PLY file to
    take instead of the statue of `decimesh demo`, if it is set.
    """

    @classmethod
    def set_up_with(cls, program: str, triangles: int):
        """Stages the program of that name in the environment, and makes a statue of so many triangles."""
        directory = tempfile.TemporaryDirectory()
        cls.addClassCleanup(directory.cleanup)
        cls.work = Path(directory.name)
        cls.program = stage(cls.work / "stage", Path(os.environ[program]), Path(os.environ["MESHLAB_LIBRARIES"]),
                            Path(os.environ["PLUGIN"]))
        if os.environ.get("MESH"):
            # Beside all else: a picture shows where it was opened.
            cls.mesh = Path(shutil.copy(os.environ["MESH"], cls.work))
        else:
            cls.decimesh("demo", cls.work, "--triangles", triangles, "--width", 100)
            cls.mesh = cls.work / "statue.ply"

    @classmethod
    def decimesh(cls, *arguments):
        command = [os.environ["DECIMESH"], *map(str, arguments), "--quiet"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


class Ply:
    """What a binary PLY file of MeshLab's or decimesh's has: columns of vertices by name, and faces."""

    TYPES = {"float": "f", "double": "d", "uchar": "B", "char": "b", "short": "h", "ushort": "H", "int": "i",
             "uint": "I", "float32": "f", "uint8": "B", "int32": "i", "uint32": "I"}

    def __init__(self, path: Path):
        data = path.read_bytes()
        header, self.body = data.split(b"end_header\n", 1)
        elements = []
        for line in header.decode().splitlines():
            words = line.split()
            if words[0] == "format" and words[1] != "binary_little_endian":
                raise ValueError(f"{path} is {words[1]}")
            if words[0] == "element":
                elements.append((words[1], int(words[2]), []))
            elif words[0] == "property":
                elements[-1][2].append(words[1:])
        self.offset = 0
        self.vertices, self.faces, self.wedges, self.textures = {}, [], [], []
        for name, count, properties in elements:
            if name == "vertex":
                self._read_vertices(count, properties)
            elif name == "face":
                self._read_faces(count, properties)

    def _read_vertices(self, count, properties):
        row = struct.Struct("<" + "".join(self.TYPES[kind] for kind, _ in properties))
        rows = list(row.iter_unpack(self.body[self.offset:self.offset + count * row.size]))
        self.offset += count * row.size
        self.vertices = {name: [values[place] for values in rows] for place, (_, name) in enumerate(properties)}

    def _read_faces(self, count, properties):
        for _ in range(count):
            for words in properties:
                if words[0] == "list":
                    (size,) = self._take(self.TYPES[words[1]])
                    values = self._take(f"{size}{self.TYPES[words[2]]}")
                    (self.faces if words[3].startswith("vertex_ind") else self.wedges).append(values)
                else:
                    (value,) = self._take(self.TYPES[words[0]])
                    if words[1] == "texnumber":
                        self.textures.append(value)

    def _take(self, form):
        values = struct.unpack_from("<" + form, self.body, self.offset)
        self.offset += struct.calcsize("<" + form)
        return values

    def places(self) -> list:
        return list(zip(*(self.vertices[axis] for axis in "xyz")))

    def surface(self, is_wanted=lambda places: True) -> list:
        """The faces by the places of their corners, bit for bit: the same for the same mesh, however it is numbered.

        Of those alone for whose places, in their order, is_wanted.
        """
        places = self.places()
        corners = [struct.pack("<3f", *place) for place in places]
        faces = []
        for face in self.faces:
            if is_wanted([places[vertex] for vertex in face]):
                found = [corners[vertex] for vertex in face]
                first = found.index(min(found))
                faces.append(tuple(found[first:] + found[:first]))
        return sorted(faces)

    def write(self, path: Path, color_at):
        """Writes places and faces, and for each vertex the colour of its place: red, green, blue, alpha."""
        header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(self.vertices['x'])}",
                  *(f"property float {axis}" for axis in "xyz"),
                  *(f"property uchar {channel}" for channel in ("red", "green", "blue", "alpha")),
                  f"element face {len(self.faces)}", "property list uchar int vertex_indices", "end_header\n"]
        rows = [struct.pack("<3f4B", *place, *color_at(place)) for place in self.places()]
        rows += [struct.pack("<B3i", 3, *face) for face in self.faces]
        path.write_bytes("\n".join(header).encode() + b"".join(rows))
