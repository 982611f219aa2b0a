"""Models from Python: training, adapting, files, scores."""

import json
import os
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

    def test_a_model_that_learns_more_is_the_file_of_the_program(self):
        few = np.where(np.arange(4000) % 40 == 0, self.labels, 255)
        write_ply(self.path("in.ply"), self.positions, self.normals, few, position_type="double")
        run("train", self.path("in.ply"), "--start", "general", "-o", self.path("few.safetensors"), "--seed", 4)
        model = pcednet.train(self.positions, few, normals=self.normals, start="general", seed=4, name="few")
        model.save(self.path("ours.safetensors"))
        self.assertEqual(self.path("ours.safetensors").read_bytes(), self.path("few.safetensors").read_bytes())

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

    def test_an_extension_decides_the_format(self):
        self.model.save(self.path("m.ONNX"))
        self.model.save(self.path("m.onnx"))
        self.assertEqual(self.path("m.ONNX").read_bytes(), self.path("m.onnx").read_bytes())
        self.model.save(self.path("M.SafeTensors"))
        self.assertEqual(pcednet.Model.load(self.path("M.SafeTensors")).name, "cube")
        for wrong in ("m.pth", "m", "m.onnx.gz", ".onnx"):
            with self.assertRaisesRegex(pcednet.UsageError, "ends in .safetensors or .onnx"):
                self.model.save(self.path(wrong))
            self.assertFalse(self.path(wrong).exists())

    def test_descriptors_go_round(self):
        rows = self.positions[:1500]
        for name in pcednet.shipped_models():
            model = pcednet.Model.load(name)
            matrix = pcednet.describe(rows, self.normals[:1500], **model.descriptor)
            self.assertEqual(matrix.shape, (1500, model.descriptor["scales"], len(model.columns)))
            self.assertEqual(model.predict(matrix).shape, (1500, len(model.classes)))
            result = model.classify(rows, self.normals[:1500], context=False, boundary=False)
            np.testing.assert_array_equal(model.predict(matrix)[:, -1], result.p_sharp, name)
            trained = pcednet.train(rows, self.labels[:1500], normals=self.normals[:1500],
                                    epochs=1, **model.descriptor)
            self.assertEqual((trained.descriptor, trained.columns),
                             (model.descriptor, model.columns), name)

    def test_settings_that_a_file_lacks_are_told_and_pickled(self):
        rows = self.positions[:1500], self.normals[:1500]
        settings = {"s_min": 0.05, "s_max": 0.5, "exact": True, "eps": 0.3}
        model = pcednet.train(rows[0], self.labels[:1500], normals=rows[1], epochs=1, scales=4, **settings)
        self.assertLessEqual(settings.items(), model.descriptor.items())
        result = model.classify(*rows, boundary=False)
        self.assertEqual(result.scales, (0.05, 0.5))
        self.assertEqual(model.classify(*rows, exact=True).scales, (0.05, 0.5))
        matrix = pcednet.describe(*rows, **model.descriptor)
        np.testing.assert_array_equal(model.predict(matrix)[:, -1], result.p_sharp)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            copied = pickle.loads(pickle.dumps(model))
        np.testing.assert_array_equal(copied.classify(*rows).p_sharp, result.p_sharp)
        with self.assertWarnsRegex(pcednet.PcednetWarning, "does not keep s_min, s_max, exact, eps, which"):
            model.save(self.path("scaled.safetensors"))
        loaded = pcednet.Model.load(self.path("scaled.safetensors"))
        self.assertTrue(set(settings).isdisjoint(loaded.descriptor))
        again = loaded.classify(*rows, **{name: settings[name] for name in ("s_min", "s_max", "exact")})
        np.testing.assert_array_equal(again.p_sharp, result.p_sharp)

    def test_octaves_describe_uneven_clouds_as_the_classification_does(self):
        model = pcednet.Model.load("general")
        random = np.random.default_rng(3)
        away = np.exp(random.uniform(np.log(0.01), 0, 4000))  # a floor and a wall, seen from near
        angle = random.uniform(0, 2 * np.pi, 4000)
        rows = np.column_stack([away * np.cos(angle), away * np.sin(angle), np.zeros(4000)])
        normals = np.tile([0.0, 0.0, 1.0], (4000, 1))
        wall = rows[:, 0] < 0
        rows[wall], normals[wall] = rows[wall][:, [2, 1, 0]] * (1, 1, -1), (1, 0, 0)
        matrix = pcednet.describe(rows, normals, **model.descriptor)
        without = pcednet.describe(rows, normals, **{**model.descriptor, "octaves": False})
        self.assertTrue((matrix != without).any())
        found = model.classify(rows, normals, context=False, boundary=False)
        np.testing.assert_array_equal(model.predict(matrix)[:, 2], found.p_sharp)
        with self.assertRaisesRegex(pcednet.UsageError, "octaves: an s_max_ratio is needed"):
            pcednet.describe(rows, normals, octaves=True)

    def test_no_context_is_that_of_the_program(self):
        """Also of experts, which decide for clouds such as this."""
        write_ply(self.path("few.ply"), self.positions[:2000], position_type="double")
        run("classify", self.path("few.ply"), "-o", self.path("theirs.ply"), "--no-context")
        cloud = pcednet.read(self.path("few.ply"))
        pcednet.write(self.path("ours.ply"), cloud, pcednet.classify(cloud, context=False))
        self.assertEqual(self.path("ours.ply").read_bytes(), self.path("theirs.ply").read_bytes())

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
        some = matrix[:3].copy()
        some[1, 2, 3] = np.nan
        np.testing.assert_array_equal(self.model.predict(some)[::2], p[:3:2])
        self.assertTrue(np.isnan(self.model.predict(some.reshape(3, -1))[1]).all())
        self.assertEqual(self.model.predict(matrix[:0]).shape, (0, 3))

    def test_a_folder_does_not_hide_a_shipped_model(self):
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder)
        os.mkdir("scan")
        self.assertEqual(pcednet.Model.load("scan").name, "scan")
        with self.assertRaises(pcednet.UnreadableError):
            pcednet.Model.load(self.folder)

    def test_a_mask_is_no_array_of_classes(self):
        mask = self.labels == 2
        cloud = pcednet.Cloud(self.positions, self.normals, labels=mask)
        for refused in (lambda: pcednet.evaluate(mask, self.labels), lambda: pcednet.evaluate(self.labels, mask),
                        lambda: pcednet.evaluate(cloud, self.labels), lambda: pcednet.lines(self.positions, mask),
                        lambda: pcednet.train(self.positions, mask), lambda: pcednet.train(cloud),
                        lambda: pcednet.write(self.path("m.ply"), self.positions, labels=mask)):
            with self.assertRaisesRegex(pcednet.UsageError, r'mask.*\{"sharp-edge": mask\}'):
                refused()

    def test_options_of_a_new_network_are_refused_with_a_start(self):
        for options in ({"epochs": 3}, {"classes": 2}, {"context": True}, {"balance": 0.5}, {"distil": 2},
                        {"recipe": "paper"}, {"network": "none such"}, {"scales": 4}, {"gate": -7.0}):
            for train in (lambda **its: pcednet.train(self.positions, self.labels, start="general", **its),
                          lambda **its: self.model.adapt(self.positions, self.labels, **its)):
                with self.assertRaisesRegex(pcednet.UsageError, f"^{next(iter(options))}: not with start"):
                    train(**options)
        with self.assertRaises(TypeError):
            self.model.adapt(self.positions, self.labels, epoch=3)

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
        for named in ({"network": "mlp"}, {"recipe": "sgd"}, {"classes": 4}, {"epochs": -1}, {"name": None}):
            with self.assertRaises(pcednet.UsageError, msg=named):
                pcednet.train(self.positions, self.labels, normals=self.normals, **named)
        with self.assertRaises(pcednet.InsufficientError):
            pcednet.train(self.positions, np.full(4000, 255), normals=self.normals)
        with self.assertRaises(pcednet.InsufficientError):
            pcednet.train(self.positions, np.zeros(4000, int), normals=self.normals)

    def test_a_cloud_without_a_labelled_point_teaches_nothing(self):
        nothing = np.full(4000, 255)
        for labels in (nothing, nothing.astype(np.uint8), np.full(4000, -1), {"sharp-edge": []},
                       {"sharp-edge": np.zeros(4000, bool)}, {}, {"unlabelled": [3]}):
            for start in (None, "general"):
                with self.assertRaisesRegex(pcednet.InsufficientError, "^cloud 0: no point is labelled$"):
                    pcednet.train(self.positions, labels, normals=self.normals, start=start)
        with self.assertRaisesRegex(pcednet.InsufficientError, "^cloud 1: no point is labelled$"):
            pcednet.train([self.positions] * 2, [self.labels, nothing], start="general")

    def test_a_point_in_two_classes_is_named(self):
        both = np.zeros(4000, bool)
        both[7:9] = True
        for labels, classes in (({"sharp-edge": [5, 7], "non-edge": [7, 8]}, "sharp-edge and non-edge"),
                                ({0: both, "smooth": [1, 7]}, "non-edge and smooth-edge"),
                                ({"unlabelled": [7], 2: [7]}, "unlabelled and sharp-edge")):
            with self.assertRaisesRegex(pcednet.UsageError,
                                        f"^labels: point 7 is in two classes, {classes}$"):
                pcednet.train(self.positions, labels, normals=self.normals, start="general")
        pcednet.write(self.path("a.ply"), self.positions, labels={2: [5, 5], "sharp": [5], 0: []})
        self.assertEqual(pcednet.read(self.path("a.ply")).labels[5], 2)

    def test_numbers_that_are_no_classes_are_named(self):
        for number in (4, 7, 254):
            for kind in (np.uint8, np.int32):
                labels = self.labels.astype(kind)
                labels[9] = number
                cloud = pcednet.Cloud(self.positions, self.normals)
                cloud.labels = labels
                for arguments in ((self.positions, labels), (cloud,)):
                    with self.assertRaisesRegex(pcednet.UsageError,
                                                f"labels: {number} is no class: 0 non-edge"):
                        pcednet.train(*arguments, epochs=1)
                with self.assertRaisesRegex(pcednet.UsageError, f"truth: {number} is no class"):
                    pcednet.evaluate(labels, self.labels)
                with self.assertRaisesRegex(pcednet.UsageError, f"predicted: {number} is no"):
                    pcednet.evaluate(self.labels, labels)

    def test_a_missing_class_is_named_by_its_label(self):
        def refused(said, labels, **options):
            with self.assertRaisesRegex(pcednet.InsufficientError, f"^{said}$"):
                pcednet.train(self.positions, labels, normals=self.normals, epochs=1, scales=4,
                              **options)
        without_sharp = np.where(self.labels == 2, 255, self.labels)
        refused(r"no point is labelled sharp-edge \(2\)", without_sharp)
        refused(r"no point is labelled sharp-edge \(2\)", without_sharp, classes=2)
        refused(r"no point is labelled non-edge \(0\)", np.where(self.labels == 0, 255,
                                                                 self.labels))
        two = np.where(self.labels == 1, 255, self.labels)
        refused(r"train: no point is labelled smooth-edge \(1\); classes=2 learns sharp-edge "
                r"\(2\) alone", two)
        pcednet.train(self.positions, two, normals=self.normals, epochs=1, scales=4, classes=2)

    def test_options_out_of_range_are_refused(self):
        for named in ({"balance": -0.1}, {"balance": 1.5}, {"balance": float("nan")},
                      {"balance": float("inf")}, {"distil": 101}, {"distil": -1}, {"epochs": 0},
                      {"eps": 0.0}, {"eps": float("nan")}, {"gate": 1.5}, {"gate": float("nan")},
                      {"second_gate": -2.0}, {"s_min": -1.0}, {"s_min": float("nan")},
                      {"s_max": float("nan")}, {"s_max": float("inf")}, {"s_max_ratio": -1.0},
                      {"s_max_ratio": float("nan")}, {"s_max_ratio": 0.5}, {"octaves": True},
                      {"scales": 5}, {"features": 5}, {"classes": 1}, {"seed": -1}):
            with self.assertRaises(pcednet.UsageError, msg=named):
                pcednet.train(self.positions, self.labels, normals=self.normals,
                              **{"epochs": 1, "scales": 4, **named})

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

    def test_the_program_reads_arrays_of_any_layout(self):
        positions, _, labels = cube(600)
        edge = labels > 0
        scores = np.column_stack([~edge, edge]).astype(np.float16)
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            write_ply(folder / "cube.ply", positions, labels=labels)
            for array in (edge, scores, np.asfortranarray(scores), labels.astype(np.float16),
                          np.asfortranarray(scores.astype(np.float64))):
                np.save(folder / "cube.npy", array)
                done = run("evaluate", folder / "cube.ply", "--predictions", folder, "--positive",
                           "edge", "--json", "-")
                self.assertEqual(json.loads(done.stdout)["clouds"][0]["mcc"], 1, array.dtype)
            for array, cause in ((labels.astype(">i4"), ">i4"), (labels.astype("c8"), "<c8")):
                np.save(folder / "cube.npy", array)
                done = run("evaluate", folder / "cube.ply", "--predictions", folder, expect=3)
                self.assertIn(f'numpy\'s type "{cause}"; expected', done.stderr)

    def test_unlabelled_truth_is_left_out(self):
        scores = pcednet.evaluate([2, 0, 2, 255, -1], [2, 2, 0, 2, 0])
        self.assertEqual((scores.tp, scores.fp, scores.fn, scores.tn), (1, 1, 1, 0))
        self.assertEqual((scores.precision, scores.recall), (0.5, 0.5))
        self.assertIn("precision 0.500", repr(scores))
        cloud = pcednet.Cloud(np.zeros((2, 3)), labels=[3, 0])
        self.assertEqual(pcednet.evaluate(cloud, [3, 3], "boundary").tp, 1)
        with self.assertRaises(pcednet.UsageError):
            pcednet.evaluate([0, 1], [0])
        bare = pcednet.Cloud(np.zeros((2, 3)))
        for said, *arguments in (("truth: no point is labelled", [], []), ("truth: no point is labelled", [255, -1], [0, 2]),
                                 ("truth: the cloud has no labels", bare, [0, 2]),
                                 ("predicted: the cloud has no labels", [0, 2], bare)):
            with self.assertRaisesRegex(pcednet.InsufficientError, said):
                pcednet.evaluate(*arguments)

    def test_edges_marked_by_one_are_a_warning(self):
        mask = np.array([0, 1, 1, 0])
        with self.assertWarnsRegex(pcednet.PcednetWarning, r"predicted: 2 points are smooth-edge \(1\), none is sharp-edge"):
            self.assertEqual(pcednet.evaluate(2 * mask, mask).mcc, 0)
        with self.assertWarnsRegex(pcednet.PcednetWarning, "truth: 2 points are smooth-edge"):
            pcednet.evaluate(mask, 2 * mask)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.assertEqual(pcednet.evaluate(mask, mask, "edge").mcc, 1)
            self.assertEqual(pcednet.evaluate(2 * mask, 2 * mask).mcc, 1)

    def test_a_result_may_be_the_truth(self):
        positions, normals, _ = cube(1000)
        result = pcednet.classify(positions, normals)
        self.assertEqual(pcednet.evaluate(result, result).mcc, 1)
        with self.assertRaises(pcednet.UsageError):
            pcednet.evaluate([0, 1], [0, 2], "smooth")


if __name__ == "__main__":
    unittest.main()
