// The clouds: truth and methods side by side, turned together.

import { BOUNDARY, CLASS_PALETTES, ERROR_PALETTE, NO_LABEL, type Meaning } from "../shared/colours";
import { bytesOf, classesOf, positionsOf } from "../shared/decode";
import { dropdown, h, segmented } from "../shared/dom";
import { PLAIN, type Stroke } from "../shared/line_layer";
import { PointViewer, type Place } from "../shared/viewer";
import { gallery as door } from "./look";
import {
  formatCount,
  formatScore,
  positiveName,
  shownOrder,
  titleOf,
  type Line,
  type PackedScene,
  type Report,
  type Result,
  type Study,
} from "./study";

type Mode = "classes" | "errors";
type Palette = "paper" | "safe";

interface Exhibit {
  scene: PackedScene;
  truth: Uint8Array;
  predictions: {
    title: string;
    result: Result | undefined;
    positive: string;
    classes: Uint8Array;
    lines: Line[];
  }[];
}

const GAP = 2;
const MOST_PANELS = 12;

/** What ERROR_PALETTE colours: 0 true negative, 1 true positive, 2 false positive, 3 false negative. */
export function agreement(truth: Uint8Array, said: Uint8Array, positive: string): Uint8Array {
  const isEdge = (label: number): boolean => label === 2 || (positive === "edge" && label === 1);
  return truth.map((label, i) => {
    if (label === NO_LABEL) return 4;
    const wanted = isEdge(label);
    return isEdge(said[i]) ? (wanted ? 1 : 2) : wanted ? 3 : 0;
  });
}

function exhibitOf(scene: PackedScene, studies: Study[], study: number): Exhibit {
  const { sets, variants, results } = studies[study];
  return {
    scene,
    truth: classesOf(scene.truth, scene.shown),
    predictions: scene.predictions
      .filter((p) => p.study === study)
      .map((p) => {
        // Counted twice, with and without smooth edges: as the set counts.
        const own = results.filter(
          (r) => r.variant === p.variant && r.set === scene.set && (r.seed ?? null) === p.seed,
        );
        const counts = sets.find((s) => s.name === scene.set)?.positive ?? "sharp";
        const result = own.find((r) => (r.positive ?? counts) === counts) ?? own[0];
        return {
          title: titleOf(variants.find((v) => v.id === p.variant)!),
          result,
          positive: result?.positive ?? counts,
          classes: classesOf(p.classes, scene.shown),
          lines: p.lines ?? [],
        };
      }),
  };
}

const strokesOf = (lines: Line[], palette: Palette): Stroke[] =>
  lines.map((line) => ({
    path: line.path.map((x) => x / 65535),
    fill: CLASS_PALETTES[palette][line.class].colour,
    ...PLAIN,
  }));

/** As 12 lines, length 3.14. */
function lengthText(lines: Line[]): string {
  const length = lines.reduce((sum, line) => sum + line.length, 0);
  return `${formatCount(lines.length)} line${lines.length === 1 ? "" : "s"}, length ${Number(length.toPrecision(4))}`;
}

class Gallery {
  readonly element = h("section", { class: "gallery", id: "clouds", "aria-labelledby": "clouds-title" });
  private readonly canvas = h("canvas", {
    tabindex: 0,
    "aria-label": "The cloud in 3D. Arrow keys orbit, plus and minus zoom, 0 resets the view.",
  });
  private readonly labels = h("div", { class: "labels" });
  private readonly stage = h("div", { class: "stage" }, this.canvas, this.labels);
  private readonly bar = h("div", { class: "controls" });
  private readonly chips = h("fieldset", { class: "chips" });
  private readonly key = h("p", { class: "key" });
  private readonly note = h("p", { class: "note" });
  private colours!: HTMLElement;
  private readonly viewer: PointViewer;
  private study: number;
  private scene: PackedScene;
  private exhibit!: Exhibit;
  private chosen = new Set<string>();
  private mode: Mode = "classes";
  private palette: Palette = "paper";
  private lines = true;
  private size = 1;

