"""What the tests of `pcednet tiles` share: a cloud of boxes, plans of it, and comparisons."""
import json
import shutil

import numpy as np

from support import CliTest, read_ply, run, write_ply


def field(columns=4, points=2000, seed=1, normals=True):
    """Boxes of different sizes on rough ground: positions, normals."""
    random_numbers = np.random.default_rng(seed)
    p, n = [], []
    for x in range(columns):
        for y in range(columns):
            size = random_numbers.uniform(0.4, 0.8, 3)
            face = random_numbers.choice([0, 1, 2, 3, 5], points)  # without the underside
            axis, side = face // 2, np.where(face % 2 == 1, 0.5, -0.5)
            q = random_numbers.uniform(-0.5, 0.5, (points, 3))
            m = np.zeros((points, 3))
            q[np.arange(points), axis] = side
            m[np.arange(points), axis] = 2 * side
            p.append(q * size + (x, y, 0.5 * size[2]))
            n.append(m)
    ground = random_numbers.uniform(-0.6, columns - 0.4, (columns * columns * points, 3))
    ground[:, 2] = 0.0
    p.append(ground)
    n.append(np.tile([0.0, 0.0, 1.0], (len(ground), 1)))
    p = np.concatenate(p) + 0.001 * random_numbers.normal(size=(2 * len(ground), 3))
    return p.astype(np.float32), np.concatenate(n) if normals else None


def stairs(steps=10):
    """Steps up and down, 6 by 3, with noise of twice the spacing: 21,600 points each, .05 apart."""
    random_numbers = np.random.default_rng(3)
    along, y = (random_numbers.uniform(0, size, 21_600 * steps) for size in (9 * steps, 6))
    step, rest = np.divmod(along, 9)  # a tread, then a riser
    rise = np.maximum(rest - 6, 0)
    p = np.column_stack([6 * step + np.minimum(rest, 6), y, np.where(step % 2 == 0, rise, 3 - rise)])
    return p + 0.1 * random_numbers.normal(size=p.shape)


def sorted_rows(path, names=("x", "y", "z")):
    """The chosen columns of all points, in an order free of that in the file."""
    rows, _ = read_ply(path)
    order = np.lexsort([rows[name] for name in names])
    return rows[order]


class TilesTest(CliTest):
    def make_plan(self, cloud, *options, tile=1.3):
        plan = self.folder / "p.json"
        plan.unlink(missing_ok=True)
        shutil.rmtree(self.folder / "p_tiles", ignore_errors=True)
        run("tiles", "plan", cloud, "-o", plan, "--tile", tile, *options)
        return plan, json.loads(plan.read_text())

    def status(self, plan, *options):
        return json.loads(run("tiles", "status", plan, "--json", "-", *options).stdout)

    def small(self, tile=1.4):
        """A plan of nine tiles, by default, that run quickly."""
        p, n = field(3, 300)
        write_ply(self.folder / "small.ply", p, n)
        return self.make_plan(self.folder / "small.ply", tile=tile)

    def check_whole(self, plan, cloud):
        """Joins, and compares the points with the input's: none lost, none doubled."""
        joined = self.folder / "joined.ply"
        run("tiles", "join", plan, "-o", joined, "--overwrite")
        rows, names = sorted_rows(joined), ("x", "y", "z")
        expected = sorted_rows(cloud)
        self.assertEqual(len(rows), len(expected))
        for name in names:
            np.testing.assert_array_equal(rows[name], expected[name])
        return rows

    def check_equal_to_untiled(self, cloud, least, *options, jobs=1, tile=1.3):
        """Returns what classify says."""
        plan, content = self.make_plan(cloud, *options, tile=tile)
        self.assertGreaterEqual(len(content["tiles"]), 9)
        run("tiles", "run", plan, "--jobs", jobs)
        rows = self.check_whole(plan, cloud)
        said = run("classify", cloud, "-o", self.folder / "whole.ply", "--overwrite", *options).stderr
        whole = sorted_rows(self.folder / "whole.ply")
        self.assertEqual(rows.dtype, whole.dtype)
        equal = np.mean(rows["scalar_edge_class"] == whole["scalar_edge_class"])
        self.assertGreaterEqual(equal, least)
        self.assertGreater(np.mean(whole["scalar_edge_class"] == 2), 0.02)
        return said
