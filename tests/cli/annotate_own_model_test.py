"""Projects that start from a model of the user's own."""
import os
import shutil
import unittest

from annotate_support import EDGE, FACE, AnnotateTest, brush
from support import SOURCE, run


class AnnotateOwnModel(AnnotateTest):
    def setUp(self):
        super().setUp()
        self.model = self.folder / "m" / "mine.safetensors"
        self.model.parent.mkdir()
        shutil.copy(SOURCE / "models/scan.safetensors", self.model)
        self.project = self.folder / "cube_annotation.json"
        self.journal = self.folder / "cube_annotation.json.journal"

    def adapted(self, *options):
        """An annotator whose run of one stroke is shown."""
        server = self.serve(*options)
        server.open()
        server.post("/api/stroke", brush("edge", 2, EDGE, radius=0.05))
        server.until("/api/runs", lambda runs: any(r["run"] == 1 and r["current"] for r in runs))
        return server

    def test_counts_as_the_same_however_it_is_named(self):
        server = self.adapted("--model", str(self.model))
        self.assertEqual(server.get("/api/session")["settings"]["start"], "m/mine.safetensors")
        model = server.request("/api/download/model")[2]
        server.end()
        records = self.journal.read_bytes()
        for options in ((), ("--model", str(self.model.parent / ".." / "m" / self.model.name)),
                        ("--model", os.path.relpath(self.model))):
            server = self.serve(*options)
            server.open()
            server.until("/api/session", lambda s: s["prediction_version"] > 0)
            self.assertEqual(server.request("/api/download/model")[2], model)
            self.assertIn("m/mine.safetensors", server.get("/api/session")["starts"])
            server.post("/api/save", {"what": "project", "overwrite": True})
            server.end()
            self.assertEqual(self.journal.read_bytes(), records)
        again = self.folder / "again.safetensors"
        run("train", "--project", self.project, "-o", again)
        self.assertEqual(again.read_bytes(), model)

    def test_is_never_overwritten_by_what_is_learnt_from_it(self):
        start = self.folder / "cube.safetensors"  # as a model of the cube would be named
        shutil.copy(self.model, start)
        before = start.read_bytes()
        server = self.adapted("--model", str(start))
        told = server.post("/api/save", {"what": "model", "name": start.name, "overwrite": True},
                           expect=400)["error"]
        self.assertIn("cube.safetensors itself is never overwritten", told)
        saved = server.post("/api/save", {"what": "model"})["path"]
        self.assertEqual(saved, str(self.folder / "cube_2.safetensors"))
        # Nor by a later training, once another start was chosen.
        server.post("/api/settings", {"start": "cad", "auto": False})
        self.assertEqual(server.post("/api/save", {"what": "model", "overwrite": True})["path"], saved)
        server.post("/api/save", {"what": "project"})
        server.end()
        run("train", "--project", self.project, "-o", start, "--overwrite", expect=2)
        self.assertEqual(start.read_bytes(), before)

    def test_that_changed_is_told_when_a_run_is_repeated(self):
        server = self.adapted("--model", str(self.model))
        server.post("/api/save", {"what": "project"})
        server.end()
        again = self.folder / "again.safetensors"
        words = "run 1 cannot be reproduced exactly"
        self.assertNotIn(words, run("train", "--project", self.project, "-o", again).stderr)
        shutil.copy(again, self.model)
        said = run("train", "--project", self.project, "-o", self.folder / "other.safetensors").stderr
        self.assertIn(words, said)

    def test_that_is_missing_is_named_with_its_project(self):
        self.adapted("--model", str(self.model)).post("/api/save", {"what": "project"})
        self.servers[-1].end()
        self.model.unlink()
        for command in (("annotate", self.cloud, "--no-browser"),
                        ("train", "--project", self.project, "-o", self.folder / "x.safetensors")):
            said = run(*command, expect=3).stderr
            self.assertIn(f"{self.project}: its start, the model {self.model}, is missing", said)


if __name__ == "__main__":
    unittest.main()
