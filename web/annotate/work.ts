// What changes labels, sent one after another in the order it was done.

import { ApiError, type Api } from "./api";
import type { Painted, Stroke } from "./types";

const TRIES = 6;
const pause = (milliseconds: number): Promise<void> => new Promise((done) => setTimeout(done, milliseconds));

export interface WorkEvents {
  painted(answer: Painted): void;
  /** Refused or lost: what was painted here may not be so there. */
  failed(error: Error): void;
  idle(): void;
}

export class WorkQueue {
  private readonly jobs: { path: string; body: unknown }[] = [];
  private running = false;

  constructor(
    private readonly api: Api,
    private readonly on: WorkEvents,
  ) {}

  get isBusy(): boolean {
    return this.running;
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
    while (this.jobs.length > 0) {
      const { path, body } = this.jobs.shift()!;
      try {
        this.on.painted(await this.send(path, body));
      } catch (error) {
        this.jobs.length = 0;
        this.on.failed(error as Error);
      }
    }
    this.running = false;
    this.on.idle();
  }

  /** A stroke carries its own name and may be sent again; an undo may not. */
  private async send(path: string, body: unknown): Promise<Painted> {
    for (let attempt = 1; ; ++attempt) {
      try {
        return await this.api.post<Painted>(path, body);
      } catch (error) {
        if (error instanceof ApiError || path !== "/api/stroke" || attempt === TRIES) throw error;
        await pause(100 * 2 ** attempt);
      }
    }
  }
}
