"""convert --keep-class, --drop-class, --drop-flag: the points that numpy chooses, with all they have."""
import unittest

import numpy as np

from las_test import FORMATS, las, points_of, random_rows, records_of, vlr
from support import CliTest, read_ply, run, write_ply

PART = 1 << 19  # points that convert reads at a time


class Filter(CliTest):
    def survey(self, n=2000, number=6):
        rows = random_rows(FORMATS[number], n)
        random = np.random.default_rng(7)
        codes = random.choice([1, 2, 6, 7, 18], n)
        if number > 5:
            rows["Classification"] = codes
            rows["returns"] = 0x11
        else:
            rows["classification"] = codes | (rows["classification"] & 0xE0)
        return rows, codes

    def write(self, rows, number=6):
        path = self.folder / "in.las"
        path.write_bytes(las(number, rows, [vlr(b"somebody", 7, b"kept as it is")]))
        return path

    def converted(self, source, *options, name="out.las"):
        target = self.folder / name
        self.told = run("convert", source, "-o", target, "--overwrite", *options).stderr
        return target

    def test_keeps_and_drops_by_class_and_flag(self):
        rows, codes = self.survey()
        source = self.write(rows)
        flags = rows["flags"]
        for options, kept in [
                (["--keep-class", "6"], codes == 6),
                (["--keep-class", "2,6"], np.isin(codes, [2, 6])),
                (["--drop-class", "7,18"], ~np.isin(codes, [7, 18])),
                (["--drop-flag", "withheld"], flags & 4 == 0),
                (["--drop-flag", "overlap,synthetic"], flags & 9 == 0),
                (["--keep-class", "6", "--drop-flag", "withheld"], (codes == 6) & (flags & 4 == 0))]:
            with self.subTest(options=options):
                data = self.converted(source, *options).read_bytes()
                self.assertEqual(points_of(data)[0], rows[kept].tobytes())
                self.assertEqual(records_of(data), [(b"somebody", 7, b"kept as it is")])
                self.assertIn(f"{kept.sum()} points of {len(rows)}", self.told)

    def test_takes_the_fields_of_other_formats(self):
        rows, codes = self.survey(number=1)
        withheld = rows["classification"] >> 7 == 1
        source = self.write(rows, number=1)
        ply = self.converted(source, "--drop-class", "7,18", name="a.ply")
        np.testing.assert_array_equal(read_ply(ply)[0]["Classification"],
                                      codes[~np.isin(codes, [7, 18])])
        text = self.converted(ply, "--keep-class", "6", "--drop-flag", "withheld", name="b.csv")
        self.assertEqual(len(text.read_text().splitlines()) - 1, ((codes == 6) & ~withheld).sum())
        spaced, _ = read_ply(self.converted(source, "--keep-class", "2", "--subsample", "0.5", name="c.ply"))
        self.assertEqual(set(spaced["Classification"]), {2})

    def test_takes_the_fields_as_cloudcompare_calls_them(self):
        p = np.random.default_rng(1).uniform(0, 1, (100, 3))
        codes = np.arange(100) % 3
        write_ply(self.folder / "cc.ply", p, scalar_Classification=codes.astype("<f4"))
        kept, _ = read_ply(self.converted(self.folder / "cc.ply", "--keep-class", "2", name="a.ply"))
        np.testing.assert_array_equal(kept["scalar_Classification"], codes[codes == 2])

    def test_reads_large_files_in_parts_of_which_the_first_may_be_left_out(self):
        rows, _ = self.survey(PART + 5000)
        rows["Classification"] = np.where(np.arange(len(rows)) < PART + 10, 2, 6)
        source = self.write(rows)
        data = self.converted(source, "--keep-class", "6").read_bytes()
        self.assertEqual(points_of(data)[0], rows[PART + 10:].tobytes())
        for name in ("out.laz", "out.ply", "out.copc.laz", "out.pcd", "out.csv"):
            self.converted(source, "--keep-class", "6", name=name)
            facts = run("info", self.folder / name).stdout
            self.assertRegex(facts, r"points +4990\n", name)
            self.assertRegex(facts, r"Classification, 6(\.0)? to 6", name)

    def test_refuses_what_keeps_no_point_or_has_no_such_field(self):
        rows, _ = self.survey()
        source = self.write(rows)
        out = ["-o", self.folder / "out.las"]
        self.assertIn("no point is left", run("convert", source, *out, "--keep-class", "99", expect=4).stderr)
        bare = self.folder / "bare.xyz"
        bare.write_text("0 0 0\n1 0 0\n0 1 0\n")
        self.assertIn("bare.xyz: has no field Classification",
                      run("convert", bare, *out, "--drop-class", "7", expect=4).stderr)
        for wrong in (["--keep-class", "256"], ["--drop-class", "x"], ["--drop-flag", "noise"],
                      ["--keep-class", "2", "--drop-class", "7"]):
            run("convert", source, *out, *wrong, expect=2)
        self.assertIn("is the input", run("convert", source, "-o", source, "--overwrite", "--drop-class", "7",
                                          expect=2).stderr)
        self.assertFalse((self.folder / "out.las").exists())

    def test_info_tells_what_leaves_noise_and_deleted_points_out(self):
        rows, codes = self.survey()
        facts = run("info", self.write(rows)).stdout
        self.assertIn(f"{np.isin(codes, [7, 18]).sum()} of 2000 points are of the classes 7 and 18, noise: labelled "
                      "like all others; convert --drop-class 7,18 leaves them out", facts)
        self.assertIn(f"{(rows['flags'] >> 2 & 1).sum()} of 2000 points are withheld (deleted): labelled like all "
                      "others; convert --drop-flag withheld leaves them out", facts)

    def test_what_labels_deleted_points_says_so_once(self):
        rows, _ = self.survey()
        source = self.write(rows)
        told = (f"{source}: {(rows['flags'] >> 2 & 1).sum()} of 2000 points are withheld (deleted): labelled like all "
                "others; convert --drop-flag withheld leaves them out")
        clean = self.converted(source, "--drop-flag", "withheld", name="clean.las")
        plan, out = self.folder / "a.plan", self.folder / "out.las"
        for command in (["classify", "-o", out], ["classify", "-o", out, "--max-memory", "1M"],
                        ["lines", "-o", self.folder / "out.dxf"], ["tiles", "plan", "-o", plan]):
            with self.subTest(command=command):
                self.assertEqual(run(*command, source, "--overwrite").stderr.count(told), 1)
                self.assertNotIn("withheld", run(*command, clean, "--overwrite").stderr)


if __name__ == "__main__":
    unittest.main()
