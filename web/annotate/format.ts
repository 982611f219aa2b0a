// Numbers as people read them.

export const count = (n: number): string => n.toLocaleString("en").replace(/,/g, "\u202f");

export const percent = (share: number): string => `${(100 * share).toFixed(1)} %`;

export const seconds = (s: number): string => (s < 10 ? `${s.toFixed(2)} s` : `${s.toFixed(0)} s`);

/** A length with three digits. */
export const length = (value: number): string => String(Number(value.toPrecision(3)));

/** What happens while a cloud is opened. */
export const share = (fraction: number): string => `${Math.round(100 * Math.min(Math.max(fraction, 0), 1))} %`;
