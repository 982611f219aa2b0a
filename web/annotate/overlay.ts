// What lies over the points without drawing them again: the brush's ring, outlines, the box, marks.

import { svg } from "../shared/dom";
import { boxCorners, project } from "./geometry";
import type { Stage } from "./stage";
import type { Box, Vec3 } from "./types";

const EDGES = [
  [0, 1],
  [2, 3],
  [4, 5],
  [6, 7],
  [0, 2],
  [1, 3],
  [4, 6],
  [5, 7],
  [0, 4],
  [1, 5],
  [2, 6],
  [3, 7],
];

/** The corners of a square, so that it is no brush. */
const MARK = "M-18 -10v-8h8M10 -18h8v8M18 10v8h-8M-10 18h-8v-8";

export class Overlay {
  private readonly ring = svg("circle", { class: "ring" });
  private readonly core = svg("circle", { class: "core", r: 1.5 });
  private readonly outline = svg("path", { class: "outline" });
  private readonly box = svg("path", { class: "box" });
  private readonly cross = svg("path", { class: "cross" });
  private readonly mark = svg("path", { class: "mark", d: MARK });
  private readonly pivot = svg("path", { class: "pivot", d: "M-7 0h14M0 -7v14M-4 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0" });
  /** What else lies over the points and moves with the view. */
  readonly followers: (() => void)[] = [];
  readonly element = svg(
    "svg",
    { class: "overlay", "aria-hidden": "true" },
    this.box,
    this.outline,
    this.mark,
    this.pivot,
    this.cross,
    this.ring,
    this.core,
  );
  private clip: Box | null = null;
  private place: Vec3 | null = null;
  private turnsAbout: Vec3 | null = null;

  constructor(private readonly stage: Stage) {
    for (const part of [this.ring, this.core, this.mark, this.pivot, this.cross])
      part.setAttribute("visibility", "hidden");
  }

  private show(part: SVGElement, on: boolean): void {
    part.setAttribute("visibility", on ? "visible" : "hidden");
  }

  /** CSS pixels of a place, and its depth; null behind the camera. */
  toScreen(place: Vec3): { x: number; y: number; depth: number } | null {
    const [x, y, , w] = project(this.stage.camera.view.matrix, place);
    if (w <= 0) return null;
    return { x: (x / w + 1) * 0.5 * this.stage.width, y: (1 - y / w) * 0.5 * this.stage.height, depth: w };
  }

  /** The ball of the brush about a surface point, in the colour it paints. */
  setRing(place: Vec3 | null, radius: number, colour: string): void {
    const at = place && this.toScreen(place);
    this.show(this.ring, !!at);
    this.show(this.core, !!at);
    if (!at) return;
    for (const part of [this.ring, this.core]) {
      part.setAttribute("cx", String(at.x));
      part.setAttribute("cy", String(at.y));
    }
    this.ring.setAttribute("r", String(Math.max((radius * this.stage.camera.pixels) / at.depth, 2)));
    this.ring.style.stroke = colour;
  }

  /** In CSS pixels. */
  setOutline(points: [number, number][], closed: boolean): void {
    this.outline.setAttribute(
      "d",
      points.length === 0 ? "" : `M${points.map((p) => p.join(" ")).join("L")}${closed ? "Z" : ""}`,
    );
  }

  setCross(on: boolean): void {
    this.show(this.cross, on);
    this.follow();
  }

  setMark(place: Vec3 | null): void {
    this.place = place;
    this.follow();
  }

  /** What the view turns about, while it does. */
  setPivot(place: Vec3 | null): void {
    this.turnsAbout = place;
    this.follow();
  }

  setClip(clip: Box | null): void {
    this.clip = clip;
    this.follow();
  }

  /** After the view has moved. */
  follow(): void {
    for (const [part, where] of [
      [this.mark, this.place],
      [this.pivot, this.turnsAbout],
    ] as const) {
      const at = where && this.toScreen(where);
      this.show(part, !!at);
      if (at) part.setAttribute("transform", `translate(${at.x} ${at.y})`);
    }
    this.followers.forEach((follow) => follow());
    const [x, y] = [this.stage.width / 2, this.stage.height / 2];
    this.cross.setAttribute("d", `M${x - 12} ${y}h8m8 0h8M${x} ${y - 12}v8m0 8v8`);
    this.box.setAttribute("d", this.clip ? this.boxPath(this.clip) : "");
  }

  private boxPath({ min, max }: Box): string {
    const places = boxCorners({ min, max });
    const corners = Array.from({ length: 8 }, (_, k) => this.toScreen(places.slice(3 * k, 3 * k + 3) as Vec3));
    return EDGES.map(([a, b]) => {
      const [from, to] = [corners[a], corners[b]];
      return from && to ? `M${from.x.toFixed(1)} ${from.y.toFixed(1)}L${to.x.toFixed(1)} ${to.y.toFixed(1)}` : "";
    }).join("");
  }
}
