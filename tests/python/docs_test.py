"""The Python of docs/python.md and of the README, run block after block."""

import os
import re
import tempfile
import unittest
import warnings

import numpy as np

import pcednet
from support import SOURCE, cube


def blocks(page):
    return re.findall(r"```python\n(.*?)```", (SOURCE / page).read_text(encoding="utf-8"), re.S)


class Docs(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder.name)
        warnings.simplefilter("ignore", pcednet.PcednetWarning)
        positions, normals, labels = cube(3000)
        intensity = np.arange(3000, dtype=np.uint16)
        for name in ("scan.laz", "scan.las"):
            pcednet.write(name, positions, attributes={"Intensity": intensity})
        own = pcednet.Cloud(positions, normals, labels=labels)
        own.comments = [f"pcednet class {number} #00000{number} {name}"
                        for number, name in enumerate(("ground", "wall", "pipe"))]
        pcednet.write("site.ply", own)
        pcednet.lines(positions, labels, normals).write("true.obj")
        self.names = {"xyz": positions, "other": pcednet.Cloud(positions, normals), "normals": normals, "other_xyz": positions + 5,
                      "picked": np.flatnonzero(labels == 2), "others": labels == 0,
                      "a": positions, "b": positions, "c": positions, "labels_a": labels,
                      "labels_b": labels, "truth": labels}

    def test_every_block_runs(self):
        for page, least in (("docs/python.md", 6), ("README.md", 1)):
            found = blocks(page)
            self.assertGreaterEqual(len(found), least)
            for block in found:
                with self.subTest(page, block=block):
                    exec(compile(block, page, "exec"), self.names)
        for file in ("edges.dxf", "roof.dxf", "roof.gpkg", "edges.laz", "mine.safetensors", "points.ply",
                     "labelled.ply"):
            self.assertTrue(os.path.getsize(file), file)


if __name__ == "__main__":
    unittest.main()
