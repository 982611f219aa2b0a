// Mouse, pen, touch: which of them paint and which move the view.

import type { Brush } from "./brush";
import { Fingers } from "./fingers";
import type { Outline } from "./outline";
import type { Overlay } from "./overlay";
import type { Stage } from "./stage";
import { refusalOf } from "./refusal";
import type { AppStore } from "./store";
import type { Vec3 } from "./types";

type Drag = "turn" | "slide" | "paint" | "pinch" | null;

const WHEEL_PAUSE_MS = 250;

export interface PointerEvents {
  /** Painting was tried where another window paints. */
  refused(): void;
  /** A point was clicked to measure from or to. */
  measured(place: Vec3): void;
  colour(): string;
}

export class Pointer {
  private drag: Drag = null;
  /** The one that drags; of two fingers the second. */
  private pointer = -1;
  private readonly fingers = new Fingers();
  private last: [number, number] = [0, 0];
  private pivot: Vec3 = [0, 0, 0];
  private wheelAt = -Infinity;
  private waiting = false;
  private inside = false;
  private byKeys = false;
  /** The space bar is held: the left button turns. */
  spaceHeld = false;

  constructor(
    private readonly stage: Stage,
    private readonly store: AppStore,
    private readonly brush: Brush,
    private readonly outline: Outline,
    private readonly overlay: Overlay,
    private readonly on: PointerEvents,
  ) {
    const { canvas } = stage;
    canvas.addEventListener("pointerdown", (e) => this.press(e));
    canvas.addEventListener("pointermove", (e) => this.move(e));
    canvas.addEventListener("pointerup", (e) => this.release(e));
    canvas.addEventListener("pointercancel", (e) => this.release(e));
    canvas.addEventListener("pointerleave", () => {
      this.inside = false;
      this.hover();
    });
    canvas.addEventListener("dblclick", () => this.outline.close());
    canvas.addEventListener("contextmenu", (e) => e.preventDefault());
    canvas.addEventListener("wheel", (e) => this.wheel(e), { passive: false });
    canvas.addEventListener("focus", () => this.setByKeys(canvas.matches(":focus-visible")));
    canvas.addEventListener("blur", () => this.setByKeys(false));
    store.watch(["tool", "radius", "paintClass", "safePalette"], () => this.hoverSoon());
  }

  /** Keys move the view and paint at its middle until the mouse is used again. */
  setByKeys(on: boolean): void {
    this.byKeys = on;
    this.stage.canvas.dataset.keys = on ? "yes" : "no";
    this.overlay.setCross(on);
    this.hoverSoon();
  }

  private at(event: MouseEvent): [number, number] {
    return [event.offsetX, event.offsetY];
  }

  /** What a drag turns about: the surface under the pointer, else the middle of what is looked at. */
  private pivotAt(x: number, y: number): Vec3 {
    return this.stage.pick(x, y, 24)?.position ?? this.stage.camera.target;
  }

  private press(event: PointerEvent): void {
    const { session, progress } = this.store.now;
    if (!session || progress) return; // where another cloud is opened, strokes would be in the last one
    const [x, y] = this.at(event);
    if (event.pointerType === "touch") {
      this.fingers.down(event.pointerId, [x, y]);
      if (this.fingers.count > 1) return this.pressSecond(event);
    }
    if (this.drag) return;
    this.setByKeys(false);
    this.last = [x, y];
    this.drag = this.dragOf(event);
    if (this.drag === "paint" && this.store.now.tool !== "measure" && refusalOf(this.store.now)) {
      this.drag = null;
      this.on.refused();
    }
    if (!this.drag) return;
    this.pointer = event.pointerId;
    this.stage.canvas.setPointerCapture(event.pointerId);
    if (this.drag !== "paint") this.pivot = this.pivotAt(x, y);
    if (this.drag === "turn") this.overlay.setPivot(this.pivot);
    if (this.drag !== "paint") return this.hoverSoon();
    if (this.store.now.tool === "measure") this.measureAt(x, y);
    else if (this.store.now.tool === "brush") this.brush.press(x, y);
    else this.outline.press(x, y, this.store.now.tool === "lasso");
    this.hoverSoon();
  }

  /** Ends what is being painted: a stroke of the brush as far as it came, an outline for nothing. */
  finish(): void {
    if (this.brush.isDown) this.brush.release();
    this.outline.cancel();
    this.drag = null;
    this.overlay.setPivot(null);
  }

  /** Takes back the stroke that is being drawn; false if there is none. */
  cancel(): boolean {
    if (!this.brush.isDown) return false;
    this.brush.cancel();
    this.drag = null;
    this.hoverSoon();
    return true;
  }

