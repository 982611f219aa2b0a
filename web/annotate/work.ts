// What changes labels, sent one after another in the order it was done.

import { ApiError, type Api } from "./api";
import type { Painted, Stroke } from "./types";

export const LONGEST_PAUSE_MS = 1000;
export const pause = (milliseconds: number): Promise<void> => new Promise((done) => setTimeout(done, milliseconds));

export interface WorkEvents {
  painted(answer: Painted): void;
  /** Refused or lost: what was painted here may not be so there. */
  failed(error: Error): void;
  /** So many strokes wait for the program to come back. */
  waits(strokes: number): void;
  /** Whether the program can take strokes. */
  isOpen(): boolean;
  idle(): void;
}

interface Job {
  path: string;
  body: unknown;
}

export class WorkQueue {
  private readonly jobs: Job[] = [];
  private running = false;
  private hopeless = false;

  constructor(
    private readonly api: Api,
    private readonly on: WorkEvents,
  ) {}

  get isBusy(): boolean {
    return this.running;
  }

  /** The program that the strokes were for is gone. */
  giveUp(): void {
    this.hopeless = true;
  }

  stroke(stroke: Stroke): void {
    this.add("/api/stroke", stroke);
  }

  undo(): void {
    this.add("/api/undo", {});
  }

  redo(): void {
    this.add("/api/redo", {});
  }

  private add(path: string, body: unknown): void {
    this.jobs.push({ path, body });
    if (!this.running) void this.run();
  }

  private async run(): Promise<void> {
    this.running = true;
    this.hopeless = false;
    while (this.jobs.length > 0) {
      const job = this.jobs.shift()!;
      try {
        this.on.painted(await this.send(job));
      } catch (error) {
        this.jobs.length = 0;
        this.on.failed(error as Error);
      }
    }
    this.running = false;
    this.on.waits(0);
    this.on.idle();
  }

  /** A stroke carries its own name and may be sent again, as often as it takes; an undo may not. */
  private async send({ path, body }: Job): Promise<Painted> {
    for (let wait = 100; ; wait = Math.min(2 * wait, LONGEST_PAUSE_MS)) {
      try {
        const answer = await this.api.post<Painted>(path, body);
        this.on.waits(0);
        return answer;
      } catch (error) {
        if (error instanceof ApiError || path !== "/api/stroke") throw error;
        this.on.waits(1 + this.jobs.length);
      }
      do {
        await pause(wait);
        if (this.hopeless) throw new Error("the program that it was for is gone");
      } while (!this.on.isOpen());
    }
  }
}
