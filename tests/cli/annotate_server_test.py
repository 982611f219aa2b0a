"""The annotator's server on the loopback: who is answered, what is painted, what survives."""
import http.client
import itertools
import json
import os
import pathlib
import re
import signal
import socket
import subprocess
import sys
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

    def __init__(self, cloud, *options, environment=None):
        browser = [] if environment else ["--no-browser"]
        self.process = subprocess.Popen(
            [support.PROGRAM, "annotate", str(cloud), *browser, "--progress", "none", *options],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment)
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

    def memory(self):
        """Bytes in use."""
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        return 1024 * int(re.search(r"VmRSS:\s+(\d+)", status)[1])

    def end(self):
        self.process.send_signal(signal.SIGINT)
        _, errors = self.process.communicate(timeout=60)
        return self.process.returncode, errors

    def kill(self):
        self.process.kill()
        self.process.communicate()


class Drip:
    """Connections that send the head of a request byte by byte and never come to its end."""

    def __init__(self, server, count):
        self.head = itertools.cycle(f"GET /api/session HTTP/1.1\r\nHost: 127.0.0.1:{server.port}\r\n"
                                    f"X-Drip: ".encode() + b"x" * 100)
        self.open = [socket.create_connection(("127.0.0.1", server.port)) for _ in range(count)]
        for s in self.open:
            s.setblocking(False)

    def step(self):
        """One more byte each; leaves out those that the server has closed."""
        byte = bytes([next(self.head)])
        for s in list(self.open):
            try:
                s.send(byte)
                if s.recv(1000) != b"":
                    continue
            except BlockingIOError:
                continue
            except OSError:
                pass
            self.open.remove(s)
            s.close()

    def close(self):
        for s in self.open:
            s.close()


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

    def serve(self, *options, environment=None):
        self.servers.append(Server(self.cloud, *options, environment=environment))
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

    def test_is_not_held_up_by_connections_that_drip_without_the_token(self):
        server = self.quiet()
        server.post("/api/stroke", brush("a", 2, EDGE))
        for count in (50, 100, 300):  # 50 leave room for others: the time limit alone ends them
            memory = server.memory()
            drip = Drip(server, count)
            self.addCleanup(drip.close)
            start = time.monotonic()
            slowest = 0
            while drip.open and time.monotonic() < start + 10:
                drip.step()
                if slowest > 0:  # an answer shows that all were accepted; the oldest have made room
                    self.assertLessEqual(len(drip.open), 101)
                asked = time.monotonic()
                server.get("/api/runs")
                self.assertEqual(server.request("/")[0], 200)
                slowest = max(slowest, time.monotonic() - asked)
                self.assertLess(server.memory(), memory + (16 << 20))
                time.sleep(0.1)
            self.assertLess(slowest, 1)
            self.assertEqual(len(drip.open), 0, "they are still connected after ten seconds")

    def test_reads_no_head_without_an_end(self):
        server = self.serve()
        with socket.create_connection(("127.0.0.1", server.port), timeout=4) as endless:
            with self.assertRaises(OSError):
                endless.sendall(b"GET /api/session HTTP/1.1\r\nX-Long: " + b"x" * (64 << 20))

    def test_takes_only_bodies_that_say_their_length(self):
        server = self.quiet()
        body = iter([b"{}"])  # urllib sends it in chunks
        self.assertEqual(server.request("/api/undo", body)[0], 400)

    def test_hands_the_token_to_the_browser_where_nobody_else_can_read_it(self):
        programs, runtime, given = (self.folder / name for name in ("bin", "run", "given.json"))
        programs.mkdir()
        runtime.mkdir()
        opener = programs / "xdg-open"
        opener.write_text(f"""#!{sys.executable}
import json, os, pathlib, sys
file = pathlib.Path(sys.argv[1])
modes = [path.stat().st_mode & 0o777 for path in (file, file.parent)]
told = dict(words=sys.argv[1:], environment=dict(os.environ), modes=modes, text=file.read_text())
half = pathlib.Path({str(given)!r} + ".part")
half.write_text(json.dumps(told))
half.rename({str(given)!r})
""")
        opener.chmod(0o755)
        environment = {**os.environ, "PATH": f"{programs}:{os.environ['PATH']}",
                       "XDG_RUNTIME_DIR": str(runtime)}
        for ask in (True, False):
            given.unlink(missing_ok=True)
            server = self.serve(environment=environment)
            end = time.monotonic() + 30
            while not given.exists() and time.monotonic() < end:
                time.sleep(0.01)
            told = json.loads(given.read_text())
            self.assertNotIn(server.token, json.dumps([told["words"], told["environment"]]))
            self.assertEqual(told["modes"], [0o600, 0o700])
            self.assertIn(f"url=http://127.0.0.1:{server.port}/?token={server.token}\"", told["text"])
            self.assertTrue(pathlib.Path(told["words"][0]).is_relative_to(runtime))
            if ask:  # once a page has come, or at the end, nothing is left of it
                server.open()
                while list(runtime.iterdir()) and time.monotonic() < end:
                    time.sleep(0.01)
                self.assertEqual(list(runtime.iterdir()), [])
            self.assertEqual(server.end()[0], 0)
            self.assertEqual(list(runtime.iterdir()), [])

    def test_saves_under_plain_names_only(self):
        server = self.quiet()
        server.post("/api/stroke", brush("a", 2, EDGE))
        before = {path: path.read_bytes() for path in self.folder.rglob("*") if path.is_file()}
        journal = "cube_annotation.json.journal"
        self.assertIn(self.folder / journal, before)
        for what, name in (("cloud", f"{journal}\0.ply"), ("cloud", "cube.ply\0.ply"), ("cloud", "a\n.ply"),
                           ("cloud", "a\x7f.ply"), ("cloud", "../a.ply"), ("cloud", "/tmp/a.ply"),
                           ("cloud", "a/../a.ply"), ("cloud", ".pcednet/a.ply"), ("cloud", ".a.ply"),
                           ("cloud", "..\\a.ply"), ("cloud", "a" * 250 + ".ply"), ("cloud", "cube.ply"),
                           ("cloud", journal), ("project", journal), ("project", f"{journal}\0.json"),
                           ("model", "cube.ply"), ("cloud", "a"), ("cloud", 7), ("cloud", None)):
            wanted = {"what": what, "name": name, "overwrite": True}
            self.assertIn("error", server.post("/api/save", wanted, expect=400), name)
        raw = b'{"what": "cloud", "name": "\xff\xfe.ply"}'
        self.assertEqual(server.request("/api/save", raw)[0], 400)
        os.link(self.folder / journal, self.folder / "other.ply")
        server.post("/api/save", {"what": "cloud", "name": "other.ply", "overwrite": True}, expect=400)
        (self.folder / "other.ply").unlink()
        self.assertEqual({path: path.read_bytes() for path in self.folder.rglob("*") if path.is_file()},
                         before)
        saved = server.post("/api/save", {"what": "cloud", "name": "K\u00e4se \u26f0.ply"})["path"]
        self.assertEqual(len(read_ply(saved)[0]), 20000)
        self.assertEqual(server.end()[0], 0)
        # A project with an unusual name is not taken for a cloud that may be replaced.
        server = self.serve("--project", str(self.folder / "strokes.ply"))
        server.open()
        server.post("/api/stroke", brush("a", 2, EDGE))
        server.post("/api/save", {"what": "project"})
        server.post("/api/save", {"what": "cloud", "name": "strokes.ply", "overwrite": True}, expect=400)

    def test_begins_with_shipped_models_and_the_one_that_the_user_named_only(self):
        server = self.quiet()
        server.post("/api/stroke", brush("edge", 2, EDGE, radius=0.05))
        server.post("/api/stroke", brush("face", 0, FACE, radius=0.15))
        server.post("/api/train")
        server.until("/api/runs", lambda r: len(r) == 1)
        mine = server.post("/api/save", {"what": "model", "name": "mine.safetensors"})["path"]
        secret = self.folder / "secret.txt"
        secret.write_text("open sesame")
        scan = str(support.SOURCE / "models/scan.safetensors")
        for start in (str(secret), mine, scan, "secret.txt", "../models/scan", "scan\0", "", "/etc/passwd",
                      "/dev/zero", 7):
            told = server.post("/api/settings", {"start": start}, expect=400)["error"]
            self.assertNotIn("sesame", told)
            if start and start != 7:
                self.assertNotIn(start, told)
                self.assertIn("cad, scan, worn", told)
        for start in ("scan", "cad", "worn", "random"):
            self.assertEqual(server.post("/api/settings", {"start": start})["start"], start)
        server.end()
        server = self.serve("--model", mine)
        server.open()
        self.assertEqual(server.post("/api/settings", {"start": mine})["start"], mine)
        server.post("/api/settings", {"start": str(secret)}, expect=400)

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
        # A window that listens, and whoever drips, does not keep the program from ending.
        drip = Drip(server, 20)
        self.addCleanup(drip.close)
        start = time.monotonic()
        self.assertEqual(server.end()[0], 0)
        self.assertLess(time.monotonic() - start, 4)
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