  /** A second finger moves the view: what the first one had begun to paint is not meant. */
  private pressSecond(event: PointerEvent): void {
    if (this.fingers.count > 2 || (this.drag && !this.fingers.has(this.pointer))) return;
    if (this.drag === "paint") this.abandon();
    this.drag = null;
    if (this.outline.isOpen) return; // its corners are pixels of this view
    this.drag = "pinch";
    this.pointer = event.pointerId;
    this.stage.canvas.setPointerCapture(event.pointerId);
    this.pivot = this.pivotAt(...this.fingers.middle);
    this.hoverSoon();
  }

  private abandon(): void {
    if (this.store.now.tool === "measure") return;
    if (this.brush.isDown) this.brush.cancel();
    else if (this.store.now.tool === "lasso") this.outline.cancel();
    else this.outline.shorten();
  }

  private dragOf({ button, shiftKey }: PointerEvent): Drag {
    const moves: Drag = this.outline.isOpen ? null : shiftKey || button === 1 ? "slide" : "turn";
    if (button !== 0 || this.spaceHeld || this.store.now.tool === "navigate") return moves;
    return "paint";
  }

  private move(event: PointerEvent): void {
    if (this.fingers.has(event.pointerId)) {
      const { by, factor } = this.fingers.move(event.pointerId, this.at(event));
      if (this.drag === "pinch") {
        this.stage.camera.slide(...by, this.pivot);
        this.stage.camera.approach(1 / factor, this.pivot);
        return;
      }
    }
    if (this.drag && event.pointerId !== this.pointer) return;
    this.inside = true;
    const [x, y] = this.at(event);
    const [dx, dy] = [x - this.last[0], y - this.last[1]];
    if (this.drag === "paint" && this.brush.isDown) {
      const events = event.getCoalescedEvents?.() ?? [];
      for (const each of events.length > 0 ? events : [event]) this.brush.drag(...this.at(each));
    } else if (this.drag === "turn") {
      const angle = Math.PI / Math.max(this.stage.height, 200);
      this.stage.camera.turn(dx * angle, dy * angle, this.pivot);
    } else if (this.drag === "slide") {
      this.stage.camera.slide(dx, dy, this.pivot);
    }
    this.outline.move(x, y, this.drag === "paint");
    this.last = [x, y];
    this.hoverSoon();
  }

  private release(event: PointerEvent): void {
    const pinched = this.drag === "pinch" && this.fingers.has(event.pointerId);
    this.fingers.up(event.pointerId);
    if (this.drag && event.pointerId !== this.pointer && !pinched) return;
    if (this.drag === "paint") {
      if (event.type === "pointercancel") this.abandon();
      else if (this.brush.isDown) this.brush.release();
      else if (this.store.now.tool !== "measure") this.outline.release();
    }
    this.drag = null;
    this.overlay.setPivot(null);
    this.hoverSoon();
  }

  private measureAt(x: number, y: number): void {
    const picked = this.stage.pick(x, y);
    if (picked) this.on.measured(picked.position);
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    if (!this.store.now.session) return;
    const pixels = event.deltaMode === 1 ? event.deltaY * 30 : event.deltaY;
    if (event.altKey) return this.brush.grow(Math.exp(-pixels * 0.002));
    if (this.outline.isOpen) return;
    if (event.timeStamp - this.wheelAt > WHEEL_PAUSE_MS) this.pivot = this.pivotAt(...this.at(event));
    this.wheelAt = event.timeStamp;
    this.stage.camera.approach(Math.exp(Math.min(Math.max(pixels, -300), 300) * 0.0015), this.pivot);
  }

  /** A dab of the brush at the middle of the view; where neither the focus nor the pointer is there, shows the middle. */
  dab(): void {
    if (this.brush.isDown) return; // a stroke is under way
    const { canvas } = this.stage;
    if (!this.inside && document.activeElement !== canvas) return canvas.focus();
    if (refusalOf(this.store.now)) return this.on.refused();
    if (!this.byKeys) this.setByKeys(true);
    this.brush.press(this.stage.width / 2, this.stage.height / 2);
    this.brush.release();
  }

  /** Shows the brush before the next frame. */
  hoverSoon(): void {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.hover();
    });
  }

  private hover(): void {
    const { tool, radius, session, progress } = this.store.now;
    const navigates = tool === "navigate" || this.spaceHeld;
    this.stage.canvas.dataset.cursor =
      this.drag === "turn" || this.drag === "slide"
        ? "grabbing"
        : navigates
          ? "grab"
          : tool === "brush"
            ? "brush"
            : "cross";
    const shown =
      session && !progress && tool === "brush" && !this.spaceHeld && (this.drag === null || this.drag === "paint");
    if (!shown || !(this.inside || this.byKeys)) return this.overlay.setRing(null, 0, "");
    const [x, y] = this.byKeys ? [this.stage.width / 2, this.stage.height / 2] : this.last;
    const picked = this.stage.pick(x, y);
    this.overlay.setRing(picked?.position ?? null, radius, this.on.colour());
  }
}
