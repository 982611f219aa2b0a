// From what the page is set to show to what the points look like.

import { PLAIN, type Stroke } from "../shared/line_layer";
import { NONE, paletteOf } from "./classes";
import { classBytes, errorClasses, fileLabels, lasClasses, type ShownClass } from "./file_classes";
import { kindOf } from "./loader";
import type { Appearance } from "./painter";
import { rampBytes, STOPS, type RampName } from "./ramp";
import { activeClip, type ColourMode, type State } from "./store";
import { NO_CLASS, type Line } from "./types";

/** The colour a tool paints with; the eraser's is that of no label. */
export const paintColour = (state: Pick<State, "classes" | "edges" | "safePalette" | "paintClass">): string =>
  paletteOf(state)[state.paintClass === NO_CLASS ? NONE : state.paintClass].colour;

/** What a feature of the method is called. */
export const FEATURE_NAMES: Record<string, string> = {
  tau: "τ, local relief",
  kappa: "κ, mean curvature",
  phi: "φ, fitness of the sphere",
  dtau: "∂τ, change of relief with scale",
  dkappa: "∂κ, change of curvature with scale",
  dphi: "∂φ, change of fitness with scale",
};

/** The classes of the file that a mode shows; none in another mode. */
export function fileClassesOf(state: State): ShownClass[] {
  if (state.mode === "file") return fileLabels(state);
  if (state.mode === "errors") return errorClasses;
  return state.mode === "las" ? lasClasses(state) : [];
}

export const isRamp = (mode: ColourMode): boolean => ["confidence", "p_sharp", "feature"].includes(mode);

export function rampOf({ mode, safePalette }: State): RampName {
  if (mode === "feature") return "signed";
  if (mode === "confidence") return "sure";
  return safePalette ? "likely-safe" : "likely";
}

/** The server's values that a mode needs, as a query. */
export function valuesQuery({ mode, feature, scale }: State): string | null {
  if (mode === "feature") return `of=feature&feature=${feature}&scale=${scale}`;
  if (mode === "file") return "of=file_labels";
  if (mode === "las") return "of=las_classes";
  if (mode === "errors") return "of=errors";
  return isRamp(mode) ? `of=${mode}` : null;
}

export function appearanceOf(state: State, background: string): Appearance {
  const { mode } = state;
  const ofFile = fileClassesOf(state);
  return {
    mode: mode === "rgb" || mode === "normals" || mode === "labels" || mode === "prediction" ? mode : "ramp",
    values: kindOf(valuesQuery(state)),
    paintOnTop: state.paintOnTop,
    palette: paletteOf(state).map((meaning) => meaning.colour),
    ramp: ofFile.length > 0 ? classBytes(ofFile) : rampBytes(rampOf(state)),
    hidden: state.hidden,
    clip: activeClip(state),
    pointSize: state.pointSize,
    background,
    eyeDome: state.eyeDome,
  };
}

const LINE_LOOKS: Record<Line["decision"] | "chosen", Pick<Stroke, "rim" | "widths">> = {
  open: PLAIN,
  accepted: { rim: "#2db478", widths: [1.5, 1.5] },
  rejected: { rim: PLAIN.rim, widths: [0.75, 0] },
  chosen: { rim: "#18a8ff", widths: [2, 3] },
};
const REJECTED = "#8f96a0";

/** How the lines are drawn that are shown now; `line` is the number of the one that is looked at. */
export function strokesOf(state: State): Stroke[] {
  if (!state.showLines) return [];
  const palette = paletteOf(state).map((meaning) => meaning.colour);
  return state.lines.lines.map(({ path, decision, class: its }, number) => ({
    path,
    fill: decision === "rejected" ? REJECTED : palette[its],
    ...LINE_LOOKS[number === state.line ? "chosen" : decision],
  }));
}

/** What the ends of the present ramp mean. */
export function rampEnds({ mode }: State): [string, string] {
  if (mode === "confidence") return ["unsure", "sure"];
  if (mode === "p_sharp") return ["0", "1"];
  return ["low", "high"];
}

export const rampStops = (state: State): string[] => STOPS[rampOf(state)];
