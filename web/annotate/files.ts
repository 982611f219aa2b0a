// What is saved beside the input, or downloaded.

import { h } from "../shared/dom";
import { ApiError, type Api } from "./api";
import { plural } from "./format";
import type { Words } from "./words";
import type { AppStore } from "./store";

export type Saved = "cloud" | "model" | "project" | "lines";

interface SavedFile {
  path: string;
  strokes_left_out: number;
}

/** What is said of a file whose model is older than what is painted. */
function lacking(what: Saved, left: string): string {
  const its = what === "model" ? "This model" : "The prediction in this cloud";
  return `${its} does not know ${left} yet. Save it again after the next training.`;
}

export class Files {
  constructor(
    private readonly api: Api,
    private readonly store: AppStore,
    private readonly words: Words,
  ) {}

  /** The path it went to; null if refused. `confirm` is asked before an older file of ours is replaced. */
  async save(what: Saved, cloud: number, confirm: (words: string) => Promise<boolean>): Promise<string | null> {
    const post = async (more = {}): Promise<string> => {
      const saved = await this.api.post<SavedFile>("/api/save", { what, cloud, ...more });
      if (saved.strokes_left_out > 0) this.words.warn(lacking(what, plural(saved.strokes_left_out, "stroke")));
      return saved.path;
    };
    this.store.set({ saving: true });
    try {
      return await post();
    } catch (error) {
      const taken = error instanceof ApiError && error.status === 409 && error.message.endsWith(" exists");
      if (!taken || !(await confirm((error as Error).message))) {
        if (!taken) this.words.warn((error as Error).message);
        return null;
      }
      return await post({ overwrite: true }).catch((problem: Error) => {
        this.words.warn(problem.message);
        return null;
      });
    } finally {
      this.store.set({ saving: false });
    }
  }

  /** For a download that begins now: of a run, it may lack strokes. */
  downloadAddress(what: Saved, query = ""): string {
    const isOfRun = what === "model" || what === "cloud";
    if (isOfRun && this.store.now.hasPrediction && this.store.now.outOfDate) {
      this.words.warn(lacking(what, "the last strokes"));
    }
    return this.api.address(`/api/download/${what}${query}`);
  }

  download(what: Saved, query: string): void {
    h("a", { href: this.downloadAddress(what, query), download: "" }).click();
  }
}
