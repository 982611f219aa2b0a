// The annotator's pure functions, in node: normals, projection, level of detail, picking, painting.
// Environment: PCEDNET_SOURCE_DIR the repository.
import assert from "node:assert/strict";
import { test } from "node:test";

import { load } from "./bundle.mjs";

const {
  geometry,
  detail,
  chunk,
  classes,
  paint,
  ramp,
  budget,
  commands,
  fingers,
  format,
  reviewer,
  clip_handles,
  measure,
  store,
} = await load(
  "geometry",
  "detail",
  "chunk",
  "classes",
  "paint",
  "ramp",
  "budget",
  "commands",
  "fingers",
  "format",
  "reviewer",
  "clip_handles",
  "measure",
  "store",
);

/** Numbers in 0..1 by a linear congruential generator. */
function random(seed) {
  let state = seed >>> 0;
  return () => (state = (Math.imul(state, 1664525) + 1013904223) >>> 0) / 2 ** 32;
}

/** Column-major perspective that looks along -z from (0, 0, distance), as OpenGL's. */
function looking(distance, aspect = 1, focal = 2) {
  const [near, far] = [0.1, 100];
  return [
    focal / aspect,
    0,
    0,
    0,
    0,
    focal,
    0,
    0,
    0,
    0,
    -(far + near) / (far - near),
    -1,
    0,
    0,
    (distance * (far + near) - 2 * far * near) / (far - near),
    distance,
  ];
}

/** The encoder, from its definition: onto the octahedron, lower half folded over. */
function encode([x, y, z]) {
  const sum = Math.abs(x) + Math.abs(y) + Math.abs(z);
  const [u, v] = [x / sum, y / sum];
  if (z >= 0) return [u, v];
  return [(1 - Math.abs(v)) * (u < 0 ? -1 : 1), (1 - Math.abs(u)) * (v < 0 ? -1 : 1)];
}

/** A chunk of the cube -1..1 with points and normals as the server sends them. */
function chunkOf(points, normals, info = {}) {
  const n = points.length;
  const bytes = Buffer.alloc(8 * n);
  points.forEach((p, i) => p.forEach((c, a) => bytes.writeUInt16LE(Math.round(((c + 1) / 2) * 65535), 6 * i + 2 * a)));
  normals.forEach((m, i) => encode(m).forEach((c, a) => bytes.writeInt8(Math.round(c * 127), 6 * n + 2 * i + a)));
  const node = { id: 0, centre: [0, 0, 0], half: 1, points: n, children: [], spacing: 0.1, ...info };
  return chunk.decodeChunk(node, bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), false);
}

const plain = { hidden: new Set(), clip: null };

test("octahedral normals come back from 8 bits within two degrees", () => {
  const next = random(1);
  for (let i = 0; i < 2000; ++i) {
    const p = [next() - 0.5, next() - 0.5, next() - 0.5];
    const n = p.map((c) => c / Math.hypot(...p));
    const back = geometry.octahedral(...encode(n).map((c) => Math.round(c * 127) / 127));
    assert.ok(Math.abs(Math.hypot(...back) - 1) < 1e-12);
    assert.ok(geometry.dot(n, back) > Math.cos((2 * Math.PI) / 180), `${n} became ${back}`);
  }
  assert.deepEqual(geometry.octahedral(0, 0), [0, 0, 1]);
});

test("a matrix of a cube's own coordinates projects as the points themselves", () => {
  const matrix = looking(5);
  const [centre, half] = [[0.3, -0.2, 0.7], 0.4];
  const own = geometry.fromCube(matrix, centre, half);
  const u = [65535, 0, 32768];
  const p = u.map((c, a) => centre[a] - half + (c / 65535) * 2 * half);
  geometry.project(own, u).forEach((c, i) => assert.ok(Math.abs(c - geometry.project(matrix, p)[i]) < 1e-12));
});

