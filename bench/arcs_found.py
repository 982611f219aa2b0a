#!/usr/bin/python3
"""How many of the true arcs and circles `pcednet lines` draws as such, by their length:

    bench/lines_scores.sh parts/ 7 && bench/arcs_found.py parts/

Found: one drawn arc or circle lies within a spacing of four fifths of the true one.
"""
import pathlib
import sys

import numpy as np

STEP = 0.3  # of samples along curves, in spacings
BOUNDS = [20, np.inf], [10, 20], [4, 10], [0, 4]  # lengths in spacings


def read_round_curves(path):
    """The corners of every arc and circle of an OBJ file of pcednet."""
    vertices, kind, curves = [], "", []
    for line in path.read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append([float(word) for word in words[1:4]])
        elif words[:1] == ["#"] and len(words) > 2:
            kind = words[2].rstrip(",")
        elif words[:1] == ["l"] and kind in ("arc", "circle") and len(words) > 4:
            curves.append([int(word) - 1 for word in words[1:]])
    return [np.array(vertices)[corners] for corners in curves]


def sampled(corners, step):
    parts = []
    for a, b in zip(corners[:-1], corners[1:]):
        count = max(1, int(np.ceil(np.linalg.norm(b - a) / step)))
        parts.append(a + (b - a) * ((np.arange(count) + 0.5) / count)[:, None])
    return np.concatenate(parts)


def radius_of(corners):
    offsets = corners - corners.mean(0)
    plane = offsets @ np.linalg.svd(offsets)[2][:2].T
    system = np.c_[2 * plane, np.ones(len(plane))]
    x, y, rest = np.linalg.lstsq(system, (plane**2).sum(1), rcond=None)[0]
    return np.sqrt(rest + x * x + y * y)


def spacing_of(path):
    """From the tenth nearest neighbours of some points of a binary PLY of floats and one label."""
    head, body = path.read_bytes().split(b"end_header\n", 1)
    types = {b"float": "<f4", b"double": "<f8", b"uchar": "u1"}
    words = [line.split() for line in head.splitlines()]
    row = [(w[2].decode(), types[w[1]]) for w in words if w[0] == b"property"]
    cloud = np.frombuffer(body, row)
    points = np.c_[cloud["x"], cloud["y"], cloud["z"]].astype(float)
    tenth = [np.partition(((points - p) ** 2).sum(1), 10)[10] for p in points[::100]]
    return np.sqrt(np.median(tenth) * np.pi / 10)


def main():
    rows = []  # length, whether found, error of the radius: in spacings
    for folder in map(pathlib.Path, sys.argv[1:]):
        for path in sorted((folder / "lines/clean").glob("*.obj")):
            spacing = spacing_of(folder / f"{path.stem}.ply")
            drawn = read_round_curves(path)
            samples = [sampled(corners, STEP * spacing) for corners in drawn]
            for corners in read_round_curves(folder / "curves" / path.name):
                true = sampled(corners, STEP * spacing)
                errors = [np.inf]
                for other, near in zip(drawn, samples):
                    far = np.linalg.norm(true[:, None] - near[None], axis=2).min(1)
                    if np.mean(far < spacing) >= 0.8:
                        errors.append(abs(radius_of(other) - radius_of(corners)) / spacing)
                length = np.linalg.norm(np.diff(corners, axis=0), axis=1).sum() / spacing
                closed = np.allclose(corners[0], corners[-1])
                rows.append((length, len(errors) > 1, min(errors) < 0.1, closed))
    rows = np.array(rows)
    print("length in spacings   true  found  radius within .1 of those found: all, circles")
    for least, most in BOUNDS:
        some = rows[(rows[:, 0] >= least) & (rows[:, 0] < most)]
        found = some[some[:, 1] > 0]
        circles = found[found[:, 3] > 0]
        shares = [np.mean(each[:, 2]) if len(each) else np.nan for each in (found, circles)]
        share = np.mean(some[:, 1]) if len(some) else np.nan
        print(f"{least:>8} to {most:<8} {len(some):>6} {share:>6.3f} {shares[0]:>6.3f} {shares[1]:>6.3f}")


main()
