// How the scores of the clouds spread: precision against recall, and one score by itself.

import { seriesColour } from "../shared/colours";
import { h, svg } from "../shared/dom";
import { densityOf, filledAbove } from "./density";
import { gallery } from "./look";
import { roomFor, rowName } from "./marks";
import {
  METRIC_NAMES,
  cloudsOf,
  formatScore,
  positiveName,
  titleOf,
  type CloudRow,
  type Group,
  type Metric,
} from "./study";

const SIDE = 190;
const PAD = { left: 26, right: 8, top: 8, bottom: 24 };
/** Room for the names of the axes. */
const NAMES = 12;
const INNER = SIDE - PAD.left - PAD.right;
const GRID = 41;
const MARGIN = 0.1;

const xOf = (value: number): number => PAD.left + value * INNER;
const yOf = (value: number): number => PAD.top + (1 - value) * INNER;

/** Where 2pr / (p + r) = f, from r = 1 to p = 1. */
function isoF1(f: number): string {
  const points: string[] = [];
  const least = f / (2 - f);
  for (let k = 0; k <= 40; ++k) {
    const p = least + ((1 - least) * k) / 40;
    points.push(`${xOf(p).toFixed(1)} ${yOf((f * p) / (2 * p - f)).toFixed(1)}`);
  }
  return `M${points.join("L")}`;
}

function frame(): SVGElement[] {
  const ticks = [0, 0.5, 1].flatMap((t) => [
    svg("text", { x: xOf(t), y: SIDE - 8, "text-anchor": "middle", class: "tick" }, String(t).replace("0.", ".")),
    svg(
      "text",
      { x: PAD.left - 5, y: yOf(t) + 3.5, "text-anchor": "end", class: "tick" },
      String(t).replace("0.", "."),
    ),
  ]);
  const [middle, side] = [PAD.left + INNER / 2, PAD.top + INNER / 2];
  return [
    svg("text", { x: middle, y: SIDE + 6, "text-anchor": "middle", class: "tick" }, "precision"),
    svg(
      "text",
      { x: -2, y: side, "text-anchor": "middle", class: "tick", transform: `rotate(-90 -2 ${side})` },
      "recall",
    ),
    svg("rect", { x: PAD.left, y: PAD.top, width: INNER, height: INNER, class: "frame" }),
    ...[0.2, 0.4, 0.6, 0.8].flatMap((f) => [
      svg("path", { d: isoF1(f), class: "iso" }),
      svg(
        "text",
        { x: xOf(1) - 3, y: yOf(f / (2 - f)) - 2, "text-anchor": "end", class: "iso-name" },
        `F1 ${String(f).slice(1)}`,
      ),
    ]),
    ...ticks,
  ];
}

function density(clouds: CloudRow[], colour: string): SVGElement | null {
  if (clouds.length < 3) return null;
  const points = clouds.map((c): [number, number] => [c.precision, c.recall]);
  const grid = densityOf(points, 0.055, GRID, MARGIN);
  const most = Math.max(...grid.values);
  const cell = (INNER * (1 + 2 * MARGIN)) / (GRID - 1);
  const place = `translate(${xOf(-MARGIN)} ${yOf(-MARGIN)}) scale(${cell} ${-cell})`;
  return svg(
    "g",
    { transform: place, fill: colour, "fill-opacity": 0.13 },
    ...[0.15, 0.4, 0.7].map((share) => svg("path", { d: filledAbove(grid, share * most) })),
  );
}

let clips = 0;