  constructor(private readonly report: Report) {
    this.viewer = new PointViewer(this.canvas);
    this.viewer.setBackground("#59616c");
    this.scene = report.scenes[0];
    const shown = new Set(this.scene.predictions.map((p) => p.study));
    this.study = shownOrder(report.studies).find((i) => shown.has(i))!;
    this.element.append(
      h("h2", { id: "clouds-title" }, "The clouds"),
      h(
        "p",
        { class: "question" },
        "The ground truth and the methods' predictions, point by point. Drag to orbit all views; the wheel " +
          "zooms once a view has been clicked.",
      ),
      this.bar,
      this.chips,
      this.stage,
      this.key,
      this.note,
    );
    this.open(this.scene, true);
    const find = (set: string, cloud: string): PackedScene | undefined =>
      report.scenes.find((s) => s.set === set && s.cloud === cloud);
    door.has = (set, cloud) => find(set, cloud) !== undefined;
    door.show = (set, cloud, study, variant) => {
      this.study = study;
      const title = report.studies[study].variants.find((v) => v.id === variant);
      if (title) this.chosen.add(titleOf(title));
      this.open(find(set, cloud)!, false);
      this.element.scrollIntoView();
      this.canvas.focus({ preventScroll: true });
    };
    new ResizeObserver(() => this.layOut()).observe(this.stage);
  }

  private open(scene: PackedScene, afresh: boolean): void {
    this.scene = scene;
    if (!scene.predictions.some((p) => p.study === this.study)) this.study = scene.predictions[0].study;
    this.exhibit = exhibitOf(scene, this.report.studies, this.study);
    const titles = this.exhibit.predictions.map((p) => p.title);
    const kept = titles.filter((title) => this.chosen.has(title));
    this.chosen = new Set(
      kept.length > 0 && !afresh ? kept : titles.slice(0, matchMedia("(max-width: 640px)").matches ? 3 : 2),
    );
    this.viewer.setCloud({
      positions: positionsOf(scene.positions),
      normals: bytesOf(scene.normals),
      view: scene.view,
    });
    this.viewer.setPointSize(this.size);
    this.drawControls();
    this.drawPanels();
  }

  private drawControls(): void {
    const { scenes, studies } = this.report;
    const sets = [...new Set(scenes.map((s) => s.set))];
    const clouds = scenes.filter((s) => s.set === this.scene.set);
    const owners = [...new Set(this.scene.predictions.map((p) => p.study))];
    const palettes: { value: Palette; label: string }[] = [
      { value: "paper", label: "as in the paper" },
      { value: "safe", label: "colour-blind safe" },
    ];
    const modes: { value: Mode; label: string }[] = [
      { value: "classes", label: "classes" },
      { value: "errors", label: "errors" },
    ];
    this.colours = segmented("Colours", palettes, this.palette, (p) => {
      this.palette = p;
      this.drawPanels();
    });
    this.bar.replaceChildren(
      dropdown(
        "Set",
        sets.map((s) => ({ value: s, label: s })),
        this.scene.set,
        (set) => this.open(scenes.find((s) => s.set === set)!, false),
      ),
      dropdown(
        "Cloud",
        clouds.map((s) => ({ value: s, label: s.cloud })),
        this.scene,
        (s) => this.open(s, false),
      ),
      ...(owners.length < 2
        ? []
        : [
            dropdown(
              "Experiment",
              owners.map((i) => ({ value: i, label: studies[i].title })),
              this.study,
              (i) => {
                this.study = i;
                this.open(this.scene, true);
              },
            ),
          ]),
      segmented("Show", modes, this.mode, (mode) => {
        this.mode = mode;
        this.drawPanels();
      }),
      this.colours,
      ...(this.scene.lines
        ? [
            h(
              "label",
              { class: "check" },
              h("input", {
                type: "checkbox",
                checked: this.lines,
                onchange: (e: Event) => {
                  this.lines = (e.target as HTMLInputElement).checked;
                  this.drawPanels();
                },
              }),
              "Lines",
            ),
          ]
        : []),
      h(
        "label",
        { class: "slider" },
        h("span", {}, "Point size"),
        h("input", {
          type: "range",
          min: 0.3,
          max: 3,
          step: 0.05,
          value: this.size,
          oninput: (e: InputEvent) => {
            this.size = Number((e.target as HTMLInputElement).value);
            this.viewer.setPointSize(this.size);
          },
        }),
      ),
      h(
        "button",
        {
          type: "button",
          class: "plain",
          title: "reset the view",
          onclick: () => this.viewer.reset(),
        },
        "Reset",
      ),
    );
    this.chips.replaceChildren(
      h("legend", {}, "Shown beside the truth"),
      ...this.exhibit.predictions.map(({ title }) =>
        h(
          "label",
          {},
          h("input", {
            type: "checkbox",
            checked: this.chosen.has(title),
            onchange: (e: Event) => {
              const box = e.target as HTMLInputElement;
              if (box.checked && this.chosen.size >= MOST_PANELS) box.checked = false;
              else if (box.checked) this.chosen.add(title);
              else this.chosen.delete(title);
              this.drawPanels();
            },
          }),
          h("span", {}, title),
        ),
      ),
    );
  }

