#!/usr/bin/python3
"""Times `pcednet annotate` on a noisy cube: loading, a stroke, training, classifying.

    bench/annotate_bench.py build/release/bin/pcednet [POINTS [MODEL]]
"""
import os
import pathlib
import sys
import tempfile
import time

os.environ["PCEDNET"] = sys.argv[1]
os.environ.setdefault("PCEDNET_SOURCE_DIR", str(pathlib.Path(__file__).parent.parent))
sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "tests/cli"))
from annotate_support import EDGE, FACE, Server, brush  # noqa: E402
from support import cube, write_ply  # noqa: E402


def processor_time(server):
    """Seconds that the server has used."""
    fields = pathlib.Path(f"/proc/{server.process.pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def main():
    points = int(sys.argv[2]) if len(sys.argv) > 2 else 1_000_000
    model = ["--model", sys.argv[3]] if len(sys.argv) > 3 else []
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "cube.ply"
        write_ply(file, *cube(points, noise=0.0005)[:2])
        for name in ("load, the first time", "load, described before"):
            begin = time.monotonic()
            server = Server(file, *model)
            server.open()
            print(f"{name:24} {time.monotonic() - begin:6.2f} s")
            if name.endswith("before"):
                break
            server.end()
        server.until("/api/runs", lambda runs: len(runs) > 0)  # the model's own answer
        begin = time.monotonic()
        server.post("/api/stroke", brush("a", 2, EDGE, 0.02))
        print(f"{'a stroke':24} {1000 * (time.monotonic() - begin):6.1f} ms")
        begin, used = time.monotonic(), processor_time(server)
        counts = server.post("/api/stroke", brush("b", 0, FACE, 0.05))["counts"]
        run = server.until("/api/runs", lambda runs: any(r["run"] > 0 for r in runs))[-1]
        print(f"{'to a new prediction':24} {time.monotonic() - begin:6.2f} s, "
              f"{processor_time(server) - used:.2f} s of processor time")
        print(f"painted {counts}")
        print(f"{'adapt the model':24} {run['seconds_train']:6.2f} s")
        print(f"{'classify':24} {run['seconds_classify']:6.2f} s")
        server.end()


if __name__ == "__main__":
    main()
