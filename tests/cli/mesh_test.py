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

    STL = ("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 4 0 0\nvertex 4 4 0\nendloop\nendfacet\n"
           "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 4 4 0\nvertex 0 4 0\nendloop\nendfacet\nendsolid a\n")

    def test_an_stl_is_sampled_as_its_obj(self):
        (self.folder / "a.obj").write_text(self.OBJ)
        (self.folder / "b.stl").write_text(self.STL)
        for name in ("a.obj", "b.stl"):
            run("convert", self.folder / name, "-o", self.folder / (name + ".ply"), "--sample", 1000)
        one, other = (read_ply(self.folder / (name + ".ply"))[0] for name in ("a.obj", "b.stl"))
        self.assertTrue((one == other).all())

    def test_the_faces_of_a_mesh_that_are_not_used_are_told(self):
        p, n, _ = cube(300)
        rows = [f"v {x} {y} {z}" for x, y, z in p] + [f"vn {x} {y} {z}" for x, y, z in n]
        mesh = self.folder / "mesh.obj"
        mesh.write_text("\n".join([*rows, "f 1 2 3", "f 4 5 6 7", ""]))
        told = "mesh.obj: 2 faces are not used, only their vertices: pcednet convert --sample N"
        for command, out in (("classify", "a.ply"), ("lines", "a.dxf"), ("normals", "b.ply"),
                             ("describe", "a.npy"), ("evaluate", None)):
            done = run(command, mesh, *(["-o", self.folder / out] if out else []), expect=0 if out else 4)
            self.assertEqual(told in done.stderr, out is not None, command)
        run("convert", mesh, "-o", self.folder / "c.ply", "--sample", 100)
        self.assertNotIn("faces", run("convert", mesh, "-o", self.folder / "d.ply").stderr)
        self.assertNotIn("faces", run("classify", self.folder / "c.ply").stderr)

    def test_an_stl_beside_a_cloud_is_no_cloud(self):
        p, n, _ = cube(300)
        write_ply(self.folder / "a.ply", p, n)
        (self.folder / "a.stl").write_text(self.STL)
        run("classify", self.folder, "--out-dir", self.folder / "out")
        self.assertEqual([path.name for path in (self.folder / "out").iterdir()], ["a_edges.ply"])

    def test_a_cloud_without_faces_is_refused(self):
        p, n, _ = cube(100)
        write_ply(self.folder / "a.ply", p, n)
        done = run("convert", self.folder / "a.ply", "-o", self.folder / "b.ply", "--sample", 10,
                   expect=4)
        self.assertIn("no faces", done.stderr)


if __name__ == "__main__":
    unittest.main()
