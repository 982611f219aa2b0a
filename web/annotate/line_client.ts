// Keeps the lines of the cloud in view, and the decisions on them, in step with the server's.

import type { Api } from "./api";
import type { Words } from "./words";
import { decided, DecisionQueue } from "./decisions";
import { count, searchText } from "./format";
import type { AppStore, State } from "./store";
import type { DecidedEvent, Decision, Lines, LinesEvent } from "./types";

/** What another search would forget, as a question; empty if nothing. */
export function lossOf({ lines }: Pick<State, "lines">): string {
  const made = lines.lines.filter(({ decision }) => decision !== "open").length;
  if (made === 0) return "";
  return (
    `You have decided on ${count(made)} of ${count(lines.lines.length)} lines. ` +
    "Find the lines again and forget these decisions?"
  );
}

export class LineClient {
  /** As the server has them; the store shows the decisions on their way, too. */
  private known: Lines;
  private readonly queue: DecisionQueue;

  constructor(
    private readonly api: Api,
    private readonly store: AppStore,
    private readonly words: Words,
    /** Whether this window paints; says so if it does not. */
    private readonly mayPaint: () => boolean,
    private readonly ask: (question: string, yes: string) => Promise<boolean>,
  ) {
    this.known = store.now.lines;
    this.queue = new DecisionQueue((decision) => this.api.post("/api/lines/decide", decision), {
      taken: (decision) => this.takeDecisions(decision),
      failed: (error) => {
        this.words.warn(`The decision was not kept: ${error.message}`);
        this.show();
      },
    });
  }

  async refresh(): Promise<void> {
    const found = await this.api.get<Lines>("/api/lines");
    const { cloud, lines } = this.store.now;
    if ((found.cloud ?? 0) !== cloud) return; // asked for before another one was looked at
    const isSame = found.version === lines.version && (lines.cloud ?? 0) === cloud;
    this.known = found;
    this.show(isSame ? {} : { line: null, showLines: true });
  }

  private show(more: Partial<State> = {}): void {
    this.store.set({ lines: decided(this.known, this.queue.pending), ...more });
  }

  /** A search has begun or ended; its lines are new if it found them. */
  async take({ cloud, version, searching }: LinesEvent): Promise<void> {
    if (cloud !== this.store.now.cloud) return;
    this.known = { ...this.known, searching };
    this.show({ searchStage: "" });
    if (version === this.known.version) return;
    await this.refresh();
    if (this.store.now.cloud !== cloud || this.known.lines.length > 0) return;
    const more = this.store.now.boundaries ? "" : " Boundaries were not searched.";
    this.words.warn(`No lines found: the prediction has no edge that is long enough.${more}`);
  }

  takeStage(stage: string, fraction: number): void {
    if (this.store.now.lines.searching) this.store.set({ searchStage: searchText(stage, fraction) });
  }

  takeDecisions(event: DecidedEvent): void {
    this.known = decided(this.known, [event]);
    this.show();
  }

  /** Finds the lines of the cloud in view; asks first if that costs decisions. */
  async find(): Promise<void> {
    if (!this.mayPaint()) return;
    const { cloud, boundaries } = this.store.now;
    const loss = lossOf(this.store.now);
    if (loss && !(await this.ask(loss, "Find again"))) return;
    this.api.post("/api/lines/find", { cloud, boundaries }).catch((error: Error) => this.words.warn(error.message));
  }

  /** Decides at once, before the server has heard of it; false if this window may not. */
  decide(decision: Decision, lines: number[]): boolean {
    if (!this.mayPaint()) return false;
    const { version, cloud } = this.known;
    this.queue.add({ cloud: cloud ?? 0, version, decision, lines });
    this.show();
    return true;
  }

  /** Once the program knows of every decision, as a download of the accepted lines needs. */
  settled(): Promise<void> {
    return this.queue.settled();
  }
}
