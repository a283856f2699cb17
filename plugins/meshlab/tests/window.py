# SPDX-License-Identifier: GPL-3.0-or-later
"""MeshLab's window, with the plugin applied in it as a user would, and pictures of that.

Takes from the environment MESHLAB, DRIVER (the plugin of window_driver.cpp), PICTURES, the directory that the pictures are
left in, and what meshlab_server.Staged takes.
"""

import os
import unittest
from pathlib import Path

import meshlab_server as meshlab


class Window(meshlab.Staged):
    @classmethod
    def setUpClass(cls):
        cls.set_up_with("MESHLAB", 100000)
        driver = Path(os.environ["DRIVER"])
        (next(cls.work.glob("stage/lib/*/meshlab/plugins")) / driver.name).symlink_to(driver)

    def do(self, name, files, steps):
        """Opens the files, does the steps, and leaves the picture of that name."""
        picture = Path(os.environ["PICTURES"]) / name
        picture.unlink(missing_ok=True)
        os.environ["DRIVER_STEPS"] = "\n".join([*steps, f"picture {picture}"])
        done = meshlab.run(self.program, self.work, *files)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertGreater(picture.stat().st_size, 20000)

    def test_simplify(self):
        self.do("meshlab-simplify.png", [self.mesh],
                [f"filter {meshlab.SIMPLIFY}", "type Number of faces = 20000", "apply",
                 "expect simplified to 20000"])

    def test_deviation(self):
        coarse = self.work / "coarse.ply"
        self.decimesh("simplify", self.mesh, coarse, "--triangles", 2000)
        self.do("meshlab-deviation.png", [coarse, self.mesh],
                [f"filter {meshlab.DEVIATION}", "apply", "expect distance from coarse.ply", "close",
                 "filter Colorize by vertex Quality", "apply", "close", "show 0"])


if __name__ == "__main__":
    unittest.main()
