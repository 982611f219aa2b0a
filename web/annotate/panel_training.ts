// Training: what it begins from, how it goes, what it was before.

import { seriesColour } from "../shared/colours";
import { h } from "../shared/dom";
import { linePlot } from "../shared/lines";
import type { Press } from "./chrome";
import type { Client } from "./client";
import { refusalOf } from "./refusal";
import { isOff, paletteOf } from "./classes";
import { count, percent, seconds } from "./format";
import { allow, button, buttons, checkbox, list, section, showOnly } from "./panel";
import type { AppStore } from "./store";
import type { Run, Start } from "./types";

/** What a start is called; a model file without its folder. */
const startName = (start: Start): string => (start === "random" ? "nothing" : `model ${start.split("/").at(-1)}`);

/** The loss by epoch: two curves where the context network trains, too, whose loss is of other samples. */
function curves(store: AppStore): HTMLElement {
  const place = h("div", { class: "curves" });
  let drawn = 0;
  const draw = (): void => {
    drawn = 0;
    const { training, runs } = store.now;
    const isOfStart = runs.some((run) => run.current && run.run === 0); // which no training shown here made
    place.hidden = !training || training.epoch.length < 2 || (isOfStart && !training.active);
    if (place.hidden || !training) return;
    place.replaceChildren(
      linePlot({
        x: training.epoch,
        height: 104,
        xLabel: "",
        yLabel: "",
        lines: [
          { name: "loss", colour: seriesColour(0), y: training.loss },
          ...(training.context.some((loss) => loss !== null)
            ? [{ name: "of the context network", colour: seriesColour(1), y: training.context }]
            : []),
        ],
      }),
    );
  };
  store.watch(["training", "runs"], () => {
    if (!drawn) drawn = window.setTimeout(draw, 100);
  });
  return place;
}

/** How right the run is on strokes that it was not trained on. */
function heldOut({ held_out: held, start }: Run): string {
  if (!held) return "";
  if (held.accuracy === null) return "Not enough strokes to tell how right it is: two of each class are needed.";
  const before = held.start === null ? "" : `; ${startName(start)}: ${percent(held.start)}`;
  return `Right on held-out strokes: ${percent(held.accuracy)}${before}.`;
}

/** How the training stands, in one line. */
function summary(store: AppStore): string {
  const { training, runs, counts, settings } = store.now;
  const last = runs.find((run) => run.current);
  if (training?.active) return `Run ${training.run}: epoch ${training.epoch.at(-1)} of ${training.epochs}`;
  if (last?.run === 0) return `This is what ${startName(last.start)} finds. Paint where it is wrong.`;
  if (last) {
    const took = last.seconds_train === null ? "" : `: ${seconds(last.seconds_train + (last.seconds_classify ?? 0))}`;
    return `Run ${last.run}${took}. ${heldOut(last)}`;
  }
  const lacking = counts.filter((n, id) => n > 0 && !isOff(id, store.now)).length < 2;
  const then = settings.auto ? "training starts automatically" : "then train";
  return lacking ? `Paint points of two classes; ${then}.` : "Not trained yet.";
}

