// Handles on the faces of the clipping box: each is dragged along its axis.

import { svg } from "../shared/dom";
import type { Overlay } from "./overlay";
import type { AppStore } from "./store";
import type { Box, Vec3 } from "./types";

interface Face {
  axis: 0 | 1 | 2;
  side: "min" | "max";
}

const FACES: Face[] = ([0, 1, 2] as const).flatMap((axis) => (["min", "max"] as const).map((side) => ({ axis, side })));

/** The middle of a face. */
export function faceMiddle({ min, max }: Box, { axis, side }: Face): Vec3 {
  const middle = min.map((low, i) => (low + max[i]) / 2) as Vec3;
  middle[axis] = side === "min" ? min[axis] : max[axis];
  return middle;
}

/** The box with a face moved along its axis, not beyond the opposite one. */
export function moved(box: Box, { axis, side }: Face, by: number): Box {
  const copy = structuredClone(box);
  copy[side][axis] += by;
  if (side === "min") copy.min[axis] = Math.min(copy.min[axis], box.max[axis]);
  else copy.max[axis] = Math.max(copy.max[axis], box.min[axis]);
  return copy;
}

/** A box that is cut down to a slice of the bounds across an axis, at a place. */
export function sliceOf(bounds: Box, axis: number, at: number, share: number): Box {
  const box = structuredClone(bounds);
  const half = ((bounds.max[axis] - bounds.min[axis]) * share) / 2;
  const middle = Math.min(Math.max(at, bounds.min[axis] + half), bounds.max[axis] - half);
  box.min[axis] = middle - half;
  box.max[axis] = middle + half;
  return box;
}

/** The box moved along the axis across which it is thinnest by so many of its thicknesses. */
export function stepped(box: Box, bounds: Box, by: number): Box {
  const width = (b: Box, axis: number): number => b.max[axis] - b.min[axis];
  const share = (axis: number): number => width(box, axis) / Math.max(width(bounds, axis), 1e-12);
  const axis = [0, 1, 2].reduce((a, b) => (share(b) < share(a) ? b : a));
  const copy = structuredClone(box);
  const step = by * width(box, axis);
  copy.min[axis] += step;
  copy.max[axis] += step;
  return copy;
}

export class ClipHandles {
  private readonly dots = FACES.map((face) => this.handle(face));

  constructor(
    private readonly overlay: Overlay,
    private readonly store: AppStore,
  ) {
    overlay.element.append(...this.dots);
    overlay.followers.push(() => this.follow());
    store.watch(["clip"], () => this.follow());
  }

  private get box(): Box | null {
    const clip = this.store?.now.clip;
    return clip?.on ? clip.box : null;
  }

  private follow(): void {
    const { box } = this;
    FACES.forEach((face, k) => {
      const at = box && this.overlay.toScreen(faceMiddle(box, face));
      this.dots[k].setAttribute("visibility", at ? "visible" : "hidden");
      if (at) this.dots[k].setAttribute("transform", `translate(${at.x} ${at.y})`);
    });
  }

  private handle(face: Face): SVGElement {
    const dot = svg("circle", {
      class: `handle axis${face.axis}`,
      r: 6,
      "data-face": `${"xyz"[face.axis]} ${face.side}`,
    });
    dot.addEventListener("pointerdown", (event) => {
      event.preventDefault();
      dot.setPointerCapture(event.pointerId);
    });
    dot.addEventListener("pointermove", (event) => {
      if (dot.hasPointerCapture(event.pointerId)) this.drag(face, event.movementX, event.movementY);
    });
    return dot;
  }

  /** By pixels of the screen, as far as they go along the axis. */
  private drag(face: Face, right: number, down: number): void {
    const { box } = this;
    if (!box) return;
    const middle = faceMiddle(box, face);
    const step = Math.max(...box.min.map((low, i) => box.max[i] - low)) / 100;
    const beyond = [...middle] as Vec3;
    beyond[face.axis] += step;
    const [from, to] = [this.overlay.toScreen(middle), this.overlay.toScreen(beyond)];
    if (!from || !to) return;
    const [dx, dy] = [to.x - from.x, to.y - from.y];
    const length = dx * dx + dy * dy;
    if (length < 1e-3) return; // seen along the axis
    const by = ((right * dx + down * dy) / length) * step;
    this.store.set({ clip: { on: true, box: moved(box, face, by) } });
  }
}
