"""pcednet classify: from a file to a labelled file."""
import os
import re
import signal
import subprocess
import time
import unittest

import numpy as np

from support import PROGRAM, CliTest, cube, read_ply, run, sheet, write_ply


class Classify(CliTest):
    def classify(self, positions, normals=None, name="cloud.ply", extra=(), **options):
        source = self.folder / name
        write_ply(source, positions, normals, **options)
        out = self.folder / (source.stem + "_out.ply")
        run("classify", source, "-o", out, "--overwrite", *extra)
        return read_ply(out)[0]

    def test_finds_the_edges_of_a_cube(self):
        p, n, label = cube()
        found = self.classify(p, n)["scalar_edge_class"] > 0
        true = label > 0
        tp, fp = np.sum(found & true), np.sum(found & ~true)
        fn, tn = np.sum(~found & true), np.sum(~found & ~true)
        mcc = (tp * tn - fp * fn) / np.sqrt(float(tp + fp) * (tp + fn) * (tn + fp) * (tn + fn))
        self.assertGreater(mcc, 0.75)

    def test_writes_the_fields_that_viewers_expect_in_their_order(self):
        p, n, _ = cube(500)
        source = self.folder / "a.ply"
        write_ply(source, p, n)
        run("classify", source)
        rows, header = read_ply(self.folder / "a_edges.ply")
        self.assertEqual(rows.dtype.names,
                         ("x", "y", "z", "nx", "ny", "nz", "red", "green", "blue", "quality",
                          "scalar_edge_class", "scalar_p_sharp", "scalar_p_smooth", "label"))
        self.assertTrue(any(line.startswith("comment pcednet model") for line in header))
        np.testing.assert_array_equal(rows["label"], rows["scalar_edge_class"])
        np.testing.assert_array_equal(rows["x"], p[:, 0].astype("f4"))
        np.testing.assert_allclose(rows["quality"], rows["scalar_p_sharp"] + rows["scalar_p_smooth"],
                                   atol=1e-6)

    def test_gives_the_same_labels_for_any_threads_order_orientation_and_origin(self):
        p, n, _ = cube(3000, noise=0.004)
        p = np.round(p, 6)
        reference = self.classify(p, n, position_type="double")
        for threads in (1, 2, 8):
            again = self.classify(p, n, extra=("--threads", threads), position_type="double")
            self.assertEqual(reference.tobytes(), again.tobytes())
        order = np.random.default_rng(3).permutation(len(p))
        shuffled = self.classify(p[order], n[order], position_type="double")
        self.assertEqual(reference[order].tobytes(), shuffled.tobytes())
        flipped = self.classify(p, -n, position_type="double")
        for field in ("label", "scalar_p_sharp", "scalar_p_smooth"):
            np.testing.assert_array_equal(reference[field], flipped[field])
        moved = self.classify(p + np.array([652000.0, 6862000.0, 35.0]), n, position_type="double")
        np.testing.assert_array_equal(reference["label"], moved["label"])

    def test_labels_where_the_surface_ends(self):
        p, n, rim = sheet()
        rows = self.classify(p, n)
        boundary = rows["label"] == 3
        self.assertGreater(np.mean(rim[boundary] < 1.5), 0.9)
        self.assertGreater(np.mean(boundary[rim < 0.5]), 0.75)
        self.assertEqual({tuple(c) for c in zip(*(rows[c][boundary]
                                                  for c in ("red", "green", "blue")))},
                         {(0, 82, 165)})
        np.testing.assert_array_equal(self.classify(p, -n)["label"] == 3, boundary)
        paper = self.classify(p, n, extra=("--no-boundary",))
        self.assertFalse(np.any(paper["label"] == 3))
        np.testing.assert_array_equal(rows["label"][~boundary], paper["label"][~boundary])
        np.testing.assert_array_equal(rows["scalar_p_sharp"], paper["scalar_p_sharp"])
        run("classify", self.folder / "cloud.ply", "--method", "ca", "--no-boundary", expect=2)
        said = run("classify", self.folder / "cloud.ply", "-o", self.folder / "b.ply").stderr
        self.assertIn(f"{np.sum(boundary)} boundary (", said)
        self.assertIn(f"{np.sum(boundary)} boundary (3)",
                      run("info", self.folder / "b.ply").stdout)

    def test_estimates_missing_normals_and_says_so(self):
        p, _, label = cube()
        source = self.folder / "bare.ply"
        write_ply(source, p)
        done = run("classify", source, "-o", self.folder / "out.ply")
        self.assertIn("normals", done.stderr)
        rows, _ = read_ply(self.folder / "out.ply")
        self.assertIn("nx", rows.dtype.names)
        self.assertGreater(np.mean((rows["label"] > 0) == (label > 0)), 0.9)

    def test_averages_noise_that_is_thicker_than_the_spacing(self):
        positions, _, _ = cube(150_000, noise=0.013)  # the spacing is .0063
        file, result, again = self.path("thick.ply"), self.path("result.ply"), self.path("again.ply")
        write_ply(file, positions, position_type="double")
        told = run("classify", file, "-o", result)
        self.assertRegex(told.stderr, r"thick\.ply: noise is (1\.9|2|2\.1) times the spacing: 150000 points are averaged to")
        points, _ = read_ply(result)
        np.testing.assert_array_equal(points["x"], positions[:, 0])
        to_edge = np.sort(0.5 - np.abs(positions), axis=1)[:, 1]
        edge = points["scalar_edge_class"] > 0
        self.assertGreater(edge[np.abs(to_edge) < 0.01].mean(), 0.95)
        self.assertLess(edge[to_edge > 0.1].mean(), 0.001)
        self.assertLess(np.abs(np.linalg.norm([points[a] for a in ("nx", "ny", "nz")], axis=0) - 1).max(), 1e-5)
        run("classify", result, "-o", again)
        np.testing.assert_array_equal(read_ply(again)[0]["scalar_edge_class"], points["scalar_edge_class"])
        saved = self.path("saved.ply")  # as by CloudCompare
        saved.write_bytes(re.sub(rb"comment [^\n]*\n", b"", result.read_bytes(), count=20))
        for cloud in file, result, saved:
            told = run("lines", cloud, "-o", self.path("edges.obj"), "--overwrite")
            self.assertIn("noise is", told.stderr)
            self.assertRegex(told.stderr, r"12 curves, total length (11\.[89]|12\.[01])")
        told = run("classify", file, "-o", result, "--overwrite", "--s-min", 0.02)
        self.assertNotIn("averaged", told.stderr)

    def test_gives_its_own_results_the_same_labels(self):
        bare, once, twice = (self.folder / name for name in ("bare.ply", "once.ply", "twice.ply"))
        write_ply(bare, cube(4000)[0])
        run("classify", bare, "-o", once)
        said = run("classify", once, "-o", twice).stderr
        self.assertIn("the normals in the file are estimates", said)
        self.assertEqual(once.read_bytes(), twice.read_bytes())
        normals, after = self.folder / "normals.ply", self.folder / "after.ply"
        run("normals", bare, "-o", normals, "--flip")
        run("classify", normals, "-o", after)
        first, rows = read_ply(once)[0], read_ply(after)[0]
        np.testing.assert_array_equal(rows["label"], first["label"])
        np.testing.assert_array_equal(rows["nx"], -first["nx"])  # the signs of the file

    def test_leaves_out_a_point_that_is_nowhere(self):
        p, n, _ = cube()
        for normals in (n, None):
            alone = self.classify(p, normals, name="alone.ply")
            given = None if normals is None else np.vstack([n, [[0, 0, 1]]])
            rows = self.classify(np.vstack([p, [[1e30, 0, 0]]]), given, name="far.ply")
            np.testing.assert_array_equal(rows["label"][:-1], alone["label"])
            self.assertEqual(rows["label"][-1], 255)
            self.assertEqual(rows["x"][-1], np.float32(1e30))

    def test_mends_normals_of_mixed_signs_unless_told_not_to(self):
        p, n, _ = cube(4000)
        mixed = np.where(np.random.default_rng(2).random(len(p))[:, None] < 0.1, -n, n)
        expected = self.classify(p, n)["label"]
        np.testing.assert_array_equal(self.classify(p, mixed)["label"], expected)
        kept = self.classify(p, mixed, extra=("--keep-orientation",))
        self.assertLess(np.mean(kept["label"] == expected), 0.99)
        np.testing.assert_allclose(kept["nx"], mixed[:, 0], atol=1e-6)
        said = run("classify", self.folder / "cloud.ply", "-o", self.folder / "b.ply").stderr
        self.assertRegex(said, "(9|10|11) % of the normals oppose the rest of their surface")
        self.assertIn("--keep-orientation", said)

    def test_keeps_points_that_cannot_be_described(self):
        p, n, _ = cube(800)
        p[5] = np.nan
        n[7] = 0
        rows = self.classify(p, n)
        self.assertEqual(len(rows), 800)
        self.assertEqual(rows["label"][5], 255)
        self.assertIn(rows["label"][7], (0, 1, 2))
        self.assertTrue(np.all(np.isfinite(rows["scalar_p_sharp"])))

    def test_tells_the_seconds_of_every_stage(self):
        write_ply(self.folder / "a.ply", *cube(400)[:2])
        said = run("classify", self.folder / "a.ply").stderr
        line = next(line for line in said.splitlines() if line.startswith("  seconds: "))
        stages = dict(part.split() for part in line.removeprefix("  seconds: ").split(", "))
        self.assertLessEqual({"read", "normals", "prepare", "describe", "context", "write", "total"},
                             stages.keys())
        seconds = {name: float(text) for name, text in stages.items()}
        total = seconds.pop("total")
        self.assertAlmostEqual(total, sum(seconds.values()), delta=0.01 * len(stages))

    def test_takes_a_folder(self):
        for name in ("a.ply", "b.ply"):
            write_ply(self.folder / name, *cube(400)[:2])
        run("classify", self.folder, "--out-dir", self.folder / "results")
        self.assertEqual(sorted(os.listdir(self.folder / "results")),
                         ["a_edges.ply", "b_edges.ply"])

    def test_warns_once_of_files_that_adjoin(self):
        p, n, _ = cube(2000)
        for name, part, shift in (("a", p[:, 0] < -0.1, 0), ("b", p[:, 0] >= -0.1, 0), ("c", p[:, 0] < 9, 0),
                                  ("d", p[:, 0] < 9, 5), ("e", p[:, 0] < 9, 6)):
            write_ply(self.folder / "some.ply", p[part] + (shift, 0, 0), n[part])
            run("convert", self.folder / "some.ply", "-o", self.folder / f"{name}.las")
        for names, adjoin in (("ab", "ab"), ("cd", ""), ("ac", ""), ("a", ""), ("cde", "de"), ("edcba", "ab")):
            said = run("classify", *(self.folder / f"{name}.las" for name in names), "--overwrite").stderr
            self.assertEqual(said.count(" adjoin: "), 1 if adjoin else 0, (names, said))
            if adjoin:
                first, second = (str(self.folder / f"{name}.las") for name in adjoin)
                self.assertIn(f"{first} and {second} adjoin: each file is classified by itself", said)
                self.assertIn("pcednet tiles plan takes such files as one cloud", said)

    def test_goes_on_after_a_bad_file_and_says_so_in_the_end(self):
        write_ply(self.folder / "b.ply", *cube(400)[:2])
        (self.folder / "a.ply").write_text("ply\nnonsense\n")
        done = run("classify", self.folder, "--out-dir", self.folder / "out", expect=3)
        self.assertIn("a.ply", done.stderr)
        self.assertEqual(os.listdir(self.folder / "out"), ["b_edges.ply"])

    def test_goes_on_after_a_missing_file_and_an_empty_folder(self):
        write_ply(self.folder / "b.ply", *cube(400)[:2])
        (self.folder / "empty").mkdir()
        missing = self.folder / "missing.ply"
        done = run("classify", missing, self.folder / "b.ply", self.folder / "empty", expect=3)
        self.assertIn(f"{missing}: no such file", done.stderr)
        self.assertIn("1 classified, 0 skipped because their results exist, 2 failed", done.stderr)
        self.assertIn(f"2 of 3 inputs failed, for the reasons above:\n  {missing}\n"
                      f"  {self.folder / 'empty'}\n", done.stderr)
        self.assertTrue((self.folder / "b_edges.ply").exists())
        run("classify", self.folder / "empty", missing, expect=4)  # the first failure's kind

    def test_skips_inputs_whose_result_is_there(self):
        for name in ("a.ply", "b.ply"):
            write_ply(self.folder / name, *cube(400)[:2])
        (self.folder / "a_edges.ply").write_text("precious")
        done = run("classify", self.folder, "--skip-existing")
        self.assertIn("1 classified, 1 skipped because their results exist, 0 failed", done.stderr)
        self.assertEqual((self.folder / "a_edges.ply").read_text(), "precious")
        again = run("classify", self.folder, "--skip-existing")
        self.assertIn("0 classified, 2 skipped", again.stderr)
        self.assertEqual(sorted(os.listdir(self.folder)),  # no results of results
                         ["a.ply", "a_edges.ply", "b.ply", "b_edges.ply"])
        run("classify", self.folder, "--skip-existing", "--overwrite", expect=2)

    def test_names_every_existing_result_before_any_work(self):
        for name in ("a.ply", "b.ply", "c.ply"):
            write_ply(self.folder / name, *cube(400)[:2])
        for name in ("b_edges.ply", "c_edges.ply"):
            (self.folder / name).write_text("precious")
        done = run("classify", self.folder, expect=2)
        for name in ("b_edges.ply", "c_edges.ply"):
            self.assertIn(f"{self.folder / name}: exists already", done.stderr)
        self.assertIn("--skip-existing", done.stderr)
        self.assertFalse((self.folder / "a_edges.ply").exists())

    def test_classifies_sparse_clouds_and_says_with_which_scales(self):
        p, n, _ = cube(100)
        write_ply(self.folder / "a.ply", p, n)
        for engine in ((), ("--exact",)):
            done = run("classify", self.folder / "a.ply", "--model", "scan", "--overwrite", *engine)
            self.assertIn("warning", done.stderr)
            self.assertIn("too few points for scales up to", done.stderr)
        rows, _ = read_ply(self.folder / "a_edges.ply")
        self.assertTrue(np.all(rows["label"] <= 2))

    def test_takes_the_scales_that_are_given(self):
        p, n, _ = cube(4800)  # fewer than 4,000 would be left to other networks without given scales
        squares = np.sum(p**2, axis=1)
        spacings = []
        for part in np.split(p, 12):
            away = np.sum(part**2, axis=1)[:, None] + squares - 2 * part @ p.T
            nearest = np.sort(np.partition(away, 10)[:, :11])[:, 1:]
            spacings.extend(np.sqrt(nearest).mean(axis=1))
        spacing = np.sort(spacings)[1200:3600].mean()  # the middle half
        s_min = 0.045  # the nearest preferred number
        self.assertLess(abs(np.log(s_min / spacing)), 0.06)
        own = self.classify(p, n, position_type="double")
        same = self.classify(p, n, position_type="double",
                             extra=("--s-min", s_min, "--s-max", 8 * s_min))
        other = self.classify(p, n, position_type="double", extra=("--s-max", 0.5))
        np.testing.assert_allclose(own["scalar_p_sharp"], same["scalar_p_sharp"], atol=1e-4)
        self.assertGreater(np.max(np.abs(own["scalar_p_sharp"] - other["scalar_p_sharp"])), 0.1)
        write_ply(self.folder / "b.ply", p, n)
        for wrong in (("--s-min", 0.5, "--s-max", 0.1), ("--s-max", -1), ("--s-min", "nan"),
                      ("--s-max", 1e-5), ("--method", "ca", "--s-max", 0.1)):
            run("classify", self.folder / "b.ply", *wrong, expect=2)

    def test_counts_copies_of_points_once(self):
        p, n, _ = cube(3000)
        every = np.arange(3000)
        for normals, extra in ((None, ()), (n, ()), (n, ("--exact",))):
            one = self.classify(p, normals, extra=extra)
            for chosen in (np.repeat(every, 2), np.r_[every, every[p[:, 0] > 0.2]],
                           np.r_[every, np.full(4000, 7)]):
                many = self.classify(p[chosen], None if normals is None else n[chosen], extra=extra)
                for name in ("label", "scalar_p_sharp", "nx"):
                    np.testing.assert_allclose(many[name], one[name][chosen], atol=1e-5)

    def test_never_overwrites_unasked(self):
        write_ply(self.folder / "a.ply", *cube(400)[:2])
        (self.folder / "a_edges.ply").write_text("precious")
        done = run("classify", self.folder / "a.ply", expect=2)
        self.assertIn("--overwrite", done.stderr)
        self.assertEqual((self.folder / "a_edges.ply").read_text(), "precious")

    def test_the_preview_is_never_the_input(self):
        write_ply(self.folder / "a.ply", *cube(500))
        before = (self.folder / "a.ply").read_bytes()
        run("classify", self.folder / "a.ply", "-o", self.folder / "b.ply", "--preview",
            self.folder / "a.ply", "--overwrite", expect=2)
        self.assertEqual((self.folder / "a.ply").read_bytes(), before)

    def test_draws_a_preview_from_where_it_is_told(self):
        path, picture = self.folder / "a.ply", self.folder / "a.png"
        write_ply(path, *cube(1000)[:2])
        said = run("classify", path, "--preview", picture).stderr
        self.assertTrue(said.endswith(f"  -> {self.folder / 'a_edges.ply'}\n  -> {picture}\n"), said)
        untold = picture.read_bytes()
        self.assertEqual(untold[:8], b"\x89PNG\r\n\x1a\n")

        def drawn(*words):
            run("classify", path, "--preview", picture, *words, "--overwrite")
            return picture.read_bytes()

        above = drawn("--preview-from", "-50", "90")
        self.assertEqual(above, drawn("--preview-from", "310", "90"))
        self.assertNotEqual(above, untold)
        for words in (["30"], ["30", "91"], ["30", "-90.5"], ["30", "nan"], ["inf", "0"], ["x", "0"]):
            run("classify", path, "--preview", picture, "--preview-from", *words, "--overwrite",
                expect=2)
        run("classify", path, "--preview-from", "30", "30", "--overwrite", expect=2)
        self.assertTrue(picture.exists())

    def test_stops_on_ctrl_c_and_leaves_nothing(self):
        write_ply(self.folder / "big.ply", *cube(100_000)[:2])
        running = subprocess.Popen([PROGRAM, "classify", self.folder / "big.ply", "--exact",
                                    "--progress", "json"], stderr=subprocess.PIPE, text=True)
        for line in running.stderr:
            if '"describe"' in line:
                break
        running.send_signal(signal.SIGINT)
        start = time.monotonic()
        running.stderr.read()
        self.assertEqual(running.wait(60), 130)
        self.assertLess(time.monotonic() - start, 30)
        running.stderr.close()
        self.assertEqual(os.listdir(self.folder), ["big.ply"])

    def test_warns_of_what_the_format_does_not_keep_and_of_rounded_coordinates(self):
        p, n, labels = cube(500)
        write_ply(self.folder / "a.ply", p, n)
        said = run("classify", self.folder / "a.ply", "-o", self.folder / "b.obj").stderr
        self.assertRegex(said, "b.obj does not keep: attributes .*scalar_p_sharp")
        self.assertEqual(said.count("b.obj does not keep: attribute"), 1)
        self.assertNotIn("keep", run("classify", self.folder / "a.ply").stderr)
        write_ply(self.folder / "far.ply", p + [500_000, 5_400_000, 0], n)
        said = run("classify", self.folder / "far.ply").stderr
        self.assertRegex(said, r"far.ply: float coordinates up to 540000\d are rounded to steps of 0.5")
        said = run("tiles", "plan", self.folder / "far.ply", "-o", self.folder / "far.json").stderr
        self.assertRegex(said, r"float coordinates up to 540000\d are rounded to steps of 0.5")
        for command in (("describe", "-o", self.folder / "matrix.npy"),
                        ("train", "-o", self.folder / "far.safetensors", "--epochs", "1", "--scales", "4")):
            write_ply(self.folder / "far.ply", p + [500_000, 5_400_000, 0], n, labels)
            said = run(command[0], self.folder / "far.ply", *command[1:]).stderr
            self.assertRegex(said, r"far.ply: float coordinates up to 540000\d are rounded to steps of 0.5")
            run(command[0], self.folder / "far.ply", *command[1:], "--s-min", "0.2", "--overwrite")
        said = run("lines", self.folder / "far.ply", "-o", self.folder / "far.obj").stderr
        self.assertRegex(said, r"far.ply: float coordinates up to 540000\d are rounded to steps of 0.5")
        p[7] = 1e30
        write_ply(self.folder / "no_data.ply", p, n)
        self.assertNotIn("rounded", run("classify", self.folder / "no_data.ply").stderr)
        p[7] = 0
        write_ply(self.folder / "far.ply", p + [500_000, 5_400_000, 0], n, position_type="double")
        self.assertNotIn("rounded", run("classify", self.folder / "far.ply", "--overwrite").stderr)

    def test_warns_of_rounding_along_any_axes(self):
        """Along all three it leaves a lattice, whose places are further apart than its steps."""
        p, n, _ = cube(20_000)
        for axes in ([1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 0], [1, 1, 1]):
            for normals in (n, None):
                write_ply(self.folder / "far.ply", p + 786_432 * np.array(axes), normals)
                for command, output in (("classify", "far_edges.ply"), ("lines", "far.obj")):
                    said = run(command, self.folder / "far.ply", "-o", self.folder / output,
                               "--overwrite").stderr
                    self.assertRegex(said, "far.ply: float coordinates up to 78643[23] are rounded "
                                     r"to steps of 0.062, but the points are only 0.0[12]\d* apart",
                                     (axes, normals is None))
        again = np.concatenate([p] * 20) + [65_536] * 3  # steps of less than half the spacing
        write_ply(self.folder / "again.ply", again, np.concatenate([n] * 20))
        self.assertNotIn("rounded", run("classify", self.folder / "again.ply").stderr)


if __name__ == "__main__":
    unittest.main()
