"""Methods without a model: covariance analysis, multi-scale surface variation."""
import json
import unittest

from support import CliTest, cube, run, write_ply


class Methods(CliTest):
    def setUp(self):
        super().setUp()
        write_ply(self.folder / "a.ply", *cube(4000))

    def scores(self, *arguments):
        done = run("evaluate", self.folder / "a.ply", *arguments, "--json", "-")
        return json.loads(done.stdout)["pooled"]

    def test_find_the_edges_of_a_cube(self):
        for method, least in (("ca", 0.3), ("multi-scale", 0.3)):
            self.assertGreater(self.scores("--method", method, "--positive", "edge")["mcc"], least)

    def test_thresholds_work_one_way(self):
        found = [self.scores("--method", "ca", "--threshold", t) for t in ("0.1", "1", "1000")]
        marked = [f["tp"] + f["fp"] for f in found]
        self.assertGreater(marked[0], marked[1])
        self.assertGreater(marked[1], marked[2])
        self.assertEqual(marked[2], 0)

    def test_refuse_options_of_others(self):
        for arguments in (("--method", "multi-scale", "--neighbours", "5"),
                          ("--method", "ca", "--offset-radius", "1"),
                          ("--method", "ca", "--neighbours", "3"),
                          ("--method", "ca", "--model", "scan")):
            run("evaluate", self.folder / "a.ply", *arguments, expect=2)

    def test_classify_without_a_model(self):
        done = run("classify", self.folder / "a.ply", "--method", "ca")
        self.assertIn("4000 points:", done.stderr)
        self.assertNotIn("scales:", done.stderr)
        again = json.loads(run("evaluate", self.folder / "a.ply", "--predictions", self.folder,
                               "--json", "-").stdout)
        self.assertEqual(again["clouds"][0]["points"], 4000)
        self.assertLess(again["clouds"][0]["mcc"], 1.0)  # of a_edges.ply, not of a.ply itself
        alone = run("evaluate", self.folder, "--method", "ca", "--json", "-")
        self.assertEqual(json.loads(alone.stdout), again)
        self.assertIn("1 file left out: it is the result", alone.stderr)


if __name__ == "__main__":
    unittest.main()
