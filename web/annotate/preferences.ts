// How the user likes to look at clouds and to paint, kept by the browser from one visit to the next.

import type { AppStore, State } from "./store";

const PLACE = "pcednet annotate";

type Preferences = Pick<State, "safePalette" | "theme" | "pointSize" | "brush" | "dxfArcs">;

const IS_FIT: { [K in keyof Preferences]: (value: unknown) => boolean } = {
  safePalette: (value) => typeof value === "boolean",
  theme: (value) => ["system", "light", "dark"].includes(value as string),
  pointSize: (value) => typeof value === "number" && value >= 0.3 && value <= 6,
  dxfArcs: (value) => ["all", "flat", "none"].includes(value as string),
  brush: (value) => typeof value === "number" && value > 0 && value < 1e6,
};
const KEYS = Object.keys(IS_FIT) as (keyof Preferences)[];

/** Those that a text holds; what is none of them is left out. */
export function readPreferences(text: string | null): Partial<Preferences> {
  let found: unknown;
  try {
    found = JSON.parse(text ?? "{}");
  } catch {
    return {};
  }
  const given = (found ?? {}) as Record<string, unknown>;
  return Object.fromEntries(KEYS.filter((key) => IS_FIT[key](given[key])).map((key) => [key, given[key]]));
}

/** Takes them up, and keeps them from now on; a browser may refuse that. */
export function keepPreferences(store: AppStore, storage: () => Pick<Storage, "getItem" | "setItem">): void {
  const attempt = (work: () => void): void => {
    try {
      work();
    } catch (error) {
      console.info("The page keeps no preferences:", error);
    }
  };
  attempt(() => store.set(readPreferences(storage().getItem(PLACE))));
  store.watch(KEYS, () =>
    attempt(() =>
      storage().setItem(PLACE, JSON.stringify(Object.fromEntries(KEYS.map((key) => [key, store.now[key]])))),
    ),
  );
}
