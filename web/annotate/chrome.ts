// What frames the view: the bar above, the tools beside, words over it.

import { BOUNDARY, type Meaning } from "../shared/colours";
import { h } from "../shared/dom";
import type { Client } from "./client";
import { refusalOf } from "./refusal";
import type { Saved } from "./files";
import { NONE, paintable, paletteOf } from "./classes";
import { fileClassesOf, isRamp, rampEnds, rampStops, FEATURE_NAMES } from "./colouring";
import type { Command } from "./commands";
import { MODES, PREDICTED } from "./modes";
import { count, length, stageText } from "./format";
import { downloadMenu } from "./download_menu";
import { icon, type IconName } from "./icons";
import { allow, button, unlessRefused } from "./panel";
import type { AppStore, State, Tool } from "./store";
import { hintWords } from "./words";

const TOOLS: { tool: Tool; icon: IconName; name: string; key: string }[] = [
  { tool: "brush", icon: "brush", name: "Brush", key: "B" },
  { tool: "lasso", icon: "lasso", name: "Lasso", key: "L" },
  { tool: "polygon", icon: "polygon", name: "Polygon", key: "G" },
  { tool: "measure", icon: "measure", name: "Measure a distance", key: "U" },
  { tool: "navigate", icon: "navigate", name: "Navigate", key: "V" },
];

/** Runs the command that has a key. */
export type Press = (key: string) => void;

export const presser =
  (commands: Command[]): Press =>
  (key) =>
    commands.find((c) => c.keys.includes(key))?.run();

function iconButton(name: IconName, label: string, key: string, press: Press): HTMLButtonElement {
  return h(
    "button",
    {
      type: "button",
      class: "tool",
      title: `${label} (${key})`,
      "aria-label": label,
      "aria-keyshortcuts": key.replace("Ctrl", "Control"),
      onclick: unlessRefused(() => press(key)),
    },
    icon(name),
  );
}

export function toolbar(store: AppStore, press: Press): HTMLElement {
  const tools = TOOLS.map((tool) => ({ ...tool, button: iconButton(tool.icon, tool.name, tool.key, press) }));
  const undo = iconButton("undo", "Undo", "Ctrl+Z", press);
  const redo = iconButton("redo", "Redo", "Ctrl+Shift+Z", press);
  const clip = iconButton("box", "Clipping box", "C", press);
  store.watch(["tool"], () =>
    tools.forEach(({ tool, button: b }) => b.setAttribute("aria-pressed", String(tool === store.now.tool))),
  );
  store.watch(["clip"], () => clip.setAttribute("aria-pressed", String(store.now.clip?.on ?? false)));
  store.watch(["undo", "redo", "writer", "connected"], () => {
    const may = refusalOf(store.now) === "";
    allow(undo, may && store.now.undo > 0);
    allow(redo, may && store.now.redo > 0);
  });
  return h(
    "div",
    { class: "toolbar", role: "toolbar", "aria-label": "Tools", "aria-orientation": "vertical" },
    ...tools.map((tool) => tool.button),
    h("hr", {}),
    undo,
    redo,
    h("hr", {}),
    iconButton("fit", "Fit to view", "F", press),
    clip,
    iconButton("camera", "Screenshot", "Shift+S", press),
    iconButton("help", "Keys", "?", press),
  );
}

export function header(store: AppStore, save: (what: Saved) => void, client: Client): HTMLElement {
  const name = h("h1", {}, "pcednet");
  const facts = h("p", { class: "facts" });
  store.watch(["session"], () => {
    const { session } = store.now;
    if (!session) return;
    document.title = `${session.name} · pcednet`;
    name.textContent = session.name;
    name.title = session.file;
    facts.textContent = `${count(session.points)} points${session.normals === "estimated" ? " · normals estimated" : ""}`;
  });
  const saves = (["project", "model", "cloud"] as Saved[]).map((what) => button(`Save ${what}`, () => save(what)));
  store.watch(["clouds"], () => {
    saves[2].textContent = store.now.clouds.length > 1 ? "Save clouds" : "Save cloud";
  });
  store.watch(["saving", "writer", "connected", "progress", "hasPrediction"], () => {
    const { saving, progress, hasPrediction } = store.now;
    const may = !saving && progress === null && refusalOf(store.now) === "";
    saves.forEach((b, i) => allow(b, may && (i !== 1 || hasPrediction)));
  });
  return h(
    "header",
    {},
    h("div", { class: "file" }, name, facts),
    h("div", { class: "saves" }, ...saves, downloadMenu(store, client)),
  );
}

