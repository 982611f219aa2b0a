// One section of the page: an experiment with its tables and charts.

import { dropdown, h, segmented } from "../shared/dom";
import { STAGES, costPlot, costTable } from "./costs";
import { learningCurves } from "./curves";
import { histograms, scatterPanels } from "./distributions";
import { overviewTable, setTable } from "./scores_table";
import {
  METRICS,
  METRIC_NAMES,
  groupsOf,
  positiveName,
  sourcesOf,
  type Group,
  type Metric,
  type Statistic,
  type Study,
} from "./study";
import { sweep } from "./sweep";

const STATISTICS: { value: Statistic; label: string }[] = [
  { value: "median", label: "median" },
  { value: "pooled", label: "pooled" },
];

/** The command that made the study, to copy. */
function commandLine(command: string): HTMLElement {
  const button = h(
    "button",
    {
      type: "button",
      class: "copy",
      onclick: () => {
        void navigator.clipboard?.writeText(command).then(() => (button.textContent = "copied"));
      },
    },
    "copy",
  );
  return h("div", { class: "command" }, h("code", { tabindex: 0 }, command), button);
}

function seedsNote(groups: Group[]): string {
  const most = Math.max(...groups.map((g) => g.results.length));
  return most > 1 ? ` Mean ± standard deviation over up to ${most} seeds.` : "";
}

function part(title: string, note: string, ...children: (HTMLElement | null)[]): HTMLElement {
  return h("section", { class: "part" }, h("h3", {}, title), h("p", { class: "note" }, note), ...children);
}

/** Everything about one set, for the chosen statistic. */
function onSet(study: Study, groups: Group[], set: string, statistic: Statistic): (HTMLElement | null)[] {
  const own = groups.filter((g) => g.set === set);
  const scored = own.filter((g) => g.results.some((r) => r.clouds.length > 0));
  const mixed = new Set(own.map((g) => g.positive)).size > 1;
  const size = study.sets.find((s) => s.name === set)?.clouds.length ?? 0;
  const sweeps = typeof study.x_label === "string";
  const seconds = costPlot(own, groups, STAGES, "seconds");
  const joules = costPlot(own, groups, ["joules"], "joules per 1000 points");
  const counts = mixed ? "" : ` Positive class: ${positiveName(own[0]?.positive ?? "sharp")}.`;
  return [
    own.some((g) => g.results.some((r) => r[statistic]))
      ? part(
          "Scores",
          `${size} clouds; ${
            statistic === "median" ? "the median of each score" : "the scores of the pooled counts"
          }.${counts} The best of each column${mixed ? " is marked, for each positive class" : " is marked"}. Open a row to ` +
            `see its clouds.${seedsNote(own)}${sourcesOf(study)}`,
          setTable(study, groups, set, statistic),
        )
      : null,
    scored.length > 0 && !sweeps
      ? part(
          "Precision and recall",
          "Recall against precision: a dot for each cloud, their density, and curves of equal F1.",
          scatterPanels(scored, mixed),
        )
      : null,
    !sweeps && (scored.length > 0 || seconds)
      ? h(
          "div",
          { class: "pair" },
          scored.length > 0 &&
            part(
              "MCC over the clouds",
              "Histogram over the clouds; the line marks the median.",
              histograms(scored, "mcc", mixed),
            ),
          seconds &&
            part("Seconds", "Total over the clouds of the set, logarithmic scale, the same for every set.", seconds),
          joules && part("Joules per 1000 points", "Logarithmic scale.", joules),
        )
      : null,
    seconds || joules
      ? h(
          "details",
          {},
          h("summary", {}, "Table of seconds and joules"),
          costTable(`${study.title}: costs on ${set}`, own),
        )
      : null,
  ];
}

export function experimentSection(study: Study, number: number): HTMLElement {
  const id = `experiment-${number}`;
  const groups = groupsOf(study, number);
  const sets = study.sets.map((s) => s.name).filter((name) => groups.some((g) => g.set === name));
  const scored = groups.some((g) => g.results.some((r) => r.median || r.pooled));
  let statistic: Statistic = "median";
  let metric: Metric = "mcc";
  let set = sets[0];
  const overview = h("div", { class: "overview" });
  const detail = h("div");
  const curve =
    typeof study.x_label === "string" && groups.some((g) => typeof g.variant.x === "number")
      ? sweep(study, groups, () => statistic)
      : null;
  const drawOverview = (): void => {
    if (sets.length > 1 && scored) overview.replaceChildren(overviewTable(study, groups, statistic, metric));
  };
  const drawDetail = (): void => {
    if (set) detail.replaceChildren(...onSet(study, groups, set, statistic).filter((c) => c !== null));
  };
  const draw = (): void => {
    drawOverview();
    drawDetail();
    curve?.draw();
  };
  draw();
  const statistics = segmented("Statistic", STATISTICS, statistic, (s) => {
    statistic = s;
    draw();
  });
  const metrics = dropdown(
    "Score",
    METRICS.map((m) => ({ value: m, label: METRIC_NAMES[m] })),
    metric,
    (m) => {
      metric = m;
      drawOverview();
    },
  );
  const setSwitch = segmented(
    "Set",
    sets.map((s) => ({ value: s, label: s })),
    set,
    (s) => {
      set = s;
      drawDetail();
    },
  );
  const curves = learningCurves(study);
  return h(
    "section",
    { class: "experiment", id, "aria-labelledby": `${id}-title` },
    h("h2", { id: `${id}-title` }, study.title),
    study.question && h("p", { class: "question" }, study.question),
    study.command && commandLine(study.command),
    scored && h("div", { class: "controls" }, statistics, sets.length > 1 && metrics),
    curve && curve.element,
    sets.length > 1 && scored && overview,
    sets.length > 1 && h("div", { class: "controls set-switch" }, setSwitch),
    detail,
    curves.length > 0 &&
      part(
        "Learning",
        "Mean over the seeds; error bars show one standard deviation. Click a name to hide its line.",
        h("div", { class: "pair" }, ...curves),
      ),
  );
}
