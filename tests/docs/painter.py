"""A user of `pcednet annotate CLOUD`: opens the page's session, paints two strokes that correct the
model, waits for the answer, saves model, cloud and project, and leaves. Run as the program, with its
words; the cloud is the sample, which holds its true labels."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "cli"))
import numpy as np
from annotate_support import Server, brush
from support import read_ply


def paint(cloud):
    points, _ = read_ply(cloud)
    place = np.stack([points[axis] for axis in "xyz"], axis=1)
    server = Server(cloud)
    session = server.open()
    server.post("/api/settings", {"auto": False})  # one training, so that all that is saved is of it
    random = np.random.default_rng(1)
    for edge_class in (2, 0):
        chosen = random.choice(np.flatnonzero(points["label"] == edge_class), 5)
        server.post("/api/stroke", brush(f"class {edge_class}", edge_class,
                                         place[chosen] - session["origin"], radius=0.05))
    server.post("/api/train")
    server.until("/api/runs", lambda runs: any(run["run"] > 0 and run["current"] for run in runs))
    for what in ("model", "cloud", "project"):
        print(server.post("/api/save", {"what": what})["path"])
    server.end()


if __name__ == "__main__":
    paint(sys.argv[2])
