"""pcednet tiles: the labels of the whole, no point lost or doubled, whatever happens on the way."""
import collections
import json
import os
import pathlib
import random
import resource
import shutil
import signal
import subprocess
import unittest

import numpy as np

from support import PROGRAM, CliTest, read_ply, run, write_ply


def field(columns=4, points=2000, seed=1, normals=True):
    """Boxes of different sizes on rough ground: positions, normals."""
    random_numbers = np.random.default_rng(seed)
    p, n = [], []
    for x in range(columns):
        for y in range(columns):
            size = random_numbers.uniform(0.4, 0.8, 3)
            face = random_numbers.choice([0, 1, 2, 3, 5], points)  # without the underside
            axis, side = face // 2, np.where(face % 2 == 1, 0.5, -0.5)
            q = random_numbers.uniform(-0.5, 0.5, (points, 3))
            m = np.zeros((points, 3))
            q[np.arange(points), axis] = side
            m[np.arange(points), axis] = 2 * side
            p.append(q * size + (x, y, 0.5 * size[2]))
            n.append(m)
    ground = random_numbers.uniform(-0.6, columns - 0.4, (columns * columns * points, 3))
    ground[:, 2] = 0.0
    p.append(ground)
    n.append(np.tile([0.0, 0.0, 1.0], (len(ground), 1)))
    p = np.concatenate(p) + 0.001 * random_numbers.normal(size=(2 * len(ground), 3))
    return p.astype(np.float32), np.concatenate(n) if normals else None


def sorted_rows(path, names=("x", "y", "z")):
    """The chosen columns of all points, in an order free of that in the file."""
    rows, _ = read_ply(path)
    order = np.lexsort([rows[name] for name in names])
    return rows[order]


