// What is saved beside the input, or downloaded.

import { h } from "../shared/dom";
import { ApiError, type Api } from "./api";
import type { Words } from "./client";
import type { AppStore } from "./store";

export type Saved = "cloud" | "model" | "project" | "lines";

export class Files {
  constructor(
    private readonly api: Api,
    private readonly store: AppStore,
    private readonly words: Words,
  ) {}

  /** The path it went to; null if refused. `confirm` is asked before an older file of ours is replaced. */
  async save(what: Saved, cloud: number, confirm: (words: string) => Promise<boolean>): Promise<string | null> {
    this.store.set({ saving: true });
    try {
      return (await this.api.post<{ path: string }>("/api/save", { what, cloud })).path;
    } catch (error) {
      const taken = error instanceof ApiError && error.status === 409 && error.message.endsWith(" exists");
      if (!taken || !(await confirm((error as Error).message))) {
        if (!taken) this.words.warn((error as Error).message);
        return null;
      }
      return await this.api.post<{ path: string }>("/api/save", { what, cloud, overwrite: true }).then(
        ({ path }) => path,
        (problem: Error) => {
          this.words.warn(problem.message);
          return null;
        },
      );
    } finally {
      this.store.set({ saving: false });
    }
  }

  downloadAddress(what: Saved, query = ""): string {
    return this.api.address(`/api/download/${what}${query}`);
  }

  download(what: Saved, query: string): void {
    h("a", { href: this.downloadAddress(what, query), download: "" }).click();
  }
}
