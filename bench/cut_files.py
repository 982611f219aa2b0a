"""Share of labels that stay when a cloud is cut into files with a halo of the largest scale.

PYTHONPATH=build/release/python /usr/bin/python3 bench/cut_files.py FILE... [--cuts N] [--no-normals] [--model MODEL]

Cuts each cloud into N x N files along the two longest sides of its box, classifies each alone, and compares the labels
of the points inside the cuts with those of the whole: with the scales of the whole given, and with the file's own.
Normals are estimated before cutting, or with --no-normals by each file.
"""

import itertools
import pathlib

import numpy as np

import pcednet
from each_file import each_file


def pieces_of(xyz, cuts, halo):
    """For each piece, whether points are inside it, and whether they are at most `halo` beyond it."""
    low, extent = xyz.min(axis=0), np.ptp(xyz, axis=0)
    sides = np.argsort(-extent)[:2]
    size = extent[sides] / cuts
    place = (xyz[:, sides] - low[sides]) / size
    cell = np.minimum(place.astype(int), cuts - 1)
    for corner in itertools.product(range(cuts), repeat=2):
        inside = (cell == corner).all(axis=1)
        if inside.any():
            yield inside, (np.abs(place - corner - 0.5) <= 0.5 + halo / size).all(axis=1)


def measure(path, options):
    cloud = pcednet.read(path)
    xyz, normals = cloud.xyz, cloud.normals
    finite = np.isfinite(xyz).all(axis=1)
    xyz = xyz[finite]
    normals = pcednet.estimate_normals(xyz) if normals is None else normals[finite]
    if options.no_normals:
        normals = None
    whole = pcednet.classify(xyz, normals, model=options.model)
    s_min, s_max = whole.scales
    kept, points = {"given": 0, "own": 0}, 0
    for inside, near in pieces_of(xyz, options.cuts, s_max):
        points += inside.sum()
        for name, scales in (("given", {"s_min": s_min, "s_max": s_max}), ("own", {})):
            piece = pcednet.classify(xyz[near], normals if normals is None else normals[near], model=options.model,
                                     **scales)
            kept[name] += (piece.labels[inside[near]] == whole.labels[inside]).sum()
    shares = "   ".join(f"{name} scales {count / points:.4f}" for name, count in kept.items())
    print(f"{pathlib.Path(path).name:32s} {options.cuts} x {options.cuts}   {shares}")


if __name__ == "__main__":
    each_file(__doc__, measure, {
        "--cuts": {"type": int, "default": 4},
        "--no-normals": {"action": "store_true"},
    })
