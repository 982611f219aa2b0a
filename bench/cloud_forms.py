#!/usr/bin/python3
"""How well pcednet finds the edges of one scene in the forms in which clouds come.

    bench/cloud_forms.py [--pcednet PROGRAM] [--model MODEL] [FORM...]

The scene is a house with a gabled roof, steps, a column and a dome on level ground, 20 by 20 metres. Found: the
points within .7 spacings of an edge that are an edge or boundary. True: the edges within 2 spacings of one. False:
the points beyond 4 spacings that are edges, in percent. Spacings are those at each point.

Lines, by default and with boundaries: the share of the edges' length, where there are points within 1.5 spacings,
that a curve follows within 2, the share of the curves' length within 2 spacings of an edge, and how many they are.
Without FORM, all.
"""
import argparse
import pathlib
import re
import subprocess
import tempfile

import numpy as np
from scipy.spatial import cKDTree

STEPS, STEP_RISE, STEP_DEPTH = 4, .4, .8


class Scene:
    """Faces (corner, u, v, whether a triangle), a column and a dome, and the segments of their edges."""

    def __init__(self):
        self.faces, self.edges, self.rims = [], [], []
        self.turn = np.array([[np.cos(.35), -np.sin(.35), 0], [np.sin(.35), np.cos(.35), 0], [0, 0, 1]])
        self.house_at = np.array([-3., -2, 0])
        self.column, self.column_height = np.array([5., -5, .8]), 4.  # x, y, radius
        self.dome = np.array([-6., 6, 2])
        self.ground()
        self.house()
        self.steps()
        self.round_edges()

    def face(self, corner, u, v, triangle=False):
        self.faces.append((np.array(corner, float), np.array(u, float), np.array(v, float), triangle))

    def edge(self, a, b):
        self.edges.append((np.array(a, float), np.array(b, float)))

    def ground(self):
        self.face((-10, -10, 0), (20, 0, 0), (0, 20, 0))
        corners = [np.array([x, y, 0.]) for x, y in ((-10, -10), (10, -10), (10, 10), (-10, 10))]
        self.rims += list(zip(corners, corners[1:] + corners[:1]))

    def house(self):
        x, y, eaves, ridge = 4., 3., 3., 5.2
        at = lambda *p: self.turn @ np.array(p, float) + self.house_at
        def face(a, b, c, triangle=False):
            self.face(at(*a), at(*b) - at(*a), at(*c) - at(*a), triangle)
        for s in (-1, 1):
            face((-x, s * y, 0), (x, s * y, 0), (-x, s * y, eaves))
            face((s * x, -y, 0), (s * x, y, 0), (s * x, -y, eaves))
            face((s * x, -y, eaves), (s * x, y, eaves), (s * x, 0, ridge), True)
            face((-x, s * y, eaves), (x, s * y, eaves), (-x, 0, ridge))
            self.edge(at(s * x, -y, 0), at(s * x, y, 0))
            for z in (0, eaves):
                self.edge(at(-x, s * y, z), at(x, s * y, z))
            for t in (-1, 1):
                self.edge(at(s * x, t * y, 0), at(s * x, t * y, eaves))
                self.edge(at(s * x, t * y, eaves), at(s * x, 0, ridge))
        self.edge(at(-x, 0, ridge), at(x, 0, ridge))

    def steps(self):
        for i in range(STEPS):
            x, low, z = 4 + STEP_DEPTH * i, STEP_RISE * i, STEP_RISE * (i + 1)
            self.face((x, 4, low), (0, 4, 0), (0, 0, STEP_RISE))
            self.face((x, 4, z), (STEP_DEPTH, 0, 0), (0, 4, 0))
            self.edge((x, 4, z), (x, 8, z))
            self.edge((x, 4, low), (x, 8, low))
            for y in (4, 8):
                self.face((x, y, 0), (STEP_DEPTH, 0, 0), (0, 0, z))
                self.edge((x, y, z), (x + STEP_DEPTH, y, z))
                self.edge((x, y, low), (x, y, z))
                self.edge((x, y, 0), (x + STEP_DEPTH, y, 0))
        self.end = 4 + STEP_DEPTH * STEPS
        self.face((self.end, 4, 0), (0, 4, 0), (0, 0, z))
        self.edge((self.end, 4, 0), (self.end, 8, 0))
        self.edge((self.end, 4, z), (self.end, 8, z))
        for y in (4, 8):
            self.edge((self.end, y, 0), (self.end, y, z))

    def round_edges(self):
        angles = np.linspace(0, 2 * np.pi, 65)
        for (x, y, r), heights in ((self.column, (0, self.column_height)), (self.dome, (0,))):
            circle = np.c_[x + r * np.cos(angles), y + r * np.sin(angles)]
            for z in heights:
                for a, b in zip(circle[:-1], circle[1:]):
                    self.edge((*a, z), (*b, z))

    def under_things(self, p):
        """Ground that the house and the others stand on."""
        house = (p - self.house_at) @ self.turn
        covered = (np.abs(house[:, 0]) < 4) & (np.abs(house[:, 1]) < 3)
        covered |= (p[:, 0] > 4) & (p[:, 0] < self.end) & (p[:, 1] > 4) & (p[:, 1] < 8)
        for x, y, r in (self.column, self.dome):
            covered |= np.hypot(p[:, 0] - x, p[:, 1] - y) < r
        return covered & (np.abs(p[:, 2]) < 1e-9)

    def surfaces(self):
        """Area and sampler, of two uniform numbers per point, of every surface."""
        for corner, u, v, triangle in self.faces:
            def flat(a, b, corner=corner, u=u, v=v, triangle=triangle):
                over = (a + b > 1) & triangle
                a, b = np.where(over, 1 - a, a), np.where(over, 1 - b, b)
                return corner + a[:, None] * u + b[:, None] * v
            yield np.linalg.norm(np.cross(u, v)) * (.5 if triangle else 1), flat
        x, y, r = self.column
        turn = lambda a: (np.cos(2 * np.pi * a), np.sin(2 * np.pi * a))
        yield 2 * np.pi * r * self.column_height, lambda a, b: np.c_[
            x + r * turn(a)[0], y + r * turn(a)[1], self.column_height * b]
        yield np.pi * r * r, lambda a, b: np.c_[
            x + r * np.sqrt(b) * turn(a)[0], y + r * np.sqrt(b) * turn(a)[1], 0 * a + self.column_height]
        X, Y, R = self.dome
        yield 2 * np.pi * R * R, lambda a, b: np.c_[
            X + R * np.sqrt(1 - b * b) * turn(a)[0], Y + R * np.sqrt(1 - b * b) * turn(a)[1], R * b]

    def drawn(self, points, random):
        """Uniform by area, and the spacing."""
        area = sum(a for a, _ in self.surfaces())
        parts = []
        for a, sampler in self.surfaces():
            n = max(1, round(points * a / area))
            parts.append(sampler(random.random(n), random.random(n)))
        p = np.vstack(parts)
        return p[~self.under_things(p)], np.sqrt(area / points)

    def ranges(self, eyes, beams):
        nearest = np.full(len(beams), np.inf)
        def meet(t, hit):
            np.copyto(nearest, t, where=hit & (t > 1e-6) & (t < nearest))
        with np.errstate(all="ignore"):
            for corner, u, v, triangle in self.faces:
                normal = np.cross(u, v)
                t = ((corner - eyes) @ normal) / (beams @ normal)
                offset = eyes + t[:, None] * beams - corner
                a, b = (np.c_[offset @ u, offset @ v] @ np.linalg.inv([[u @ u, u @ v], [u @ v, v @ v]])).T
                meet(t, (a >= 0) & (b >= 0) & ((a + b <= 1) if triangle else (a <= 1) & (b <= 1)))
            centre, height = np.array([*self.column[:2], 0]), self.column_height
            o, r = eyes - centre, self.column[2]
            k, m = (beams[:, :2] ** 2).sum(1), (o[:, :2] * beams[:, :2]).sum(1)
            t = (-m - np.sqrt(m * m - k * ((o[:, :2] ** 2).sum(1) - r * r))) / k
            meet(t, (np.abs(o[:, 2] + t * beams[:, 2] - height / 2) <= height / 2))
            t = (height - o[:, 2]) / beams[:, 2]
            meet(t, np.hypot(*(o + t[:, None] * beams)[:, :2].T) < r)
            o = eyes - [*self.dome[:2], 0]
            m = (o * beams).sum(1)
            t = -m - np.sqrt(m * m - (o * o).sum(1) + self.dome[2] ** 2)
            meet(t, o[:, 2] + t * beams[:, 2] >= 0)
        return nearest

    def scanned(self, eye, step, noise, random):
        """By a scanner with one beam per `step` radians, noise along the beam."""
        azimuth, elevation = np.meshgrid(np.arange(0, 2 * np.pi, step), np.arange(-1.2, .9, step))
        a, e = azimuth.ravel(), elevation.ravel()
        beams = np.c_[np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)]
        eyes = np.tile(np.array(eye, float), (len(beams), 1))
        t = self.ranges(eyes, beams)
        seen = t < 40
        t = t[seen] + noise * random.normal(size=seen.sum())
        return eyes[seen] + t[:, None] * beams[seen]

    def profiled(self, y, apart, step, noise, random):
        """From a vehicle along x: a profile every `apart` metres, aslant by 30 degrees, a beam per `step` radians."""
        x, angle = np.meshgrid(np.arange(-14, 14, apart), np.arange(0, 2 * np.pi, step), indexing="ij")
        x, angle = x.ravel(), (angle + step * random.random(x.shape[0])[:, None]).ravel()
        beams = np.c_[np.cos(angle) * np.sin(np.pi / 6), np.cos(angle) * np.cos(np.pi / 6), np.sin(angle)]
        eyes = np.c_[x, np.full_like(x, y), np.full_like(x, 2.2)]
        t = self.ranges(eyes, beams)
        seen = t < 40
        t = t[seen] + noise * random.normal(size=seen.sum())
        return eyes[seen] + t[:, None] * beams[seen]

    def photographed(self, eye, towards, random):
        """By a depth camera of 640 by 480, whose disparity has noise of a tenth and steps of an eighth."""
        focal, base = 500, .6
        eye = np.array(eye, float)
        ahead = np.array(towards, float) - eye
        ahead /= np.linalg.norm(ahead)
        right = np.cross(ahead, [0, 0, 1])
        right /= np.linalg.norm(right)
        u, v = np.meshgrid(np.arange(640) - 320, np.arange(480) - 240)
        beams = u.reshape(-1, 1) / focal * right + v.reshape(-1, 1) / focal * np.cross(ahead, right) + ahead
        length = np.linalg.norm(beams, axis=1)
        t = self.ranges(np.tile(eye, (len(beams), 1)), beams / length[:, None])
        seen = t < 25
        disparity = focal * base * length[seen] / t[seen] + .1 * random.normal(size=seen.sum())
        return eye + (focal * base / (np.round(8 * disparity) / 8))[:, None] * beams[seen]


