"""The notebook-style example, run as a script in an empty folder."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import pcednet
from support import SOURCE

try:
    import matplotlib  # noqa: F401: the example draws with it
except ImportError:
    sys.exit(77)


class Example(unittest.TestCase):
    def test_first_steps(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, SOURCE / "examples/python/first_steps.py"],
                                  cwd=folder, capture_output=True, text=True,
                                  env={**os.environ, "MPLCONFIGDIR": folder})
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertNotIn("Warning", done.stderr)
            out = pathlib.Path(folder) / "out"
            model = pcednet.Model.load(out / "mine.safetensors")
            self.assertEqual(model.name, "mine")
            self.assertIn(b"AcDbLine", (out / "edges.dxf").read_bytes())
            labelled = pcednet.read(out / "edges.ply")
            self.assertGreater(np.count_nonzero(labelled.labels == 2), 500)
            sharp, general, mine = (float(line.split("mcc ")[1].split(",")[0])
                                    for line in done.stdout.splitlines() if "mcc" in line)
            self.assertGreater(sharp, 0.8)
            self.assertGreater(mine, general + 0.1)
            self.assertEqual((out / "precision_recall.png").read_bytes()[1:4], b"PNG")


if __name__ == "__main__":
    unittest.main()
