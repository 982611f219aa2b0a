"""Where the scanner stood: --viewpoint of classify and lines."""
import re
import unittest

import numpy as np

from support import CliTest, run, write_ply

PLACE = np.array([20.0, 10.0, 1.7])


def panel_scan(step=0.008):
    """A panel 8 before the scanner, 3 wide and .8 high, and its shadow on the ground, up to 15.1."""
    down, turn = (a.ravel() for a in np.meshgrid(np.arange(0.08, 0.5, step), np.arange(-0.5, 0.5, step)))
    beams = np.c_[np.cos(down) * np.cos(turn), np.cos(down) * np.sin(turn), -np.sin(down)]
    at = 8.0 / beams[:, :1] * beams
    panel = (np.abs(at[:, 1]) < 1.5) & (at[:, 2] > -1.7) & (at[:, 2] < -0.9)
    ranges = np.where(panel, np.linalg.norm(at, axis=1), 1.7 / np.sin(down))
    ranges += 0.002 * np.random.default_rng(4).normal(size=len(ranges))
    return PLACE + ranges[:, None] * beams


class Viewpoint(CliTest):
    def setUp(self):
        super().setUp()
        write_ply(self.folder / "scan.ply", panel_scan(), position_type="double")

    def length(self, file, *options):
        done = run("lines", self.folder / file, "-o", self.folder / "x.obj", "--overwrite", "--boundaries",
                   *options)
        return float(re.search(r"total length ([\d.]+)", done.stderr).group(1))

    def test_shadows_end_in_no_line_where_it_is_told(self):
        told = ("--viewpoint", *PLACE)
        self.assertGreater(self.length("scan.ply"), self.length("scan.ply", *told) + 12)

    def test_a_result_keeps_it(self):
        done = run("classify", self.folder / "scan.ply", "--viewpoint", *PLACE)
        self.assertIn("turned towards the scanner", done.stderr)
        self.assertIn(b"comment scanner 0: 20 10 1.7\n", (self.folder / "scan_edges.ply").read_bytes())
        self.assertGreater(self.length("scan.ply"), self.length("scan_edges.ply") + 12)

    def test_is_for_one_scan(self):
        write_ply(self.folder / "two.ply", panel_scan(0.05), scan=np.zeros(180))
        done = run("classify", self.folder / "two.ply", "--viewpoint", "0", "0", "0", expect=2)
        self.assertIn("two.ply: is of several scans, --viewpoint is for one", done.stderr)
        run("classify", self.folder / "scan.ply", "--viewpoint", "0", "nan", "0", expect=2)
        run("classify", self.folder / "scan.ply", "--method", "ca", "--viewpoint", "0", "0", "0", expect=2)


if __name__ == "__main__":
    unittest.main()
