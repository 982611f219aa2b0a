"""pcednet evaluate: scores as JSON, of a model and of other tools' predictions."""
import json
import os
import signal
import subprocess
import unittest

import numpy as np

from support import PROGRAM, CliTest, cube, run, sheet, write_own, write_ply


class Evaluate(CliTest):
    def test_scores_predictions_in_every_format(self):
        p, n, label = cube(1000)
        write_ply(self.folder / "a.ply", p, n, label)
        predicted = label.copy()
        predicted[:100] = 0
        truth, said = label == 2, predicted == 2
        expected = {"tp": int(np.sum(truth & said)), "fp": int(np.sum(~truth & said)),
                    "fn": int(np.sum(truth & ~said)), "tn": int(np.sum(~truth & ~said))}
        (self.folder / "u8").mkdir()
        (self.folder / "u8" / "a.u8").write_bytes(predicted.tobytes())
        (self.folder / "txt").mkdir()
        (self.folder / "txt" / "a.txt").write_text("\n".join(map(str, predicted)) + "\n")
        (self.folder / "ply").mkdir()
        write_ply(self.folder / "ply" / "a.ply", p, n, predicted)
        for kind in ("u8", "txt", "ply"):
            done = run("evaluate", self.folder / "a.ply", "--predictions", self.folder / kind,
                       "--json", "-")
            report = json.loads(done.stdout)
            row = report["clouds"][0]
            self.assertEqual({k: row[k] for k in expected}, expected, kind)
            self.assertEqual(row["name"], "a")
            self.assertEqual(row["points"], 1000)
            self.assertEqual(report["pooled"]["mcc"], report["median"]["mcc"])

    def test_says_that_edges_marked_by_one_are_not_counted(self):
        p, n, label = cube(1000)
        write_ply(self.folder / "a.ply", p, n, label)
        (self.folder / "other").mkdir()
        np.save(self.folder / "other" / "a.npy", (label == 2).astype(np.int64))
        said = "none is sharp-edge (2): positive sharp counts 2 alone, positive edge both"
        arguments = ("evaluate", self.folder / "a.ply", "--predictions", self.folder / "other")
        self.assertIn(f"the predictions: {np.sum(label == 2)} points are smooth-edge (1), {said}", run(*arguments).stderr)
        self.assertNotIn(said, run(*arguments, "--positive", "edge").stderr)
        np.save(self.folder / "other" / "a.npy", label == 2)  # of a mask, true is sharp-edge
        self.assertEqual(run(*arguments).stderr, "")
        write_ply(self.folder / "a.ply", p, n, np.minimum(label, 1))
        self.assertIn("the labels: ", run(*arguments).stderr)

    def test_tells_whether_probabilities_are_right(self):
        write_ply(self.folder / "a.ply", *cube(3000))
        done = run("evaluate", self.folder / "a.ply", "--model", "scan", "--positive", "edge",
                   "--calibration", "--json", "-")
        calibration = json.loads(done.stdout)["calibration"]
        self.assertEqual(sum(b["points"] for b in calibration["bins"]), 3000)
        self.assertLess(calibration["error"], 0.1)
        run("evaluate", self.folder / "a.ply", "--method", "ca", "--calibration", expect=2)

    def test_scores_where_the_surface_ends(self):
        p, n, rim = sheet()
        write_ply(self.folder / "a.ply", p, n, np.where(rim < 0.7, 3, 0).astype(np.uint8))
        said = {}
        for extra in ((), ("--no-boundary",)):
            report = json.loads(run("evaluate", self.folder / "a.ply", "--model", "scan",
                                    "--positive", "boundary", "--json", "-", *extra).stdout)
            said[extra] = report["clouds"][0]
        self.assertGreater(said[()]["mcc"], 0.6)
        self.assertEqual(said[("--no-boundary",)]["tp"] + said[("--no-boundary",)]["fp"], 0)
        run("evaluate", self.folder / "a.ply", "--model", "scan", "--positive", "boundary",
            "--calibration", expect=2)

    def test_scores_a_model_and_writes_the_file(self):
        write_ply(self.folder / "a.ply", *cube(3000))
        run("evaluate", self.folder / "a.ply", "--model", "scan", "--positive", "edge", "--json",
            self.folder / "scores.json")
        report = json.loads((self.folder / "scores.json").read_text())
        self.assertGreater(report["median"]["mcc"], 0.7)
        twice = run("evaluate", self.folder, self.folder / "a.ply", "--model", "scan", "--json", "-")
        self.assertEqual(len(json.loads(twice.stdout[twice.stdout.index("{"):])["clouds"]), 1)

    def test_names_that_are_not_utf8_are_written_as_far_as_they_are(self):
        write_ply(self.folder / "a.ply", *cube(500))
        os.rename(self.folder / "a.ply", os.fsencode(self.folder) + b"/lat\xfcin.ply")
        run("evaluate", self.folder, "--method", "ca", "--json", self.folder / "scores.json", errors="replace")
        scores = json.loads((self.folder / "scores.json").read_text(encoding="utf-8"))
        self.assertEqual([row["name"] for row in scores["clouds"]], ["lat\ufffdin"])

    def test_scores_lines_against_the_curves_that_generate_writes(self):
        parts = self.folder / "parts"
        run("generate", "lines", parts, "--only", "roof_hip")
        self.assertEqual(sorted(os.listdir(parts)), ["curves", "roof_hip_0.ply", "roof_hip_1.ply"])
        self.assertEqual(sorted(os.listdir(parts / "curves")), ["roof_hip_0.obj", "roof_hip_1.obj"])
        # The curves are no clouds of the folder.
        self.assertEqual(len(json.loads(run("evaluate", parts, "--method", "ca", "--json",
                                            "-").stdout)["clouds"]), 2)
        done = run("evaluate", parts / "curves", "--truth", parts, "--cloud", parts, "--json",
                   self.folder / "lines.json")
        self.assertEqual(len(done.stdout.splitlines()), 5)
        scores = json.loads((self.folder / "lines.json").read_text())
        self.assertEqual([row["name"] for row in scores["clouds"]], ["roof_hip_0", "roof_hip_1"])
        for name in ("precision_01", "recall_02", "found", "pieces", "corners"):
            self.assertEqual(scores["mean"][name], 1.0, name)
        run("generate", "lines", parts, "--only", "no such part", expect=2)

    def test_scores_lines_by_hand(self):
        truth, lines = self.folder / "truth.obj", self.folder / "lines.obj"
        truth.write_text("v -1 0 0\nv 1 0 0\nv 1 1 0\nl 1 2\nl 2 3\n")
        lines.write_text("v -1 0 0\nv 0.5 0 0\nv 1 0 0\nl 1 2\nl 2 3\n")
        run("convert", self.square(), "-o", self.folder / "cloud.ply")
        for extra in ((), ("--cloud", self.folder / "cloud.ply")):
            row = json.loads(run("evaluate", lines, "--truth", truth, "--json", "-",
                                 *extra).stdout)["clouds"][0]
            self.assertEqual((row["lines"], row["true_curves"]), (2, 2))
            self.assertAlmostEqual(row["precision_02"], 1.0)
            self.assertAlmostEqual(row["recall_02"], 2 / 3, delta=0.01)
            self.assertEqual((row["found"], row["pieces"]), (0.0, 2.0))
            self.assertAlmostEqual(row["corners"], 2 / 3)
        lines.write_text("# nothing found\n")
        row = json.loads(run("evaluate", lines, "--truth", truth, "--json",
                             "-").stdout)["clouds"][0]
        self.assertEqual((row["lines"], row["found"], row["cd"]), (0, 0.0, None))

    def square(self):
        path = self.folder / "square.xyz"
        path.write_text("".join(f"{x} {y} 0\n" for x in (-1, 1) for y in (-1, 1)))
        return path

    def test_curves_in_pieces_are_told(self):
        ring = "".join(f"v {np.cos(a):.6f} {np.sin(a):.6f} 0\n" for a in np.arange(48) * np.pi / 24)
        whole, pieces, square = (self.folder / name for name in ("whole.obj", "pieces.obj", "square.obj"))
        whole.write_text(ring + "l " + " ".join(str(k + 1) for k in range(48)) + " 1\n")
        pieces.write_text(ring + "".join(f"l {k + 1} {(k + 1) % 48 + 1}\n" for k in range(0, 48)))
        square.write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nl 1 2\nl 2 3\nl 3 4\nl 4 1\n")
        for lines, truth, told in ((pieces, whole, pieces), (whole, pieces, pieces)):
            said = run("evaluate", lines, "--truth", truth).stderr
            self.assertIn(f"{told}: its 48 lines are pieces of curves, which go on straight at 48 ends", said)
        for lines in (whole, square):
            self.assertNotIn("pieces of curves", run("evaluate", lines, "--truth", lines).stderr)

    def test_scoring_of_lines_stops_at_once(self):
        points = np.random.default_rng(1).random((6000, 3))  # to score them would take seconds
        truth = self.folder / "truth.obj"
        truth.write_text("".join(f"v {x} {y} {z}\n" for x, y, z in points)
                         + "".join(f"l {i} {i + 1}\n" for i in range(1, len(points), 2)))
        (self.folder / "warned.obj").write_text("v 0 0 0\n")
        for number in (signal.SIGINT, signal.SIGTERM):
            running = subprocess.Popen([PROGRAM, "evaluate", self.folder / "warned.obj", truth, "--truth", truth],
                                       stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            self.assertIn("taken for a result without lines", running.stderr.readline())
            running.send_signal(number)
            self.assertEqual(running.communicate(timeout=60), ("", "pcednet: stopped by the user\n"))
            self.assertEqual(running.returncode, 130)

    def test_refuses_lines_without_truth(self):
        truth = self.folder / "truth.obj"
        truth.write_text("v 0 0 0\nv 1 0 0\nl 1 2\n")
        (self.folder / "other").mkdir()
        (self.folder / "empty.obj").write_text("")
        for of_labels in (("--model", "scan"), ("--positive", "edge"), ("--calibration",)):
            said = run("evaluate", truth, "--truth", truth, *of_labels, expect=2).stderr
            self.assertRegex(said, f"--truth excludes {of_labels[0]}|{of_labels[0]} excludes --truth")
        run("evaluate", truth, "--cloud", truth, expect=2)
        run("evaluate", truth, "--truth", self.folder / "other", expect=4)
        run("evaluate", truth, "--truth", self.folder / "empty.obj", expect=4)
        run("evaluate", truth, "--truth", self.folder / "gone.obj", expect=3)
        run("evaluate", truth, "--truth", truth, "--cloud", self.folder / "other", expect=3)

    def test_labels_that_are_no_classes(self):
        p, n, label = cube(300)
        for name, labels in (("none", 255), ("others", 7)):
            path = self.folder / (name + ".ply")
            write_ply(path, p, n, np.full(300, labels, np.uint8))
            self.assertIn(f"{path}: no point is labelled with a class of edges",
                          run("evaluate", path, "--method", "ca", expect=4).stderr)
        label[:5] = 8
        write_ply(self.folder / "some.ply", p, n, label)
        said = run("evaluate", self.folder / "some.ply", "--method", "ca").stderr
        self.assertIn("some.ply: 5 labels are not edge classes", said)

    def test_predictions_are_in_a_folder(self):
        cloud = self.folder / "a.ply"
        write_ply(cloud, *cube(300))
        for name in (cloud, self.folder / "none"):
            said = run("evaluate", cloud, "--predictions", name, expect=3).stderr
            self.assertIn(f"--predictions {name}: no such folder; there is to be a file in it", said)

    def test_unlabelled_clouds_among_others_are_left_out(self):
        p, n, label = cube(300)
        clouds = self.folder / "in"
        clouds.mkdir()
        for name, labels in (("a", None), ("b", label), ("c", np.full(300, 255, np.uint8)), ("d", label)):
            write_ply(clouds / (name + ".ply"), p, n, labels)
        done = run("evaluate", clouds, "--method", "ca", "--json", "-")
        self.assertEqual([row["name"] for row in json.loads(done.stdout)["clouds"]], ["b", "d"])
        self.assertIn(f"warning: {clouds}/a.ply: has no labels, as no column is named label: left out", done.stderr)
        self.assertIn(f"warning: {clouds}/c.ply: no point is labelled with a class of edges", done.stderr)
        self.assertEqual(done.stderr.count(": left out"), 2)
        said = run("evaluate", clouds / "a.ply", clouds / "c.ply", "--method", "ca", expect=4).stderr
        self.assertIn(f"pcednet: {clouds}/a.ply: has no labels, as no column is named label\n", said)

    def own(self, name, names=("ground", "wall", "pipe")):
        return write_own(self.folder / name, *cube(2000), names=names)

    def test_clouds_of_other_classes_than_the_model_are_refused(self):
        own, edges = self.own("own.ply"), self.folder / "edges.ply"
        write_ply(edges, *cube(2000))
        model = self.folder / "own.safetensors"
        run("train", own, "-o", model, "--epochs", "2", "--scales", "4")
        for cloud, way, said in (
                (own, (), "its classes are ground, wall, pipe, those of the model edges"),
                (own, ("--method", "ca"), "its classes are ground, wall, pipe, those of --method ca edges"),
                (edges, ("--model", model), "its classes are edges, those of the model ground, wall, pipe"),
                (self.own("other.ply", ("ground", "roof", "pipe")), ("--model", model),
                 "its classes are ground, roof, pipe, those of the model ground, wall, pipe")):
            for more in ((), (self.folder / "edges.ply",) if cloud is own else (own,)):
                self.assertIn(f"{cloud}: {said}", run("evaluate", cloud, *more, *way, expect=4).stderr)
        classes = json.loads(run("evaluate", own, "--model", model, "--json", "-").stdout)["classes"]
        self.assertEqual([row["name"] for row in classes], ["ground", "wall", "pipe"])

    def test_predictions_are_of_the_classes_of_the_cloud(self):
        own, edges = self.own("own.ply"), self.folder / "z.ply"
        label = cube(2000)[2]
        write_ply(edges, *cube(2000))
        said = self.folder / "said"
        said.mkdir()
        for name in ("own", "z"):
            (said / f"{name}.u8").write_bytes(label.tobytes())
        report = json.loads(run("evaluate", own, "--predictions", said, "--json", "-").stdout)
        self.assertEqual((report["accuracy"], len(report["classes"])), (1.0, 3))
        self.assertIn(f"{edges}: its classes are edges, those of the first cloud ground, wall, pipe",
                      run("evaluate", own, edges, "--predictions", said, expect=4).stderr)
        for cloud, number, most in ((edges, 7, 3), (own, 3, 2)):
            label[5] = number
            (said / f"{cloud.stem}.u8").unlink()
            (said / f"{cloud.stem}.txt").write_text("\n".join(map(str, label)))
            self.assertIn(f"{cloud.stem}.txt:6: expected a class in 0 ... {most}, or 255 or -1, not {number}",
                          run("evaluate", cloud, "--predictions", said, expect=3).stderr)
            (said / f"{cloud.stem}.txt").unlink()
            for value in (number, np.nan):
                np.save(said / f"{cloud.stem}.npy", np.where(np.arange(2000) == 5, value, 0.0))
                self.assertIn(f"{cloud.stem}.npy: row 5 is {value}, no class: there are 0 to {most}",
                              run("evaluate", cloud, "--predictions", said, expect=4).stderr)

    def test_a_cloud_is_no_file_of_lines(self):
        write_ply(self.folder / "a.ply", *cube(300))
        (self.folder / "truth.obj").write_text("v 0 0 0\nv 1 0 0\nl 1 2\n")
        said = run("evaluate", self.folder / "a.ply", "--truth", self.folder / "truth.obj", expect=4).stderr
        self.assertIn("a.ply: has no lines", said)

    def test_refuses_what_has_no_meaning(self):
        write_ply(self.folder / "a.ply", *cube(300))
        for extra in (("--no-context",), ("--no-boundary",), ("--exact",), ("--s-max", "1")):
            for other in (("--predictions", self.folder), ("--method", "ca"),
                          ("--truth", self.folder / "a.ply")):
                run("evaluate", self.folder / "a.ply", *other, *extra, expect=2)

    def test_the_default_model_takes_the_options_of_a_model(self):
        write_ply(self.folder / "a.ply", *cube(3000))
        scores = [json.loads(run("evaluate", self.folder / "a.ply", "--json", "-", "--s-max", "0.5",
                                 *model).stdout)["clouds"] for model in ((), ("--model", "general"))]
        self.assertEqual(*scores)

    def test_takes_the_scales_that_are_given(self):
        write_ply(self.folder / "a.ply", *cube(3000))
        scores = [json.loads(run("evaluate", self.folder / "a.ply", "--model", "scan", "--json", "-",
                                 *extra).stdout)["clouds"] for extra in ((), ("--s-max", "0.5"))]
        self.assertNotEqual(*scores)

    def test_refuses_predictions_for_another_cloud(self):
        write_ply(self.folder / "a.ply", *cube(300))
        (self.folder / "p").mkdir()
        (self.folder / "p" / "a.u8").write_bytes(bytes(299))
        done = run("evaluate", self.folder / "a.ply", "--predictions", self.folder / "p", expect=4)
        self.assertIn("a.ply", done.stderr)


if __name__ == "__main__":
    unittest.main()
