"""What is painted, trained and saved, and what survives."""
import http.client
import json
import pathlib
import threading
import time
import unittest

import numpy as np

from annotate_support import AnnotateTest, Drip, EDGE, FACE, POINTS, Server, brush
from support import read_ply, run, sheet, write_ply


class AnnotateSession(AnnotateTest):
    def test_paints_the_points_of_the_brush_and_takes_them_back(self):
        server = self.quiet()
        session = server.get("/api/session")
        self.assertEqual(sum(n["points"] for n in session["nodes"]), POINTS)
        centre = np.array([0.5, 0.1, 0.1]) - session["origin"]
        answer = server.post("/api/stroke", brush("a", 1, [centre]))
        near = np.linalg.norm(self.positions - [0.5, 0.1, 0.1], axis=1) < 0.1
        self.assertEqual(answer["changed"], near.sum())
        self.assertEqual(answer["counts"], [0, near.sum(), 0])
        places, labels = server.labels()
        np.testing.assert_array_equal(
            labels == 1, np.linalg.norm(places - centre, axis=1) < 0.1)
        # The same stroke again changes nothing; undo and redo do.
        self.assertEqual(server.post("/api/stroke", brush("a", 1, [centre])), answer)
        self.assertEqual(server.post("/api/undo")["counts"], [0, 0, 0])
        self.assertEqual(server.post("/api/redo")["counts"], [0, near.sum(), 0])
        protected = server.post("/api/stroke", brush("b", 2, [centre], radius=0.15, protect=True))
        self.assertEqual(protected["counts"][1], near.sum())
        self.assertGreater(protected["counts"][2], 0)

    def test_loses_no_stroke_of_several_at_once(self):
        server = self.quiet()
        random = np.random.default_rng(3)
        centres = random.uniform(-0.5, 0.5, (40, 3))
        centres[:, 0] = 0.5
        ids = iter(range(1000))
        threads = [threading.Thread(target=lambda part=part: [
            server.post("/api/stroke", brush(f"s{next(ids)}", 2, [c], radius=0.05)) for c in part])
            for part in np.split(centres, 8)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        near = (np.linalg.norm(self.positions[:, None] - centres[None], axis=2) < 0.05)
        facing = self.positions[:, 0] > 0  # none of the balls reaches the other side
        self.assertEqual(server.get("/api/session")["classes"][2]["count"],
                         (near.any(axis=1) & facing).sum())

    def test_survives_being_killed(self):
        server = self.quiet()
        server.post("/api/stroke", brush("edge", 2, EDGE))
        server.post("/api/stroke", brush("gone", 1, FACE))
        server.post("/api/undo")
        server.post("/api/stroke", brush("face", 0, FACE))
        before = server.labels()[1]
        server.kill()
        with open(self.folder / "cube_annotation.json.journal", "ab") as journal:
            journal.write(b'{"stroke":"half","cla')
        server = self.serve()
        session = server.open()
        self.assertEqual(session["settings"]["auto"], False)
        np.testing.assert_array_equal(server.labels()[1], before)
        self.assertEqual(server.post("/api/stroke", brush("edge", 2, EDGE))["undo"], 2)
        self.assertEqual(server.post("/api/undo")["counts"][0], 0)

    def test_a_cloud_of_no_painted_points_lacks_no_stroke(self):
        server = self.serve("--model", "scan")
        server.open()
        server.post("/api/settings", {"auto": False})
        server.until("/api/runs", lambda runs: len(runs) == 1)
        save = {"what": "cloud", "overwrite": True}
        server.post("/api/stroke", brush("a", 2, EDGE))
        self.assertEqual(server.post("/api/save", save)["strokes_left_out"], 1)
        server.post("/api/stroke", brush("b", 255, EDGE))
        self.assertEqual(server.post("/api/save", save)["strokes_left_out"], 0)

    def test_refuses_a_journal_of_another_cloud(self):
        server = self.quiet()
        server.post("/api/stroke", brush("a", 2, EDGE))
        self.assertEqual(server.end()[0], 0)
        write_ply(self.cloud, self.positions[:-1000])
        done = run("annotate", self.cloud, "--no-browser", expect=4)
        self.assertIn("another input", done.stderr)

    def test_trains_and_the_command_line_makes_the_same_model(self):
        server = self.quiet()
        server.post("/api/train", expect=409)
        self.paint_edge_and_face(server)
        runs = self.train(server, 1)
        self.assertTrue(runs[0]["current"])
        runs = server.until("/api/runs", lambda r: r[0]["held_out"])
        self.assertEqual(runs[0]["held_out"], {"strokes": 2, "accuracy": None, "start": None})
        done = run("train", "--project", self.folder / "cube_annotation.json", "-o", self.folder / "m.safetensors", expect=3)
        self.assertIn("cube_annotation.json: the project is not saved yet: Save project", done.stderr)
        # What is painted after the run does not belong to its model.
        server.post("/api/stroke", brush("more", 1, [(0.5, 0.4, 0.4)], radius=0.1))
        for what in ("model", "project", "cloud"):
            saved = server.post("/api/save", {"what": what})
            self.assertEqual(saved["strokes_left_out"], 0 if what == "project" else 1)
            server.post("/api/save", {"what": what}, expect=409)
            server.post("/api/save", {"what": what, "overwrite": True})
            self.assertEqual(server.request(f"/api/download/{what}")[2],
                             pathlib.Path(saved["path"]).read_bytes())
        self.assertEqual(server.post("/api/save", {"what": "cloud", "name": 7}, expect=400)["error"],
                         "save: type must be string, but is number")
        server.post("/api/save", {"what": "cloud", "name": "../x.ply"}, expect=400)
        server.post("/api/save", {"what": "cloud", "name": "cube.ply", "overwrite": True}, expect=400)
        model = (self.folder / "cube.safetensors").read_bytes()
        for threads in (1, 2, 8):
            again = self.folder / f"again{threads}.safetensors"
            run("train", "--project", self.folder / "cube_annotation.json", "-o", again,
                "--threads", threads)
            self.assertEqual(again.read_bytes(), model)
        rows, _ = read_ply(self.folder / "cube_annotated.ply")
        run("classify", self.cloud, "-o", self.folder / "by_model.ply",
            "--model", self.folder / "cube.safetensors")
        other, _ = read_ply(self.folder / "by_model.ply")
        for field in ("scalar_edge_class", "scalar_p_sharp", "scalar_p_smooth", "quality", "label"):
            np.testing.assert_array_equal(rows[field], other[field])
        counts = [c["count"] for c in server.get("/api/session")["classes"]]
        self.assertEqual([int((rows["scalar_painted_label"] == c).sum()) for c in range(3)], counts)
        place = server.get("/api/uncertain?after=0")
        self.assertEqual(place["rank"], 1)

    def test_trains_by_itself_and_restores_an_earlier_run(self):
        server = self.serve()
        server.open()
        self.paint_edge_and_face(server)
        server.until("/api/runs", lambda r: len(r) == 1)
        first = server.request("/api/download/model")[2]
        server.post("/api/settings", {"start": "cad", "seed": 5})
        server.until("/api/runs", lambda r: len(r) == 2 and r[1]["current"])
        self.assertNotEqual(server.request("/api/download/model")[2], first)
        server.post("/api/runs/1/restore")
        server.until("/api/runs", lambda r: r[0]["current"])
        self.assertEqual(server.request("/api/download/model")[2], first)
        server.post("/api/runs/9/restore", expect=404)

    def test_restores_a_run_of_an_earlier_start_after_being_killed(self):
        server = self.quiet()
        self.paint_edge_and_face(server)
        self.train(server, 1)
        first = server.request("/api/download/model")[2]
        server.post("/api/settings", {"start": "cad", "seed": 5})
        server.post("/api/stroke", brush("more", 0, [(0.5, 0.4, 0.4)], radius=0.1))
        runs = self.train(server, 2)
        second = server.request("/api/download/model")[2]
        server.kill()
        server = self.serve()
        server.open()
        self.assertEqual([{**r, "held_out": None} for r in server.get("/api/runs")],
                         [{**r, "held_out": None} for r in runs])
        self.assertEqual([r["current"] for r in runs], [False, True])
        server.until("/api/session", lambda s: s["prediction_version"] == 1)
        self.assertEqual(server.request("/api/download/model")[2], second)
        server.post("/api/runs/1/restore")
        server.until("/api/runs", lambda r: r[0]["current"])
        self.assertEqual(server.request("/api/download/model")[2], first)
        self.assertEqual({**server.get("/api/runs")[0], "held_out": None},
                         {**runs[0], "current": True, "held_out": None})
        # The journal says so too: the next start shows it, the command line trains it.
        server.post("/api/save", {"what": "project"})
        run("train", "--project", self.folder / "cube_annotation.json", "-o",
            self.folder / "again.safetensors")
        server.kill()
        self.assertEqual((self.folder / "again.safetensors").read_bytes(), first)
        server = self.serve()
        server.open()
        self.assertTrue(server.get("/api/runs")[0]["current"])
        server.until("/api/session", lambda s: s["prediction_version"] == 1)
        self.assertEqual(server.request("/api/download/model")[2], first)

    def test_repeating_a_training_warns_of_its_clouds_as_training_on_files_does(self):
        write_ply(self.cloud, self.positions + [500_000, 5_400_000, 0])
        server = self.quiet()
        self.paint_edge_and_face(server)
        server.post("/api/save", {"what": "project"})
        server.end()
        said = run("train", "--project", self.folder / "cube_annotation.json", "-o",
                   self.folder / "again.safetensors").stderr
        self.assertRegex(said, r"cube.ply: float coordinates up to 540000\d are rounded to steps of 0.5")
        self.assertRegex(said, "cube.ply: .*no normals")

    def test_starts_from_the_default_model_and_keeps_its_context_network(self):
        server = self.serve("--model", "scan")
        server.open()
        self.assertEqual(server.get("/api/session")["settings"]["start"], "scan")
        self.assertEqual(server.until("/api/runs", lambda r: len(r) == 1)[0]["run"], 0)
        server.post("/api/save", {"what": "cloud"})
        rows, _ = read_ply(self.folder / "cube_annotated.ply")
        run("classify", self.cloud, "-o", self.folder / "scan.ply", "--model", "scan")
        other, _ = read_ply(self.folder / "scan.ply")
        for field in ("scalar_edge_class", "scalar_p_sharp", "label"):
            np.testing.assert_array_equal(rows[field], other[field])
        # One stroke of one class is enough.
        server.post("/api/stroke", brush("face", 0, FACE, radius=0.15))
        runs = server.until("/api/runs", lambda r: len(r) == 2 and r[1]["current"])
        self.assertEqual((runs[1]["start"], runs[1]["classes"]), ("scan", 3))
        for what in ("model", "project", "cloud"):
            server.post("/api/save", {"what": what, "overwrite": True})
        said = run("train", "--project", self.folder / "cube_annotation.json", "-o",
                   self.folder / "again.safetensors").stderr
        self.assertIn("adapted to the painted points: nothing is held out", said)
        self.assertNotIn("fewer than 20 points", said)
        model = self.folder / "cube.safetensors"
        self.assertEqual((self.folder / "again.safetensors").read_bytes(), model.read_bytes())
        self.assertIn(b"context.", model.read_bytes())
        rows, _ = read_ply(self.folder / "cube_annotated.ply")
        run("classify", self.cloud, "-o", self.folder / "by_model.ply", "--model", model)
        other, _ = read_ply(self.folder / "by_model.ply")
        for field in ("scalar_edge_class", "scalar_p_sharp", "scalar_p_smooth", "label"):
            np.testing.assert_array_equal(rows[field], other[field])
        # Without any stroke it is the start again; the other model at once when it is chosen.
        server.post("/api/undo")
        server.until("/api/runs", lambda r: r[0]["current"])
        server.post("/api/settings", {"start": "worn"})
        server.until("/api/runs", lambda r: r[0]["current"] and r[0]["start"] == "worn")

    def test_an_older_project_keeps_its_start_unless_another_is_asked_for(self):
        server = self.quiet()
        server.post("/api/stroke", brush("edge", 2, EDGE))
        server.kill()
        for options, start in (((), "random"), (("--model", "scan"), "scan")):
            self.servers.append(Server(self.cloud, *options))
            server = self.servers[-1]
            self.assertEqual(server.open()["settings"]["start"], start)
            server.kill()

    def test_saves_a_las_cloud_as_las(self):
        las = self.folder / "cube.las"
        run("convert", self.cloud, "-o", las)
        self.servers.append(Server(las, "--model", "none"))
        server = self.servers[-1]
        server.open()
        server.post("/api/settings", {"auto": False})
        counts = server.post("/api/stroke", brush("edge", 2, EDGE, radius=0.05))["counts"]
        saved = server.post("/api/save", {"what": "cloud"})["path"]
        self.assertEqual(saved, str(self.folder / "cube_annotated.las"))
        run("convert", saved, "-o", self.folder / "back.ply")
        rows, _ = read_ply(self.folder / "back.ply")
        self.assertEqual(int((rows["scalar_painted_label"] == 2).sum()), counts[2])

    def test_judges_by_whole_strokes(self):
        server = self.quiet()
        for k, z in enumerate((-0.3, 0.3)):
            server.post("/api/stroke", brush(f"e{k}", 2, [(0.5, 0.5, z)], radius=0.05))
            server.post("/api/stroke", brush(f"f{k}", 0, [(0.5, z, z)], radius=0.1))
        self.train(server, 1)
        held = server.until("/api/runs", lambda r: r[0]["held_out"])[0]["held_out"]
        self.assertEqual((held["strokes"], held["start"]), (4, None))
        self.assertGreater(held["accuracy"], 0.6)

    def find_lines(self, server, version):
        """Finds lines and waits for that version of them, which it returns."""
        server.post("/api/lines/find")
        return server.until("/api/lines",
                            lambda l: l["version"] == version and not l["searching"])

    def test_finds_lines_and_keeps_the_decisions_on_them(self):
        server = self.quiet()
        self.assertEqual(server.get("/api/lines"), {"version": 0, "prediction_version": 0,
                                                    "searching": False, "lines": []})
        server.post("/api/lines/find", expect=409)  # in no prediction
        self.paint_edge_and_face(server)
        self.train(server, 1)
        found = self.find_lines(server, 1)
        self.assertEqual(found["prediction_version"], 1)
        origin = np.array(server.get("/api/session")["origin"])
        # The cube's edges: straight, at right angles, one long, half a side from two of the axes.
        self.assertGreaterEqual(len(found["lines"]), 12)
        edges = [l for l in found["lines"] if l["kind"] == "segment" and l["length"] > 0.9]
        self.assertGreaterEqual(len(edges), 10)
        for line in edges:
            self.assertEqual((line["class"], line["decision"]), (2, "open"))
            self.assertAlmostEqual(line["length"], 1, delta=0.05)
            self.assertAlmostEqual(line["angle"], 90, delta=5)
            middle = np.sort(np.abs(np.add(line["middle"], origin)))
            np.testing.assert_allclose(middle, [0, 0.5, 0.5], atol=0.05)
            self.assertGreater(np.dot(line["normal"], np.add(line["middle"], origin)), 0.5)
            ends = np.reshape(line["path"], (-1, 3))
            self.assertAlmostEqual(np.linalg.norm(ends[-1] - ends[0]), line["length"])
        self.assertEqual(server.request("/api/download/lines")[0], 409)  # none is accepted

        def decide(decision, *lines, expect=200, version=1):
            return server.post("/api/lines/decide", {"version": version, "decision": decision,
                                                     "lines": lines}, expect=expect)

        decide("accepted", *range(len(found["lines"])))
        decide("rejected", 3)
        decide("open", 4)
        decide("rejected", len(found["lines"]), expect=404)
        decide("rejected", 1, expect=409, version=2)
        decide("good", 1, expect=400)
        server.post("/api/lines/decide", {"version": 1}, expect=400)
        decisions = [l["decision"] for l in server.get("/api/lines")["lines"]]
        self.assertEqual(decisions, ["rejected" if i == 3 else "open" if i == 4 else "accepted"
                                     for i in range(len(decisions))])
        saved = server.post("/api/save", {"what": "lines"})
        self.assertEqual(pathlib.Path(saved["path"]), self.folder / "cube_lines.dxf")
        for name, expect in (("cube_lines.geojson", 200), ("cube.ply", 400), ("x.txt", 400)):
            server.post("/api/save", {"what": "lines", "name": name}, expect=expect)
        drawn = json.loads((self.folder / "cube_lines.geojson").read_text())["features"]
        self.assertEqual(len(drawn), len(decisions) - 2)
        server.post("/api/save", {"what": "lines", "name": "cube_lines.gpkg"})
        for format in ("dxf", "geojson", "gpkg"):
            status, headers, data = server.request(f"/api/download/lines?format={format}")
            self.assertEqual((status, headers["Content-Disposition"]),
                             (200, f'attachment; filename="cube_lines.{format}"'))
            self.assertEqual(data, (self.folder / f"cube_lines.{format}").read_bytes())
        self.assertEqual(server.request("/api/download/lines?format=doc")[0], 400)
        server.kill()
        server = self.serve()
        server.open()
        server.until("/api/session", lambda s: s["prediction_version"] > 0 and s["run"])
        again = self.find_lines(server, 1)
        self.assertEqual([l["decision"] for l in again["lines"]], decisions)
        self.assertEqual([l["path"] for l in again["lines"]], [l["path"] for l in found["lines"]])
        # A new search begins afresh; what runs is cancelled, as training is.
        self.assertEqual({l["decision"] for l in self.find_lines(server, 2)["lines"]}, {"open"})
        server.post("/api/lines/find")
        server.post("/api/cancel")
        self.assertFalse(server.get("/api/lines")["searching"])

    def test_finds_boundaries_if_they_are_asked_for(self):
        self.cloud = self.folder / "sheet.ply"
        write_ply(self.cloud, *sheet()[:2])
        server = self.serve("--model", "general")
        server.open()
        server.until("/api/session", lambda s: s["prediction_version"] > 0 and s["run"])
        self.assertEqual(self.find_lines(server, 1)["lines"], [])
        server.post("/api/lines/find", {"boundaries": "rim"}, expect=400)
        server.post("/api/lines/find", {"boundaries": True})
        found = server.until("/api/lines", lambda l: l["version"] == 2 and not l["searching"])["lines"]
        self.assertEqual({line["class"] for line in found}, {3})
        self.assertAlmostEqual(sum(line["length"] for line in found), 4, delta=0.2)

    def test_tells_whether_strokes_are_newer_than_the_run(self):
        server = self.quiet()
        is_old = lambda: server.get("/api/session")["out_of_date"]
        self.paint_edge_and_face(server)
        self.assertFalse(is_old())  # there is no run
        self.train(server, 1)
        self.assertFalse(is_old())
        server.post("/api/stroke", brush("more", 2, [(-0.5, -0.5, 0)], radius=0.05))
        self.assertTrue(is_old())
        self.train(server, 2)
        self.assertFalse(is_old())
        server.post("/api/undo")
        self.assertTrue(is_old())
        server.kill()
        server = self.serve()
        server.open()
        server.until("/api/session", lambda s: s["prediction_version"] > 0)
        self.assertTrue(is_old())

    def test_tells_of_what_happens(self):
        server = self.quiet()
        stream = http.client.HTTPConnection("127.0.0.1", server.port, timeout=20)
        stream.request("GET", f"/api/events?token={server.token}")
        answer = stream.getresponse()
        self.assertEqual(answer.status, 200)
        self.assertEqual(answer.headers["Content-Type"], "text/event-stream")
        server.post("/api/stroke", brush("a", 2, EDGE))
        lines = []
        while not any(line.startswith(b"data: {") for line in lines):
            lines.append(answer.fp.readline())
            lines.append(answer.fp.readline())
        self.assertTrue(any(line == b"event: labels\n" for line in lines), lines)
        # A window that listens, and whoever drips, does not keep the program from ending.
        drip = Drip(server, 20)
        self.addCleanup(drip.close)
        start = time.monotonic()
        self.assertEqual(server.end()[0], 0)
        self.assertLess(time.monotonic() - start, 4)
        stream.close()

    def test_opens_las_and_saves_it_as_las(self):
        las = self.folder / "cube.las"
        run("convert", self.cloud, "-o", las)
        self.cloud = las
        server = self.quiet()
        counts = server.post("/api/stroke", brush("a", 2, EDGE))["counts"]
        for name in ("painted.laz", "painted.las", "painted.ply"):
            saved = server.post("/api/save", {"what": "cloud", "name": name})["path"]
            back = self.folder / "back.ply"
            run("convert", saved, "-o", back, "--overwrite")
            rows, _ = read_ply(back)
            self.assertEqual(int((rows["scalar_painted_label"] == 2).sum()), counts[2], name)
        server.post("/api/save", {"what": "cloud", "name": "painted.e57"}, expect=400)

    def test_shows_the_scales_of_the_start(self):
        for model, scales in (("none", 16), ("general", 8)):
            server = self.serve("--model", model)
            server.open()
            session = server.get("/api/session")
            self.assertEqual(len(session["scales"]), scales)
            self.assertEqual(session["scales"], sorted(session["scales"]))
            last = f"/api/node/0/values?of=feature&feature=1&scale={scales - 1}"
            self.assertEqual(server.request(last)[0], 200)
            self.assertEqual(server.request(last.replace(str(scales - 1), str(scales)))[0], 404)
            server.end()

    def test_takes_no_cache_that_is_damaged(self):
        server = self.quiet()
        values = server.request("/api/node/0/values?of=feature&feature=1&scale=8")[2]
        server.end()
        (cache,) = (self.folder / ".pcednet").glob("*.description")
        sound = cache.read_bytes()
        for damaged in (sound[:100], sound[:-4], sound[:-4] + b"\x01\x02\x03\x04", b""):
            cache.write_bytes(damaged)
            server = self.serve()
            server.open()
            self.assertEqual(server.request("/api/node/0/values?of=feature&feature=1&scale=8")[2],
                             values)
            server.end()
            self.assertEqual(cache.read_bytes(), sound)


if __name__ == "__main__":
    unittest.main()
