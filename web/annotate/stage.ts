// The view: chooses what to draw, draws it over several frames, picks in it.

import type { Stroke } from "../shared/line_layer";
import type { Api } from "./api";
import { Budget } from "./budget";
import { Camera, type Pose, type Side } from "./camera";
import { pick, placesOf, withoutFar, type Chunk, type Picked, type Visibility } from "./chunk";
import { drawnSpacings, selectNodes, withSpacings, type Take } from "./detail";
import { boxCorners as corners } from "./geometry";
import { Loader } from "./loader";
import { Painter, type Appearance, type Layer } from "./painter";
import type { Box, Session } from "./types";

const SETTLE_MS = 120;
const REST_MS = 200;

export interface StageEvents {
  /** Points of the cloud are there, or do not come. */
  arrived(): void;
  /** The view has changed: what lies over it must follow. */
  moved(): void;
  failed(error: Error): void;
  isPainting(): boolean;
  /** The graphics card was taken away, or is there again. */
  contextLost(isLost: boolean): void;
}

export class Stage {
  readonly camera: Camera;
  readonly loader: Loader;
  readonly budget = new Budget();
  private readonly painter: Painter;
  private look!: Appearance;
  private bounds: Box | null = null;
  private takes: Take[] = [];
  private next = 0;
  private awaitsFirst = false;
  private stale = true;
  private readonly touched = new Set<number>();
  private frame = 0;
  private settle = 0;
  private lastMove = 0;
  private atRest = false;
  width = 1;
  height = 1;

