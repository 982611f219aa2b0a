// The page's data, as `pcednet report` writes it, and sums over it.

export const METRICS = ["precision", "recall", "mcc", "f1", "accuracy", "iou"] as const;
export type Metric = (typeof METRICS)[number];
export const METRIC_NAMES: Record<Metric, string> = {
  precision: "Precision",
  recall: "Recall",
  mcc: "MCC",
  f1: "F1",
  accuracy: "Accuracy",
  iou: "IoU",
};

export type Scores = Record<Metric, number>;
export type CloudRow = Scores & { name: string; points: number };
export type Statistic = "median" | "pooled";

export interface Variant {
  id: string;
  title?: string;
  family?: string;
  parameters?: number | null;
  x?: number | null;
  note?: string;
}

export interface Result {
  variant: string;
  set: string;
  seed?: number | null;
  positive?: string;
  clouds: CloudRow[];
  median?: Scores | null;
  pooled?: Scores | null;
  seconds?: Record<string, number> | null;
  joules?: number | null;
  predictions?: string | null;
}

export interface Epoch {
  epoch: number;
  seconds?: number | null;
  loss?: number | null;
  held_out_loss?: number | null;
  held_out_mcc?: number | null;
}

export interface Study {
  experiment: string;
  title: string;
  question?: string;
  command?: string;
  version?: string;
  machine?: string;
  x_label?: string | null;
  sets: { name: string; positive?: string; clouds: { name: string; points?: number; file: string }[] }[];
  variants: Variant[];
  results: Result[];
  curves?: { variant: string; seed?: number | null; epochs: Epoch[] }[] | null;
  expected?: Expected[] | null;
}

export interface Expected {
  variant: string;
  set: string;
  positive?: string;
  published: Partial<Record<Statistic, Partial<Scores>>>;
  source?: string;
}

/** An edge as a curve. */
export interface Line {
  class: number;
  length: number;
  /** Vertices: x, y, z, x, y, z, ...; 65535 is the longest side of the box of the points. */
  path: number[];
}

export interface PackedScene {
  set: string;
  cloud: string;
  file: string;
  points: number;
  shown: number;
  size: number;
  view: number[];
  positions: string;
  normals: string;
  truth: string;
  /** Of the truth, if the page has lines. */
  lines?: Line[];
  predictions: { study: number; variant: string; seed: number | null; classes: string; lines?: Line[] }[];
}

export interface Report {
  schema: string;
  /** Of the page, as its maker wished; empty: none. */
  title?: string;
  date?: string;
  studies: Study[];
  scenes: PackedScene[];
}

/** The numbers of the studies as they are shown: the comparison of methods first. */
export function shownOrder(studies: Study[]): number[] {
  const isLater = (i: number): number => Number(studies[i].experiment !== "methods");
  return studies.map((_, i) => i).sort((a, b) => isLater(a) - isLater(b) || a - b);
}

export interface Spread {
  mean: number;
  /** Sample standard deviation; null of a single value. */
  deviation: number | null;
  count: number;
}

export function spreadOf(values: (number | null | undefined)[]): Spread | null {
  const numbers = values.filter((v): v is number => typeof v === "number" && Number.isFinite(v));
  if (numbers.length === 0) return null;
  const mean = numbers.reduce((a, b) => a + b, 0) / numbers.length;
  if (numbers.length === 1) return { mean, deviation: null, count: 1 };
  const squares = numbers.reduce((sum, v) => sum + (v - mean) ** 2, 0);
  return { mean, deviation: Math.sqrt(squares / (numbers.length - 1)), count: numbers.length };
}

/** The results of one variant on one set with one positive class: one for each seed. */
export interface Group {
  /** Its place in the report. */
  study: number;
  variant: Variant;
  index: number;
  set: string;
  positive: string;
  results: Result[];
}

export const positiveName = (positive: string): string => (positive === "edge" ? "sharp + smooth" : positive);

export const titleOf = (variant: Variant): string => variant.title ?? variant.id;

export function groupsOf(study: Study, number: number): Group[] {
  const groups = new Map<string, Group>();
  for (const result of study.results) {
    const index = study.variants.findIndex((v) => v.id === result.variant);
    const positive = result.positive ?? study.sets.find((s) => s.name === result.set)?.positive ?? "sharp";
    const key = JSON.stringify([index, result.set, positive]);
    const group = groups.get(key) ?? {
      study: number,
      variant: study.variants[index],
      index,
      set: result.set,
      positive,
      results: [],
    };
    group.results.push(result);
    groups.set(key, group);
  }
  return [...groups.values()].sort((a, b) => a.index - b.index);
}

export const scoreOf = (group: Group, statistic: Statistic, metric: Metric): Spread | null =>
  spreadOf(group.results.map((r) => r[statistic]?.[metric]));

/** Seconds by what they were spent on, or joules, over the seeds. */
export const costOf = (group: Group, name: string): Spread | null =>
  spreadOf(group.results.map((r) => (name === "joules" ? r.joules : r.seconds?.[name])));

/** Each cloud's scores, the mean over the seeds. */
export function cloudsOf(group: Group): CloudRow[] {
  const rows = new Map<string, CloudRow[]>();
  for (const result of group.results) {
    for (const cloud of result.clouds) rows.set(cloud.name, [...(rows.get(cloud.name) ?? []), cloud]);
  }
  return [...rows].map(([name, seeds]) => {
    const row = { name, points: seeds[0].points } as CloudRow;
    for (const metric of METRICS) row[metric] = spreadOf(seeds.map((s) => s[metric]))!.mean;
    return row;
  });
}

/** Where the published figures of a study come from, in words; empty if it has none. */
export function sourcesOf(study: Study): string {
  const sources = [...new Set((study.expected ?? []).map((e) => e.source).filter(Boolean))];
  return sources.length > 0 ? ` Published: ${sources.join("; ")}.` : "";
}

export const expectedOf = (study: Study, group: Group): Expected | undefined =>
  study.expected?.find(
    (e) => e.variant === group.variant.id && e.set === group.set && (e.positive ?? group.positive) === group.positive,
  );

/** .856, 1.000, -.120 */
export function formatScore(value: number): string {
  return value
    .toFixed(3)
    .replace(/^(-?)0\./, "$1.")
    .replace(/^-(\.000)$/, "$1");
}

export function formatCost(value: number): string {
  if (value === 0) return "0";
  const digits = value >= 100 ? 0 : value >= 10 ? 1 : value >= 1 ? 2 : 3;
  return value < 0.0005 ? value.toExponential(0) : value.toFixed(digits);
}

export const formatCount = (value: number): string =>
  Math.round(value)
    .toString()
    .replace(/\B(?=(\d{3})+$)/g, "\u202f");
