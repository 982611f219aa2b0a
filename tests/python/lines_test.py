"""pcednet.lines: the curves of the program, as objects and in files."""

import json
import unittest
import warnings

import numpy as np

import pcednet
from las_test import NEW, SCALE, las, vlr
from support import CliTest, cube, run, write_ply

WKT = 'PROJCS["UTM",UNIT["metre",1],AUTHORITY["EPSG","25832"]]'


class Lines(CliTest):
    @classmethod
    def setUpClass(cls):
        positions, normals, _ = cube(12_000)
        cls.positions, cls.normals = positions, normals.astype(np.float32)
        cls.result = pcednet.classify(cls.positions, cls.normals)
        cls.lines = pcednet.lines(cls.positions, cls.result)

    def setUp(self):
        super().setUp()
        warnings.simplefilter("ignore", pcednet.PcednetWarning)

    def test_a_cube_has_twelve_segments(self):
        self.assertEqual(len(self.lines), 12)
        self.assertAlmostEqual(self.lines.length, 12, delta=0.05)
        for curve in self.lines:
            self.assertEqual((curve.kind, curve.label, curve.closed), ("segment", 2, False))
            self.assertAlmostEqual(curve.dihedral_angle, np.pi / 2, delta=0.1)
            self.assertGreater(curve.confidence, 0.5)
            self.assertGreater(curve.support, 10)
            ends = curve.points
            self.assertEqual(ends.shape, (2, 3))
            self.assertAlmostEqual(np.linalg.norm(ends[1] - ends[0]), curve.length)
            np.testing.assert_array_equal(curve.sampled(0.01), ends)
            with self.assertRaises(pcednet.UsageError):
                curve.sampled(0)

    def test_thick_noise_is_averaged_for_labels_and_lines(self):
        positions, _, _ = cube(150_000, noise=0.013)  # two spacings
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            result = pcednet.classify(positions)
        self.assertIn("times the spacing: 150000 points are averaged to", str(told[0].message))
        self.assertEqual(result.labels.shape, (150_000,))
        self.assertEqual(result.normals.shape, (150_000, 3))
        for found in (pcednet.lines(positions, result), pcednet.lines(positions),
                      pcednet.lines(positions, np.asarray(result.labels))):
            self.assertEqual(len(found), 12)
            self.assertAlmostEqual(found.length, 12, delta=0.15)

    def test_files_are_those_of_the_program(self):
        write_ply(self.path("in.ply"), self.positions, self.normals, position_type="double")
        cloud = pcednet.read(self.path("in.ply"))
        for options, found in (
                ([], pcednet.lines(cloud)),
                (["--class", "sharp,smooth", "--kind", "segment", "--regularise", "--angle", 20],
                 pcednet.lines(cloud, pcednet.classify(cloud), classes=("sharp", "smooth"),
                               kinds="segment", regularise=True, angle=20)),
                (["--stage", "creases", "--min-confidence", "0.8"],
                 pcednet.lines(cloud, stage="creases", min_confidence=0.8))):
            for ending in ("dxf", "geojson", "gpkg", "svg", "obj", "ply"):
                theirs, ours = self.path(f"theirs.{ending}"), self.path(f"ours.{ending}")
                if ending in ("dxf", "obj") or not options:
                    run("lines", self.path("in.ply"), "-o", theirs, "--overwrite", *options)
                    found.write(ours, overwrite=True)
                    self.assertEqual(ours.read_bytes(), theirs.read_bytes(), ending)

    def test_large_arcs_are_drawn_as_finely_as_by_the_program(self):
        angles, heights = np.meshgrid(np.linspace(0, 2 * np.pi, 3000, endpoint=False), np.arange(12) * 0.5)
        side = np.c_[250 * np.cos(angles.ravel()), 250 * np.sin(angles.ravel()), -heights.ravel()]
        top = np.concatenate([(side[:3000] * (1 - k / 500)) * [1, 1, 0] for k in range(1, 12)])
        points = np.concatenate([side, top])
        write_ply(self.path("tank.ply"), points, position_type="double")
        cloud = pcednet.read(self.path("tank.ply"))
        run("lines", self.path("tank.ply"), "-o", self.path("theirs.obj"))
        found = pcednet.lines(cloud)
        self.assertTrue(any(curve.kind in ("arc", "circle") and curve.radius > 200 for curve in found))
        found.write(self.path("ours.obj"))
        self.assertEqual(self.path("ours.obj").read_bytes(), self.path("theirs.obj").read_bytes())

    def test_rounded_coordinates_are_spread_as_by_the_program(self):
        np.savetxt(self.path("rounded.xyz"), self.positions, fmt="%.2f")
        run("lines", self.path("rounded.xyz"), "-o", self.path("theirs.obj"))
        theirs = self.path("theirs.obj").read_bytes()
        self.assertGreater(len(theirs), 500)
        cloud = pcednet.read(self.path("rounded.xyz"))
        found = pcednet.classify(cloud)
        ways = {"alone": pcednet.lines(cloud), "of a result": pcednet.lines(cloud, found),
                "of labels": pcednet.lines(cloud, found.labels, p_sharp=found.p_sharp,
                                           p_smooth=found.p_smooth)}
        for name, way in ways.items():
            way.write(self.path("ours.obj"), overwrite=True)
            self.assertEqual(self.path("ours.obj").read_bytes(), theirs, name)

    def test_float_coordinates_rounded_too_coarsely_are_told_where_labels_are_given(self):
        far = (self.positions + [500_000, 5_400_000, 0]).astype(np.float32)
        with self.assertWarnsRegex(UserWarning, "float coordinates up to .* are rounded to steps of 0.5"):
            pcednet.lines(far, self.result.labels, self.normals)

    def test_a_cloud_all_unlabelled_is_classified(self):
        write_ply(self.path("unlabelled.ply"), self.positions, self.normals,
                  labels=np.full(len(self.positions), 255, np.uint8))
        self.assertEqual(len(pcednet.lines(pcednet.read(self.path("unlabelled.ply")))), 12)
        for none in (-1, 255):
            cloud = pcednet.Cloud(self.positions, self.normals, labels=np.full(len(self.positions), none))
            self.assertEqual(len(pcednet.lines(cloud)), 12)

    def test_labels_of_ones_own_are_drawn(self):
        given = pcednet.lines(self.positions, self.result.labels, self.normals,
                              p_sharp=self.result.p_sharp, p_smooth=self.result.p_smooth)
        cloud = pcednet.Cloud(self.positions, self.normals, labels=self.result.labels.tolist(), attributes={
            name: getattr(self.result, name).tolist() for name in ("p_sharp", "p_smooth")})
        self.assertEqual([c.confidence for c in pcednet.lines(cloud)], [c.confidence for c in given])
        self.assertEqual(len(given), 12)
        self.assertEqual(pcednet.lines(self.positions, np.zeros(12_000, np.uint8)), [])
        with self.assertRaises(pcednet.UsageError):
            pcednet.lines(self.positions, self.result.labels[1:])
        with self.assertRaisesRegex(pcednet.UsageError, "a Result of 12000 points, the cloud has 100"):
            pcednet.lines(self.positions[:100], self.result)
        with self.assertRaisesRegex(pcednet.UsageError, "p_smooth: p_sharp is needed with it"):
            pcednet.lines(self.positions, self.result.labels, p_smooth=self.result.p_smooth)

    def test_masked_labels_are_unlabelled(self):
        labels = self.result.labels
        other = np.where(labels == pcednet.SMOOTH_EDGE, pcednet.UNLABELLED, labels)
        expected = [curve.length for curve in pcednet.lines(self.positions, other, self.normals)]
        for kind in (np.uint8, np.int8, np.int64, np.float32):
            masked = np.ma.masked_equal(labels.astype(kind), pcednet.SMOOTH_EDGE)
            found = pcednet.lines(self.positions, masked, self.normals)
            self.assertEqual([curve.length for curve in found], expected, kind)

    def test_classes_have_their_long_names_as_well(self):
        for classes in ("sharp-edge", ["sharp-edge", "smooth"], ("smooth-edge",)):
            short = [classes] if isinstance(classes, str) else classes
            short = [name.removesuffix("-edge") for name in short]
            self.assertEqual(len(pcednet.lines(self.positions, self.result, classes=classes)),
                             len(pcednet.lines(self.positions, self.result, classes=short)))

    def test_notes_on_arrays_speak_of_no_file(self):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            pcednet.lines(self.positions, self.result.labels)
        said = [str(warning.message) for warning in caught]
        self.assertRegex(said[0], "^no normals given: estimated from")
        self.assertNotIn("in the file", " ".join(said))

    def test_labels_of_a_file_are_drawn(self):
        write_ply(self.path("in.ply"), self.positions, self.normals, position_type="double")
        run("classify", self.path("in.ply"), "-o", self.path("labelled.ply"), "--model", "cad")
        run("lines", self.path("labelled.ply"), "-o", self.path("theirs.dxf"))
        cloud = pcednet.read(self.path("labelled.ply"))
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            pcednet.lines(cloud).write(self.path("ours.dxf"))
        self.assertEqual(self.path("ours.dxf").read_bytes(), self.path("theirs.dxf").read_bytes())
        self.assertEqual(pcednet.evaluate(cloud["scalar_edge_class"], cloud).mcc, 1)
        cloud.comments = ["pcednet class 0 #9e9e9e ground", "pcednet class 1 #f28e2b roof"]
        with self.assertRaisesRegex(pcednet.UsageError, "lines are of edge classes"):
            pcednet.lines(cloud)
        cloud.comments = []
        cloud["scalar_p_sharp"][3] = 2
        with self.assertRaisesRegex(pcednet.UsageError, "from 0 to 1"):
            pcednet.lines(cloud)
        del cloud.attributes["scalar_p_sharp"]
        cloud["scalar_edge_class"][:] = 0
        self.assertEqual(pcednet.lines(cloud), [])
        self.assertEqual(len(pcednet.lines(cloud, pcednet.classify(cloud))), 12)

    def test_a_part_of_a_cloud_keeps_its_coordinate_system(self):
        rows = np.zeros(len(self.positions), NEW)
        for i, axis in enumerate("XYZ"):
            rows[axis] = np.round((100 + 10 * self.positions[:, i]) / SCALE[i])
        records = [vlr(b"LASF_Projection", 2112, WKT.encode() + b"\0")]
        self.path("in.las").write_bytes(las(6, rows, records))
        part = pcednet.read(self.path("in.las")).select(range(6000))
        pcednet.lines(part).write(self.path("part.gpkg"))
        self.assertIn(b"25832", self.path("part.gpkg").read_bytes())
        pcednet.write(self.path("part.las"), part)
        pcednet.lines(pcednet.read(self.path("part.las"))).write(self.path("again.gpkg"))
        self.assertIn(b"25832", self.path("again.gpkg").read_bytes())

    def test_a_slice_is_written_as_the_whole_is(self):
        longest = pcednet.lines(pcednet.Cloud(self.positions), self.result)
        longest._kept, longest._fit_tolerance = "the file", 0.5
        longest.sort(key=lambda curve: -curve.length)
        for some in (longest[:2], longest[::-1][-2:][::-1], longest.copy()[slice(0, 2)]):
            self.assertIsInstance(some, pcednet.Lines)
            self.assertEqual(list(some), list(longest)[:2])
            self.assertEqual((some._kept, some._fit_tolerance), ("the file", 0.5))
        self.assertIsInstance(longest[-1], pcednet.Curve)
        self.assertEqual(longest[50:], [])
        self.lines[:2].write(self.path("two.geojson"))
        self.assertEqual(self.path("two.geojson").read_text().count("LineString"), 2)

    def test_scores_are_those_of_the_program(self):
        cloud = next(iter(pcednet.generate("lines", 3, "bracket_0")))
        found = pcednet.lines(cloud)
        pcednet.write(self.path("cloud.ply"), cloud)
        found.write(self.path("found.obj"))
        pcednet.Lines(cloud.curves).write(self.path("true.obj"))
        ours, truth = pcednet.read_lines(self.path("found.obj")), pcednet.read_lines(self.path("true.obj"))
        self.assertEqual((type(ours), len(ours)), (pcednet.Lines, len(found)))
        for points, options in ((None, ()), (cloud, ("--cloud", self.path("cloud.ply")))):
            done = run("evaluate", self.path("found.obj"), "--truth", self.path("true.obj"), "--json", "-", *options)
            theirs = json.loads(done.stdout)["clouds"][0]
            self.assertEqual(theirs.pop("name"), "found")
            self.assertEqual(vars(pcednet.evaluate_lines(truth, ours, points)), theirs)
        self.assertGreater(pcednet.evaluate_lines(cloud.curves, found, cloud.xyz).recall_02, 0.5)
        nothing = pcednet.evaluate_lines(truth, [])
        self.assertEqual((nothing.lines, nothing.found), (0, 0))
        self.assertTrue(np.isnan(nothing.cd))
        with self.assertRaises(pcednet.InsufficientError):
            pcednet.evaluate_lines([], ours)
        with self.assertRaisesRegex(pcednet.UsageError, r"pcednet.read_lines\(path\)"):
            pcednet.evaluate_lines(truth, str(self.path("found.obj")))
        with self.assertRaises(pcednet.MissingFileError):
            pcednet.read_lines(self.path("absent.obj"))

    def test_the_coordinate_system_goes_along(self):
        found = pcednet.lines(self.positions, self.result)
        found.write(self.path("a.gpkg"), epsg=25832)
        self.assertIn(b"25832", self.path("a.gpkg").read_bytes())
        found.write(self.path("a.dxf"), unit="mm", dxf_version="r12", dxf_arcs="none")
        with self.assertRaises(FileExistsError):
            found.write(self.path("a.dxf"))
        for wrong in ({"unit": "mile"}, {"view": "below"}, {"dxf_version": "9"}, {"dxf_arcs": "some"}):
            with self.assertRaisesRegex(pcednet.UsageError, "there are"):
                found.write(self.path("b.dxf"), **wrong)
        with self.assertRaises(pcednet.UsageError):
            found.write(self.path("b.dwg"))
        for wrong in ({"tolerance": -1.0}, {"tolerance": float("nan")}, {"epsg": -5}, {"epsg": 1},
                      {"epsg": 32767}):
            with self.assertRaisesRegex(pcednet.UsageError, "is needed"):
                found.write(self.path("b.gpkg"), **wrong)
        with self.assertRaisesRegex(pcednet.UsageError, "^epsg: EPSG:30001: PROJ knows no such system$"):
            found.write(self.path("b.gpkg"), epsg=30001)
        with self.assertRaisesRegex(pcednet.UsageError, "^epsg: EPSG:5703: a system of heights alone"):
            found.write(self.path("b.gpkg"), epsg=5703)
        self.assertFalse(self.path("b.gpkg").exists())
        found.write(self.path("metres.dxf"), epsg=25832)
        self.assertRegex(self.path("metres.dxf").read_text(), r"\$INSUNITS\s+70\s+6\s")

    def test_options_that_leave_out_every_curve_are_told(self):
        for options in ({"classes": "smooth"}, {"kinds": "circle"}, {"min_confidence": 1.0}):
            with self.assertWarnsRegex(pcednet.PcednetWarning, "all 12 curves are left out by classes, kinds or min_conf"):
                self.assertEqual(pcednet.lines(self.positions, self.result, **options), [])
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.assertTrue(pcednet.lines(self.positions, self.result, kinds="segment"))

    def test_wrong_choices_are_refused(self):
        for wrong in ({"classes": ["crease"]}, {"kinds": "spline"}, {"stage": "end"},
                      {"gap": -1.0}, {"angle": 0.0}, {"angle": 400.0}, {"min_confidence": 2.0},
                      {"classes": []}, {"viewpoint": (0.0, 0.0, float("nan"))}):
            with self.assertRaises(pcednet.UsageError):
                pcednet.lines(self.positions, self.result, **wrong)
        with self.assertWarnsRegex(pcednet.PcednetWarning, "7 labels are not edge classes"):
            labels = self.result.labels.copy()
            labels[:7] = 9
            pcednet.lines(self.positions, labels, self.normals)


if __name__ == "__main__":
    unittest.main()
