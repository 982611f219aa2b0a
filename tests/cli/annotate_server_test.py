"""The annotator's server on the loopback: who is answered, what is painted, what survives."""
import http.client
import json
import pathlib
import re
import signal
import socket
import subprocess
import threading
import time
import unittest
import urllib.error
import urllib.request

import numpy as np

import support
from support import CliTest, read_ply, run, write_ply


class Server:
    """A running `pcednet annotate`."""

    def __init__(self, cloud, *options):
        self.process = subprocess.Popen(
            [support.PROGRAM, "annotate", str(cloud), "--no-browser", "--progress", "none", *options],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        line = self.process.stdout.readline()
        found = re.fullmatch(r"http://127\.0\.0\.1:(\d+)/\?token=([0-9a-f]{32})\n", line)
        if not found:
            self.process.kill()
            raise AssertionError(f"no address: {line!r}: {self.process.communicate()}")
        self.port, self.token, self.window = int(found[1]), found[2], ""

    def request(self, path, body=None, headers=None):
        """Status, headers and bytes of an answer."""
        given = {"X-Pcednet-Token": self.token, "X-Window": self.window}
        given.update(headers or {})
        data = json.dumps(body).encode() if isinstance(body, (dict, list)) else body
        request = urllib.request.Request(
            f"http://127.0.0.1:{self.port}{path}", data,
            {name: value for name, value in given.items() if value is not None})
        if data is not None:
            request.add_header("Content-Type", "application/json")
        try:
            with urllib.request.urlopen(request, timeout=60) as answer:
                return answer.status, answer.headers, answer.read()
        except urllib.error.HTTPError as error:
            return error.code, error.headers, error.read()

    def get(self, path):
        status, _, text = self.request(path)
        assert status == 200, (path, status, text)
        return json.loads(text)

    def post(self, path, body=None, expect=200):
        status, _, text = self.request(path, {} if body is None else body)
        assert status == expect, (path, status, text)
        return json.loads(text)

    def until(self, path, is_done, seconds=120):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            answer = self.get(path)
            if is_done(answer):
                return answer
            time.sleep(0.05)
        raise AssertionError(f"{path}: waited in vain: {answer}")

    def open(self):
        """Waits for the cloud and becomes the writer."""
        session = self.until("/api/session", lambda s: s["state"] == "ready")
        self.window = self.post("/api/window")["window"]
        self.post(f"/api/window/{self.window}/take")
        return session

    def labels(self):
        """Local positions and labels of all points, node by node."""
        places, labels = [], []
        for node in self.get("/api/session")["nodes"]:
            data = self.request(f"/api/node/{node['id']}/points")[2]
            places.append(np.frombuffer(data, "<u2", 3 * node["points"]).reshape(-1, 3) / 65535
                          * 2 * node["half"] - node["half"] + node["centre"])
            labels.append(np.frombuffer(
                self.request(f"/api/node/{node['id']}/values?of=labels")[2], np.uint8))
        return np.concatenate(places), np.concatenate(labels)

    def end(self):
        self.process.send_signal(signal.SIGINT)
        _, errors = self.process.communicate(timeout=60)
        return self.process.returncode, errors

    def kill(self):
        self.process.kill()
        self.process.communicate()


def brush(name, edge_class, centres, radius=0.1, **more):
    return {"id": name, "tool": "brush", "class": edge_class, "radius": radius, "protect": False,
            "hidden": [], "clip": None, "centres": [list(map(float, c)) for c in centres], **more}


EDGE = [(0.5, 0.5, z) for z in np.linspace(-0.3, 0.3, 13)]
FACE = [(0.5, y, z) for y in (-0.2, 0, 0.2) for z in (-0.2, 0, 0.2)]


class AnnotateServer(CliTest):
    def setUp(self):
        super().setUp()
        self.positions, normals, _ = support.cube(20000)
        self.cloud = self.folder / "cube.ply"
        write_ply(self.cloud, self.positions, normals)
        self.servers = []

    def tearDown(self):
        for server in self.servers:
            if server.process.poll() is None:
                server.kill()
        super().tearDown()

    def serve(self, *options):
        self.servers.append(Server(self.cloud, *options))
        return self.servers[-1]

    def quiet(self):
        """A server that trains only when asked to."""
        server = self.serve()
        server.open()
        server.post("/api/settings", {"auto": False})
        return server

    def test_answers_nobody_without_the_token(self):
        server = self.serve()
        for headers in ({"X-Pcednet-Token": None}, {"X-Pcednet-Token": "0" * 32},
                        {"Origin": "http://evil.example"}, {"Host": "evil.example"},
                        {"Host": f"127.0.0.1:{server.port + 1}"}):
            for path in ("/api/session", "/api/events", "/api/node/0/points"):
                self.assertEqual(server.request(path, headers=headers)[0], 403, (path, headers))
            self.assertEqual(server.request("/api/undo", {}, headers)[0], 403, headers)
        self.assertEqual(server.request(f"/api/session?token={server.token}",
                                        headers={"X-Pcednet-Token": None})[0], 200)
        own = f"http://127.0.0.1:{server.port}"
        self.assertEqual(server.request("/api/session", headers={"Origin": own})[0], 200)

    def test_listens_on_the_loopback_alone(self):
        server = self.serve()
        listening = [line.split()[1] for line in pathlib.Path("/proc/net/tcp").read_text().splitlines()[1:]
                     if line.split()[3] == "0A" and line.split()[1].endswith(f":{server.port:04X}")]
        self.assertEqual(listening, [f"0100007F:{server.port:04X}"])

    def test_refuses_bodies_that_are_too_long_or_make_no_sense(self):
        server = self.quiet()
        self.assertEqual(server.request("/api/stroke", b" " * (9 << 20))[0], 413)
        for body in (b"", b"{", b"[]", b"null", b'"x"', b"[" * 100000, b"\xff\xfe",
                     brush("", 2, EDGE), brush("a", 3, EDGE), brush("a", 2, []),
                     brush("a", 2, EDGE, radius=-1), brush("a", 2, [[1, 2]]),
                     brush("a", 2, EDGE, clip=7), {**brush("a", 2, EDGE), "tool": "laser"},
                     {"id": "a", "tool": "polygon", "class": 1, "polygon": [[0, 0]]}):
            status, _, text = server.request("/api/stroke", body)
            self.assertEqual(status, 400, (body[:40] if isinstance(body, bytes) else body, text))
            self.assertIn("error", json.loads(text))
        for path in ("/api/nothing", "/api/node/99999/points", "/api/node/0/values?of=feature&feature=9",
                     "/nothing"):
            self.assertEqual(server.request(path)[0], 404, path)
        self.assertEqual(server.request("/api/node/x/points")[0], 400)
        self.assertEqual(server.request("/api/node/0/values?of=x")[0], 400)
        self.assertEqual(server.get("/api/session")["strokes"], 0)

    def test_slow_and_aborted_clients_do_not_stop_the_others(self):
        server = self.quiet()
        sockets = []
        for text in ("GET /api/sess", "POST /api/stroke HTTP/1.1\r\nHost: 127.0.0.1:%d\r\n"
                     "X-Pcednet-Token: %s\r\nContent-Length: 1000\r\n\r\n{" %
                     (server.port, server.token), "") * 3:
            sockets.append(socket.create_connection(("127.0.0.1", server.port)))
            sockets[-1].sendall(text.encode())
        for _ in range(5):
            with socket.create_connection(("127.0.0.1", server.port)) as stream:
                stream.sendall(f"GET /api/events?token={server.token} HTTP/1.1\r\n"
                               f"Host: 127.0.0.1:{server.port}\r\n\r\n".encode())
                self.assertTrue(stream.recv(10).startswith(b"HTTP/1.1 2"))
        start = time.monotonic()
        self.assertGreater(server.post("/api/stroke", brush("a", 2, EDGE))["changed"], 0)
        self.assertLess(time.monotonic() - start, 4)
        for s in sockets:
            s.close()

    def test_paints_the_points_of_the_brush_and_takes_them_back(self):
        server = self.quiet()
        session = server.get("/api/session")
        self.assertEqual(sum(n["points"] for n in session["nodes"]), 20000)
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

    def test_only_the_window_that_writes_is_heard(self):
        server = self.quiet()
        first, second = server.window, server.post("/api/window")
        self.assertFalse(second["writer"])
        server.window = second["window"]
        for path in ("/api/undo", "/api/train", "/api/settings", "/api/save"):
            server.post(path, {}, expect=409)
        server.post("/api/stroke", brush("a", 2, EDGE), expect=409)
        server.post(f"/api/window/{second['window']}/take")
        self.assertGreater(server.post("/api/stroke", brush("a", 2, EDGE))["changed"], 0)
        server.window = first
        server.post("/api/stroke", brush("b", 2, FACE), expect=409)

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

    def test_refuses_a_journal_of_another_cloud(self):
        server = self.quiet()
        server.post("/api/stroke", brush("a", 2, EDGE))
        self.assertEqual(server.end()[0], 0)
        write_ply(self.cloud, self.positions[:15000])
        done = run("annotate", self.cloud, "--no-browser", expect=4)
        self.assertIn("another input", done.stderr)

    def test_trains_and_the_command_line_makes_the_same_model(self):
        server = self.quiet()
        server.post("/api/train", expect=409)
        server.post("/api/stroke", brush("edge", 2, EDGE, radius=0.05))
        server.post("/api/stroke", brush("face", 0, FACE, radius=0.15))
        server.post("/api/train")
        runs = server.until("/api/runs", lambda r: len(r) == 1)
        self.assertTrue(runs[0]["current"])
        self.assertGreater(runs[0]["held_out_accuracy"], 0.9)
        # What is painted after the run does not belong to its model.
        server.post("/api/stroke", brush("more", 1, [(0.5, 0.4, 0.4)], radius=0.1))
        for what in ("model", "project", "cloud"):
            saved = server.post("/api/save", {"what": what})
            server.post("/api/save", {"what": what}, expect=409)
            server.post("/api/save", {"what": what, "overwrite": True})
            self.assertEqual(server.request(f"/api/download/{what}")[2],
                             pathlib.Path(saved["path"]).read_bytes())
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
        server.post("/api/stroke", brush("edge", 2, EDGE, radius=0.05))
        server.post("/api/stroke", brush("face", 0, FACE, radius=0.15))
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
        server.post("/api/stroke", brush("edge", 2, EDGE, radius=0.05))
        server.post("/api/stroke", brush("face", 0, FACE, radius=0.15))
        server.post("/api/train")
        server.until("/api/runs", lambda r: len(r) == 1)
        first = server.request("/api/download/model")[2]
        server.post("/api/settings", {"start": "cad", "seed": 5})
        server.post("/api/stroke", brush("more", 0, [(0.5, 0.4, 0.4)], radius=0.1))
        server.post("/api/train")
        runs = server.until("/api/runs", lambda r: len(r) == 2)
        second = server.request("/api/download/model")[2]
        server.kill()
        server = self.serve()
        server.open()
        self.assertEqual(server.get("/api/runs"), runs)
        self.assertEqual([r["current"] for r in runs], [False, True])
        server.until("/api/session", lambda s: s["prediction_version"] == 1)
        self.assertEqual(server.request("/api/download/model")[2], second)
        server.post("/api/runs/1/restore")
        server.until("/api/runs", lambda r: r[0]["current"])
        self.assertEqual(server.request("/api/download/model")[2], first)
        self.assertEqual(server.get("/api/runs")[0], {**runs[0], "current": True})
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
        stream.close()

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

    def test_says_what_is_wrong_and_ends(self):
        self.assertIn("no such file", run("annotate", self.folder / "none.ply", expect=3).stderr)
        (self.folder / "bad.ply").write_text("ply\nrubbish\n")
        for _ in range(20):  # told to stop while its server is still starting
            run("annotate", self.folder / "bad.ply", "--no-browser", expect=3)
        run("train", "-o", self.folder / "m.safetensors", expect=2)
        server = self.serve()
        run("annotate", self.cloud, "--no-browser", "--port", server.port, expect=1)
        server.open()
        code, errors = server.end()
        self.assertEqual((code, "ready" in errors), (0, True))


if __name__ == "__main__":
    unittest.main()
