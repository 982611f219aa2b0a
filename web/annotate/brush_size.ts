// How large the brush may be in a cloud.

import { boxDiagonal } from "./geometry";
import type { Session } from "./types";

type Known = Pick<Session, "spacing" | "bounds">;

/** The radii of the smallest and the largest brush. */
export const brushRange = ({ spacing, bounds }: Known): [number, number] => [spacing * 0.5, boxDiagonal(bounds) / 4];

export function usableRadius(radius: number, session: Known): number {
  const [low, high] = brushRange(session);
  return Math.min(Math.max(radius, low), high);
}
