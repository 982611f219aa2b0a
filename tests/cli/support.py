"""What the tests of the command line share: running the program, reading and writing small clouds."""
import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

PROGRAM = os.environ["PCEDNET"]
SOURCE = pathlib.Path(os.environ["PCEDNET_SOURCE_DIR"])


def run(*arguments, expect=0, **options):
    """Runs pcednet and returns the finished process; fails unless it exits with `expect`."""
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                          timeout=300, **options)
    if done.returncode != expect:
        raise AssertionError(f"exit {done.returncode} instead of {expect}: pcednet "
                             f"{' '.join(map(str, arguments))}\n{done.stdout}\n{done.stderr}")
    return done


def cube(points=4000, seed=1, noise=0.0):
    """A unit cube: positions, outward normals, labels by the distance to its edges."""
    random = np.random.default_rng(seed)
    face = random.integers(0, 6, points)
    axis, side = face // 2, np.where(face % 2 == 1, 0.5, -0.5)
    p = random.uniform(-0.5, 0.5, (points, 3))
    n = np.zeros((points, 3))
    p[np.arange(points), axis] = side
    n[np.arange(points), axis] = 2 * side
    away = np.sort(0.5 - np.abs(p), axis=1)[:, 1]  # 0 on an edge
    label = np.where(away < 0.02, 2, np.where(away < 0.06, 1, 0)).astype(np.uint8)
    return p + noise * random.normal(size=p.shape), n, label


def rough_ground(points=3000, seed=1):
    """A unit square of rough ground: positions."""
    random = np.random.default_rng(seed)
    return np.column_stack([random.uniform(0.0, 1.0, (points, 2)), 0.03 * random.normal(size=points)])


def sheet(points=3000, seed=1):
    """A unit square, open all around: positions, normals, distances to its rim in spacings."""
    p = np.random.default_rng(seed).uniform(0.0, 1.0, (points, 3)) * (1.0, 1.0, 0.0)
    rim = np.minimum(p[:, :2], 1.0 - p[:, :2]).min(axis=1) * np.sqrt(points)
    return p, np.tile([0.0, 0.0, 1.0], (points, 1)), rim


def write_ply(path, positions, normals=None, labels=None, position_type="float", comments=(), **more):
    """A binary PLY as any program might write it; `more` are attributes in float."""
    fields = [(a, "<f8" if position_type == "double" else "<f4") for a in "xyz"]
    lines = [f"property {position_type} {a}" for a in "xyz"]
    if normals is not None:
        fields += [(a, "<f4") for a in ("nx", "ny", "nz")]
        lines += [f"property float {a}" for a in ("nx", "ny", "nz")]
    if labels is not None:
        fields.append(("label", "u1"))
        lines.append("property uchar label")
    fields += [(name, "<f4") for name in more]
    lines += [f"property float {name}" for name in more]
    rows = np.zeros(len(positions), fields)
    for i, a in enumerate("xyz"):
        rows[a] = positions[:, i]
        if normals is not None:
            rows["n" + a] = normals[:, i]
    if labels is not None:
        rows["label"] = labels
    for name, values in more.items():
        rows[name] = values
    header = "\n".join(["ply", "format binary_little_endian 1.0", *(f"comment {text}" for text in comments),
                        f"element vertex {len(rows)}", *lines, "end_header", ""])
    pathlib.Path(path).write_bytes(header.encode() + rows.tobytes())


TYPES = {"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4",
         "float": "f4", "double": "f8"}


def write_own(path, positions, normals, labels, names=("ground", "wall", "pipe")):
    """A PLY file whose labels are of own classes."""
    write_ply(path, positions, normals, labels)
    table = "".join(f"comment pcednet class {id} #{id}0a0b0 {its}\n" for id, its in enumerate(names))
    path.write_bytes(path.read_bytes().replace(b"element vertex", table.encode() + b"element vertex", 1))
    return path


def read_ply(path):
    """The vertices of a binary little-endian PLY as a numpy record array, and its header lines."""
    data = pathlib.Path(path).read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    header = data[:end].decode().splitlines()
    count, fields = 0, []
    for line in header:
        words = line.split()
        if words[0] == "element" and words[1] != "vertex":
            break
        if words[0] == "element":
            count = int(words[2])
        if words[0] == "property":
            fields.append((words[2], "<" + TYPES[words[1]]))
    return np.frombuffer(data, np.dtype(fields), count, end), header


class CliTest(unittest.TestCase):
    """A test with a folder of its own."""

    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self._folder.name)

    def tearDown(self):
        self._folder.cleanup()

    def path(self, name):
        return self.folder / name
