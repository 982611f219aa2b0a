// The places where the network is unsure, one after another.

import type { Api } from "./api";
import type { AppStore } from "./store";
import type { Uncertain } from "./types";
import type { Words } from "./words";

export class UncertainClient {
  /** The last step, done or not. */
  private stepped: Promise<Uncertain | null> = Promise.resolve(null);

  constructor(
    private readonly api: Api,
    private readonly store: AppStore,
    private readonly words: Words,
  ) {}

  /** The next place or the one before, round and round. One step after another: two at a time would lead to the same
   *  place. */
  step(by: 1 | -1): Promise<Uncertain | null> {
    this.stepped = this.stepped.then(() => this.take(by));
    return this.stepped;
  }

  private async take(by: 1 | -1): Promise<Uncertain | null> {
    const last = this.store.now.uncertain;
    const after = last ? (last.rank - 1 + by + last.of) % last.of : 0;
    const { cloud } = this.api;
    const isElsewhere = (): boolean => cloud !== this.api.cloud; // another one is looked at by now
    try {
      const place = await this.api.get<Uncertain>(`/api/uncertain?after=${after}`);
      if (isElsewhere()) return null;
      this.store.set({ uncertain: place });
      return place;
    } catch (error) {
      if (!isElsewhere()) this.words.warn((error as Error).message);
      return null;
    }
  }
}
