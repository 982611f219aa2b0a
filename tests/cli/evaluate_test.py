"""pcednet evaluate: scores as JSON, of a model and of other tools' predictions."""
import json
import unittest

import numpy as np

from support import CliTest, cube, run, write_ply


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

    def test_tells_whether_probabilities_are_right(self):
        write_ply(self.folder / "a.ply", *cube(3000))
        done = run("evaluate", self.folder / "a.ply", "--model", "scan", "--positive", "edge",
                   "--calibration", "--json", "-")
        calibration = json.loads(done.stdout)["calibration"]
        self.assertEqual(sum(b["points"] for b in calibration["bins"]), 3000)
        self.assertLess(calibration["error"], 0.1)
        run("evaluate", self.folder / "a.ply", "--method", "ca", "--calibration", expect=2)

    def test_scores_a_model_and_writes_the_file(self):
        write_ply(self.folder / "a.ply", *cube(3000))
        run("evaluate", self.folder / "a.ply", "--model", "scan", "--positive", "edge", "--json",
            self.folder / "scores.json")
        report = json.loads((self.folder / "scores.json").read_text())
        self.assertGreater(report["median"]["mcc"], 0.7)

    def test_refuses_what_has_no_meaning(self):
        write_ply(self.folder / "a.ply", *cube(300))
        for extra in (("--no-context",), ("--exact",), ("--s-max", "1")):
            run("evaluate", self.folder / "a.ply", "--predictions", self.folder, *extra, expect=2)

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
