# SPDX-License-Identifier: GPL-3.0-or-later
"""The filters as meshlabserver runs them, on files, beside the decimesh command on the same files.

Takes from the environment MESHLABSERVER, and what meshlab_server.Staged takes.
"""

import collections
import math
import os
import re
import tempfile
import unittest
from pathlib import Path

import meshlab_server as meshlab
from meshlab_server import CHOOSE, DEVIATION, LEVELS, SIMPLIFY, Ply


class Server(meshlab.Staged):
    @classmethod
    def setUpClass(cls):
        cls.set_up_with("MESHLABSERVER", 20000)
        cls.faces = len(Ply(cls.mesh).faces)

    def setUp(self):
        directory = tempfile.TemporaryDirectory(dir=self.work)
        self.addCleanup(directory.cleanup)
        self.place = Path(directory.name)

    def meshlab(self, inputs, filters, *outputs):
        """What meshlabserver answered with, and printed."""
        script = meshlab.script(self.place / "filters.mlx", filters)
        return meshlab.run(self.program, self.place, "-i", *inputs, "-s", script, *outputs)

    def apply(self, filter_name, parameters, source=None, *attributes):
        """The mesh that a filter makes of a file, with attributes as meshlabserver names them."""
        out = self.place / "out.ply"
        saved = ["-o", out, *(["-m", *attributes] if attributes else [])]
        done = self.meshlab([source or self.mesh], [(filter_name, parameters)], *saved)
        self.assertEqual(done.returncode, 0, done.stdout)
        return Ply(out)

    def command(self, *arguments, source=None):
        """The mesh that the command makes of a file."""
        out = self.place / "command.ply"
        self.decimesh("simplify", source or self.mesh, out, *arguments)
        return Ply(out)

    def refused(self, message, inputs, filter_name, parameters):
        out = self.place / "out.ply"
        done = self.meshlab(inputs, [(filter_name, parameters)], "-o", out)
        # Ended by itself, not by a signal.
        self.assertGreater(done.returncode, 0, done.stdout)
        self.assertIn("decimesh: " + message, done.stdout)
        self.assertFalse(out.exists())

    def test_filters_are_listed_and_each_parameter_is_explained(self):
        listed = self.place / "filters.txt"
        meshlab.run(self.program, self.place, "-d", listed)
        text = listed.read_text(errors="replace")
        for name in (SIMPLIFY, CHOOSE, LEVELS, DEVIATION):
            self.assertIn(name, text)
            table = text.split(name + " \n")[1].split("</TABLE>")[0]
            rows = table.split("<TR>")[1:]
            self.assertGreater(len(rows), 5, name)
            for row in rows:
                self.assertNotIn("<i>  -- </i>", row)

    def test_simplify_equals_the_command(self):
        target = self.faces // 4
        mine = self.apply(SIMPLIFY, {"TargetFaces": target})
        self.assertLessEqual(len(mine.faces), target)
        self.assertGreaterEqual(len(mine.faces), target - 1)
        self.assertEqual(mine.surface(), self.command("--triangles", target).surface())

    def test_ratio_equals_the_command(self):
        mine = self.apply(SIMPLIFY, {"Target": meshlab.choice(2, 4), "Ratio": 0.1})
        self.assertEqual(mine.surface(), self.command("--ratio", 0.1).surface())

    def test_existing_vertices_equal_the_command(self):
        mine = self.apply(SIMPLIFY, {"TargetFaces": self.faces // 4, "Placement": meshlab.choice(1, 2)})
        self.assertEqual(mine.surface(), self.command("--triangles", self.faces // 4, "--engine", "indices").surface())

    def test_multiple_choice_equals_the_command(self):
        target = self.faces // 4
        mine = self.apply(CHOOSE, {"TargetFaces": target})
        theirs = self.command("--triangles", target, "--engine", "multiple-choice")
        self.assertEqual(mine.surface(), theirs.surface())

    def test_refined_equals_the_command(self):
        mine = self.apply(SIMPLIFY, {"TargetFaces": 2000, "Refine": True, "KeepTopology": True, "Threads": 1})
        theirs = self.command("--triangles", 2000, "--refine", "--keep-topology")
        self.assertEqual(mine.surface(), theirs.surface())

    def test_certified_equals_the_command(self):
        source = self.place / "mesh.ply"
        self.decimesh("simplify", self.mesh, source, "--triangles", 3000)
        # A number of 32 bits, as MeshLab keeps it, and short, as a user types it.
        distance = 0.02
        mine = self.apply(SIMPLIFY, {"Target": meshlab.choice(3, 4), "MaxError": meshlab.length(distance),
                                     "Certify": True}, source)
        self.assertLess(len(mine.faces), 3000)
        theirs = self.command("--max-error", distance, "--certify", source=source)
        self.assertEqual(mine.surface(), theirs.surface())

    def colored(self):
        """The mesh with colours that go with the place: a file."""
        path = self.place / "colored.ply"
        Ply(self.mesh).write(path, lambda place: [int(128 + 100 * math.sin(3 * x)) for x in place] + [255])
        return path

    def test_colours_count_by_their_weight_as_in_the_command(self):
        source = self.colored()
        target = self.faces // 8
        existing = {"TargetFaces": target, "Placement": meshlab.choice(1, 2)}
        weighed = self.apply(SIMPLIFY, {**existing, "ColorWeight": 0.5}, source)
        theirs = self.command("--triangles", target, "--engine", "indices", "--color-weight", 0.5, source=source)
        self.assertEqual(weighed.surface(), theirs.surface())
        self.assertNotEqual(weighed.surface(), self.apply(SIMPLIFY, existing, source).surface())

    def test_colours_go_with_vertices_that_move(self):
        source = self.colored()
        mine = self.apply(SIMPLIFY, {"TargetFaces": self.faces // 4}, source, "vc")
        theirs = self.command("--triangles", self.faces // 4, source=source)
        self.assertEqual(mine.surface(), theirs.surface())

        def by_place(mesh):
            names = ("x", "y", "z", "red", "green", "blue", "alpha")
            return sorted(zip(*(mesh.vertices[name] for name in names)))
        self.assertEqual(by_place(mine), by_place(theirs))

    def test_faces_that_are_not_selected_stay(self):
        select = (meshlab.SELECT, {"condSelect": ("RichString", {"value": "x0 < 0"})})
        for filter_name in (SIMPLIFY, CHOOSE):
            with self.subTest(filter_name):
                out = self.place / "out.ply"
                done = self.meshlab([self.mesh], [select, (filter_name, {"TargetFaces": 1000, "SelectedFaces": True})],
                                    "-o", out)
                self.assertEqual(done.returncode, 0, done.stdout)
                whole, mine = Ply(self.mesh), Ply(out)
                before, after = collections.Counter(whole.surface()), collections.Counter(mine.surface())
                kept = collections.Counter(whole.surface(lambda places: places[0][0] >= 0))
                joined, whole_joined = meshlab.edges(mine.surface()), meshlab.edges(whole.surface())
                self.assertGreater(kept.total(), self.faces // 4)
                self.assertEqual(kept - after, collections.Counter())
                self.assertLess((after - before).total(), 1001)
                self.assertIn(after.total() - kept.total(), (999, 1000))
                # No crack: where they were joined to faces that have gone, they are joined to new ones.
                for edge in meshlab.edges(kept.elements()):
                    self.assertEqual(joined[edge], whole_joined[edge])

    def test_textures_of_wedges_stay_on_their_faces(self):
        """A strip of squares on two textures, whose coordinates are those of the place, each on its own."""
        source, side = self.place / "charts.ply", 40
        rows = range(side + 1)
        places = [(column / side, row / side, 0.1 * math.sin(7 * column / side)) for row in rows for column in rows]
        faces = []
        for row in range(side):
            for column in range(side):
                a, b, c, d = (row * (side + 1) + column + step for step in (0, 1, side + 2, side + 1))
                faces += [((a, b, c), column * 2 // side), ((a, c, d), column * 2 // side)]
        with source.open("w") as file:
            file.write("ply\nformat ascii 1.0\ncomment TextureFile a.png\ncomment TextureFile b.png\n"
                       f"element vertex {len(places)}\nproperty float x\nproperty float y\nproperty float z\n"
                       f"element face {len(faces)}\nproperty list uchar int vertex_indices\n"
                       "property list uchar float texcoord\nproperty int texnumber\nend_header\n")
            file.writelines("{} {} {}\n".format(*place) for place in places)
            for corners, texture in faces:
                uvs = [number for corner in corners for number in (places[corner][0] - 0.5 * texture, places[corner][1])]
                file.write(f"3 {' '.join(map(str, corners))} 6 {' '.join(map(str, uvs))} {texture}\n")
        for filter_name, tolerance in ((SIMPLIFY, 0.02), (CHOOSE, 1e-6)):
            with self.subTest(filter_name):
                mine = self.apply(filter_name, {"TargetFaces": 400}, source, "wt")
                self.assertLess(len(mine.faces), 401 if filter_name == SIMPLIFY else 1000)
                self.assertEqual(set(mine.textures), {0, 1})
                for corners, uvs, texture in zip(mine.faces, mine.wedges, mine.textures):
                    for corner, vertex in enumerate(corners):
                        x, y = mine.vertices["x"][vertex], mine.vertices["y"][vertex]
                        self.assertAlmostEqual(uvs[2 * corner], x - 0.5 * texture, delta=tolerance)
                        self.assertAlmostEqual(uvs[2 * corner + 1], y, delta=tolerance)

    def test_off_and_stl_are_simplified(self):
        for extension in ("off", "stl"):
            with self.subTest(extension):
                source = self.place / f"mesh.{extension}"
                self.decimesh("simplify", self.mesh, source, "--triangles", 8000)
                mine = self.apply(SIMPLIFY, {"TargetFaces": 1000}, source)
                self.assertIn(len(mine.faces), (999, 1000))
                if extension == "off":
                    self.assertEqual(mine.surface(), self.command("--triangles", 1000, source=source).surface())

    def test_levels_become_layers(self):
        for nested, engine in ((False, "hqms"), (True, "indices")):
            with self.subTest(nested=nested):
                self.decimesh("levels", self.mesh, self.place / engine, "--count", 3, "--ratio", 0.5,
                              "--engine", engine)
                outputs = [self.place / f"level{level}-{nested}.ply" for level in range(4)]
                saved = [word for level, out in enumerate(outputs) for word in ("-o", out, "-l", level)]
                done = self.meshlab([self.mesh], [(LEVELS, {"Levels": 3, "Ratio": 0.5, "Nested": nested})], *saved)
                self.assertEqual(done.returncode, 0, done.stdout)
                layers = [Ply(out) for out in outputs]
                self.assertEqual(layers[0].surface(), Ply(self.mesh).surface())
                for level in (1, 2, 3):
                    self.assertIn(self.faces // 2**level - len(layers[level].faces), (0, 1))
                    theirs = Ply(self.place / engine / f"{self.mesh.stem}_{level}.ply")
                    self.assertEqual(layers[level].surface(), theirs.surface())
                self.assertIn("level 3: ", done.stdout)

    def test_deviation_becomes_quality(self):
        coarse = self.place / "coarse.ply"
        self.decimesh("simplify", self.mesh, coarse, "--triangles", 1000)
        out = self.place / "out.ply"
        done = self.meshlab([self.mesh, coarse], [(DEVIATION, {"Reference": meshlab.layer(0)})],
                            "-o", out, "-l", 1, "-m", "vq")
        self.assertEqual(done.returncode, 0, done.stdout)
        qualities = Ply(out).vertices["quality"]
        self.assertGreater(max(qualities), 0)
        self.assertIn("both surfaces: RMS ", done.stdout)

    def test_the_largest_distance_is_proven(self):
        coarse = self.place / "coarse.ply"
        self.decimesh("simplify", self.mesh, coarse, "--triangles", 2000)
        for bound in (False, True):
            done = self.meshlab([self.mesh, coarse],
                                [(DEVIATION, {"Reference": meshlab.layer(0), "Bound": bound, "Tolerance": 0.05})])
            self.assertEqual(done.returncode, 0, done.stdout)
            proven = re.search("proven to be between ([0-9.e-]+) and ([0-9.e-]+)", done.stdout)
            self.assertEqual(proven is not None, bound, done.stdout)
        lower, upper = map(float, proven.groups())
        sampled = float(re.search("largest ([0-9.e-]+)", done.stdout).group(1))
        self.assertLessEqual(sampled, upper * 1.00001)
        self.assertLessEqual(lower, upper)
        self.assertLessEqual(upper, 1.0501 * lower)

    def test_what_fails_says_so(self):
        points = self.place / "points.ply"
        points.write_text("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                          "property float z\nend_header\n0 0 0\n1 0 0\n0 1 0\n")
        self.refused("the layer has no faces", [points], SIMPLIFY, {"TargetFaces": 1})
        self.refused("the layer has no faces", [points], CHOOSE, {"TargetFaces": 1})
        self.refused("the layer has no faces", [points], LEVELS, {})
        self.refused("the layer that distances are from has no faces", [points], DEVIATION, {})
        self.refused("no face is selected", [self.mesh], SIMPLIFY, {"SelectedFaces": True})
        self.refused("TargetFaces is -1, and must not be negative", [self.mesh], SIMPLIFY, {"TargetFaces": -1})
        self.refused("Certify is for a distance as the target", [self.mesh], SIMPLIFY, {"Certify": True})
        self.refused("the ratio of levels must be", [self.mesh], LEVELS, {"Ratio": 1.5})

    def test_a_target_above_the_size_leaves_the_mesh(self):
        mine = self.apply(SIMPLIFY, {"TargetFaces": 10 * self.faces})
        self.assertEqual(mine.surface(), Ply(self.mesh).surface())


if __name__ == "__main__":
    unittest.main()
