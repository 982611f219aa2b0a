// What methods cost: seconds and joules, a row a method, on a logarithmic scale.

import { h, svg } from "../shared/dom";
import { roomFor, rowName } from "./marks";
import { plainTable } from "./scores_table";
import { costOf, formatCost, titleOf, type Group } from "./study";

const WIDTH = 500;
const ROW = 26;

export const STAGES = ["normals", "describe", "describe_training", "train", "classify"];

const STAGE_NAMES: Record<string, string> = {
  normals: "normals",
  describe: "descriptors",
  describe_training: "descriptors for training",
  train: "training",
  classify: "classification",
};

/** A cost's name for people. */
export function costName(name: string): string {
  if (name === "joules") return "joules per 1000 points";
  return STAGE_NAMES[name] ?? name;
}

const SHAPES: Record<string, (x: number, y: number) => string> = {
  normals: (x, y) => `M${x - 4} ${y - 4}h8v8h-8z`,
  describe: (x, y) => `M${x} ${y - 5.5}l5.5 5.5l-5.5 5.5l-5.5 -5.5z`,
  describe_training: (x, y) => `M${x} ${y - 5.5}l5.5 5.5l-5.5 5.5l-5.5 -5.5z`,
  train: (x, y) => `M${x} ${y - 5}l5.5 9.5h-11z`,
  classify: (x, y) => `M${x - 4.5} ${y}a4.5 4.5 0 1 0 9 0a4.5 4.5 0 1 0 -9 0z`,
  joules: (x, y) => `M${x - 4.5} ${y}a4.5 4.5 0 1 0 9 0a4.5 4.5 0 1 0 -9 0z`,
};

/** Powers of ten that embrace the positive `values`. */
function decades(values: number[]): [number, number] {
  const logs = values.map(Math.log10);
  const low = Math.floor(Math.min(...logs));
  return [low, Math.max(low + 1, Math.ceil(Math.max(...logs)))];
}

/** A row for each method: what it costs is the same for any positive class. */
const onePerVariant = (groups: Group[]): Group[] =>
  groups.filter((group, i) => groups.findIndex((other) => other.index === group.index) === i);

/** A dot for each stage that took time; null if none did. The axis is that of `all`, so that plots can be compared. */
export function costPlot(groups: Group[], all: Group[], names: string[], unit: string): HTMLElement | null {
  const rows = onePerVariant(groups)
    .map((group) => ({ group, costs: names.map((name) => ({ name, spread: costOf(group, name) })) }))
    .filter(({ costs }) => costs.some(({ spread }) => spread && spread.mean > 0));
  if (rows.length === 0) return null;
  const values = all.flatMap((group) => names.map((name) => costOf(group, name)?.mean ?? 0)).filter((v) => v > 0);
  const room = roomFor(rows.map(({ group }) => titleOf(group.variant)));
  const used = names.filter((name) => rows.some(({ group }) => (costOf(group, name)?.mean ?? 0) > 0));
  const [low, high] = decades(values);
  const x = (v: number): number => room + ((Math.log10(v) - low) / (high - low)) * (WIDTH - room - 20);
  const height = rows.length * ROW + 30;
  const ticks = Array.from({ length: high - low + 1 }, (_, k) => low + k);
  const plot = svg(
    "svg",
    { viewBox: `0 0 ${WIDTH} ${height}`, role: "img", "aria-label": `${unit}, logarithmic` },
    ...ticks.flatMap((t) => [
      svg("line", { x1: x(10 ** t), x2: x(10 ** t), y1: 2, y2: height - 26, class: "rule" }),
      svg(
        "text",
        { x: x(10 ** t), y: height - 12, "text-anchor": "middle", class: "tick" },
        Math.abs(t) < 4 ? String(Number((10 ** t).toPrecision(1))) : `1e${t}`,
      ),
    ]),
    ...rows.map(({ group, costs }, row) => {
      const y = row * ROW + ROW / 2 + 2;
      const known = costs.filter(({ spread }) => spread && spread.mean > 0);
      const places = known.map(({ spread }) => x(spread!.mean));
      return svg(
        "g",
        {},
        rowName(titleOf(group.variant), room - 10, y + 4),
        svg("line", { x1: Math.min(...places), x2: Math.max(...places), y1: y, y2: y, class: "base" }),
        ...known.map(({ name, spread }) =>
          svg(
            "path",
            { d: SHAPES[name](x(spread!.mean), y), class: `stage ${name}` },
            svg("title", {}, `${titleOf(group.variant)}, ${costName(name)}: ${formatCost(spread!.mean)} ${unit}`),
          ),
        ),
      );
    }),
  );
  const key =
    used.length > 1 &&
    h(
      "figcaption",
      { class: "key" },
      ...used.map((name) =>
        h(
          "span",
          {},
          svg(
            "svg",
            { viewBox: "0 0 14 14", width: 14, height: 14, "aria-hidden": "true" },
            svg("path", { d: SHAPES[name](7, 7), class: `stage ${name}` }),
          ),
          costName(name),
        ),
      ),
    );
  return h("figure", { class: "wide" }, key, plot);
}

/** The same in numbers. */
export function costTable(caption: string, groups: Group[]): HTMLElement {
  const names = [...STAGES, "joules"].filter((name) => groups.some((g) => costOf(g, name) !== null));
  return plainTable(
    caption,
    ["Method", ...names.map((n) => costName(n) + (n === "joules" ? "" : ", s"))],
    onePerVariant(groups).map((group) => [
      titleOf(group.variant),
      ...names.map((name) => {
        const spread = costOf(group, name);
        return spread ? formatCost(spread.mean) : "–";
      }),
    ]),
  );
}
