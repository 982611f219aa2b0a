"""`pcednet lines`: curves of a cloud in every format, what is asked for and nothing else, bad input."""
import json
import os
import re
import resource
import sqlite3
import struct
import subprocess
import unittest
import xml.etree.ElementTree as ElementTree

import numpy as np

from las_test import NEW, OFFSET, SCALE, las, vlr
from lines_support import FORMATS, WITHOUT_SQLITE, LinesTest
from support import PROGRAM, cube, run, write_ply

WKT = ('PROJCS["ETRS89 / UTM zone 32N",GEOGCS["ETRS89",DATUM["European_Terrestrial_Reference_System_'
       '1989",SPHEROID["GRS 1980",6378137,298.257222101]],PRIMEM["Greenwich",0],UNIT["degree",'
       '0.0174532925199433]],PROJECTION["Transverse_Mercator"],PARAMETER["latitude_of_origin",0],'
       'PARAMETER["central_meridian",9],PARAMETER["scale_factor",0.9996],PARAMETER["false_easting",'
       '500000],PARAMETER["false_northing",0],UNIT["metre",1],AUTHORITY["EPSG","25832"]]')


def geojson(path):
    """The properties and the vertices of every feature."""
    features = json.loads(path.read_text())["features"]
    return [(f["properties"], np.array(f["geometry"]["coordinates"])) for f in features]


def geopackage(path):
    """The same of a GeoPackage, by the words of its standard."""
    database = sqlite3.connect(path)
    names = ("class", "kind", "length", "confidence", "dihedral_angle", "points", "radius")
    (srs, z, m), = database.execute("SELECT srs_id, z, m FROM gpkg_geometry_columns")
    box, = database.execute("SELECT min_x, min_y, max_x, max_y FROM gpkg_contents")
    found, every = [], []
    for blob, *values in database.execute(f"SELECT geom, {', '.join(names)} FROM edges ORDER BY fid"):
        magic, version, flags, of = struct.unpack_from("<2sBBi", blob)
        assert (magic, version, flags, of, z, m) == (b"GP", 0, 5, srs, 1, 0)
        envelope = struct.unpack_from("<6d", blob, 8)
        order, kind, count = struct.unpack_from("<BII", blob, 56)
        assert (order, kind, len(blob)) == (1, 1002, 65 + 24 * count)
        points = np.frombuffer(blob, "<f8", 3 * count, 65).reshape(-1, 3)
        assert np.array_equal(np.reshape(envelope, (3, 2)).T, [points.min(0), points.max(0)])
        found.append((dict(zip(names, values)), points))
        every.append(points)
    if every:
        every = np.vstack(every)
        assert np.array_equal(box, [*every[:, :2].min(0), *every[:, :2].max(0)])
    else:
        assert box == (None,) * 4
    database.close()
    return found


