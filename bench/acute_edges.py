"""How well edges are found whose faces meet at an acute angle.

PYTHONPATH=build/release/python /usr/bin/python3 bench/acute_edges.py [--model MODEL] [--points N]

Wedges of two unit squares that meet at an angle, with the normals of their faces, turned at random; noise is in
spacings. Of the points up to half a spacing from the edge and two or more from its ends: the share that is an edge,
and sharp-edge; of those .6 to 1.4 from it, and 2.5 to half the face: the share that is an edge.
"""

import argparse
import warnings

import numpy as np
from scipy.spatial.transform import Rotation

import pcednet


def wedge(angle, points, noise, random):
    """Positions, normals, spacing, and every point's place along the edge and distance to it."""
    side = np.where(np.arange(points) % 2 == 0, 1.0, -1.0)
    place, away = random.random(points), random.random(points)
    c, s = np.cos(angle / 2), np.sin(angle / 2)
    xyz = np.stack([place, away * c, away * s * side], axis=1)
    normals = np.stack([np.zeros(points), np.full(points, -s), c * side], axis=1)
    spacing = np.sqrt(2.0 / points)
    xyz += noise * spacing * random.normal(size=xyz.shape)
    turn = Rotation.random(random_state=3).as_matrix()
    return xyz @ turn.T, normals @ turn.T, spacing, place, away


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--model", default="general")
    parser.add_argument("--points", type=int, default=100000)
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    for noise in (0.0, 0.3, 0.5):
        for angle in (15, 20, 30, 45, 60, 70, 75, 90):
            xyz, normals, spacing, place, away = wedge(np.radians(angle), options.points, noise,
                                                       np.random.default_rng(7))
            labels = pcednet.classify(xyz, normals, model=options.model, boundary=False).labels
            inner = (place > 2 * spacing) & (place < 1 - 2 * spacing)
            edge = np.isin(labels, (1, 2))
            near = inner & (away < 0.5 * spacing)
            band = inner & (away > 0.6 * spacing) & (away < 1.4 * spacing)
            far = inner & (away > 2.5 * spacing) & (away < 0.5)
            print(f"noise {noise:.1f}  {angle} degrees  edge {edge[near].mean():.3f}  sharp {(labels[near] == 2).mean():.3f}  "
                  f"beside it {edge[band].mean():.3f}  elsewhere {edge[far].mean():.4f}")


if __name__ == "__main__":
    main()
