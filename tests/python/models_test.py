"""Models from Python: training, adapting, files, scores."""

import json
import pathlib
import pickle
import tempfile
import unittest
import warnings

import numpy as np

import pcednet
from support import CliTest, cube, run, write_ply


class Training(CliTest):
    @classmethod
    def setUpClass(cls):
        cls.positions, normals, cls.labels = cube(4000)
        cls.normals = normals.astype(np.float32)
        cls.model = pcednet.train(cls.positions, cls.labels, normals=cls.normals, epochs=5,
                                  scales=8, seed=3, name="cube")

    def setUp(self):
        super().setUp()
        warnings.simplefilter("ignore", pcednet.PcednetWarning)

    def test_a_training_gives_the_file_of_the_program(self):
        write_ply(self.path("in.ply"), self.positions, self.normals, self.labels,
                  position_type="double")
        run("train", self.path("in.ply"), "-o", self.path("cube.safetensors"), "--epochs", 5,
            "--scales", 8, "--seed", 3)
        self.model.save(self.path("ours.safetensors"))
        self.assertEqual(self.path("ours.safetensors").read_bytes(),
                         self.path("cube.safetensors").read_bytes())
        self.assertEqual([epoch["epoch"] for epoch in self.model.history], [1, 2, 3, 4, 5])
        self.assertGreater(self.model.history[0]["loss"], self.model.history[-1]["loss"])
        self.assertIn("validation_accuracy", self.model.history[0])

    def test_models_survive_files_and_pickles(self):
        self.model.save(self.path("a.safetensors"))
        with self.assertRaises(FileExistsError):
            self.model.save(self.path("a.safetensors"))
        self.model.save(self.path("a.safetensors"), overwrite=True)
        expected = self.model.classify(self.positions, self.normals)
        for model in (pcednet.Model.load(self.path("a.safetensors")),
                      pickle.loads(pickle.dumps(self.model))):
            found = pcednet.classify(self.positions, self.normals, model=model)
            np.testing.assert_array_equal(found.p_sharp, expected.p_sharp)
            self.assertEqual((model.name, model.seed, model.classes, model.has_context),
                             ("cube", 3, [0, 1, 2], False))
        self.assertEqual(pcednet.classify(self.positions, self.normals,
                                          model=self.path("a.safetensors")).model.name, "cube")
        self.path("b.safetensors").write_bytes(b"nothing of the kind")
        with self.assertRaises(pcednet.ModelError):
            pcednet.Model.load(self.path("b.safetensors"))
        with self.assertRaises(FileNotFoundError):
            pcednet.Model.load("absent.safetensors")

    def test_shipped_models_are_there(self):
        self.assertIn("general", pcednet.shipped_models())
        model = pcednet.Model.load()
        self.assertEqual((model.name, model.weights, model.has_context),
                         ("general", 12_099 + 1_907, True))
        self.assertEqual(model.descriptor["scales"], 8)

    def test_predictions_are_those_of_the_classification(self):
        matrix = pcednet.describe(self.positions, self.normals, scales=8)
        p = self.model.predict(matrix)
        result = self.model.classify(self.positions, self.normals, boundary=False)
        np.testing.assert_array_equal(p[:, 2], result.p_sharp)
        np.testing.assert_array_equal(p[:, 1], result.p_smooth)
        with self.assertRaises(pcednet.UsageError):
            self.model.predict(matrix[:, :5])

    def test_labels_may_be_given_in_several_ways(self):
        by_name = {name: np.flatnonzero(self.labels == number)
                   for number, name in enumerate(("non-edge", "smooth-edge", "sharp"))}
        by_mask = {number: self.labels == number for number in range(3)}
        clouds = [pcednet.Cloud(self.positions, self.normals, labels=self.labels)]
        expected = self.model.predict(np.ones((1, 8, 6)))
        for arguments in ((self.positions, by_name), (self.positions, by_mask),
                          ([self.positions], [self.labels.astype(int).tolist()]), (clouds,),
                          (clouds[0],)):
            model = pcednet.train(*arguments, epochs=5, scales=8, seed=3, normals=(
                [self.normals] if isinstance(arguments[0], list) else self.normals))
            np.testing.assert_array_equal(model.predict(np.ones((1, 8, 6))), expected)

    def test_wrong_labels_are_refused(self):
        few = self.positions[:100]
        for labels in (None, self.labels[:99], np.full(100, 7), {"sharp-edge": [100]},
                       {"sharp-edge": [-1]}, {"crease": [1]}, {2: [True]}, {2: [0.5]},
                       [self.labels[:100]] * 2):
            with self.assertRaises(pcednet.UsageError, msg=labels):
                pcednet.train(few, labels)
        with self.assertRaises(pcednet.UsageError):
            pcednet.train([few, few], [self.labels[:100]])
        with self.assertRaises(pcednet.UsageError):
            pcednet.train([], [])
        with self.assertRaisesRegex(TypeError, "unexpected keyword argument 'colour'"):
            pcednet.train(few, self.labels[:100], colour=1)
        for named in ({"network": "mlp"}, {"recipe": "sgd"}, {"classes": 4}, {"epochs": -1}):
            with self.assertRaises(pcednet.UsageError, msg=named):
                pcednet.train(self.positions, self.labels, normals=self.normals, **named)
        with self.assertRaises(pcednet.InsufficientError):
            pcednet.train(self.positions, np.full(4000, 255), normals=self.normals)
        with self.assertRaises(pcednet.InsufficientError):
            pcednet.train(self.positions, np.zeros(4000, int), normals=self.normals)

    def test_painted_points_teach_the_general_model(self):
        """The definition is changed: edges of the top face alone."""
        before = pcednet.classify(self.positions, self.normals)
        top = self.positions[:, 2] > 0.3
        painted = {"sharp-edge": np.flatnonzero((self.labels == 2) & top)[::2],
                   "non-edge": np.flatnonzero((self.labels == 2) & ~top)[::2]}
        model = pcednet.train(self.positions, painted, normals=self.normals, start="general",
                              name="mine", seed=5)
        again = pcednet.Model.load("general").adapt(self.positions, painted, seed=5,
                                                    normals=self.normals, threads=1)
        after = model.classify(self.positions, self.normals)
        self.assertEqual((model.name, model.has_context), ("mine", True))
        self.assertEqual(len(model.history), 30)  # twice 15 epochs
        np.testing.assert_array_equal(
            after.p_sharp, again.classify(self.positions, self.normals).p_sharp)
        flat = self.labels == 0
        self.assertGreater(np.mean(after.labels[flat] == before.labels[flat]), 0.95)
        self.assertTrue((after.p_sharp != before.p_sharp).any())