def distance(p, segments):
    least = np.full(len(p), np.inf)
    for a, b in segments:
        along = b - a
        at = np.clip((p - a) @ along / (along @ along), 0, 1)
        least = np.minimum(least, np.linalg.norm(p - a - at[:, None] * along, axis=1))
    return least


def centres(p, edge):
    return (np.unique(np.floor(p / edge).astype(int), axis=0) + .5) * edge


PLACES = (9, -9, 2), (-9.5, -8, 2), (-8, 9, 2), (9, 2, 2)  # of tripods


def forms(scene, random):
    """Name and maker of every form: positions, and the number of the scanner's place where it is told."""
    drawn = lambda noise, points=150_000: (
        lambda p, s: p + noise * s * random.normal(size=p.shape))(*scene.drawn(points, random))
    rounded = lambda p, step: np.round(p / step) * step
    scans = lambda: [scene.scanned(place, .006, .003, random) for place in PLACES]
    told = lambda clouds: np.vstack([np.c_[p, np.full(len(p), i)] for i, p in enumerate(clouds)])

    profiles = lambda apart: np.vstack([scene.profiled(y, apart, .003, .003, random) for y in (-9, 9)])

    def thinner_with_distance():
        p, _ = scene.drawn(1_200_000, random)
        keep = random.random(len(p)) < .02 + np.exp(-np.linalg.norm(p - [4, 6, 1], axis=1) / 2)
        return p[keep] + .003 * random.normal(size=(keep.sum(), 3))

    return {
        "drawn, clean": lambda: drawn(0),
        "drawn, noise of .15 spacings": lambda: drawn(.15),
        "drawn, noise of .6 spacings": lambda: drawn(.6),
        "drawn, noise of 1 spacing": lambda: drawn(1),
        "drawn, noise of 2 spacings": lambda: drawn(2, 600_000),
        "drawn, noise of 3 spacings": lambda: drawn(3, 1_200_000),
        "rounded to .3 spacings, noise of .15": lambda: rounded(drawn(.15), .02),
        "rounded to .7 spacings, noise of .15": lambda: rounded(drawn(.15), .05),
        "rounded to .7 spacings, clean": lambda: rounded(drawn(0), .05),
        "centres of voxels": lambda: centres(scene.drawn(600_000, random)[0], .083),
        "one scan from a tripod": lambda: scene.scanned(PLACES[0], .004, .003, random),
        "one scan from a tripod, whose place is told": lambda: told([scene.scanned(PLACES[0], .004, .003, random)]),
        "four scans from tripods": lambda: np.vstack(scans()),
        "four scans from tripods, whose places are told": lambda: told(scans()),
        "four scans, rounded to 1 cm": lambda: rounded(np.vstack(scans()), .01),
        "four scans, centres of voxels": lambda: centres(np.vstack(scans()), .05),
        "four scans, each 2 cm off the last": lambda: np.vstack(
            [scan + np.array([.02, .015, .01]) * i for i, scan in enumerate(scans())]),
        "profiles of a vehicle, 8 cm apart": lambda: profiles(.08),
        "profiles of a vehicle, 20 cm apart": lambda: profiles(.2),
        "thinner with distance": thinner_with_distance,
        "depth camera": lambda: scene.photographed((8, -9, 3), (0, 0, 1), random),
    }


