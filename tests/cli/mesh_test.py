"""`pcednet convert --sample`: points on the faces of a mesh."""
import unittest

import numpy as np

from support import CliTest, cube, read_ply, run, write_ply


class Sample(CliTest):
    OBJ = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nf 1 2 3 4\n"

    def test_points_lie_on_the_faces_of_an_obj_and_of_its_ply(self):
        (self.folder / "a.obj").write_text(self.OBJ)
        run("convert", self.folder / "a.obj", "-o", self.folder / "mesh.ply")
        clouds = []
        for name in ("a.obj", "mesh.ply"):
            out = self.folder / (name + ".sampled.ply")
            run("convert", self.folder / name, "-o", out, "--sample", 1000, "--seed", 5)
            clouds.append(read_ply(out)[0])
        rows = clouds[0]
        self.assertEqual(len(rows), 1000)
        self.assertTrue((rows["z"] == 0).all() and (rows["nz"] == 1).all())
        self.assertLess(abs(rows["x"].mean() - 2), 5 * 4 / np.sqrt(12 * 1000))
        self.assertTrue((clouds[0] == clouds[1]).all())

    def test_a_cloud_without_faces_is_refused(self):
        p, n, _ = cube(100)
        write_ply(self.folder / "a.ply", p, n)
        done = run("convert", self.folder / "a.ply", "-o", self.folder / "b.ply", "--sample", 10,
                   expect=4)
        self.assertIn("no faces", done.stderr)


if __name__ == "__main__":
    unittest.main()
