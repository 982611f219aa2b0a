// Keeps the lines and the decisions on them in step with the server's.

import type { Api } from "./api";
import type { Words } from "./client";
import { searchText } from "./format";
import type { AppStore } from "./store";
import type { DecidedEvent, Decision, Lines } from "./types";

export class LineClient {
  constructor(
    private readonly api: Api,
    private readonly store: AppStore,
    private readonly words: Words,
    /** Whether this window paints; says so if it does not. */
    private readonly mayPaint: () => boolean,
  ) {}

  async refresh(): Promise<void> {
    const found = await this.api.get<Lines>("/api/lines");
    // Those of another cloud are shown there.
    const lines = (found.cloud ?? 0) === this.store.now.cloud ? found : { ...found, version: 0, lines: [] };
    const isSame = lines.version === this.store.now.lines.version;
    this.store.set({ lines, ...(isSame ? {} : { line: null, showLines: true }) });
  }

  /** A search has begun or ended; its lines are new if it found them. */
  async take(version: number, searching: boolean): Promise<void> {
    const { lines } = this.store.now;
    this.store.set({ lines: { ...lines, searching }, searchStage: "" });
    if (version === lines.version) return;
    await this.refresh();
    const now = this.store.now.lines;
    if (now.lines.length > 0 || (now.cloud ?? 0) !== this.store.now.cloud) return;
    this.words.warn("No lines found: the prediction has no edge that is long enough.");
  }

  takeStage(stage: string, fraction: number): void {
    if (this.store.now.lines.searching) this.store.set({ searchStage: searchText(stage, fraction) });
  }

  takeDecisions({ version, decision, lines: numbers }: DecidedEvent): void {
    const { lines } = this.store.now;
    if (version !== lines.version) return;
    const changed = [...lines.lines];
    for (const number of numbers) changed[number] = { ...changed[number], decision };
    this.store.set({ lines: { ...lines, lines: changed } });
  }

  find(): void {
    if (!this.mayPaint()) return;
    const { cloud } = this.store.now;
    this.api.post("/api/lines/find", { cloud }).catch((error: Error) => this.words.warn(error.message));
  }

  /** Whether the server took the decision; says why if it did not. */
  async decide(decision: Decision, lines: number[]): Promise<boolean> {
    if (!this.mayPaint()) return false;
    const event = { version: this.store.now.lines.version, decision, lines };
    try {
      await this.api.post("/api/lines/decide", event);
    } catch (error) {
      this.words.warn((error as Error).message);
      return false;
    }
    this.takeDecisions(event);
    return true;
  }
}
