// An experiment that sweeps a number: lines over it, one for each set and series.

import { seriesColour } from "../shared/colours";
import { dropdown, h } from "../shared/dom";
import { linePlot, type Line } from "../shared/lines";
import {
  METRICS,
  METRIC_NAMES,
  costOf,
  positiveName,
  scoreOf,
  titleOf,
  type Group,
  type Metric,
  type Spread,
  type Statistic,
  type Study,
  type Variant,
} from "./study";
import { STAGES, costName } from "./costs";

type Measure = Metric | string;

/** What the variants of one line have in common: the id without the swept number at its end. */
export function seriesOf(variant: Variant): string {
  return variant.id.replace(/[^A-Za-z0-9]*-?[0-9]+(\.[0-9]+)?(e[-+]?[0-9]+)?%?$/i, "") || variant.id;
}

/** What the titles of its variants begin with, without the number and what belongs to it. */
function lineName(series: string, titles: string[]): string {
  let common = titles[0];
  for (const title of titles) while (!title.startsWith(common)) common = common.slice(0, -1);
  return titles.length > 1 ? common.replace(/[\s,:(]*[\d.]*$/, "") || series : titles[0];
}

const measured = (group: Group, statistic: Statistic, measure: Measure): Spread | null =>
  (METRICS as readonly string[]).includes(measure)
    ? scoreOf(group, statistic, measure as Metric)
    : costOf(group, measure);

const nameOf = (measure: Measure): string =>
  METRIC_NAMES[measure as Metric] ?? costName(measure) + (measure === "joules" ? "" : ", s");

/** Whether the numbers spread over so much that a logarithmic axis shows them better. */
const spreads = (values: number[]): boolean =>
  Math.min(...values) > 0 && Math.max(...values) / Math.min(...values) >= 20;

function plotOf(study: Study, groups: Group[], statistic: Statistic, measure: Measure): HTMLElement {
  const x = [...new Set(groups.map((g) => g.variant.x!))].sort((a, b) => a - b);
  const series = [...new Set(groups.map((g) => seriesOf(g.variant)))];
  const sets = [...new Set(groups.map((g) => g.set))];
  const keys = [...new Set(groups.map((g) => JSON.stringify([seriesOf(g.variant), g.set, g.positive])))];
  const lines = keys.map((key): Line => {
    const [own, set, positive] = JSON.parse(key) as string[];
    const members = groups.filter((g) => JSON.stringify([seriesOf(g.variant), g.set, g.positive]) === key);
    const spreadsAt = x.map((v) => {
      const group = members.find((g) => g.variant.x === v);
      return group ? measured(group, statistic, measure) : null;
    });
    const both = groups.some((g) => g.set === set && seriesOf(g.variant) === own && g.positive !== positive);
    const parts = [
      series.length > 1 &&
        lineName(
          own,
          members.map((g) => titleOf(g.variant)),
        ),
      sets.length > 1 && set,
      both && positiveName(positive),
    ].filter(Boolean);
    const many = series.length > 1;
    return {
      name: parts.join(", ") || nameOf(measure),
      colour: seriesColour(many ? series.indexOf(own) : sets.indexOf(set)),
      dashed: both ? positive === "sharp" : many && sets.indexOf(set) % 2 === 1,
      y: spreadsAt.map((s) => s?.mean ?? null),
      error: spreadsAt.map((s) => s?.deviation ?? null),
    };
  });
  const values = lines.flatMap((line) => line.y).filter((v): v is number => v !== null);
  const isCost = !(METRICS as readonly string[]).includes(measure);
  return linePlot({
    x,
    lines,
    points: true,
    height: 320,
    xLabel: study.x_label!,
    yLabel: nameOf(measure) + (isCost ? "" : ` (${statistic})`),
    scores: !isCost,
    logX: spreads(x),
    logY: isCost && values.length > 0 && spreads(values),
  });
}

/** The plot, and what to plot. */
export function sweep(
  study: Study,
  groups: Group[],
  statistic: () => Statistic,
): { element: HTMLElement; draw: () => void } {
  const swept = groups.filter((g) => typeof g.variant.x === "number");
  const measures: Measure[] = [...METRICS, ...STAGES, "joules"].filter((measure) =>
    swept.some((g) => {
      const spread = measured(g, "median", measure);
      return spread !== null && ((METRICS as readonly string[]).includes(measure) || spread.mean > 0);
    }),
  );
  const preferred = study.experiment === "energy" ? "joules" : study.experiment === "timing" ? "classify" : "mcc";
  let measure = measures.includes(preferred) ? preferred : measures[0];
  const place = h("div");
  const draw = (): void => {
    if (measure) place.replaceChildren(plotOf(study, swept, statistic(), measure));
  };
  draw();
  const picker = dropdown(
    "Show",
    measures.map((m) => ({ value: m, label: nameOf(m) })),
    measure,
    (m) => {
      measure = m;
      draw();
    },
  );
  return { element: h("div", {}, h("div", { class: "controls" }, picker), place), draw };
}
