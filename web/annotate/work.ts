// What changes labels, sent one after another in the order it was done.

import { ApiError, type Api } from "./api";
import type { Painted, Stroke } from "./types";

export const LONGEST_PAUSE_MS = 1000;
export const pause = (milliseconds: number): Promise<void> => new Promise((done) => setTimeout(done, milliseconds));

type Kind = "stroke" | "undo" | "redo";

/** How many steps can be undone and redone. */
export interface Steps {
  undo: number;
  redo: number;
}

export interface WorkEvents {
  painted(answer: Painted, kind: Kind): void;
  /** Refused or lost: what was painted here may not be so there. */
  failed(message: string): void;
  /** So many strokes wait for the program to come back. */
  waits(strokes: number): void;
  /** Whether the program can take strokes. */
  isOpen(): boolean;
  /** As far as is known here. */
  steps(): Steps;
  /** As the program has them now. */
  askSteps(): Promise<Steps>;
  idle(): void;
}

interface Job {
  kind: Kind;
  body: unknown;
}

/** What was not done, in words. */
function notDone(jobs: Job[]): string {
  const strokes = jobs.filter(({ kind }) => kind === "stroke").length;
  if (strokes > 1) return `${strokes} strokes were not applied`;
  return `The ${strokes > 0 ? "stroke" : jobs[0].kind} was not applied`;
}

export class WorkQueue {
  /** The first is on its way. */
  private readonly jobs: Job[] = [];
  private running = false;
  private hopeless = false;

  constructor(
    private readonly api: Pick<Api, "post">,
    private readonly on: WorkEvents,
    private readonly firstPauseMs = 100,
  ) {}

  get isBusy(): boolean {
    return this.running;
  }

  /** The program that the strokes were for is gone. */
  giveUp(): void {
    this.hopeless = true;
  }

  stroke(stroke: Stroke): void {
    this.add("stroke", stroke);
  }

  undo(): void {
    this.add("undo");
  }

  redo(): void {
    this.add("redo");
  }

  private add(kind: Kind, body: unknown = {}): void {
    this.jobs.push({ kind, body });
    if (!this.running) void this.run();
  }

  /** One that fails takes no other with it, unless the program is gone for good. */
  private async run(): Promise<void> {
    this.running = true;
    this.hopeless = false;
    while (this.jobs.length > 0) {
      const [job] = this.jobs;
      try {
        const answer = await this.send(job);
        if (answer) this.on.painted(answer, job.kind);
        this.jobs.shift();
      } catch (error) {
        const lost = this.jobs.splice(0, this.hopeless ? this.jobs.length : 1);
        this.on.failed(`${notDone(lost)}: ${(error as Error).message}`);
      }
    }
    this.running = false;
    this.on.waits(0);
    this.on.idle();
  }

  /** Sends a job until it is answered; null if it was done although its answer was lost. */
  private async send(job: Job): Promise<Painted | null> {
    const before = this.on.steps();
    for (let wait = this.firstPauseMs; ; wait = Math.min(2 * wait, LONGEST_PAUSE_MS)) {
      try {
        const answer = await this.api.post<Painted>(`/api/${job.kind}`, job.body);
        this.on.waits(0);
        return answer;
      } catch (error) {
        if (error instanceof ApiError) throw error;
      }
      let done: boolean | undefined;
      do {
        this.on.waits(this.jobs.filter(({ kind }) => kind === "stroke").length);
        await pause(wait);
        if (this.hopeless) throw new Error("the program that it was for is gone");
        done = this.on.isOpen() ? await this.isDone(job.kind, before) : undefined;
      } while (done === undefined);
      if (done) return null;
    }
  }

  /**
   * Whether the program did it although no answer came; undefined if it does not say. A stroke carries its own name and
   * may be sent again, as often as it takes; an undo may not.
   */
  private async isDone(kind: Kind, before: Steps): Promise<boolean | undefined> {
    if (kind === "stroke") return false;
    let now: Steps;
    try {
      now = await this.on.askSteps();
    } catch {
      return undefined;
    }
    if (now.undo === before.undo && now.redo === before.redo) return false;
    if (now.undo === before.undo + (kind === "undo" ? -1 : 1)) return true;
    throw new Error("other strokes came between");
  }
}
