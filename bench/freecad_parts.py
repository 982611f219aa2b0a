#!/usr/bin/python3
"""Lines of 14 CAD parts that another program made: FreeCAD (Debian: freecad-python3), which also gives their true edges.

    bench/freecad_parts.py [--pcednet PROGRAM] [--points N] [--folder FOLDER] [NOISE]...

The parts have what parts have: fillets and round corners, chamfers, bores, bent sheet, turned grooves, a loft, spline
blades, embossed letters, obtuse facets. They are sampled evenly, without normals, with noise in spacings. True edges turn
by 25 degrees or more; a curve goes on through a seam. Prints the scores of `pcednet evaluate` for each noise.
"""
import argparse
import collections
import math
import pathlib
import random
import subprocess
import sys
import tempfile

import numpy as np
from scipy.spatial import cKDTree

sys.path.append("/usr/lib/freecad-python3/lib")
import FreeCAD  # noqa: E402
import Part  # noqa: E402
from FreeCAD import Vector as V  # noqa: E402

LEAST_ANGLE, SAME_DIRECTION = 25, math.cos(math.radians(5))


def box(x, y, z, at=(0, 0, 0)):
    return Part.makeBox(x, y, z, V(*at))


def cylinder(radius, height, at=(0, 0, 0), axis=(0, 0, 1)):
    return Part.makeCylinder(radius, height, V(*at), V(*axis))


def face(points):
    return Part.Face(Part.makePolygon([V(*p) for p in points + points[:1]]))


def cut(part, *holes):
    for hole in holes:
        part = part.cut(hole)
    return part


def edges(part, test):
    return [edge for edge in part.Edges if test(edge, edge.CenterOfMass)]


def flange():
    part = cylinder(40, 8).fuse(cylinder(22, 30)).cut(cylinder(15, 40, (0, 0, -2)))
    turns = [i * math.pi / 3 for i in range(6)]
    part = cut(part, *[cylinder(3.5, 20, (31 * math.cos(a), 31 * math.sin(a), -2)) for a in turns])
    is_foot = lambda e, c: isinstance(e.Curve, Part.Circle) and abs(e.Curve.Radius - 22) < .01 and abs(e.Curve.Center.z - 8) < .1
    return part.makeFillet(4, edges(part, is_foot))


def sheet():
    profile = face([(0, 0, 0), (60, 0, 0), (60, 0, 40), (58, 0, 40), (58, 0, 2), (0, 0, 2)])
    part = profile.extrude(V(0, 40, 0))
    for x, z, radius in ((60, 0, 5), (58, 2, 3)):
        bend = edges(part, lambda e, c: math.hypot(c.x - x, c.z - z) < .01 and abs(e.Length - 40) < .01)
        part = part.makeFillet(radius, bend)
    holes = [cylinder(3, 10, (x, y, -2)) for x in (15, 40) for y in (10, 30)]
    return cut(part, *holes, cylinder(6, 20, (50, 20, 25), (1, 0, 0)))


def shaft():
    profile = [(0, 0), (10, 0), (11, 1), (11, 20), (16, 20), (16, 32), (14, 32), (14, 35), (16, 35), (16, 50), (12, 60), (12, 80), (0, 80)]
    part = face([(x, 0, z) for x, z in profile]).revolve(V(0, 0, 0), V(0, 0, 1), 360)
    return part.cut(box(5, 4, 12, (-2.5, 9, 64)))


def bracket():
    rib = face([(6, 18, 6), (40, 18, 6), (6, 18, 34)]).extrude(V(0, 5, 0))
    part = box(60, 40, 6).fuse(box(6, 40, 40)).fuse(rib)
    for y in (8, 32):
        part = cut(part, cylinder(4, 10, (45, y, -2)), cylinder(3, 12, (-2, y, 28), (1, 0, 0)))
    part = part.removeSplitter()
    return part.makeFillet(6, edges(part, lambda e, c: abs(c.x - 60) < .01 and abs(e.Length - 6) < .01))


def nut():
    corners = [(30 * math.cos(i * math.pi / 3), 30 * math.sin(i * math.pi / 3), 0) for i in range(6)]
    cone = Part.makeCone(42, 27, 13.5, V(0, 0, 12.5)).fuse(cylinder(42, 12.5))
    return face(corners).extrude(V(0, 0, 24)).common(cone).cut(cylinder(15, 40, (0, 0, -5)))


