"""Where the scanner stood: --viewpoint of classify, lines and tiles, and the scanners of a file."""
import re
import unittest

import numpy as np

from support import CliTest, run, write_ply
from tiles_support import sorted_rows

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


def room_scan():
    """A room of 6 by 6 by 3 from its middle, in equal steps of both angles."""
    columns, rows = np.linspace(0, 2 * np.pi, 400, endpoint=False), -1.2 + 0.018 * np.arange(150)
    turn, up = (a.ravel() for a in np.meshgrid(columns, rows))
    beams = np.c_[np.cos(up) * np.cos(turn), np.cos(up) * np.sin(turn), np.sin(up)]
    with np.errstate(divide="ignore"):
        ranges = np.min([3.0, 3.0, 1.5] / abs(beams), axis=1)
    ranges += 0.006 * np.random.default_rng(4).normal(size=len(ranges))
    return [100, 50, 1.5] + ranges[:, None] * beams


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

    def check_tiles(self, cloud, *options):
        """The labels, normals and scanners of the whole cloud in tiles and in one file read in tiles."""
        folder = self.folder
        run("classify", folder / cloud, "-o", folder / "whole.ply", *options, "--overwrite")
        done = run("tiles", "plan", folder / cloud, "-o", folder / "p.json", "--tile", 5, *options, "--overwrite")
        self.assertIn("turned towards the scanner", done.stderr)
        run("tiles", "run", folder / "p.json", "--overwrite")
        run("tiles", "join", folder / "p.json", "-o", folder / "joined.ply", "--overwrite")
        run("classify", folder / cloud, "-o", folder / "large.ply", *options, "--max-memory", "101M", "--overwrite")
        whole = sorted_rows(folder / "whole.ply")
        for name in "joined.ply", "large.ply":
            rows = sorted_rows(folder / name)
            self.assertGreater(np.mean(rows["scalar_edge_class"] == whole["scalar_edge_class"]), 0.9999)
            self.assertGreater(np.mean(abs(rows["nx"] - whole["nx"]) < 1e-3), 0.9999)
            self.assertEqual(re.findall(rb"comment scanner.*", (folder / name).read_bytes()),
                             re.findall(rb"comment scanner.*", (folder / "whole.ply").read_bytes()))

    def test_tiles_take_it_and_keep_it(self):
        told = ("--viewpoint", *PLACE)
        self.check_tiles("scan.ply", *told)
        shadows = self.length("scan.ply") - 12
        for file, options in (("joined.ply", ()), ("large.ply", ("--max-memory", "101M")),
                              ("scan.ply", (*told, "--max-memory", "101M"))):
            self.assertGreater(shadows, self.length(file, *options))

    def test_tiles_take_the_scanners_of_the_file(self):
        # The panel from the other side, too: its faces cannot be told by their neighbours.
        p = panel_scan(0.012)
        back = (2 * PLACE + [16.05, 0, 0]) - p * [1, 1, -1] - [0, 0, 2 * PLACE[2]]
        comments = ["scanner 0: 20 10 1.7", "scanner 1: 36.05 10 1.7"]
        write_ply(self.folder / "two.ply", np.vstack([p, back]), position_type="double", comments=comments,
                  scan=np.repeat([0, 1], len(p)))
        self.check_tiles("two.ply")

    def test_tiles_take_the_scanners_of_each_file(self):
        """Two files of a scan each, and one that names no scanner, as the cloud that has them all."""
        p = panel_scan(0.012)
        clouds = p, (2 * PLACE + [16.05, 0, 0]) - p * [1, 1, -1] - [0, 0, 2 * PLACE[2]], p + [0, 30, 0]
        scanners = ["scanner 0: 20 10 1.7"], ["scanner 0: 36.05 10 1.7"], []
        for name, cloud, comments in zip("abc", clouds, scanners):
            write_ply(self.folder / f"{name}.ply", cloud, position_type="double", comments=comments)
        write_ply(self.folder / "all.ply", np.vstack(clouds), position_type="double",
                  comments=["scanner 0: 20 10 1.7", "scanner 1: 36.05 10 1.7"], scan=np.repeat([0, 1, 2], len(p)))
        plan, joined = self.folder / "p.json", self.folder / "joined.ply"
        rows = {}
        for inputs, what in (["all.ply"], "one"), (["a.ply", "b.ply", "c.ply"], "three"):
            paths = [self.folder / name for name in inputs]
            done = run("tiles", "plan", *paths, "-o", plan, "--tile", 5, "--overwrite")
            self.assertEqual("3 scans, numbered by `scan`" in done.stderr, what == "three")
            run("tiles", "run", plan, "--overwrite")
            run("tiles", "join", plan, "-o", joined, "--overwrite")
            self.assertEqual(re.findall(rb"comment scanner.*", joined.read_bytes()),
                             [b"comment scanner 0: 20 10 1.7", b"comment scanner 1: 36.05 10 1.7"])
            rows[what] = sorted_rows(joined)
        self.assertEqual(set(rows["three"]["scan"]), {0, 1, 2})
        for column in "scan", "scalar_edge_class", "nx":
            np.testing.assert_array_equal(rows["three"][column], rows["one"][column])
        # --viewpoint is for all of them.
        run("tiles", "plan", *paths, "-o", plan, "--viewpoint", 1, 2, 3, "--tile", 100, "--overwrite")
        run("tiles", "run", plan, "--overwrite")
        tile = (self.folder / "p_tiles" / "0.ply").read_bytes()
        self.assertEqual(re.findall(rb"comment scanner.*", tile), [b"comment scanner 0: 1 2 3"])
        self.assertNotIn(b" scan\n", tile)

    def test_tiles_leave_out_the_crowds_above_scanners(self):
        write_ply(self.folder / "room.ply", room_scan(), position_type="double", comments=["scanner 0: 100 50 1.5"])
        run("classify", self.folder / "room.ply", "-o", self.folder / "whole.ply")
        done = run("tiles", "plan", self.folder / "room.ply", "-o", self.folder / "p.json", "--tile", 3)
        self.assertIn("points crowd above and below scanners", done.stderr)
        run("tiles", "run", self.folder / "p.json")
        run("tiles", "join", self.folder / "p.json", "-o", self.folder / "joined.ply")
        whole, joined = (sorted_rows(self.folder / name) for name in ("whole.ply", "joined.ply"))
        self.assertGreater(np.mean(joined["scalar_edge_class"] == whole["scalar_edge_class"]), 0.9995)
        beams = np.c_[joined["x"], joined["y"], joined["z"]] - [100, 50, 1.5]
        above = beams[:, 2] > 0.95 * np.linalg.norm(beams, axis=1)
        self.assertGreater(np.sum(above), 100)
        self.assertLess(np.mean(abs(joined["nz"][above]) < 0.8), 0.02)

    def test_is_for_one_scan(self):
        write_ply(self.folder / "two.ply", panel_scan(0.05), scan=np.zeros(180))
        done = run("classify", self.folder / "two.ply", "--viewpoint", "0", "0", "0", expect=2)
        self.assertIn("two.ply: is of several scans, --viewpoint is for one", done.stderr)
        done = run("tiles", "plan", self.folder / "two.ply", "-o", self.folder / "p.json", "--viewpoint", 0, 0, 0,
                   expect=2)
        self.assertIn("two.ply: is of several scans", done.stderr)
        run("classify", self.folder / "scan.ply", "--viewpoint", "0", "nan", "0", expect=2)
        run("classify", self.folder / "scan.ply", "--method", "ca", "--viewpoint", "0", "0", "0", expect=2)


if __name__ == "__main__":
    unittest.main()
