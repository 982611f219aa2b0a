#!/usr/bin/python3
"""The learning curve: MCC against the number of painted points, for PCEDNet, FC and CNN.

Paints whole strokes on small clouds of `pcednet generate default --seed 1`, as a user of the annotator
would: balls of two spacings about random points, about equally many strokes begun on each class, each
point with its true label. Trains the three networks on the same strokes with the settings of the
annotator, and scores them on clouds of seed 5, which nobody painted.

    bench/learning_curve.py build/release/bin/pcednet -o learning_curve.svg

With --work DIR the clouds and scores are kept there, and a later call measures only what is missing.
"""
import argparse
import concurrent.futures
import itertools
import json
import math
import pathlib
import random
import statistics
import struct
import subprocess
import tempfile

NETWORKS = {"pcednet": ("PCEDNet", "#a80000"), "fc": ("FC", "#1f6fc4"), "cnn": ("CNN", "#2b8a4b")}
SIZES = (50, 100, 200, 500, 1000, 2000, 5000, 10_000, 20_000, 50_000, 100_000)
UNPAINTED = 255
CLASSES = (2, 1, 0)  # sharp-edge first, as a user would begin
POINT = struct.Struct("<6fB")  # position, normal, label: what `generate` writes
FIELDS = [b"property float " + axis for axis in (b"x", b"y", b"z", b"nx", b"ny", b"nz")] + [b"property uchar label"]
MOST_TO_PAINT, MOST_TO_SCORE = 15_000, 8_000  # points of a cloud; larger ones are left out
MANY, MOST_DRAWS_OF_MANY = 2000, 3  # scores of more painted points scatter less and cost more
EPOCHS, MOST_PER_EPOCH, LEAST_PER_EPOCH = 20, 1 << 15, 1 << 14  # those of the annotator


class Cloud:
    """A generated cloud: its bytes, and the points of every ball of two spacings."""

    def __init__(self, path):
        data = path.read_bytes()
        self.begin = data.index(b"end_header\n") + len(b"end_header\n")
        header = data[:self.begin].splitlines()
        if [line for line in header if line.startswith(b"property")] != FIELDS:
            raise SystemExit(f"{path}: not as `pcednet generate` writes it")
        (spacing,) = (float(line.split()[2].rstrip(b";")) for line in header if line.startswith(b"comment spacing"))
        points = list(POINT.iter_unpack(data[self.begin:]))
        self.name, self.data, self.radius = path.name, data, 2 * spacing
        self.positions = [point[:3] for point in points]
        self.labels = bytes(point[6] for point in points)
        self.cells = {}
        for i, position in enumerate(self.positions):
            self.cells.setdefault(self.cell(position), []).append(i)

    def cell(self, position):
        return tuple(math.floor(x / self.radius) for x in position)

    def ball(self, centre):
        middle = self.positions[centre]
        x, y, z = self.cell(middle)
        for dx, dy, dz in itertools.product((-1, 0, 1), repeat=3):
            for i in self.cells.get((x + dx, y + dy, z + dz), ()):
                if math.dist(self.positions[i], middle) <= self.radius:
                    yield i

    def write(self, path, painted):
        """The cloud with the labels of the painted points alone."""
        data = bytearray(self.data)
        last = self.begin + POINT.size - 1
        data[last::POINT.size] = bytes([UNPAINTED]) * len(self.labels)
        for i in painted:
            data[last + i * POINT.size] = self.labels[i]
        path.write_bytes(data)


def strokes(clouds, seed):
    """Painted points, stroke by stroke: lists of (cloud, point), each begun on an unpainted point of
    the next class, until no point is left."""
    chance = random.Random(seed)
    starts = {kind: [(c, i) for c, cloud in enumerate(clouds) for i, label in enumerate(cloud.labels) if label == kind]
              for kind in CLASSES}
    for kind in CLASSES:
        chance.shuffle(starts[kind])
    painted = set()
    while any(starts.values()):
        for kind in CLASSES:
            while starts[kind] and starts[kind][-1] in painted:
                starts[kind].pop()
            if starts[kind]:
                c, centre = starts[kind].pop()
                stroke = [(c, i) for i in clouds[c].ball(centre) if (c, i) not in painted]
                painted.update(stroke)
                yield stroke


