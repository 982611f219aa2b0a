// The classes: which one is painted, how many points have it, which are hidden; and the brush.

import { h } from "../shared/dom";
import type { Brush } from "./brush";
import { brushRange } from "./brush_size";
import { refusalOf } from "./refusal";
import { isOff, paintable, paletteOf } from "./classes";
import { toggled } from "./commands";
import { count, length } from "./format";
import { icon } from "./icons";
import { fileStrokes } from "./file_classes";
import { allow, button, checkbox, section, slider } from "./panel";
import type { AppStore } from "./store";
import { NO_CLASS } from "./types";

/** A row: choose, see, count. It follows the state when asked to. */
interface Row {
  element: HTMLElement;
  follow(): void;
}

function classRow(store: AppStore, id: number, key: string): Row {
  const isEraser = id === NO_CLASS;
  const radio = h("input", { type: "radio", name: "class", value: id, onchange: () => store.set({ paintClass: id }) });
  const swatch = h("span", { class: "swatch", "aria-hidden": "true" });
  if (isEraser) swatch.append(icon("eraser"));
  const words = h("span", { class: "name" }, "eraser");
  const counter = h("span", { class: "count" });
  const eye = h("button", {
    type: "button",
    class: "eye",
    onclick: () => store.set({ hidden: toggled(store.now.hidden, id) }),
  });
  const element = h(
    "li",
    { class: "class" },
    h("label", {}, radio, swatch, words, key && h("kbd", {}, key)),
    counter,
    isEraser ? h("span", { class: "eye" }) : eye,
  );
  const follow = (): void => {
    const { now } = store;
    radio.checked = now.paintClass === id;
    radio.disabled = isOff(id, now);
    element.classList.toggle("off", radio.disabled);
    if (isEraser) return;
    const { name, colour } = paletteOf(now)[id];
    const hidden = now.hidden.has(id);
    words.textContent = words.title = name;
    swatch.style.background = colour;
    counter.textContent = count(now.counts[id] ?? 0);
    counter.setAttribute("aria-label", `${now.counts[id] ?? 0} points painted`);
    eye.replaceChildren(icon(hidden ? "hidden" : "eye"));
    eye.setAttribute("aria-pressed", String(hidden));
    eye.setAttribute("aria-label", `Hide ${name}`);
    eye.title = `${hidden ? "Show" : "Hide"} ${name} (Shift+${key})`;
  };
  follow();
  return { element, follow };
}

/** A row for each class and the eraser, as there are. */
function classRows(store: AppStore): HTMLElement {
  const list = h("ul", { class: "classes" });
  let rows: Row[] = [];
  let shown = "";
  store.watch(["classes", "edges", "paintClass", "counts", "hidden", "safePalette", "settings"], () => {
    const ids = paintable(store.now).map(({ id }) => id);
    if (shown !== ids.join()) {
      shown = ids.join();
      rows = [...ids, NO_CLASS].map((id, index) => classRow(store, id, id === NO_CLASS ? "E" : String(index + 1)));
      list.replaceChildren(...rows.map((row) => row.element));
    }
    for (const row of rows) row.follow();
  });
  return list;
}

export function classesPanel(store: AppStore, brush: Brush, edit: () => void, takeFileLabels: () => void): HTMLElement {
  const size = slider("Brush", 0, 1, 0.001, (at) => {
    const { session } = store.now;
    if (!session) return;
    const [low, high] = brushRange(session);
    brush.grow((low * (high / low) ** at) / store.now.radius);
  });
  const protect = checkbox("Protect painted points", "P", (on) => store.set({ protect: on }));
  const front = checkbox("Lasso: front points only", "X", (on) => store.set({ frontOnly: on }));
  store.watch(["radius", "session", "protect", "frontOnly"], () => {
    const { radius, session } = store.now;
    protect.set(store.now.protect);
    front.set(store.now.frontOnly);
    if (!session) return;
    const [low, high] = brushRange(session);
    size.set(Math.log(radius / low) / Math.log(high / low), length(radius));
  });
  const change = button("Classes…", edit, "⇧E");
  change.title = "Add, rename, recolour or remove classes (Shift+E)";
  const take = button("As in the file", takeFileLabels);
  take.title = "Paint every unpainted point with its class in the file, within the clipping box if it is in use";
  store.watch(["writer", "connected"], () => {
    change.disabled = refusalOf(store.now) !== "";
    allow(take, refusalOf(store.now) === "");
  });
  store.watch(["session", "classes", "edges"], () => (take.hidden = fileStrokes(store.now).length === 0));
  return section(
    "Paint",
    true,
    classRows(store),
    h("div", { class: "buttons" }, change, take),
    size.element,
    protect.element,
    front.element,
  );
}