def loft():
    square = Part.makePolygon([V(-20, -20, 0), V(20, -20, 0), V(20, 20, 0), V(-20, 20, 0), V(-20, -20, 0)])
    circle = Part.Wire(Part.makeCircle(12, V(0, 0, 40)))
    return Part.makeLoft([square, circle], True).fuse(cylinder(12, 15, (0, 0, 40))).fuse(box(60, 60, 6, (-30, -30, -6)))


def panel():
    heights = [[V(10 * i, 10 * j, 6 * math.sin(i / 3) + 3 * math.cos(j / 2.5)) for j in range(9)] for i in range(9)]
    surface = Part.BSplineSurface()
    surface.interpolate(heights)
    return surface.toShape().extrude(V(0, 0, -60)).common(box(70, 70, 60, (5, 5, -30)))


def pocket():
    hole = box(50, 30, 12, (15, 15, 10))
    hole = hole.makeFillet(6, edges(hole, lambda e, c: abs(e.Length - 12) < .01))
    part = box(80, 60, 20).cut(hole)
    for x, y in ((8, 8), (72, 8), (8, 52), (72, 52)):
        part = cut(part, cylinder(2.5, 30, (x, y, -2)), cylinder(5, 4, (x, y, 17)))
    return part.makeChamfer(2, edges(part, lambda e, c: abs(c.z - 20) < .01 and e.Length > 55))


def elbow():
    arc = Part.makeCircle(30, V(0, 0, 0), V(0, 1, 0), 0, 90)
    ends = [(arc.valueAt(t), arc.tangentAt(t)) for t in arc.ParameterRange]
    (a, along_a), (b, along_b) = ends
    pipe = lambda radius: Part.Wire(arc).makePipe(Part.Face(Part.Wire(Part.makeCircle(radius, a, along_a))))
    part = pipe(10).fuse(Part.makeCylinder(16, 4, a - along_a * 4, along_a)).fuse(Part.makeCylinder(16, 4, b, along_b))
    return cut(part, pipe(8), Part.makeCylinder(8, 6, a - along_a * 6, along_a), Part.makeCylinder(8, 6, b, along_b))


def blades():
    part = cylinder(12, 16)
    for k in range(7):
        turn = 2 * k * math.pi / 7
        spline = Part.BSplineCurve()
        spline.interpolate([V((10 + r) * math.cos(turn + .02 * r), (10 + r) * math.sin(turn + .02 * r), 0) for r in (0, 8, 16, 25)])
        part = part.fuse(spline.toShape().extrude(V(0, 0, 12)).makeOffsetShape(2.5, .01, fill=True))
    return part.cut(cylinder(6, 30, (0, 0, -5)))


def letters():
    bar = lambda x, z, height: [box(4, 30, height, (x, 5, z)), box(16, 4, height, (x, 5, z))]
    more = lambda x, z, height: [box(14, 4, height, (x, 18, z)), box(16, 4, height, (x, 31, z))]
    part = box(100, 40, 5)
    for piece in bar(10, 5, 2) + more(10, 5, 2) + bar(40, 5, 2):
        part = part.fuse(piece)
    return cut(part, *bar(70, 3.5, 3), *more(70, 3.5, 3))


def gem():
    drawn = random.Random(4)
    part = box(60, 60, 60, (-30, -30, -30))
    for _ in range(18):
        out = V(drawn.gauss(0, 1), drawn.gauss(0, 1), drawn.gauss(0, 1)).normalize()
        cutter = box(200, 200, 100, (-100, -100, 0))
        cutter.Placement = FreeCAD.Placement(out * 28, FreeCAD.Rotation(V(0, 0, 1), out))
        part = part.cut(cutter)
    return part


def case():
    part = box(50, 40, 30)
    part = part.makeFillet(3, part.Edges)
    return cut(part, cylinder(8, 40, (25, 20, -5)), box(10, 60, 8, (20, -5, 24)))


def ball():
    return cut(Part.makeSphere(30), box(60, 60, 40, (-30, -30, 15)), cylinder(10, 80, (0, 0, -40)), Part.makeTorus(30, 5))


PARTS = [flange, sheet, shaft, bracket, nut, loft, panel, pocket, elbow, blades, letters, gem, case, ball]


