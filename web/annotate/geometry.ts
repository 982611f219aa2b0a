// Small geometry on plain arrays: normals, matrices, boxes, polygons.

import type { Box, Vec3 } from "./types";

/** The unit vector that octahedral coordinates in -1..1 stand for. */
export function octahedral(u: number, v: number): Vec3 {
  let [x, y] = [u, v];
  const z = 1 - Math.abs(u) - Math.abs(v);
  if (z < 0) {
    x = (1 - Math.abs(v)) * (u < 0 ? -1 : 1);
    y = (1 - Math.abs(u)) * (v < 0 ? -1 : 1);
  }
  const length = Math.hypot(x, y, z);
  return [x / length, y / length, z / length];
}

export const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** Clip coordinates x, y, z, w of a point; `matrix` is column-major. */
export function project(matrix: ArrayLike<number>, p: Vec3): [number, number, number, number] {
  const row = (r: number): number => matrix[r] * p[0] + matrix[4 + r] * p[1] + matrix[8 + r] * p[2] + matrix[12 + r];
  return [row(0), row(1), row(2), row(3)];
}

/** A matrix after a cube's own: from its coordinates 0..65535 to clip space. */
export function fromCube(matrix: ArrayLike<number>, centre: Vec3, half: number): Float64Array {
  const out = new Float64Array(16);
  const step = (2 * half) / 65535;
  for (let r = 0; r < 4; ++r) {
    for (let c = 0; c < 3; ++c) {
      out[4 * c + r] = matrix[4 * c + r] * step;
      out[12 + r] += matrix[4 * c + r] * (centre[c] - half);
    }
    out[12 + r] += matrix[12 + r];
  }
  return out;
}

/** Planes a x + b y + c z + d >= 0 within the view: left, right, bottom, top, near; unit normals. */
export function viewPlanes(matrix: ArrayLike<number>): [number, number, number, number][] {
  const row = (r: number): number[] => [matrix[r], matrix[4 + r], matrix[8 + r], matrix[12 + r]];
  const w = row(3);
  const sides: [number, number][] = [
    [0, 1],
    [0, -1],
    [1, 1],
    [1, -1],
    [2, 1],
  ];
  return sides.map(([axis, sign]) => {
    const plane = row(axis).map((value, i) => w[i] + sign * value);
    const length = Math.hypot(plane[0], plane[1], plane[2]) || 1;
    return plane.map((value) => value / length) as [number, number, number, number];
  });
}

export function cubeMeetsBox(centre: Vec3, half: number, box: Box): boolean {
  return centre.every((c, i) => c + half >= box.min[i] && c - half <= box.max[i]);
}

export const inBox = (x: number, y: number, z: number, box: Box): boolean =>
  x >= box.min[0] && y >= box.min[1] && z >= box.min[2] && x <= box.max[0] && y <= box.max[1] && z <= box.max[2];

/** Is the point within the polygon, by even and odd crossings? */
export function inPolygon(x: number, y: number, polygon: [number, number][]): boolean {
  let inside = false;
  for (let i = 0, j = polygon.length - 1; i < polygon.length; j = i++) {
    const [xi, yi] = polygon[i];
    const [xj, yj] = polygon[j];
    if (yi > y !== yj > y && x < ((xj - xi) * (y - yi)) / (yj - yi) + xi) inside = !inside;
  }
  return inside;
}

/** Leaves out corners nearer than `step` to the last one kept. */
export function thin(polygon: [number, number][], step: number): [number, number][] {
  const kept: [number, number][] = [];
  for (const p of polygon) {
    const last = kept[kept.length - 1];
    if (!last || Math.hypot(p[0] - last[0], p[1] - last[1]) >= step) kept.push(p);
  }
  return kept;
}

export const boxCentre = (box: Box): Vec3 => box.min.map((low, i) => (low + box.max[i]) / 2) as Vec3;

/** The eight corners: x, y, z, x, y, z, ... */
export const boxCorners = ({ min, max }: Box): number[] =>
  Array.from({ length: 8 }, (_, k) => [0, 1, 2].map((i) => ((k >> i) & 1 ? max : min)[i])).flat();

export const boxDiagonal = (box: Box): number => Math.hypot(...box.min.map((low, i) => box.max[i] - low));
