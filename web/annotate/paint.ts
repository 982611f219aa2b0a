// Strokes applied to the points that are here, at once; the server applies them to all points.

import { normalAt, visibleIn, type Chunk, type Visibility } from "./chunk";
import { dot, fromCube, inPolygon } from "./geometry";
import { NO_CLASS, type PolygonStroke, type Vec3 } from "./types";

export interface PaintOptions extends Visibility {
  /** 255 erases. */
  class: number;
  /** Points that have a label keep it. */
  protect: boolean;
}

/** A brush paints what faces no more than 120 degrees away from the point under it. */
const LEAST_COSINE = -0.5;

/** Paints a ball; true if any label changed. */
export function paintBall(chunk: Chunk, centre: Vec3, normal: Vec3, radius: number, options: PaintOptions): boolean {
  const { centre: middle, half } = chunk.info;
  const units = 65535 / (2 * half);
  const [cx, cy, cz] = centre.map((c, i) => (c - middle[i] + half) * units);
  const reach = radius * units;
  if (![cx, cy, cz].every((c) => c >= -reach && c <= 65535 + reach)) return false;
  const visible = visibleIn(chunk, options);
  const { positions: p, labels } = chunk;
  let changed = false;
  for (let i = 0; i < labels.length; ++i) {
    const [dx, dy, dz] = [p[3 * i] - cx, p[3 * i + 1] - cy, p[3 * i + 2] - cz];
    if (dx * dx + dy * dy + dz * dz > reach * reach) continue;
    if (!mayPaint(labels[i], options) || !visible(i)) continue;
    if (dot(normalAt(chunk, i), normal) < LEAST_COSINE) continue;
    labels[i] = options.class;
    changed = true;
  }
  return changed;
}

const mayPaint = (label: number, { class: wanted, protect }: PaintOptions): boolean =>
  label !== wanted && !(protect && label !== NO_CLASS);

/** The nearest depth in each cell of the view, cells as large as a point is drawn. */
class DepthGrid {
  private readonly cells: Float32Array;
  private readonly columns: number;
  private readonly rows: number;

  constructor([width, height]: [number, number], cell: number) {
    this.columns = Math.max(1, Math.ceil(width / cell));
    this.rows = Math.max(1, Math.ceil(height / cell));
    this.cells = new Float32Array(this.columns * this.rows).fill(Infinity);
  }

  private cell(x: number, y: number): number {
    const column = Math.floor((x * 0.5 + 0.5) * this.columns);
    const row = Math.floor((y * 0.5 + 0.5) * this.rows);
    return column < 0 || row < 0 || column >= this.columns || row >= this.rows ? -1 : row * this.columns + column;
  }

  add(x: number, y: number, depth: number): void {
    const cell = this.cell(x, y);
    if (cell >= 0 && depth < this.cells[cell]) this.cells[cell] = depth;
  }

  /** Nothing much nearer in the same cell? */
  shows(x: number, y: number, depth: number): boolean {
    const cell = this.cell(x, y);
    return cell >= 0 && depth <= this.cells[cell] * 1.02;
  }
}

function forEachInView(
  chunk: Chunk,
  matrix: number[],
  visit: (i: number, x: number, y: number, w: number) => void,
): void {
  const m = fromCube(matrix, chunk.info.centre, chunk.info.half);
  const p = chunk.positions;
  for (let i = 0; i < chunk.labels.length; ++i) {
    const [a, b, c] = [p[3 * i], p[3 * i + 1], p[3 * i + 2]];
    const w = m[3] * a + m[7] * b + m[11] * c + m[15];
    if (w <= 0) continue;
    const x = (m[0] * a + m[4] * b + m[8] * c + m[12]) / w;
    const y = (m[1] * a + m[5] * b + m[9] * c + m[13]) / w;
    if (Math.abs(x) <= 1 && Math.abs(y) <= 1) visit(i, x, y, w);
  }
}

/** Paints what lies in the polygon of the view; the chunks whose labels changed. */
export function paintPolygon(chunks: Chunk[], stroke: PolygonStroke, options: PaintOptions): Chunk[] {
  const grid = stroke.front_only ? new DepthGrid(stroke.viewport, Math.max(stroke.point_size, 3)) : null;
  if (grid) {
    for (const chunk of chunks) {
      const visible = visibleIn(chunk, options);
      forEachInView(chunk, stroke.matrix, (i, x, y, w) => {
        if (visible(i)) grid.add(x, y, w);
      });
    }
  }
  return chunks.filter((chunk) => {
    const visible = visibleIn(chunk, options);
    let changed = false;
    forEachInView(chunk, stroke.matrix, (i, x, y, w) => {
      if (!mayPaint(chunk.labels[i], options) || !inPolygon(x, y, stroke.polygon)) return;
      if (!visible(i) || (grid && !grid.shows(x, y, w))) return;
      chunk.labels[i] = options.class;
      changed = true;
    });
    return changed;
  });
}
