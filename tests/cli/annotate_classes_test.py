#!/usr/bin/env python3
"""Own classes in `pcednet annotate`, and what the other commands make of them."""
import json
import pathlib
import unittest

import numpy as np

import support
from annotate_support import EDGE, FACE, AnnotateTest, Server, brush
from support import read_ply, run, write_ply

NAMES = "ground=#112233, wall, pipe rail"


class AnnotateClasses(AnnotateTest):
    """The cube, whose edges are the class `pipe rail` here and whose faces `ground`."""

    def own(self, *options, classes=NAMES):
        self.servers.append(Server(self.cloud, "--classes", classes, *options))
        server = self.servers[-1]
        session = server.open()
        return server, session

    def paint(self, server):
        server.post("/api/stroke", brush("edge", 2, EDGE, radius=0.05))
        return server.post("/api/stroke", brush("face", 0, FACE, radius=0.15))

    def trained(self, server):
        server.post("/api/settings", {"auto": False})
        painted = self.paint(server)
        self.train(server, 1)
        return painted

    def test_paints_trains_and_saves_them(self):
        server, session = self.own()
        self.assertFalse(session["edges"])
        self.assertEqual([c["name"] for c in session["classes"]], ["ground", "wall", "pipe rail"])
        self.assertEqual(session["classes"][0]["colour"], [0x11, 0x22, 0x33])
        self.assertEqual(session["starts"], [])
        self.assertEqual(session["settings"]["start"], "random")
        server.post("/api/stroke", brush("none", 3, EDGE), expect=400)
        server.post("/api/settings", {"start": "general"}, expect=400)
        painted = self.trained(server)
        self.assertEqual(len(painted["counts"]), 3)
        server.post("/api/lines/find", {}, expect=409)
        place = server.get("/api/uncertain")
        self.assertIn(place["prediction"], (0, 2))
        cloud = pathlib.Path(server.post("/api/save", {"what": "cloud"})["path"])
        model = pathlib.Path(server.post("/api/save", {"what": "model"})["path"])
        server.post("/api/save", {"what": "project"})
        self.assertEqual(server.end()[0], 0)

        rows, header = read_ply(cloud)[:2]
        self.assertEqual(int((rows["scalar_painted_label"] == 2).sum()), painted["counts"][2])
        self.assertEqual(set(rows["label"]), {0, 2})
        self.assertNotIn("scalar_edge_class", rows.dtype.names)
        self.assertTrue(0.02 < (rows["label"] == 2).mean() < 0.5)
        info = run("info", cloud).stdout
        self.assertIn("pipe rail (2)", info)
        self.assertIn("pcednet class 0 #112233 ground", info)
        of_model = run("info", model).stdout
        self.assertIn("pipe rail", of_model)
        self.assertIn("#112233", of_model)

        # The same model on the command line, which finds the same.
        again = self.folder / "again.safetensors"
        run("train", "--project", self.folder / "cube_annotation.json", "-o", again)
        self.assertEqual(again.read_bytes(), model.read_bytes())
        out = self.folder / "out.ply"
        done = run("classify", self.cloud, "--model", again, "-o", out, "--preview",
                   self.folder / "out.png")
        self.assertIn("pipe rail", done.stderr + done.stdout)
        np.testing.assert_array_equal(read_ply(out)[0]["scalar_class"], rows["scalar_class"])
        las = self.folder / "out.las"
        run("classify", self.cloud, "--model", again, "-o", las, "--las-classification", "2=13")
        self.assertIn("pcednet class 2", run("info", las).stdout)

        # Scored class by class; neither lines nor tiles are for it.
        table = run("evaluate", out, "--model", again).stdout
        self.assertIn("pipe rail", table)
        self.assertIn("accuracy 1.000", table)
        scores = json.loads(run("evaluate", out, "--model", again, "--json", "-").stdout)
        self.assertEqual([c["name"] for c in scores["classes"]], ["ground", "wall", "pipe rail"])
        for command in (["lines", out], ["lines", self.cloud, "--model", again]):
            done = run(*command, "-o", self.folder / "x.dxf", expect=2)
            self.assertIn("lines are of edge classes", done.stderr)
        done = run("tiles", "plan", self.cloud, "--model", again, "-o", self.folder / "plan.json",
                   expect=2)
        self.assertIn("own classes", done.stderr)

        # A labelled cloud says which classes it has: `train` makes a model of these.
        run("train", out, "-o", self.folder / "third.safetensors", "--epochs", "2")
        self.assertIn("pipe rail", run("info", self.folder / "third.safetensors").stdout)

    def test_keeps_them_and_changes_them_as_far_as_strokes_allow(self):
        server, _ = self.own()
        self.trained(server)
        wanted = [{"name": "soil", "colour": "#010203"}, {"name": "wall", "colour": "#000000"},
                  {"name": "rail", "colour": "#ff0000"}, {"name": "tree", "colour": "#00ff00"}]
        changed = server.post("/api/classes", {"classes": wanted})
        self.assertEqual([c["name"] for c in changed["classes"]], ["soil", "wall", "rail", "tree"])
        self.assertEqual(changed["classes"][0]["colour"], [1, 2, 3])
        self.assertGreater(changed["classes"][2]["count"], 0)
        gone = [{**c, "removed": True} if c["name"] == "rail" else c for c in wanted]
        server.post("/api/classes", {"classes": gone}, expect=400)  # it is painted
        gone = [{**c, "removed": True} if c["name"] == "wall" else c for c in wanted]
        server.post("/api/classes", {"classes": gone})
        server.post("/api/stroke", brush("gone", 1, FACE), expect=400)
        server.post("/api/classes", {"classes": wanted[:2]}, expect=400)
        server.post("/api/classes", {"classes": [{"name": "a", "colour": "red"}]}, expect=400)
        server.kill()

        # All is there again, with the names of now; the run is not trained once more.
        server = self.serve()
        session = server.open()
        self.assertEqual([c["name"] for c in session["classes"]], ["soil", "wall", "rail", "tree"])
        self.assertTrue(session["classes"][1]["removed"])
        server.until("/api/session", lambda s: s["prediction_version"] > 0)
        self.assertEqual([r["run"] for r in server.get("/api/runs")], [1])
        model = self.folder / "model.safetensors"
        model.write_bytes(server.request("/api/download/model")[2])
        self.assertIn("soil", run("info", model).stdout)
        server.end()
        done = run("annotate", self.cloud, "--no-browser", "--classes", "a,b", expect=2)
        self.assertIn("after the first stroke", done.stderr)

    def test_take_the_place_of_edges_in_the_page_and_back(self):
        self.servers.append(Server(self.cloud))
        server = self.servers[-1]
        server.open()
        server.until("/api/runs", lambda runs: len(runs) > 0)
        own = [{"name": "a", "colour": "#010203"}, {"name": "b", "colour": "#040506"}]
        self.assertFalse(server.post("/api/classes", {"classes": own})["edges"])
        server.until("/api/runs", lambda runs: runs == [])
        self.assertEqual(server.get("/api/session")["settings"]["start"], "random")
        edges = [{"name": name, "colour": colour} for name, colour in (
            ("non-edge", "#ffffff"), ("smooth-edge", "#ffc45d"), ("sharp-edge", "#a80000"),
            ("boundary", "#0052a5"))]
        self.assertTrue(server.post("/api/classes", {"classes": edges})["edges"])
        server.until("/api/runs", lambda runs: len(runs) == 1)
        self.assertEqual(server.get("/api/session")["settings"]["start"], "general")

    def test_follow_those_of_edges_and_begin_with_the_default_model(self):
        listed = self.folder / "classes.txt"
        listed.write_bytes(b"\xef\xbb\xbfedges\r\nhandle=#00aaff\r\n")  # as Windows writes it
        server, session = self.own("--model", "scan", classes=str(listed))
        self.assertTrue(session["edges"])
        self.assertEqual(session["classes"][4]["name"], "handle")
        self.assertIn("general", session["starts"])
        server.until("/api/runs", lambda runs: len(runs) > 0)
        server.post("/api/stroke", brush("boundary", 3, FACE), expect=400)
        server.post("/api/settings", {"auto": False})
        server.post("/api/stroke", brush("face", 4, FACE, radius=0.15))
        self.train(server, 2)
        found = self.values(server, "prediction")
        self.assertGreater((found == 4).sum(), 200)
        self.assertGreater((found == 2).sum(), 200)
        server.post("/api/lines/find", {})
        server.until("/api/lines", lambda lines: lines["version"] == 1)
        server.post("/api/save", {"what": "project"})
        model = server.request("/api/download/model")[2]
        server.end()
        again = self.folder / "again.safetensors"
        run("train", "--project", self.folder / "cube_annotation.json", "-o", again)
        self.assertEqual(again.read_bytes(), model)

    def test_of_a_model_are_those_of_a_new_project(self):
        server, _ = self.own()
        self.trained(server)
        model = self.folder / "mine.safetensors"
        model.write_bytes(server.request("/api/download/model")[2])
        server.end()
        positions, normals, _ = support.cube(8000, seed=3)
        other = self.folder / "other.ply"
        write_ply(other, positions, normals)
        self.servers.append(Server(other, "--model", str(model)))
        server = self.servers[-1]
        session = server.open()
        self.assertEqual([c["name"] for c in session["classes"]], ["ground", "wall", "pipe rail"])
        server.until("/api/runs", lambda runs: len(runs) > 0)  # what the model finds
        server.post("/api/settings", {"auto": False})
        corners = [(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]
        server.post("/api/stroke", brush("wall", 1, corners, radius=0.06))
        self.train(server, 2)
        found = self.values(server, "prediction")
        self.assertTrue({0, 1, 2} <= set(found), set(found))

    def test_that_make_no_sense_are_refused(self):
        for wrong in ("a", "a,a", "a,b=blue", "1,2,3,4,5,6,7,8,9"):
            done = run("annotate", self.cloud, "--no-browser", "--classes", wrong, expect=2)
            self.assertIn("classes:", done.stderr)
        done = run("annotate", self.cloud, "--no-browser", "--classes", "a,b", "--model", "scan",
                   expect=2)
        self.assertIn("cannot be the start for a, b", done.stderr)

    def values(self, server, of):
        names = ",".join(str(node["id"]) for node in server.get("/api/session")["nodes"])
        return np.frombuffer(server.request(f"/api/values?of={of}&nodes={names}")[2], np.uint8)


if __name__ == "__main__":
    unittest.main()
