// What the page shows, in one place; those who show it watch it.

import type { Box, ClassInfo, CloudInfo, Lines, Run, Session, Settings, Uncertain, Vec3 } from "./types";

export type Tool = "navigate" | "brush" | "lasso" | "polygon" | "measure";
export type ColourMode =
  | "rgb"
  | "normals"
  | "file"
  | "las"
  | "errors"
  | "labels"
  | "prediction"
  | "confidence"
  | "p_sharp"
  | "feature";

/** Which arcs and circles are such in DXF; the others are polylines. */
export type DxfArcs = "all" | "flat" | "none";

export type Theme = "system" | "light" | "dark";

/** The curves of the run that is under way or was last. */
export interface Training {
  run: number;
  active: boolean;
  epochs: number;
  epoch: number[];
  /** By epoch; null where the context network trains. */
  loss: (number | null)[];
  /** The same of the context network, which trains last. */
  context: (number | null)[];
}

export interface Clip {
  on: boolean;
  box: Box;
}

export interface State {
  session: Session | null;
  clouds: CloudInfo[];
  /** The number of the cloud that is looked at. */
  cloud: number;
  progress: { stage: string; fraction: number } | null;
  /** Nothing of the cloud is here yet. */
  fetching: boolean;
  connected: boolean;
  /** Another start of the program answers, which does not know this page. */
  restarted: boolean;
  /** The graphics card was taken away. */
  contextLost: boolean;
  /** Strokes that wait for the program to come back. */
  waiting: number;
  writer: boolean;
  tool: Tool;
  classes: ClassInfo[];
  /** The first classes are those of edges. */
  edges: boolean;
  /** Of `classes`, or 255: the eraser. */
  paintClass: number;
  /** Of the brush, in units of the cloud. */
  radius: number;
  /** The same in spacings of the cloud: as large the brush is in another one. */
  brush: number;
  protect: boolean;
  frontOnly: boolean;
  hidden: ReadonlySet<number>;
  clip: Clip | null;
  mode: ColourMode;
  feature: number;
  scale: number;
  paintOnTop: boolean;
  safePalette: boolean;
  pointSize: number;
  eyeDome: boolean;
  orthographic: boolean;
  theme: Theme;
  /** The places between which a distance is measured: none, one or two. */
  measured: Vec3[];
  /** Painted points by class. */
  counts: number[];
  undo: number;
  redo: number;
  saving: boolean;
  settings: Settings;
  runs: Run[];
  training: Training | null;
  /** There is one to show. */
  hasPrediction: boolean;
  uncertain: Uncertain | null;
  predictionVersion: number;
  /** Strokes that the prediction does not know yet. */
  outOfDate: boolean;
  lines: Lines;
  /** The next search is for boundaries, too. */
  boundaries: boolean;
  /** The number of the line that is looked at. */
  line: number | null;
  showLines: boolean;
  dxfArcs: DxfArcs;
  /** How far the search for lines is, in words. */
  searchStage: string;
}

export const initialState: State = {
  session: null,
  clouds: [],
  cloud: 0,
  progress: { stage: "Connecting", fraction: 0 },
  fetching: false,
  connected: true,
  restarted: false,
  contextLost: false,
  waiting: 0,
  writer: false,
  tool: "brush",
  classes: [],
  edges: true,
  paintClass: 2,
  radius: 1,
  brush: 1.75, // thin enough for an edge
  protect: false,
  frontOnly: true,
  hidden: new Set(),
  clip: null,
  mode: "labels",
  feature: 0,
  scale: 8,
  paintOnTop: true,
  safePalette: false,
  pointSize: 1.7,
  eyeDome: false,
  orthographic: false,
  theme: "system",
  measured: [],
  counts: [0, 0, 0],
  undo: 0,
  redo: 0,
  saving: false,
  settings: { classes: 3, auto: true, start: "random", seed: 1 },
  runs: [],
  training: null,
  hasPrediction: false,
  uncertain: null,
  predictionVersion: 0,
  outOfDate: false,
  boundaries: false,
  lines: { version: 0, prediction_version: 0, searching: false, cloud: 0, lines: [] },
  line: null,
  showLines: true,
  dxfArcs: "all",
  searchStage: "",
};

export class Store<T extends object> {
  private readonly watchers: { keys: (keyof T)[]; tell: () => void }[] = [];

  constructor(public now: Readonly<T>) {}

  set(changes: Partial<T>): void {
    const changed = (Object.keys(changes) as (keyof T)[]).filter((key) => this.now[key] !== changes[key]);
    if (changed.length === 0) return;
    this.now = { ...this.now, ...changes };
    for (const { keys, tell } of this.watchers) if (keys.some((key) => changed.includes(key))) tell();
  }

  /** Calls `tell` now and whenever one of the keys has changed. */
  watch(keys: (keyof T)[], tell: () => void): void {
    this.watchers.push({ keys, tell });
    tell();
  }
}

export type AppStore = Store<State>;

/** The clip box if it is in use; a face that is on the cloud's bounds cuts nothing off, however coordinates are rounded. */
export function activeClip({ clip, session }: Pick<State, "clip" | "session">): Box | null {
  if (!clip?.on || !session) return null;
  const { min, max } = structuredClone(clip.box);
  const { bounds } = session;
  for (let axis = 0; axis < 3; ++axis) {
    const extent = bounds.max[axis] - bounds.min[axis];
    const room = 0.01 * Math.max(extent, session.spacing);
    if (min[axis] <= bounds.min[axis]) min[axis] -= room;
    if (max[axis] >= bounds.max[axis]) max[axis] += room;
  }
  return { min, max };
}
