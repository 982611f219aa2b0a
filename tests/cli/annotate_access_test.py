"""Who may ask the annotator's server, for what, and what it is not held up by."""
import json
import os
import pathlib
import socket
import sys
import time
import unittest

import support
from annotate_support import AnnotateTest, Drip, EDGE, FACE, POINTS, Server, brush
from support import read_ply, run, write_ply


class AnnotateAccess(AnnotateTest):
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

    def test_keeps_its_address_for_a_new_start_where_nobody_else_can_read_it(self):
        kept = self.folder / "cube_annotation.json.address"
        server = self.quiet()
        first, window = (server.port, server.token), server.window
        self.assertEqual(kept.stat().st_mode & 0o777, 0o600)
        server.kill()
        server = self.serve()
        server.window = window
        session = server.until("/api/session", lambda s: s["state"] == "ready")
        self.assertEqual((server.port, server.token), first)
        self.assertFalse(session["known"] or session["writer"], "a window of the earlier start")
        server.post("/api/undo", expect=409)
        server.open()
        self.assertTrue(server.get("/api/session")["known"])
        # A file that others may read, or one that is too old, is of no use.
        for spoil in (lambda: kept.chmod(0o644), lambda: os.utime(kept, (0, 0)),
                      lambda: kept.write_text(f"{server.port} abc\n")):
            last = server.token
            server.end()
            spoil()
            server = self.serve()
            server.open()
            self.assertNotEqual(server.token, last)

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
        self.assertEqual(len(read_ply(saved)[0]), POINTS)
        self.assertEqual(server.end()[0], 0)
        # A project with an unusual name is not taken for a cloud that may be replaced.
        server = self.serve("--project", str(self.folder / "strokes.ply"))
        server.open()
        server.post("/api/stroke", brush("a", 2, EDGE))
        server.post("/api/save", {"what": "project"})
        server.post("/api/save", {"what": "cloud", "name": "strokes.ply", "overwrite": True}, expect=400)

    def test_begins_with_shipped_models_and_the_one_that_the_user_named_only(self):
        server = self.quiet()
        self.paint_edge_and_face(server)
        self.train(server, 1)
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
                self.assertIn("cad, general, scan, worn", told)
        for start in ("scan", "cad", "worn", "random"):
            self.assertEqual(server.post("/api/settings", {"start": start})["start"], start)
        server.end()
        server = self.serve("--model", mine)
        server.open()
        name = pathlib.Path(mine).name  # as a project beside it has it
        self.assertEqual(server.post("/api/settings", {"start": name})["start"], name)
        server.post("/api/settings", {"start": mine}, expect=400)
        server.post("/api/settings", {"start": str(secret)}, expect=400)

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

    def test_a_window_that_leaves_lets_another_paint(self):
        server = self.quiet()
        first, second, third = server.window, *(server.post("/api/window")["window"] for _ in range(2))
        server.post(f"/api/window/{second}/leave")
        self.assertGreater(server.post("/api/stroke", brush("a", 2, EDGE))["changed"], 0)
        server.post(f"/api/window/{first}/leave")
        server.post("/api/undo", expect=409)
        server.window = third
        server.post("/api/undo")
        server.post(f"/api/window/{third}/leave")
        self.assertTrue(server.post("/api/window")["writer"])
        for gone in (first, "w99", "w", "x1"):
            for what in ("leave", "take"):
                server.post(f"/api/window/{gone}/{what}", expect=404)

    def test_opens_no_browser_for_an_input_that_cannot_be_painted(self):
        given = self.folder / "given"
        opener = self.folder / "xdg-open"
        opener.write_text(f"#!/bin/sh\ntouch {given}\n")
        opener.chmod(0o755)
        environment = {**os.environ, "PATH": f"{self.folder}:{os.environ['PATH']}"}
        server = self.serve()
        server.open()
        write_ply(self.folder / "none.ply", self.positions[:0])
        said = run("annotate", self.folder / "none.ply", expect=4, env=environment).stderr
        self.assertIn(f"{self.folder / 'none.ply'}: the cloud has no points", said)
        done = run("annotate", self.cloud, expect=1, env=environment)
        self.assertEqual(done.stdout, "")  # no address
        self.assertIn("another annotator has it open", done.stderr)
        self.assertFalse(given.exists())

    def test_says_what_is_wrong_and_ends(self):
        self.assertIn("no such file", run("annotate", self.folder / "none.ply", expect=3).stderr)
        self.assertIn("is a folder; give its files one by one",
                      run("annotate", self.folder, "--no-browser", expect=2).stderr)
        (self.folder / "bad.ply").write_text("ply\nrubbish\n")
        for _ in range(20):  # told to stop while its server is still starting
            run("annotate", self.folder / "bad.ply", "--no-browser", expect=3)
        run("train", "-o", self.folder / "m.safetensors", expect=2)
        server = self.serve()
        run("annotate", self.cloud, "--no-browser", "--port", server.port, expect=1)
        server.open()
        code, errors = server.end()
        self.assertEqual((code, "ready" in errors), (0, True))

    def test_says_where_strokes_may_go_if_the_folder_cannot_be_written(self):
        self.folder.chmod(0o555)
        # Root may do everything, and becomes somebody else.
        somebody = (lambda: os.setuid(65534)) if os.getuid() == 0 else None
        errors = run("annotate", self.cloud, "--no-browser", expect=1, preexec_fn=somebody).stderr
        self.assertIn("the folder cannot be written; --project FILE keeps the strokes elsewhere",
                      errors)
        self.folder.chmod(0o755)

    def test_what_cannot_be_saved_can_be_downloaded(self):
        own = self.folder / "own"
        own.mkdir()
        own.chmod(0o777)
        self.folder.chmod(0o555)
        somebody = (lambda: os.setuid(65534)) if os.getuid() == 0 else None
        self.servers.append(Server(self.cloud, "--project", str(own / "p.json"), "--model", "none",
                                   preexec_fn=somebody))
        server = self.servers[0]
        server.open()
        server.post("/api/stroke", brush("edge", 2, EDGE))
        refused = server.post("/api/save", {"what": "cloud"}, expect=500)["error"]
        self.assertIn(f"{self.folder / 'cube_annotated.ply'}: cannot be written: folder {self.folder}: Permission "
                      "denied; all strokes are kept: download it instead, or mend that and save again", refused)
        self.assertEqual(server.request("/api/download/cloud")[0], 200)
        server.post("/api/save", {"what": "project"})  # lies elsewhere
        self.folder.chmod(0o777)
        server.post("/api/save", {"what": "cloud"})
        self.assertTrue((self.folder / "cube_annotated.ply").exists())


if __name__ == "__main__":
    unittest.main()