/** The classes that a mode shows, by their colours; none in the modes of no classes. */
function meaningsOf(state: State): Meaning[] {
  const { mode, edges } = state;
  const palette = paletteOf(state);
  const shown = fileClassesOf(state);
  if (shown.length > 0) {
    const all = shown.reduce((sum, { points = 0 }) => sum + points, 0);
    return all === state.session?.points ? shown : [...shown, palette[NONE]];
  }
  if (mode !== "labels" && mode !== "prediction") return [];
  const ids = [...paintable(state).map(({ id }) => id), NONE];
  if (edges && mode === "prediction") ids.splice(BOUNDARY, 0, BOUNDARY); // nobody paints it
  return ids.map((id) => palette[id]);
}

function entry({ name, colour }: Meaning): HTMLElement {
  const swatch = h("span", { class: "swatch" });
  swatch.style.background = colour;
  return h("span", { class: "entry" }, swatch, name);
}

/** What the colours mean. */
export function legend(store: AppStore): HTMLElement {
  const element = h("div", { class: "legend" });
  store.watch(
    ["mode", "feature", "scale", "safePalette", "session", "paintOnTop", "outOfDate", "classes", "edges"],
    () => {
      const { mode, session, feature, scale } = store.now;
      let title = MODES.find((m) => m.mode === mode)!.name;
      if (mode === "feature" && session) {
        const name = session.features[feature];
        title = `${FEATURE_NAMES[name] ?? name}, radius ${length(session.scales[scale] ?? 0)}`;
      }
      if (mode === "file" && session?.file_predicted) title = "predictions in the file";
      if (PREDICTED.includes(mode) && store.now.outOfDate) title += ", out of date";
      element.replaceChildren(h("b", {}, title));
      if (isRamp(mode)) {
        const bar = h("span", { class: "ramp" });
        bar.style.background = `linear-gradient(to right, ${rampStops(store.now).join(", ")})`;
        const [low, high] = rampEnds(store.now);
        element.append(h("span", { class: "scale" }, low, bar, high));
      } else {
        element.append(...meaningsOf(store.now).map(entry));
      }
    },
  );
  return element;
}

/** What to do first, until there is a stroke. */
export function hint(store: AppStore): HTMLElement {
  const element = h("p", { class: "hint" });
  store.watch(["progress", "undo", "writer", "counts", "runs"], () => {
    const { progress, undo, writer, counts, runs } = store.now;
    element.hidden = progress !== null || !writer || undo > 0 || counts.some((n) => n > 0);
    element.textContent = hintWords(runs.length > 0, matchMedia("(pointer: coarse)").matches);
  });
  return element;
}

/** Loading, another window, a lost connection, a lost graphics card. */
export function curtain(store: AppStore, client: Client): HTMLElement {
  const bar = h("progress", { max: 1 });
  const stage = h("p", {});
  const loading = h("div", { class: "loading", role: "status" }, stage, bar);
  const other = h(
    "div",
    { class: "banner" },
    h("span", {}, "Another window is painting this cloud; this one is read-only. "),
    button("Take over", () => client.takeOver()),
  );
  const lost = h("div", { class: "banner", role: "alert" });
  const dark = h(
    "div",
    { class: "banner", role: "alert" },
    "The browser has lost the graphics card and cannot draw. If the cloud does not come back, reload the page: all strokes are kept.",
  );
  store.watch(["progress", "fetching", "writer", "connected", "restarted", "waiting"], () => {
    const { progress, fetching, writer, connected, restarted, waiting } = store.now;
    const strokes = waiting === 1 ? " One stroke waits." : waiting > 1 ? ` ${waiting} strokes wait.` : "";
    lost.textContent = restarted
      ? "pcednet was started again: open the address that it printed. All strokes are kept."
      : `pcednet does not answer. Is the program still running? Start it again as before, and this page goes on.${strokes}`;
    loading.hidden = progress === null && !fetching;
    other.hidden = writer || progress !== null || !connected;
    lost.hidden = connected;
    if (progress) {
      stage.textContent = stageText(progress.stage, progress.fraction);
      bar.value = progress.fraction;
    } else if (fetching) {
      stage.textContent = "Fetching the points";
      bar.removeAttribute("value");
    }
  });
  store.watch(["contextLost"], () => (dark.hidden = !store.now.contextLost));
  return h("div", { class: "curtain" }, loading, h("div", { class: "banners" }, other, lost, dark));
}