class Scoring(unittest.TestCase):
    def test_scores_are_those_of_the_program(self):
        positions, normals, labels = cube(3000, noise=0.01)
        normals = normals.astype(np.float32)
        result = pcednet.classify(positions, normals)
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "cube.ply"
            write_ply(file, positions, normals, labels, position_type="double")
            for positive in ("sharp", "edge"):
                theirs = json.loads(run("evaluate", file, "--positive", positive, "--json", "-",
                                        "--model", "general").stdout)["clouds"][0]
                scores = pcednet.evaluate(labels, result, positive)
                for name, value in vars(scores).items():
                    self.assertAlmostEqual(value, theirs[name], 6, name)

    def test_unlabelled_truth_is_left_out(self):
        scores = pcednet.evaluate([2, 0, 2, 255, -1], [2, 2, 0, 2, 0])
        self.assertEqual((scores.tp, scores.fp, scores.fn, scores.tn), (1, 1, 1, 0))
        self.assertEqual((scores.precision, scores.recall), (0.5, 0.5))
        self.assertIn("precision 0.500", repr(scores))
        cloud = pcednet.Cloud(np.zeros((2, 3)), labels=[3, 0])
        self.assertEqual(pcednet.evaluate(cloud, [3, 3], "boundary").tp, 1)
        with self.assertRaises(pcednet.UsageError):
            pcednet.evaluate([0, 1], [0])
        with self.assertRaises(pcednet.UsageError):
            pcednet.evaluate([0, 1], [0, 2], "smooth")


if __name__ == "__main__":
    unittest.main()