/** A panel for each method: recall over precision, a dot for each cloud, their density behind. */
export function scatterPanels(groups: Group[], mixed: boolean): HTMLElement {
  return h(
    "div",
    { class: "panels" },
    ...groups.map((group) => {
      const clouds = cloudsOf(group);
      const colour = seriesColour(group.index);
      const clip = `clip${++clips}`;
      const name = titleOf(group.variant) + (mixed ? ` (${positiveName(group.positive)})` : "");
      return h(
        "figure",
        {},
        h("figcaption", {}, name),
        svg(
          "svg",
          {
            viewBox: `${-NAMES} 0 ${SIDE + NAMES} ${SIDE + NAMES}`,
            role: "img",
            "aria-label": `${name}: recall over precision of ${clouds.length} clouds`,
          },
          svg("clipPath", { id: clip }, svg("rect", { x: PAD.left, y: PAD.top, width: INNER, height: INNER })),
          ...frame(),
          svg("g", { "clip-path": `url(#${clip})` }, density(clouds, colour)),
          ...clouds.map((cloud) =>
            svg(
              "circle",
              {
                cx: xOf(cloud.precision),
                cy: yOf(cloud.recall),
                r: 3.2,
                fill: colour,
                class: gallery.has(group.set, cloud.name) ? "dot look" : "dot",
                onclick: () =>
                  gallery.has(group.set, cloud.name) &&
                  gallery.show(group.set, cloud.name, group.study, group.variant.id),
              },
              svg(
                "title",
                {},
                `${cloud.name}: precision ${formatScore(cloud.precision)}, ` +
                  `recall ${formatScore(cloud.recall)}, MCC ${formatScore(cloud.mcc)}`,
              ),
            ),
          ),
        ),
      );
    }),
  );
}

const BINS = 25;
const ROW = 34;
const WIDTH = 500;

/** A histogram over the clouds for each method, with the median as a stroke. */
export function histograms(groups: Group[], metric: Metric, mixed: boolean): HTMLElement {
  const values = groups.map((g) => cloudsOf(g).map((c) => c[metric]));
  const low = Math.min(0, ...values.flat().map((v) => Math.floor(v * 5) / 5));
  const titles = groups.map((g) => titleOf(g.variant) + (mixed ? `, ${positiveName(g.positive)}` : ""));
  const name = roomFor(titles);
  const inner = WIDTH - name - 14;
  const x = (value: number): number => name + ((value - low) / (1 - low)) * inner;
  const height = groups.length * ROW + 36;
  const ticks = Array.from({ length: Math.round((1 - low) * 5) + 1 }, (_, k) => low + k / 5);
  const lines = groups.map((group, row) => {
    const counts = new Array<number>(BINS).fill(0);
    for (const v of values[row]) counts[Math.min(BINS - 1, Math.floor(((v - low) / (1 - low)) * BINS))] += 1;
    const most = Math.max(...counts, 1);
    const base = row * ROW + ROW - 5;
    const sorted = [...values[row]].sort((a, b) => a - b);
    const middle = sorted.length / 2;
    const median = (sorted[Math.floor(middle)] + sorted[Math.ceil(middle) - 1]) / 2;
    const title = titles[row];
    return svg(
      "g",
      {},
      rowName(title, name - 10, base - 4),
      svg("line", { x1: name, x2: WIDTH - 14, y1: base, y2: base, class: "base" }),
      ...counts.map(
        (count, bin) =>
          count > 0 &&
          svg(
            "rect",
            {
              x: name + (bin * inner) / BINS + 0.5,
              width: inner / BINS - 1,
              y: base - (count / most) * (ROW - 10),
              height: (count / most) * (ROW - 10),
              fill: seriesColour(group.index),
              "fill-opacity": 0.75,
            },
            svg(
              "title",
              {},
              `${title}: ${count} of ${sorted.length} clouds, ${METRIC_NAMES[metric]} ` +
                `${formatScore(low + ((1 - low) * bin) / BINS)} to ${formatScore(low + ((1 - low) * (bin + 1)) / BINS)}`,
            ),
          ),
      ),
      svg(
        "line",
        { x1: x(median), x2: x(median), y1: base - ROW + 8, y2: base + 3, class: "median" },
        svg("title", {}, `${title}: median ${formatScore(median)}`),
      ),
    );
  });
  return h(
    "figure",
    { class: "wide" },
    svg(
      "svg",
      { viewBox: `0 0 ${WIDTH} ${height}`, role: "img", "aria-label": `${METRIC_NAMES[metric]} over the clouds` },
      ...ticks.flatMap((t) => [
        svg("line", { x1: x(t), x2: x(t), y1: 4, y2: height - 34, class: "rule" }),
        svg(
          "text",
          { x: x(t), y: height - 20, "text-anchor": "middle", class: "tick" },
          String(Number(t.toFixed(1))).replace("0.", "."),
        ),
      ]),
      svg("text", { x: name + inner / 2, y: height - 5, "text-anchor": "middle", class: "tick" }, METRIC_NAMES[metric]),
      ...lines,
    ),
  );
}
