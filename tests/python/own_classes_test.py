"""Classes other than edges from Python: learning, finding, writing, as the program does."""

import unittest
import warnings

import numpy as np

import pcednet
from support import CliTest, cube, run

NAMES = ["ground", "wall", "pipe"]
TABLE = [f"pcednet class {number} #{number}0a0b0 {name}" for number, name in enumerate(NAMES)]


def owned(points=3000, seed=1, table=TABLE):
    positions, normals, labels = cube(points, seed)
    cloud = pcednet.Cloud(positions, normals.astype(np.float32), labels=labels, name="own")
    cloud.comments = list(table)
    return cloud


class OwnClasses(CliTest):
    @classmethod
    def setUpClass(cls):
        cls.model = pcednet.train(owned(), epochs=5, scales=8, name="own")

    def setUp(self):
        super().setUp()
        warnings.simplefilter("ignore", pcednet.PcednetWarning)
        pcednet.write(self.path("in.ply"), owned())
        self.model.save(self.path("own.safetensors"))

    def test_they_are_learnt_as_by_the_program(self):
        run("train", self.path("in.ply"), "-o", self.path("theirs.safetensors"), "--epochs", 5,
            "--scales", 8)
        cloud = pcednet.read(self.path("in.ply"))
        self.assertEqual(cloud.class_names, NAMES)
        ours = pcednet.train(cloud, epochs=5, scales=8, name="theirs")
        self.assertEqual((ours.classes, ours.class_names), ([0, 1, 2], NAMES))
        ours.save(self.path("ours.safetensors"))
        self.assertEqual(self.path("ours.safetensors").read_bytes(),
                         self.path("theirs.safetensors").read_bytes())
        painted = {name: np.flatnonzero(cloud.labels == number)
                   for number, name in enumerate(NAMES)}
        again = pcednet.train(cloud, painted, epochs=5, scales=8, name="theirs")
        for name, weights in ours.tensors.items():
            np.testing.assert_array_equal(again.tensors[name], weights)

    def test_a_result_has_their_names_and_probabilities(self):
        cloud = owned(seed=2)
        result = pcednet.classify(cloud, model=self.path("own.safetensors"))
        self.assertEqual(result.class_names, NAMES)
        self.assertEqual(list(result.counts), [*NAMES, "unlabelled"])
        self.assertRegex(repr(result), r"\d+ ground, \d+ wall, \d+ pipe>")
        self.assertEqual(result.p_class.shape, (3000,))
        self.assertTrue((result.p_class >= 1 / 3 - 1e-5).all())
        self.assertLess(result.p_class.min(), 0.9)
        np.testing.assert_array_equal(result.confidence, result.p_class)
        self.assertGreater((result.labels == cloud.labels).mean(), 0.8)
        self.assertFalse(result.p_sharp.any())
        edges = pcednet.classify(cloud)
        self.assertIsNone(edges.p_class)
        self.assertEqual(edges.class_names[:2], ["non-edge", "smooth-edge"])

    def test_a_result_is_written_as_by_the_program(self):
        for ending in ("ply", "las", "pcd"):
            theirs, ours = self.path(f"theirs.{ending}"), self.path(f"ours.{ending}")
            run("classify", self.path("in.ply"), "-o", theirs, "--model",
                self.path("own.safetensors"))
            cloud = pcednet.read(self.path("in.ply"))
            pcednet.write(ours, cloud, pcednet.classify(cloud, model=self.path("own.safetensors")))
            self.assertEqual(ours.read_bytes(), theirs.read_bytes(), ending)

    def test_unlabelled_points_have_no_confidence(self):
        cloud = owned()
        cloud.xyz[7] = np.nan
        result = self.model.classify(cloud)
        self.assertEqual((result.labels[7], result.counts["unlabelled"]), (255, 1))
        self.assertEqual(np.flatnonzero(np.isnan(result.confidence)).tolist(), [7])

    def test_lines_and_scores_are_of_edge_classes(self):
        cloud = owned()
        result = self.model.classify(cloud)
        with self.assertRaisesRegex(pcednet.UsageError, "ground, wall, pipe; lines are of edge"):
            pcednet.lines(cloud.xyz, result)
        for truth, predicted in ((cloud.labels, result), (cloud, cloud.labels),
                                 (cloud.labels, cloud)):
            with self.assertRaisesRegex(pcednet.UsageError, "pipe; scores are of edge classes"):
                pcednet.evaluate(truth, predicted)

    def test_edge_classes_with_others_besides_have_lines(self):
        edges = [f"pcednet class {line}" for line in pcednet._core.class_lines([])]
        cloud = owned(6000, table=edges + ["pcednet class 4 #102030 pipe"])
        self.assertEqual(cloud.class_names[3:], ["boundary", "pipe"])
        cloud.labels[cloud.xyz[:, 2] == 0.5] = 4
        model = pcednet.train(cloud, epochs=5, scales=8)
        self.assertEqual(model.classes, [0, 1, 2, 4])
        result = model.classify(cloud)
        self.assertGreater(result.counts["pipe"], 0)
        self.assertEqual(np.isnan(result.confidence).sum(), result.counts["boundary"])
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.assertGreater(len(pcednet.lines(cloud, result)), 0)
        with self.assertRaisesRegex(pcednet.UsageError, "edges, pipe; scores"):
            pcednet.evaluate(cloud.labels, result)

    def test_different_classes_are_refused(self):
        other = owned(table=TABLE[:2] + ["pcednet class 2 #102030 rail"])
        for clouds in ([owned(), other], [owned(), owned(table=())],
                       [owned(), cube(1000)[0]]):
            with self.assertRaisesRegex(pcednet.InsufficientError,
                                        "its classes are .*, those of the first cloud ground"):
                pcednet.train(clouds, [np.zeros(len(cloud)) for cloud in clouds])
        cloud = owned()
        cloud.labels[3] = 3
        with self.assertRaisesRegex(pcednet.UsageError, "3 is no class: 0 ground, 1 wall, 2 pipe"):
            pcednet.train(cloud)
        with self.assertRaisesRegex(pcednet.UsageError, "there are ground, wall, pipe"):
            pcednet.train(cloud, {"sharp-edge": [1]})

    def test_one_class_alone_is_too_few(self):
        cloud = owned()
        cloud.labels[:] = 1
        with self.assertRaisesRegex(pcednet.InsufficientError, r"points are wall \(1\): two "):
            pcednet.train(cloud, epochs=1, scales=4)

    def test_a_model_of_them_learns_more(self):
        cloud = owned()
        painted = {"pipe": np.flatnonzero(cloud.labels == 2)[::2],
                   "ground": np.flatnonzero(cloud.labels == 0)[::9]}
        for points in (cloud, cloud.xyz):
            model = self.model.adapt(points, painted, normals=cloud.normals, name="more")
            self.assertEqual((model.name, model.class_names), ("more", NAMES))
            self.assertEqual(set(model.classify(cloud).labels.tolist()) - {0, 1, 2}, set())
        for points, start in ((cloud, "general"), (owned(table=()), self.model)):
            with self.assertRaisesRegex(pcednet.UsageError, "^start: the model knows the classes"):
                pcednet.train(points, start=start)

    def test_context_is_of_edge_classes(self):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            pcednet.train(owned(), epochs=2, scales=4, context=True)
        self.assertEqual([str(one.message) for one in caught],
                         ["no context network was trained: context is of edge classes"])
        done = run("train", self.path("in.ply"), "-o", self.path("c.safetensors"), "--epochs", 2,
                   "--scales", 4, "--context")
        said = [line for line in done.stderr.splitlines() if "context" in line]
        self.assertEqual(said, ["pcednet: warning: no context network was trained: context is of "
                                "edge classes"])


if __name__ == "__main__":
    unittest.main()
