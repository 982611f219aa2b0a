#!/usr/bin/env python3
"""Classifies the tiles of a plan with Dask and joins them.

    dask_tiles.py PLAN OUT [SCHEDULER]

SCHEDULER is the address of a Dask scheduler, such as tcp://head:8786, whose workers see the same
paths; without one, two processes of this machine work. PCEDNET names the program. A tile
whose process fails or is killed, or whose worker is lost, is tried again up to three times. After a
stop, run it again: tiles that are done cost nothing.
"""
import json
import os
import pathlib
import subprocess
import sys

from dask.distributed import Client, LocalCluster, as_completed

PCEDNET = os.environ.get("PCEDNET", "pcednet")


def run_tile(program, plan, tile):
    subprocess.run([program, "tiles", "run", plan, "--tile", str(tile), "--threads", "1",
                    "--progress", "none"], check=True)
    return tile


def missing_tiles(plan):
    done = subprocess.run([PCEDNET, "tiles", "status", plan, "--json", "-"], check=True,
                          stdout=subprocess.PIPE)
    status = json.loads(done.stdout)
    return status["missing"] + status["damaged"]


def main(plan, out, scheduler=None):
    plan, out = str(pathlib.Path(plan).resolve()), str(pathlib.Path(out).resolve())
    cluster = scheduler or LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None)
    with Client(cluster) as client:
        tiles = [client.submit(run_tile, PCEDNET, plan, tile, retries=3, pure=False)
                 for tile in missing_tiles(plan)]
        for future in as_completed(tiles):
            if future.status != "finished":
                print(f"dask_tiles.py: {future.exception()!r}", file=sys.stderr)
    return subprocess.run([PCEDNET, "tiles", "join", plan, "-o", out, "--overwrite"]).returncode


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
