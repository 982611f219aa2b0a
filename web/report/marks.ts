// The small marks that tie a method's name to its colour.

import { seriesColour } from "../shared/colours";
import { h } from "../shared/dom";

export const swatch = (index: number): HTMLElement =>
  h("span", { class: "swatch", style: `background:${seriesColour(index)}`, "aria-hidden": "true" });
