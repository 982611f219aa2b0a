"""What the tests of `pcednet lines` share: the formats of this build, a labelled cube, and the output files."""
import re
import subprocess

import numpy as np

from support import PROGRAM, CliTest, cube, write_ply

WITHOUT_SQLITE = b"made without SQLite" in subprocess.run([PROGRAM, "lines", "a.ply", "-o", "a.gpkg"],
                                                          capture_output=True).stderr
FORMATS = ("dxf", "obj", "ply", "geojson", "svg") + (() if WITHOUT_SQLITE else ("gpkg",))


class LinesTest(CliTest):
    def outputs(self, *formats):
        self.made = {f: self.folder / f"out.{f}" for f in formats or FORMATS}
        return [word for path in self.made.values() for word in ("-o", path)]

    def labelled_cube(self, name="cube.ply", shift=(0, 0, 0), points=8000):
        p, n, label = cube(points)
        write_ply(self.folder / name, p + shift, n, np.where(label == 2, 2, 0).astype(np.uint8),
                  position_type="double")
        return self.folder / name

    def stated_count(self, done):
        return int(re.search(r": (\d+) curves?, total length", done.stderr)[1])
