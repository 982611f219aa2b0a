// The brush: a ball about the surface point under the pointer.

import { usableRadius } from "./brush_size";
import { paintBall } from "./paint";
import type { Picked } from "./chunk";
import type { Client } from "./client";
import type { Stage } from "./stage";
import { activeClip, type AppStore } from "./store";
import { NO_CLASS, type BrushStroke } from "./types";

export class Brush {
  /** As it was when the stroke began: what is set meanwhile is for the next one. */
  private stroke: BrushStroke | null = null;
  private last: [number, number] = [0, 0];
  private readonly shown = new Set<number>();

  constructor(
    private readonly stage: Stage,
    private readonly store: AppStore,
    private readonly client: Client,
  ) {}

  get isDown(): boolean {
    return this.stroke !== null;
  }

  /** Starts a stroke at a pixel. */
  press(x: number, y: number): void {
    const state = this.store.now;
    this.stroke = {
      id: crypto.randomUUID(),
      tool: "brush",
      class: state.paintClass,
      centres: [],
      radius: state.radius,
      protect: state.protect,
      hidden: [...state.hidden],
      clip: activeClip(state),
    };
    this.shown.clear();
    this.dab(x, y);
  }

  /** Goes on to a pixel; dabs overlap. */
  drag(x: number, y: number): void {
    if (!this.stroke) return;
    const picked = this.stage.pick(x, y);
    if (!picked) return;
    const step = Math.max(2, (0.4 * this.stroke.radius * this.stage.camera.pixels) / picked.depth);
    const [dx, dy] = [x - this.last[0], y - this.last[1]];
    const away = Math.hypot(dx, dy);
    if (away < step) return;
    const dabs = Math.min(Math.floor(away / step), 40);
    const [x0, y0] = this.last;
    for (let k = 1; k <= dabs; ++k) this.dab(x0 + (dx * k) / dabs, y0 + (dy * k) / dabs);
  }

  /** Ends the stroke: now the server hears of it. */
  release(): void {
    const { stroke } = this;
    this.stroke = null;
    if (!stroke) return;
    if (stroke.centres.length === 0) return this.stage.loader.resume();
    if (stroke.class === NO_CLASS) this.stage.redraw(); // erased points are smaller than painted ones
    this.client.paint(stroke);
  }

  /** Ends the stroke without painting: what was shown of it goes. */
  cancel(): void {
    this.stroke = null;
    this.stage.loader.refresh("labels", this.shown);
  }

  private dab(x: number, y: number): void {
    const picked = this.stage.pick(x, y);
    this.last = [x, y];
    if (!picked || !this.stroke) return;
    this.stroke.centres.push(picked.position);
    this.show(picked, this.stroke);
  }

  private show({ position, normal }: Picked, stroke: BrushStroke): void {
    const options = { ...stroke, hidden: new Set(stroke.hidden) };
    for (const chunk of this.stage.chunks) {
      if (paintBall(chunk, position, normal, stroke.radius, options)) {
        this.stage.touch(chunk.info.id, "labels");
        this.shown.add(chunk.info.id);
      }
    }
  }

  grow(factor: number): void {
    const { session, radius } = this.store.now;
    if (session) this.store.set({ radius: usableRadius(radius * factor, session) });
  }
}
