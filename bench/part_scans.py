#!/usr/bin/python3
"""Lines of a part from twelve scans around it that are not quite aligned.

    bench/part_scans.py [--pcednet PROGRAM] [RAYS NOISE SHIFT]...

The bracket of fused_part.py, seen by so many rays across and as many up in each scan, with noise along the rays,
each scan moved by as much; lengths are deviations, and the bracket is 100 long.
"""
import argparse
import pathlib

import numpy as np

from fused_part import distances, print_scores

DEFAULTS = [(240, .05, 0), (240, .05, .1), (240, .05, .2), (240, .05, .3), (240, .01, .3), (240, .05, .45)]
CENTRE, AWAY, HALF_ANGLE = np.array([50, 30, 20.]), 260, .25
VIEWS = [(a, e) for a in (20, 110, 200, 290) for e in (35, -35)] + [(45, 80), (135, 5), (315, 5), (225, -80)]


def scan(azimuth, elevation, rays, noise, random):
    """Points where rays from a place on a sphere around the part meet it."""
    a, e = np.radians([azimuth, elevation])
    away = np.array([np.cos(a) * np.cos(e), np.sin(a) * np.cos(e), np.sin(e)])
    right = np.cross([0, 0, 1], away)
    right /= np.linalg.norm(right)
    across, up = np.meshgrid(*[np.linspace(-HALF_ANGLE, HALF_ANGLE, rays)] * 2, indexing="ij")
    beams = -away + across.reshape(-1, 1) * right + up.reshape(-1, 1) * np.cross(away, right)
    beams /= np.linalg.norm(beams, axis=1)[:, None]
    place, ranges, open_beams = CENTRE + AWAY * away, np.full(len(beams), 180.), np.arange(len(beams))
    for _ in range(400):  # sphere tracing
        step = distances(*(place + ranges[open_beams, None] * beams[open_beams]).T)
        ranges[open_beams] += .98 * np.maximum(step, 0)
        open_beams = open_beams[(step > 1e-9) & (ranges[open_beams] < 360)]
        if not len(open_beams):
            break
    hit = (ranges < 360) & (np.abs(distances(*(place + ranges[:, None] * beams).T)) < 1e-4)
    return place + (ranges[hit] + noise * random.standard_normal(hit.sum()))[:, None] * beams[hit]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pcednet", default=pathlib.Path(__file__).parents[1] / "build/release/bin/pcednet")
    parser.add_argument("numbers", nargs="*", type=float)
    arguments = parser.parse_args()
    for rays, noise, shift in list(zip(*[iter(arguments.numbers)] * 3)) or DEFAULTS:
        random = np.random.default_rng(4)
        scans = [scan(*view, int(rays), noise, random) for view in VIEWS]
        points = np.vstack([one + shift * random.standard_normal(3) for one in scans])
        print(f"{rays:g} rays, noise {noise:g}, moved by {shift:g}: {len(points)} points")
        print_scores(arguments.pcednet, random.permutation(points), ["sharp"])


if __name__ == "__main__":
    main()
