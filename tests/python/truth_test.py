"""Results of pcednet as truth: what was painted or given counts, as for the program, not what was predicted."""

import copy
import json
import unittest
import warnings

import numpy as np

import pcednet
from support import CliTest, cube, run, write_ply


class ResultsAsTruth(CliTest):
    def setUp(self):
        super().setUp()
        positions, normals, self.labels = cube(3000, noise=0.01)
        write_ply(self.path("cube.ply"), positions, normals, self.labels)
        run("classify", self.path("cube.ply"), "-o", self.path("result.ply"))
        self.result = pcednet.read(self.path("result.ply"))
        self.predicted = self.result.labels.copy()
        self.assertTrue((self.predicted != self.labels).any())

    def scores(self, cloud, said):
        with self.assertWarnsRegex(pcednet.PcednetWarning, said):
            return vars(pcednet.evaluate(cloud, cloud))

    def expected(self, truth):
        return vars(pcednet.evaluate(truth, self.predicted))

    def test_the_labels_of_the_input_are_scored_as_by_the_program(self):
        ours = self.scores(self.result, "^result: a result of pcednet: .* scalar_input_label$")
        self.assertEqual(ours, self.expected(self.labels))
        self.path("said").mkdir()
        self.path("said/result.u8").write_bytes(self.predicted.tobytes())
        theirs = json.loads(run("evaluate", self.path("result.ply"), "--predictions",
                                self.path("said"), "--json", "-").stdout)["clouds"][0]
        for name, value in ours.items():
            self.assertAlmostEqual(value, theirs[name], 6, name)

    def test_painted_labels_come_first(self):
        painted = np.full(3000, 255, np.uint8)
        self.result["scalar_painted_label"] = painted
        self.assertEqual(self.scores(self.result, "scalar_input_label"), self.expected(self.labels))
        painted[:900] = 2
        self.assertEqual(self.scores(self.result, "scalar_painted_label"), self.expected(painted))
        pcednet.write(self.path("painted.ply"), self.result)
        again = pcednet.read(self.path("painted.ply"))
        self.assertEqual(self.scores(again, "scalar_painted_label"), self.expected(painted))

    def test_own_labels_alone_are_scored_with_a_warning(self):
        del self.result.attributes["scalar_input_label"]
        self.assertEqual(self.scores(self.result, "no truth unless")["mcc"], 1)

    def test_lines_are_of_changed_labels_in_memory_and_in_the_file(self):
        self.assertGreater(len(pcednet.lines(self.result)), 0)
        self.result.labels = np.zeros(3000, np.uint8)
        self.assertEqual(len(pcednet.lines(self.result)), 0)
        for name in ("a.ply", "a.las"):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", pcednet.PcednetWarning)
                pcednet.write(self.path(name), self.result)
            again = pcednet.read(self.path(name))
            self.assertEqual(len(pcednet.lines(again)), 0)
            np.testing.assert_array_equal(again["scalar_edge_class"], 0)
            self.assertIn("0 curves", run("lines", self.path(name), "-o", self.path("a.dxf"), "--overwrite").stderr)

    def test_what_another_program_corrected_counts(self):
        """CloudCompare drops the comments and keeps the columns."""
        corrected = np.where(np.arange(3000) < 500, 0, self.predicted)
        columns = {name: self.result[name] for name in ("scalar_p_sharp", "scalar_p_smooth")}
        for name, classes, labels, said in (("a", corrected, self.predicted, "scalar_edge_class, which was corrected$"),
                                            ("b", self.predicted, corrected, "label, which was corrected$"),
                                            ("c", self.predicted, self.predicted, "no truth unless"),
                                            ("d", corrected, None, "scalar_edge_class are no truth unless")):
            pcednet.write(self.path(f"{name}.ply"), self.result.xyz, labels=labels,
                          attributes={"scalar_edge_class": classes.astype(np.float32), **columns})
            cloud = pcednet.read(self.path(f"{name}.ply"))
            wanted = self.predicted if name == "c" else corrected
            with self.assertWarnsRegex(pcednet.PcednetWarning, said):
                self.assertEqual(vars(pcednet.evaluate(cloud, self.predicted)), self.expected(wanted))
            with self.assertWarnsRegex(pcednet.PcednetWarning, said):
                pcednet.train(cloud, start="general")
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                pcednet.lines(cloud)
            self.assertEqual(any("edge_class is drawn" in str(one.message) for one in caught), name in "ab")

    def test_columns_of_edges_are_labels_as_for_the_program(self):
        marked = (self.predicted == 2).astype(np.float32)
        file = self.path("marked.ply")
        pcednet.write(file, self.result.xyz, attributes={"is_edge": marked, "other_edge": 7 * marked})
        cloud = pcednet.read(file)
        run("lines", file, "-o", self.path("theirs.obj"))
        with self.assertWarnsRegex(pcednet.PcednetWarning, "^marked: labels from its column is_edge$"):
            pcednet.lines(cloud).write(self.path("ours.obj"))
        self.assertEqual(self.path("ours.obj").read_bytes(), self.path("theirs.obj").read_bytes())
        run("train", file, "-o", self.path("theirs.safetensors"), "--epochs", 1, "--classes", 2)
        with self.assertWarnsRegex(pcednet.PcednetWarning, "^marked: labels from its column is_edge$"):
            pcednet.train(cloud, epochs=1, classes=2, name="theirs").save(self.path("ours.safetensors"))
        self.assertEqual(self.path("ours.safetensors").read_bytes(), self.path("theirs.safetensors").read_bytes())
        with self.assertWarnsRegex(pcednet.PcednetWarning, "^marked: labels from its column is_edge$"):
            self.assertEqual(pcednet.evaluate(2 * marked, cloud).mcc, 1)
        cloud["is_edge"] = marked / 2
        with self.assertRaisesRegex(pcednet.InsufficientError, "the cloud has no labels"):
            pcednet.evaluate(cloud, self.predicted)

    def test_changed_labels_count(self):
        corrected = np.where(np.arange(3000) < 500, 0, self.predicted)
        in_place = copy.deepcopy(self.result)
        in_place.labels[:500] = 0
        replaced = copy.copy(self.result)
        replaced.labels = corrected.tolist()
        foreign = pcednet.Cloud(self.result.xyz, labels=corrected)
        foreign.comments = list(self.result.comments)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            for cloud in (in_place, replaced, foreign, replaced.select(np.arange(3000))):
                self.assertEqual(vars(pcednet.evaluate(cloud, self.predicted)),
                                 self.expected(corrected))

    def test_changed_labels_are_true_of_their_file_too(self):
        rows = np.arange(3000)
        corrected = np.where(rows < 500, 0, self.predicted)
        self.result.labels = corrected.astype(int)
        for name, cloud, wanted in (("a.ply", self.result, corrected), ("a.las", self.result, corrected),
                                    ("part.ply", self.result.select(rows[::2]), corrected[::2]),
                                    ("copy.ply", copy.deepcopy(self.result), corrected)):
            with self.subTest(name):
                with warnings.catch_warnings():
                    warnings.filterwarnings("error", message=".*painted")
                    warnings.filterwarnings("ignore", message=".*digits of positions")
                    pcednet.write(self.path(name), cloud)
                again = pcednet.read(self.path(name))
                np.testing.assert_array_equal(again["scalar_edge_class"], wanted)
                if name.endswith(".ply"):  # LAS holds equal columns once
                    np.testing.assert_array_equal(again.labels, wanted)
                predicted = self.predicted[::3000 // len(wanted)]
                with self.assertWarnsRegex(pcednet.PcednetWarning, "scalar_painted_label$"):
                    scores = pcednet.evaluate(again, predicted)
                self.assertEqual(vars(scores), vars(pcednet.evaluate(wanted, predicted)))
        run("classify", self.path("a.ply"), "-o", self.path("again.ply"), "--model", "cad")
        run("train", self.path("again.ply"), "-o", self.path("theirs.safetensors"), "--epochs", 1, "--scales", 4)
        model = pcednet.train(self.result, epochs=1, scales=4, name="theirs")
        for name, weights in pcednet.Model.load(self.path("theirs.safetensors")).tensors.items():
            np.testing.assert_array_equal(model.tensors[name], weights)

    def test_changed_labels_that_replace_painted_ones_are_told(self):
        painted = np.full(3000, 255, np.uint8)
        painted[:900] = 2
        self.result["scalar_painted_label"] = painted
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            pcednet.write(self.path("kept.ply"), self.result)
        self.result.labels[:500] = 0
        with self.assertWarnsRegex(pcednet.PcednetWarning, "replace its scalar_painted_label$"):
            pcednet.write(self.path("replaced.ply"), self.result)
        np.testing.assert_array_equal(pcednet.read(self.path("kept.ply"))["scalar_painted_label"], painted)
        again = pcednet.read(self.path("replaced.ply"))
        np.testing.assert_array_equal(again["scalar_painted_label"], self.result.labels)

    def test_copies_parts_and_other_types_of_the_same_labels_do_not(self):
        of_ints = copy.deepcopy(self.result)
        of_ints.labels = of_ints.labels.astype(int)
        for cloud in (copy.deepcopy(self.result), self.result.select(np.arange(3000)), of_ints):
            self.assertEqual(self.scores(cloud, "scalar_input_label"), self.expected(self.labels))

    def test_a_training_is_that_of_the_program(self):
        run("train", self.path("result.ply"), "-o", self.path("theirs.safetensors"), "--epochs", 3,
            "--scales", 4)
        with self.assertWarnsRegex(pcednet.PcednetWarning, "^result: .* scalar_input_label$"):
            model = pcednet.train(self.result, epochs=3, scales=4, name="theirs")
        model.save(self.path("ours.safetensors"))
        self.assertEqual(self.path("ours.safetensors").read_bytes(),
                         self.path("theirs.safetensors").read_bytes())
        given = pcednet.train(self.result, self.labels, epochs=3, scales=4, name="theirs")
        for name, weights in model.tensors.items():
            np.testing.assert_array_equal(given.tensors[name], weights)


if __name__ == "__main__":
    unittest.main()
