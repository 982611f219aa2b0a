#!/usr/bin/python3
"""Writes a city as an aeroplane sees it, of any size: LAS files of a million points, each made alone.

    bench/large_city.py FOLDER [MILLIONS]

Ground, houses with flat and gable roofs, some of their walls, trees; 16 points to a square metre, 2 cm
of noise, in scan lines, without normals. Each file is a square of 250 m; ten stand side by side.
"""
import pathlib
import struct
import sys

import numpy as np

POINTS, SIDE, CELLS = 1_000_000, 250.0, 5  # a house stands in each of 5 x 5 cells of a file
CORNER, STEP = np.array([500_000.0, 5_400_000.0, 100.0]), 0.001
POINT = np.dtype([("at", "<i4", 3), ("intensity", "<u2"), ("returns", "u1"), ("flags", "u1"), ("class", "u1"),
                  ("user", "u1"), ("angle", "<i2"), ("source", "<u2"), ("time", "<f8")])


def ground(x, y):
    return 6 * np.sin(x / 170) * np.cos(y / 230) + 0.5 * np.sin(x / 21 + y / 34)


def square(number):
    """The points of a file, relative to CORNER."""
    random = np.random.default_rng([17, number])
    left = np.array([number % 10 * SIDE, number // 10 * SIDE])
    cell = SIDE / CELLS
    houses = CELLS * CELLS
    middle = left + cell * (np.indices((CELLS, CELLS)).reshape(2, -1).T + random.uniform(0.45, 0.55, (houses, 2)))
    half = np.sort(random.uniform(4, 12, (houses, 2)), axis=1)[:, ::-1]  # the ridge runs along the longer side
    turn = random.uniform(0, np.pi, houses)
    eaves, pitch = random.uniform(3, 15, houses), np.where(random.random(houses) < 0.6, random.uniform(0.3, 1, houses), 0)
    base = ground(*middle.T)

    x, y = (left[:, None] + random.uniform(0, SIDE, (2, POINTS)))
    house = np.minimum((x - left[0]) // cell, CELLS - 1).astype(int) * CELLS + \
        np.minimum((y - left[1]) // cell, CELLS - 1).astype(int)
    c, s = np.cos(turn), np.sin(turn)
    dx, dy = x - middle[house, 0], y - middle[house, 1]
    u, v = c[house] * dx + s[house] * dy, c[house] * dy - s[house] * dx
    inside = (abs(u) < half[house, 0]) & (abs(v) < half[house, 1])
    z = np.where(inside, base[house] + eaves[house] + pitch[house] * (half[house, 1] - abs(v)), ground(x, y))

    walls = slice(0, POINTS // 16)  # a random place on the outline of a random house
    k = random.integers(0, houses, POINTS // 16)
    long_side, sign = random.random(len(k)) < half[k, 0] / half[k].sum(axis=1), random.choice([-1, 1], len(k))
    along = random.uniform(-1, 1, len(k))
    u = half[k, 0] * np.where(long_side, along, sign)
    v = half[k, 1] * np.where(long_side, sign, along)
    x[walls], y[walls] = middle[k, 0] + c[k] * u - s[k] * v, middle[k, 1] + s[k] * u + c[k] * v
    z[walls] = base[k] + random.uniform(0, 1, len(k)) * eaves[k]

    trees = slice(POINTS // 16, POINTS // 8)
    place = left + random.uniform(4, SIDE - 4, (60, 2))
    crown = random.normal(size=(3, POINTS // 16))
    crown *= random.uniform(0.7, 1, POINTS // 16) / np.linalg.norm(crown, axis=0)
    k = random.integers(0, len(place), POINTS // 16)
    x[trees], y[trees] = place[k].T + 3.5 * crown[:2]
    z[trees] = ground(x[trees], y[trees]) + 6 + 3 * crown[2]

    rows = np.column_stack([x, y, z + random.normal(0, 0.02, POINTS)])
    line = (y - left[1]) // 0.35  # the lines run to and fro
    return rows[np.lexsort([np.where(line % 2, -x, x), line])]


def write_las(path, rows):
    points = np.zeros(len(rows), POINT)
    points["at"] = np.round(rows / STEP)
    points["returns"] = 0x11
    low, high = points["at"].min(axis=0) * STEP + CORNER, points["at"].max(axis=0) * STEP + CORNER
    header = struct.pack("<4sHH16sBB32s32sHHHIIBHI20s", b"LASF", 0, 16, b"", 1, 4, b"", b"large_city.py", 1, 2026,
                         375, 375, 0, 6, POINT.itemsize, 0, b"")
    header += struct.pack("<12d", STEP, STEP, STEP, *CORNER, *np.column_stack([high, low]).ravel())
    header += struct.pack("<QQIQ15Q", 0, 0, 0, len(rows), len(rows), *[0] * 14)
    path.write_bytes(header + points.tobytes())


def main():
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for number in range(int(sys.argv[2]) if len(sys.argv) > 2 else 10):
        write_las(folder / f"{number:05}.las", square(number))


if __name__ == "__main__":
    main()
