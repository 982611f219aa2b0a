// The classes that the file gives its points: what they are called, their colours, and strokes that paint them.

import { CLASS_PALETTES, ERROR_PALETTE, NO_LABEL, rgbOf } from "../shared/colours";
import { classNames, hexOf, paintable, paletteOf, SHARP_EDGE } from "./classes";
import { activeClip, type State } from "./store";
import type { FileClass, FileStroke } from "./types";

type Known = Pick<State, "session" | "classes" | "edges" | "safePalette">;

export interface ShownClass {
  id: number;
  name: string;
  colour: string;
  /** Left out where it depends on the prediction. */
  points?: number;
}

/** Whether it is a class of the project, too. */
const isProjects = (one: FileClass, state: Pick<State, "classes" | "edges">): boolean =>
  classNames(state)[one.id] === one.name;

/** The file's labels, with the project's names and colours where it has these classes. */
export function fileLabels(state: Known): ShownClass[] {
  const palette = paletteOf(state);
  return (state.session?.file_labels ?? []).map((one) => ({
    ...one,
    ...(isProjects(one, state) ? palette[one.id] : { colour: hexOf(one.colour) }),
  }));
}

export const lasClasses = ({ session }: Pick<State, "session">): ShownClass[] =>
  (session?.las_classes ?? []).map((one) => ({ ...one, colour: hexOf(one.colour) }));

/** The labels of the file that are a truth. */
const givenLabels = ({ session }: Pick<State, "session">): FileClass[] =>
  session && !session.file_predicted ? session.file_labels : [];

/** Whether sharp edges that are predicted can be compared with those of the file. */
export const hasErrors = (state: Pick<State, "session" | "classes" | "edges">): boolean =>
  state.edges && givenLabels(state).some((one) => one.id === SHARP_EDGE && isProjects(one, state));

/** What can be said of a prediction of sharp edges, as the report colours it. */
export const errorClasses: ShownClass[] = ERROR_PALETTE.slice(0, 4).map((meaning, id) => ({ id, ...meaning }));

/** For each byte of a value its colour, as a ramp has it. */
export function classBytes(shown: ShownClass[]): Uint8Array {
  const bytes = new Uint8Array(1024);
  const set = (id: number, colour: string): void =>
    rgbOf(colour).forEach((part, c) => (bytes[4 * id + c] = Math.round(255 * part)));
  for (let id = 0; id < 256; ++id) set(id, CLASS_PALETTES.paper[NO_LABEL].colour);
  for (const { id, colour } of shown) set(id, colour);
  return bytes;
}

/** A stroke for each class of the file that the project can paint; of points that are painted none changes. */
export function fileStrokes(state: Known & Pick<State, "clip" | "counts">): FileStroke[] {
  const ids = new Set(paintable(state).map(({ id }) => id));
  return givenLabels(state)
    .filter((one) => ids.has(one.id) && isProjects(one, state))
    .map(({ id }) => ({
      id: crypto.randomUUID(),
      tool: "file",
      class: id,
      protect: true,
      hidden: [],
      clip: activeClip(state),
    }));
}