test("the planes of the view tell inside from outside as the projection does", () => {
  const matrix = looking(4, 1.5);
  const planes = geometry.viewPlanes(matrix);
  const next = random(2);
  let inside = 0;
  for (let i = 0; i < 3000; ++i) {
    const p = [0, 1, 2].map(() => 8 * next() - 4);
    const [x, y, z, w] = geometry.project(matrix, p);
    const seen = Math.abs(x) < w && Math.abs(y) < w && z > -w;
    inside += Number(seen);
    assert.equal(
      planes.every(([a, b, c, d]) => a * p[0] + b * p[1] + c * p[2] + d > 0),
      seen,
    );
  }
  assert.ok(inside > 100 && inside < 2900);
});

test("a point in a polygon is told by its winding too", () => {
  const star = Array.from({ length: 10 }, (_, k) => {
    const r = k % 2 ? 0.3 : 0.9;
    return [r * Math.sin((k * Math.PI) / 5), r * Math.cos((k * Math.PI) / 5)];
  });
  const winds = (x, y) =>
    Math.abs(
      star.reduce((sum, [ax, ay], i) => {
        const [bx, by] = star[(i + 1) % star.length];
        return sum + Math.atan2((ax - x) * (by - y) - (ay - y) * (bx - x), (ax - x) * (bx - x) + (ay - y) * (by - y));
      }, 0),
    ) > 1;
  const next = random(3);
  for (let i = 0; i < 2000; ++i) {
    const [x, y] = [2 * next() - 1, 2 * next() - 1];
    assert.equal(geometry.inPolygon(x, y, star), winds(x, y));
  }
});

/** An octree of the cube -1..1 with three levels and equal shares. */
function tree() {
  const nodes = [];
  const add = (centre, half, level) => {
    const node = { id: nodes.length, centre, half, points: 1000, children: [], spacing: 1 };
    nodes.push(node);
    if (level < 2) {
      for (let k = 0; k < 8; ++k) {
        node.children.push(
          add(
            centre.map((c, a) => c + ((k >> a) & 1 ? 0.5 : -0.5) * half),
            half / 2,
            level + 1,
          ),
        );
      }
    }
    return node.id;
  };
  add([0, 0, 0], 1, 0);
  return nodes;
}

test("spacings follow how many of the points are drawn", () => {
  const nodes = detail.withSpacings(tree(), 0.01);
  // The root draws 1000 of 73000; a child 125 of the root's and 1000 of its own, of 125 + 9000.
  assert.ok(Math.abs(nodes.get(0).spacing - 0.01 * Math.sqrt(73)) < 1e-9);
  assert.ok(Math.abs(nodes.get(nodes.get(0).children[3]).spacing - 0.01 * Math.sqrt(9125 / 1125)) < 1e-9);
  const leaf = [...nodes.values()].find((node) => node.children.length === 0);
  assert.ok(Math.abs(leaf.spacing - 0.01) < 1e-9, "with all ancestors a leaf is all there is");
});

test("the choice of nodes keeps to its budget, parents first, and drops what is out of view", () => {
  const nodes = detail.withSpacings(tree(), 0.01);
  const view = { matrix: looking(4), eye: [0, 0, 4], pixels: 1000 };
  for (const wanted of [300, 1000, 5500, 73000]) {
    const taken = detail.selectNodes(nodes, view, { budget: wanted });
    assert.equal(
      taken.reduce((sum, take) => sum + take.points, 0),
      wanted,
    );
    const seen = new Set();
    for (const { id } of taken) {
      const parent = [...nodes.values()].find((node) => node.children.includes(id));
      assert.ok(!parent || seen.has(parent.id));
      seen.add(id);
    }
  }
  const near = detail.selectNodes(nodes, { ...view, matrix: looking(1.2), eye: [0, 0, 1.2] }, { budget: 1e6 });
  assert.ok(near.length < 73, "from near some cubes are beside the view");
  const clipped = detail.selectNodes(nodes, view, {
    budget: 1e6,
    clip: { min: [0.6, 0.6, 0.6], max: [0.9, 0.9, 0.9] },
  });
  assert.equal(clipped.length, 3);
  assert.equal(
    detail.selectNodes(nodes, { ...view, pixels: 1 }, { budget: 1e6 }).length,
    1,
    "far away the root is enough",
  );
  const backwards = looking(4).map((v, i) => (i % 4 === 3 || i % 4 === 2 ? -v : v));
  assert.equal(detail.selectNodes(nodes, { ...view, matrix: backwards }, { budget: 1e6 }).length, 0);
});

