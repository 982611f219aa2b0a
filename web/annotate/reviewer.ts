// Going through the lines that were found, one by one.

import type { LineClient } from "./line_client";
import type { Stage } from "./stage";
import type { AppStore } from "./store";
import type { Decision, Line } from "./types";

/** How many lines there are of each decision. */
export function countDecisions(lines: Line[]): Record<Decision, number> {
  const counts = { open: 0, accepted: 0, rejected: 0 };
  for (const { decision } of lines) ++counts[decision];
  return counts;
}

/** The line some steps from one, round the end; the first or the last from none. */
export function stepped(count: number, from: number | null, by: number): number | null {
  if (count === 0) return null;
  if (from === null) return by > 0 ? 0 : count - 1;
  return (from + by + count) % count;
}

/** The first undecided line after one, round the end; null if all others are decided. */
export function nextOpen(lines: Line[], from: number): number | null {
  for (let k = 1; k < lines.length; ++k) {
    const number = (from + k) % lines.length;
    if (lines[number].decision === "open") return number;
  }
  return null;
}

/** The diagonal of the box of a path. */
function extent(path: number[]): number {
  const side = (axis: number): number => {
    const values = path.filter((_, i) => i % 3 === axis);
    return values.reduce((a, b) => Math.max(a, b)) - values.reduce((a, b) => Math.min(a, b));
  };
  return Math.hypot(side(0), side(1), side(2));
}

export class Reviewer {
  constructor(
    private readonly stage: Stage,
    private readonly store: AppStore,
    private readonly client: LineClient,
  ) {}

  step(by: number): void {
    const { lines, line } = this.store.now;
    this.visit(stepped(lines.lines.length, line, by));
  }

  /** Decides on the line that is looked at and goes to the next that is undecided. */
  decide(decision: Decision): void {
    const { line } = this.store.now;
    if (line === null || !this.client.decide(decision, [line])) return;
    const next = nextOpen(this.store.now.lines.lines, line);
    if (next !== null) this.visit(next);
  }

  acceptRest(): void {
    const rest = this.store.now.lines.lines.flatMap(({ decision }, i) => (decision === "open" ? [i] : []));
    this.client.decide("accepted", rest);
  }

  private visit(number: number | null): void {
    const { lines, session } = this.store.now;
    if (number === null || !session) return;
    this.store.set({ line: number, showLines: true });
    const { middle, normal, path } = lines.lines[number];
    this.stage.camera.visit(
      middle,
      normal,
      Math.max(this.stage.camera.nearby(session.spacing * 60), 1.8 * extent(path)),
    );
  }
}