def paint(clouds, seed, sizes):
    """For each size the points of the first strokes that hold so many; larger sizes paint on."""
    painted, sizes = [], sorted(sizes)
    for stroke in strokes(clouds, seed):
        painted += stroke
        while sizes and len(painted) >= sizes[0]:
            yield sizes.pop(0), list(painted)
        if not sizes:
            return
    raise SystemExit(f"the clouds have {len(painted)} points to paint, fewer than {sizes[0]}")


def write_painted(clouds, painted, folder):
    folder.mkdir(exist_ok=True)
    of_cloud = {}
    for c, i in painted:
        of_cloud.setdefault(c, []).append(i)
    for c, points in of_cloud.items():
        clouds[c].write(folder / clouds[c].name, points)


def epochs(labels):
    """So many that training takes as many samples as in the annotator, whose epochs are cut short."""
    largest = max(labels.count(kind) for kind in CLASSES)
    return max(1, round(EPOCHS * min(1, MOST_PER_EPOCH / max(LEAST_PER_EPOCH, len(CLASSES) * largest))))


def measure(program, network, seed, folder, labels, test, work):
    """Trains a network on the painted clouds of a folder and scores it."""
    model, scores = (work / f"{folder.name}_{network}{end}" for end in (".safetensors", ".json"))

    def pcednet(*words):
        subprocess.run([program, *map(str, words), "--threads", "1", "--progress", "none", "--overwrite"],
                       check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    pcednet("train", folder, "-o", model, "--network", network, "--epochs", epochs(labels), "--seed", seed)
    pcednet("evaluate", test, "--model", model, "--positive", "edge", "--json", scores)
    found = json.loads(scores.read_text())
    return {"median": found["median"]["mcc"], "pooled": found["pooled"]["mcc"], "painted": len(labels),
            **{f"class {kind}": labels.count(kind) for kind in CLASSES}}


def draws(size, options):
    return min(options.draws, MOST_DRAWS_OF_MANY) if size > MANY else options.draws


def small_clouds(folder, most):
    return [cloud for cloud in map(Cloud, sorted(folder.glob("*.ply"))) if len(cloud.labels) <= most]


def run(options, work):
    """The scores by "network size draw"; those that an earlier call kept are not measured again."""
    kept = work / "scores.json"
    record = json.loads(kept.read_text()) if kept.exists() else {}
    for seed in (1, 5):
        if not (work / f"seed{seed}").exists():
            subprocess.run([options.program, "generate", "default", work / f"seed{seed}", "--seed", str(seed)],
                           check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    clouds, test = small_clouds(work / "seed1", MOST_TO_PAINT), work / "test"
    test.mkdir(exist_ok=True)
    for cloud in small_clouds(work / "seed5", MOST_TO_SCORE):
        cloud.write(test / cloud.name, range(len(cloud.labels)))
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        jobs = {}
        for draw in range(1, options.draws + 1):
            missing = {size: [network for network in NETWORKS if f"{network} {size} {draw}" not in record]
                       for size in options.sizes if draw <= draws(size, options)}
            for size, painted in paint(clouds, draw, [size for size, networks in missing.items() if networks]):
                folder = work / f"{size}_{draw}"
                write_painted(clouds, painted, folder)
                labels = bytes(clouds[c].labels[i] for c, i in painted)
                for network in missing[size]:
                    job = pool.submit(measure, options.program, network, draw, folder, labels, test, work)
                    jobs[job] = f"{network} {size} {draw}"
        for job in concurrent.futures.as_completed(jobs):
            record[jobs[job]] = job.result()
            print(jobs[job], record[jobs[job]], flush=True)
            kept.write_text(json.dumps(record, indent=1))
    return {key: record[key] for network in NETWORKS for size in options.sizes
            for key in (f"{network} {size} {draw}" for draw in range(1, draws(size, options) + 1))}


def curves(record, score):
    """For each network (size, mean, standard deviation, draws) in order of size."""
    found = {network: {} for network in NETWORKS}
    for key, scores in record.items():
        network, size, _ = key.split()
        found[network].setdefault(int(size), []).append(scores[score])
    return {network: [(size, statistics.mean(values), statistics.stdev(values) if len(values) > 1 else 0, len(values))
                      for size, values in sorted(of_size.items())] for network, of_size in found.items()}


def table(record):
    both = curves(record, "median"), curves(record, "pooled")
    shown = lambda value: f"{value:.3f}".replace("0.", ".", 1)
    lines = ["| points | " + " | ".join(title for title, _ in NETWORKS.values()) + " | draws |", "|---" * 5 + "|"]
    for row in range(len(both[0]["pcednet"])):
        size, _, _, draws = both[0]["pcednet"][row]
        cells = []
        for network in NETWORKS:
            (_, median, deviation, _), (_, pooled, spread, _) = (score[network][row] for score in both)
            cells.append(f"{shown(median)} ± {shown(deviation)} / {shown(pooled)} ± {shown(spread)}")
        lines.append(f"| {size:,} | " + " | ".join(cells) + f" | {draws} |")
    return "\n".join(lines)


def picture(record, score):
    """The curves as an SVG picture: means with bars of one standard deviation, names at the lines' ends."""
    found = curves(record, score)
    sizes = [size for size, *_ in found["pcednet"]]
    low = min(mean - deviation for points in found.values() for _, mean, deviation, _ in points)
    low = math.floor(low * 10) / 10
    high = math.ceil(max(mean + deviation for points in found.values() for _, mean, deviation, _ in points) * 10) / 10
    left, right, top, bottom = 70, 690, 56, 400
    first, last = math.log10(sizes[0]), math.log10(sizes[-1])

    def across(size):
        return left + 16 + (right - left - 32) * (math.log10(size) - first) / (last - first)

    def down(value):
        return bottom - (bottom - top) * (value - low) / (high - low)

    def text(x, y, words, more=""):
        return f'<text x="{x:.1f}" y="{y:.1f}" {more}>{words}</text>'

    def line(x1, y1, x2, y2, more):
        return f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" {more}/>'

    parts = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 780 460" width="780" height="460" '
             'font-family="Helvetica, Arial, DejaVu Sans, sans-serif" font-size="13" fill="#444">',
             '<rect width="780" height="460" fill="#fff"/>',
             text(left, 28, "MCC on unpainted clouds", 'font-size="15" fill="#111"'),
             text((left + right) / 2, 445, "painted points", 'text-anchor="middle"')]
    for tenth in range(round(low * 10), round(high * 10) + 1):
        parts.append(line(left, down(tenth / 10), right, down(tenth / 10), 'stroke="#e4e4e4"'))
        parts.append(text(left - 10, down(tenth / 10) + 4.5, f"{tenth / 10:.1f}", 'text-anchor="end"'))
    parts.append(line(left, bottom, right, bottom, 'stroke="#888"'))
    for size in sizes:
        parts.append(line(across(size), bottom, across(size), bottom + 5, 'stroke="#888"'))
        parts.append(text(across(size), bottom + 21, f"{size:,}", 'text-anchor="middle"'))
    names = []
    for aside, (network, (title, colour)) in zip((-4, 0, 4), NETWORKS.items()):
        dots = [(across(size) + aside, mean, deviation) for size, mean, deviation, _ in found[network]]
        path = " ".join(f"{x:.1f},{down(mean):.1f}" for x, mean, _ in dots)
        parts.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="2"/>')
        for x, mean, deviation in dots:
            parts.append(line(x, down(mean - deviation), x, down(mean + deviation), f'stroke="{colour}"'))
            parts.append(f'<circle cx="{x:.1f}" cy="{down(mean):.1f}" r="3.5" fill="{colour}" stroke="#fff"/>')
        names.append([down(dots[-1][1]), title, colour])
    names.sort()
    for above, below in itertools.pairwise(names):
        below[0] = max(below[0], above[0] + 17)
    shift = max(0, names[-1][0] - bottom)
    for y, title, colour in names:
        parts.append(text(right + 2, y - shift + 4.5, title, f'fill="{colour}" font-weight="bold"'))
    return "\n".join(parts + ["</svg>\n"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("-o", "--output", type=pathlib.Path, help="write the curves to this SVG file")
    parser.add_argument("--work", type=pathlib.Path, help="keep clouds and scores in this folder")
    parser.add_argument("--sizes", type=int, nargs="+", default=SIZES, help="numbers of painted points")
    parser.add_argument("--draws", type=int, default=5,
                        help=f"draws of strokes (above {MANY} points at most {MOST_DRAWS_OF_MANY})")
    parser.add_argument("--jobs", type=int, default=2, help="trainings at a time, one thread each")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as passing:
        record = run(options, options.work or pathlib.Path(passing))
    print(table(record))
    if options.output:
        options.output.write_text(picture(record, "median"))


if __name__ == "__main__":
    main()
