"""Several inputs at once: what is refused before the work, what is passed over, what is left behind."""
import os
import resource
import unittest

import numpy as np

from las_test import FORMATS, las, random_rows
from support import CliTest, cube, read_ply, run, write_ply


class Inputs(CliTest):
    def cloud(self, name, **options):
        path = self.folder / name
        path.parent.mkdir(exist_ok=True)
        write_ply(path, *cube(200)[:2], **options)
        return path

    def names(self, folder=""):
        return sorted(os.listdir(self.folder / folder))

    def test_codes_that_a_las_file_cannot_hold_are_refused_before_the_work(self):
        source, out = self.folder / "old.las", self.folder / "out.las"
        source.write_bytes(las(3, random_rows(FORMATS[3], 300)))
        run("convert", source, "-o", self.folder / "old.ply")
        run("convert", source, "-o", self.folder / "new.copc.laz")
        before = self.names()
        for name, more in (("old.las", ()), ("old.ply", ()), ("old.ply", ("--max-memory", "1M"))):
            said = run("classify", self.folder / name, "-o", out, "--las-classification", "1=20,2=64",
                       "--progress", "plain", *more, expect=2).stderr
            self.assertIn(f"{name}: --las-classification 2=64 does not fit point format 3, which {out} keeps: its "
                          "codes are 0 to 31", said)
            self.assertNotIn("describe", said)
            self.assertEqual(self.names(), before)
        # Other outputs hold all codes, and the example of the help suits every LAS file.
        run("classify", source, "-o", self.folder / "b.copc.laz", "--las-classification", "2=64")
        run("classify", source, "-o", self.folder / "b.ply", "--las-classification", "2=64")
        self.assertIn("2=31 sets sharp edges to 31", " ".join(run("classify", "--help").stdout.split()))
        run("classify", source, "-o", out, "--las-classification", "2=31")
        run("convert", out, "-o", self.folder / "out.ply")
        rows, _ = read_ply(self.folder / "out.ply")
        self.assertTrue(np.all(rows["Classification"][rows["scalar_edge_class"] == 2] == 31))

    def test_positions_that_las_cannot_hold_are_refused_before_the_work(self):
        p, _, _ = cube(500)
        for bad, said in ((np.nan, "out.laz: point 7: LAS cannot hold positions that are not finite; PLY, PCD and text can"),
                          (1e30, "out.laz: LAS cannot hold coordinates from -0.5 to 1e+30, not even in steps of 1; does")):
            p[7] = bad
            write_ply(self.folder / "a.ply", p, position_type="double")
            for command, work in (("classify", "describe"), ("normals", "neighbours")):
                done = run(command, self.folder / "a.ply", "-o", self.folder / "out.laz", "--progress", "plain", expect=4)
                self.assertIn(said, done.stderr)
                self.assertNotIn(work, done.stderr)
            run("classify", self.folder / "a.ply", "-o", self.folder / "out.ply", "--overwrite")

    def test_hidden_files_of_a_folder_are_no_inputs(self):
        (self.folder / "in").mkdir()
        self.cloud("in/a.ply")
        hidden = self.folder / "in/._a.ply"
        hidden.write_bytes(bytes(100))
        run("classify", self.folder / "in", "--out-dir", self.folder / "out")
        self.assertEqual(self.names("out"), ["a_edges.ply"])
        run("tiles", "plan", self.folder / "in", "-o", self.folder / "p.json")
        run("classify", hidden, "--out-dir", self.folder / "out", expect=3)

    def test_results_beside_the_inputs_are_no_inputs_of_another_folder(self):
        self.cloud("in/s.ply")
        run("classify", self.folder / "in")
        said = run("classify", self.folder / "in", "--out-dir", self.folder / "out").stderr
        self.assertIn("1 file left out: it is the result of another input", said)
        self.assertEqual(self.names("out"), ["s_edges.ply"])

    def test_the_result_of_a_laz_file_is_one(self):
        for name in ("a.LAZ", "b.copc.laz", "c.las"):
            run("convert", self.cloud("s.ply"), "-o", self.folder / name)
        (self.folder / "s.ply").unlink()
        run("classify", self.folder, "--out-dir", self.folder / "out")
        self.assertEqual(self.names("out"), ["a_edges.laz", "b_edges.laz", "c_edges.las"])
        sizes = [(self.folder / "out" / name).stat().st_size for name in self.names("out")]
        self.assertLess(max(sizes[:2]), sizes[2])
        # Those of earlier versions are known as results, too.
        os.rename(self.folder / "out/a_edges.laz", self.folder / "a_edges.las")
        said = run("classify", self.folder, "--out-dir", self.folder / "out", "--overwrite").stderr
        self.assertIn("1 file left out: it is the result of another input", said)

    def test_two_results_of_one_name_are_refused_and_both_inputs_named(self):
        inputs = [self.cloud("a/s.ply"), self.cloud("b/s.ply")]
        out = self.folder / "out" / "deep"
        said = run("classify", *inputs, "--out-dir", out, expect=2).stderr
        self.assertIn(f"{out}/s_edges.ply: the results of {inputs[0]} and {inputs[1]} would both be written here", said)
        self.assertEqual(self.names(), ["a", "b"])
        (self.folder / "out").mkdir()
        run("classify", *inputs, "--out-dir", f"{out}/", expect=2)
        run("classify", inputs[0], "-o", self.folder / "x.ply", "--out-dir", out, expect=2)
        self.assertEqual(self.names("out"), [])

    def test_texts_in_a_folder_that_are_no_points_are_passed_over(self):
        self.cloud("in/a.ply")
        row = "".join(f"{x} {y} {x * y % 3}\n" for x in range(8) for y in range(8))
        points = {"count.txt": "64\n" + row, "names.csv": "x,y,z\n" + row.replace(" ", ","), "note.asc": "# a\n" + row,
                  "commas.txt": row.replace(" ", ",5;").replace("\n", ",5\n")}
        prose = {"README.txt": "This folder holds\na cloud: x y z\n", "empty.txt": "", "1.txt": "1 tree\n2 trees\n",
                 "list.csv": "name;points\na;200\n", "axes.txt": "Axes: x y z\nz is up\n", "only.asc": "# a comment\n"}
        for name, text in (points | prose).items():
            (self.folder / "in" / name).write_text(text)
        folder, out = self.folder / "in", self.folder / "out"
        said = run("classify", folder, "--out-dir", out).stderr
        self.assertIn(f"{len(points) + 1} classified, 0 skipped", said)
        for name in prose:
            self.assertEqual(said.count(f"warning: {folder}/{name}: does not look like a text of points: skipped"),
                             1, said)
        said = run("classify", folder, "--out-dir", out, "--skip-existing").stderr
        self.assertIn(f"0 classified, {len(points) + 1} skipped because their results exist, 0 failed", said)
        # One that is named, or that begins like points, is an error as ever.
        self.assertIn("README.txt:1: expected numbers", run("info", folder / "README.txt", expect=3).stderr)
        (folder / "broken.txt").write_text("0 0 0\n1 1 one\n")
        self.assertIn("broken.txt:2: ", run("info", folder, expect=3).stderr)
        (self.folder / "other").mkdir()
        (self.folder / "other/README.txt").write_text("Nothing here.\n")
        self.assertIn("no point files in it", run("classify", self.folder / "other", expect=4).stderr)

    def test_convert_reads_text_beyond_memory_in_parts(self):
        text = self.folder / "a.xyz"
        text.write_bytes(b"# x y z nx ny nz q\n" + b"0.5 1.5 2.5 0 0 1 7\n1 2 3 0 0.6 0.8 255\n" * 1_250_000)
        whole, parts = self.folder / "whole.ply", self.folder / "parts.ply"
        run("convert", text, "-o", whole)
        limit = 350_000_000
        run("convert", text, "-o", parts, "--threads", 1,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
        self.assertEqual(parts.read_bytes(), whole.read_bytes())


if __name__ == "__main__":
    unittest.main()