test("where children are drawn the points of their parent shrink", () => {
  const nodes = detail.withSpacings(tree(), 0.01);
  const child = nodes.get(0).children[5];
  const spacings = detail.drawnSpacings(nodes, [
    { id: 0, points: 1000 },
    { id: child, points: 1000 },
  ]);
  const root = spacings.get(0);
  assert.equal(detail.octantOf([0, 0, 0], nodes.get(child).centre), 5);
  assert.ok(root[5] < root[4]);
  assert.ok(Math.abs(root[5] - nodes.get(child).spacing) < 1e-6);
  const half = detail.drawnSpacings(nodes, [{ id: 0, points: 250 }]).get(0);
  assert.ok(Math.abs(half[0] / nodes.get(0).spacing - 2) < 1e-6, "a quarter of the points, twice as far apart");
});

test("bytes of the wrong number are refused", () => {
  const info = { id: 7, centre: [0, 0, 0], half: 1, points: 3, children: [], spacing: 1 };
  assert.throws(() => chunk.decodeChunk(info, new ArrayBuffer(23), false), /node 7: 23 bytes, not 24/);
  assert.equal(chunk.decodeChunk(info, new ArrayBuffer(33), true).colours.length, 9);
});

/** Two walls at z = 0.5 and z = -0.5, facing up and down. */
function walls() {
  const points = [],
    normals = [];
  for (const z of [0.5, -0.5]) {
    for (let i = 0; i < 41; ++i) {
      for (let j = 0; j < 41; ++j) {
        points.push([-0.8 + 0.04 * i, -0.8 + 0.04 * j, z]);
        normals.push([0, 0, Math.sign(z)]);
      }
    }
  }
  return chunkOf(points, normals);
}

test("picking finds the wall in front, and the one behind where the first is clipped or hidden", () => {
  const c = walls();
  const n = c.labels.length;
  const view = { matrix: looking(4), halfWidth: 300, halfHeight: 300, pixels: 600, reach: 6 };
  for (const target of [
    [0, 0],
    [0.4, -0.24],
    [-0.6, 0.6],
  ]) {
    const [x, y, , w] = geometry.project(view.matrix, [...target, 0.5]);
    const at = { ...view, ...plain, x: x / w, y: y / w };
    const front = chunk.pick([{ chunk: c, points: n }], at);
    front.position.forEach((v, a) => assert.ok(Math.abs(v - [...target, 0.5][a]) < 1e-3));
    assert.ok(front.normal[2] > 0.99);
    const behind = chunk.pick([{ chunk: c, points: n }], {
      ...at,
      reach: 12,
      clip: { min: [-1, -1, -1], max: [1, 1, 0] },
    });
    assert.ok(Math.abs(behind.position[2] + 0.5) < 1e-3);
  }
  c.prediction.fill(1, 0, n / 2);
  const through = chunk.pick([{ chunk: c, points: n }], {
    ...view,
    x: 0,
    y: 0,
    reach: 12,
    hidden: new Set([1]),
    clip: null,
  });
  assert.ok(Math.abs(through.position[2] + 0.5) < 1e-3);
  assert.equal(chunk.pick([{ chunk: c, points: n }], { ...view, ...plain, x: 0.95, y: 0.95 }), null);
  assert.equal(
    chunk.pick([{ chunk: c, points: n / 2 }], { ...view, x: 0, y: 0, hidden: new Set([1]), clip: null }),
    null,
    "points that are not drawn are not picked",
  );
});

