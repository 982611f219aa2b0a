"""Share of the labels of a cloud that its crops of few points keep.

PYTHONPATH=build/release/python /usr/bin/python3 bench/crops.py FILE... [--points 1000 2000 3000] [--crops N]
                                                                        [--model MODEL]

From each cloud, takes N crops of each number of points around random ones, in turns a ball and a vertical column of
square section, without normals, and compares their labels by MODEL with those of the whole by `general`. The last
column is the largest share of edges in a crop.
"""

import pathlib

import numpy as np

import pcednet
from each_file import each_file


def crop(xyz, points, is_ball, random):
    """The indices of so many points nearest to a random one."""
    offset = np.abs(xyz - xyz[random.integers(len(xyz))])
    reach = (offset**2).sum(axis=1) if is_ball else offset[:, :2].max(axis=1)
    return np.argpartition(reach, points)[:points]


def measure(path, options):
    xyz = pcednet.read(path).xyz
    xyz = np.unique(xyz[np.isfinite(xyz).all(axis=1)], axis=0)
    whole = pcednet.classify(xyz).labels
    random = np.random.default_rng(7)
    kept, most, edges_of_whole = [], 0.0, 0.0
    for number in range(options.crops):
        for points in options.points:
            inside = crop(xyz, points, number % 2 == 0, random)
            labels = pcednet.classify(xyz[inside], model=options.model).labels
            kept.append((labels == whole[inside]).mean())
            edges = np.isin(labels, (1, 2)).mean()
            if edges > most:
                most, edges_of_whole = edges, np.isin(whole[inside], (1, 2)).mean()
    print(f"{pathlib.Path(path).name:32s} kept {np.mean(kept):.3f}   most edges {most:.2f}, "
          f"in the whole {edges_of_whole:.2f}")


if __name__ == "__main__":
    each_file(__doc__, measure, {
        "--points": {"type": int, "nargs": "+", "default": [1000, 2000, 3000]},
        "--crops": {"type": int, "default": 10},
    })
