"""Bad input of every kind: the right exit code, a message that names the file, nothing lost."""
import contextlib
import os
import pathlib
import resource
import signal
import subprocess
import unittest

import numpy as np

from support import PROGRAM, CliTest, cube, run, write_ply


def has_open(process, path):
    """Whether the process has the file open. It may close others meanwhile."""
    for file in pathlib.Path(f"/proc/{process.pid}/fd").iterdir():
        with contextlib.suppress(FileNotFoundError):
            if os.readlink(file) == str(path):
                return True
    return False


class Errors(CliTest):
    def fails(self, code, *arguments, naming=None, **options):
        done = run(*arguments, expect=code, **options)
        self.assertIn("pcednet", done.stderr)
        if naming:
            self.assertIn(str(naming), done.stderr)
        return done.stderr

    def classify_fails(self, code, name, content):
        path = self.folder / name
        path.write_bytes(content)
        said = self.fails(code, "classify", path, naming=path)
        self.assertEqual(os.listdir(self.folder), [name])
        path.unlink()
        return said

    def test_usage(self):
        run("--help")
        run("--version")
        run(expect=2)
        run("no-such-command", expect=2)
        run("classify", "--no-such-option", expect=2)
        run("classify", expect=2)
        for command in ("classify", "lines", "train", "evaluate", "describe", "generate", "normals", "info",
                        "convert"):
            self.assertIn("Examples", run(command, "--help").stdout)

    def test_unreadable_input(self):
        self.fails(3, "classify", self.folder / "none.ply", naming="none.ply")
        for name in ("empty.ply", "empty.laz", "empty.csv"):
            self.assertIn("the file is empty", self.classify_fails(3, name, b""))
        self.classify_fails(3, "text.ply", b"this is no PLY\n")
        self.classify_fails(3, "unknown.xyzzy", b"1 2 3\n")
        self.classify_fails(3, "bad.xyz", b"1 2 3\n4 five 6\n")
        write_ply(self.folder / "whole.ply", *cube(100)[:2])
        whole = (self.folder / "whole.ply").read_bytes()
        (self.folder / "whole.ply").unlink()
        self.classify_fails(3, "truncated.ply", whole[:-10])
        self.classify_fails(3, "absurd.ply", whole.replace(b"vertex 100", b"vertex 99999999999"))

    def test_a_pipe_is_no_input(self):
        os.mkfifo(self.folder / "a.ply")
        said = self.fails(3, "classify", self.folder / "a.ply", naming="a.ply")
        self.assertIn("a.ply: is a pipe, and is read at several places: save it as a file", said)
        with subprocess.Popen(["cat"], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE) as cat:
            self.assertIn("/dev/stdin: is a pipe", run("classify", "/dev/stdin", "-o", self.folder / "b.ply",
                                                       stdin=cat.stdout, expect=3).stderr)

    def test_clouds_that_lack_something(self):
        nothing = b"ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\n" \
                  b"property float y\nproperty float z\nend_header\n"
        self.classify_fails(4, "no_points.ply", nothing % 0)
        self.classify_fails(4, "one_point.ply", nothing % 1 + b"1 2 3\n")
        self.classify_fails(4, "nan.ply", nothing % 3 + 3 * b"nan nan nan\n")
        self.classify_fails(4, "copies.ply", nothing % 50 + 50 * b"1 2 3\n")
        line = b"".join(b"%d 0 0\n" % i for i in range(100))
        self.classify_fails(4, "line.ply", nothing % 100 + line)
        (self.folder / "line.ply").write_bytes(nothing % 100 + line)
        self.fails(4, "normals", self.folder / "line.ply", "-o", self.folder / "n.ply", naming="line.ply")
        (self.folder / "line.ply").unlink()
        write_ply(self.folder / "plain.ply", *cube(200)[:2])
        self.fails(4, "train", self.folder / "plain.ply", "-o", self.folder / "m.safetensors",
                   naming="plain.ply")
        self.fails(4, "evaluate", self.folder / "plain.ply", "--model", "scan", naming="plain.ply")

    def test_duplicates_and_huge_coordinates_are_fine(self):
        p, n, _ = cube(600)
        write_ply(self.folder / "twice.ply", np.vstack([p, p]), np.vstack([n, n]))
        run("classify", self.folder / "twice.ply")
        write_ply(self.folder / "far.ply", p + 1e7, n, position_type="double")
        run("classify", self.folder / "far.ply")

    def test_models(self):
        write_ply(self.folder / "a.ply", *cube(200)[:2])
        (self.folder / "m.safetensors").write_bytes(b"\x10\0\0\0\0\0\0\0{}")
        self.fails(5, "classify", self.folder / "a.ply", "--model", self.folder / "m.safetensors",
                   naming="m.safetensors")
        self.fails(2, "classify", self.folder / "a.ply", "--model", "no-such-model",
                   naming="no-such-model")

    def test_reading_stops_at_once(self):
        text = self.folder / "a.xyz"
        text.write_bytes(b"0.123456 1.234567 2.345678\n" * 5_000_000)
        for arguments in (("classify", text), ("convert", text, "-o", self.folder / "a.ply"),
                          ("describe", text, "-o", self.folder / "a.npy")):
            running = subprocess.Popen([PROGRAM, *map(str, arguments), "--threads", "1"], stderr=subprocess.PIPE, text=True,
                                       preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (1, 1)))
            while not has_open(running, text):
                self.assertIsNone(running.poll())
            running.send_signal(signal.SIGINT)  # to read all would take more than a second
            self.assertIn("stopped by the user", running.communicate(timeout=60)[1])
            self.assertEqual(running.returncode, 130)
        self.assertEqual(os.listdir(self.folder), ["a.xyz"])

    def test_what_is_printed_and_lost_is_an_error(self):
        write_ply(self.folder / "a.ply", *cube(500))
        for arguments in (("info", "a.ply"), ("info", "a.ply", "--json", "-"), ("--help",), ("--version",)):
            with open("/dev/full", "w") as full:
                done = subprocess.run([PROGRAM, *arguments], stdout=full, stderr=subprocess.PIPE,
                                      text=True, cwd=self.folder)
            self.assertEqual(done.returncode, 1, arguments)
            self.assertIn("standard output: No space left on device", done.stderr)

    def test_work_goes_on_when_nobody_reads_the_messages(self):
        write_ply(self.folder / "a.ply", *cube(500))
        for close, arguments, expect in ((True, ("info", "a.ply", "none.ply"), 3), (True, ("classify", "a.ply"), 0),
                                         (False, ("classify", "a.ply", "--overwrite", "--progress", "plain"), 0)):
            unread, messages = os.pipe()
            os.close(unread)
            done = subprocess.run([PROGRAM, *arguments], stdout=subprocess.DEVNULL, stderr=messages, cwd=self.folder,
                                  preexec_fn=(lambda: os.close(2)) if close else None)
            os.close(messages)
            self.assertEqual(done.returncode, expect, arguments)
        self.assertTrue((self.folder / "a_edges.ply").exists())

    def test_a_full_disk_leaves_nothing_half_written(self):
        write_ply(self.folder / "a.ply", *cube(20000)[:2])
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))
        self.fails(1, "classify", self.folder / "a.ply", naming="a_edges.ply", preexec_fn=limit)
        self.assertEqual(os.listdir(self.folder), ["a.ply"])


if __name__ == "__main__":
    unittest.main()
