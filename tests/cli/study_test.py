"""pcednet study: the experiments as files, again from the cache, interrupted, refused."""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import time
import unittest

from support import PROGRAM, SOURCE, CliTest, cube, run, write_own, write_ply

SCORES = {"precision", "recall", "mcc", "f1", "accuracy", "iou"}
COUNTS = {"name", "points", "tp", "fp", "tn", "fn"}


class Study(CliTest):
    def setUp(self):
        super().setUp()
        for folder, seeds in (("train", (1, 2)), ("test", (3, 4))):
            (self.folder / folder).mkdir()
            for seed in seeds:
                write_ply(self.folder / folder / f"cube{seed}.ply", *cube(900, seed))

    def study(self, *arguments, **options):
        return run("study", *arguments, "--train", "train", "-o", "out", "--epochs", "2",
                   cwd=self.folder, **options)

    def read(self, name):
        return json.loads((self.folder / "out" / f"{name}.json").read_text())

    def check_schema(self, study, name):
        self.assertEqual(study["schema"], "pcednet-study-1")
        self.assertEqual(study["experiment"], name)
        for key in ("title", "question", "command", "version", "machine"):
            self.assertIsInstance(study[key], str)
            self.assertTrue(study[key])
        sets = {s["name"]: [c["name"] for c in s["clouds"]] for s in study["sets"]}
        for cloud in (c for s in study["sets"] for c in s["clouds"]):  # a report may be made from anywhere
            self.assertTrue((self.folder / "out" / cloud["file"]).is_file(), cloud["file"])
        variants = {v["id"]: v for v in study["variants"]}
        self.assertEqual(len(variants), len(study["variants"]))
        for variant in variants.values():
            self.assertIn(variant["family"], ("network", "classic", "external"))
            self.assertEqual(variant["x"] is None, study["x_label"] is None)
        for result in study["results"]:
            self.assertIn(result["variant"], variants)
            self.assertIn(result["positive"], ("edge", "sharp"))
            self.assertLessEqual({c["name"] for c in result["clouds"]}, set(sets[result["set"]]))
            for cloud in result["clouds"]:
                self.assertEqual(set(cloud), SCORES | COUNTS)
                self.assertEqual(cloud["points"], sum(cloud[k] for k in ("tp", "fp", "tn", "fn")))
            self.assertEqual(set(result["median"]), SCORES)
            self.assertLessEqual(SCORES, set(result["pooled"]))
            self.assertTrue(all(s >= 0 for s in result["seconds"].values()))
            if result["predictions"]:
                for cloud in result["clouds"]:
                    file = self.folder / "out" / result["predictions"] / f"{cloud['name']}.u8"
                    self.assertEqual(file.stat().st_size, 900)
        for curve in study["curves"]:
            self.assertEqual([e["epoch"] for e in curve["epochs"]], [1, 2])
            self.assertLessEqual({"seconds", "loss", "held_out_loss", "held_out_mcc"},
                                 set(curve["epochs"][0]))

    def test_writes_what_evaluate_finds_with_the_same_predictions(self):
        self.study("methods", "--test", "a=test", "--seeds", "2,1", "--methods", "pcednet,fc-2c")
        study = self.read("methods")
        self.check_schema(study, "methods")
        self.assertEqual([v["parameters"] for v in study["variants"]], [1623, 6646])
        self.assertEqual(sorted({r["seed"] for r in study["results"]}), [1, 2])
        self.assertEqual(len(study["curves"]), 4)
        for result in study["results"]:
            if not result["predictions"]:
                continue
            done = run("evaluate", self.folder / "test", "--predictions",
                       self.folder / "out" / result["predictions"], "--positive",
                       result["positive"], "--json", "-")
            expected = json.loads(done.stdout)
            for part in ("clouds", "median", "pooled"):
                self.assertEqual(result[part], expected[part])

    def test_names_that_are_not_utf8(self):
        odd = os.fsencode(self.folder) + b"/t\xe4st"
        os.rename(self.folder / "test", odd)
        os.rename(odd + b"/cube3.ply", odd + b"/c\xfcbe.ply")
        shutil.copy(SOURCE / "models" / "scan.safetensors", os.fsencode(self.folder) + b"/m\xfc.safetensors")
        words = ("methods", "--test", b"a=t\xe4st", "--models", b"m\xfc.safetensors",
                 "--methods", b"ca,m\xfc")
        command = [PROGRAM, "study", *words, "--train", "train", "-o", "out"]
        for _ in range(2):  # the second one is of the same command, and finds all in the cache
            done = subprocess.run(command, cwd=self.folder, capture_output=True)
            self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(b"0 clouds classified", done.stderr)
        study = self.read("methods")
        self.assertEqual([v["id"] for v in study["variants"]], ["m\ufffd", "ca"])
        self.assertEqual([(c["name"], c["file"]) for c in study["sets"][0]["clouds"]],
                         [("cube4", "../t\ufffdst/cube4.ply"), ("c\ufffdbe", "../t\ufffdst/c\ufffdbe.ply")])
        os.rename(odd + b"/cube4.ply", odd + b"/c\xe4be.ply")
        done = subprocess.run([*command[:-1], "other"], cwd=self.folder, capture_output=True)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("t\udce4st/c\udcfcbe.ply: the set a has a cloud c\ufffdbe already", os.fsdecode(done.stderr))

    def test_refuses_what_no_experiment_reads(self):
        for option, value in (("--predictions", "x=out"), ("--models", "scan"), ("--fee", "a=1,2")):
            done = run("study", "scales", "--test", f"a={self.folder / 'test'}", "-o", self.folder / "o", option, value, expect=2)
            self.assertIn(f"{option}: only the experiment methods", done.stderr)

    def test_does_nothing_twice(self):
        first = self.study("classes", "--test", "a=test", "--quick")
        self.check_schema(self.read("classes"), "classes")
        self.assertIn("2 networks trained, 4 clouds classified", first.stderr)
        before = (self.folder / "out" / "classes.json").read_bytes()
        second = self.study("classes", "--test", "a=test", "--quick")
        self.assertIn("0 networks trained, 0 clouds classified", second.stderr)
        self.assertEqual((self.folder / "out" / "classes.json").read_bytes(), before)
        self.assertEqual(first.stdout, second.stdout)

    def test_copc_has_the_stem_that_evaluate_gives_it(self):
        (self.folder / "copc").mkdir()
        run("convert", self.folder / "test/cube3.ply", "-o", self.folder / "copc/cube3.copc.laz")
        self.study("methods", "--methods", "ca", "--test", "a=copc")
        self.assertEqual([c["name"] for c in self.read("methods")["sets"][0]["clouds"]], ["cube3"])
        run("evaluate", self.folder / "copc", "--predictions", self.folder / "out/predictions/methods/ca/a")

    def test_another_program_classifies_anew(self):
        other = self.folder / "other"
        other.write_bytes(pathlib.Path(PROGRAM).read_bytes() + b"\0")
        other.chmod(0o755)
        for program, classified in ((PROGRAM, 2), (PROGRAM, 0), (other, 2), (other, 0)):
            done = subprocess.run([program, "study", "methods", "--methods", "ca", "--test", "a=test", "--train", "train",
                                   "-o", "out", "--overwrite"], cwd=self.folder, capture_output=True, text=True)
            self.assertIn(f"{classified} clouds classified", done.stderr)

    def test_runs_the_sweeps(self):
        self.study("range", "density", "noise", "--test", "a=test", "--quick")
        for name, rows in (("range", 5), ("density", 5), ("noise", 9)):
            study = self.read(name)
            self.check_schema(study, name)
            self.assertEqual(len(study["variants"]), rows)
        clean = {v["id"] for v in self.read("noise")["variants"] if v["x"] == 0}
        counts = {r["variant"]: r["pooled"] for r in self.read("noise")["results"]}
        self.assertEqual(counts["isotropic-0"], counts["normal-0"])
        self.assertEqual(len(clean), 3)

    def test_stops_while_it_generates_the_training_set(self):
        command = ["study", "features", "--test", "a=test", "-o", "out", "--progress", "plain"]
        program = subprocess.Popen([PROGRAM, *command], cwd=self.folder, stderr=subprocess.PIPE, text=True)
        self.assertIn("generate", program.stderr.readline())
        program.send_signal(signal.SIGINT)
        _, words = program.communicate(timeout=120)
        self.assertEqual(program.returncode, 130, words)
        self.assertNotIn("train", words)

    def test_goes_on_after_an_interrupt(self):
        command = ["study", "features", "--test", "a=test", "--train", "train", "-o", "out",
                   "--seeds", "1,2,3", "--epochs", "12", "--progress", "plain"]
        program = subprocess.Popen([PROGRAM, *command], cwd=self.folder, stderr=subprocess.PIPE,
                                   text=True)
        deadline = time.monotonic() + 120
        kept = 0
        while kept < 2 and program.poll() is None and time.monotonic() < deadline:
            kept = len(list((self.folder / "out" / "cache").glob("model-*.json")))
            time.sleep(0.02)
        program.send_signal(signal.SIGINT)
        _, words = program.communicate(timeout=120)
        self.assertEqual(program.returncode, 130, words)
        self.assertIn("the same command resumes", words)
        self.assertFalse((self.folder / "out" / "features.json").exists())
        kept = len(list((self.folder / "out" / "cache").glob("model-*.json")))
        done = run(*command, cwd=self.folder)
        self.assertIn(f"{15 - kept} networks trained", done.stderr)
        self.check_features(self.read("features"))

    def check_features(self, study):
        self.assertEqual([v["id"] for v in study["variants"]],
                         ["features28", "features7", "features6", "features4", "features3"])
        self.assertEqual(len(study["results"]), 5 * 3)

    def test_leaves_out_what_was_learnt_from(self):
        write_ply(self.folder / "test" / "known.ply", *cube(900, 1))
        done = self.study("classes", "--test", "a=test", "--quick")
        self.assertIn("known of a is not scored", done.stderr)
        for result in self.read("classes")["results"]:
            self.assertEqual([c["name"] for c in result["clouds"]], ["cube3", "cube4"])

    def test_refuses_to_score_nothing(self):
        said = self.study("classes", "--test", "a=train", expect=4).stderr
        self.assertIn("nothing to score", said)
        self.assertNotIn("train pcednet", said)
        self.assertEqual(list(self.folder.glob("out/*.json")), [])

    def test_compares_models_and_predictions_of_others(self):
        folder = self.folder / "others" / "a"
        folder.mkdir(parents=True)
        _, _, label = cube(900, 3)
        (folder / "cube3.u8").write_bytes(label.tobytes())
        done = self.study("methods", "--test", "a=test", "--quick", "--models", "scan",
                          "--predictions", "perfect=others/{set}", "--methods", "scan,perfect")
        self.assertIn("cube4 of a has no classes by perfect", done.stderr)
        study = self.read("methods")
        self.check_schema(study, "methods")
        self.assertEqual([v["family"] for v in study["variants"]], ["network", "external"])
        perfect = [r for r in study["results"] if r["variant"] == "perfect"]
        self.assertTrue(perfect)
        for result in perfect:
            self.assertEqual(result["median"]["mcc"], 1.0)
            self.assertEqual([c["name"] for c in result["clouds"]], ["cube3"])

    def test_generates_training_clouds_only_for_networks(self):
        command = ("study", "methods", "--test", "a=test", "--progress", "plain", "-o", "out")
        said = run(*command, "--methods", "ca", cwd=self.folder).stderr
        self.assertNotIn("generate ", said)
        self.check_schema(self.read("methods"), "methods")

    def test_refuses_what_makes_no_sense(self):
        self.assertIn("no experiment nonsense",
                      self.study("nonsense", "--test", "a=test", expect=2).stderr)
        self.assertIn("--test", self.study("classes", expect=2).stderr)
        self.assertIn("NAME=VALUE", self.study("classes", "--test", "test", expect=2).stderr)
        for positive, said in (("b=edge", "--positive b=edge: no set of --test is named b"),
                               ("a=flat", "--positive a=flat: give SET=sharp or SET=edge")):
            self.assertIn(said, self.study("classes", "--test", "a=test", "--positive", positive,
                                           expect=2).stderr)
        self.study("classes", "--test", "a=test", "--methods", "nobody", expect=2)
        self.study("classes", "--test", "a=nowhere", expect=3)
        write_ply(self.folder / "bare.ply", *cube(100)[:2])
        self.assertIn("bare.ply", self.study("classes", "--test", "a=bare.ply", expect=4).stderr)
        run("study", "classes", "--test", f"a={self.folder / 'test'}", expect=2)
        said = self.study("classes", "--test", "a=test", "--seeds", "2,1,2", expect=2).stderr
        self.assertIn("--seeds 2,1,2: the seed 2 is there twice", said)
        self.assertFalse((self.folder / "out").exists())
        (self.folder / "out").mkdir()
        (self.folder / "out" / "classes.json").write_text("{}")
        self.study("classes", "--test", "a=test", expect=2)

    def test_refuses_own_classes(self):
        own = write_own(self.folder / "own.ply", *cube(900))
        said = "its classes are ground, wall, pipe; a study is of edge classes"
        self.assertIn(f"own.ply: {said}", self.study("classes", "--test", "a=test", "--test", "a=own.ply",
                                                     expect=4).stderr)
        done = run("study", "classes", "--test", "a=test", "--train", own, "-o", "out", cwd=self.folder,
                   expect=4)
        self.assertIn(f"{own}: {said}", done.stderr)
        run("train", own, "-o", self.folder / "own.safetensors", "--epochs", "2", "--scales", "4")
        self.assertIn(f"own.safetensors: {said}",
                      self.study("methods", "--test", "a=test", "--quick", "--models", "own.safetensors",
                                 "--methods", "own", expect=5).stderr)

    def test_lists_the_experiments(self):
        names = [line.split()[0] for line in run("study", "list").stdout.splitlines()]
        for name in ("methods", "features", "classes", "scales", "range", "density", "noise",
                     "reconstructions", "timing", "energy", "learning"):
            self.assertIn(name, names)


if __name__ == "__main__":
    unittest.main()
