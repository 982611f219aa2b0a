// A cloud to annotate: a stepped roof of flat faces whose sharp edges are known, and where to paint on it.
import fs from "node:fs";

const POINTS = 40_000;
const BAND = 2.5; // spacings from an edge that count as it

/** Faces: corner, two sides, outward normal. Ground, a box on it, a gable on the box. */
function faces() {
  const box = (x0, y0, x1, y1, z0, z1) => [
    { at: [x0, y0, z0], u: [x1 - x0, 0, 0], v: [0, 0, z1 - z0], n: [0, -1, 0] },
    { at: [x0, y1, z0], u: [x1 - x0, 0, 0], v: [0, 0, z1 - z0], n: [0, 1, 0] },
    { at: [x0, y0, z0], u: [0, y1 - y0, 0], v: [0, 0, z1 - z0], n: [-1, 0, 0] },
    { at: [x1, y0, z0], u: [0, y1 - y0, 0], v: [0, 0, z1 - z0], n: [1, 0, 0] },
    { at: [x0, y0, z1], u: [x1 - x0, 0, 0], v: [0, y1 - y0, 0], n: [0, 0, 1] },
  ];
  return [...box(0, 0, 2, 1.4, 0, 0.6), ...box(0.4, 0.3, 1.2, 1.1, 0.6, 1.1)];
}

/** The edges where two of the faces meet at right angles. */
function edges() {
  const of = (x0, y0, x1, y1, z0, z1, foot) => {
    const corners = [
      [x0, y0],
      [x1, y0],
      [x1, y1],
      [x0, y1],
    ];
    return corners.flatMap(([x, y], i) => {
      const [nx, ny] = corners[(i + 1) % 4];
      return [
        [
          [x, y, z0],
          [x, y, z1],
        ],
        [
          [x, y, z1],
          [nx, ny, z1],
        ],
        ...(foot
          ? [
              [
                [x, y, z0],
                [nx, ny, z0],
              ],
            ]
          : []),
      ];
    });
  };
  return [...of(0, 0, 2, 1.4, 0, 0.6, false), ...of(0.4, 0.3, 1.2, 1.1, 0.6, 1.1, true)];
}

function distance(p, [a, b]) {
  const d = b.map((c, i) => c - a[i]);
  const t = Math.min(
    Math.max(d.reduce((s, c, i) => s + c * (p[i] - a[i]), 0) / d.reduce((s, c) => s + c * c, 0), 0),
    1,
  );
  return Math.hypot(...p.map((c, i) => c - a[i] - t * d[i]));
}

const cross = (a, b) => Math.hypot(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);

/** Points drawn by area, 0.012 apart: position, normal, sharp or not. The same every time. */
export function roof() {
  let state = 7;
  const next = () => (state = (Math.imul(state, 1664525) + 1013904223) >>> 0) / 2 ** 32;
  const all = faces();
  const areas = all.map(({ u, v }) => cross(u, v));
  const total = areas.reduce((a, b) => a + b, 0);
  const spacing = Math.sqrt(total / POINTS);
  const lines = edges();
  const points = [];
  all.forEach(({ at, u, v, n }, f) => {
    for (let k = Math.round((POINTS * areas[f]) / total); k > 0; --k) {
      const [s, t] = [next(), next()];
      const p = at.map((c, i) => c + s * u[i] + t * v[i]);
      // Below the upper box there is no roof.
      if (f === 4 && p[0] > 0.4 && p[0] < 1.2 && p[1] > 0.3 && p[1] < 1.1) continue;
      points.push({ p, n, sharp: lines.some((line) => distance(p, line) < BAND * spacing) });
    }
  });
  return points;
}

export function writeRoof(file, points, type = "float") {
  const head = [
    "ply",
    "format ascii 1.0",
    `element vertex ${points.length}`,
    ...["x", "y", "z", "nx", "ny", "nz"].map((name) => `property ${type} ${name}`),
    "end_header",
  ];
  fs.writeFileSync(
    file,
    [...head, ...points.map(({ p, n }) => [...p.map((c) => c.toFixed(5)), ...n].join(" ")), ""].join("\n"),
  );
}

const between = (a, b, steps) =>
  Array.from({ length: steps + 1 }, (_, k) => a.map((c, i) => c + (k / steps) * (b[i] - c)));

/** Strokes seen from the first view (from the front, the left and above): along edges, and on faces. */
export const painted = {
  sharp: [
    between([0.3, 0, 0.6], [1.7, 0, 0.6], 12),
    between([0, 0.2, 0.6], [0, 1.2, 0.6], 10),
    between([0.5, 0.3, 1.1], [1.1, 0.3, 1.1], 8),
    between([0.5, 0.3, 0.6], [1.1, 0.3, 0.6], 8),
  ],
  flat: [
    // Right beside the edges, so that these become no wider than they are.
    between([0.3, 0, 0.52], [1.7, 0, 0.52], 12),
    between([0.5, 0.3, 1.02], [1.1, 0.3, 1.02], 8),
    between([0.3, 0.08, 0.6], [1.7, 0.08, 0.6], 12),
    between([0.3, 0, 0.3], [1.7, 0, 0.3], 6),
    between([1.4, 0.12, 0.6], [1.8, 0.5, 0.6], 5),
    between([0.55, 0.45, 1.1], [1.05, 0.6, 1.1], 5),
    between([0.2, 0.2, 0.6], [0.2, 0.7, 0.6], 5),
  ],
};

const BYTES = {
  double: 8,
  float: 4,
  float64: 8,
  float32: 4,
  int: 4,
  uint: 4,
  uchar: 1,
  uint8: 1,
  char: 1,
  ushort: 2,
  short: 2,
};

/** A binary little-endian PLY of one element; `column(name)` gives its numbers. */
export function readPly(file) {
  const bytes = fs.readFileSync(file);
  const end = bytes.indexOf("end_header\n") + "end_header\n".length;
  const lines = bytes.subarray(0, end).toString("latin1").split("\n");
  const count = Number(/element vertex (\d+)/.exec(lines.join("\n"))[1]);
  const fields = lines.filter((line) => line.startsWith("property ")).map((line) => line.split(" ").slice(1));
  const row = fields.reduce((sum, [type]) => sum + BYTES[type], 0);
  return {
    column(name) {
      const index = fields.findIndex((field) => field[1] === name);
      if (index < 0) throw new Error(`${file} has no ${name}`);
      const type = fields[index][0];
      const offset = end + fields.slice(0, index).reduce((sum, [t]) => sum + BYTES[t], 0);
      return Array.from({ length: count }, (_, i) => {
        const at = offset + i * row;
        return type === "float" || type === "float32"
          ? bytes.readFloatLE(at)
          : type === "double" || type === "float64"
            ? bytes.readDoubleLE(at)
            : bytes.readUIntLE(at, BYTES[type]);
      });
    },
  };
}
