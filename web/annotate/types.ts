// What the server says: the shapes of its answers.

export type Vec3 = [number, number, number];

export interface Box {
  min: Vec3;
  max: Vec3;
}

/** A cube of the octree; its points add to those of its ancestors. */
export interface NodeInfo {
  id: number;
  centre: Vec3;
  half: number;
  points: number;
  children: number[];
  spacing: number;
}

export interface ClassInfo {
  id: number;
  name: string;
  /** 0 to 255. */
  colour: Vec3;
  count: number;
  /** By the user: it is there for strokes that undo brings back. */
  removed?: boolean;
}

/** A class that points have in the file: of its labels, or of LAS. */
export interface FileClass {
  id: number;
  name: string;
  /** 0 to 255. */
  colour: Vec3;
  points: number;
}

/** The project's classes: all that can be painted; where own classes follow those of edges, boundary too. */
export interface Classes {
  classes: ClassInfo[];
  /** Whether the first are those of edges, of which lines and boundary are. */
  edges: boolean;
}

/** "random", or a model's name. */
export type Start = string;

/** How a run does on strokes that it was not trained on. */
export interface HeldOut {
  strokes: number;
  /** Null: too few strokes to tell. */
  accuracy: number | null;
  /** That of the model that it started from. */
  start: number | null;
}

export interface Settings {
  classes: 2 | 3;
  auto: boolean;
  start: Start;
  seed: number;
}

export interface Run {
  run: number;
  seconds_train: number | null;
  seconds_classify: number | null;
  loss: number | null;
  /** Null as long as it is not known. */
  held_out: HeldOut | null;
  painted: number | null;
  start: Start;
  classes: number | null;
  current: boolean;
  time: string;
}

/** One of the clouds that are trained on together. */
export interface CloudInfo {
  file: string;
  points: number;
  painted: number;
}

export interface Session extends Classes {
  name: string;
  file: string;
  clouds: CloudInfo[];
  /** The number of the one that the rest is about. */
  cloud: number;
  points: number;
  origin: Vec3;
  bounds: Box;
  spacing: number;
  has_colours: boolean;
  normals: "file" | "estimated";
  state: "loading" | "ready";
  stage: string;
  features: string[];
  scales: number[];
  settings: Settings;
  /** What settings.start may be besides "random". */
  starts: Start[];
  nodes: NodeInfo[];
  /** None if the file has none. */
  file_labels: FileClass[];
  /** They are predictions of pcednet: to look at, not to paint from. */
  file_predicted: boolean;
  las_classes: FileClass[];
  /** What the user should know of the cloud. */
  notes: string[];
  strokes: number;
  undo: number;
  redo: number;
  run: Run | null;
  writer: boolean;
  /** Strokes are newer than the current run. */
  out_of_date: boolean;
  /** Whether this start of the program knows the window. */
  known: boolean;
  prediction_version: number;
  labels_version: number;
}

/** The answer to a stroke, an undo, a redo. */
export interface Painted {
  changed?: number;
  cloud: number;
  /** By class, of all clouds. */
  counts: number[];
  /** Points of each cloud. */
  painted: number[];
  labels_version: number;
  nodes: number[];
  undo: number;
  redo: number;
}

export interface Uncertain {
  rank: number;
  position: Vec3;
  normal: Vec3;
  confidence: number;
  /** Class. */
  prediction: number;
  of: number;
}

export interface TrainingEvent {
  run: number;
  epoch: number;
  epochs: number;
  /** Of the context network, which trains last. */
  context: boolean;
  loss: number;
}

export interface PredictionEvent {
  prediction_version: number;
  run: number;
  out_of_date: boolean;
  seconds_train: number | null;
  seconds_classify: number | null;
}

export type Decision = "open" | "accepted" | "rejected";

/** An edge as a curve. */
export interface Line {
  kind: "segment" | "arc" | "circle" | "polyline";
  class: number;
  length: number;
  confidence: number;
  /** Between the normals of its surfaces, degrees. */
  angle: number;
  /** That it stands for. */
  points: number;
  decision: Decision;
  middle: Vec3;
  normal: Vec3;
  /** Vertices: x, y, z, x, y, z, ... */
  path: number[];
}

export interface Lines {
  version: number;
  prediction_version: number;
  searching: boolean;
  /** Left out: the first. */
  cloud?: number;
  lines: Line[];
}

export interface LinesEvent {
  cloud: number;
  version: number;
  searching: boolean;
}

/** Decisions of any window. */
export interface DecidedEvent {
  cloud: number;
  version: number;
  decision: Decision;
  lines: number[];
}

interface StrokeCommon {
  id: string;
  /** Its number; left out where there is one. */
  cloud?: number;
  /** 255 erases. */
  class: number;
  protect: boolean;
  hidden: number[];
  clip: Box | null;
}

export interface BrushStroke extends StrokeCommon {
  tool: "brush";
  centres: Vec3[];
  radius: number;
}

export interface PolygonStroke extends StrokeCommon {
  tool: "polygon";
  /** In clip space, -1..1. */
  polygon: [number, number][];
  /** Local to clip, column-major. */
  matrix: number[];
  front_only: boolean;
  point_size: number;
  viewport: [number, number];
}

/** The points that have the class in the file. */
export interface FileStroke extends StrokeCommon {
  tool: "file";
}

export type Stroke = BrushStroke | PolygonStroke | FileStroke;

export const NO_CLASS = 255;
