"""pcednet.classify against the command line on the same points, run in turns.

PYTHONPATH=build/release/python python3 bench/python_bench.py FILE [--runs N]

Prints the seconds of each run and the ratio of the medians: of the work alone (all stages of the program between reading and writing, against the call), and of
the whole processes, file to file.
"""

import argparse
import os
import pathlib
import re
import statistics
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
    begin = time.perf_counter()
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True,
                          check=True)
    return time.perf_counter() - begin, done


def program(file, out):
    whole, done = timed(PROGRAM, "classify", file, "-o", out, "--overwrite", "--threads", "0")
    (line,) = (line for line in done.stderr.splitlines() if "seconds:" in line)
    stages = {name.strip(): float(value)
              for name, value in re.findall(r"([a-z ]+) ([\d.]+)", line.split(":", 1)[1])}
    return stages["total"] - stages["read"] - stages["write"], whole


def module(file, out):
    whole, done = timed(sys.executable, "-c", FILE_TO_FILE, file, out)
    return float(done.stdout), whole


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
    for k, what in enumerate(("classify", "file to file")):
        seconds = {name: [run[k] for run in runs] for name, runs in times.items()}
        medians = {name: statistics.median(runs) for name, runs in seconds.items()}
        print(f"{what}: " + "; ".join(
            f"{name} {medians[name]:.2f} s ({', '.join(f'{s:.2f}' for s in runs)})"
            for name, runs in seconds.items())
            + f"; ratio {medians['module'] / medians['program']:.3f}")
    print("the same bytes" if same else "OTHER BYTES")


if __name__ == "__main__":
    main()
