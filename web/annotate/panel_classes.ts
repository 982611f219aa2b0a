// The classes: which one is painted, how many points have it, which are hidden; and the brush.

import { h } from "../shared/dom";
import { LEAST_SPACINGS, type Brush } from "./brush";
import { paletteOf } from "./colouring";
import { toggled } from "./commands";
import { boxDiagonal } from "./geometry";
import { count, length } from "./format";
import { icon } from "./icons";
import { checkbox, section, slider } from "./panel";
import type { AppStore } from "./store";
import { NO_CLASS } from "./types";

const KEYS = ["1", "2", "3", "E"];

/** A row: choose, see, count. */
function classRow(store: AppStore, id: number, index: number): HTMLElement {
  const name = index === 3 ? "eraser" : paletteOf(store.now)[index].name;
  const radio = h("input", { type: "radio", name: "class", value: id, onchange: () => store.set({ paintClass: id }) });
  const swatch = h("span", { class: "swatch", "aria-hidden": "true" });
  if (index === 3) swatch.append(icon("eraser"));
  const counter = h("span", { class: "count" });
  const eye = h("button", {
    type: "button",
    class: "eye",
    onclick: () => store.set({ hidden: toggled(store.now.hidden, id) }),
  });
  const row = h(
    "li",
    { class: "class" },
    h("label", {}, radio, swatch, h("span", { class: "name" }, name), h("kbd", {}, KEYS[index])),
    counter,
    index < 3 ? eye : h("span", { class: "eye" }),
  );
  store.watch(["paintClass", "counts", "hidden", "safePalette", "settings"], () => {
    const { now } = store;
    radio.checked = now.paintClass === id;
    radio.disabled = id === 1 && now.settings.classes === 2;
    row.classList.toggle("off", radio.disabled);
    if (index < 3) {
      const hidden = now.hidden.has(id);
      swatch.style.background = paletteOf(now)[index].colour;
      counter.textContent = count(now.counts[index]);
      counter.setAttribute("aria-label", `${now.counts[index]} points painted`);
      eye.replaceChildren(icon(hidden ? "hidden" : "eye"));
      eye.setAttribute("aria-pressed", String(hidden));
      eye.setAttribute("aria-label", `Hide ${name}`);
      eye.title = `${hidden ? "Show" : "Hide"} ${name} (Shift+${KEYS[index]})`;
    }
  });
  return row;
}

export function classesPanel(store: AppStore, brush: Brush): HTMLElement {
  const size = slider("Brush", 0, 1, 0.001, (at) => {
    const { session } = store.now;
    if (!session) return;
    const [low, high] = [session.spacing * LEAST_SPACINGS, boxDiagonal(session.bounds) / 4];
    brush.grow((low * (high / low) ** at) / store.now.radius);
  });
  const protect = checkbox("Protect painted points", "P", (on) => store.set({ protect: on }));
  const front = checkbox("Lasso: front points only", "X", (on) => store.set({ frontOnly: on }));
  store.watch(["radius", "session", "protect", "frontOnly"], () => {
    const { radius, session } = store.now;
    protect.set(store.now.protect);
    front.set(store.now.frontOnly);
    if (!session) return;
    const [low, high] = [session.spacing * LEAST_SPACINGS, boxDiagonal(session.bounds) / 4];
    size.set(Math.log(radius / low) / Math.log(high / low), length(radius));
  });
  return section(
    "Paint",
    true,
    h("ul", { class: "classes" }, ...[0, 1, 2, NO_CLASS].map((id, index) => classRow(store, id, index))),
    size.element,
    protect.element,
    front.element,
  );
}
