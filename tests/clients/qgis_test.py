"""The files of lines that we write, opened and drawn by QGIS (python3-qgis), without a display.

qgis_test.py LINES_SAMPLE exits with 77 (skipped) where QGIS is not installed, or the sample was
built without GeoPackage.
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SAMPLE = sys.argv.pop(1)
LAYERS = {1: "smooth-edge", 2: "sharp-edge", 3: "boundary"}


class Qgis(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls._folder = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls._folder.name)
        said = subprocess.run([SAMPLE, cls.folder], check=True, capture_output=True, text=True).stdout
        cls.classes = [LAYERS[int(line.split()[1])] for line in said.splitlines()]
        cls.points = [f["geometry"]["coordinates"]
                      for f in json.loads((cls.folder / "lines.geojson").read_text())["features"]]

    @classmethod
    def tearDownClass(cls):
        cls._folder.cleanup()

    def layer(self, name):
        layer = core.QgsVectorLayer(str(self.folder / name), name, "ogr")
        self.assertTrue(layer.isValid(), name)
        return layer

    def vertices(self, layer):
        return [[[v.x(), v.y(), v.z()] for v in feature.geometry().vertices()]
                for feature in layer.getFeatures()]

    def test_geopackage_and_geojson(self):
        for name in ("lines.gpkg", "lines.geojson"):
            layer = self.layer(name)
            self.assertEqual(layer.crs().authid(), "EPSG:25832")
            self.assertEqual(self.vertices(layer), self.points)
            self.assertEqual([f["class"] for f in layer.getFeatures()], self.classes)

    def test_dxf_of_both_versions(self):
        for name in ("lines.dxf", "lines_r12.dxf"):
            layer = self.layer(name)
            self.assertEqual([f["Layer"] for f in layer.getFeatures()], self.classes)
            for axis in ("xMinimum", "yMinimum", "xMaximum", "yMaximum"):
                expected = getattr(self.layer("lines.gpkg").extent(), axis)()
                self.assertLess(abs(getattr(layer.extent(), axis)() - expected), 2e-4)

    def test_coordinate_systems_of_a_geopackage(self):
        own = self.layer("own_system.gpkg").crs()
        self.assertEqual((own.description(), own.isGeographic()), ("a system of our own", False))
        self.assertEqual(self.layer("no_system.gpkg").crs().description(), "Undefined Cartesian SRS")

    def test_files_without_curves(self):
        for name in ("empty.dxf", "empty_r12.dxf", "empty.geojson", "empty.gpkg"):
            self.assertEqual(self.layer(name).featureCount(), 0)

    def test_lines_are_drawn_where_they_are(self):
        layer = self.layer("lines.gpkg")
        red = core.QgsLineSymbol.createSimple({"line_color": "255,0,0", "line_width": "1"})
        layer.setRenderer(core.QgsSingleSymbolRenderer(red))
        for points in self.points:  # one curve fills the map
            box = core.QgsRectangle(*[f(p[axis] for p in points) for f in (min, max) for axis in (0, 1)])
            box.grow(max(box.width(), box.height(), 1e-3) / 4)
            settings = core.QgsMapSettings()
            settings.setLayers([layer])
            settings.setDestinationCrs(layer.crs())
            settings.setOutputSize(QSize(200, 200))
            settings.setBackgroundColor(QColor("white"))
            settings.setExtent(box)
            drawing = core.QgsMapRendererSequentialJob(settings)
            drawing.start()
            drawing.waitForFinished()
            image, to_pixel = drawing.renderedImage(), settings.mapToPixel()
            for p in points:
                at = to_pixel.transform(p[0], p[1])
                x, y = int(at.x()), int(at.y())
                near = [QColor(image.pixel(x + i, y + j)) for i in (-1, 0, 1) for j in (-1, 0, 1)]
                self.assertIn(QColor("red"), near, p)


if __name__ == "__main__":
    try:
        os.environ["QT_QPA_PLATFORM"] = "offscreen"
        from qgis import core
        from qgis.PyQt.QtCore import QSize
        from qgis.PyQt.QtGui import QColor
    except ImportError as error:
        print(f"skipped: QGIS for {sys.executable} is not installed: {error}")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as scratch:
        done = subprocess.run([SAMPLE, scratch], capture_output=True, text=True)
        os.environ["HOME"] = os.environ["XDG_RUNTIME_DIR"] = scratch  # QGIS keeps files there
        if done.returncode == 77:
            print(done.stdout)
            sys.exit(77)
        core.QgsApplication.setPrefixPath("/usr", True)
        application = core.QgsApplication([], False)
        application.initQgis()
        outcome = unittest.main(exit=False).result
        application.exitQgis()
    sys.exit(not outcome.wasSuccessful())