  private drawPanels(): void {
    const { truth, predictions, scene } = this.exhibit;
    const shown = predictions.filter((p) => this.chosen.has(p.title));
    const lines = this.lines && scene.lines ? [scene.lines, ...shown.map((p) => p.lines)] : [];
    const errors = this.mode === "errors";
    const positive = (shown[0] ?? predictions[0]).positive;
    this.colours.hidden = errors; // errors have colours of their own, safe anyway
    this.viewer.setPalette(errors ? ERROR_PALETTE : CLASS_PALETTES[this.palette]);
    this.viewer.setPanels([
      errors ? agreement(truth, truth, positive) : truth,
      ...shown.map((p) => (errors ? agreement(truth, p.classes, p.positive) : p.classes)),
    ]);
    this.viewer.setLines(lines.map((those) => strokesOf(those, this.palette)));
    this.labels.replaceChildren(
      h("div", { class: "label" }, h("p", {}, h("b", {}, "Truth")), lines[0] && h("p", {}, lengthText(lines[0]))),
      ...shown.map(({ title, result }, i) => {
        const mcc = result?.clouds.find((c) => c.name === scene.cloud)?.mcc;
        return h(
          "div",
          { class: "label" },
          h("p", { title }, h("b", {}, title), mcc !== undefined && h("span", {}, ` MCC ${formatScore(mcc)}`)),
          lines[i + 1] && h("p", {}, lengthText(lines[i + 1])),
        );
      }),
    );
    this.drawKey(errors ? ERROR_PALETTE : CLASS_PALETTES[this.palette], positive, lines.flat());
    this.layOut();
  }

  private drawKey(meanings: Meaning[], positive: string, lines: Line[]): void {
    const { scene, truth, predictions } = this.exhibit;
    const absent = [
      ...(truth.includes(NO_LABEL) ? [] : ["no label"]),
      ...([truth, ...predictions.map((p) => p.classes)].some((classes) => classes.includes(BOUNDARY))
        ? []
        : ["boundary"]),
    ];
    this.key.replaceChildren(
      ...meanings
        .filter((m) => !absent.includes(m.name))
        .map((m) => h("span", {}, h("span", { class: "swatch", style: `background:${m.colour}` }), m.name)),
      ...CLASS_PALETTES[this.palette]
        .filter((_, its) => lines.some((line) => line.class === its))
        .map((m) =>
          h("span", {}, h("span", { class: "swatch line", style: `background:${m.colour}` }), `line of a ${m.name}`),
        ),
    );
    const sampled =
      scene.shown < scene.points
        ? `${formatCount(scene.shown)} of its ${formatCount(scene.points)} points, a uniform sample`
        : `all ${formatCount(scene.points)} points`;
    const counts = this.mode === "errors" ? ` Positive class: ${positiveName(positive)}.` : "";
    this.note.textContent = `${scene.file}: ${sampled}. Scores count every point.${counts}`;
  }

  /** Panels of one size in as many columns as leave them wide enough. */
  private layOut(): void {
    const count = this.labels.children.length;
    const width = this.stage.clientWidth;
    if (width === 0) return;
    const most = Math.max(width < 480 ? 2 : 1, Math.floor(width / 290));
    const rows = Math.ceil(count / most);
    const columns = Math.ceil(count / rows);
    const across = (width - GAP * (columns - 1)) / columns;
    const down = Math.round(Math.min(Math.max(across, 150), 480));
    const places: Place[] = Array.from({ length: count }, (_, i) => ({
      x: (i % columns) * (across + GAP),
      y: Math.floor(i / columns) * (down + GAP),
      width: across,
      height: down,
    }));
    const height = rows * down + GAP * (rows - 1);
    this.stage.style.height = `${height}px`;
    [...this.labels.children].forEach((label, i) => {
      const { x, y } = places[i];
      (label as HTMLElement).style.cssText = `left:${x}px;top:${y}px;width:${across}px;height:${down}px`;
    });
    this.viewer.setLayout(width, height, places);
  }
}

/** The section, or a word on why there is none. */
export function gallery(report: Report): HTMLElement | null {
  if (report.scenes.length === 0) return null;
  try {
    return new Gallery(report).element;
  } catch {
    return h(
      "section",
      { class: "gallery", id: "clouds" },
      h("h2", {}, "The clouds"),
      h("p", { class: "note" }, "This browser does not support WebGL, which is needed to draw the clouds."),
    );
  }
}