def turn_at(edge, faces):
    """The largest angle between the normals of two faces along their edge, in degrees."""
    low, high = edge.ParameterRange
    turns = []
    for share in (.25, .5, .75):
        at = edge.valueAt(low + share * (high - low))
        a, b = (f.normalAt(*f.Surface.parameter(at)) for f in faces)
        turns.append(math.degrees(math.acos(max(-1, min(1, a.dot(b))))))
    return max(turns)


def true_curves(part):
    curves = []
    for edge in part.Edges:
        faces = [f for f in part.Faces if any(edge.isSame(other) for other in f.Edges)]
        if len(faces) < 2 or turn_at(edge, faces[:2]) < LEAST_ANGLE:
            continue
        count = 2 if isinstance(edge.Curve, Part.Line) else max(3, int(5 * edge.Length))
        curves.append(np.array([tuple(p) for p in edge.discretize(Number=count)]))
    while joined := next_joint(curves):
        i, j, curve = joined
        curves = [c for k, c in enumerate(curves) if k not in (i, j)] + [curve]
    return curves


def next_joint(curves):
    """Two curves, both straight or both bent, one of which continues the other."""
    ends = collections.defaultdict(list)
    for i, curve in enumerate(curves):
        for end in (0, -1):
            ends[tuple(np.round(curve[end], 4))].append((i, end))
    for meeting in ends.values():
        if len(meeting) != 2 or meeting[0][0] == meeting[1][0]:
            continue
        (i, a), (j, b) = meeting
        first, second = (curves[i] if a else curves[i][::-1]), (curves[j][::-1] if b else curves[j])
        before, after = first[-1] - first[-2], second[1] - second[0]
        cosine = before @ after / np.linalg.norm(before) / np.linalg.norm(after)
        if cosine > SAME_DIRECTION and (len(first) == 2) == (len(second) == 2):
            return i, j, np.vstack([first, second[1:]])
    return None


def write_obj(file, vertices, elements, kind):
    lines = ["v %.7f %.7f %.7f" % tuple(v) for v in vertices]
    lines += [" ".join([kind] + [str(i + 1) for i in element]) for element in elements]
    file.write_text("\n".join(lines) + "\n")


def write_part(make, folder):
    part = make()
    vertices, triangles = part.tessellate(2e-4 * part.BoundBox.DiagonalLength)
    write_obj(folder / f"{make.__name__}.obj", vertices, triangles, "f")
    curves = true_curves(part)
    starts = np.cumsum([0] + [len(c) for c in curves])
    write_obj(folder / "curves" / f"{make.__name__}.obj", np.vstack(curves),
              [range(s, s + len(c)) for s, c in zip(starts, curves)], "l")


def write_noisy(cloud, noisy, noise):
    points = np.loadtxt(cloud, usecols=(0, 1, 2))
    spacing = np.median(cKDTree(points).query(points, 7)[0][:, 6]) / math.sqrt(6 / math.pi)
    np.savetxt(noisy, points + noise * spacing * np.random.default_rng(3).normal(size=points.shape), "%.9f")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pcednet", default="build/release/bin/pcednet")
    parser.add_argument("--points", default=32768, type=int)
    parser.add_argument("--folder", type=pathlib.Path, help="to keep meshes, clouds, lines and curves in")
    parser.add_argument("noise", nargs="*", type=float, default=[0, .03, .15, .5])
    options = parser.parse_args()
    folder = options.folder or pathlib.Path(tempfile.mkdtemp())
    (folder / "curves").mkdir(parents=True, exist_ok=True)
    run = lambda *arguments: subprocess.run([options.pcednet, *map(str, arguments)], check=True, capture_output=True, text=True).stdout
    for make in PARTS:
        write_part(make, folder)
        run("convert", folder / f"{make.__name__}.obj", "--sample", options.points, "--seed", 1, "-o", folder / f"{make.__name__}.xyz", "--overwrite")
    for noise in options.noise:
        clouds, lines = folder / f"clouds_{noise:g}", folder / f"lines_{noise:g}"
        clouds.mkdir(exist_ok=True), lines.mkdir(exist_ok=True)
        for make in PARTS:
            cloud = clouds / f"{make.__name__}.xyz"
            write_noisy(folder / f"{make.__name__}.xyz", cloud, noise)
            run("lines", cloud, "--classify", "-o", lines / f"{make.__name__}.obj", "--overwrite")
        print(f"noise of {noise:g} spacings")
        print(run("evaluate", lines, "--truth", folder, "--cloud", clouds), flush=True)


main()
