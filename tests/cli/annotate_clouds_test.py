#!/usr/bin/env python3
"""Several clouds in one project of `pcednet annotate`."""
import json
import os
import pathlib
import shutil
import unittest

import numpy as np

import support
from annotate_support import EDGE, FACE, POINTS, AnnotateTest, Server, brush
from support import read_ply, run, write_ply


class AnnotateClouds(AnnotateTest):
    """The cube, and a second one, larger and elsewhere, in a folder beside it."""

    def setUp(self):
        super().setUp()
        positions, normals, _ = support.cube(15000, seed=2)
        self.other = self.folder / "more" / "hall.ply"
        self.other.parent.mkdir()
        write_ply(self.other, 3 * positions + 100, normals)
        self.project = self.folder / "cube_annotation.json"

    def both(self, *options):
        self.servers.append(Server(self.cloud, str(self.other), *options))
        server = self.servers[-1]
        server.open()
        return server

    def quiet_both(self, *options):
        server = self.both("--model", "none", *options)
        server.post("/api/settings", {"auto": False})
        return server

    def paint_both(self, server):
        """An edge in one cloud, a face in the other."""
        first = server.post("/api/stroke", brush("edge", 2, EDGE, radius=0.05))
        second = server.post("/api/stroke", brush("face", 0, 3 * np.array(FACE), radius=0.45, cloud=1))
        return first, second

    def values(self, server, of, cloud):
        nodes = server.get(f"/api/session?cloud={cloud}")["nodes"]
        names = ",".join(str(node["id"]) for node in nodes)
        return np.frombuffer(
            server.request(f"/api/values?of={of}&nodes={names}&cloud={cloud}")[2], np.uint8)

    def test_tells_files_of_one_name_by_their_folders(self):
        same = self.other.with_name(self.cloud.name)
        shutil.copy(self.other, same)
        self.other = same
        session = self.quiet_both().get("/api/session")
        self.assertEqual([c["file"] for c in session["clouds"]], [f"{self.folder.name}/cube.ply", "more/cube.ply"])

    def test_shows_paints_and_takes_back_in_each(self):
        server = self.quiet_both()
        sessions = [server.get(f"/api/session?cloud={k}") for k in (0, 1)]
        self.assertEqual([s["file"] for s in sessions], ["cube.ply", "hall.ply"])
        self.assertEqual([s["points"] for s in sessions], [POINTS, 15000])
        self.assertGreater(sessions[1]["spacing"], 2 * sessions[0]["spacing"])
        self.assertEqual(server.request("/api/session?cloud=2")[0], 404)
        first, second = self.paint_both(server)
        self.assertEqual((first["cloud"], second["cloud"]), (0, 1))
        self.assertEqual(second["counts"], [second["changed"], 0, first["changed"]])
        self.assertEqual(second["painted"], [first["changed"], second["changed"]])
        painted = [c["painted"] for c in server.get("/api/session?cloud=1")["clouds"]]
        self.assertEqual(painted, [first["changed"], second["changed"]])
        for cloud, label, answer in ((0, 2, first), (1, 0, second)):
            labels = self.values(server, "labels", cloud)
            self.assertEqual(set(labels), {label, 255})
            self.assertEqual((labels == label).sum(), answer["changed"])
        undone = server.post("/api/undo")
        self.assertEqual((undone["cloud"], undone["undo"]), (1, 1))
        self.assertEqual(set(self.values(server, "labels", 1)), {255})
        server.post("/api/stroke", brush("x", 2, EDGE, cloud=2), expect=404)
        server.post("/api/stroke", brush("y", 2, EDGE, cloud=-1), expect=400)

    def test_trains_one_model_on_all_and_saves_each(self):
        server = self.quiet_both()
        server.post("/api/stroke", brush("edge", 2, EDGE, radius=0.05))
        server.post("/api/train", expect=409)  # sharp-edge alone
        server.post("/api/stroke", brush("face", 0, 3 * np.array(FACE), radius=0.45, cloud=1))
        self.train(server, 1)
        for cloud in (0, 1):
            found = self.values(server, "prediction", cloud)
            self.assertTrue(0.01 < (found == 2).mean() < 0.4, f"{(found == 2).mean()}")
        saved = [pathlib.Path(server.post("/api/save", {"what": "cloud", "cloud": k})["path"])
                 for k in (0, 1)]
        self.assertEqual(saved, [self.folder / "cube_annotated.ply",
                                 self.other.parent / "hall_annotated.ply"])
        model = pathlib.Path(server.post("/api/save", {"what": "model"})["path"])
        server.post("/api/save", {"what": "project"})
        server.post("/api/lines/find", {"cloud": 1})
        lines = server.until("/api/lines?cloud=1", lambda lines: lines["version"] == 1)
        self.assertEqual(lines["cloud"], 1)
        self.assertEqual(server.end()[0], 0)

        # The same model on the command line; it finds the same in each cloud.
        project = json.loads(self.project.read_text())
        self.assertEqual(project["format"], "pcednet-annotation-2")
        self.assertEqual([i["name"] for i in project["inputs"]], ["cube.ply", "more/hall.ply"])
        again = self.folder / "again.safetensors"
        for threads in (1, 2):
            run("train", "--project", self.project, "-o", again, "--overwrite", "--threads",
                        threads)
            self.assertEqual(again.read_bytes(), model.read_bytes())
        for cloud, file in zip((self.cloud, self.other), saved):
            out = self.folder / "out.ply"
            run("classify", cloud, "--model", again, "-o", out, "--overwrite")
            columns = [read_ply(f)[0]["scalar_edge_class"] for f in (out, file)]
            np.testing.assert_array_equal(*columns)

        # Moved elsewhere, the inputs are given.
        moved = self.folder / "moved.ply"
        shutil.copy(self.other, moved)
        shutil.rmtree(self.other.parent)
        run("train", "--project", self.project, self.cloud, moved, "-o", again, "--overwrite")
        self.assertEqual(again.read_bytes(), model.read_bytes())

    def test_keeps_the_lines_of_each(self):
        server = self.quiet_both()
        server.post("/api/lines/find", {"cloud": 2}, expect=404)
        self.paint_both(server)
        self.train(server, 1)
        for cloud in (0, 1):
            server.post("/api/lines/find", {"cloud": cloud})  # both, one after the other
        found = [server.until(f"/api/lines?cloud={k}",
                              lambda lines: lines["version"] == 1 and not lines["searching"])
                 for k in (0, 1)]
        self.assertTrue(all(f["lines"] for f in found))
        for cloud, decision in ((0, "accepted"), (1, "rejected")):
            server.post("/api/lines/decide", {"cloud": cloud, "version": 1, "decision": decision,
                                              "lines": [0]})
        for wrapped in ({"version": 2**32 + 1}, {"version": 1.5}, {"lines": [2**32]}, {"lines": [0.5]}, {"lines": 0}):
            decided = {"cloud": 0, "version": 1, "decision": "rejected", "lines": [0], **wrapped}
            self.assertIn(f"decide: {list(wrapped)[0]}", server.post("/api/lines/decide", decided, expect=400)["error"])
        server.post("/api/settings", {"classes": 2**32 + 2}, expect=400)
        self.assertEqual(server.request("/api/download/lines?cloud=1")[0], 409)
        for arcs in ("", "?dxf_arcs=all", "?format=dxf&dxf_arcs=flat", "?dxf_arcs=none"):
            self.assertEqual(server.request("/api/download/lines" + arcs)[0], 200)
        self.assertEqual(server.request("/api/download/lines?dxf_arcs=some")[0], 400)
        server.post("/api/lines/find", {"cloud": 1})
        again = server.until("/api/lines?cloud=1", lambda lines: lines["version"] == 2)
        self.assertEqual({line["decision"] for line in again["lines"]}, {"open"})
        first = server.get("/api/lines")
        self.assertEqual(first["version"], 1)
        self.assertEqual([line["decision"] for line in first["lines"]],
                         ["accepted"] + ["open"] * (len(first["lines"]) - 1))
        server.post("/api/lines/decide", {"cloud": 1, "version": 2, "decision": "accepted",
                                          "lines": [0]})
        path = pathlib.Path(server.post("/api/save", {"what": "lines", "cloud": 1})["path"])
        self.assertEqual(path, self.other.parent / "hall_lines.dxf")

    def test_survives_being_killed_and_opens_all_again_by_the_first(self):
        server = self.quiet_both()
        self.paint_both(server)
        before = [self.values(server, "labels", k) for k in (0, 1)]
        server.kill()
        server = self.serve()  # names the first alone
        server.open()
        self.assertEqual([c["file"] for c in server.get("/api/session")["clouds"]],
                         ["cube.ply", "hall.ply"])
        for cloud in (0, 1):
            np.testing.assert_array_equal(self.values(server, "labels", cloud), before[cloud])

    def test_a_cloud_may_join_later_and_earlier_runs_stay_as_they_were(self):
        server = self.quiet()
        self.paint_edge_and_face(server)
        self.train(server, 1)
        model = server.request("/api/download/model")[2]
        first_journal = (self.folder / "cube_annotation.json.journal").read_text()
        self.assertIn('"pcednet-annotation-1"', first_journal)
        server.kill()
        server = self.both()
        server.until("/api/session", lambda s: s["prediction_version"] > 0)
        self.assertEqual(server.request("/api/download/model")[2], model)
        self.assertGreater((self.values(server, "prediction", 1) == 2).sum(), 100)
        journal = (self.folder / "cube_annotation.json.journal").read_text()
        self.assertEqual(journal.splitlines()[1:], first_journal.splitlines()[1:])
        self.assertIn('"pcednet-annotation-2"', journal.splitlines()[0])
        server.post("/api/stroke", brush("more", 0, 3 * np.array(FACE), radius=0.3, cloud=1))
        self.train(server, 2)
        both = server.request("/api/download/model")[2]
        self.assertNotEqual(both, model)
        for run, wanted in ((1, model), (2, both)):
            server.post(f"/api/runs/{run}/restore")
            server.until("/api/runs", lambda runs: [r["run"] for r in runs if r["current"]] == [run])
            self.assertEqual(server.request("/api/download/model")[2], wanted)

    def test_a_cloud_that_is_missing_is_named_with_its_project(self):
        server = self.quiet_both()
        painted = [a["changed"] for a in self.paint_both(server)]
        server.post("/api/save", {"what": "project"})
        server.end()
        moved = self.folder / "moved.ply"
        self.other.rename(moved)
        said = run("annotate", self.cloud, "--no-browser", expect=3).stderr
        self.assertIn(f"{self.project}: cloud 2 of 2, {self.other}, is missing", said)
        self.assertIn("name all clouds in their order", said)
        self.other = moved
        server = self.both()  # as it says
        self.assertEqual([c["painted"] for c in server.get("/api/session")["clouds"]], painted)
        server.end()
        server = self.serve()  # which is not asked again
        server.open()
        self.assertEqual([(c["file"], c["painted"]) for c in server.get("/api/session")["clouds"]],
                         [("cube.ply", painted[0]), ("moved.ply", painted[1])])
        server.end()
        run("train", "--project", self.project, "-o", self.folder / "m.safetensors")  # nor this
        self.assertEqual(json.loads(self.project.read_text())["inputs"][1]["name"], "moved.ply")

    def test_a_cloud_that_changed_or_is_missing_is_named_with_what_to_do(self):
        server = self.quiet_both()
        self.paint_both(server)
        server.post("/api/save", {"what": "project"})
        server.end()
        kept = [path.read_bytes() for path in sorted(self.folder.glob("cube_annotation.json*"))]
        repeat = ("train", "--project", self.project, "-o", self.folder / "m.safetensors")
        sound = self.other.read_bytes()
        self.other.write_bytes(sound[:-27] + bytes(27))
        said = run("annotate", self.cloud, "--no-browser", expect=4).stderr
        self.assertIn(f"{self.project}: cloud 2 of 2, more/hall.ply, is another input now: put back", said)
        self.assertIn("start afresh with --project FILE", said)
        self.assertIn(f"{self.other}: not the file that the project is about: put back the one that was "
                      "painted, or name its place", run(*repeat, expect=4).stderr)
        self.other.unlink()
        for command in (repeat, (*repeat, self.cloud)):
            self.assertIn(f"{self.project}: cloud 2 of 2, {self.other}, is missing: put it back, or name all "
                          "clouds in their order", run(*command, expect=3).stderr)
        self.other.write_bytes(sound)
        self.cloud.rename(self.folder / "elsewhere.ply")
        self.assertIn(f"cloud 1 of 2, {self.cloud}, is missing", run(*repeat, expect=3).stderr)
        self.assertEqual([path.read_bytes() for path in sorted(self.folder.glob("cube_annotation.json*"))], kept)
        run(*repeat, self.folder / "elsewhere.ply", self.other)  # as it says

    def test_names_that_are_not_utf8(self):
        def odd(path, name):
            path.rename(path.with_name(os.fsdecode(name)))
            return path.with_name(os.fsdecode(name))
        self.cloud, self.other = odd(self.cloud, b"c\xfcbe.ply"), odd(self.other, b"h\xe4ll.ply")
        start = self.folder / os.fsdecode(b"m\xfcne.safetensors")
        shutil.copy(support.SOURCE / "models" / "scan.safetensors", start)
        server = self.both("--model", str(start))
        session = server.get("/api/session")
        self.assertEqual([c["file"] for c in session["clouds"]], ["c\ufffdbe.ply", "h\ufffdll.ply"])
        self.assertEqual(session["settings"]["start"], "m\ufffdne.safetensors")
        server.post("/api/settings", {"auto": False, "start": session["settings"]["start"]})
        server.until("/api/runs", lambda r: len(r) == 1)  # the labels of the start
        painted = [a["changed"] for a in self.paint_both(server)]
        self.train(server, 2)
        for what in ("project", "cloud", "model"):
            server.post("/api/save", {"what": what, "cloud": int(what == "cloud")})
            self.assertEqual(server.request(f"/api/download/{what}")[0], 200)
        self.assertEqual(server.end()[0], 0)
        names = set(os.listdir(os.fsencode(self.folder))) | set(os.listdir(os.fsencode(self.other.parent)))
        self.assertLessEqual({b"c\xfcbe_annotation.json", b"c\xfcbe.safetensors", b"h\xe4ll_annotated.ply"}, names)
        server = self.serve()  # names the first alone
        server.open()
        session = server.get("/api/session")
        self.assertEqual([c["painted"] for c in session["clouds"]], painted)
        model = self.folder / os.fsdecode(b"c\xfcbe.safetensors")
        again = self.folder / "again.safetensors"
        run("train", "--project", self.folder / os.fsdecode(b"c\xfcbe_annotation.json"), "-o", again)
        self.assertEqual(again.read_bytes(), model.read_bytes())

    def test_refuses_inputs_that_cannot_be_told_apart(self):
        twin = self.folder / "cube.pcd"
        run("convert", self.cloud, "-o", twin)
        for more in (self.cloud, twin):
            done = run("annotate", self.cloud, more, "--no-browser", expect=2)
            self.assertIn("would be saved under one name", done.stderr)


if __name__ == "__main__":
    unittest.main()
