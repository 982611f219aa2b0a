// Lasso and polygon: what lies within an outline on the screen.

import type { Client } from "./client";
import { thin } from "./geometry";
import type { Overlay } from "./overlay";
import { paintPolygon } from "./paint";
import type { Stage } from "./stage";
import { activeClip, type AppStore } from "./store";
import { NO_CLASS, type PolygonStroke } from "./types";

const MOST_CORNERS = 2000;

export class Outline {
  private points: [number, number][] = [];
  private pointer: [number, number] | null = null;
  private free = false;

  constructor(
    private readonly stage: Stage,
    private readonly store: AppStore,
    private readonly client: Client,
    private readonly overlay: Overlay,
  ) {}

  get isOpen(): boolean {
    return this.points.length > 0;
  }

  /** A lasso follows the pointer; a polygon takes a corner a click. */
  press(x: number, y: number, free: boolean): void {
    this.free = free;
    if (free) this.points = [];
    this.stage.camera.stop(); // corners are pixels of this view
    this.points.push([x, y]);
    this.show();
  }

  move(x: number, y: number, pressed: boolean): void {
    if (!this.isOpen) return;
    this.pointer = [x, y];
    if (this.free && pressed) this.points = thin([...this.points, [x, y]], 2);
    this.show();
  }

  release(): void {
    if (this.free) this.close();
  }

  /** Takes the last corner back. */
  shorten(): void {
    this.points.pop();
    this.show();
  }

  cancel(): void {
    this.points = [];
    this.pointer = null;
    this.show();
  }

  /** Paints what lies within. */
  close(): void {
    const corners = thin(this.points, 1);
    this.cancel();
    if (corners.length < 3) return;
    const every = Math.ceil(corners.length / MOST_CORNERS);
    const state = this.store.now;
    const stroke: PolygonStroke = {
      id: crypto.randomUUID(),
      tool: "polygon",
      class: state.paintClass,
      polygon: corners.filter((_, i) => i % every === 0).map(([x, y]) => this.stage.toClip(x, y)),
      matrix: Array.from(this.stage.camera.view.matrix),
      front_only: state.frontOnly,
      point_size: this.pointSize(),
      viewport: [this.stage.width, this.stage.height],
      protect: state.protect,
      hidden: [...state.hidden],
      clip: activeClip(state),
    };
    const options = { class: state.paintClass, protect: state.protect, ...this.stage.visibility };
    for (const chunk of paintPolygon(this.stage.chunks, stroke, options)) this.stage.touch(chunk.info.id, "labels");
    if (state.paintClass === NO_CLASS) this.stage.redraw(); // erased points are smaller than painted ones
    this.client.paint(stroke);
  }

  /** So many pixels lie between neighbours of the whole cloud at the middle of the view. */
  private pointSize(): number {
    const { session, pointSize } = this.store.now;
    const middle = this.overlay.toScreen(this.stage.camera.target);
    const pixels = middle ? ((session!.spacing * this.stage.camera.pixels) / middle.depth) * pointSize * 1.5 : 4;
    return Math.min(Math.max(pixels, 3), 48);
  }

  private show(): void {
    const shown = this.pointer && !this.free ? [...this.points, this.pointer] : this.points;
    this.overlay.setOutline(this.isOpen ? shown : [], true);
  }
}
