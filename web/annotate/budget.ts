// How many points to draw, from how long drawing takes.

const MOVING_MS = 30;
const RESTING_MS = 120;
const STILL_MS = 1500;
const clamp = (value: number, low: number, high: number): number => Math.min(Math.max(value, low), high);

export class Budget {
  /** Points drawn in a millisecond: at first as of a slow machine. */
  private rate = 2000;
  private known = false;

  /** Tells how long some points took; a few points tell nothing. */
  learn(points: number, milliseconds: number): void {
    if (points < 10_000) return;
    const seen = points / Math.max(milliseconds, 0.2);
    this.rate = this.known ? 0.7 * this.rate + 0.3 * seen : seen;
    this.known = true;
  }

  /** For one frame while the view moves. */
  get moving(): number {
    return Math.round(clamp(this.rate * MOVING_MS, 30_000, 4_000_000));
  }

  /** For one frame of a view at rest: less often interrupted, so less is seen to fill in. */
  get resting(): number {
    return Math.round(clamp(this.rate * RESTING_MS, 60_000, 6_000_000));
  }

  /** For a view at rest, filled in frame by frame. */
  get still(): number {
    return Math.round(clamp(this.rate * STILL_MS, 500_000, 6_000_000));
  }
}
