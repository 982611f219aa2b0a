// The points of one node as they come and as they are drawn.

import { fromCube, inBox, octahedral } from "./geometry";
import { NO_CLASS, type Box, type NodeInfo, type Vec3 } from "./types";

export interface Chunk {
  info: NodeInfo;
  /** Three a point; 0..65535 spans the cube. */
  positions: Uint16Array;
  /** Two a point: octahedral, -127..127. */
  normals: Int8Array;
  /** Three a point, or none. */
  colours: Uint8Array | null;
  /** Painted class a point; 255 none. */
  labels: Uint8Array;
  /** The same as the server said last: without strokes that it has not taken. */
  confirmed: Uint8Array;
  /** Predicted class a point; 255 none. */
  prediction: Uint8Array;
  /** What a ramp colours, a byte a point, and what it is, as "confidence"; null before it is here. */
  values: Uint8Array;
  valuesOf: string | null;
}

/** Which points count as visible. */
export interface Visibility {
  hidden: ReadonlySet<number>;
  clip: Box | null;
}

/** A chunk from the server's bytes; throws if their number is wrong. */
export function decodeChunk(info: NodeInfo, bytes: ArrayBuffer, hasColours: boolean): Chunk {
  const n = info.points;
  const wanted = n * (hasColours ? 11 : 8);
  if (bytes.byteLength !== wanted) {
    throw new Error(`node ${info.id}: ${bytes.byteLength} bytes, not ${wanted}`);
  }
  return {
    info,
    positions: new Uint16Array(bytes, 0, 3 * n), // little-endian, as every browser's machine
    normals: new Int8Array(bytes, 6 * n, 2 * n),
    colours: hasColours ? new Uint8Array(bytes, 8 * n, 3 * n) : null,
    labels: new Uint8Array(n).fill(NO_CLASS),
    confirmed: new Uint8Array(n).fill(NO_CLASS),
    prediction: new Uint8Array(n).fill(NO_CLASS),
    values: new Uint8Array(n),
    valuesOf: null,
  };
}

export function pointAt({ info: { centre, half }, positions }: Chunk, i: number): Vec3 {
  const step = (2 * half) / 65535;
  return [0, 1, 2].map((axis) => centre[axis] - half + positions[3 * i + axis] * step) as Vec3;
}

const MOST_PLACES = 20_000;

/** Some of its points, spread evenly as any first ones are: x, y, z, x, y, z, ... */
export function placesOf(chunk: Chunk): number[] {
  const places: number[] = [];
  for (let i = 0; i < Math.min(chunk.info.points, MOST_PLACES); ++i) places.push(...pointAt(chunk, i));
  return places;
}

/** The places without those that lie far from nearly all others: one far point would make a speck of the cloud. */
export function withoutFar(places: number[]): number[] {
  const n = places.length / 3;
  const ends = [0, 1, 2].map((axis) => {
    const sorted = Float64Array.from({ length: n }, (_, i) => places[3 * i + axis]).sort();
    return [sorted[Math.floor(0.01 * (n - 1))], sorted[Math.ceil(0.99 * (n - 1))]];
  });
  const room = Math.max(...ends.map(([low, high]) => high - low));
  const isNear = (i: number): boolean =>
    ends.every(([low, high], axis) => places[i + axis] >= low - room && places[i + axis] <= high + room);
  return places.filter((_, k) => isNear(k - (k % 3)));
}

export const normalAt = ({ normals }: Chunk, i: number): Vec3 =>
  octahedral(normals[2 * i] / 127, normals[2 * i + 1] / 127);

/** The clip box in a cube's own coordinates. */
function boxInCube({ centre, half }: NodeInfo, clip: Box | null): Box | null {
  if (!clip) return null;
  const unit = (p: Vec3): Vec3 => p.map((c, i) => ((c - centre[i] + half) / (2 * half)) * 65535) as Vec3;
  return { min: unit(clip.min), max: unit(clip.max) };
}

/** A test whether a chunk's point is visible: in the box, and neither painted nor predicted as hidden. */
export function visibleIn(chunk: Chunk, { hidden, clip }: Visibility): (i: number) => boolean {
  const { positions: p, labels, prediction } = chunk;
  const box = boxInCube(chunk.info, clip);
  return (i) =>
    (hidden.size === 0 || !(hidden.has(labels[i]) || hidden.has(prediction[i]))) &&
    (!box || inBox(p[3 * i], p[3 * i + 1], p[3 * i + 2], box));
}

export interface Picked {
  chunk: Chunk;
  index: number;
  position: Vec3;
  normal: Vec3;
  /** Along the view. */
  depth: number;
}

export interface PickOptions extends Visibility {
  /** Local to clip, column-major. */
  matrix: ArrayLike<number>;
  /** In clip space, -1..1. */
  x: number;
  y: number;
  /** Half the view's size in pixels. */
  halfWidth: number;
  halfHeight: number;
  /** Height in pixels of one unit at distance one. */
  pixels: number;
  /** How far from the cursor a point may be, in pixels. */
  reach: number;
}

/** The nearest visible point under the cursor, one nearer to its middle before one a little in front. */
export function pick(drawn: { chunk: Chunk; points: number }[], options: PickOptions): Picked | null {
  const { x, y, halfWidth, halfHeight, reach, pixels } = options;
  let best = { chunk: null as Chunk | null, index: -1, score: Infinity, depth: 0 };
  for (const { chunk, points } of drawn) {
    const m = fromCube(options.matrix, chunk.info.centre, chunk.info.half);
    if (!cubeUnderCursor(m, options)) continue;
    const visible = visibleIn(chunk, options);
    const p = chunk.positions;
    for (let i = 0; i < points; ++i) {
      const [a, b, c] = [p[3 * i], p[3 * i + 1], p[3 * i + 2]];
      const w = m[3] * a + m[7] * b + m[11] * c + m[15];
      if (w <= 0 || w >= best.score) continue;
      const dx = ((m[0] * a + m[4] * b + m[8] * c + m[12]) / w - x) * halfWidth;
      const dy = ((m[1] * a + m[5] * b + m[9] * c + m[13]) / w - y) * halfHeight;
      const away = dx * dx + dy * dy;
      if (away > reach * reach) continue;
      const score = w + (2 * Math.sqrt(away) * w) / pixels;
      if (score < best.score && visible(i)) best = { chunk, index: i, score, depth: w };
    }
  }
  if (!best.chunk) return null;
  const { chunk, index, depth } = best;
  return { chunk, index, depth, position: pointAt(chunk, index), normal: normalAt(chunk, index) };
}

/** May a cube, drawn with the matrix of its own coordinates, hold a point within reach? */
function cubeUnderCursor(m: Float64Array, { x, y, halfWidth, halfHeight, reach }: PickOptions): boolean {
  const most = 65535;
  const [rx, ry] = [reach / halfWidth, reach / halfHeight];
  const outside = [true, true, true, true, true];
  for (let corner = 0; corner < 8; ++corner) {
    const [a, b, c] = [(corner & 1) * most, ((corner >> 1) & 1) * most, (corner >> 2) * most];
    const at = (r: number): number => m[r] * a + m[4 + r] * b + m[8 + r] * c + m[12 + r];
    const w = at(3);
    const sides = [at(0) - (x - rx) * w, (x + rx) * w - at(0), at(1) - (y - ry) * w, (y + ry) * w - at(1), w];
    sides.forEach((side, k) => {
      if (side >= 0) outside[k] = false;
    });
  }
  return !outside.includes(true);
}