export function trainingPanel(store: AppStore, client: Client): HTMLElement {
  const words = h("p", { class: "summary", role: "status" });
  const bar = h("progress", { max: 1, "aria-label": "Training" });
  const train = button("Train now", () => client.train(), "T");
  const cancel = button("Cancel", () => client.cancel(), "Esc");
  const auto = checkbox("Train after each stroke", "", (on) => client.setSettings({ auto: on }));
  const classes = buttons<2 | 3>(
    "Model",
    [
      { value: 2, label: "2 classes" },
      { value: 3, label: "3 classes" },
    ],
    (chosen) => client.setSettings({ classes: chosen }),
  );
  const start = h("div", {});
  const own = h(
    "p",
    { class: "summary" },
    "Shipped models know edges alone: own classes begin with nothing, or with a model of yours.",
  );
  const follow = (): void => {
    const off = refusalOf(store.now) !== "";
    for (const element of [auto.element, classes.element, start]) {
      for (const each of element.querySelectorAll<HTMLInputElement | HTMLSelectElement>("input, select")) {
        each.disabled = off;
      }
    }
  };
  const showStarts = (): void => {
    const { session, settings } = store.now;
    const names = [...new Set(["random", ...(session?.starts ?? []), settings.start])];
    const choices = names.map((value) => ({ value, label: startName(value) }));
    const picker = list("Start from", choices, (chosen) => client.setSettings({ start: chosen }));
    picker.set(settings.start);
    start.replaceChildren(picker.element);
    follow();
  };
  store.watch(["training", "runs", "counts", "settings", "edges", "writer", "connected"], () => {
    const { training } = store.now;
    allow(train, refusalOf(store.now) === "");
    const active = training?.active ?? false;
    words.textContent = summary(store);
    bar.hidden = !active;
    if (active) showOnly(cancel, train);
    else showOnly(train, cancel);
    if (training) bar.value = (training.epoch.at(-1) ?? 0) / Math.max(training.epochs, 1);
  });
  store.watch(["settings"], () => {
    const { settings } = store.now;
    auto.set(settings.auto);
    classes.set(settings.classes);
    start.querySelectorAll("option").forEach((option) => (option.selected = option.text === startName(settings.start)));
  });
  store.watch(["session"], showStarts);
  store.watch(["writer", "connected"], follow);
  store.watch(["edges"], () => {
    classes.element.hidden = !store.now.edges;
    own.hidden = store.now.edges;
  });
  return section(
    "Training",
    true,
    words,
    bar,
    curves(store),
    h("div", { class: "buttons" }, train, cancel),
    auto.element,
    classes.element,
    start,
    own,
  );
}

export function uncertainPanel(store: AppStore, press: Press): HTMLElement {
  const right = button("It is right", () => press("Y"), "Y");
  const words = h("p", { class: "summary", role: "status" });
  store.watch(["uncertain", "runs"], () => {
    const { uncertain: place, runs } = store.now;
    words.textContent = place
      ? `Place ${count(place.rank)} of ${count(place.of)}: ${paletteOf(store.now)[place.prediction].name}, ` +
        `confidence ${percent(place.confidence)}. Paint its true class, or say that it is right.`
      : runs.length > 0
        ? "Places of lowest confidence first."
        : "Available once there is a prediction.";
    allow(right, place !== null);
  });
  const steps = [button("Previous", () => press("Shift+N"), "⇧N"), button("Next", () => press("N"), "N")];
  return section("Uncertain places", true, words, h("div", { class: "buttons" }, ...steps, right));
}

function runRow(run: Run, client: Client): HTMLElement {
  const accuracy = run.held_out?.accuracy ?? null;
  const held = accuracy === null ? "–" : percent(accuracy);
  return h(
    "tr",
    { class: run.current && "current" },
    h(
      "th",
      { scope: "row", title: run.time && new Date(run.time).toLocaleString() },
      run.run === 0 ? startName(run.start) : String(run.run),
    ),
    h("td", {}, held),
    h("td", {}, run.loss === null ? "–" : run.loss.toFixed(3)),
    h("td", {}, run.painted === null ? "–" : count(run.painted)),
    h(
      "td",
      {},
      run.current
        ? "current"
        : h(
            "button",
            {
              type: "button",
              class: "link",
              "aria-label": `Restore run ${run.run}`,
              onclick: () => client.restore(run.run),
            },
            "restore",
          ),
    ),
  );
}

export function runsPanel(store: AppStore, client: Client): HTMLElement {
  const body = h("tbody", {});
  const table = h(
    "table",
    { class: "runs" },
    h(
      "thead",
      {},
      h("tr", {}, ...["Run", "Held out", "Loss", "Painted", ""].map((name) => h("th", { scope: "col" }, name))),
    ),
    body,
  );
  const none = h("p", { class: "summary" }, "None yet.");
  store.watch(["runs"], () => {
    const { runs } = store.now;
    table.hidden = runs.length === 0;
    none.hidden = runs.length > 0;
    body.replaceChildren(...[...runs].reverse().map((run) => runRow(run, client)));
  });
  return section("Runs", false, none, table);
}
