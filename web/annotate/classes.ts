// The classes that can be painted: those of edges, own ones, or both.

import { BOUNDARY, CLASS_PALETTES, NO_LABEL, type Meaning } from "../shared/colours";
import type { State } from "./store";
import { NO_CLASS, type ClassInfo, type Vec3 } from "./types";

export const MOST_CLASSES = 8;

export const SHARP_EDGE = 2;

/** What stands for no class in a palette. */
export const NONE = MOST_CLASSES;

/** How many classes those of edges are. */
export const EDGE_CLASSES = BOUNDARY + 1;

/** Colours for own classes, as the program gives them. */
const USUAL = ["#59a14f", "#b07aa1", "#f28e2b", "#4e79a7", "#edc948", "#76b7b2", "#e15759", "#9c755f"];

/** The same for the colour-blind (Okabe and Ito). */
const SAFE = ["#e69f00", "#56b4e9", "#009e73", "#f0e442", "#0072b2", "#d55e00", "#cc79a7", "#5b5b5b"];

export const hexOf = (colour: Vec3): string => `#${colour.map((part) => part.toString(16).padStart(2, "0")).join("")}`;

/** A colour that no class has yet. */
export const freshColour = (taken: string[]): string => USUAL.find((colour) => !taken.includes(colour)) ?? USUAL[0];

type Known = Pick<State, "classes" | "edges" | "safePalette">;

/** By class, and NONE. */
export function paletteOf({ classes, edges, safePalette }: Known): Meaning[] {
  const known = CLASS_PALETTES[safePalette ? "safe" : "paper"];
  const palette = SAFE.map((safe, id): Meaning => {
    if (edges && id < EDGE_CLASSES) return known[id];
    const own = classes.find((one) => one.id === id);
    if (!own) return { name: `class ${id}`, colour: known[NO_LABEL].colour };
    return { name: own.name, colour: safePalette ? safe : hexOf(own.colour) };
  });
  return [...palette, known[NO_LABEL]];
}

/** By class as the program names them; boundary, too, where there are edge classes. */
export function classNames({ classes, edges }: Pick<State, "classes" | "edges">): string[] {
  const names = edges ? CLASS_EDGES.map(({ name }) => name) : [];
  for (const { id, name } of classes) names[id] = name;
  return names;
}

/** Own classes that are there. */
export const ownClasses = ({ classes, edges }: Pick<State, "classes" | "edges">): ClassInfo[] =>
  classes.filter(({ id, removed }) => !removed && (!edges || id >= EDGE_CLASSES));

/** The classes that can be painted, in the order of their keys 1, 2, ... */
export const paintable = ({ classes, edges, counts }: Pick<State, "classes" | "edges" | "counts">): ClassInfo[] =>
  classes.filter(({ id, removed }) => (!removed || counts[id] > 0) && !(edges && id === BOUNDARY));

/** Smooth edges cannot be told from the rest by a model of two classes. */
export const isOff = (id: number, { edges, settings }: Pick<State, "edges" | "settings">): boolean =>
  edges && id === 1 && settings.classes === 2;

/** The chosen class, or another one if that cannot be painted. */
export function usableClass(state: Pick<State, "classes" | "edges" | "counts" | "settings" | "paintClass">): number {
  const { paintClass, edges } = state;
  const ids = paintable(state)
    .map(({ id }) => id)
    .filter((id) => !isOff(id, state));
  if (paintClass === NO_CLASS || ids.includes(paintClass)) return paintClass;
  return edges ? SHARP_EDGE : (ids[0] ?? NO_CLASS);
}

/** A class as the program takes it. */
export interface WantedClass {
  name: string;
  colour: string;
  removed?: boolean;
}

/** A row of the editor: a class that there is, or a new one. */
export interface Draft {
  id: number | null;
  name: string;
  colour: string;
}

/** A name that two rows, or a row and an edge class, have but for case, hyphens and spaces; null if there is none. */
export function repeatedName(rows: Pick<Draft, "name">[], withEdges: boolean): string | null {
  const names = [...(withEdges ? CLASS_EDGES : []), ...rows].map(({ name }) => name.trim());
  const alike = names.map((name) => name.toLowerCase().replace(/[-_\s]/g, " "));
  return names.find((name, k) => name !== "" && alike.indexOf(alike[k]) < k) ?? null;
}

/** The table that rows stand for. Classes keep their numbers once there was a stroke: what is missing is removed. */
export function wantedTable(
  { classes, edges }: Pick<State, "classes" | "edges">,
  rows: Draft[],
  withEdges: boolean,
  isPainted: boolean,
): WantedClass[] {
  const edgeTable = CLASS_EDGES.slice(0, withEdges ? EDGE_CLASSES : 0);
  const plain = ({ name, colour }: Draft): WantedClass => ({ name: name.trim(), colour });
  if (!isPainted) return [...edgeTable, ...rows.map(plain)];
  const table = [...edgeTable];
  for (const { id, name, colour } of classes) {
    if (edges && id < EDGE_CLASSES) continue;
    const row = rows.find((one) => one.id === id);
    table[id] = row ? plain(row) : { name, colour: hexOf(colour), removed: true };
  }
  for (const row of rows.filter((one) => one.id === null)) {
    const slot = table.findIndex((one) => one.removed && one.name === row.name.trim());
    const free = table.length < MOST_CLASSES ? table.length : table.findIndex((one) => one.removed);
    table[slot >= 0 ? slot : free >= 0 ? free : table.length] = plain(row);
  }
  return table;
}

/** Those of edges as the program names them. */
const CLASS_EDGES: WantedClass[] = [
  { name: "non-edge", colour: "#ffffff" },
  { name: "smooth-edge", colour: "#ffc45d" },
  { name: "sharp-edge", colour: "#a80000" },
  { name: "boundary", colour: "#0052a5" },
];
