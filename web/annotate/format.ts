// Numbers as people read them.

export const count = (n: number): string => n.toLocaleString("en").replace(/,/g, "\u202f");

export const plural = (n: number, noun: string): string => `${count(n)} ${noun}${n === 1 ? "" : "s"}`;

export const percent = (share: number): string => `${(100 * share).toFixed(1)} %`;

export const seconds = (s: number): string => (s < 10 ? `${s.toFixed(2)} s` : `${s.toFixed(0)} s`);

/** A coordinate, to a thousandth of what it ranges over. */
export const coordinate = (value: number, range: number): string =>
  value.toFixed(Math.min(Math.max(3 - Math.floor(Math.log10(range || 1)), 0), 12));

/** A length with three digits; small ones are written as 6.89e-5, which fits where 0.0000689 does not. */
export const length = (value: number): string => {
  const rounded = Number(value.toPrecision(3));
  return rounded !== 0 && Math.abs(rounded) < 1e-3 ? rounded.toExponential() : String(rounded);
};

const STAGES: Record<string, string> = {
  read: "reading the file",
  neighbours: "finding neighbours",
  normals: "estimating normals",
  orientation: "orienting normals",
  prepare: "preparing descriptors",
  resolutions: "building the pyramid",
  describe: "computing descriptors",
  classify: "classifying",
};

/** What happens while a cloud is opened: a stage of the program's, or a sentence. */
export function stageText(stage: string, fraction: number): string {
  const name = STAGES[stage] ?? stage;
  return name.charAt(0).toUpperCase() + name.slice(1) + (fraction > 0 ? `, ${share(fraction)}` : "");
}

/** What happens while lines are searched. */
export const searchText = (stage: string, fraction: number): string =>
  `Finding lines${fraction > 0 ? `: ${stage}, ${share(fraction)}` : ""}`;

/** A part of a whole. */
export const share = (fraction: number): string => `${Math.round(100 * Math.min(Math.max(fraction, 0), 1))} %`;