test("the brush paints a ball of one side, as measured point by point", () => {
  const c = walls();
  const options = { class: 2, protect: false, ...plain };
  const centre = [0.2, 0.2, 0.5];
  assert.ok(paint.paintBall(c, centre, [0, 0, 1], 1.1, options));
  for (let i = 0; i < c.labels.length; ++i) {
    const p = chunk.pointAt(c, i);
    const away = Math.hypot(...p.map((v, a) => v - centre[a]));
    if (Math.abs(away - 1.1) > 1e-3) assert.equal(c.labels[i], away < 1.1 && p[2] > 0 ? 2 : 255);
  }
  assert.ok(!paint.paintBall(c, centre, [0, 0, 1], 1.1, options), "nothing is left to change");
  assert.ok(!paint.paintBall(c, centre, [0, 0, 1], 0.5, { ...options, class: 0, protect: true }));
  assert.ok(paint.paintBall(c, centre, [0, 0, 1], 0.5, { ...options, class: 255 }), "the eraser");
  assert.ok(!paint.paintBall(c, [5, 5, 5], [0, 0, 1], 0.5, options));
});

test("a polygon paints through to the back, unless front only", () => {
  for (const front of [false, true]) {
    const c = walls();
    const stroke = {
      matrix: looking(4),
      polygon: [
        [-0.3, -0.3],
        [0.3, -0.3],
        [0.3, 0.3],
        [-0.3, 0.3],
      ],
      front_only: front,
      point_size: 16,
      viewport: [300, 300],
    };
    assert.deepEqual(paint.paintPolygon([c], stroke, { class: 1, protect: false, ...plain }), [c]);
    let [near, far] = [0, 0];
    c.labels.forEach((label, i) => {
      const [x, y, , w] = geometry.project(stroke.matrix, chunk.pointAt(c, i));
      const within = Math.max(Math.abs(x / w), Math.abs(y / w)) < 0.2999;
      if (label === 1) chunk.pointAt(c, i)[2] > 0 ? ++near : ++far;
      if (within && chunk.pointAt(c, i)[2] > 0) assert.equal(label, 1);
    });
    assert.ok(near > 100);
    assert.equal(far > 0, !front);
  }
});

test("ramps begin and end with their stops", () => {
  for (const [name, stops] of Object.entries(ramp.STOPS)) {
    const bytes = ramp.rampBytes(name);
    const hex = (i) => `#${[0, 1, 2].map((c) => bytes[4 * i + c].toString(16).padStart(2, "0")).join("")}`;
    assert.equal(hex(0), stops[0]);
    assert.equal(hex(255), stops.at(-1));
  }
});

test("the budget follows the speed of drawing", () => {
  const slow = new budget.Budget(),
    fast = new budget.Budget();
  for (let i = 0; i < 20; ++i) {
    slow.learn(50_000, 50);
    fast.learn(2_000_000, 5);
  }
  assert.equal(slow.moving, 30_000);
  assert.equal(fast.moving, 4_000_000);
  assert.ok(slow.still >= 500_000 && slow.still <= 1_600_000);
  const before = fast.moving;
  fast.learn(10, 1000);
  assert.equal(fast.moving, before, "a few points tell nothing");
});

const spelt = (key, code, mods = {}) =>
  commands.spellings({
    ...{ key, code, ctrlKey: false, metaKey: false, shiftKey: false, altKey: false },
    getModifierState: () => false,
    ...mods,
  });
const [shift, control, alt] = [{ shiftKey: true }, { ctrlKey: true }, { altKey: true }];

test("keys are spelt alike on any keyboard", () => {
  const key = (...words) => spelt(...words)[0];
  assert.equal(key("z", "KeyZ", control), "Ctrl+Z");
  assert.equal(key("Z", "KeyZ", { metaKey: true, ...shift }), "Ctrl+Shift+Z");
  assert.equal(key("!", "Digit1", shift), "Shift+1");
  assert.equal(key("?", "Slash", shift), "?");
  assert.equal(key("{", "BracketLeft", shift), "{");
  assert.equal(key("ArrowUp", "ArrowUp", shift), "Shift+ArrowUp");
  assert.equal(key("b", "KeyB"), "B");
});

