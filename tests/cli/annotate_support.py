"""What the tests of the annotator share: its server, a client that never ends, and strokes."""
import itertools
import json
import pathlib
import re
import signal
import socket
import subprocess
import time
import urllib.error
import urllib.request

import numpy as np

import support
from support import CliTest, write_ply


class Server:
    """A running `pcednet annotate`."""

    def __init__(self, cloud, *options, environment=None, preexec_fn=None):
        browser = [] if environment else ["--no-browser"]
        self.process = subprocess.Popen(
            [support.PROGRAM, "annotate", str(cloud), *browser, "--progress", "none", *options],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment,
            preexec_fn=preexec_fn)
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


POINTS = 8000  # of the cube
EDGE = [(0.5, 0.5, z) for z in np.linspace(-0.3, 0.3, 13)]
FACE = [(0.5, y, z) for y in (-0.2, 0, 0.2) for z in (-0.2, 0, 0.2)]


class AnnotateTest(CliTest):
    """A cube and the annotators that a test starts on it."""

    def setUp(self):
        super().setUp()
        self.positions, normals, _ = support.cube(POINTS)
        self.cloud = self.folder / "cube.ply"
        write_ply(self.cloud, self.positions, normals)
        self.servers = []

    def tearDown(self):
        for server in self.servers:
            if server.process.poll() is None:
                server.kill()
        super().tearDown()

    def serve(self, *options, environment=None):
        """An annotator that starts a new project from nothing, unless it is given a model."""
        is_new = not list(self.folder.glob("*.journal"))
        if is_new and "--model" not in options:
            options += ("--model", "none")
        self.servers.append(Server(self.cloud, *options, environment=environment))
        return self.servers[-1]

    def quiet(self):
        """A server that trains only when asked to."""
        server = self.serve()
        server.open()
        server.post("/api/settings", {"auto": False})
        return server

    def paint_edge_and_face(self, server):
        """As little as can be trained on."""
        server.post("/api/stroke", brush("edge", 2, EDGE, radius=0.05))
        server.post("/api/stroke", brush("face", 0, FACE, radius=0.15))

    def train(self, server, runs):
        """Trains and waits until there are so many runs, which it returns."""
        server.post("/api/train")
        return server.until("/api/runs", lambda r: len(r) == runs)
