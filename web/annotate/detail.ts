// Level of detail: which nodes of the octree to draw, coarse before fine.

import { cubeMeetsBox, viewPlanes } from "./geometry";
import type { Box, NodeInfo, Vec3 } from "./types";

export interface View {
  /** Local to clip, column-major. */
  matrix: ArrayLike<number>;
  eye: Vec3;
  /** Height in pixels of one unit at distance one. */
  pixels: number;
}

/** A node and how many of its first points to draw. */
export interface Take {
  id: number;
  points: number;
}

const SQRT3 = Math.sqrt(3);

/** How large a cube's sphere looks, in pixels; endless from within. */
export function projectedSize(node: NodeInfo, view: View): number {
  const [x, y, z] = node.centre;
  const away = Math.hypot(x - view.eye[0], y - view.eye[1], z - view.eye[2]) - SQRT3 * node.half;
  return away <= 0 ? Infinity : (node.half * view.pixels) / away;
}

/** Keeps the largest item first; a binary heap. */
class Queue {
  private readonly heap: { id: number; size: number }[] = [];

  get length(): number {
    return this.heap.length;
  }

  push(id: number, size: number): void {
    const heap = this.heap;
    heap.push({ id, size });
    for (let i = heap.length - 1; i > 0; ) {
      const up = (i - 1) >> 1;
      if (heap[up].size >= heap[i].size) break;
      [heap[up], heap[i]] = [heap[i], heap[up]];
      i = up;
    }
  }

  pop(): { id: number; size: number } {
    const heap = this.heap;
    const top = heap[0];
    const last = heap.pop()!;
    if (heap.length === 0) return top;
    heap[0] = last;
    for (let i = 0; ; ) {
      let largest = i;
      for (const child of [2 * i + 1, 2 * i + 2]) {
        if (child < heap.length && heap[child].size > heap[largest].size) largest = child;
      }
      if (largest === i) return top;
      [heap[largest], heap[i]] = [heap[i], heap[largest]];
      i = largest;
    }
  }
}

export interface DetailOptions {
  /** At most so many points. */
  budget: number;
  /** Points nearer to each other than this many pixels need no children. */
  finest?: number;
  clip?: Box | null;
}

/** The nodes to draw, each after its parent, those that look largest first. */
export function selectNodes(nodes: ReadonlyMap<number, NodeInfo>, view: View, options: DetailOptions): Take[] {
  const { budget, finest = 1.2, clip } = options;
  const planes = viewPlanes(view.matrix);
  const visible = ({ centre: [x, y, z], half, centre }: NodeInfo): boolean =>
    planes.every(([a, b, c, d]) => a * x + b * y + c * z + d >= -SQRT3 * half) &&
    (!clip || cubeMeetsBox(centre, half, clip));
  const queue = new Queue();
  const root = nodes.get(0);
  if (root && visible(root)) queue.push(0, Infinity);
  const taken: Take[] = [];
  let left = budget;
  while (queue.length > 0 && left > 0) {
    const { id } = queue.pop();
    const node = nodes.get(id)!;
    const points = Math.min(node.points, left);
    left -= points;
    taken.push({ id, points });
    // Half the side and the spacing shrink alike, so the ratio gives the spacing in pixels.
    if (projectedSize(node, view) * (node.spacing / node.half) < finest) continue;
    for (const child of node.children) {
      const info = nodes.get(child);
      if (info && visible(info)) queue.push(child, projectedSize(info, view));
    }
  }
  return taken;
}

/**
 * Nodes with their spacing: the distance between neighbours when a node is drawn with its ancestors and no child.
 * `full` is that distance when everything is drawn. Nodes are uniform samples of their cubes, so the points of
 * the ancestors are spread over the children as the points below these are.
 */
export function withSpacings(nodes: NodeInfo[], full: number): Map<number, NodeInfo> {
  const byId = new Map(nodes.map((node) => [node.id, { ...node }]));
  const below = new Map<number, number>();
  const order: number[] = byId.has(0) ? [0] : [];
  for (let i = 0; i < order.length; ++i) order.push(...byId.get(order[i])!.children.filter((id) => byId.has(id)));
  for (const id of [...order].reverse()) {
    const node = byId.get(id)!;
    below.set(
      id,
      node.children.reduce((sum, child) => sum + (below.get(child) ?? 0), node.points),
    );
  }
  const above = new Map<number, number>([[0, 0]]);
  for (const id of order) {
    const node = byId.get(id)!;
    const all = below.get(id)!;
    const drawn = above.get(id)! + node.points;
    node.spacing = full * Math.sqrt((above.get(id)! + all) / Math.max(drawn, 1));
    for (const child of node.children)
      above.set(child, (drawn * (below.get(child) ?? 0)) / Math.max(all - node.points, 1));
  }
  return byId;
}

/** Which of eight octants of a cube a place lies in: bit 0 x, bit 1 y, bit 2 z. */
export const octantOf = (centre: Vec3, place: Vec3): number =>
  (place[0] >= centre[0] ? 1 : 0) | (place[1] >= centre[1] ? 2 : 0) | (place[2] >= centre[2] ? 4 : 0);

/** For each node drawn, the distance between the points drawn in each of its octants. */
export function drawnSpacings(nodes: ReadonlyMap<number, NodeInfo>, taken: Take[]): Map<number, Float32Array> {
  const spacings = new Map<number, Float32Array>();
  for (let i = taken.length - 1; i >= 0; --i) {
    // children come after their parents
    const node = nodes.get(taken[i].id)!;
    const own = node.spacing * Math.sqrt(node.points / Math.max(taken[i].points, 1));
    const octants = new Float32Array(8).fill(own);
    for (const child of node.children) {
      const finer = spacings.get(child);
      if (!finer) continue;
      const mean = finer.reduce((sum, value) => sum + value, 0) / 8;
      octants[octantOf(node.centre, nodes.get(child)!.centre)] = Math.min(own, mean);
    }
    spacings.set(node.id, octants);
  }
  return spacings;
}
