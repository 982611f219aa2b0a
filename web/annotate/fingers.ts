// Two fingers on the screen: where their middle goes and how far they part.

export type Place = [number, number];

/** What two fingers did since the last time: pixels of their middle, and by what factor they parted. */
export interface Pinch {
  by: Place;
  factor: number;
}

const NEAREST = 10; // pixels: nearer than that, fingers do not say how far apart they are

export class Fingers {
  private readonly places = new Map<number, Place>();

  get count(): number {
    return this.places.size;
  }

  has(id: number): boolean {
    return this.places.has(id);
  }

  down(id: number, at: Place): void {
    this.places.set(id, at);
  }

  up(id: number): void {
    this.places.delete(id);
  }

  /** The first two; the same twice if there is one. */
  private get pair(): [Place, Place] {
    const [first, second] = [...this.places.values()];
    return [first, second ?? first];
  }

  get middle(): Place {
    const [[x, y], [u, v]] = this.pair;
    return [(x + u) / 2, (y + v) / 2];
  }

  private get apart(): number {
    const [[x, y], [u, v]] = this.pair;
    return Math.max(Math.hypot(x - u, y - v), NEAREST);
  }

  move(id: number, at: Place): Pinch {
    const { middle: before, apart } = this;
    this.places.set(id, at);
    const after = this.middle;
    return { by: [after[0] - before[0], after[1] - before[1]], factor: this.apart / apart };
  }
}
