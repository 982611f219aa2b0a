"""Point files in and out, as the command line reads and writes them; generated clouds."""

import pathlib
import pickle
import subprocess
import tempfile
import unittest
import warnings

import numpy as np

import pcednet
from support import PROGRAM, SOURCE, CliTest, cube, run, write_ply


class Files(CliTest):
    def setUp(self):
        super().setUp()
        warnings.simplefilter("ignore", pcednet.PcednetWarning)

    def assert_same_bytes(self, ours, theirs):
        self.assertEqual(ours.read_bytes(), theirs.read_bytes(), ours.name)

    def test_results_are_the_files_of_the_program(self):
        positions, normals, labels = cube(2000)
        write_ply(self.path("given.ply"), positions, 2 * normals, labels)
        write_ply(self.path("bare.ply"), positions + 5e5, position_type="double")
        run("convert", self.path("given.ply"), "-o", self.path("given.las"))
        for name in ("given.ply", "bare.ply", "given.las", "theirs_bare.ply"):
            ours, theirs = self.path(f"ours_{name}"), self.path(f"theirs_{name}")
            run("classify", self.path(name), "-o", theirs)
            cloud = pcednet.read(self.path(name))
            pcednet.write(ours, cloud, pcednet.classify(cloud))
            self.assert_same_bytes(ours, theirs)
            copied = self.path(f"copy_{name}")
            pcednet.write(copied, pcednet.read(theirs))
            again = self.path(f"again_{name}")
            run("convert", theirs, "-o", again)
            self.assert_same_bytes(copied, again)

    def test_reading_keeps_order_types_and_fields(self):
        cloud = pcednet.read(SOURCE / "examples" / "building.ply")
        self.assertEqual((len(cloud), cloud.xyz.dtype, cloud.name),
                         (140_000, np.float64, "building"))
        self.assertEqual(cloud.labels.dtype, np.uint8)
        self.assertIsNone(cloud.normals)
        np.testing.assert_array_equal(np.asarray(cloud), cloud.xyz)

    def test_text_of_other_encodings_is_kept(self):
        """Names, comments and file names in Latin-1."""
        positions, normals, labels = cube(1000)
        write_ply(self.path("given.ply"), positions, normals, labels)
        given = self.path("given.ply").read_bytes()
        self.assertIn(b"property uchar label\n", given)
        latin = given.replace(b"element vertex", b"comment Gr\xfc\xdfe\nelement vertex").replace(
            b"property uchar label\n", b"property uchar H\xf6he\n")
        source = self.path("Geb\udce4ude.ply")
        source.write_bytes(latin)
        cloud = pcednet.read(source)
        self.assertEqual(cloud.comments[-1].encode(errors="surrogateescape"), b"Gr\xfc\xdfe")
        np.testing.assert_array_equal(cloud["H\udcf6he"], labels)
        for name in ("copy.ply", "copy.las"):
            pcednet.write(self.path(f"our_{name}"), pickle.loads(pickle.dumps(cloud)))
            run("convert", source, "-o", self.path(f"their_{name}"), errors="surrogateescape")
            self.assert_same_bytes(self.path(f"our_{name}"), self.path(f"their_{name}"))
        run("classify", source, "-o", self.path("theirs.ply"), errors="surrogateescape")
        pcednet.write(self.path("ours.ply"), cloud, pcednet.classify(cloud))
        self.assert_same_bytes(self.path("ours.ply"), self.path("theirs.ply"))
        cloud.labels = labels
        self.assertEqual(len(pcednet.train(cloud, epochs=1).history), 1)
        source.write_bytes(latin[:-9])
        with self.assertRaisesRegex(pcednet.UnreadableError, "Geb\udce4ude.ply: declares 1000 rows"):
            pcednet.read(source)

    def test_arrays_come_back_as_they_went(self):
        positions, normals, labels = cube(500)
        random = np.random.default_rng(2)
        fields = {"a_byte": random.integers(0, 255, 500).astype(np.uint8),
                  "a_short": random.integers(-9, 9, 500).astype(np.int16),
                  "a_float": random.normal(size=500).astype(np.float32),
                  "a_double": random.normal(size=500)}
        colours = random.integers(0, 255, (500, 3)).astype(np.uint8)
        for dtype in (np.float32, np.float64):
            xyz = positions.astype(dtype)
            file = self.path(f"{np.dtype(dtype)}.ply")
            pcednet.write(file, xyz, normals=normals, colours=colours, labels=labels,
                          attributes={**fields, "a_flag": fields["a_byte"] > 99,
                                      "strided": fields["a_double"][::-1]})
            self.assertIn(b"property float x" if dtype == np.float32 else b"property double x",
                          file.read_bytes()[:100])
            back = pcednet.read(file)
            np.testing.assert_array_equal(back.xyz, xyz)
            np.testing.assert_array_equal(back.colours, colours)
            np.testing.assert_array_equal(back.labels, labels)
            np.testing.assert_allclose(back.normals, normals, atol=1e-7)
            for name, values in fields.items():
                self.assertEqual(back[name].dtype, values.dtype, name)
                np.testing.assert_array_equal(back[name], values)
            np.testing.assert_array_equal(back["a_flag"], fields["a_byte"] > 99)
            np.testing.assert_array_equal(back["strided"], fields["a_double"][::-1])

    def test_whole_numbers_are_one_column_that_other_programs_read(self):
        """Numpy makes them of 64 bits, of which PLY would have two columns."""
        positions, _, labels = cube(300)
        ids, large = np.arange(300) - 7, np.arange(300) + 2**40
        pcednet.write(self.path("a.ply"), positions, attributes={
            "cluster": ids, "count": np.arange(300, dtype=np.uint64) + 2**31, "time": large, "label": labels.astype(int)})
        header = self.path("a.ply").read_bytes()[:500]
        for column in (b"int cluster", b"uint count", b"uint time_low32", b"int time_high32", b"int label"):
            self.assertIn(b"property " + column + b"\n", header)
        cloud = pcednet.read(self.path("a.ply"))
        np.testing.assert_array_equal(cloud["cluster"], ids)
        np.testing.assert_array_equal(cloud["time"], large)
        np.testing.assert_array_equal(cloud.labels, labels)
        # What a file has in 64 bits stays so, as in the program.
        pcednet.write(self.path("b.ply"), cloud.select(large < 2**40 + 9))
        cloud["time"] -= 2**40
        pcednet.write(self.path("c.ply"), pickle.loads(pickle.dumps(cloud)))
        for name in ("b.ply", "c.ply"):
            self.assertIn(b"property uint time_low32\n", self.path(name).read_bytes()[:500])

    def test_paths_may_be_bytes(self):
        positions = cube(300)[0]
        cloud, model = (str(self.path(name)).encode() for name in ("a.ply", "m.safetensors"))
        pcednet.write(cloud, positions)
        self.assertEqual(pcednet.read(cloud).name, "a")
        pcednet.Model.load(b"cad").save(model)
        self.assertEqual(pcednet.Model.load(model).name, pcednet.Model.load("cad").name)
        with self.assertRaisesRegex(pcednet.MissingFileError, "^none: neither a file"):
            pcednet.Model.load(b"none")

    def test_a_cloud_may_be_changed_and_cut(self):
        positions, normals, labels = cube(500)
        write_ply(self.path("in.ply"), positions, normals, labels)
        cloud = pcednet.read(self.path("in.ply"))
        cloud["height"] = cloud.xyz[:, 2].astype(np.float32)
        cloud.normals = -2 * cloud.normals
        with self.assertRaisesRegex(KeyError, "no attribute 'width': there are height"):
            cloud["width"]
        for points in (slice(5), labels == 2, 0):
            with self.assertRaisesRegex(TypeError, r"some points are cloud.select\(points\)"):
                cloud[points]
        self.assertIs(np.asarray(cloud), cloud.xyz)
        self.assertIsNot(cloud.__array__(copy=True), cloud.xyz)  # as numpy 2 asks
        part = cloud.select(cloud.labels == 2)
        pcednet.write(self.path("part.ply"), part)
        back = pcednet.read(self.path("part.ply"))
        self.assertEqual(len(back), np.count_nonzero(labels == 2))
        np.testing.assert_array_equal(back.xyz, cloud.xyz[labels == 2])
        np.testing.assert_allclose(back.normals, -normals[labels == 2], atol=1e-7)
        np.testing.assert_array_equal(back["height"], part.xyz[:, 2].astype(np.float32))
        self.assertIn(b"property float x", self.path("part.ply").read_bytes()[:100])
        cloud.xyz = cloud.xyz.tolist()
        np.testing.assert_array_equal(cloud.select([3, 1]).xyz, np.asarray(cloud.xyz)[[3, 1]])

    def test_errors_are_of_python_kinds(self):
        positions = cube(50)[0]
        with self.assertRaisesRegex(FileNotFoundError, "absent.ply: no such file"):
            pcednet.read(self.path("absent.ply"))
        self.path("damaged.ply").write_bytes(b"ply\nformat ascii 1.0\nelement vertex 3\n")
        with self.assertRaises(pcednet.UnreadableError) as raised:
            pcednet.read(self.path("damaged.ply"))
        self.assertIsInstance(raised.exception, OSError)
        pcednet.write(self.path("there.ply"), positions)
        with self.assertRaisesRegex(FileExistsError, "exists already; give overwrite=True"):
            pcednet.write(self.path("there.ply"), positions)
        pcednet.write(self.path("there.ply"), positions, overwrite=True)
        with self.assertRaises(ValueError):
            pcednet.write(self.path("cloud.dwg"), positions)
        with self.assertRaises(OSError):
            pcednet.write(self.path("no_folder/cloud.ply"), positions)
        for wrong in ({"colours": positions}, {"labels": np.zeros(3, np.uint8)},
                      {"attributes": {"f": np.zeros(3)}}, {"attributes": {"f": ["a"] * 50}},
                      {"labels": np.full(50, 7)}, {"normals": np.zeros((3, 3))}):
            with self.assertRaises(pcednet.UsageError, msg=wrong):
                pcednet.write(self.path("wrong.ply"), positions, **wrong)
        self.assertFalse(self.path("wrong.ply").exists())
        cloud = pcednet.Cloud(positions)
        with self.assertRaisesRegex(pcednet.UsageError, "of 50 points, the cloud has 49"):
            pcednet.write(self.path("x.ply"), cloud.select(range(49)),
                          type("Result", (), {"labels": np.zeros(50)}))

    def test_what_a_format_cannot_hold_is_a_warning(self):
        positions = cube(50)[0]
        with self.assertWarnsRegex(pcednet.PcednetWarning, "does not keep"):
            pcednet.write(self.path("cloud.obj"), positions, labels=np.zeros(50, np.uint8))

    def test_faces_of_a_mesh_are_told_and_sampled(self):
        self.path("a.obj").write_text("v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 0 4 4\nf 1 2 3 4\nf 3 4 5\n")
        mesh = pcednet.read(self.path("a.obj"))
        self.assertEqual((len(mesh), mesh.faces), (5, 2))
        labels = np.zeros(5, np.uint8)
        for use in (pcednet.describe, pcednet.classify, lambda mesh: pcednet.lines(mesh, labels), pcednet.lines):
            with warnings.catch_warnings(record=True) as told:
                warnings.simplefilter("always")
                try:
                    use(mesh)
                except pcednet.InsufficientError:
                    pass  # so few vertices are no surface
            said = [str(one.message) for one in told if "faces" in str(one.message)]
            self.assertEqual(said, ["a: 2 faces are not used, only their vertices: Cloud.sample(n) samples points on faces"])
        points = mesh.sample(1000, seed=5)
        run("convert", self.path("a.obj"), "-o", self.path("theirs.ply"), "--sample", 1000, "--seed", 5)
        pcednet.write(self.path("ours.ply"), points)
        self.assert_same_bytes(self.path("ours.ply"), self.path("theirs.ply"))
        self.assertEqual(points.faces, 0)
        self.assertEqual(mesh.select([0, 1]).faces, 0)
        with self.assertRaisesRegex(pcednet.InsufficientError, "no faces to sample"):
            points.sample(10)
        with self.assertRaises(pcednet.UsageError):
            mesh.sample(0)

    def test_scanners_of_a_cloud_are_used(self):
        positions = cube(3000)[0]
        cloud = pcednet.Cloud(positions)
        cloud.scanners = [[0.0, 0.0, 5.0], [5.0, 0.0, 0.0]]
        self.assertIsNone(cloud.viewpoint())
        cloud["scan"] = np.arange(3000) % 3  # the last is of no scanner
        places = cloud.viewpoint()
        self.assertTrue(np.isnan(places[2::3]).all())
        np.testing.assert_array_equal(places[1], [5, 0, 0])
        normals = pcednet.estimate_normals(cloud)
        facing = np.einsum("ij,ij->i", normals, places - positions)
        self.assertTrue((facing[np.arange(3000) % 3 < 2] >= 0).all())