test("on keyboards of other languages, too", () => {
  assert.deepEqual(spelt("&", "Digit1"), ["1", "&"], "French");
  assert.deepEqual(spelt("1", "Digit1", shift), ["1"]);
  assert.deepEqual(spelt("-", "Digit6"), ["6", "-"]);
  assert.deepEqual(spelt("a", "KeyQ"), ["A"]);
  assert.deepEqual(spelt("=", "Digit0", shift), ["Shift+0", "="], "German");
  const altGraph = { getModifierState: (name) => name === "AltGraph" };
  assert.deepEqual(spelt("[", "Digit8", altGraph), ["["]);
  assert.deepEqual(spelt("{", "Digit8", { ...alt, ...control }), ["{"]);
  assert.deepEqual(spelt("ArrowLeft", "ArrowLeft", alt), [], "the browser's");
  assert.deepEqual(spelt("b", "KeyB", alt), []);
  assert.deepEqual(spelt("\u0434", "KeyL"), ["\u0414", "L"], "Russian");
  assert.deepEqual(spelt("\u044f", "KeyZ", control), ["Ctrl+\u042f", "Ctrl+Z"]);
  assert.deepEqual(spelt("\u042f", "KeyZ", { ...control, ...shift }), ["Ctrl+\u042f", "Ctrl+Shift+Z"]);
});

test("two fingers slide by their middle and zoom by their distance", () => {
  const two = new fingers.Fingers();
  two.down(5, [100, 100]);
  two.down(9, [200, 100]);
  assert.deepEqual(two.middle, [150, 100]);
  assert.deepEqual(two.move(9, [300, 100]), { by: [50, 0], factor: 2 });
  assert.deepEqual(two.move(5, [200, 140]), { by: [50, 20], factor: Math.hypot(100, 40) / 200 });
  two.up(5);
  assert.equal(two.count, 1);
  assert.deepEqual(two.move(9, [310, 100]).by, [10, 0]);
  assert.ok(two.has(9) && !two.has(5));
});

test("tells coordinates of a national grid apart", () => {
  assert.equal(format.coordinate(652012.34567, 40), "652012.35");
  assert.equal(format.coordinate(-0.5, 1), "-0.500");
  assert.equal(format.coordinate(5, 0), "5.000");
  assert.deepEqual([0, 1234.5, 0.001234, 0.0000689, -2.5e-7].map(format.length), [
    "0",
    "1230",
    "0.00123",
    "6.89e-5",
    "-2.5e-7",
  ]);
});

test("names the stages of loading, and leaves a sentence as it is", () => {
  assert.equal(format.stageText("describe", 0.824), "Computing descriptors, 82 %");
  assert.equal(format.stageText("read", 0), "Reading the file");
  assert.equal(format.stageText("Cannot open the cloud: no points.", 0), "Cannot open the cloud: no points.");
});

test("goes through lines round the end, and to those that are undecided", () => {
  const { stepped, nextOpen, countDecisions } = reviewer;
  assert.deepEqual([stepped(0, null, 1), stepped(3, null, 1), stepped(3, null, -1)], [null, 0, 2]);
  assert.deepEqual([stepped(3, 0, 1), stepped(3, 2, 1), stepped(3, 0, -1), stepped(1, 0, -1)], [1, 0, 2, 0]);
  const lines = (...decisions) => decisions.map((decision) => ({ decision }));
  assert.equal(nextOpen(lines("open", "accepted", "rejected", "open"), 0), 3);
  assert.equal(nextOpen(lines("open", "accepted", "rejected", "open"), 3), 0);
  assert.equal(nextOpen(lines("accepted", "open"), 1), null); // itself does not count
  assert.equal(nextOpen(lines("accepted"), 0), null);
  assert.deepEqual(countDecisions(lines("open", "rejected", "open")), { open: 2, accepted: 0, rejected: 1 });
});

