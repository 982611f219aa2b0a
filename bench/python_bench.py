"""pcednet.classify against the command line on the same points, run in turns.

PYTHONPATH=build/release/python python3 bench/python_bench.py FILE [--runs N]

Prints the seconds of each run and the ratio of the quickest, which other work disturbs least: of
the classification (all stages of the program between reading and writing, against the call), of the
whole processes, file to file, and of what these spent on processors.
"""

import argparse
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile
import time

PROGRAM = os.environ.get("PCEDNET", "build/release/bin/pcednet")
FILE_TO_FILE = """
import sys, time, warnings
import pcednet
warnings.simplefilter("ignore")
cloud = pcednet.read(sys.argv[1])
begin = time.perf_counter()
result = pcednet.classify(cloud)
print(time.perf_counter() - begin)
pcednet.write(sys.argv[2], cloud, result, overwrite=True)
"""


def timed(*command):
    """Seconds of a process, its seconds on processors, and what it said."""
    begin, before = time.perf_counter(), resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True,
                          check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    worked = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
    return time.perf_counter() - begin, worked, done


def program(file, out):
    whole, worked, done = timed(PROGRAM, "classify", file, "-o", out, "--overwrite", "--threads", "0")
    (line,) = (line for line in done.stderr.splitlines() if "seconds:" in line)
    stages = {name.strip(): float(value)
              for name, value in re.findall(r"([a-z ]+) ([\d.]+)", line.split(":", 1)[1])}
    return stages["total"] - stages["read"] - stages["write"], whole, worked


def module(file, out):
    whole, worked, done = timed(sys.executable, "-c", FILE_TO_FILE, file, out)
    return float(done.stdout), whole, worked


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file")
    parser.add_argument("--runs", type=int, default=5)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        times = {"program": [], "module": []}
        for _ in range(arguments.runs):
            times["program"].append(program(arguments.file, pathlib.Path(folder) / "a.ply"))
            times["module"].append(module(arguments.file, pathlib.Path(folder) / "b.ply"))
        same = (pathlib.Path(folder) / "a.ply").read_bytes() == (
            pathlib.Path(folder) / "b.ply").read_bytes()
    for k, what in enumerate(("classify", "file to file", "on processors")):
        seconds = {name: [run[k] for run in runs] for name, runs in times.items()}
        quickest = {name: min(runs) for name, runs in seconds.items()}
        ratio = quickest["module"] / quickest["program"]
        print(f"{what}: " + "; ".join(
            f"{name} {quickest[name]:.2f} s ({', '.join(f'{s:.2f}' for s in runs)})"
            for name, runs in seconds.items()) + f"; ratio {ratio:.3f}")
    print("the same bytes" if same else "OTHER BYTES")


if __name__ == "__main__":
    main()
