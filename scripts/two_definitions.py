#!/usr/bin/python3
"""What counts as an edge is what you paint: the same part, fewer than 200 painted points, two meanings.

Makes the part fandisk_0 of `pcednet generate default`, paints small spots of it as a brush would,
trains on them alone and draws what is found: sharp edges only, then smooth edges and chamfers too.

    scripts/two_definitions.py build/release/bin/pcednet docs/images
"""

import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

import numpy

UNLABELLED = 255
FLAT, SMOOTH, SHARP, BESIDE = 0, 1, 2, 3  # beside a sharp edge: neither painted nor scored
SPOTS = 20  # of each kind, three points at most each


def read_ply(path):
    """Header lines and the points, as a structured array; binary little-endian only."""
    types = {"double": "<f8", "float": "<f4", "uchar": "u1", "int": "<i4"}
    data = path.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    lines = data[:end].decode().splitlines()
    fields = [line.split()[1:] for line in lines if line.startswith("property")]
    dtype = numpy.dtype([(name, types[kind]) for kind, name in fields])
    return lines, numpy.frombuffer(data[end:], dtype).copy()


def write_ply(path, lines, points):
    path.write_bytes(("\n".join(lines) + "\n").encode() + points.tobytes())


def nearest(positions, others):
    """Distance of each position to the nearest of others, in slices that fit into memory."""
    parts = [numpy.linalg.norm(part[:, None] - others[None], axis=2).min(axis=1)
             for part in numpy.array_split(positions, max(1, len(positions) // 200))]
    return numpy.concatenate(parts)


def spots(positions, kinds, spacing, seed):
    """Small balls about points of each kind, within which all points are of that kind."""
    random = numpy.random.default_rng(seed)
    chosen = []
    for kind in (FLAT, SMOOTH, SHARP):
        taken = 0
        for centre in random.permutation(numpy.flatnonzero(kinds == kind)):
            near = numpy.linalg.norm(positions - positions[centre], axis=1) < 1.2 * spacing
            if taken == SPOTS:
                break
            if (kinds[near] == kind).all():
                chosen.append(numpy.flatnonzero(near)[:3])
                taken += 1
    return numpy.concatenate(chosen)


def write_png(path, pixels):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    height, width, _ = pixels.shape
    rows = numpy.concatenate([numpy.zeros((height, 1), numpy.uint8), pixels.reshape(height, -1)], axis=1)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
                     + chunk(b"IDAT", zlib.compress(rows.tobytes(), 9)) + chunk(b"IEND", b""))


def draw(positions, normals, edge, painted, towards):
    """The points seen from one side, nearest last: edges dark red, painted points with a blue rim."""
    towards = towards / numpy.linalg.norm(towards)
    axis = numpy.linalg.svd(numpy.cov((positions - positions @ towards[:, None] * towards).T))[0][:, 0]
    across = positions @ axis
    down = positions @ numpy.cross(axis, towards)
    scale = 860 / numpy.ptp(across)
    column = ((across - across.min()) * scale + 20).astype(int)
    row = ((down - down.min()) * scale + 20).astype(int)
    light = 0.35 + 0.65 * numpy.abs(normals @ (towards + 0.3 * axis)) / numpy.linalg.norm(towards + 0.3 * axis)
    colours = numpy.where(edge[:, None], numpy.array([168, 0, 0]), 225) * light[:, None]
    pixels = numpy.full((row.max() + 20, 900, 3), 255, numpy.uint8)
    depth = positions @ towards
    disc = [(y, x) for y in range(-3, 4) for x in range(-3, 4) if x * x + y * y <= 10]
    cells = numpy.concatenate([(row + y) * 900 + column + x for y, x in disc])
    order = numpy.argsort(numpy.tile(depth, len(disc)), kind="stable")
    pixels.reshape(-1, 3)[cells[order]] = numpy.tile(colours, (len(disc), 1))[order]
    nearest_depth = numpy.full(pixels.shape[0] * 900, -numpy.inf)
    nearest_depth[cells[order]] = numpy.tile(depth, len(disc))[order]
    nearest_depth = nearest_depth.reshape(pixels.shape[:2])
    for i in painted:
        if depth[i] > nearest_depth[row[i], column[i]] - 0.02 * numpy.ptp(across):
            pixels[row[i] - 3: row[i] + 4, column[i] - 3: column[i] + 4] = [31, 120, 209]
            pixels[row[i] - 2: row[i] + 3, column[i] - 2: column[i] + 3] = colours[i]
    return pixels


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])

    def pcednet(*words):
        subprocess.run([program, *map(str, words)], check=True)

    with tempfile.TemporaryDirectory() as name:
        work = pathlib.Path(name)
        pcednet("generate", "default", work / "clouds")
        lines, points = read_ply(work / "clouds" / "fandisk_0.ply")
        positions = numpy.stack([points[axis] for axis in "xyz"], axis=1).astype(float)
        normals = numpy.stack([points[axis] for axis in ("nx", "ny", "nz")], axis=1).astype(float)
        sample = positions[:: len(positions) // 200]
        spacing = 2 * numpy.median([numpy.partition(numpy.linalg.norm(positions - p, axis=1), 1)[1] for p in sample])
        kinds = points["label"].copy()
        smooth = numpy.flatnonzero(kinds == SMOOTH)
        kinds[smooth[nearest(positions[smooth], positions[kinds == SHARP]) < 4 * spacing]] = BESIDE
        painted = spots(positions, kinds, spacing, seed=1)
        for title, edges in (("sharp_only", (SHARP,)), ("smooth_too", (SHARP, SMOOTH))):
            points["label"] = UNLABELLED
            points["label"][painted] = numpy.where(numpy.isin(kinds[painted], edges), 2, 0)
            write_ply(work / f"{title}.ply", lines, points)
            model = work / f"{title}.safetensors"
            pcednet("train", work / f"{title}.ply", "-o", model, "--classes", 2)
            picture = folder / f"{title}.png"
            pcednet("classify", work / f"{title}.ply", "--model", model, "-o", work / f"{title}_edges.ply")
            _, found = read_ply(work / f"{title}_edges.ply")
            said = found["scalar_edge_class"] == 2
            write_png(picture, draw(positions, normals, said, painted, normals[kinds == SMOOTH].mean(axis=0)))
            shares = [100 * said[kinds == kind].mean() for kind in (FLAT, SMOOTH, SHARP)]
            print("{}: {} points painted; edge are {:.1f} % of the flat, {:.1f} % of the smooth edges and chamfers, "
                  "{:.1f} % of the sharp edges".format(picture, len(painted), *shares))


if __name__ == "__main__":
    main()
