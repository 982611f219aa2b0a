"""The files of lines that we write, read by GDAL (ogrinfo and ogr2ogr of gdal-bin).

gdal_test.py LINES_SAMPLE exits with 77 (skipped) where GDAL is not installed, or the sample was
built without GeoPackage.
"""
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

SAMPLE = sys.argv.pop(1)
LAYERS = {1: "smooth-edge", 2: "sharp-edge", 3: "boundary"}
COLOURS = {1: "#ffbf7f", 2: "#a50000", 3: "#0052a5"}


def output_of(*command):
    return subprocess.run(list(map(str, command)), check=True, capture_output=True, text=True,
                          timeout=60)


def summary(path):
    """What ogrinfo says of the only layer: its name, feature count, extent and the whole text."""
    done = output_of("ogrinfo", "-ro", "-al", "-so", path)
    assert not re.search("warning|error", done.stderr, re.I), done.stderr
    extent = re.search(r"Extent: \((.*), (.*)\) - \((.*), (.*)\)", done.stdout)
    return (re.search(r"Layer name: (.*)", done.stdout)[1],
            int(re.search(r"Feature Count: (\d+)", done.stdout)[1]),
            [float(word) for word in extent.groups()] if extent else None, done.stdout)


def features(path):
    """The properties and the vertices of every feature, as GDAL hands them on."""
    done = output_of("ogr2ogr", "-f", "GeoJSON", "/vsistdout/", path, "-lco",
                     "SIGNIFICANT_FIGURES=17")
    return [(f["properties"], f["geometry"]["coordinates"])
            for f in json.loads(done.stdout)["features"]]


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


class Gdal(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls._folder = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls._folder.name)
        cls.curves = []
        for line in output_of(SAMPLE, cls.folder).stdout.splitlines():
            kind, *numbers = line.split()
            numbers = [float(word) for word in numbers]
            cls.curves.append({"kind": kind, "class": int(numbers[0]), "closed": numbers[1] == 1,
                               "radius": numbers[2], "centre": numbers[3:6], "axis": numbers[6:9]})
        ours = json.loads((cls.folder / "lines.geojson").read_text())["features"]
        for curve, feature in zip(cls.curves, ours):
            curve["points"] = feature["geometry"]["coordinates"]
        every = [p for curve in cls.curves for p in curve["points"]]
        cls.extent = [f(p[axis] for p in every) for f in (min, max) for axis in (0, 1)]

    @classmethod
    def tearDownClass(cls):
        cls._folder.cleanup()

    def assert_extent(self, found):
        for a, b in zip(found, self.extent):
            self.assertLess(abs(a - b), 2e-4)  # the tolerance of the arcs, and six decimals

    def test_dxf_of_both_versions(self):
        for name in ("lines.dxf", "lines_r12.dxf"):
            layer, count, extent, _ = summary(self.folder / name)
            self.assertEqual((layer, count), ("entities", len(self.curves)))
            self.assert_extent(extent)
            for curve, (properties, points) in zip(self.curves, features(self.folder / name)):
                self.assertEqual(properties["Layer"], LAYERS[curve["class"]])
                if curve["kind"] in ("segment", "polyline"):
                    self.assertEqual(points, curve["points"])
                else:
                    self.assert_round(curve, points)
            colours = re.findall(r"PEN\(c:(#\w+)", output_of("ogrinfo", "-al", self.folder / name).stdout)
            self.assertEqual(colours, [COLOURS[curve["class"]] for curve in self.curves])

    def assert_round(self, curve, points):
        """Every vertex of GDAL's is on the circle, and the ends are those of the curve."""
        for point in points:
            away = minus(point, curve["centre"])
            self.assertLess(abs(math.sqrt(dot(away, away)) - curve["radius"]), 1e-8)
            self.assertLess(abs(dot(away, curve["axis"])), 1e-8)
        if curve["kind"] == "arc":
            for ours, theirs in zip(sorted(curve["points"][::len(curve["points"]) - 1]),
                                    sorted([points[0], points[-1]])):
                self.assertLess(max(map(abs, minus(ours, theirs))), 1e-8)
            middle = curve["points"][len(curve["points"]) // 2]
            nearest = min(math.dist(middle, point) for point in points)
            self.assertLess(nearest, curve["radius"] / 10)

    def test_geojson_and_geopackage(self):
        for name in ("lines.geojson", "lines.gpkg"):
            layer, count, extent, text = summary(self.folder / name)
            self.assertEqual((layer, count), ("edges", len(self.curves)))
            self.assert_extent(extent)
            self.assertIn("3D Line String", text)
            self.assertIn('PROJCRS["ETRS89 / UTM zone 32N"', text)
            for field in ("length", "confidence", "dihedral_angle", "radius"):
                self.assertIn(f"{field}: Real", text)
            for curve, (properties, points) in zip(self.curves, features(self.folder / name)):
                self.assertEqual(points, curve["points"])
                self.assertEqual(properties["class"], LAYERS[curve["class"]])
                self.assertEqual(properties["kind"], curve["kind"])
                self.assertEqual(properties["radius"], curve["radius"] or None)
        first = features(self.folder / "lines.gpkg")[0][0]
        self.assertEqual((first["points"], first["confidence"], first["dihedral_angle"]),
                         (123, 0.9375, 90.0))

    def test_coordinate_systems_of_a_geopackage(self):
        self.assertIn('PROJCRS["a system of our own"', summary(self.folder / "own_system.gpkg")[3])
        self.assertIn("Undefined Cartesian", summary(self.folder / "no_system.gpkg")[3])

    def test_files_without_curves(self):
        for name in ("empty.dxf", "empty_r12.dxf", "empty.geojson", "empty.gpkg"):
            self.assertEqual(summary(self.folder / name)[1], 0, name)


if __name__ == "__main__":
    if not (shutil.which("ogrinfo") and shutil.which("ogr2ogr")):
        print("skipped: ogrinfo and ogr2ogr are not installed")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as scratch:
        done = subprocess.run([SAMPLE, scratch], capture_output=True, text=True)
    if done.returncode == 77:
        print(done.stdout)
        sys.exit(77)
    unittest.main()
