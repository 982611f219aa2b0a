#!/usr/bin/python3
"""Writes a scene larger than `pcednet generate` makes: a cube, a sphere and a ridged ground, with normals.

    bench/large_scene.py scene.ply [POINTS]
"""
import sys

import numpy as np


def cube(n, random):
    face = random.integers(0, 6, n)
    p = random.uniform(-0.5, 0.5, (n, 3))
    normals = np.zeros((n, 3))
    rows = np.arange(n)
    normals[rows, face // 2] = np.where(face % 2 == 1, 1, -1)
    p[rows, face // 2] = 0.5 * normals[rows, face // 2]
    return p + [-0.8, 0, 0.5], normals


def sphere(n, random):
    normals = random.normal(size=(n, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return 0.6 * normals + [0.8, 0, 0.6], normals


def ridges(n, random):
    """Ground that goes up and down along x, eight times, in straight slopes."""
    p = np.column_stack([random.uniform(-2, 2, n), random.uniform(-1.5, 1.5, n), np.zeros(n)])
    along = p[:, 0] * 2 % 1
    p[:, 2] = 0.25 * np.minimum(along, 1 - along) - 0.125
    slope = np.where(along < 0.5, 0.5, -0.5)
    normals = np.column_stack([-slope, np.zeros(n), np.ones(n)]) / np.sqrt(1.25)
    return p, normals


def main():
    points = int(sys.argv[2]) if len(sys.argv) > 2 else 10_000_000
    random = np.random.default_rng(1)
    shares = (points // 3, points // 3, points - 2 * (points // 3))
    parts = [make(n, random) for make, n in zip((cube, sphere, ridges), shares)]
    rows = np.concatenate([np.hstack(part) for part in parts]).astype("<f4")
    names = "".join(f"property float {a}\n" for a in ("x", "y", "z", "nx", "ny", "nz"))
    with open(sys.argv[1], "wb") as file:
        file.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {points}\n{names}"
                   "end_header\n".encode())
        rows[random.permutation(points)].tofile(file)


if __name__ == "__main__":
    main()