class Generated(unittest.TestCase):
    def test_clouds_are_those_of_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            theirs = pathlib.Path(folder) / "theirs"
            run("generate", "lines", theirs, "--only", "roof_mansard", "--seed", "3")
            clouds = list(pcednet.generate("lines", 3, only="roof_mansard"))
            self.assertEqual(sorted(cloud.name for cloud in clouds),
                             sorted(file.stem for file in theirs.glob("*.ply")))
            cloud = clouds[0]
            ours = pathlib.Path(folder) / "ours.ply"
            pcednet.write(ours, cloud)
            self.assertEqual(ours.read_bytes(), (theirs / f"{cloud.name}.ply").read_bytes())
            self.assertGreater(len(cloud.curves), 3)
            self.assertIn(cloud.curves[0].kind, ("segment", "arc", "circle", "polyline"))

    def test_every_set_of_the_program_is_there(self):
        for name in ("sparse", "drawn", "pieces"):
            with tempfile.TemporaryDirectory() as folder:
                first, ours = next(pcednet.generate(name)), pathlib.Path(folder) / "ours.ply"
                pcednet.write(ours, first)
                with subprocess.Popen([PROGRAM, "generate", name, folder], text=True,
                                      stderr=subprocess.PIPE) as work:
                    lines = [work.stderr.readline() for _ in range(2)]  # the second: one is made
                    work.terminate()
                self.assertIn(first.name, lines[1])
                self.assertEqual(ours.read_bytes(),
                                 (pathlib.Path(folder) / f"{first.name}.ply").read_bytes())
        self.assertTrue(pcednet.generate("sparse", only="roof"))

    def test_they_are_made_one_by_one(self):
        clouds = pcednet.generate("default")  # nine and more: only the first is made
        first = next(clouds)
        self.assertEqual(len(first.labels), len(first))
        self.assertEqual(len(next(pcednet.generate("sample"))), 140_000)
        for wrong in ("shapes", ""):
            with self.assertRaisesRegex(pcednet.UsageError, "there are default, cad"):
                pcednet.generate(wrong)
        with self.assertRaisesRegex(pcednet.UsageError, "no cloud of cad"):
            pcednet.generate("cad", only="nothing like it")


if __name__ == "__main__":
    unittest.main()
