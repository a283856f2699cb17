# SPDX-License-Identifier: GPL-3.0-or-later
"""MeshLab's window, with the plugin applied in it as a user would, and a picture of that.

Takes from the environment what server.py takes, and MESHLAB, DRIVER (the plugin of window_driver.cpp), and PICTURE, the
file that the picture is left in.
"""

import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import meshlab_server as meshlab


class Window(unittest.TestCase):
    def test_a_filter_is_applied_in_the_window(self):
        with tempfile.TemporaryDirectory() as directory:
            work = Path(directory)
            program = meshlab.stage(work / "stage", Path(os.environ["MESHLAB"]), Path(os.environ["MESHLAB_LIBRARIES"]),
                                    Path(os.environ["PLUGIN"]))
            driver = Path(os.environ["DRIVER"])
            (next(work.glob("stage/lib/*/meshlab/plugins")) / driver.name).symlink_to(driver)
            subprocess.run([os.environ["DECIMESH"], "demo", work, "--triangles", "100000", "--width", "100", "--quiet"],
                           check=True, stdout=subprocess.DEVNULL)
            picture = Path(os.environ["PICTURE"])
            picture.unlink(missing_ok=True)
            os.environ.update(DRIVER_FILTER=meshlab.SIMPLIFY, DRIVER_FACES="5000", DRIVER_PICTURE=str(picture))
            done = meshlab.run(program, work, work / "statue.ply")
            self.assertEqual(done.returncode, 0, done.stdout)
            self.assertGreater(picture.stat().st_size, 20000)


if __name__ == "__main__":
    unittest.main()
