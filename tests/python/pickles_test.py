"""Clouds, results and curves in pickles and copies, as multiprocessing sends them."""

import copy
import multiprocessing
import pickle
import unittest
import warnings

import numpy as np

import pcednet
from las_test import NEW, SCALE, las, vlr
from support import CliTest, cube, write_ply

WKT = b'PROJCS["UTM",UNIT["metre",1],AUTHORITY["EPSG","25832"]]\0'
WAYS = {"pickle": lambda it: pickle.loads(pickle.dumps(it)), "deepcopy": copy.deepcopy,
        "copy": copy.copy}
FACE = b"element face 1\nproperty list uchar int vertex_indices\n"


class Pickles(CliTest):
    def setUp(self):
        super().setUp()
        warnings.simplefilter("ignore", pcednet.PcednetWarning)

    def files(self):
        """A PLY with long normals, faces and comments; a LAS with a coordinate system."""
        positions, normals, labels = cube(2000)
        write_ply(self.path("a.ply"), positions, 2 * normals, labels, height=positions[:, 2])
        header, rows = self.path("a.ply").read_bytes().split(b"end_header\n", 1)
        self.path("a.ply").write_bytes(header + b"comment a scan\n" + FACE + b"end_header\n" + rows +
                                       b"\x03" + np.arange(3, dtype="<i4").tobytes())
        records = np.zeros(len(positions), NEW)
        for i, axis in enumerate("XYZ"):
            records[axis] = np.round((100 + 10 * positions[:, i]) / SCALE[i])
        self.path("a.las").write_bytes(las(6, records, [vlr(b"LASF_Projection", 2112, WKT)]))
        return self.path("a.ply"), self.path("a.las")

    def test_a_cloud_keeps_everything(self):
        for file in self.files():
            cloud = pcednet.read(file)
            pcednet.write(self.path("wanted" + file.suffix), cloud)
            wanted = self.path("wanted" + file.suffix).read_bytes()
            for name, way in WAYS.items():
                with self.subTest(name, file=file.name):
                    other = way(cloud)
                    out = self.path(name + file.suffix)
                    pcednet.write(out, other)
                    self.assertEqual(out.read_bytes(), wanted)
                    self.assertEqual((other.name, other.comments), (cloud.name, cloud.comments))
        self.assertIn(FACE, self.path("deepcopy.ply").read_bytes())
        self.assertIn(b"25832", self.path("deepcopy.las").read_bytes())

    def test_a_deep_copy_is_independent(self):
        cloud = pcednet.read(self.files()[0])
        other = copy.deepcopy(cloud)
        other.xyz[0] = 9
        other["height"] = np.zeros(2000)
        self.assertNotEqual(cloud.xyz[0, 0], 9)
        self.assertTrue(cloud["height"].any())

    def test_estimated_normals_stay_known(self):
        positions = cube(2000)[0]
        pcednet.write(self.path("b.ply"), positions, pcednet.classify(positions))
        cloud = pcednet.read(self.path("b.ply"))
        self.assertTrue(cloud._has_estimates())
        self.assertTrue(pickle.loads(pickle.dumps(cloud))._has_estimates())

    def test_lines_keep_their_curves_and_their_coordinate_system(self):
        cloud = next(pcednet.generate("lines", only="roof_mansard"))
        cloud._kept = pcednet.read(self.files()[1])._kept
        lines = pcednet.lines(cloud, cloud.labels, stage="curves")
        self.assertGreater(len(lines), 3)
        lines.write(self.path("wanted.gpkg"))
        for name, way in WAYS.items():
            other = way(lines)
            self.assertIsInstance(other, pcednet.Lines)
            other.write(self.path(f"{name}.gpkg"))
            self.assertEqual(self.path(f"{name}.gpkg").read_bytes(),
                             self.path("wanted.gpkg").read_bytes())
        self.assertEqual(len(pickle.loads(pickle.dumps(cloud)).curves), len(cloud.curves))

    def test_a_curve_keeps_its_numbers(self):
        names = ("kind", "label", "closed", "radius", "confidence", "dihedral_angle", "support",
                 "length")
        kinds = set()
        for cloud in pcednet.generate("lines", only="housing"):
            for curve in cloud.curves:
                kinds.add(curve.kind)
                for way in WAYS.values():
                    other = way(curve)
                    for name in names:
                        self.assertEqual(getattr(other, name), getattr(curve, name), name)
                    for name in ("points", "centre", "axis"):
                        np.testing.assert_array_equal(getattr(other, name), getattr(curve, name))
            break
        self.assertGreater(len(kinds), 1)

    def test_a_process_classifies_a_cloud(self):
        positions, normals, _ = cube(1500)
        clouds = [pcednet.Cloud(positions, normals), pcednet.Cloud(positions + 9, normals)]
        with multiprocessing.get_context("spawn").Pool(1) as pool:
            results = pool.map(pcednet.classify, clouds)
        for cloud, result in zip(clouds, results):
            np.testing.assert_array_equal(result.labels, pcednet.classify(cloud).labels)
            self.assertEqual(result.model.name, "general")


if __name__ == "__main__":
    unittest.main()
