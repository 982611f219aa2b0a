// How the cloud is coloured, and the clipping box.

import { h } from "../shared/dom";
import { FEATURE_NAMES } from "./colouring";
import { MODES, modesOf } from "./modes";
import type { Press } from "./chrome";
import { sliceOf } from "./clip_handles";
import { boxDiagonal } from "./geometry";
import { coordinate, length } from "./format";
import { button, buttons, checkbox, list, section, slider, type Picker } from "./panel";
import type { Side } from "./camera";
import type { Stage } from "./stage";
import type { AppStore, Clip, ColourMode, Theme } from "./store";
import type { Box } from "./types";

const SIDES: [Side, string][] = [
  ["top", "Z"],
  ["front", "W"],
  ["right", "Q"],
  ["bottom", "⇧Z"],
  ["back", "⇧W"],
  ["left", "⇧Q"],
];

export function viewPanel(store: AppStore, press: Press): HTMLElement {
  const lists = h("div", {}); // what this cloud offers
  const scale = slider("Scale", 0, 15, 1, (value) => store.set({ scale: value }));
  const size = slider("Point size", 0.3, 6, 0.05, (value) => store.set({ pointSize: value }));
  const onTop = checkbox("Painted points on top", "O", (on) => store.set({ paintOnTop: on }));
  const eyeDome = checkbox("Eye-dome lighting", "I", (on) => store.set({ eyeDome: on }));
  const palette = buttons(
    "Palette",
    [
      { value: false, label: "standard" },
      { value: true, label: "colour-blind" },
    ],
    (safePalette) => store.set({ safePalette }),
  );
  const theme = buttons<Theme>(
    "Page",
    (["system", "light", "dark"] as Theme[]).map((value) => ({ value, label: value })),
    (chosen) => store.set({ theme: chosen }),
  );
  const flat = checkbox("Orthographic", "⇧F", () => {
    press("Shift+F");
    flat.set(store.now.orthographic);
  });
  const sides = h(
    "div",
    { class: "sides", role: "group", "aria-label": "Look from" },
    ...SIDES.map(([side, key]) => button(side, () => press(key.replace("⇧", "Shift+")), key)),
  );
  let colours: Picker<ColourMode>;
  let features: Picker<number>;
  store.watch(["session", "edges", "hasPrediction"], () => {
    const names = store.now.session?.features ?? [];
    colours = list(
      "Colour by",
      MODES.filter(({ mode }) => modesOf(store).includes(mode)).map(({ mode, name }) => ({ value: mode, label: name })),
      (mode) => store.set({ mode }),
    );
    features = list(
      "Feature",
      names.map((name, i) => ({ value: i, label: FEATURE_NAMES[name] ?? name })),
      (feature) => store.set({ feature }),
    );
    lists.replaceChildren(colours.element, features.element);
  });
  store.watch(["mode", "feature", "scale", "session", "edges", "hasPrediction"], () => {
    const { session, mode, feature } = store.now;
    features.element.hidden = scale.element.hidden = mode !== "feature";
    colours.set(mode);
    features.set(feature);
    scale.element.querySelector("input")!.max = String(Math.max(session?.scales.length ?? 1, 1) - 1);
    scale.set(store.now.scale, length(session?.scales[store.now.scale] ?? 0));
  });
  store.watch(["pointSize", "paintOnTop", "safePalette", "eyeDome", "theme", "orthographic"], () => {
    theme.set(store.now.theme);
    flat.set(store.now.orthographic);
    size.set(store.now.pointSize, `×${store.now.pointSize.toFixed(1)}`);
    onTop.set(store.now.paintOnTop);
    palette.set(store.now.safePalette);
    eyeDome.set(store.now.eyeDome);
  });
  return section(
    "View",
    true,
    lists,
    scale.element,
    size.element,
    onTop.element,
    eyeDome.element,
    flat.element,
    sides,
    palette.element,
    theme.element,
  );
}

/** A box that is in use: all of the cloud at first. */
export function toggledClip({ clip, session }: { clip: Clip | null; session: { bounds: Box } | null }): Clip | null {
  if (clip) return { ...clip, on: !clip.on };
  return session ? { on: true, box: structuredClone(session.bounds) } : null;
}

/** A slice is this part of the cloud's extent. */
const SLICE = 0.04;

export function clipPanel(store: AppStore, stage: Stage, press: Press): HTMLElement {
  const around = (): Box | null => store.now.session && boxAround(stage.camera.target, store.now.session.bounds);
  const slice = (axis: number): void => {
    const { session } = store.now;
    if (!session) return;
    store.set({ clip: { on: true, box: sliceOf(session.bounds, axis, stage.camera.target[axis], SLICE) } });
  };
  const use = checkbox("Show only the points in the box", "C", () => store.set({ clip: toggledClip(store.now) }));
  const change =
    (side: "min" | "max", axis: number) =>
    (at: number): void => {
      const { session, clip } = store.now;
      if (!session) return;
      const { min, max } = session.bounds;
      const box = structuredClone(clip?.box ?? session.bounds);
      box[side][axis] = min[axis] + at * (max[axis] - min[axis]);
      if (side === "min") box.max[axis] = Math.max(box.max[axis], box.min[axis]);
      else box.min[axis] = Math.min(box.min[axis], box.max[axis]);
      store.set({ clip: { on: true, box } });
    };
  const sides = ["x", "y", "z"].flatMap((name, axis) =>
    (["min", "max"] as const).map((side) => ({
      axis,
      side,
      slider: slider(`${name} ${side === "min" ? "from" : "to"}`, 0, 1, 0.001, change(side, axis)),
    })),
  );
  store.watch(["clip", "session"], () => {
    const { clip, session } = store.now;
    use.set(clip?.on ?? false);
    if (!session) return;
    for (const { axis, side, slider: control } of sides) {
      const { min, max } = session.bounds;
      const value = (clip?.box ?? session.bounds)[side][axis];
      control.set(
        (value - min[axis]) / Math.max(max[axis] - min[axis], 1e-12),
        coordinate(value + session.origin[axis], max[axis] - min[axis]),
      );
    }
  });
  return section(
    "Clipping box",
    false,
    use.element,
    h("div", { class: "limits" }, ...sides.map((side) => side.slider.element)),
    h("p", { class: "summary" }, "Or drag the dots on its faces. Slices across an axis:"),
    h(
      "div",
      { class: "buttons" },
      ...["x", "y", "z"].map((name, axis) => button(`Slice ${name}`, () => slice(axis))),
      button("Back", () => press("<"), "<"),
      button("On", () => press(">"), ">"),
    ),
    h(
      "div",
      { class: "buttons" },
      button("Around the view centre", () => {
        const box = around();
        if (box) store.set({ clip: { on: true, box } });
      }),
      button("Reset", () => store.set({ clip: null })),
    ),
  );
}

/** A cube about a place, a sixth of the cloud wide. */
export function boxAround(place: number[], bounds: Box): Box {
  const half = boxDiagonal(bounds) / 12;
  const side = (sign: number): [number, number, number] => [
    place[0] + sign * half,
    place[1] + sign * half,
    place[2] + sign * half,
  ];
  return { min: side(-1), max: side(1) };
}
