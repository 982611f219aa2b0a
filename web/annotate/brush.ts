// The brush: a ball about the surface point under the pointer.

import { paintBall } from "./paint";
import type { Picked } from "./chunk";
import { boxDiagonal } from "./geometry";
import type { Client } from "./client";
import type { Stage } from "./stage";
import { activeClip, type AppStore } from "./store";
import { NO_CLASS, type Vec3 } from "./types";

/** The radius of the smallest brush. */
export const LEAST_SPACINGS = 0.5;

export class Brush {
  private centres: Vec3[] | null = null;
  private last: [number, number] = [0, 0];
  private readonly shown = new Set<number>();

  constructor(
    private readonly stage: Stage,
    private readonly store: AppStore,
    private readonly client: Client,
  ) {}

  get isDown(): boolean {
    return this.centres !== null;
  }

  /** Starts a stroke at a pixel. */
  press(x: number, y: number): void {
    this.centres = [];
    this.shown.clear();
    this.dab(x, y);
  }

  /** Goes on to a pixel; dabs overlap. */
  drag(x: number, y: number): void {
    if (!this.centres) return;
    const picked = this.stage.pick(x, y);
    if (!picked) return;
    const step = Math.max(2, (0.4 * this.store.now.radius * this.stage.camera.pixels) / picked.depth);
    const [dx, dy] = [x - this.last[0], y - this.last[1]];
    const away = Math.hypot(dx, dy);
    if (away < step) return;
    const dabs = Math.min(Math.floor(away / step), 40);
    const [x0, y0] = this.last;
    for (let k = 1; k <= dabs; ++k) this.dab(x0 + (dx * k) / dabs, y0 + (dy * k) / dabs);
  }

  /** Ends the stroke: now the server hears of it. */
  release(): void {
    const { centres } = this;
    this.centres = null;
    if (!centres) return;
    if (centres.length === 0) return this.stage.loader.resume();
    const state = this.store.now;
    if (state.paintClass === NO_CLASS) this.stage.redraw(); // erased points are smaller than painted ones
    this.client.paint({
      id: crypto.randomUUID(),
      tool: "brush",
      class: state.paintClass,
      centres,
      radius: state.radius,
      protect: state.protect,
      hidden: [...state.hidden],
      clip: activeClip(state),
    });
  }

  /** Ends the stroke without painting: what was shown of it goes. */
  cancel(): void {
    this.centres = null;
    this.stage.loader.refresh("labels", this.shown);
  }

  private dab(x: number, y: number): void {
    const picked = this.stage.pick(x, y);
    this.last = [x, y];
    if (!picked) return;
    this.centres!.push(picked.position);
    this.show(picked);
  }

  private show({ position, normal }: Picked): void {
    const state = this.store.now;
    const options = { class: state.paintClass, protect: state.protect, ...this.stage.visibility };
    for (const chunk of this.stage.chunks) {
      if (paintBall(chunk, position, normal, state.radius, options)) {
        this.stage.touch(chunk.info.id, "labels");
        this.shown.add(chunk.info.id);
      }
    }
  }

  grow(factor: number): void {
    const { session, radius } = this.store.now;
    if (!session) return;
    const most = boxDiagonal(session.bounds) / 4;
    this.store.set({ radius: Math.min(Math.max(radius * factor, session.spacing * LEAST_SPACINGS), most) });
  }
}
