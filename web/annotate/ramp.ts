// Colours of numbers: 256 steps between a few stops, safe for the colour-blind.

import { rgbOf } from "../shared/colours";

export type RampName = "likely" | "likely-safe" | "sure" | "signed";

/** From the byte 0 to the byte 255. */
export const STOPS: Record<RampName, string[]> = {
  likely: ["#f4f2ee", "#ffc45d", "#d9571f", "#8e0000"],
  "likely-safe": ["#f4f2ee", "#f5c36b", "#4c86b8", "#003f8a"],
  sure: ["#5b2a86", "#c2549d", "#f2b1a0", "#f7f4ec"],
  signed: ["#1f4e8c", "#8fb6dc", "#f4f2ee", "#eaa15a", "#9a4300"],
};

/** 256 colours of four bytes. */
export function rampBytes(name: RampName): Uint8Array {
  const stops = STOPS[name].map(rgbOf);
  const bytes = new Uint8Array(1024);
  for (let i = 0; i < 256; ++i) {
    const at = (i / 255) * (stops.length - 1);
    const low = Math.min(Math.floor(at), stops.length - 2);
    for (let c = 0; c < 3; ++c) {
      bytes[4 * i + c] = Math.round(255 * (stops[low][c] + (at - low) * (stops[low + 1][c] - stops[low][c])));
    }
    bytes[4 * i + 3] = 255;
  }
  return bytes;
}
