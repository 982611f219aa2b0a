// Line plots with error bars (uPlot): scores over a swept number, learning curves.

import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import "./lines.css";
import { css, h } from "./dom";

export interface Line {
  name: string;
  colour: string;
  /** One y for each x of the plot. */
  y: (number | null)[];
  /** Half the length of the error bar at each x. */
  error?: (number | null)[];
  dashed?: boolean;
  faint?: boolean;
}

export interface LinePlot {
  x: number[];
  lines: Line[];
  xLabel: string;
  yLabel: string;
  logX?: boolean;
  logY?: boolean;
  points?: boolean;
  height?: number;
  /** y is a score: written as in tables, .87. */
  scores?: boolean;
}

/** Steps of an axis of whole numbers. */
const WHOLE = [1, 2, 5].flatMap((n) => [0, 1, 2, 3, 4, 5].map((e) => n * 10 ** e)).sort((a, b) => a - b);

/** The lowest and the highest that is drawn, error bars too. */
function extent(lines: Line[]): [number, number] {
  const ends = lines.flatMap(({ y, error }) =>
    y.flatMap((v, i) => (v === null ? [] : [v - (error?.[i] ?? 0), v + (error?.[i] ?? 0)])),
  );
  return ends.length > 0 ? [Math.min(...ends), Math.max(...ends)] : [0, 1];
}

const score = (v: number): string => String(Number(v.toPrecision(6))).replace(/^(-?)0\./, "$1.");

function drawErrors(lines: Line[]): uPlot.Plugin {
  return {
    hooks: {
      draw: (u: uPlot) => {
        const { ctx } = u;
        lines.forEach((line, k) => {
          if (!line.error || !u.series[k + 1].show) return;
          ctx.save();
          ctx.strokeStyle = line.colour;
          ctx.lineWidth = devicePixelRatio * 1.2;
          ctx.beginPath();
          line.y.forEach((y, i) => {
            const error = line.error![i];
            if (y === null || !error) return;
            const x = u.valToPos(u.data[0][i], "x", true);
            const cap = 3 * devicePixelRatio;
            const [top, bottom] = [u.valToPos(y + error, "y", true), u.valToPos(y - error, "y", true)];
            if (!Number.isFinite(top) || !Number.isFinite(bottom)) return;
            ctx.moveTo(x, top);
            ctx.lineTo(x, bottom);
            ctx.moveTo(x - cap, top);
            ctx.lineTo(x + cap, top);
            ctx.moveTo(x - cap, bottom);
            ctx.lineTo(x + cap, bottom);
          });
          ctx.stroke();
          ctx.restore();
        });
      },
    },
  };
}

const compact = (v: number): string =>
  Math.abs(v) >= 1e6 ? `${v / 1e6}M` : Math.abs(v) >= 1e4 ? `${v / 1e3}k` : String(Number(v.toPrecision(6)));

/** A digit of an axis in pixels, at most, and what is between the numbers and the plot. */
const DIGIT = 7,
  GAP = 9;

/** The room beside the plot: no number is cut. */
const besidePlot =
  (least: number): uPlot.Axis.Size =>
  (_, values) =>
    Math.max(least, GAP + DIGIT * Math.max(0, ...(values ?? []).map((value) => value.length)));

/** A label of no letters takes no room. */
function axis(label: string, size: uPlot.Axis.Size): uPlot.Axis {
  return {
    label: label || undefined,
    labelSize: label ? 20 : 0,
    labelFont: `12px ${css("--sans")}`,
    font: `11px ${css("--sans")}`,
    size,
    stroke: css("--ink-2"),
    grid: { stroke: css("--line"), width: 1 },
    ticks: { show: false },
    values: (_, splits) => splits.map((v) => (v === null ? "" : compact(v))),
  };
}

function options(plot: LinePlot, width: number): uPlot.Options {
  const xAxis = axis(plot.xLabel, 30);
  if (plot.logX) {
    // Ticks where there are data, unless they crowd.
    xAxis.splits = () => plot.x;
    xAxis.filter = (_, splits) => splits;
  } else if (plot.x.every(Number.isInteger)) {
    xAxis.incrs = WHOLE;
  }
  const yAxis = axis(plot.yLabel, besidePlot(plot.yLabel ? 46 : 30));
  if (plot.scores) yAxis.values = (_, splits) => splits.map((v) => (v === null ? "" : score(v)));
  return {
    width,
    height: plot.height ?? 260,
    scales: {
      x: {
        time: false,
        distr: plot.logX ? 3 : 1,
        range: (_, min, max) =>
          plot.logX
            ? [min / (max / min) ** 0.04, max * (max / min) ** 0.04]
            : [min - 0.03 * (max - min || 1), max + 0.03 * (max - min || 1)],
      },
      y: plot.logY ? { distr: 3 } : { range: () => uPlot.rangeNum(...extent(plot.lines), 0.1, true) },
    },
    axes: [xAxis, yAxis],
    // As the line is drawn.
    legend: { markers: { width: 2, dash: (u, i) => (u.series[i].dash ? "dashed" : "solid") } },
    series: [
      { label: plot.xLabel, value: (_, v) => (v === null ? "" : compact(v)) },
      ...plot.lines.map(
        (line): uPlot.Series => ({
          label: line.name,
          stroke: line.colour,
          width: line.faint ? 1 : 2,
          dash: line.dashed ? [5, 4] : undefined,
          spanGaps: true,
          points: { show: plot.points ?? false, size: 6, fill: line.colour },
          value: (_, v) => (v === null || v === undefined ? "" : Number(v.toPrecision(3)).toString()),
        }),
      ),
    ],
    cursor: { drag: { x: false, y: false } },
    plugins: [drawErrors(plot.lines)],
  };
}

/** A plot as wide as its place, drawn anew for another width, another theme, and for paper. */
export function linePlot(plot: LinePlot): HTMLElement {
  const place = h("div", {
    class: "plot",
    role: "img",
    "aria-label":
      plot.yLabel && plot.xLabel
        ? `${plot.yLabel} over ${plot.xLabel}`
        : plot.lines.map((line) => line.name).join(", "),
  });
  let drawn: uPlot | undefined;
  let width = 0;
  const draw = (): void => {
    drawn?.destroy();
    const data: uPlot.AlignedData = [plot.x, ...plot.lines.map((line) => line.y)];
    drawn = new uPlot(options(plot, width), data, place);
    drawn.batch(() => {}); // draws now: a page that is printed waits for nothing
  };
  new ResizeObserver(([entry]) => {
    const now = Math.floor(entry.contentRect.width);
    if (now === 0 || now === width) return;
    width = now;
    if (drawn) drawn.setSize({ width, height: plot.height ?? 260 });
    else draw();
  }).observe(place);
  for (const other of ["(prefers-color-scheme: dark)", "print"]) {
    matchMedia(other).addEventListener("change", () => place.isConnected && drawn && draw());
  }
  return place;
}
