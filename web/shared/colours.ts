// What colour means what.

export interface Meaning {
  name: string;
  colour: string;
}

/** Where the surface ends. */
export const BOUNDARY = 3;

/** What stands for no class in CLASS_PALETTES. */
export const NO_LABEL = 4;

/** By class: 0 non-edge, 1 smooth-edge, 2 sharp-edge, 3 boundary; then NO_LABEL. */
export const CLASS_PALETTES: Record<"paper" | "safe", Meaning[]> = {
  paper: [
    { name: "non-edge", colour: "#ffffff" },
    { name: "smooth edge", colour: "#ffc45d" },
    { name: "sharp edge", colour: "#a80000" },
    { name: "boundary", colour: "#0052a5" },
    { name: "no label", colour: "#8f96a0" },
  ],
  // Told apart by lightness alone as well: white, orange, green, dark blue.
  safe: [
    { name: "non-edge", colour: "#ffffff" },
    { name: "smooth edge", colour: "#f5a300" },
    { name: "sharp edge", colour: "#003f8a" },
    { name: "boundary", colour: "#1a9e77" },
    { name: "no label", colour: "#8f96a0" },
  ],
};

/** Agreement about the positive class, safe for the colour-blind: right is grey, wrong is coloured. */
export const ERROR_PALETTE: Meaning[] = [
  { name: "true negative", colour: "#ffffff" },
  { name: "true positive", colour: "#20242a" },
  { name: "false positive", colour: "#ee7a1a" },
  { name: "false negative", colour: "#1f78d1" },
  { name: "no label", colour: "#8f96a0" },
];

/** Colours for methods in charts, readable on light and on dark paper. */
const SERIES = [
  "#b5342b",
  "#2f78b7",
  "#2d936c",
  "#d08a14",
  "#8657a8",
  "#4aa5b8",
  "#c25c96",
  "#7d8a2e",
  "#8a6a4f",
  "#6c7686",
  "#e0703a",
  "#4c5fc4",
];

export const seriesColour = (index: number): string => SERIES[index % SERIES.length];

export function rgbOf(colour: string): [number, number, number] {
  const number = parseInt(colour.slice(1), 16);
  return [(number >> 16) / 255, ((number >> 8) & 255) / 255, (number & 255) / 255];
}
