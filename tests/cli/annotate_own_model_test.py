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
