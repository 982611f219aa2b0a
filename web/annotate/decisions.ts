// Decisions on lines: shown at once, sent one after another in the order they were made.

import type { DecidedEvent, Lines } from "./types";

/** The lines with those of the decisions that are on this version of them. */
export function decided(lines: Lines, decisions: readonly DecidedEvent[]): Lines {
  const changed = [...lines.lines];
  for (const { cloud, version, decision, lines: numbers } of decisions) {
    if (version !== lines.version || cloud !== (lines.cloud ?? 0)) continue;
    for (const number of numbers) changed[number] = { ...changed[number], decision };
  }
  return { ...lines, lines: changed };
}

export interface DecisionEvents {
  taken(decision: DecidedEvent): void;
  /** The program did not take one; those that followed are given up, too. */
  failed(error: Error): void;
}

export class DecisionQueue {
  private readonly waiting: DecidedEvent[] = [];
  private running = false;
  private work = Promise.resolve();

  constructor(
    private readonly send: (decision: DecidedEvent) => Promise<unknown>,
    private readonly on: DecisionEvents,
  ) {}

  /** Those that the program has not taken yet. */
  get pending(): readonly DecidedEvent[] {
    return this.waiting;
  }

  add(decision: DecidedEvent): void {
    this.waiting.push(decision);
    if (!this.running) this.work = this.run();
  }

  /** Once the program has taken all, or refused one. */
  settled(): Promise<void> {
    return this.work;
  }

  private async run(): Promise<void> {
    this.running = true;
    while (this.waiting.length > 0) {
      try {
        await this.send(this.waiting[0]);
        this.on.taken(this.waiting.shift()!);
      } catch (error) {
        this.waiting.length = 0;
        this.on.failed(error as Error);
      }
    }
    this.running = false;
  }
}
