"""`pcednet lines`: whose labels it draws, of which column and by which codes."""
import unittest

import numpy as np

from lines_support import LinesTest
from support import cube, run, write_ply


class LinesLabels(LinesTest):
    def test_labels_from_the_codes_of_las(self):
        """Edges that were corrected in a program for LAS: the codes change, other columns stay."""
        p, n, label = cube(8000)
        plain, coded = self.folder / "plain.csv", self.folder / "coded.csv"
        rows = np.column_stack([np.round(p, 5), n, label])
        np.savetxt(plain, rows, fmt=["%.5f"] * 6 + ["%d"], delimiter=",", header="x,y,z,nx,ny,nz,label", comments="")
        rows = np.column_stack([rows[:, :6], 0 * label, np.choose(label, [6, 65, 64])])
        np.savetxt(coded, rows, fmt=["%.5f"] * 6 + ["%d"] * 2, delimiter=",",
                   header="x,y,z,nx,ny,nz,edge_class,Classification", comments="")
        las_file = self.folder / "coded.las"
        run("convert", coded, "-o", las_file)
        run("lines", plain, "-o", self.folder / "plain.obj")
        for cloud in (coded, las_file):
            done = run("lines", cloud, *self.outputs("obj"), "--las-classification", "2=64,1=65,0=6", "--overwrite")
            self.assertIn("labels from its field Classification", done.stderr)
            self.assertEqual(self.stated_count(done), 12)
            if cloud == coded:
                self.assertEqual(self.made["obj"].read_bytes(), (self.folder / "plain.obj").read_bytes())
        of_cloudcompare = self.folder / "scalar.csv"
        of_cloudcompare.write_text(coded.read_text().replace(",Classification", ",scalar_Classification", 1))
        done = run("lines", of_cloudcompare, *self.outputs("obj"), "--las-classification", "2=64,1=65,0=6", "--overwrite")
        self.assertIn("labels from its field Classification", done.stderr)
        self.assertEqual(self.made["obj"].read_bytes(), (self.folder / "plain.obj").read_bytes())
        in_tiles = run("lines", las_file, *self.outputs("obj"), "--las-classification", "2=64,1=65,0=6", "--overwrite",
                       "--max-memory", "90M")
        self.assertEqual(self.stated_count(in_tiles), 12)
        out = (*self.outputs("obj"), "--overwrite", "--las-classification")
        self.assertIn("holds 6, 64", run("lines", las_file, *out, "2=7", expect=4).stderr)
        self.assertIn("no field Classification", run("lines", plain, *out, "2=64", expect=4).stderr)
        for bad in (["x"], ["2=64", "--classify"], ["2=64", "--model", "cad"]):
            self.assertIn("--las-classification", run("lines", las_file, *out, *bad, expect=2).stderr)

    def test_labels_are_used_unless_asked_otherwise(self):
        p, n, _ = cube(4000)
        write_ply(self.folder / "a.ply", p, n, np.zeros(len(p), np.uint8))
        done = run("lines", self.folder / "a.ply", *self.outputs("geojson"))
        self.assertIn("its labels are used, but none is an edge class; --classify", done.stderr)
        self.assertIn("no edges", done.stderr)
        done = run("lines", self.folder / "a.ply", *self.outputs("geojson"), "--classify",
                   "--overwrite")
        self.assertNotIn("no edges", done.stderr)
        done = run("lines", self.folder / "a.ply", *self.outputs("geojson"), "--model", "cad",
                   "--overwrite")
        self.assertNotIn("no edges", done.stderr)

    def test_says_whose_labels_it_uses(self):
        done = run("lines", self.labelled_cube(), *self.outputs("obj"))
        self.assertRegex(done.stderr, r"cube.ply: its labels are used: \d+ sharp-edge; --classify")
        done = run("lines", self.labelled_cube(), *self.outputs("obj"), "--classify", "--overwrite")
        self.assertIn("its labels are not used: classified by model general", done.stderr)

    def test_says_which_of_two_columns_that_differ_it_draws(self):
        p, n, label = cube(3000)
        cloud = self.folder / "two.ply"
        for other, warns in ((label, False), (np.zeros_like(label), True)):
            write_ply(cloud, p, n, other, scalar_edge_class=label)
            said = run("lines", cloud, "-o", self.folder / "two.obj", "--overwrite").stderr
            self.assertEqual("its columns edge_class and label differ: edge_class is drawn" in said, warns)
            self.assertNotIn(" 0 curves", said)

    def test_a_column_of_another_program_is_named(self):
        p, _, label = cube(8000)
        for column, said in (("is_edge", "labels from its column is_edge"),
                             ("class", "its column class is not taken for edge classes")):
            path = self.folder / f"{column}.csv"
            np.savetxt(path, np.column_stack([p, label == 2]), fmt="%.9g", delimiter=",",
                       header="x,y,z," + column, comments="")
            done = run("lines", path, *self.outputs("obj"), "--overwrite")
            self.assertIn(f"{path}: {said}", done.stderr)
            self.assertEqual("its labels are used" in done.stderr, column == "is_edge")
            self.assertEqual(self.stated_count(done), 12)
            las_file = path.with_suffix(".las")
            run("convert", path, "-o", las_file)
            done = run("lines", las_file, *self.outputs("obj"), "--overwrite", "--max-memory", "90M")
            self.assertIn("classified in tiles", done.stderr)
            self.assertEqual(f"{las_file}: its column is_edge is read as labels only of a cloud that fits into memory\n"
                             in done.stderr, column == "is_edge")

    def test_labels_of_las_count_in_any_type(self):
        """Extra bytes of a label are float where CloudCompare writes them. %6C keeps the reader of PLY from the column."""
        p, n, label = cube(8000)
        plain, las_file = self.folder / "plain.ply", self.folder / "a.las"
        for numbers, expect in ((label, 0), (2 * label, 4)):
            write_ply(plain, p, n, **{"%6Cabel": numbers})
            run("convert", plain, "-o", las_file, "--overwrite")
            self.assertRegex(run("info", las_file).stdout, "float32 label, 0 to ")
            done = run("train", las_file, "-o", self.folder / "m.safetensors", "--epochs", 1,
                       "--overwrite", expect=expect)
            self.assertIn(f"{las_file}: " + ("labels from its column label\n" if expect == 0 else
                                            "has no labels, as its column label holds 4, which is none\n"), done.stderr)
        write_ply(plain, p, n, **{"%6Cabel": label})
        done = run("lines", plain, *self.outputs("obj"))
        self.assertIn("labels from its column label\n", done.stderr)
        self.assertEqual(self.stated_count(done), 12)

    def test_labels_that_are_probabilities_are_told(self):
        p, _, label = cube(3000)
        path = self.folder / "p.csv"
        np.savetxt(path, np.column_stack([p, np.where(label == 2, 0.9, 0)]), fmt="%.9g", delimiter=",",
                   header="x,y,z,label", comments="")
        done = run("lines", path, *self.outputs("obj"))
        self.assertIn(f"{path}: its column label is not taken for classes: it holds 0.9\n", done.stderr)

    def test_a_classified_file_has_the_lines_of_the_cloud_itself(self):
        """Its normals are estimates of what it was written with, its coordinates are rounded."""
        p, _, _ = cube(8000)
        for name, text in {"rounded": "%.2f", "exact": "%.17g"}.items():
            raw, labelled = self.folder / f"{name}.xyz", self.folder / f"{name}.ply"
            np.savetxt(raw, p, fmt=text)
            run("lines", raw, *self.outputs("obj"), "--overwrite")
            drawn = self.made["obj"].read_bytes()
            self.assertGreater(len(drawn), 500)
            run("classify", raw, "-o", labelled)
            done = run("lines", labelled, *self.outputs("obj"), "--overwrite")
            self.assertIn("its labels are used", done.stderr)
            self.assertEqual(self.made["obj"].read_bytes(), drawn, name)

    def test_a_cloud_whose_points_are_all_unlabelled_is_classified(self):
        p, n, _ = cube(4000)
        write_ply(self.folder / "bare.ply", p, n)
        run("lines", self.folder / "bare.ply", *self.outputs("obj"))
        drawn = self.made["obj"].read_bytes()
        write_ply(self.folder / "none.ply", p, n, np.full(len(p), 255, np.uint8))
        done = run("lines", self.folder / "none.ply", *self.outputs("obj"), "--overwrite")
        self.assertIn("all points are unlabelled (255): classified by model general", done.stderr)
        self.assertEqual(self.made["obj"].read_bytes(), drawn)

    def test_boundary_labels_alone_are_not_called_no_edges_without_a_word(self):
        random = np.random.default_rng(3)
        p = np.column_stack([random.uniform(0, 4, (6000, 2)), np.zeros(6000)])
        label = np.where(np.minimum(p, 4 - p)[:, :2].min(1) < 0.05, 3, 0).astype(np.uint8)
        write_ply(self.folder / "floor.ply", p, np.tile([0, 0, 1.0], (6000, 1)), label)
        done = run("lines", self.folder / "floor.ply", *self.outputs("obj"))
        count = np.count_nonzero(label)
        self.assertIn(f"no edges: what was written holds no lines; --boundaries draws where the surface ends "
                      f"({count} points)", done.stderr)
        done = run("lines", self.folder / "floor.ply", *self.outputs("obj"), "--boundaries", "--overwrite")
        self.assertGreater(self.stated_count(done), 3)

    def test_probabilities_are_from_0_to_1(self):
        p, n, label = cube(3000)
        for bad in (np.nan, 90):
            values = np.full(3000, 0.5, np.float32)
            values[7] = bad
            write_ply(self.folder / "p.ply", p, n, label, scalar_p_sharp=values)
            done = run("lines", self.folder / "p.ply", "-o", self.folder / "p.obj", expect=4)
            self.assertIn("scalar_p_sharp of point 7", done.stderr)


if __name__ == "__main__":
    unittest.main()