def write_ply(path, p):
    head = "ply\nformat binary_little_endian 1.0\n"
    names = ["x", "y", "z", "scan"][:p.shape[1]]
    if "scan" in names:
        head += "".join(f"comment scanner {i}: {x} {y} {z}\n" for i, (x, y, z) in enumerate(PLACES))
    head += "element vertex %d\n" % len(p)
    head += "".join(f"property double {name}\n" for name in names) + "end_header\n"
    path.write_bytes(head.encode() + p.astype("<f8").tobytes())


def classes_of(path):
    head, body = path.read_bytes().split(b"end_header\n", 1)
    kinds = {"double": "<f8", "float": "<f4", "uchar": "u1"}
    fields = [(name, kinds[kind]) for kind, name in re.findall(r"property (\w+) (\w+)\n", head.decode())]
    return np.frombuffer(body, dtype=fields)["scalar_edge_class"]


def spacing_at(p):
    near, index = cKDTree(p).query(p, 11)
    return np.median(near[:, 1:].mean(1)[index], axis=1) / 1.15


def curves_of(path):
    """The polylines of an OBJ file."""
    words = [line.split() for line in path.read_text().splitlines()]
    corners = np.array([w[1:4] for w in words if w[:1] == ["v"]], float).reshape(-1, 3)
    return [corners[[int(i) - 1 for i in w[1:]]] for w in words if w[:1] == ["l"]]


