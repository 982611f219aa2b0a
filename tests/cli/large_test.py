"""pcednet classify --max-memory: clouds that memory does not hold, with the result of those that it does."""
import os
import re
import resource
import signal
import subprocess
import time
import unittest

import numpy as np

from support import PROGRAM, CliTest, read_ply, run, write_ply
from tiles_support import field, stairs

CHANCE = ("quality", "scalar_p_sharp", "scalar_p_smooth")  # their last digits may differ
LABELS = ("label", "scalar_edge_class", "red", "green", "blue")


class Large(CliTest):
    def classified(self, cloud, ending, *options):
        """In memory and in tiles."""
        whole, tiled = self.folder / ("whole" + ending), self.folder / ("tiled" + ending)
        said = run("classify", cloud, "-o", whole, *options).stderr
        self.assertNotIn("in tiles", said)
        how = re.findall("  (?:scales|decided).*", said)
        before = set(os.listdir(self.folder))
        said = run("classify", cloud, "-o", tiled, "--max-memory", "101M", *options).stderr
        self.assertRegex(said, r"points may take \d+ MiB of memory, more than 101 MiB: classified in tiles")
        self.assertRegex(said, r"  \d+ tiles of length")
        self.assertEqual(re.findall("  (?:scales|decided).*", said), how)
        self.assertEqual(set(os.listdir(self.folder)) - before, {tiled.name})
        self.how = "".join(how)
        return whole, tiled

    def check_equal(self, whole, tiled, least):
        (whole, head), (tiled, other) = read_ply(whole), read_ply(tiled)
        self.assertEqual(head, other)
        labels = whole["label"] == tiled["label"]
        self.assertGreaterEqual(np.mean(labels), least)
        self.assertGreater(np.mean(whole["label"] == 2), 0.02)
        for name in whole.dtype.names:  # in the order of the input, and the colours of the classes
            if name in LABELS:
                np.testing.assert_array_equal(whole[name][labels], tiled[name][labels], err_msg=name)
            elif name in CHANCE:
                self.assertLess(np.mean(abs(whole[name] - tiled[name]) > 1e-3), 1 - least + 1e-4, name)
            elif name not in ("nx", "ny", "nz"):
                np.testing.assert_array_equal(whole[name], tiled[name], err_msg=name)
        if "nx" in whole.dtype.names:
            along = sum(whole[name] * tiled[name] for name in ("nx", "ny", "nz"))
            self.assertGreater(np.mean(along > 0.999), least)

    def test_the_file_is_that_of_the_cloud_in_memory(self):
        p, n = field(3)
        p[7] = np.nan
        write_ply(self.folder / "a.ply", p, n)
        self.check_equal(*self.classified(self.folder / "a.ply", ".ply"), 0.9999)

    def test_normals_are_estimated_and_fields_kept(self):
        p, _ = field(3, normals=False)
        write_ply(self.folder / "a.ply", p + np.float32(100), labels=np.arange(len(p)) % 7)
        run("convert", self.folder / "a.ply", "-o", self.folder / "in.laz")
        found = self.classified(self.folder / "in.laz", ".laz", "--las-classification", "2=64")
        plys = []
        for laz in found:
            plys.append(laz.with_suffix(".ply"))
            run("convert", laz, "-o", plys[-1])
        self.check_equal(*plys, 0.999)
        rows, _ = read_ply(plys[1])
        np.testing.assert_array_equal(rows["Classification"] == 64, rows["scalar_edge_class"] == 2)

    def test_the_scales_and_the_networks_are_told(self):
        p, random = field(4, normals=False)[0], np.random.default_rng(4)
        kept = random.random(len(p)) < 0.04 + np.exp(-1.5 * p[:, 0])
        q = field(3)[0]
        for name, cloud, words in (
                ("sparser", p[kept], "where points are sparser"),
                ("noisy", q + 0.02 * random.normal(size=q.shape), "of this kind: estimated normals, noisy points")):
            write_ply(self.folder / f"{name}.ply", cloud)
            self.classified(self.folder / f"{name}.ply", f"_{name}.ply")
            self.assertIn(words, self.how)

    def test_a_picture_is_drawn_and_copc_written(self):
        write_ply(self.folder / "a.ply", *field(3))
        run("classify", self.folder / "a.ply", "-o", self.folder / "a.copc.laz", "--max-memory", "101M",
            "--preview", self.folder / "a.png")
        self.assertGreater((self.folder / "a.png").stat().st_size, 10000)
        said = run("info", self.folder / "a.copc.laz").stdout
        self.assertIn("points         36000", said)

    def test_ctrl_c_leaves_nothing(self):
        write_ply(self.folder / "a.ply", *field())
        process = subprocess.Popen([PROGRAM, "classify", str(self.folder / "a.ply"), "--max-memory", "105M",
                                    "--progress", "plain"], stderr=subprocess.PIPE, text=True)
        for line in process.stderr:
            if line.startswith("tiles ") and not line.startswith("tiles 0"):
                break
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130)
        self.assertEqual(os.listdir(self.folder), ["a.ply"])

    def test_a_full_disk_is_said_and_leaves_nothing(self):
        write_ply(self.folder / "a.ply", *field(3))
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))
        said = run("classify", self.folder / "a.ply", "--max-memory", "101M", expect=1, preexec_fn=limit).stderr
        self.assertIn("File too large", said)
        self.assertEqual(os.listdir(self.folder), ["a.ply"])

    def lines(self, cloud, *options):
        out = self.folder / "lines.obj"
        said = run("lines", cloud, "-o", out, "--overwrite", *options).stderr
        vertices, length, count = [], 0.0, 0
        for line in out.read_text().splitlines():
            words = line.split()
            if words[0] == "v":
                vertices.append(np.array(words[1:4], float))
            if words[0] == "l":
                ends = [vertices[int(w) - 1] for w in words[1:]]
                length += sum(np.linalg.norm(b - a) for a, b in zip(ends, ends[1:]))
                count += 1
        return count, length, said

    def test_lines_come_from_the_points_near_edges(self):
        write_ply(self.folder / "a.ply", *field(3))
        count, length, said = self.lines(self.folder / "a.ply")
        self.assertNotIn("in tiles", said)
        self.assertGreater(count, 72)  # 9 boxes
        for name in ("a.ply", "a_edges.ply"):
            if name == "a_edges.ply":
                run("classify", self.folder / "a.ply")
            tiled, tiled_length, said = self.lines(self.folder / name, "--max-memory", "101M")
            self.assertRegex(said, r"lines are found from the \d+ of 36000 points that are near edges")
            self.assertIn("101 MiB: classified in tiles" if name == "a.ply" else
                          "101 MiB: read in tiles; its labels are kept", said)
            self.assertAlmostEqual(tiled / count, 1, delta=0.02)
            self.assertAlmostEqual(tiled_length / length, 1, delta=0.01)
        # Labels that are all 255 are none, wherever the file has a label.
        p, n = field(3)[:2]
        labels = np.full(len(p), 255, np.uint8)
        for last, done in ((255, ": classified in tiles"), (2, "its labels are kept")):
            labels[-1] = last
            write_ply(self.folder / "c.ply", p, n, labels)
            self.assertIn(done, self.lines(self.folder / "c.ply", "--max-memory", "101M")[2])
        # Labels without normals: these are estimated in tiles.
        rows, _ = read_ply(self.folder / "a_edges.ply")
        p = np.column_stack([rows[a] for a in "xyz"])
        write_ply(self.folder / "b.ply", p, labels=rows["label"])
        count, length, _ = self.lines(self.folder / "b.ply")
        tiled, tiled_length, said = self.lines(self.folder / "b.ply", "--max-memory", "101M")
        self.assertIn("no normals in the file", said)
        self.assertAlmostEqual(tiled / count, 1, delta=0.02)
        self.assertAlmostEqual(tiled_length / length, 1, delta=0.01)

    def test_lines_that_memory_does_not_hold_are_refused_before_the_work(self):
        write_ply(self.folder / "a.ply", field(3, 5000, normals=False)[0])
        run("classify", self.folder / "a.ply", "-o", self.folder / "a.laz")
        done = run("lines", self.folder / "a.laz", "-o", self.folder / "a.obj", "--max-memory", "20M",
                   "--progress", "plain", expect=1)
        self.assertIn("their lines take more memory than 20 MiB", done.stderr)
        self.assertNotIn("tiles 0 %", done.stderr)

    def test_lines_of_thick_noise_come_from_averages(self):
        write_ply(self.folder / "a.ply", stairs())
        count, length, said = self.lines(self.folder / "a.ply")
        self.assertIn("points are averaged to", said)
        self.assertGreater(length, 100)
        run("classify", self.folder / "a.ply")
        for name in ("a.ply", "a_edges.ply"):
            tiled, tiled_length, said = self.lines(self.folder / name, "--max-memory", "101M")
            self.assertIn("points are averaged to", said)
            self.assertAlmostEqual(tiled / count, 1, delta=0.05)
            self.assertAlmostEqual(tiled_length / length, 1, delta=0.02)

    def test_what_cannot_be_cut_is_said(self):
        write_ply(self.folder / "a.ply", *field(3))
        said = run("classify", self.folder / "a.ply", "-o", self.folder / "a.pcd", "--max-memory", "101M").stderr
        self.assertIn("are written in tiles", said)
        self.assertIn("more than 101 MiB", said)
        run("convert", self.folder / "a.ply", "-o", self.folder / "a.pcd", "--overwrite")
        said = run("classify", self.folder / "a.pcd", "--max-memory", "101M").stderr
        self.assertNotIn("classified in tiles", said)
        self.assertRegex(said, r"a.pcd: about 36000 points may take \d+ MiB of memory, more than 101 MiB; LAS, LAZ")
        run("convert", self.folder / "a.ply", "-o", self.folder / "a.xyz")
        said = run("classify", self.folder / "a.xyz", "--max-memory", "101M", "--overwrite").stderr
        points = int(re.search(r"a.xyz: about (\d+) points may take", said)[1])
        self.assertAlmostEqual(points / 36000, 1, delta=0.1)
        said = run("classify", self.folder / "a.xyz", "--max-memory", "1G", "--overwrite").stderr
        self.assertNotIn("may take", said)
        run("classify", self.folder / "a.ply", "--max-memory", "lots", expect=2)
        run("classify", self.folder / "a.ply", "--max-memory", "1G", "--method", "fee", expect=2)

    def test_copc_stops_at_the_first_ctrl_c(self):
        p = np.random.default_rng(1).uniform(0, 100, (1_500_000, 3)).astype(np.float32)
        write_ply(self.folder / "a.ply", p)
        process = subprocess.Popen([PROGRAM, "convert", str(self.folder / "a.ply"), "-o",
                                    str(self.folder / "a.copc.laz"), "--progress", "plain"],
                                   stderr=subprocess.PIPE, text=True)
        for line in process.stderr:  # all points are known by then
            if line.startswith("octree "):
                break
        process.send_signal(signal.SIGINT)
        start = time.monotonic()
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130)
        self.assertLess(time.monotonic() - start, 20)
        self.assertEqual(os.listdir(self.folder), ["a.ply"])


if __name__ == "__main__":
    unittest.main()
