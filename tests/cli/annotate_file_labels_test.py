"""The labels and the classes of LAS that a cloud comes with."""
import unittest

import numpy as np

from annotate_support import AnnotateTest, brush, FACE
from support import cube, write_ply


class AnnotateFileLabels(AnnotateTest):
    def setUp(self):
        super().setUp()
        _, normals, _ = cube(len(self.positions))
        self.labels = np.where(np.abs(self.positions).min(axis=1) > 0.4, 2, 0).astype(np.uint8)
        self.labels[:50] = 255
        self.labels[50:60] = 7  # none of the project's
        self.codes = np.where(self.positions[:, 2] > 0, 6, 2)
        write_ply(self.cloud, self.positions, normals, self.labels, scalar_Classification=self.codes)

    def values(self, server, of):
        nodes = server.get("/api/session")["nodes"]
        names = ",".join(str(node["id"]) for node in nodes)
        return np.frombuffer(server.request(f"/api/values?of={of}&nodes={names}")[2], np.uint8)

    def test_are_named_counted_and_a_byte_a_point(self):
        server = self.quiet()
        session = server.get("/api/session")
        self.assertFalse(session["file_predicted"])
        for of, given in (("file_labels", self.labels), ("las_classes", self.codes)):
            values = self.values(server, of)
            self.assertEqual(len(values), len(self.positions))
            self.assertEqual({each["id"]: each["points"] for each in session[of]},
                             {id: int((given == id).sum()) for id in np.unique(given) if id != 255})
            np.testing.assert_array_equal(np.bincount(values, minlength=256),
                                          np.bincount(given, minlength=256))
        self.assertEqual([each["name"] for each in session["file_labels"]],
                         ["non-edge", "sharp-edge", "class 7"])
        self.assertEqual([each["name"] for each in session["las_classes"]], ["2 ground", "6 building"])
        self.assertEqual(session["las_classes"][0]["colour"], [166, 118, 66])

    def test_can_be_painted(self):
        server = self.quiet()
        painted = server.post("/api/stroke", brush("mine", 2, FACE, radius=0.15))["counts"][2]
        take = {"tool": "file", "protect": True, "hidden": [], "clip": None}
        sharp = server.post("/api/stroke", {"id": "s", "class": 2, **take})
        self.assertEqual(sharp["counts"][2], painted + (self.labels == 2).sum())
        half = {"min": [-9, -9, -9], "max": [0, 9, 9]}
        flat = server.post("/api/stroke", {"id": "f", "class": 0, **take, "clip": half})
        self.assertLess(flat["counts"][0], 0.7 * (self.labels == 0).sum())
        self.assertGreater(flat["counts"][0], 0.3 * (self.labels == 0).sum())
        flat = server.post("/api/stroke", {"id": "g", "class": 0, **take})
        self.assertEqual(sum(flat["counts"]), painted + np.isin(self.labels, (0, 2)).sum()
                         - self.painted_of_file(server, painted))
        before = server.labels()[1]
        server.kill()
        server = self.serve()
        server.open()
        np.testing.assert_array_equal(server.labels()[1], before)
        self.assertEqual(server.post("/api/undo")["undo"], 3)

    def painted_of_file(self, server, painted):
        """Of the points painted by hand, those that the file labels: every one but few."""
        at = [np.linalg.norm(self.positions - place, axis=1) < 0.15 for place in FACE]
        near = np.any(at, axis=0) & (self.positions[:, 0] > 0.49)
        self.assertEqual(near.sum(), painted)
        return (near & (self.labels < 7)).sum()

    def test_refuses_those_that_are_not_the_projects(self):
        server = self.quiet()
        take = {"id": "a", "tool": "file", "protect": True, "hidden": [], "clip": None}
        for other in (1, 3, 7, 255):
            server.post("/api/stroke", {**take, "class": other}, expect=400)
        self.assertEqual(server.request("/api/values?of=las&nodes=0")[0], 400)

    def test_predictions_of_pcednet_are_seen_but_not_painted(self):
        _, normals, _ = cube(len(self.positions))
        labels = self.labels.clip(0, 2)
        write_ply(self.cloud, self.positions, normals, labels, scalar_edge_class=labels,
                  scalar_p_sharp=labels / 2, scalar_p_smooth=0 * labels)
        server = self.quiet()
        session = server.get("/api/session")
        self.assertTrue(session["file_predicted"])
        self.assertEqual([each["id"] for each in session["file_labels"]], [0, 2])
        self.assertEqual(len(self.values(server, "file_labels")), len(self.positions))
        server.post("/api/stroke", {"id": "a", "tool": "file", "class": 2, "protect": True,
                                    "hidden": [], "clip": None}, expect=400)

    def test_a_cloud_without_has_none(self):
        _, normals, _ = cube(len(self.positions))
        write_ply(self.cloud, self.positions, normals)
        server = self.quiet()
        session = server.get("/api/session")
        self.assertEqual([session["file_labels"], session["las_classes"]], [[], []])
        for of in ("file_labels", "las_classes", "errors"):
            self.assertEqual(server.request(f"/api/values?of={of}&nodes=0")[0], 404)


if __name__ == "__main__":
    unittest.main()
