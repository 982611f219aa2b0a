"""pcednet.classify, describe and estimate_normals of arrays of every kind."""

import pathlib
import re
import tempfile
import unittest
import warnings

import numpy as np

import pcednet
from support import CliTest, cube, read_ply, run, sheet, write_ply

UTM = np.array([691_000.0, 5_334_000.0, 520.0])


def quietly(function, *arguments, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", pcednet.PcednetWarning)
        return function(*arguments, **options)


class NeedsGradients:
    """Refuses to be an array as a tensor of PyTorch does."""

    def __array__(self, dtype=None):
        raise RuntimeError("use detach()")


class AsOnTheCommandLine(unittest.TestCase):
    def compare(self, positions, normals, position_type, *options, **named):
        with tempfile.TemporaryDirectory() as folder:
            file, out = pathlib.Path(folder) / "in.ply", pathlib.Path(folder) / "out.ply"
            write_ply(file, positions, normals, position_type=position_type)
            run("classify", file, "-o", out, *options)
            theirs, _ = read_ply(out)
        result = quietly(pcednet.classify, positions, normals, **named)
        np.testing.assert_array_equal(result.labels, theirs["label"])
        np.testing.assert_array_equal(result.p_sharp, theirs["scalar_p_sharp"])
        np.testing.assert_array_equal(result.p_smooth, theirs["scalar_p_smooth"])
        return result

    def test_labels_and_probabilities_are_those_of_the_program(self):
        positions, normals, _ = cube(noise=0.002)
        result = self.compare(positions.astype(np.float32), normals.astype(np.float32), "float")
        self.assertGreater(result.counts["sharp-edge"], 100)

    def test_national_grids_keep_their_digits(self):
        positions = cube()[0] + UTM
        result = self.compare(positions, None, "double")
        self.assertGreater(result.counts["sharp-edge"], 100)
        self.assertTrue(result.made_normals)

    def test_options_do_what_those_of_the_program_do(self):
        positions, normals, _ = cube(noise=0.01)
        normals = normals.astype(np.float32)
        self.compare(positions, normals, "double", "--model", "scan", "--no-context",
                     "--no-boundary", "--s-min", "0.03", "--s-max", "0.3", model="scan",
                     context=False, boundary=False, s_min=0.03, s_max=0.3)
        self.compare(positions, normals, "double", "--exact", exact=True)
        normals[::3] *= -1
        self.compare(positions, normals, "double", "--keep-orientation", keep_orientation=True)

    def test_boundaries_are_found(self):
        positions, normals, rim = sheet()
        result = self.compare(positions, normals.astype(np.float32), "double")
        self.assertGreater(np.mean(result.labels[rim < 0.5] == pcednet.BOUNDARY), 0.8)

    def test_the_matrix_is_that_of_the_program(self):
        positions, normals, _ = cube(noise=0.01)
        positions[7] = np.nan
        normals = normals.astype(np.float32)
        with tempfile.TemporaryDirectory() as folder:
            file, out = pathlib.Path(folder) / "in.ply", pathlib.Path(folder) / "out.npy"
            write_ply(file, positions, normals, position_type="double")
            for options, named in [([], {}),
                                   (["--scales", 8, "--features", 28, "--gate", -0.2],
                                    {"scales": 8, "features": 28, "gate": -0.2}),
                                   (["--exact", "--reconstruction", "covariance-plane", "--s-max-ratio", 8],
                                    {"exact": True, "reconstruction": "covariance-plane", "s_max_ratio": 8})]:
                run("describe", file, "-o", out, "--overwrite", *options)
                matrix, scales = quietly(pcednet.describe, positions, normals, return_scales=True,
                                         **named)
                theirs = np.load(out)
                self.assertEqual(matrix.dtype, np.float32)
                np.testing.assert_array_equal(matrix, theirs)
                self.assertEqual(len(scales), theirs.shape[1])
                self.assertTrue((np.diff(scales) > 0).all())

    def test_normals_are_those_of_the_program(self):
        positions = cube(noise=0.005)[0]
        with tempfile.TemporaryDirectory() as folder:
            file, out = pathlib.Path(folder) / "in.ply", pathlib.Path(folder) / "out.ply"
            write_ply(file, positions, position_type="double")
            for options, named in [([], {}), (["--neighbours", 30], {"neighbours": 30})]:
                run("normals", file, "-o", out, "--overwrite", *options)
                theirs = pcednet.read(out).normals
                ours = pcednet.estimate_normals(positions, **named)
                np.testing.assert_allclose(ours, theirs, atol=1e-6)
            outwards = np.einsum("ij,ij->i", ours, positions)
            self.assertGreater(np.mean(outwards > 0), 0.99)
            inwards = pcednet.estimate_normals(positions, -ours)
            np.testing.assert_allclose(np.abs(np.einsum("ij,ij->i", ours, inwards)), 1, atol=1e-12)
            seen = pcednet.estimate_normals(positions, viewpoint=(0, 0, 9))
            self.assertTrue((np.einsum("ij,ij->i", seen, (0, 0, 9) - positions) >= 0).all())


class Layouts(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.positions, cls.normals, _ = cube(3000)
        cls.labels = pcednet.classify(cls.positions, cls.normals).labels

    def test_every_layout_gives_the_same_labels(self):
        class Points:
            def __array__(self, dtype=None):
                return Layouts.positions

        wide = np.zeros((3000, 7))
        wide[:, 2:5] = self.positions
        frozen = self.positions.copy()
        frozen.flags.writeable = False
        reversed_view = self.positions[::-1].copy()[::-1]
        shifted = np.frombuffer(b"?" + self.positions.tobytes(), np.uint8)[1:].view(np.float64)
        for name, xyz in {"list": self.positions.tolist(), "rows": list(self.positions),
                          "columns of a table": wide[:, 2:5], "read-only": frozen,
                          "Fortran order": np.asfortranarray(self.positions),
                          "reversed": reversed_view, "big-endian": self.positions.astype(">f8"),
                          "unaligned": shifted.reshape(-1, 3), "__array__": Points(),
                          "masked": np.ma.masked_array(self.positions),
                          "Cloud": pcednet.Cloud(self.positions)}.items():
            with self.subTest(name):
                result = pcednet.classify(xyz, self.normals)
                np.testing.assert_array_equal(result.labels, self.labels)

    def test_plain_float64_is_not_copied(self):
        from pcednet import _arrays
        self.assertIs(_arrays.vectors(self.positions, "xyz"), self.positions)
        cloud = pcednet.Cloud(self.positions, self.normals)
        self.assertIs(cloud.xyz, self.positions)
        result = pcednet.classify(self.positions, self.normals)
        self.assertFalse(result.made_normals)
        for values in (result.labels, result.p_sharp, result.p_smooth):
            self.assertIsNotNone(values.base)  # the library's own memory
            values[0] = 0                      # which may be written

    def test_the_order_is_that_of_the_input(self):
        order = np.random.default_rng(1).permutation(3000)
        result = pcednet.classify(self.positions[order], self.normals[order])
        np.testing.assert_array_equal(result.labels, self.labels[order])

    def test_flipped_normals_and_normals_of_any_length_change_nothing(self):
        for normals in (-self.normals, 3.7 * self.normals, self.normals.astype(np.float32)):
            result = pcednet.classify(self.positions, normals)
            np.testing.assert_array_equal(result.labels, self.labels)
            np.testing.assert_allclose(np.linalg.norm(result.normals, axis=1), 1, atol=1e-12)

    def test_integers_are_positions_as_well(self):
        grid = np.indices((20, 20, 20)).reshape(3, -1).T
        rim = grid[((grid == 0) | (grid == 19)).any(axis=1)].astype(np.int32)
        as_float = quietly(pcednet.classify, rim.astype(np.float64))
        np.testing.assert_array_equal(quietly(pcednet.classify, rim).labels, as_float.labels)

    def test_points_that_are_not_finite_are_unlabelled(self):
        positions = self.positions.copy()
        positions[[0, 9], [1, 2]] = np.nan, np.inf
        with self.assertWarnsRegex(pcednet.PcednetWarning, "2 of 3000 points have no finite"):
            result = pcednet.classify(positions, self.normals)
        self.assertEqual(np.flatnonzero(result.labels == pcednet.UNLABELLED).tolist(), [0, 9])
        self.assertTrue(np.isnan(result.confidence[[0, 9]]).all())
        masked = np.ma.masked_invalid(positions)
        np.testing.assert_array_equal(quietly(pcednet.classify, masked, self.normals).labels,
                                      result.labels)

    def test_confidence_is_the_probability_of_the_label(self):
        result = pcednet.classify(self.positions, self.normals)
        for label, values in ((2, result.p_sharp), (1, result.p_smooth),
                              (0, 1 - result.p_sharp - result.p_smooth)):
            chosen = result.labels == label
            np.testing.assert_array_equal(result.confidence[chosen], values[chosen])
        self.assertEqual(sum(result.counts.values()), len(result))


class Rounded(CliTest):
    """float32 coordinates of a national grid: steps of half a metre in a cube of one metre."""

    SAID = r"float coordinates up to 53340\d\d are rounded to steps of 0.5, but the points are only \S+ apart"

    def setUp(self):
        super().setUp()
        positions, self.normals, self.labels = cube(1000)
        self.exact = positions + UTM
        self.rounded = self.exact.astype(np.float32)
        write_ply(self.path("far.ply"), self.exact, self.normals)

    def said(self, function, *arguments, **options):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            function(*arguments, **options)
        return "\n".join(str(one.message) for one in caught)

    def train(self, cloud, **options):
        pcednet.train(cloud, self.labels, epochs=1, scales=4, **options)

    def test_it_is_a_warning_as_of_the_program(self):
        theirs = run("classify", self.path("far.ply")).stderr
        apart = re.search(self.SAID, theirs)[0]
        cloud = pcednet.read(self.path("far.ply"))
        own = pcednet.Cloud(self.rounded, self.normals)
        for xyz, normals in ((cloud, None), (own, None), (self.rounded, self.normals),
                             (self.rounded.astype(">f4"), self.normals),
                             (np.ma.array(self.rounded), self.normals)):
            self.assertIn(apart, self.said(pcednet.classify, xyz, normals))
            self.assertRegex(self.said(pcednet.describe, xyz, normals), self.SAID)
            self.assertRegex(self.said(self.train, xyz, normals=normals), r"(far|cloud 0): " + self.SAID)
        self.assertIn("keep them as float64, or relative", self.said(pcednet.classify, cloud))
        self.assertRegex(self.said(self.train, self.rounded, normals=self.normals, s_max_ratio=8), self.SAID)
        self.assertRegex(self.said(pcednet.train, cloud, self.labels, start="general"), self.SAID)

    def test_what_is_not_rounded_is_not_told(self):
        moved = pcednet.read(self.path("far.ply"))
        moved.xyz = self.exact
        near = (self.exact - UTM).astype(np.float32)
        for xyz, normals in ((self.exact, self.normals), (moved, None), (near, self.normals)):
            for function in (pcednet.classify, pcednet.describe, self.train):
                self.assertNotIn("rounded", self.said(function, xyz, normals=normals))
        for function in (pcednet.classify, pcednet.describe, self.train):  # the scales are not the spacing
            self.assertNotIn("rounded", self.said(function, self.rounded, normals=self.normals, s_min=0.2))


class Refusals(unittest.TestCase):
    def test_wrong_shapes_say_which_are_possible(self):
        good = cube(100)[0]
        for xyz in (np.zeros((5, 2)), np.zeros(6), np.zeros((2, 3, 3)), 3.0):
            with self.assertRaisesRegex(ValueError, r"xyz: shape \(n, 3\) is needed"):
                pcednet.classify(xyz)
        for xyz in (["a", "b"], [[1, 2, 3], [4, 5]], good.astype(complex), None):
            with self.assertRaisesRegex(pcednet.UsageError, "xyz"):
                pcednet.classify(xyz)
        with self.assertRaisesRegex(pcednet.UsageError, "normals: 99 rows for 100 points"):
            pcednet.classify(good, good[:99])
        with self.assertRaisesRegex(pcednet.UsageError, "viewpoint: 2 rows for 100"):
            pcednet.classify(good, viewpoint=good[:2])
        with self.assertRaisesRegex(pcednet.UsageError, "threads"):
            pcednet.classify(good, threads=-1)

    def test_what_is_no_array_of_points_is_told_what_to_do(self):
        for xyz, said in (("scan.ply", r"xyz: an array is needed, .* by pcednet.read\('scan.ply'\)$"),
                          (pathlib.Path("a/scan.las"), r"by pcednet.read\('a/scan.las'\)$"),
                          (np.ones((3, 100)), r"xyz: shape \(n, 3\) is needed, not \(3, 100\); its transpose is xyz.T$"),
                          (np.ones((100, 6)), r"not \(100, 6\); the first three columns are xyz\[:, :3\]$"),
                          (np.zeros(9, [("x", "f8"), ("y", "f4"), ("z", "f8"), ("class", "u1")]),
                           r"structured array; np.column_stack\(\[xyz\['x'\], xyz\['y'\], xyz\['z'\]\]\)"),
                          (NeedsGradients(), "xyz: not an array of numbers: use detach"),
                          (np.ones((100, 2)), r"not \(100, 2\)$"), (np.ones(100), r"not \(100,\)$")):
            with self.assertRaisesRegex(pcednet.UsageError, said):
                pcednet.classify(xyz)

    def test_too_few_points_are_insufficient(self):
        for xyz in ([], np.zeros((0, 3)), [[1.0, 2.0, 3.0]], np.full((9, 3), np.nan),
                    np.zeros((50, 3)), np.outer(np.arange(50.0), [1, 2, 3])):
            with self.assertRaises(pcednet.InsufficientError) as raised:
                quietly(pcednet.classify, xyz)
            self.assertIsInstance(raised.exception, ValueError)
        self.assertEqual(pcednet.estimate_normals(np.zeros((0, 3))).shape, (0, 3))
        with self.assertWarnsRegex(pcednet.PcednetWarning, "1 points without a normal"):
            self.assertFalse(pcednet.estimate_normals([[1.0, 2.0, 3.0]]).any())

    def test_unknown_options_are_refused_by_name(self):
        good = cube(500)[0]
        for named in ({"features": 5}, {"reconstruction": "cube"}, {"scales": 5},
                      {"s_min": 2.0, "s_max": 1.0}, {"gate": 2.0}):
            with self.assertRaises(pcednet.UsageError):
                quietly(pcednet.describe, good, **named)
        with self.assertRaisesRegex(FileNotFoundError, "neither a file nor a shipped model .*gene"):
            pcednet.classify(good, model="no_such_model")

    def test_scales_larger_than_the_cloud_are_refused_or_told(self):
        good, normals, labels = cube(500)
        for function in (pcednet.classify, pcednet.describe,
                         lambda xyz, normals, **named: pcednet.train(
                             xyz, labels, normals=normals, epochs=1, scales=4, **named)):
            for named in ({"s_min": 1000.0}, {"s_min": 1e9, "s_max": 1e10}):
                with self.assertRaisesRegex(
                        pcednet.UsageError, r"s_min 1(000|e\+09) is larger than the cloud, whose "
                                            r"diagonal is 1\.7\d"):
                    quietly(function, good, normals, **named)
            with self.assertWarnsRegex(pcednet.PcednetWarning,
                                       r"s_max 1000 is larger than the cloud, whose diagonal is 1"):
                function(good, normals, s_max=1000.0)

    def test_values_of_another_type_are_refused_by_name(self):
        good, _, labels = cube(500)
        for function, named in (
                (pcednet.classify, {"s_min": "near"}), (pcednet.classify, {"threads": 1.5}),
                (pcednet.describe, {"scales": "many"}), (pcednet.describe, {"gate": [1, 2]}),
                (pcednet.describe, {"reconstruction": 3}), (pcednet.lines, {"min_length": "long"}),
                (pcednet.lines, {"stage": None}), (pcednet.estimate_normals, {"neighbours": 1e9}),
                (lambda xyz, **named: pcednet.train(xyz, labels, **named), {"seed": -1}),
                (lambda xyz, **named: pcednet.train(xyz, labels, **named), {"epochs": 1.5}),
                (lambda xyz, **named: pcednet.train(xyz, labels, **named), {"balance": "even"}),
                (lambda xyz, **named: pcednet.evaluate(labels, labels, **named), {"positive": 2})):
            name, = named
            with self.assertRaisesRegex(pcednet.UsageError, f"^{name}: a .* is needed, not "):
                quietly(function, good, **named)

    def test_warnings_point_at_the_line_that_called(self):
        positions = cube(1000)[0]
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            result = pcednet.classify(positions)
        self.assertEqual([str(one.message) for one in caught], result.notes)
        self.assertRegex(result.notes[0], "^no normals given: estimated from")
        self.assertEqual({one.filename for one in caught}, {__file__})


if __name__ == "__main__":
    unittest.main()
