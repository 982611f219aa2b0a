// The lines found in the prediction: a search, a walk through them, what becomes of each.

import { BOUNDARY, CLASS_PALETTES } from "../shared/colours";
import { h } from "../shared/dom";
import type { Press } from "./chrome";
import type { Client } from "./client";
import { refusalOf } from "./refusal";
import { count, length, percent, plural } from "./format";
import { allow, button, buttons, checkbox, section, showOnly } from "./panel";
import { countDecisions, type Reviewer } from "./reviewer";
import type { AppStore, DxfArcs } from "./store";
import type { Line } from "./types";

const FORMATS: [string, string][] = [
  ["dxf", "DXF"],
  ["obj", "OBJ"],
  ["geojson", "GeoJSON"],
  ["gpkg", "GeoPackage"],
];

/** What DXF has as arcs and circles, as --dxf-arcs of `pcednet lines` says it. */
const DXF_ARCS: { value: DxfArcs; words: string }[] = [
  { value: "all", words: "DXF has all arcs and circles as such." },
  {
    value: "flat",
    words: "DXF has the flat ones (in horizontal planes) as such, the others as polylines, for FreeCAD and LibreCAD.",
  },
  { value: "none", words: "DXF has polylines only, for CloudCompare." },
];

/** How the search and the decisions stand. */
function summary(store: AppStore): string {
  const { lines, searchStage, runs, predictionVersion, edges } = store.now;
  if (lines.searching) return searchStage || "Finding lines";
  if (!edges) return "Lines are of edge classes, which this project does not have.";
  if (lines.version === 0) {
    return runs.length > 0
      ? "The predicted edges as segments, arcs and circles."
      : "Available once there is a prediction.";
  }
  const { accepted, rejected } = countDecisions(lines.lines);
  const stale = lines.prediction_version === predictionVersion ? "" : " The prediction has changed since.";
  return `${plural(lines.lines.length, "line")}: ${count(accepted)} accepted, ${count(rejected)} rejected.${stale}`;
}

/** What is known of a line. */
function facts(line: Line): [string, string][] {
  return [
    ["kind", `${line.kind}, ${CLASS_PALETTES.paper[line.class].name}`],
    ["length", length(line.length)],
    ["confidence", percent(line.confidence)],
    ...(line.class === BOUNDARY
      ? []
      : ([["angle", `${line.angle.toFixed(0)}° between the surfaces`]] as [string, string][])),
    ["points", count(line.points)],
    ["decision", line.decision],
  ];
}

export function linesPanel(store: AppStore, client: Client, reviewer: Reviewer, press: Press): HTMLElement {
  const words = h("p", { class: "summary", role: "status" });
  const find = button("Find lines", () => void client.lines.find());
  const boundaries = checkbox("Boundaries, too", "", (on) => store.set({ boundaries: on }));
  const cancel = button("Cancel", () => client.cancel());
  const show = checkbox("Show lines", "H", (on) => store.set({ showLines: on }));
  const title = h("h3", {});
  const list = h("dl", { class: "line-facts" });
  const accept = button("Accept", () => press("A"), "A");
  const reject = button("Reject", () => press("D"), "D");
  const rest = button("Accept the rest", () => reviewer.acceptRest());
  const walk = h(
    "div",
    { class: "buttons" },
    button("Previous", () => press("K"), "K"),
    button("Next", () => press("J"), "J"),
  );
  const download = async (format: string): Promise<void> => {
    await client.lines.settled();
    client.files.download("lines", `?format=${format}&dxf_arcs=${store.now.dxfArcs}`);
  };
  const arcs = buttons<DxfArcs>(
    "DXF arcs",
    DXF_ARCS.map(({ value }) => ({ value, label: value })),
    (dxfArcs) => store.set({ dxfArcs }),
  );
  const arcsWords = h("p", { class: "summary" });
  store.watch(["dxfArcs"], () => {
    arcs.set(store.now.dxfArcs);
    arcsWords.textContent = DXF_ARCS.find(({ value }) => value === store.now.dxfArcs)!.words;
  });
  const downloads = FORMATS.map(([format, label]) => button(label, () => void download(format)));
  const review = h(
    "div",
    {},
    show.element,
    walk,
    title,
    list,
    h("div", { class: "buttons" }, accept, reject, rest),
    h("p", { class: "summary" }, "Download the accepted lines"),
    h("div", { class: "buttons" }, ...downloads),
    arcs.element,
    arcsWords,
  );
  store.watch(["lines", "searchStage", "runs", "predictionVersion", "writer", "connected", "training", "edges"], () => {
    const { lines, runs, edges } = store.now;
    const mayDecide = refusalOf(store.now) === "";
    const { open, accepted } = countDecisions(lines.lines);
    words.textContent = summary(store);
    if (lines.searching) showOnly(cancel, find);
    else showOnly(find, cancel);
    find.hidden ||= !edges;
    boundaries.element.hidden = !edges;
    allow(find, mayDecide && runs.length > 0);
    review.hidden = lines.lines.length === 0;
    allow(rest, mayDecide && open > 0);
    for (const each of downloads) allow(each, accepted > 0 && store.now.connected);
  });
  store.watch(["lines", "line", "writer", "connected", "showLines"], () => {
    const { lines, line } = store.now;
    const chosen = line === null ? undefined : lines.lines[line];
    show.set(store.now.showLines);
    title.textContent = chosen ? `Line ${count(line! + 1)} of ${count(lines.lines.length)}` : "";
    list.replaceChildren(
      ...(chosen ? facts(chosen) : []).flatMap(([name, value]) => [h("dt", {}, name), h("dd", {}, value)]),
    );
    for (const each of [accept, reject]) allow(each, refusalOf(store.now) === "" && chosen !== undefined);
  });
  return section("Lines", true, words, h("div", { class: "buttons" }, find, cancel), boundaries.element, review);
}
