// A small study in the format of `pcednet study`: labelled cubes, what three methods make of them,
// and a sweep. Scores are computed here, from their definitions.
import fs from "node:fs";
import path from "node:path";

function random(seed) {
  let state = seed >>> 0;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

/** Points on the faces of a unit cube with labels by their distance to its edges; in the middles of the faces boundary. */
function cube(points, seed) {
  const next = random(seed);
  return Array.from({ length: points }, () => {
    const p = [next(), next(), next()];
    const axis = Math.floor(3 * next());
    p[axis] = next() < 0.5 ? 0 : 1;
    const away = p.map((c) => Math.min(c, 1 - c)).sort((a, b) => a - b)[1];
    const normal = [0, 0, 0];
    normal[axis] = 2 * p[axis] - 1;
    return { p, normal, label: away < 0.03 ? 2 : away < 0.08 ? 1 : away > 0.38 ? 3 : 0 };
  });
}

function writePly(file, cloud) {
  const head = [
    "ply",
    "format ascii 1.0",
    `element vertex ${cloud.length}`,
    ...["x", "y", "z", "nx", "ny", "nz"].map((n) => `property float ${n}`),
    "property uchar label",
    "end_header",
  ];
  const rows = cloud.map(({ p, normal, label }) => [...p.map((c) => c.toFixed(5)), ...normal, label].join(" "));
  fs.writeFileSync(file, [...head, ...rows, ""].join("\n"));
}

function scores({ tp, fp, tn, fn }) {
  const ratio = (a, b) => (b === 0 ? 0 : a / b);
  return {
    precision: ratio(tp, tp + fp),
    recall: ratio(tp, tp + fn),
    mcc: ratio(tp * tn - fp * fn, Math.sqrt((tp + fp) * (tp + fn) * (tn + fp) * (tn + fn))),
    f1: ratio(2 * tp, 2 * tp + fp + fn),
    accuracy: (tp + tn) / (tp + fp + tn + fn),
    iou: ratio(tp, tp + fp + fn),
  };
}

function count(cloud, said, positive) {
  const is = (label) => label === 2 || (positive === "edge" && label === 1);
  const counts = { tp: 0, fp: 0, tn: 0, fn: 0 };
  cloud.forEach(({ label }, i) => {
    counts[is(label) ? (is(said[i]) ? "tp" : "fn") : is(said[i]) ? "fp" : "tn"] += 1;
  });
  return counts;
}

function median(values) {
  const sorted = [...values].sort((a, b) => a - b);
  const half = sorted.length / 2;
  return (sorted[Math.floor(half)] + sorted[Math.ceil(half) - 1]) / 2;
}

/** A method that errs about each point with probability `error`. */
function guess(cloud, error, seed) {
  const next = random(seed);
  return Uint8Array.from(cloud, ({ label }) => (next() < error ? Math.floor(3 * next()) : label));
}

function evaluated(clouds, saids, positive) {
  const rows = clouds.map(({ name, points }, i) => {
    const counts = count(points, saids[i], positive);
    return { name, points: points.length, ...counts, ...scores(counts) };
  });
  const sum = {};
  for (const key of ["tp", "fp", "tn", "fn"]) sum[key] = rows.reduce((s, row) => s + row[key], 0);
  const keys = ["precision", "recall", "mcc", "f1", "accuracy", "iou"];
  return {
    clouds: rows,
    median: Object.fromEntries(keys.map((k) => [k, median(rows.map((row) => row[k]))])),
    pooled: { ...sum, ...scores(sum) },
  };
}

/** Writes the study to `folder`; returns its two experiments. */
export function writeStudy(folder) {
  const sets = [
    ["default", "edge", 3],
    ["cad", "sharp", 2],
  ].map(([name, positive, clouds], s) => ({
    name,
    positive,
    clouds: Array.from({ length: clouds }, (_, c) => ({ name: `cube${c}`, points: cube(900 + 100 * c, 10 * s + c) })),
  }));
  for (const set of sets) {
    fs.mkdirSync(path.join(folder, "clouds", set.name), { recursive: true });
    for (const cloud of set.clouds) writePly(path.join(folder, "clouds", set.name, `${cloud.name}.ply`), cloud.points);
  }
  const listed = sets.map(({ name, positive, clouds }) => ({
    name,
    positive,
    clouds: clouds.map((c) => ({ name: c.name, points: c.points.length, file: `clouds/${name}/${c.name}.ply` })),
  }));
  const common = {
    schema: "pcednet-study-1",
    version: "0.0.0",
    machine: "a machine, 2 cores",
    sets: listed,
  };
  const result = (experiment, variant, set, seed, error, keep) => {
    const saids = set.clouds.map((c, i) => guess(c.points, error, 1000 * (seed ?? 0) + 7 * i + variant.length));
    const predictions = keep ? `predictions/${experiment}/${variant}/${set.name}` : null;
    if (keep) {
      fs.mkdirSync(path.join(folder, predictions), { recursive: true });
      set.clouds.forEach((c, i) => fs.writeFileSync(path.join(folder, predictions, `${c.name}.u8`), saids[i]));
    }
    return {
      variant,
      set: set.name,
      seed,
      positive: set.positive,
      ...evaluated(set.clouds, saids, set.positive),
      seconds: { normals: 0, describe: 0.4, train: variant === "ca" ? 0 : 8, classify: 0.02 },
      joules: 3 + error,
      predictions,
    };
  };
  const methods = {
    ...common,
    experiment: "methods",
    title: "Methods </script> & <b>names</b>",
    question: "Which one?",
    command: "pcednet study methods -o study",
    x_label: null,
    variants: [
      { id: "ca", title: "Covariance analysis", family: "classic", parameters: null, x: null, note: "" },
      { id: "pcednet", title: "PCEDNet", family: "network", parameters: 1623, x: null, note: "" },
      { id: "cnn", title: "CNN", family: "network", parameters: 9723, x: null, note: "" },
    ],
    results: sets.flatMap((set) => [
      result("methods", "ca", set, null, 0.5, true),
      ...[1, 2, 3].map((seed) => result("methods", "pcednet", set, seed, 0.1, seed === 1)),
      ...[1, 2].map((seed) => result("methods", "cnn", set, seed, 0.3, seed === 1)),
    ]),
    curves: [1, 2].map((seed) => ({
      variant: "pcednet",
      seed,
      epochs: [1, 2, 3, 4].map((epoch) => ({
        epoch,
        seconds: epoch,
        loss: 1 / epoch,
        held_out_loss: 1.2 / epoch,
        held_out_mcc: 1 - 0.3 / (epoch + seed),
      })),
    })),
    expected: [{ variant: "pcednet", set: "default", published: { median: { mcc: 0.856 } }, source: "a table" }],
  };
  const scales = {
    ...common,
    experiment: "scales",
    title: "Scales",
    question: "How many?",
    command: "pcednet study scales --quick --test abc=/data/a/folder/with/a/long/name -o study --predictions parts",
    x_label: "scales",
    variants: [4, 8, 16, 32, 64, 128].map((x) => ({
      id: `pcednet-${x}`,
      title: `${x} scales`,
      family: "network",
      parameters: x,
      x,
      note: "",
    })),
    results: sets.flatMap((set) =>
      [4, 8, 16, 32, 64, 128].flatMap((x) =>
        [1, 2].map((seed) => result("scales", `pcednet-${x}`, set, seed, 1 / x, false)),
      ),
    ),
    curves: [],
    expected: [],
  };
  for (const study of [methods, scales]) {
    fs.writeFileSync(path.join(folder, `${study.experiment}.json`), JSON.stringify(study));
  }
  return { methods, scales };
}
