"""pcednet tiles: the labels of the whole from any inputs, and their columns."""
import json
import re
import struct
import unittest

import numpy as np

from las_test import FORMATS, descriptor, las, vlr
from support import read_ply, run, write_ply
from tiles_support import TilesTest, field, sorted_rows, stairs


class Tiles(TilesTest):
    def test_labels_are_those_of_the_whole_cloud(self):
        write_ply(self.folder / "a.ply", *field(3))
        self.check_equal_to_untiled(self.folder / "a.ply", 0.9999, jobs=2)
        self.check_equal_to_untiled(self.folder / "a.ply", 0.9999, "--model", "worn")

    def test_labels_are_those_of_the_whole_cloud_without_normals(self):
        write_ply(self.folder / "bare.ply", *field(3, normals=False))
        self.check_equal_to_untiled(self.folder / "bare.ply", 0.999)

    def test_labels_are_those_of_the_whole_cloud_if_rounded(self):
        p, _ = field(3)
        c, s = np.cos(0.5), np.sin(0.5)
        oblique = p @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]) @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
        write_ply(self.folder / "rounded.ply", np.round(oblique / 0.02).astype(np.float32) * 0.02)
        self.check_equal_to_untiled(self.folder / "rounded.ply", 0.9999)
        plan = json.loads((self.folder / "p.json").read_text())
        self.assertAlmostEqual(plan["normals"]["rounded_to"], 0.02, 6)
        self.assertIn("rounded to 0.02", plan["notes"][0])

    def test_labels_are_those_of_the_whole_cloud_where_the_spacing_varies(self):
        p, n = field(3)
        kept = np.random.default_rng(4).random(len(p)) < 0.04 + np.exp(-1.5 * p[:, 0])
        write_ply(self.folder / "uneven.ply", p[kept], n[kept])
        said = self.check_equal_to_untiled(self.folder / "uneven.ply", 0.999)
        self.assertIn("where points are sparser", said)
        plan = json.loads((self.folder / "p.json").read_text())
        self.assertEqual(len(plan["pyramids"]), 4)

    def test_few_points_of_a_scan_are_a_piece_in_every_tile(self):
        p, _ = field(2, 400, seed=2)
        near = np.argsort(np.abs(p[:, :2] - p[0, :2]).max(axis=1))[:2500]
        write_ply(self.folder / "piece.ply", p[near])
        said = self.check_equal_to_untiled(self.folder / "piece.ply", 0.999, tile=0.3)
        self.assertNotIn("fewer than 4000", said)

    def test_a_plan_is_the_same_again_and_says_what_decides(self):
        p, n = field(3, 600)
        write_ply(self.folder / "a.ply", p, n)
        plan, content = self.make_plan(self.folder / "a.ply", tile=1.0)
        first = plan.read_bytes()
        run("tiles", "plan", self.folder / "a.ply", "-o", plan, "--tile", 1, "--threads", 1,
            "--overwrite")
        self.assertEqual(plan.read_bytes(), first)
        for name in ("program", "model", "scales", "normals", "pyramids", "buffer", "inputs"):
            self.assertIn(name, content)
        self.assertEqual(sum(t["points"] for t in content["tiles"]), len(p))
        self.assertEqual(len(content["model"]["sha256"]), 64)
        self.assertEqual(content["box"][:3], [float(v) for v in p.min(axis=0)])
        said = run("classify", self.folder / "a.ply").stderr
        self.assertIn(f"scales: {content['scales']['s_min']:.9g} to "
                      f"{content['scales']['s_max']:.9g}", said)

    def test_other_formats_are_refused_with_the_command_that_makes_one_of_these(self):
        p, n = field(2, 200)
        write_ply(self.folder / "a.ply", p, n)
        for other, readable in (("a.xyz", "a.laz"), ("a.pcd", "a.laz"), ("text.ply", "text.laz")):
            other, readable = self.folder / other, self.folder / readable
            run("convert", self.folder / "a.ply", "-o", other, *(["--ascii"] if other.suffix == ".ply" else []))
            said = run("tiles", "plan", other, "-o", self.folder / "q.json", expect=2).stderr
            command = f"convert {other} -o {readable}"
            self.assertIn(f"pcednet {command} makes one", said)
            run(*command.split(), "--overwrite")
            self.make_plan(readable)

    def test_las_keeps_its_columns_and_steps(self):
        p, n = field(3, 600)
        write_ply(self.folder / "a.ply", p + np.float32(100), n)
        run("convert", self.folder / "a.ply", "-o", self.folder / "in.laz")
        run("convert", self.folder / "in.laz", "-o", self.folder / "in.ply")
        plan, content = self.make_plan(self.folder / "in.laz", "--output",
                                       "{XLEFT}_{YBOTTOM}.laz", tile=1.0)
        run("tiles", "run", plan)
        run("tiles", "join", plan, "-o", self.folder / "out.laz")
        run("convert", self.folder / "out.laz", "-o", self.folder / "out.ply")
        run("tiles", "join", plan, "-o", self.folder / "out.xyz")
        run("convert", self.folder / "out.xyz", "-o", self.folder / "text.ply")
        self.assertEqual(len(sorted_rows(self.folder / "text.ply")), content["points"])
        run("classify", self.folder / "in.laz", "-o", self.folder / "whole.laz")
        run("convert", self.folder / "whole.laz", "-o", self.folder / "whole.ply")
        out, whole = (sorted_rows(self.folder / name) for name in ("out.ply", "whole.ply"))
        self.assertEqual(out.dtype, whole.dtype)
        for name in out.dtype.names:
            if not name.startswith(("scalar_", "quality", "label")):
                np.testing.assert_array_equal(out[name], whole[name], err_msg=name)
        self.assertGreater(np.mean(out["scalar_edge_class"] == whole["scalar_edge_class"]), 0.9999)
        self.assertTrue((self.folder / "p_tiles/100_100.laz").exists())

    def test_tiles_are_listed_in_a_virtual_point_cloud(self):
        p, n = field(3, 300)
        write_ply(self.folder / "a.ply", p, n)
        run("convert", self.folder / "a.ply", "-o", self.folder / "a.laz")
        plan, content = self.make_plan(self.folder / "a.laz", tile=1.4)
        vpc = self.folder / "a.vpc"
        said = run("tiles", "join", plan, "--vpc", vpc, expect=4).stderr
        self.assertIn("tiles are missing or damaged: 0 to", said)
        self.assertFalse(vpc.exists())
        run("tiles", "run", plan)
        run("tiles", "join", plan, "--vpc", vpc, "-o", self.folder / "joined.laz")
        self.assertTrue((self.folder / "joined.laz").exists())
        listed = {}
        for item in json.loads(vpc.read_text())["features"]:
            listed[item["assets"]["data"]["href"]] = item["properties"]["pc:count"]
        self.assertEqual(listed, {"./" + t["output"]: t["points"] for t in content["tiles"]})
        before = vpc.read_bytes()
        run("info", self.folder / "p_tiles", "--vpc", self.folder / "b.vpc")
        self.assertEqual((self.folder / "b.vpc").read_bytes(), before)
        run("tiles", "join", plan, "--vpc", vpc, expect=2)  # exists
        self.assertIn("needs -o FILE, --vpc FILE", run("tiles", "join", plan, expect=2).stderr)
        plan, _ = self.make_plan(self.folder / "a.ply", tile=10)
        run("tiles", "run", plan)
        said = run("tiles", "join", plan, "--vpc", self.folder / "c.vpc", expect=2).stderr
        self.assertIn("0.ply: --vpc lists LAS, LAZ and COPC files; tiles plan --output {ID}.laz", said)

    def test_copc_and_virtual_point_clouds_are_planned(self):
        p, n = field(3, 600)
        write_ply(self.folder / "a.ply", p, n)
        run("convert", self.folder / "a.ply", "-o", self.folder / "a.laz")
        run("convert", self.folder / "a.laz", "-o", self.folder / "a.ply", "--overwrite")
        (self.folder / "in").mkdir()
        rows, _ = read_ply(self.folder / "a.ply")
        for name, part in (("left", rows["x"] < 1.2), ("right", rows["x"] >= 1.2)):
            some = np.column_stack([rows[a] for a in "xyz"])[part]
            normals = np.column_stack([rows["n" + a] for a in "xyz"])[part]
            write_ply(self.folder / "b.ply", some, normals, position_type="double")
            run("convert", self.folder / "b.ply", "-o", self.folder / f"in/{name}.copc.laz")
            (self.folder / "b.ply").unlink()
        run("info", self.folder / "in", "--vpc", self.folder / "in.vpc")
        plan, content = self.make_plan(self.folder / "in.vpc", tile=1.4)
        self.assertEqual([i["path"] for i in content["inputs"]],
                         ["in/left.copc.laz", "in/right.copc.laz"])
        # Each file is in the finest steps that hold it, which do not hold both together.
        self.assertIn("rounded to steps of 1e-08", "".join(content["notes"]))
        run("tiles", "run", plan)
        run("tiles", "join", plan, "-o", self.folder / "joined.laz")
        run("convert", self.folder / "joined.laz", "-o", self.folder / "joined.ply")
        joined, whole = sorted_rows(self.folder / "joined.ply"), sorted_rows(self.folder / "a.ply")
        for name in "xyz":
            np.testing.assert_allclose(joined[name], whole[name], atol=1e-7)
        # Each file of the list is a point file to other commands, under the name without .copc.
        run("classify", self.folder / "in.vpc", "--out-dir", self.folder / "out")
        self.assertEqual(sorted(f.name for f in (self.folder / "out").iterdir()),
                         ["left_edges.laz", "right_edges.laz"])
        (self.folder / "in/left.copc.laz").unlink()
        said = run("tiles", "plan", self.folder / "in.vpc", "-o", self.folder / "q.json", expect=3).stderr
        self.assertIn("in.vpc: refers to ./in/left.copc.laz, but ", said)

    def test_several_inputs_are_one_cloud(self):
        p, n = field(3, 600)
        half = p[:, 0] < 1.2
        write_ply(self.folder / "a.ply", p, n)
        (self.folder / "in").mkdir()
        write_ply(self.folder / "in/left.ply", p[half], n[half])
        write_ply(self.folder / "in/right.ply", p[~half], n[~half])
        plan, _ = self.make_plan(self.folder / "in", tile=1.4)
        run("tiles", "run", plan)
        rows = self.check_whole(plan, self.folder / "a.ply")
        run("classify", self.folder / "a.ply", "-o", self.folder / "whole.ply")
        whole = sorted_rows(self.folder / "whole.ply")
        self.assertGreater(np.mean(rows["scalar_edge_class"] == whole["scalar_edge_class"]), 0.9999)
        write_ply(self.folder / "in/other.ply", p, n, np.zeros(len(p), np.uint8))
        said = run("tiles", "plan", self.folder / "in", "-o", self.folder / "q.json", expect=2)
        self.assertIn("different columns; only", said.stderr)
        self.assertIn("other.ply has labels: plan them one by one", said.stderr)

    def test_las_of_different_forms_is_one_cloud(self):
        p, _ = field(3, 400)
        steps = np.unique(np.rint((p + 100) * 1000).astype(np.int32), axis=0)  # in millimetres
        extra = [("Amplitude", "<u2")]
        (self.folder / "in").mkdir()
        parts = {}
        for k, number in enumerate((1, 3, 6, 7, 8)):
            some = steps[k::5]
            rows = np.zeros(len(some), FORMATS[number] + (extra if number == 3 else []))
            for field_of_las in rows.dtype.names:
                rows[field_of_las] = 1 + np.arange(len(some)) % 7
            for axis, name in enumerate("XYZ"):
                rows[name] = some[:, axis]
            rows["returns"] = 0x11 if number > 5 else 0x09  # the only one
            if number == 7:
                rows["Red"] *= 1000  # the colours of the others are below 256
            parts[number] = rows
            vlrs = [vlr(b"LASF_Spec", 4, descriptor("Amplitude", 3))] if number == 3 else []
            (self.folder / f"in/{number}.las").write_bytes(las(number, rows, vlrs))
        for options in ((), ("--sort", self.folder / "sorted")):
            said = run("tiles", "plan", self.folder / "in", "-o", self.folder / "p.json", "--tile", 1.4,
                       "--overwrite", *options).stderr
            self.assertIn("the tiles have all, with 0 where an input has none: Amplitude, Blue, Green, Infrared, Red",
                          said)
            run("tiles", "run", self.folder / "p.json")
            run("tiles", "join", self.folder / "p.json", "-o", self.folder / "all.las", "--overwrite")
            self.check_forms(self.folder / "all.las", parts)

    def check_forms(self, joined, parts):
        """That a file of point format 8 has the points of all parts, with their values."""
        data = joined.read_bytes()
        self.assertEqual((data[25], data[104]), (4, 8))
        start, = struct.unpack_from("<I", data, 96)
        types = FORMATS[8] + [("Amplitude", "<u2"), ("edge_class", "u1"), ("p", "<f4", 2)]
        rows = np.frombuffer(data, types, struct.unpack_from("<Q", data, 247)[0], start)
        place_of = {point: i for i, point in enumerate(zip(rows["X"], rows["Y"], rows["Z"]))}
        self.assertEqual(len(place_of), sum(len(part) for part in parts.values()))
        for number, part in parts.items():
            its = rows[[place_of[point] for point in zip(part["X"], part["Y"], part["Z"])]]
            np.testing.assert_array_equal(its["returns"], 0x11)
            for name in ("Intensity", "UserData", "PointSourceId", "GpsTime"):
                np.testing.assert_array_equal(its[name], part[name])
            for name in ("Red", "Green", "Blue", "Infrared", "Amplitude"):
                np.testing.assert_array_equal(its[name], part[name] if name in part.dtype.names else 0)
            angle = np.rint(part["ScanAngleRank"] / 0.006) if number < 6 else part["ScanAngle"]
            np.testing.assert_array_equal(its["ScanAngle"], angle)
            old = "classification" if number < 6 else "Classification"
            np.testing.assert_array_equal(its["Classification"], part[old])
        self.assertGreater(np.mean(rows["edge_class"] == 2), 0.02)

    def test_ply_beside_las_is_refused_with_the_command_that_makes_las(self):
        p, n = field(2, 200)
        half = p[:, 0] < 0.7
        write_ply(self.folder / "a.ply", p[half])
        write_ply(self.folder / "b.ply", p[~half])
        run("convert", self.folder / "a.ply", "-o", self.folder / "a.laz")
        said = run("tiles", "plan", self.folder / "a.laz", self.folder / "b.ply", "-o", self.folder / "q.json",
                   expect=2).stderr
        command = f"convert {self.folder / 'b.ply'} -o {self.folder / 'b.laz'}"
        self.assertIn(f"columns of LAZ may differ, and pcednet {command} makes one", said)
        run(*command.split())
        run("tiles", "plan", self.folder / "a.laz", self.folder / "b.laz", "-o", self.folder / "q.json")

    def test_results_and_files_without_points_are_no_inputs(self):
        p, n = field(3, 300)
        (self.folder / "in").mkdir()
        for name, some in (("a", slice(0, 3000)), ("b", slice(3000, None)), ("empty", slice(0, 0))):
            write_ply(self.folder / f"in/{name}.ply", p[some], n[some])
        for name in ("a", "empty"):
            run("convert", self.folder / f"in/{name}.ply", "-o", self.folder / f"in/{name}.laz")
            (self.folder / f"in/{name}.ply").unlink()
        run("convert", self.folder / "in/b.ply", "-o", self.folder / "in/b.laz")
        (self.folder / "in/b.ply").unlink()
        run("classify", self.folder / "in/a.laz")
        said = run("tiles", "plan", self.folder / "in", "-o", self.folder / "p.json", "--tile", 1.4).stderr
        self.assertIn("1 file left out: it is the result of another input", said)
        self.assertIn("empty.laz: no points in it, left out", said)
        content = json.loads((self.folder / "p.json").read_text())
        self.assertEqual([i["path"] for i in content["inputs"]], ["in/a.laz", "in/b.laz"])
        said = run("tiles", "plan", self.folder / "in/empty.laz", "-o", self.folder / "q.json", expect=4).stderr
        self.assertIn("the inputs have no point with a finite position", said)

    def test_the_same_points_twice_are_told(self):
        p, n = field(3, 300)
        for name in ("a.ply", "b.ply"):
            write_ply(self.folder / name, p, n)
        said = run("tiles", "plan", self.folder / "a.ply", self.folder / "b.ply", "-o", self.folder / "p.json").stderr
        self.assertIn(f"b.ply: holds the same points as {self.folder}/a.ply: they count twice", said)
        said = run("tiles", "plan", self.folder / "a.ply", "-o", self.folder / "q.json").stderr
        self.assertNotIn("doubled", said)

    def test_ply_made_of_coloured_las_is_read_in_tiles(self):
        p, n = field(3, 300)
        write_ply(self.folder / "a.ply", p, n, red=7, green=8, blue=9)
        run("convert", self.folder / "a.ply", "-o", self.folder / "a.las")
        run("convert", self.folder / "a.las", "-o", self.folder / "b.ply")
        self.assertIn(b"property ushort Red", (self.folder / "b.ply").read_bytes()[:4000])
        plan, _ = self.make_plan(self.folder / "b.ply")
        run("tiles", "run", plan)
        run("tiles", "join", plan, "-o", self.folder / "joined.ply")
        rows, _ = read_ply(self.folder / "joined.ply")
        self.assertEqual({tuple(rows[c][5] for c in ("Red", "Green", "Blue"))}, {(7 * 257, 8 * 257, 9 * 257)})

    def test_inputs_in_random_order_can_be_sorted_first(self):
        p, n = field(3, 600)
        p[::700] = np.nan
        p[350] = 1e30
        order = np.random.default_rng(4).permutation(len(p))
        write_ply(self.folder / "a.ply", p[order], n[order])
        plan, content = self.make_plan(self.folder / "a.ply", "--sort", self.folder / "sorted",
                                       tile=1.4)
        self.assertEqual(len(content["inputs"]), len(content["tiles"]))
        self.assertEqual(len(list((self.folder / "sorted").iterdir())), len(content["tiles"]))
        run("tiles", "run", plan)
        rows = self.check_whole(plan, self.folder / "a.ply")
        run("classify", self.folder / "a.ply", "-o", self.folder / "whole.ply")
        whole = sorted_rows(self.folder / "whole.ply")
        self.assertEqual(rows.dtype, whole.dtype)
        self.assertGreater(np.mean(rows["scalar_edge_class"] == whole["scalar_edge_class"]), 0.9999)

    def test_random_order_is_refused_after_the_first_reading(self):
        p, n = field()
        order = np.random.default_rng(4).permutation(len(p))
        write_ply(self.folder / "a.ply", p[order], n[order])
        said = run("tiles", "plan", self.folder / "a.ply", "-o", self.folder / "p.json", "--tile", 0.15,
                   "--progress", "plain", expect=2).stderr
        self.assertIn("in no order in space", said)
        self.assertIn("sort the inputs: --sort FOLDER makes copies in order", said)
        self.assertIn("index 100 %", said)
        self.assertNotIn("dense sample", said)

    def test_much_reading_is_said(self):
        p, n = field(6, 3000)
        order = np.random.default_rng(4).permutation(len(p))
        write_ply(self.folder / "a.ply", (p[order] + 1) * np.float32([2, 1, 1]), n[order])
        plan = self.folder / "p.json"
        for much, *options in ((False, "--tile", 20), (False, "--tile", 2, "--sort", self.folder / "sorted"),
                               (True, "--tile", 2)):
            said = run("tiles", "plan", self.folder / "a.ply", "-o", plan, "--overwrite", *options).stderr
            found = re.search(r"the (\d+) tiles will read each point ([\d.]+) times, but about ([\d.]+) times from "
                              r"copies in order, which --sort FOLDER makes", said)
            self.assertEqual(found is not None, much, said)
        tiles, times, in_order = map(float, found.groups())
        self.assertEqual(tiles, len(json.loads(plan.read_text())["tiles"]))
        self.assertAlmostEqual(times, tiles, delta=2)  # each reads nearly all
        self.assertLess(in_order, 10)

    def test_normals_that_were_estimated_are_estimated_again(self):
        p, _ = field(3, 300, normals=False)
        write_ply(self.folder / "bare.ply", p)
        run("classify", self.folder / "bare.ply", "-o", self.folder / "a.ply")
        self.check_equal_to_untiled(self.folder / "a.ply", 0.9999)
        rows, whole = (sorted_rows(self.folder / name) for name in ("joined.ply", "a.ply"))
        self.assertGreater(np.mean(rows["scalar_edge_class"] == whole["scalar_edge_class"]), 0.9999)
        given = (self.folder / "a.ply").read_bytes().replace(b"normals estimated", b"normals measured")
        (self.folder / "b.ply").write_bytes(given)
        said = run("tiles", "plan", self.folder / "a.ply", self.folder / "b.ply", "-o",
                   self.folder / "q.json", expect=2)
        self.assertIn("differ in whether pcednet estimated their normals", said.stderr)

    def test_noise_thicker_than_the_spacing_is_averaged_as_in_the_whole_cloud(self):
        write_ply(self.folder / "a.ply", stairs())
        said = self.check_equal_to_untiled(self.folder / "a.ply", 0.9999, tile=6)
        plan = json.loads((self.folder / "p.json").read_text())
        self.assertLess(plan["buffer"], 25)  # of 60: no tile sees all points
        self.assertAlmostEqual(plan["normals"]["averaged_noise"], 0.1, delta=0.01)
        self.assertIn("points are averaged to", plan["notes"][0])
        self.assertIn(plan["notes"][0], said)
        # Not by a model without experts, nor where the smallest scale is given.
        for options in ("--model", "cad"), ("--s-min", 0.06):
            _, plan = self.make_plan(self.folder / "a.ply", *options, tile=6)
            self.assertEqual(plan["normals"]["averaged_noise"], 0)

    def test_what_a_sample_shows_is_said_to_be_of_a_sample(self):
        p = np.random.default_rng(2).uniform(0, 100, (310_000, 3))
        p[:, 2] = np.sin(p[:, 0] / 9)
        write_ply(self.folder / "a.ply", p)
        said = run("tiles", "plan", self.folder / "a.ply", "-o", self.folder / "p.json").stderr
        self.assertRegex(said, r"in a sample of 15\d{4} points: no normals in the file")
        self.assertIn("310000 points in 1 tile of length", said)

    def test_points_of_no_place_stay_and_change_no_other(self):
        p, n = field(3, 300)
        p[::500] = np.nan
        p[250] = 1e30
        write_ply(self.folder / "a.ply", p, n)
        said = run("tiles", "plan", self.folder / "a.ply", "-o", self.folder / "p.json", "--tile", 1.4)
        plan = self.folder / "p.json"
        self.assertIn("12 of 5400 points have no finite position up to 1e+15", said.stderr)
        self.assertEqual(len(json.loads(plan.read_text())["tiles"]), 9)
        run("tiles", "run", plan)
        run("tiles", "join", plan, "-o", self.folder / "joined.ply")
        rows, _ = read_ply(self.folder / "joined.ply")
        self.assertEqual(len(rows), len(p))
        lost = ~(rows["x"] < 1e15)
        self.assertEqual(lost.sum(), 12)
        self.assertTrue(np.all((rows["scalar_edge_class"] == 255) == lost))
        run("classify", self.folder / "a.ply", "-o", self.folder / "whole.ply")
        rows, whole = (sorted_rows(self.folder / name) for name in ("joined.ply", "whole.ply"))
        self.assertGreater(np.mean(rows["scalar_edge_class"] == whole["scalar_edge_class"]), 0.9999)


if __name__ == "__main__":
    unittest.main()