class Lines(LinesTest):
    def test_every_format_holds_the_same_curves(self):
        far = np.array([512049.25, 5403059.5, 252.5])
        done = run("lines", self.labelled_cube(shift=far), *self.outputs())
        count = self.stated_count(done)
        self.assertGreaterEqual(count, 6)
        for path in self.made.values():
            self.assertIn(f"-> {path}", done.stderr)
        curves = geojson(self.made["geojson"])
        self.assertEqual(len(curves), count)
        for properties, points in curves:
            self.assertEqual(properties["class"], "sharp-edge")
            self.assertLess(np.abs(points - far).max(), 0.6)
        if "gpkg" in FORMATS:
            packed = geopackage(self.made["gpkg"])
            self.assertEqual([p for p, _ in packed], [p for p, _ in curves])
            for (_, a), (_, b) in zip(packed, curves):
                self.assertTrue(np.array_equal(a, b))
        obj = self.made["obj"].read_text()
        vertices = np.array([line.split()[1:] for line in obj.splitlines() if line.startswith("v ")],
                            float)
        chains = [line.split()[1:] for line in obj.splitlines() if line.startswith("l ")]
        self.assertEqual(len(chains), count)
        for chain, (_, points) in zip(chains, curves):
            self.assertTrue(np.array_equal(vertices[np.array(chain, int) - 1], points))
        self.assertEqual(len(np.unique(vertices, axis=0)), len(vertices))
        self.assertIn(f": {count} curves\n".encode(), self.made["ply"].read_bytes())
        svg = ElementTree.parse(self.made["svg"])
        self.assertEqual(len(svg.findall(".//{http://www.w3.org/2000/svg}polyline")), count)
        dxf = self.made["dxf"].read_text().split("ENTITIES")[1]
        self.assertEqual(len(re.findall(r"^  0\n(?:LINE|ARC|CIRCLE|POLYLINE)$", dxf, re.M)), count)

    def test_the_same_bytes_with_any_number_of_threads(self):
        path = self.labelled_cube()
        bytes_of = []
        for threads in (1, 2):
            run("lines", path, *self.outputs(), "--threads", threads, "--overwrite")
            bytes_of.append([p.read_bytes() for p in self.made.values()])
        self.assertEqual(*bytes_of)

    def test_filters_and_versions(self):
        path = self.labelled_cube()
        every = self.stated_count(run("lines", path, *self.outputs("geojson")))
        kinds = [p["kind"] for p, _ in geojson(self.made["geojson"])]
        done = run("lines", path, *self.outputs("geojson"), "--kind", "segment", "--overwrite")
        self.assertEqual(self.stated_count(done), kinds.count("segment"))
        done = run("lines", path, *self.outputs("geojson"), "--class", "smooth,boundary",
                   "--overwrite")
        self.assertEqual(geojson(self.made["geojson"]), [])
        self.assertIn(f"left out: {every} by --class smooth,boundary", done.stderr)
        done = run("lines", path, *self.outputs("geojson"), "--min-points", "5", "--kind",
                   "circle", "--overwrite")
        self.assertIn(f"left out: {every} by --kind circle", done.stderr)
        run("lines", path, *self.outputs("dxf"), "--dxf-version", "r12", "--overwrite")
        self.assertIn("AC1009", self.made["dxf"].read_text())
        run("lines", path, *self.outputs("dxf"), "--unit", "mm", "--overwrite")
        self.assertIn("$INSUNITS\n 70\n4\n", self.made["dxf"].read_text())

    def test_says_what_left_everything_out(self):
        path = self.labelled_cube()
        for option in (("--min-length", "1000"), ("--kind", "circle"), ("--min-points", "9999")):
            done = run("lines", path, *self.outputs("geojson"), *option, "--overwrite")
            self.assertRegex(done.stderr, rf"left out: \d+ by {' '.join(option)}\b")
            self.assertIn("all curves were left out: what was written holds no lines", done.stderr)
            self.assertNotIn("no edges", done.stderr)
            self.assertEqual(geojson(self.made["geojson"]), [])
        run("lines", path, *self.outputs("geojson"), "--min-length", "0.9", "--overwrite")
        self.assertEqual(len(geojson(self.made["geojson"])), 12)
        points, _, _ = cube(8000)
        inner = np.clip(points, .06, .94)
        normals = (points - inner) / np.linalg.norm(points - inner, axis=1)[:, None]
        labels = (np.sort(np.abs(normals), axis=1)[:, 1] > .1).astype(np.uint8)
        rounded = self.folder / "rounded.ply"
        write_ply(rounded, inner + .06 * normals, normals, labels)
        done = run("lines", rounded, *self.outputs("geojson"), "--overwrite")
        self.assertRegex(done.stderr, r"left out: \d+ by --class sharp \(rounded edges are [\d.]+ long: "
                                      r"--class sharp,smooth draws them\)")
        done = run("lines", rounded, *self.outputs("geojson"), "--class", "sharp,smooth", "--overwrite")
        self.assertNotIn("left out", done.stderr)
        done = run("lines", path, *self.outputs("geojson"), "--stage", "creases", "--min-length", "9",
                   "--overwrite")
        self.assertNotIn("by --min-length", done.stderr)

    def lengths(self, *options):
        """The lengths that lines states: spacing and noise, --min-length, --gap and --tolerance."""
        said = run("lines", self.labelled_cube(), *self.outputs("obj"), "--overwrite", *options).stderr
        self.assertRegex(said, r"\n  spacing .*, noise .* of it: min-length .*, gap .*, tolerance ")
        line = re.search(r"\n  (spacing .*)\n", said)[1]
        return dict(zip("spacing noise length gap tolerance".split(),
                        map(float, re.findall(r"(?:spacing|noise|length|gap|tolerance) ([0-9.e-]+)", line))))

    def test_states_the_lengths_that_it_used(self):
        found = self.lengths()
        spacing = found["spacing"]
        self.assertAlmostEqual(spacing / np.sqrt(6 / 8000), 1, delta=0.1)
        self.assertLess(found["noise"], 0.01)
        for name, spacings in (("length", 3), ("gap", 6), ("tolerance", 0.2)):
            self.assertAlmostEqual(found[name] / spacing, spacings, delta=0.03 * spacings)
        found = self.lengths("--min-length", "0.5", "--gap", "0.25", "--tolerance", "0.125")
        self.assertEqual([found[name] for name in ("length", "gap", "tolerance")], [0.5, 0.25, 0.125])
        self.assertEqual(found["spacing"], spacing)

    def write_tank(self, turned=np.eye(3)):
        """The rim of a tank of 400 spacings' radius: the top, the wall, and the edge between."""
        random = np.random.default_rng(5)
        turn, away = random.uniform(0, 2 * np.pi, 40000), random.uniform(0, 0.04, 40000)
        top = np.arange(40000) % 2 == 0
        r, z = np.where(top, 1 - away, 1), np.where(top, 0, -away)
        p = np.column_stack([r * np.cos(turn), r * np.sin(turn), z])
        n = np.where(top[:, None], [0, 0, 1.0], np.column_stack([np.cos(turn), np.sin(turn), 0 * z]))
        write_ply(self.folder / "tank.ply", p @ turned.T, n @ turned.T, np.where(away < 0.003, 2, 0).astype(np.uint8))
        return self.folder / "tank.ply"

    def test_tells_of_tilted_circles_in_dxf_and_makes_them_polylines(self):
        path = self.write_tank(np.array([[1, 0, 0], [0, 0.6, -0.8], [0, 0.8, 0.6]]))
        kinds = lambda: re.findall(r"^  0\n(ARC|CIRCLE|POLYLINE)$", self.made["dxf"].read_text(), re.M)
        self.assertIn("circles of tilted planes, here 1; --dxf-arcs", run("lines", path, *self.outputs("dxf")).stderr)
        self.assertEqual(kinds(), ["CIRCLE"])
        done = run("lines", path, *self.outputs("dxf"), "--dxf-arcs", "flat", "--overwrite")
        self.assertNotIn("tilted", done.stderr)
        self.assertEqual(kinds(), ["POLYLINE"])
        path = self.write_tank()
        done = run("lines", path, *self.outputs("dxf"), "--overwrite")
        self.assertNotIn("tilted", done.stderr)
        self.assertEqual(kinds(), ["CIRCLE"])
        run("lines", path, *self.outputs("dxf"), "--dxf-arcs", "none", "--overwrite")
        self.assertEqual(kinds(), ["POLYLINE"])

    def test_round_curves_of_formats_without_arcs_keep_to_the_tolerance_of_their_points(self):
        said = run("lines", self.write_tank(), *self.outputs("geojson")).stderr
        tolerance = float(re.search(r", tolerance (\S+)", said)[1])
        self.assertLess(tolerance, 0.0008)
        (properties, points), = geojson(self.made["geojson"])
        self.assertEqual(properties["kind"], "circle")
        middles = 0.5 * (points[1:] + points[:-1])
        deviation = properties["radius"] - np.linalg.norm(middles[:, :2], axis=1)
        self.assertLess(np.median(deviation), 1.01 * tolerance)

    @unittest.skipIf(WITHOUT_SQLITE, "no GeoPackage in this build")
    def test_las_without_labels_or_normals_is_classified_and_keeps_its_coordinate_system(self):
        p, _, _ = cube(8000)
        rows = np.zeros(len(p), NEW)
        for i, axis in enumerate("XYZ"):
            rows[axis] = np.round((100 + 10 * p[:, i]) / SCALE[i])
        path = self.folder / "a.las"
        path.write_bytes(las(6, rows, [vlr(b"LASF_Projection", 2112, WKT.encode() + b"\0")]))
        done = run("lines", path, *self.outputs("gpkg", "geojson", "dxf"))
        self.assertIn("no labels: classified by model general", done.stderr)
        self.assertIn("no normals", done.stderr)
        for _, points in geopackage(self.made["gpkg"]):
            self.assertLess(np.abs(points - OFFSET - 100).max(), 8)
        database = sqlite3.connect(self.made["gpkg"])
        row, = database.execute("SELECT s.organization, s.organization_coordsys_id, s.definition "
                                "FROM gpkg_contents c JOIN gpkg_spatial_ref_sys s USING (srs_id)")
        database.close()
        self.assertEqual(row, ("EPSG", 25832, WKT))
        crs = json.loads(self.made["geojson"].read_text())["crs"]
        self.assertEqual(crs["properties"]["name"], "urn:ogc:def:crs:EPSG::25832")
        self.assertIn("$INSUNITS\n 70\n6\n", self.made["dxf"].read_text())
        done = run("lines", path, *self.outputs("geojson"), "--crs", "EPSG:25833", "--overwrite")
        self.assertIn("names another coordinate system, EPSG:25832: that of --crs", done.stderr)
        self.assertIn("EPSG::25833", self.made["geojson"].read_text())
        heights = b'VERT_CS["DHHN",VERT_DATUM["D",2005],UNIT["metre",1],AUTHORITY["EPSG","7837"]]'
        path.write_bytes(las(6, rows, [vlr(b"LASF_Projection", 2112, heights + b"\0")]))
        run("lines", path, *self.outputs("gpkg"), "--overwrite")
        database = sqlite3.connect(self.made["gpkg"])
        self.assertEqual(database.execute("SELECT srs_id FROM gpkg_contents").fetchall(), [(-1,)])
        database.close()
        done = run("lines", path, *self.outputs("gpkg"), "--crs", "EPSG:25833", "--overwrite")
        self.assertNotIn("another coordinate system", done.stderr)

    def test_crs_names_the_coordinate_system_of_a_file_that_does_not(self):
        path = self.labelled_cube()
        without = run("lines", path, *self.outputs("geojson")).stderr
        self.assertIn("does not keep: that its coordinates are lengths", without)
        done = run("lines", path, *self.outputs(), "--crs", "EPSG:25832", "--overwrite")
        self.assertNotIn("does not keep", done.stderr)
        self.assertNotIn("another coordinate system", done.stderr)
        crs = json.loads(self.made["geojson"].read_text())["crs"]
        self.assertEqual(crs["properties"]["name"], "urn:ogc:def:crs:EPSG::25832")
        if "gpkg" in FORMATS:
            database = sqlite3.connect(self.made["gpkg"])
            srs, = database.execute("SELECT srs_id FROM gpkg_contents")
            database.close()
            self.assertEqual(srs, (25832,))
        run("lines", path, *self.outputs(), "--crs", "EPSG:25832+7837", "--overwrite")
        crs = json.loads(self.made["geojson"].read_text())["crs"]
        self.assertEqual(crs["properties"]["name"], "urn:ogc:def:crs:EPSG::25832")
        # A build without PROJ takes any code in the range of codes, and does not know its unit.
        unknown = subprocess.run([PROGRAM, "lines", path, "-o", self.folder / "u.dxf", "--crs", "EPSG:30001"],
                                 capture_output=True, text=True)
        if unknown.returncode != 0:
            self.assertEqual(unknown.returncode, 2)
            self.assertIn("PROJ knows no such system", unknown.stderr)
            self.assertIn("$INSUNITS\n 70\n6\n", self.made["dxf"].read_text())
        run("lines", path, "-o", self.folder / "a.obj", "--crs", "epsg:25832", expect=2)
        for bad in ("25832", "EPSG:", "EPSG:0", "EPSG:-1", "EPSG:1e4", "EPSG:99999999999", "EPSG:25832+", "EPSG:25832+1+2", ""):
            done = run("lines", path, "-o", self.folder / "b.dxf", "--crs=" + bad, expect=2)
            self.assertIn("--crs", done.stderr)
        for code in (1, 1023, 32767, 999999):
            done = run("lines", path, "-o", self.folder / "c.dxf", "--crs", f"EPSG:{code}", expect=2)
            self.assertIn(f"--crs: EPSG:{code}: no code of a coordinate system, which are from 1024 to 32766",
                          done.stderr)
        self.assertFalse((self.folder / "c.dxf").exists())

    def test_no_edges_give_empty_files(self):
        p, n, _ = cube(2000)
        write_ply(self.folder / "a.ply", p, n, np.zeros(len(p), np.uint8))
        done = run("lines", self.folder / "a.ply", *self.outputs())
        self.assertIn("0 curves", done.stderr)
        self.assertEqual(geojson(self.made["geojson"]), [])
        if "gpkg" in FORMATS:
            self.assertEqual(geopackage(self.made["gpkg"]), [])
        ElementTree.parse(self.made["svg"])
        self.assertTrue(self.made["dxf"].read_text().endswith("  0\nEOF\n"))

    def test_draws_the_curves_over_the_cloud(self):
        path = self.labelled_cube()
        picture = self.folder / "edges.png"
        done = run("lines", path, *self.outputs("dxf"), "--preview", picture)
        self.assertIn(f"-> {picture}", done.stderr)
        drawn = picture.read_bytes()
        self.assertEqual(drawn[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(struct.unpack(">II", drawn[16:24]), (1280, 960))
        run("lines", path, *self.outputs("dxf"), "--preview", picture, "--preview-from", "0", "90",
            "--overwrite")
        self.assertNotEqual(picture.read_bytes(), drawn)
        run("lines", path, *self.outputs("svg"), "--preview", picture, expect=2)
        run("lines", path, "-o", picture, "--preview", picture, expect=2)
        run("lines", path, *self.outputs("svg"), "--preview", picture, "--overwrite",
            "--kind", "circle")
        self.assertNotEqual(picture.read_bytes(), drawn)  # the cube has no circles

    def test_looks_at_a_floor_from_above_whatever_the_signs_of_its_normals(self):
        random = np.random.default_rng(3)
        p = np.column_stack([random.uniform(0, 6, 6000), random.uniform(0, 4, 6000), np.zeros(6000)])
        pictures = []
        for name, normals in (("bare", None), ("up", np.tile([0, 0, 1.0], (6000, 1)))):
            path, picture = self.folder / f"{name}.ply", self.folder / f"{name}.png"
            write_ply(path, p, normals, np.where(p[:, 1] < 0.05, 3, 0).astype(np.uint8))
            run("lines", path, *self.outputs("obj"), "--preview", picture, "--overwrite")
            pictures.append(picture.read_bytes())
        self.assertEqual(*pictures)

    def test_a_tolerance_below_the_noise_is_told(self):
        p, n, label = cube(8000, noise=0.01)
        write_ply(self.folder / "noisy.ply", p, n, label)
        done = run("lines", self.folder / "noisy.ply", *self.outputs("obj"))
        self.assertNotIn("below the noise", done.stderr)
        done = run("lines", self.folder / "noisy.ply", *self.outputs("obj"), "--tolerance", "1e-5", "--overwrite")
        self.assertIn("--tolerance 1e-05 is below the noise of the points, 0.0", done.stderr)
        self.assertGreater(self.stated_count(done), 0)

    def test_odd_clouds(self):
        p, n, label = cube(3000)
        write_ply(self.folder / "one.ply", p[:1], n[:1], np.full(1, 2, np.uint8))
        self.assertIn("0 curves", run("lines", self.folder / "one.ply", *self.outputs("obj")).stderr)
        p[::7] = np.nan
        n[::11] = 0
        write_ply(self.folder / "nan.ply", p, n, label)
        run("lines", self.folder / "nan.ply", *self.outputs(), "--overwrite")
        for _, points in geojson(self.made["geojson"]):
            self.assertTrue(np.isfinite(points).all())
        write_ply(self.folder / "odd.ply", *cube(3000)[:2], np.full(3000, 17, np.uint8))
        done = run("lines", self.folder / "odd.ply", *self.outputs("obj"), "--overwrite")
        self.assertIn("3000 labels are not edge classes", done.stderr)
        self.assertIn("--classify labels the cloud anew", done.stderr)

    def test_options_out_of_range(self):
        path = self.labelled_cube()
        before = set(os.listdir(self.folder))
        bad = [(option, value) for option in ("--tolerance", "--gap", "--min-length", "--angle")
               for value in ("0", "-1", "nan", "inf", "1e999", "x", "")]
        bad += [("--angle", "181"), ("--min-confidence", "1.5"), ("--min-confidence", "nan"),
                ("--min-dihedral", "200"), ("--min-points", "-1"), ("--class", "sharp,blunt"),
                ("--kind", "spline"), ("--dxf-version", "2018"), ("--view", "below"),
                ("--unit", "yard"), ("--model", "none such")]
        for option, value in bad:
            done = run("lines", path, "-o", self.folder / "a.dxf", option + "=" + value, expect=2)
            self.assertTrue(option in done.stderr or value in done.stderr, done.stderr)
        run("lines", path, expect=2)
        done = run("lines", path, "-o", self.folder / "a.dxf", "--unit", "m", "--dxf-version", "r12",
                   expect=2)
        self.assertIn("R12 has no unit", done.stderr)
        run("lines", path, "-o", self.folder / "a.shp", expect=2)
        run("lines", path, "-o", self.folder / "a.obj", "-o", self.folder / "." / "a.obj", expect=2)
        self.assertEqual(set(os.listdir(self.folder)), before)

    def test_inputs_that_cannot_be_used(self):
        out = ("-o", self.folder / "a.dxf")
        run("lines", self.folder / "none.ply", *out, expect=3)
        (self.folder / "text.ply").write_text("no ply\n")
        run("lines", self.folder / "text.ply", *out, expect=3)
        write_ply(self.folder / "empty.ply", np.zeros((0, 3)))
        run("lines", self.folder / "empty.ply", *out, expect=4)
        (self.folder / "half.ply").write_text(
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
            "property float z\nproperty float edge_class\nend_header\n0 0 0 0.5\n")
        self.assertIn("no class", run("lines", self.folder / "half.ply", *out, expect=4).stderr)
        run("lines", self.labelled_cube(), "-o", self.folder / "no" / "a.dxf", expect=1)
        done = run("lines", self.folder, *out, expect=2)
        self.assertIn("lines takes one cloud", done.stderr)

    def test_a_file_of_lines_is_told(self):
        run("lines", self.labelled_cube(), *self.outputs("ply", "obj"), "--stage", "creases")
        for name in ("ply", "obj"):
            done = run("lines", self.made[name], "-o", self.folder / f"{name}.dxf")
            self.assertIn(f".{name}: has lines: their vertices are taken", done.stderr)

    def test_the_input_is_never_an_output(self):
        path = self.folder / "in.ply"
        write_ply(path, *cube(3000))
        before = path.read_bytes()
        for options in (("-o", path), ("-o", self.folder / "a.obj", "--preview", path)):
            run("lines", path, *options, "--overwrite", expect=2)
        self.assertEqual(path.read_bytes(), before)

    def test_filters_by_attributes(self):
        path = self.labelled_cube()
        for options, left in (((), 12), (("--min-points", "5"), 12), (("--min-points", "9999"), 0),
                              (("--min-dihedral", "60"), 12), (("--min-dihedral", "120"), 0)):
            run("lines", path, *self.outputs("geojson"), "--overwrite", *options)
            self.assertEqual(len(geojson(self.made["geojson"])), left, options)

    def test_nothing_is_replaced_or_left_half_written(self):
        path = self.labelled_cube()
        precious = self.folder / "out.obj"
        precious.write_text("precious")
        done = run("lines", path, *self.outputs("dxf", "obj"), expect=2)
        self.assertIn("--overwrite", done.stderr)
        self.assertEqual(precious.read_text(), "precious")
        self.assertFalse(self.made["dxf"].exists())
        precious.unlink()
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (200, 200))
        for name in FORMATS:
            done = run("lines", path, *self.outputs(name), expect=1, preexec_fn=limit)
            self.assertIn(f"out.{name}", done.stderr)
        self.assertEqual(os.listdir(self.folder), [path.name])


if __name__ == "__main__":
    unittest.main()