def places_along(curves, step=.02):
    """Points in such steps along polylines."""
    parts = [np.zeros((0, 3))]
    for curve in curves:
        for a, b in zip(curve[:-1], curve[1:]):
            n = max(1, int(np.ceil(np.linalg.norm(b - a) / step)))
            parts.append(a + ((np.arange(n) + .5) / n)[:, None] * (b - a))
    return np.vstack(parts)


def score_lines(curves, scene, p, spacing):
    """Found, true and the number of curves."""
    if not curves:
        return 0.0, 1.0, 0
    cloud, drawn, edges = cKDTree(p), places_along(curves), places_along(scene.edges)
    away, index = cloud.query(edges)
    seen, reach = away < 1.5 * spacing[index], 2 * spacing[index]
    found = cKDTree(drawn).query(edges[seen])[0] < reach[seen]
    off = distance(drawn, scene.edges + scene.rims)
    return found.mean(), (off < 2 * spacing[cloud.query(drawn)[1]]).mean(), len(curves)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pcednet", default="build/release/bin/pcednet")
    parser.add_argument("--model", default="general")
    parser.add_argument("forms", nargs="*")
    arguments = parser.parse_args()
    scene = Scene()
    print(f"{'form':46s}   points  found   true  false % |  lines: found   true curves | with boundaries")
    with tempfile.TemporaryDirectory() as folder:
        cloud, labelled, drawn = (pathlib.Path(folder) / name for name in ("cloud.ply", "labelled.ply", "lines.obj"))
        run = lambda *command: subprocess.run([arguments.pcednet, *command, "--overwrite"], check=True,
                                              capture_output=True)
        for name in forms(scene, None):
            if arguments.forms and not any(form in name for form in arguments.forms):
                continue
            p = forms(scene, np.random.default_rng(5))[name]()
            write_ply(cloud, p)
            p = p[:, :3]
            run("classify", cloud, "-o", labelled, "--model", arguments.model)
            classes, spacing = classes_of(labelled), spacing_at(p)
            away, rim = distance(p, scene.edges), distance(p, scene.rims)
            edge = (classes == 1) | (classes == 2)
            near, far = away < .7 * spacing, np.minimum(away, rim) > 4 * spacing
            print(f"{name:46s} {len(p):8d}   {(classes[near] > 0).mean():.3f}"
                  f"  {(away[edge] < 2 * spacing[edge]).mean():.3f}  {100 * edge[far].mean():7.3f}", end="")
            for boundaries in ([], ["--boundaries"]):
                run("lines", labelled, "-o", drawn, *boundaries)
                found, true, count = score_lines(curves_of(drawn), scene, p, spacing)
                print(f" |         {found:.3f}  {true:.3f} {count:6d}", end="")
            print(flush=True)


if __name__ == "__main__":
    main()
