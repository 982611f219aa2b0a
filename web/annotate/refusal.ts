// Why this window cannot paint now.

import { NO_ANSWER } from "./api";
import type { State } from "./store";

const READ_ONLY = "Another window is painting this cloud. Take over to paint here.";

export const NOTHING_PAINTED = `${NO_ANSWER}: nothing can be painted.`;

/** Empty if it can. */
export const refusalOf = ({ writer, connected }: Pick<State, "writer" | "connected">): string =>
  !connected ? NOTHING_PAINTED : writer ? "" : READ_ONLY;
