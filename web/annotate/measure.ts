// Measuring: the distance between two points that are clicked.

import { svg } from "../shared/dom";
import { length } from "./format";
import type { Overlay } from "./overlay";
import type { AppStore } from "./store";
import type { Vec3 } from "./types";

/** The distance, and how far it goes along each axis. */
export function distanceWords([from, to]: Vec3[]): string {
  const along = to.map((c, i) => c - from[i]);
  const parts = along.map((d, i) => `Δ${"xyz"[i]} ${length(d)}`).join(", ");
  return `${length(Math.hypot(...along))} (${parts})`;
}

export class Measure {
  private readonly line = svg("path", { class: "measure" });
  private readonly words = svg("text", { class: "measure-words" });

  constructor(
    private readonly overlay: Overlay,
    private readonly store: AppStore,
  ) {
    overlay.element.append(this.line, this.words);
    overlay.followers.push(() => this.follow());
    store.watch(["measured", "session"], () => this.follow());
  }

  /** A third place begins anew. */
  add(place: Vec3): void {
    const { measured } = this.store.now;
    this.store.set({ measured: measured.length === 1 ? [...measured, place] : [place] });
  }

  private follow(): void {
    const { measured } = this.store.now;
    const ends = measured.map((place) => this.overlay.toScreen(place));
    const dot = (p: { x: number; y: number }): string => `M${p.x - 4} ${p.y}a4 4 0 1 0 8 0a4 4 0 1 0 -8 0`;
    const seen = ends.filter((end) => end !== null);
    const both = seen.length === 2 ? `M${seen[0].x} ${seen[0].y}L${seen[1].x} ${seen[1].y}` : "";
    this.line.setAttribute("d", seen.map(dot).join("") + both);
    this.words.textContent = measured.length === 2 && seen.length === 2 ? distanceWords(measured) : "";
    if (seen.length === 2) {
      this.words.setAttribute("x", String((seen[0].x + seen[1].x) / 2 + 8));
      this.words.setAttribute("y", String((seen[0].y + seen[1].y) / 2 - 8));
    }
  }
}
