#!/usr/bin/python3
"""Lines of a part as a fused scan or a remeshed volume: the vertices of marching cubes.

    bench/fused_part.py [--pcednet PROGRAM] [PITCH BLUR NOISE]...

The scores have a line for sharp edges and one for sharp and rounded ones. The part is a bracket of 100 by 60 by 50 with bores, counterbores, a pocket and a boss. Its signed distance is
sampled at a pitch, blurred by a Gaussian (which rounds edges), and given smooth noise, both in pitches.
"""
import argparse
import pathlib
import subprocess
import tempfile

import numpy as np
from scipy.ndimage import gaussian_filter

DEFAULTS = [(1, 0, 0), (1, .45, 0), (1, .7, 0), (1, .7, .001), (1, .7, .03), (1, .7, .1), (1, 1.2, .1)]
LOW, HIGH = np.array([-3.] * 3), np.array([103., 63, 53])
SCREWS, POCKET, BOSS = [(30, 12), (30, 48)], [(40, 20, 5), (55, 40, 12)], (75, 30)


def distances(x, y, z):
    """Of points to the part, negative inside."""
    def box(low, high):
        return np.max([np.maximum(a - c, c - b) for a, b, c in zip(low, high, (x, y, z))], axis=0)

    def cylinder(u, v, centre, radius, w, low, high):
        return np.maximum(np.hypot(u - centre[0], v - centre[1]) - radius, np.maximum(low - w, w - high))

    part = np.minimum(box((0, 0, 0), (100, 60, 10)), box((0, 0, 0), (10, 60, 50)))
    part = np.minimum(part, cylinder(x, y, BOSS, 15, z, 5, 30))
    holes = [cylinder(x, y, BOSS, 8, z, -5, 40), cylinder(y, z, (30, 30), 8, x, -5, 15), box(*POCKET)]
    for screw in SCREWS:
        holes += [cylinder(x, y, screw, 6, z, -5, 20), cylinder(x, y, screw, 9, z, 6, 20)]
    for hole in holes:
        part = np.maximum(part, -hole)
    return part


def vertices(distance, pitch):
    """Where the edges of the grid cross the surface."""
    found = []
    for axis in range(3):
        near, far = (np.take(distance, range(k, distance.shape[axis] - 1 + k), axis) for k in (0, 1))
        at = np.argwhere((near < 0) != (far < 0))
        near, far = near[tuple(at.T)], far[tuple(at.T)]
        place = at.astype(float)
        place[:, axis] += near / (near - far)
        found.append(LOW + pitch * place)
    return np.vstack(found)


def true_edges():
    """The edges as polylines."""
    def rim(corners):
        return [[a, b] for a, b in zip(corners, corners[1:] + corners[:1])]

    def rectangle(low, high, z):
        return rim([(low[0], low[1], z), (high[0], low[1], z), (high[0], high[1], z), (low[0], high[1], z)])

    def circle(centre, radius, z):
        turns = np.linspace(0, 2 * np.pi, 181)
        return np.c_[centre[0] + radius * np.cos(turns), centre[1] + radius * np.sin(turns), np.full(181, z)]

    edges = [[(100, 0, z), (100, 60, z)] for z in (0, 10)] + [[(10, 0, 10), (10, 60, 10)], [(0, 0, 0), (0, 60, 0)]]
    edges += [[(x, 0, 50), (x, 60, 50)] for x in (0, 10)]
    for y in (0, 60):
        profile = [(0, 0), (100, 0), (100, 10), (10, 10), (10, 50), (0, 50)]
        edges += rim([(x, y, z) for x, z in profile])
    for z in (POCKET[0][2], 10):
        edges += rectangle(*POCKET, z)
    edges += [[(x, y, POCKET[0][2]), (x, y, 10)] for x in (40, 55) for y in (20, 40)]
    edges += [circle(BOSS, r, z) for r, z in ((15, 10), (15, 30), (8, 30), (8, 0))]
    edges += [circle(screw, r, z) for screw in SCREWS for r, z in ((6, 0), (6, 6), (9, 6), (9, 10))]
    edges += [circle((30, 30), 8, x)[:, [2, 0, 1]] for x in (0, 10)]
    return edges


def write(folder, points):
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n"
    head += "".join(f"property float {name}\n" for name in "xyz") + "end_header\n"
    (folder / "part.ply").write_bytes(head.encode() + points.astype("<f4").tobytes())
    lines, count = [], 0
    for edge in true_edges():
        lines += ["v %g %g %g" % tuple(p) for p in edge]
        lines.append("l " + " ".join(str(count + i + 1) for i in range(len(edge))))
        count += len(edge)
    (folder / "true.obj").write_text("\n".join(lines) + "\n")


def print_scores(pcednet, points, all_classes):
    """Of the lines of these classes."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write(folder, points)
        for classes in all_classes:
            subprocess.run([pcednet, "lines", folder / "part.ply", "-o", folder / f"{classes}.obj", "--class", classes,
                            "--progress", "none"], check=True, capture_output=True)
            scores = subprocess.run([pcednet, "evaluate", folder / f"{classes}.obj", "--truth", folder / "true.obj"],
                                    check=True, capture_output=True, text=True).stdout
            print("\n".join(scores.splitlines()[classes != "sharp":2]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pcednet", default=pathlib.Path(__file__).parents[1] / "build/release/bin/pcednet")
    parser.add_argument("numbers", nargs="*", type=float)
    arguments = parser.parse_args()
    cases = list(zip(*[iter(arguments.numbers)] * 3)) or DEFAULTS
    for pitch, blur, noise in cases:
        random = np.random.default_rng(3)
        grid = np.meshgrid(*(np.arange(a, b, pitch) for a, b in zip(LOW, HIGH)), indexing="ij")
        distance = distances(*grid)
        if blur:
            distance = gaussian_filter(np.clip(distance, -4 * pitch, 4 * pitch), blur)
        if noise:
            bumps = gaussian_filter(random.standard_normal(distance.shape), 2.5)
            distance += noise * pitch * bumps / bumps.std()
        points = vertices(distance, pitch)
        print(f"pitch {pitch:g}, blurred by {blur:g}, noise {noise:g} pitches: {len(points)} points")
        print_scores(arguments.pcednet, random.permutation(points), ["sharp", "sharp,smooth"])


if __name__ == "__main__":
    main()
