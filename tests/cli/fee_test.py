"""pcednet evaluate --method fee, which needs pcednet-fee, which needs CGAL."""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import unittest

import numpy as np

from support import PROGRAM, CliTest, cube, run, write_ply

HAS_FEE = (pathlib.Path(PROGRAM).parent / "pcednet-fee").exists() or shutil.which("pcednet-fee")


class Fee(CliTest):
    def setUp(self):
        super().setUp()
        self.position, normal, label = cube(4000)
        write_ply(self.folder / "a.ply", self.position, normal, label)

    def scores(self, *arguments):
        done = run("evaluate", self.folder / "a.ply", "--method", "fee", *arguments, "--json", "-")
        return json.loads(done.stdout)["pooled"]

    def test_agrees_with_its_definition_far_from_edges(self):
        size = np.ptp(self.position, axis=0).max()
        radii = ("--offset-radius", size * 0.1, "--convolution-radius", size * 0.05)
        self.assertGreater(self.scores(*radii, "--positive", "edge")["mcc"], 0.3)
        nothing = self.scores(*radii, "--threshold", "0.5")
        self.assertEqual(nothing["tp"] + nothing["fp"], 0)

    def test_a_study_keeps_results_by_threshold(self):
        size = np.ptp(self.position, axis=0).max()

        def found(threshold):
            run("study", "methods", "--methods", "fee", "--test", f"a={self.folder / 'a.ply'}", "--train",
                self.folder / "a.ply", "-o", self.folder / "out", "--overwrite",
                "--fee", f"a={size * 0.1},{size * 0.05}{threshold}")
            study = json.loads((self.folder / "out/methods.json").read_text())
            return sum(cloud["tp"] + cloud["fp"] for result in study["results"] for cloud in result["clouds"])

        self.assertGreater(found(",0.16"), 0)
        self.assertEqual(found(",0.5"), 0)
        self.assertGreater(found(""), 0)

    def test_radii_of_a_study_are_numbers_to_their_end(self):
        for bad in ("a=0.1,0.2junk", "a=0.1", "a=0.1,0.2,0.3,0.4", "a=nan,0.2"):
            said = run("study", "classes", "--test", f"a={self.folder / 'a.ply'}", "--train", self.folder / "a.ply",
                       "-o", self.folder / "out", "--fee", bad, expect=2).stderr
            self.assertIn("give SET=R,r", said)

    def test_says_what_is_missing(self):
        alone = self.folder / "pcednet"  # pcednet-fee is looked for beside it
        shutil.copy(PROGRAM, alone)
        done = subprocess.run([alone, "evaluate", self.folder / "a.ply", "--method", "fee"],
                              capture_output=True, text=True, env=os.environ | {"PATH": ""})
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertIn("CGAL", done.stderr)


if __name__ == "__main__":
    if not HAS_FEE:
        print("skipped: pcednet-fee was not built")
        sys.exit(77)
    unittest.main()
