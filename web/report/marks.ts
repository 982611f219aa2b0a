// A method's name beside its colour, and beside its row of a chart.

import { seriesColour } from "../shared/colours";
import { h, svg } from "../shared/dom";

export const swatch = (index: number): HTMLElement =>
  h("span", { class: "swatch", style: `background:${seriesColour(index)}`, "aria-hidden": "true" });

const LETTER = 6.4; // of .row-name, in the units of a chart
const MOST_LETTERS = 46;

const shortened = (name: string): string =>
  name.length > MOST_LETTERS ? `${name.slice(0, MOST_LETTERS - 1).trimEnd()}…` : name;

/** The room that names need to the left of their rows. */
export const roomFor = (names: string[]): number =>
  Math.max(90, 14 + LETTER * Math.max(...names.map((name) => shortened(name).length)));

/** The name of a row, which ends at x. */
export const rowName = (name: string, x: number, y: number): SVGElement =>
  svg("text", { x, y, "text-anchor": "end", class: "row-name" }, svg("title", {}, name), shortened(name));