test("a face of the clipping box moves along its axis, and stops at the opposite one", () => {
  const box = { min: [0, 0, 0], max: [2, 4, 6] };
  assert.deepEqual(clip_handles.faceMiddle(box, { axis: 1, side: "max" }), [1, 4, 3]);
  assert.deepEqual(clip_handles.moved(box, { axis: 0, side: "min" }, 0.5).min, [0.5, 0, 0]);
  assert.deepEqual(clip_handles.moved(box, { axis: 0, side: "min" }, 9).min, [2, 0, 0]);
  assert.deepEqual(clip_handles.moved(box, { axis: 2, side: "max" }, -9).max, [2, 4, 0]);
  assert.deepEqual(box, { min: [0, 0, 0], max: [2, 4, 6] });
});

test("a slice lies within the cloud and steps by its thickness", () => {
  const bounds = { min: [0, 0, 0], max: [10, 20, 30] };
  assert.deepEqual(clip_handles.sliceOf(bounds, 1, 5, 0.1), { min: [0, 4, 0], max: [10, 6, 30] });
  const last = clip_handles.sliceOf(bounds, 1, 500, 0.1);
  assert.deepEqual(last, { min: [0, 18, 0], max: [10, 20, 30] });
  assert.deepEqual(clip_handles.stepped(last, bounds, -2), { min: [0, 14, 0], max: [10, 16, 30] });
});

test("a clipping box as large as the cloud cuts nothing off, a smaller one what lies outside", () => {
  const bounds = { min: [0, 0, 0], max: [10, 10, 0] };
  const clip = { on: true, box: { min: [0, 2, 0], max: [10, 10, 0] } };
  const { min, max } = store.activeClip({ clip, session: { bounds, spacing: 1 } });
  assert.ok(min[0] < 0 && min[1] === 2 && min[2] < 0 && max[0] > 10 && max[1] > 10 && max[2] > 0);
  assert.equal(store.activeClip({ clip: { ...clip, on: false }, session: { bounds, spacing: 1 } }), null);
});

test("a measured distance names its parts along the axes", () => {
  const words = measure.distanceWords([
    [0, 0, 0],
    [3, -4, 12],
  ]);
  assert.equal(words, "13 (Δx 3, Δy -4, Δz 12)");
});

test("the places to frame are the first points of a node, which are spread over all of it", () => {
  const n = 30_000;
  const positions = Uint16Array.from({ length: 3 * n }, (_, i) => (Math.floor(i / 3) % 2 === 0 ? 0 : 65535));
  const places = chunk.placesOf({ info: { points: n, centre: [0, 0, 0], half: 1 }, positions });
  assert.deepEqual([...new Set(places)].sort(), [-1, 1]);
  assert.ok(places.length > 1000 && places.length < 3 * n);
});

test("a far point is not framed, all others are", () => {
  const next = random(4);
  const cloud = Array.from({ length: 3000 }, (_, k) => (k % 3 === 2 ? 0.01 : 1) * next());
  assert.deepEqual(chunk.withoutFar(cloud), cloud);
  assert.deepEqual(chunk.withoutFar([...cloud, 0, 0, 500]), cloud);
  assert.deepEqual(chunk.withoutFar([0, 0, 0, 1, 0, 0, 0, 9, 0]), [0, 0, 0, 1, 0, 0, 0, 9, 0]);
});

const row = (id, name, more = {}) => ({ id, name, colour: [id, 0, 255], count: 0, ...more });
const edges = ["non-edge", "smooth-edge", "sharp-edge"].map((name, id) => row(id, name));

test("the palette holds the edge classes, own ones, and none", () => {
  const own = { classes: [row(0, "ground"), row(1, "pipe")], edges: false, safePalette: false };
  const palette = classes.paletteOf(own);
  assert.equal(palette.length, classes.NONE + 1);
  assert.deepEqual(palette[1], { name: "pipe", colour: "#0100ff" });
  assert.equal(palette[classes.NONE].name, "no label");
  const both = { classes: [...edges, row(3, "boundary"), row(4, "pipe")], edges: true, safePalette: true };
  assert.deepEqual(
    classes
      .paletteOf(both)
      .map(({ name }) => name)
      .slice(0, 5),
    ["non-edge", "smooth edge", "sharp edge", "boundary", "pipe"],
  );
  const safe = classes.paletteOf({
    ...own,
    classes: Array.from({ length: 8 }, (_, id) => row(id, `${id}`)),
    safePalette: true,
  });
  assert.equal(new Set(safe.map(({ colour }) => colour)).size, 9, "told apart");
});

