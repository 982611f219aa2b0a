// From the texts of a packed scene back to numbers.

export function bytesOf(base64: string): Uint8Array {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

/** Three little-endian uint16 a point. */
export function positionsOf(base64: string): Uint16Array {
  const bytes = bytesOf(base64);
  const numbers = new Uint16Array(bytes.length / 2);
  for (let i = 0; i < numbers.length; ++i) numbers[i] = bytes[2 * i] | (bytes[2 * i + 1] << 8);
  return numbers;
}

/** A class a point, as CLASS_PALETTES has them. */
export function classesOf(base64: string, count: number): Uint8Array {
  const bytes = bytesOf(base64);
  const classes = new Uint8Array(count);
  for (let i = 0; i < count; ++i) classes[i] = (bytes[i >> 1] >> (4 * (i & 1))) & 15;
  return classes;
}