  constructor(
    readonly canvas: HTMLCanvasElement,
    api: Api,
    on: StageEvents,
  ) {
    this.painter = new Painter(canvas);
    this.camera = new Camera(() => {
      this.lastMove = performance.now();
      this.redraw();
      on.moved();
    });
    this.loader = new Loader(api, {
      arrived: ({ info }) => {
        if (info.id === 0 && this.awaitsFirst) {
          this.awaitsFirst = false;
          this.fit("first"); // on the cloud itself, not on its box
        }
        on.arrived();
        this.touched.add(info.id);
        this.redrawSoon();
        this.schedule();
      },
      dropped: (id) => this.painter.forget(id),
      changed: (ids, layer) => {
        ids.forEach((id) => this.painter.refresh(id, layer));
        if (layer === "labels" || this.look.hidden.size > 0) this.redraw();
        else this.recolour();
      },
      failed: (error) => {
        on.arrived();
        on.failed(error);
      },
      isPainting: () => on.isPainting(),
    });
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement!);
    canvas.addEventListener("webglcontextlost", () => on.contextLost(true));
    canvas.addEventListener("webglcontextrestored", () => {
      on.contextLost(false);
      if (this.look) this.painter.setAppearance(this.look);
      this.redraw();
    });
  }

  /** Seen from the first direction, unless it was looked at before. */
  open({ nodes, spacing, bounds, has_colours: hasColours }: Session, hasPrediction: boolean, pose?: Pose): void {
    this.loader.setNodes(withSpacings(nodes, spacing), hasColours, hasPrediction);
    this.bounds = bounds;
    this.camera.setBounds(bounds);
    this.resize();
    this.awaitsFirst = !pose;
    if (pose) this.camera.pose = pose;
    else this.camera.fit("first", corners(bounds));
    this.redraw();
  }

  /** All of the cloud but points far from it, as its coarsest points show it. */
  fit(from: Side | "first" | "here"): void {
    const first = this.loader.chunks.get(0);
    if (first) this.camera.fit(from, withoutFar(placesOf(first)));
    else if (this.bounds) this.camera.fit(from, corners(this.bounds));
  }

  /** Until another cloud is opened. */
  close(): void {
    this.bounds = null;
    this.takes = [];
    this.touched.clear();
    this.loader.reset();
  }

  setAppearance(look: Appearance): void {
    const old = this.look;
    this.look = look;
    this.painter.setAppearance(look);
    const same = (["paintOnTop", "hidden", "clip", "pointSize", "background", "eyeDome"] as const).every(
      (key) => old?.[key] === look[key],
    );
    if (same && old.mode !== "labels" && look.mode !== "labels") this.recolour();
    else this.redraw();
  }

  setLines(lines: Stroke[], spacing: number): void {
    this.painter.lines.setLines(lines, spacing);
    this.redraw();
  }

  /** Is every pixel the processor's work here? */
  get isSoftware(): boolean {
    return this.painter.isSoftware;
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement!;
    if (width === 0 || height === 0) return;
    [this.width, this.height] = [width, height];
    this.painter.resize(width, height);
    this.camera.resize(width, height);
  }

  /** Draws all anew from the next frame on. */
  redraw(): void {
    this.stale = true;
    this.schedule();
  }

  /** Draws the same points over themselves: their places and sizes are as they were. */
  private recolour(): void {
    this.next = 0;
    this.schedule();
  }

  /** Labels of a chunk were painted here: draws it again over itself. */
  touch(id: number, layer: Layer): void {
    this.painter.refresh(id, layer);
    this.touched.add(id);
    this.schedule();
  }

  private redrawSoon(): void {
    window.clearTimeout(this.settle);
    this.settle = window.setTimeout(() => {
      this.settle = 0;
      this.redraw();
    }, SETTLE_MS);
  }

  private schedule(): void {
    if (this.frame === 0) this.frame = requestAnimationFrame(() => this.drawFrame());
  }

  /** Is everything drawn that is to be drawn? */
  get isSettled(): boolean {
    return this.frame === 0 && this.settle === 0 && !this.loader.isLoading && this.bounds !== null;
  }

  private drawFrame(): void {
    this.frame = 0;
    if (!this.look || !this.bounds) return;
    const isFirst = this.stale;
    if (isFirst) this.begin();
    const todo = this.nextTakes();
    const milliseconds = this.painter.draw(todo, this.camera.three, this.camera.pixels, this.camera.stretch);
    if (milliseconds !== null)
      this.budget.learn(
        todo.reduce((sum, take) => sum + take.points, 0),
        milliseconds,
      );
    const isLast = this.next >= this.takes.length && this.touched.size === 0;
    if (isFirst || isLast) this.painter.drawLines(this.camera.three, this.camera.pixels);
    if (!isLast) this.schedule();
  }

  private begin(): void {
    this.atRest = performance.now() - this.lastMove > REST_MS;
    this.stale = false;
    this.next = 0;
    this.touched.clear();
    const all = selectNodes(this.loader.nodes, this.camera.view, { budget: this.budget.still, clip: this.look.clip });
    this.loader.mostPoints = 2 * this.budget.still;
    this.loader.want(all.map((take) => take.id));
    this.takes = all.filter((take) => this.loader.chunks.has(take.id));
    this.painter.setSpacings(drawnSpacings(this.loader.nodes, this.takes));
    this.painter.clear();
  }

  /** As much as one frame has time for. */
  private nextTakes(): { chunk: Chunk; points: number }[] {
    const most = this.atRest ? this.budget.resting : this.budget.moving;
    const todo: { chunk: Chunk; points: number }[] = [];
    let points = 0;
    while (this.next < this.takes.length && points < most) {
      const { id, points: all } = this.takes[this.next++];
      const chunk = this.loader.chunks.get(id);
      if (!chunk) continue;
      // A prefix of a coarse node is better than no picture; the rest follows with the next frame.
      const some = points === 0 && this.next === 1 ? Math.min(all, most) : all;
      if (some < all) this.touched.add(id);
      todo.push({ chunk, points: some });
      points += some;
    }
    for (const id of this.touched) {
      if (points >= most) break;
      const chunk = this.loader.chunks.get(id);
      this.touched.delete(id);
      if (!chunk || todo.some((take) => take.chunk === chunk)) continue;
      const points0 = this.takes.find((take) => take.id === id)?.points ?? chunk.info.points;
      todo.push({ chunk, points: points0 });
      points += points0;
    }
    return todo;
  }

  /** The chunks that the view shows. */
  get drawn(): { chunk: Chunk; points: number }[] {
    return this.takes.flatMap(({ id, points }) => {
      const chunk = this.loader.chunks.get(id);
      return chunk ? [{ chunk, points }] : [];
    });
  }

  get chunks(): Chunk[] {
    return [...this.loader.chunks.values()];
  }

  get visibility(): Visibility {
    return { hidden: this.look.hidden, clip: this.look.clip };
  }

  /** Pixels of the canvas to clip space. */
  toClip(x: number, y: number): [number, number] {
    return [(2 * x) / this.width - 1, 1 - (2 * y) / this.height];
  }

  /** The surface point at a pixel of the canvas. */
  pick(x: number, y: number, reach = 8): Picked | null {
    const [cx, cy] = this.toClip(x, y);
    return pick(this.drawn, {
      ...this.visibility,
      matrix: this.camera.view.matrix,
      x: cx,
      y: cy,
      reach,
      halfWidth: this.width / 2,
      halfHeight: this.height / 2,
      pixels: this.camera.pixels,
    });
  }

  picture(): Promise<Blob | null> {
    return this.painter.picture();
  }
}
