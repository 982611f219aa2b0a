"""`pcednet info`: spacing, problems, folders with files that cannot be read."""
import json
import os
import re
import shutil
import signal
import struct
import subprocess
import unittest

import numpy as np

from las_test import FORMATS, las, random_rows, vlr
from support import PROGRAM, SOURCE, CliTest, cube, run, write_ply


class Info(CliTest):
    def info(self, *paths, expect=0):
        return json.loads(run("info", *paths, "--json", "-", expect=expect).stdout)

    def test_median_spacing_is_that_of_a_grid(self):
        grid = np.stack(np.meshgrid(*[np.arange(9.0)] * 3), -1).reshape(-1, 3) * 0.25
        write_ply(self.folder / "grid.ply", grid)
        self.assertEqual(self.info(self.folder / "grid.ply")[0]["median_spacing"], 0.25)

    def test_spacing_is_the_side_of_the_square_of_a_point(self):
        p, n, _ = cube(8000)
        write_ply(self.folder / "a.ply", p, n)
        spacing = self.info(self.folder / "a.ply")[0]["spacing"]
        self.assertAlmostEqual(spacing / np.sqrt(6 / 8000), 1, delta=0.1)
        said = run("lines", self.folder / "a.ply", "-o", self.folder / "a.obj").stderr
        of_lines = float(re.search(r"\n  spacing (\S+),", said)[1])  # away from the edges
        self.assertAlmostEqual(spacing / of_lines, 1, delta=0.05)
        self.assertIn(f"spacing        {spacing:.6g}, ", run("info", self.folder / "a.ply").stdout)

    def test_problems_are_named(self):
        p, n, _ = cube(500)
        p[1] = p[0]
        p[2, 0] = np.nan
        n[3] *= 2
        write_ply(self.folder / "a.ply", p + [2_600_000, 1_200_000, 0], n, position_type="double")
        problems = " ".join(self.info(self.folder / "a.ply")[0]["problems"])
        for part in ("1 of 500 points have no finite position", "1 of 500 points lie exactly",
                     "1 of 500 normals are not of unit length", "as float they would be rounded"):
            self.assertIn(part, problems)
        self.assertNotIn("no normals", problems)

    def test_rounding_of_float_coordinates(self):
        p, n, _ = cube(500)
        write_ply(self.folder / "far.ply", p + [500_000, 5_400_000, 0], n)
        self.assertIn("coordinates up to 5400000: as float they are rounded to 0.5",
                      " ".join(self.info(self.folder / "far.ply")[0]["problems"]))
        write_ply(self.folder / "twice.ply", np.vstack([p, p]) + [9, 9, 0], np.vstack([n, n]))
        self.assertNotIn("rounded", " ".join(self.info(self.folder / "twice.ply")[0]["problems"]))

    def test_names_the_coordinate_system_by_its_code(self):
        keys = struct.pack("<16H", 1, 1, 0, 3, 1024, 0, 1, 1, 3072, 0, 1, 25832, 4096, 0, 1, 7837)
        wkt = b'PROJCS["a zone",GEOGCS["b"],AUTHORITY["EPSG","25833"]]\0'
        unknown = b'PROJCS["mine",GEOGCS["b"]]\0'
        path = self.folder / "a.las"
        for records, code, said in [
                ([], "", "coordinates    of no coordinate system that the file names\n"),
                ([(34735, keys)], "EPSG:25832+7837", "coordinates    EPSG:25832+7837\n"),
                ([(2112, wkt)], "EPSG:25833", "coordinates    EPSG:25833, a zone\n"),
                ([(2112, unknown)], "", 'coordinates    PROJCS["mine",GEOGCS["b"]]\n')]:
            with self.subTest(said=said):
                vlrs = [vlr(b"LASF_Projection", number, data) for number, data in records]
                path.write_bytes(las(6, random_rows(FORMATS[6], 20), vlrs))
                self.assertEqual(self.info(path)[0]["las"]["coordinate_system_code"], code)
                self.assertIn(said, run("info", path).stdout)

    def test_names_the_classes_of_las_by_the_point_format(self):
        path = self.folder / "a.las"
        for number, field, said in [(1, "classification", "6 building: 2, 8 model key point: 1, 12 overlap: 1, 14: 2\n"),
                                    (6, "Classification", "6 building: 2, 8: 1, 12: 1, 14 conductor wire: 2\n")]:
            rows = random_rows(FORMATS[number], 6)
            rows[field] = [6, 6, 8, 12, 14, 14]
            path.write_bytes(las(number, rows))
            self.assertIn("by class       " + said, run("info", path).stdout)

    def test_texts_that_las_leaves_empty_are_left_out(self):
        path = self.folder / "a.las"
        whole = las(6, random_rows(FORMATS[6], 6), [vlr(b"survey", 1, b"1234"), vlr(b"survey", 2, b"12", b"two")])
        path.write_bytes(whole)
        said = run("info", path).stdout
        self.assertIn("made by        a scanner / a program, day 100 of 2020\n", said)
        self.assertIn("record         survey 1, 4 bytes\n", said)
        self.assertIn("record         survey 2, 2 bytes, two\n", said)
        path.write_bytes(whole.replace(b"a scanner", bytes(9)))
        self.assertIn("made by        a program, day 100 of 2020\n", run("info", path).stdout)

    def test_outliers_are_counted(self):
        """As by brute force: fewer than three others within ten spacings; cells hold many points or few."""
        p, n, _ = cube(1500)
        random = np.random.default_rng(7)
        p = np.concatenate([p, random.uniform(-1.5, 1.5, (40, 3)), [[9, 9, 9]] * 3, [[-9, 1e6, 9]] * 4, [[1e30, 0, 0]]])
        write_ply(self.folder / "a.ply", p, position_type="double")
        facts = self.info(self.folder / "a.ply")[0]
        distances = np.linalg.norm(p[:, None] - p[None], axis=2)
        third = np.partition(distances, 3, axis=1)[:, 3]  # the nearest is the point itself
        outliers = (third > 10 * facts["spacing"]).sum()
        self.assertGreater(outliers, 20)
        self.assertLess(outliers, 44)
        self.assertEqual(facts["outliers"], outliers)
        self.assertIn(f"{outliers} of {len(p)} points are outliers", " ".join(facts["problems"]))

    def test_labels_of_a_result_in_las_are_told(self):
        write_ply(self.folder / "a.ply", *cube(3000)[:2])
        for ending in "ply", "laz":
            run("classify", self.folder / "a.ply", "-o", self.folder / f"result.{ending}")
        ply, las = (self.info(self.folder / f"result.{ending}")[0]["labels"] for ending in ("ply", "laz"))
        self.assertEqual(las, ply)
        self.assertIn("sharp-edge (2)", run("info", self.folder / "result.laz").stdout)

    def test_bounds_of_las_have_the_decimals_of_its_scale(self):
        p = np.round(np.random.default_rng(1).random((100, 3)) * 1000 + [432100, 5812000.5, 0], 3)
        (self.folder / "a.xyz").write_text("".join("%.3f %.3f %.3f\n" % tuple(q) for q in p))
        run("convert", self.folder / "a.xyz", "-o", self.folder / "a.las")
        ends = {"min": p.min(axis=0).tolist(), "max": p.max(axis=0).tolist()}
        self.assertEqual(self.info(self.folder / "a.las")[0]["bounds"], ends)
        said = run("info", self.folder / "a.las").stdout
        for name, end in (("least", "min"), ("largest", "max")):
            self.assertIn(f"{name} x y z".ljust(15) + " ".join(map(repr, ends[end])) + "\n", said)

    def test_a_good_cloud_has_no_problems(self):
        p, n, _ = cube(500)
        write_ply(self.folder / "a.ply", p, n)
        self.assertEqual(self.info(self.folder / "a.ply")[0]["problems"], [])

    def test_an_unreadable_file_does_not_stop_the_others(self):
        p, n, _ = cube(100)
        write_ply(self.folder / "c.ply", p, n)
        (self.folder / "b.ply").write_bytes(b"ply\nformat nonsense\n")
        files = self.info(self.folder, expect=3)
        self.assertIn("b.ply", files[0]["error"])
        self.assertEqual(files[1]["points"], 100)

    def test_a_sample_is_read_of_a_large_file_unless_all_are_asked_for(self):
        side = np.arange(128.0)  # two million points and more
        grid = np.stack(np.meshgrid(side, side, side, indexing="ij"), -1).reshape(-1, 3) * 0.25
        labels = (grid[:, 0] > 15).astype(np.uint8)
        random = np.random.default_rng(3).permutation(len(grid))
        for name, order in (("slabs", slice(None)), ("random", random)):
            write_ply(self.folder / "a.ply", grid[order], labels=labels[order])
            part, = self.info(self.folder / "a.ply")
            self.assertEqual((part["points"], part["points_read"]), (len(grid), 800000))
            self.assertEqual(sum(part["labels"].values()), 800000)
            if name == "slabs":
                self.assertEqual(part["median_spacing"], 0.25)
                # Of a cubic grid, the tenth nearest is at the diagonal of a face.
                self.assertAlmostEqual(part["spacing"], 0.25 * np.sqrt(2 * np.pi / 11), places=12)
            else:
                self.assertNotIn("median_spacing", part)
            said = run("info", self.folder / "a.ply").stdout
            self.assertRegex(said, r"read +800000, a sample: .* --all reads every point")
            self.assertRegex(said, r"outliers +not counted: the file is read in parts")
        whole, = self.info(self.folder / "a.ply", "--all")
        self.assertNotIn("points_read", whole)
        self.assertEqual(whole["median_spacing"], 0.25)
        self.assertAlmostEqual(whole["spacing"], 0.25 * np.sqrt(2 * np.pi / 11), places=12)
        self.assertEqual(whole["labels"]["1"], int(labels.sum()))
        self.assertEqual(whole["bounds"], {"min": [0, 0, 0], "max": [31.75] * 3})
        run("convert", self.folder / "a.ply", "-o", self.folder / "a.las")
        part, = self.info(self.folder / "a.las")
        self.assertEqual((part["bounds"]["max"], part["points"]), ([31.75] * 3, len(grid)))
        self.assertEqual(sum(part["las"]["points_by_return"].values()), part["points_read"])

    def test_describes_models_by_an_extension_in_any_case(self):
        model = self.folder / "M.SafeTensors"
        shutil.copy(SOURCE / "models/scan.safetensors", model)
        self.assertIn("  format         model\n", run("info", model).stdout)

    def test_ctrl_c_ends_a_long_reading(self):
        write_ply(self.folder / "a.ply", np.random.default_rng(3).random((2_100_000, 3)))
        process = subprocess.Popen([PROGRAM, "info", str(self.folder / "a.ply"), "--all", "--threads", "1",
                                    "--progress", "plain"], stderr=subprocess.PIPE, stdout=subprocess.PIPE)
        self.assertIn(b"read", process.stderr.readline())
        process.send_signal(signal.SIGINT)
        said = process.communicate(timeout=60)
        self.assertEqual((process.returncode, said[0]), (130, b""))

    def test_lists_files_in_a_virtual_point_cloud_by_their_headers(self):
        p, n, _ = cube(300)
        write_ply(self.folder / "a.ply", p, n)
        tiles = self.folder / "tiles"
        tiles.mkdir()
        for name in ("a.laz", "b.copc.laz"):
            run("convert", self.folder / "a.ply", "-o", tiles / name)
        whole = (tiles / "a.laz").read_bytes()
        (tiles / "a.laz").write_bytes(whole[:-200])  # damaged points do not matter
        made = run("info", tiles, "--vpc", self.folder / "all.vpc")
        self.assertIn("2 files, 600 points", made.stderr)
        items = json.loads((self.folder / "all.vpc").read_text())["features"]
        self.assertEqual([item["assets"]["data"]["href"] for item in items],
                         ["./tiles/a.laz", "./tiles/b.copc.laz"])
        self.assertEqual([item["properties"]["pc:count"] for item in items], [300, 300])
        run("info", tiles, "--vpc", self.folder / "all.vpc", expect=2)
        bare = bytearray(whole)
        struct.pack_into("<6d", bare, 179, *[np.nan] * 6)
        (self.folder / "bare.laz").write_bytes(bare)
        self.assertRegex(run("info", self.folder / "bare.laz").stdout, r"points +300\n")
        said = run("info", self.folder / "bare.laz", "--vpc", self.folder / "b.vpc", expect=3).stderr
        self.assertIn("bare.laz: byte 179: the header has no bounds of the points", said)
        said = run("info", self.folder / "a.ply", "--vpc", self.folder / "b.vpc", expect=2).stderr
        self.assertIn("a.ply: --vpc lists LAS, LAZ and COPC files, which pcednet convert writes", said)
        self.assertFalse((self.folder / "b.vpc").exists())
        os.rename(tiles / "a.laz", os.fsencode(tiles) + b"/lat\xfcin.laz")
        done = subprocess.run([PROGRAM, "info", str(tiles), "--vpc", str(self.folder / "c.vpc")], capture_output=True)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn(b"lat\xfcin.laz: the name is not in UTF-8", done.stderr)
        self.assertFalse((self.folder / "c.vpc").exists())


if __name__ == "__main__":
    unittest.main()