test("keys name the classes that can be painted, without boundary and those removed", () => {
  const ids = (state) => classes.paintable(state).map(({ id }) => id);
  assert.deepEqual(ids({ classes: edges, edges: true, counts: [0, 0, 0] }), [0, 1, 2]);
  const all = [...edges, row(3, "boundary"), row(4, "a", { removed: true }), row(5, "b")];
  assert.deepEqual(ids({ classes: all, edges: true, counts: [0, 0, 0, 0, 0, 0] }), [0, 1, 2, 5]);
  // Undo brought its points back.
  assert.deepEqual(ids({ classes: all, edges: true, counts: [0, 0, 0, 0, 3, 0] }), [0, 1, 2, 4, 5]);
});

test("the editor's rows become a table: any before the first stroke, then with the numbers that there are", () => {
  const draft = (id, name) => ({ id, name, colour: "#010203" });
  const names = (table) => table.map(({ name, removed }) => (removed ? `(${name})` : name));
  const start = { classes: edges, edges: true };
  assert.deepEqual(names(classes.wantedTable(start, [draft(null, " a "), draft(null, "b")], false, false)), ["a", "b"]);
  const table = classes.wantedTable(start, [draft(null, "a")], true, true);
  assert.deepEqual(names(table), ["non-edge", "smooth-edge", "sharp-edge", "boundary", "a"]);
  const own = { classes: [row(0, "a"), row(1, "b"), row(2, "c")], edges: false };
  const rows = [draft(0, "soil"), draft(2, "c"), draft(null, "d")];
  assert.deepEqual(names(classes.wantedTable(own, rows, false, true)), ["soil", "(b)", "c", "d"]);
  const back = [draft(0, "a"), draft(2, "c"), draft(null, "b")];
  assert.deepEqual(names(classes.wantedTable(own, back, false, true)), ["a", "b", "c"], "it comes back");
  const full = { classes: Array.from({ length: 8 }, (_, id) => row(id, `${id}`)), edges: false };
  const replaced = [...Array.from({ length: 7 }, (_, id) => draft(id, `${id}`)), draft(null, "new")];
  assert.equal(names(classes.wantedTable(full, replaced, false, true))[7], "new", "in the place of one removed");
});

test("a class that cannot be painted is not the chosen one", () => {
  const state = (paintClass, more = {}) => ({
    ...{ classes: edges, edges: true, counts: [0, 0, 0], settings: { classes: 3 }, paintClass },
    ...more,
  });
  assert.equal(classes.usableClass(state(1)), 1);
  assert.equal(classes.usableClass(state(1, { settings: { classes: 2 } })), 2, "two classes know no smooth edge");
  assert.equal(classes.usableClass(state(255, { settings: { classes: 2 } })), 255);
  const own = { classes: [row(0, "a", { removed: true }), row(1, "b")], edges: false };
  assert.equal(classes.usableClass(state(0, own)), 1);
  assert.equal(classes.usableClass(state(1, { ...own, settings: { classes: 2 } })), 1);
});

test("a name that is there twice is told as it was given", () => {
  const named = (...names) =>
    classes.repeatedName(
      names.map((name) => ({ name })),
      true,
    );
  assert.equal(named("a", "b", " a "), "a");
  assert.equal(named("a", "b", "", ""), null);
  assert.equal(named("tall wall", "Tall-Wall"), "Tall-Wall", "nearly the same");
  assert.equal(named("sharp edge"), "sharp edge", "that of an edge class");
  assert.equal(classes.repeatedName([{ name: "sharp edge" }], false), null);
});