class Tiles(CliTest):
    def make_plan(self, cloud, *options, tile=1.3):
        plan = self.folder / "p.json"
        plan.unlink(missing_ok=True)
        shutil.rmtree(self.folder / "p_tiles", ignore_errors=True)
        run("tiles", "plan", cloud, "-o", plan, "--tile", tile, *options)
        return plan, json.loads(plan.read_text())

    def status(self, plan, *options):
        return json.loads(run("tiles", "status", plan, "--json", "-", *options).stdout)

    def small(self, tile=1.4):
        """A plan of nine tiles, by default, that run quickly."""
        p, n = field(3, 300)
        write_ply(self.folder / "small.ply", p, n)
        return self.make_plan(self.folder / "small.ply", tile=tile)

    def check_whole(self, plan, cloud):
        """Joins, and compares the points with the input's: none lost, none doubled."""
        joined = self.folder / "joined.ply"
        run("tiles", "join", plan, "-o", joined, "--overwrite")
        rows, names = sorted_rows(joined), ("x", "y", "z")
        expected = sorted_rows(cloud)
        self.assertEqual(len(rows), len(expected))
        for name in names:
            np.testing.assert_array_equal(rows[name], expected[name])
        return rows

    def check_equal_to_untiled(self, cloud, least, *options, jobs=1):
        """Returns what classify says."""
        plan, content = self.make_plan(cloud, *options)
        self.assertGreaterEqual(len(content["tiles"]), 9)
        run("tiles", "run", plan, "--jobs", jobs)
        rows = self.check_whole(plan, cloud)
        said = run("classify", cloud, "-o", self.folder / "whole.ply", "--overwrite", *options).stderr
        whole = sorted_rows(self.folder / "whole.ply")
        self.assertEqual(rows.dtype, whole.dtype)
        equal = np.mean(rows["scalar_edge_class"] == whole["scalar_edge_class"])
        self.assertGreaterEqual(equal, least)
        self.assertGreater(np.mean(whole["scalar_edge_class"] == 2), 0.02)
        return said

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
        self.check_equal_to_untiled(self.folder / "rounded.ply", 0.999)
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
        said = run("tiles", "join", plan, "--vpc", self.folder / "c.vpc", expect=4).stderr
        self.assertIn("of LAS, LAZ and COPC files", said)

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
                         ["left_edges.las", "right_edges.las"])
        (self.folder / "in/left.copc.laz").unlink()
        said = run("tiles", "plan", self.folder / "in.vpc", "-o", self.folder / "q.json", expect=3).stderr
        self.assertIn("in.vpc: names ./in/left.copc.laz, and there is no", said)

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
        self.assertIn("different columns", said.stderr)

    def test_inputs_in_random_order_can_be_sorted_first(self):
        p, n = field(3, 600)
        p[::700] = np.nan
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
        self.assertIn("sort the inputs", said)
        self.assertIn("index 100 %", said)
        self.assertNotIn("dense sample", said)

    def test_points_that_are_not_finite_stay(self):
        p, n = field(3, 300)
        p[::500] = np.nan
        write_ply(self.folder / "a.ply", p, n)
        plan, _ = self.make_plan(self.folder / "a.ply", tile=1.4)
        run("tiles", "run", plan)
        run("tiles", "join", plan, "-o", self.folder / "joined.ply")
        rows, _ = read_ply(self.folder / "joined.ply")
        self.assertEqual(len(rows), len(p))
        lost = np.isnan(rows["x"])
        self.assertEqual(lost.sum(), np.isnan(p[:, 0]).sum())
        self.assertTrue(np.all((rows["scalar_edge_class"] == 255) == lost))

    def test_only_what_is_missing_or_damaged_is_run(self):
        plan, content = self.small()
        run("tiles", "run", plan, "--tile", "0", "--tile", "2-4")
        state = self.status(plan)
        self.assertEqual(state["done"], [0, 2, 3, 4])
        self.assertIn(f"  next: pcednet tiles run {plan}\n", run("tiles", "status", plan).stdout)
        said = run("tiles", "join", plan, "-o", self.folder / "j.ply", expect=4).stderr
        self.assertIn("missing or damaged: 1, 5 to ", said)
        self.assertFalse((self.folder / "j.ply").exists())
        run("tiles", "run", plan)
        state = self.status(plan)
        self.assertEqual(state["missing"] + state["damaged"], [])
        self.assertEqual(state["done_points"], content["points"])
        files = [self.folder / t["output"] for t in content["tiles"]]
        before = [f.read_bytes() for f in files]
        # Times say nothing: neither old nor future ones make a tile to be run.
        for f, when in zip(files, (0, 1, 2**31, 2**33)):
            os.utime(f, (when, when))
            os.utime(str(f) + ".json", (2**33 - when, 2**33 - when))
        said = run("tiles", "run", plan).stderr
        self.assertIn("0 tiles run", said)
        # Of four damages the last is seen by digest only.
        files[0].unlink()
        files[1].write_bytes(before[1][:-1])
        pathlib.Path(str(files[2]) + ".json").unlink()
        files[3].write_bytes(before[3][:-1] + bytes([before[3][-1] ^ 1]))
        state = self.status(plan)
        self.assertEqual((state["missing"], state["damaged"]), ([0, 2], [1]))
        self.assertEqual(self.status(plan, "--verify")["damaged"], [1, 3])
        self.assertIn("run %s --tile 1 --tile 3 --overwrite" % plan,
                      run("tiles", "status", plan, "--verify").stdout)
        said = run("tiles", "run", plan, "--missing", expect=2).stderr
        self.assertIn(f"{files[2]}: exists already", said)  # for all that is known, not a tile
        run("tiles", "run", plan, "--tile", 2, "--overwrite")
        run("tiles", "run", plan, "--missing")
        run("tiles", "run", plan, "--tile", 3, "--overwrite")
        self.assertEqual([f.read_bytes() for f in files], before)
        self.assertEqual(self.status(plan, "--verify")["done"], list(range(len(files))))

    def test_tiles_and_copies_replace_nothing_else(self):
        p, n = field(3, 300)
        os.mkdir(self.folder / "in")
        for name in ("0.ply", "1.ply", "unsorted_0.ply"):
            write_ply(self.folder / "in" / name, p[::3], n[::3])
        before = (self.folder / "in/0.ply").read_bytes()
        plan, copies = self.folder / "p.json", self.folder / "copies"
        for options in (("--out-dir", self.folder / "in"), ("--sort", self.folder / "in")):
            said = run("tiles", "plan", self.folder / "in", "-o", plan, "--tile", 1.4, *options,
                       "--overwrite", expect=2).stderr
            self.assertIn("0.ply: is the input", said)
        self.assertEqual(len(list((self.folder / "in").iterdir())), 3)
        copies.mkdir()
        (copies / "1.ply").write_text("precious")
        sort = ("tiles", "plan", self.folder / "in/0.ply", "-o", plan, "--tile", 1.4, "--sort", copies)
        self.assertIn("1.ply: exists already", run(*sort, expect=2).stderr)
        self.assertEqual([f.name for f in copies.iterdir()], ["1.ply"])
        run(*sort, "--overwrite")
        tile = self.folder / "p_tiles/2.ply"
        tile.parent.mkdir()
        for name in ("2.ply", "2.ply.json"):
            there = tile.parent / name
            there.write_text("precious")
            for jobs in (1, 2):
                said = run("tiles", "run", plan, "--jobs", jobs, expect=2).stderr
                self.assertIn(f"{there}: exists already; give --overwrite", said)
            self.assertEqual(there.read_text(), "precious")
            there.unlink()
        run("tiles", "run", plan)
        self.assertEqual((self.folder / "in/0.ply").read_bytes(), before)

    def test_an_input_counts_once(self):
        p, n = field(3, 300)
        write_ply(self.folder / "a.ply", p, n)
        (self.folder / "b.ply").symlink_to("a.ply")
        for twice in ("a.ply", "b.ply", "."):
            said = run("tiles", "plan", self.folder / "a.ply", self.folder / twice, "-o",
                       self.folder / "p.json", expect=2).stderr
            self.assertIn("the same file as the input", said)

    def test_killed_at_random_nothing_is_lost(self):
        plan, content = self.small(tile=1.0)
        whole = self.folder / "small.ply"
        chance = random.Random(17)
        for attempt in range(200):
            if not self.status(plan)["missing"]:
                break
            # Each attempt lives a little longer, so that one comes to its end at last.
            process = subprocess.Popen([PROGRAM, "tiles", "run", str(plan), "--jobs",
                                        str(1 + attempt % 2)], stderr=subprocess.DEVNULL,
                                       start_new_session=True)
            try:
                process.wait(chance.uniform(0.02, 0.15 + 0.02 * attempt))
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()
        self.assertGreater(attempt, 0)
        rows = self.check_whole(plan, whole)
        tiles = [self.folder / t["output"] for t in content["tiles"]]
        again = [t.read_bytes() for t in tiles]
        run("tiles", "run", plan, "--overwrite")
        self.assertEqual([t.read_bytes() for t in tiles], again)
        self.assertEqual(len(rows), content["points"])

    def test_two_runs_at_once_do_no_harm(self):
        plan, content = self.small()
        runs = [subprocess.Popen([PROGRAM, "tiles", "run", str(plan)], stderr=subprocess.PIPE)
                for _ in range(3)]
        for process in runs:
            said = process.communicate()[1]
            self.assertEqual(process.returncode, 0, said)
        self.assertEqual(self.status(plan, "--verify")["done"], list(range(len(content["tiles"]))))
        self.check_whole(plan, self.folder / "small.ply")
        self.assertEqual([p.name for p in (self.folder / "p_tiles").iterdir() if "part" in p.name], [])

    def test_an_interrupt_stops_cleanly(self):
        write_ply(self.folder / "a.ply", *field())
        plan, _ = self.make_plan(self.folder / "a.ply")
        for jobs in ("1", "2"):
            process = subprocess.Popen([PROGRAM, "tiles", "run", str(plan), "--jobs", jobs,
                                        "--overwrite", "--progress", "json"],
                                       stderr=subprocess.PIPE)
            self.assertTrue(process.stderr.readline())  # the first tile is in work
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=60)
            self.assertEqual(process.returncode, 130)
            self.assertEqual([p.name for p in (self.folder / "p_tiles").iterdir()
                              if "part" in p.name], [])
            self.assertEqual(self.status(plan, "--verify")["damaged"], [])

    def test_a_full_disk_is_said_and_harms_nothing(self):
        plan, _ = self.small()
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))
        said = run("tiles", "run", plan, expect=1, preexec_fn=limit).stderr
        self.assertIn("File too large", said)
        self.assertEqual(list((self.folder / "p_tiles").iterdir()), [])
        run("tiles", "run", plan)
        self.check_whole(plan, self.folder / "small.ply")
        run("tiles", "join", plan, "-o", self.folder / "j.ply", expect=1, preexec_fn=limit)
        self.assertFalse((self.folder / "j.ply").exists())

    def test_inputs_and_models_that_changed_are_refused(self):
        plan, _ = self.small()
        cloud = self.folder / "small.ply"
        before = cloud.read_bytes()
        changed = bytearray(before)
        changed[-20] ^= 1  # as long as before
        for content, code, words in ((bytes(changed), 3, "has changed since the plan"),
                                     (before + b" ", 3, "has changed since the plan"),
                                     (before[:-4], 3, "has changed since the plan"),
                                     (None, 3, "small.ply")):
            cloud.unlink(missing_ok=True)
            if content is not None:
                cloud.write_bytes(content)
            self.assertIn(words, run("tiles", "run", plan, expect=code).stderr)
        said = run("tiles", "run", plan, "--jobs", 2, expect=3).stderr
        self.assertEqual(said.count("small.ply: No such file"), 1)
        self.assertEqual(self.status(plan)["done"], [])
        cloud.write_bytes(before)
        model = self.folder / "m.safetensors"
        shutil.copy(pathlib.Path(os.environ["PCEDNET_SOURCE_DIR"]) / "models/general.safetensors", model)
        plan, _ = self.make_plan(cloud, "--model", model, tile=1.0)
        run("tiles", "run", plan, "--tile", 0)
        shutil.copy(pathlib.Path(os.environ["PCEDNET_SOURCE_DIR"]) / "models/worn.safetensors", model)
        self.assertIn("not the model", run("tiles", "run", plan, expect=5).stderr)
        self.assertIn("not the model", run("tiles", "run", plan, "--jobs", 2, expect=5).stderr)

    def test_usage_errors(self):
        plan, content = self.small()
        run("tiles", "plan", self.folder / "none.laz", "-o", self.folder / "q.json", expect=3)
        run("tiles", "plan", self.folder / "small.ply", "-o", plan, expect=2)  # exists
        self.assertIn("-o is required",
                      run("tiles", "plan", self.folder / "small.ply", expect=2).stderr)
        for bad in ("99", "x", "2-", "3-1", "-1"):
            run("tiles", "run", plan, "--tile=" + bad, expect=2)
        run("tiles", "run", plan, "--max-memory", "lots", expect=2)
        self.assertIn("smaller", run("tiles", "run", plan, "--max-memory", "1M", expect=2).stderr)
        self.assertIn("convert", run("tiles", "plan", self.text_cloud(), "-o",
                                     self.folder / "q.json", expect=2).stderr)
        p, n = field(2, 300)
        p[7] = (1e9, 1e9, 0)
        write_ply(self.folder / "far.ply", p, n)
        self.assertIn("points far from all others?",
                      run("tiles", "plan", self.folder / "far.ply", "-o", self.folder / "q.json",
                          "--tile", 1, expect=2).stderr)
        (self.folder / "no.json").write_text("{}")
        for command in ("run", "status"):
            run("tiles", command, self.folder / "no.json", expect=3)
        said = run("tiles", "run", self.folder / "small.ply", expect=3).stderr
        self.assertIn("not a plan of tiles: byte 1 is not JSON", said)
        self.assertIn("Examples", run("tiles", "run", "--help").stdout)

    def text_cloud(self):
        path = self.folder / "a.xyz"
        path.write_text("0 0 0\n1 1 1\n")
        return path


if __name__ == "__main__":
    unittest.main()
