// The COPC that we write, read by copc and decompressed by laz-perf.
// node copc_test.mjs PCEDNET LAS_SAMPLE
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";

const [pcednet, sample] = process.argv.slice(2);
for (const name of ["copc", "laz-perf"]) {
  if (existsSync(new URL(`node_modules/${name}`, import.meta.url))) continue;
  console.log(`skipped: ${name} is not installed; npm ci in tests/clients`);
  process.exit(77);
}
const { Copc, Las, Key, Bounds } = (await import("copc")).default;

const folder = mkdtempSync(join(tmpdir(), "pcednet-copc-"));
after(() => rmSync(folder, { recursive: true }));
let files = 0;
const fresh = (extension) => join(folder, `${++files}.${extension}`);
function made(command, input, extension, ...more) {
  const output = fresh(extension);
  execFileSync(pcednet, [command, input, "-o", output, ...more], { stdio: ["ignore", "ignore", "pipe"] });
  return output;
}

// LAS from tables of the standard, not from our code.
function makeSample({ format, minor = 4, points = 1000, extra = 0, channels = 1 }) {
  const path = fresh("las");
  const numbers = [format, minor, points, extra, channels].map(String);
  writeFileSync(path, execFileSync(sample, numbers, { maxBuffer: 1 << 28 }));
  return path;
}

// Opens a file and checks all that COPC says about it; its points, a view per node.
async function open(file) {
  const copc = await Copc.create(file);
  const { header, info, vlrs } = copc;
  assert.deepEqual([header.majorVersion, header.minorVersion, header.headerLength], [1, 4, 375]);
  assert.deepEqual([vlrs[0].userId, vlrs[0].recordId, vlrs[0].contentOffset], ["copc", 1, 429]);
  assert.ok(header.globalEncoding & 16, "the WKT bit");
  const { nodes, pages } = await Copc.loadHierarchyPage(file, info.rootHierarchyPage);
  assert.deepEqual(pages, {});
  assert.ok(nodes["0-0-0-0"]);
  const side = info.cube[3] - info.cube[0];
  for (const axis of [0, 1, 2]) {
    assert.ok(info.cube[axis] <= header.min[axis] && info.cube[axis + 3] >= header.max[axis]);
    assert.ok(Math.abs(info.cube[axis + 3] - info.cube[axis] - side) < 1e-6, "a cube");
  }
  assert.ok(Math.abs(info.spacing - side / 128) < 1e-6);

  const views = [];
  let count = 0;
  for (const [name, node] of Object.entries(nodes)) {
    const key = Key.create(name);
    const parent = [key[0] - 1, key[1] >> 1, key[2] >> 1, key[3] >> 1].join("-");
    assert.ok(key[0] === 0 || nodes[parent], `${name} has no parent`);
    const view = await Copc.loadPointDataView(file, copc, node);
    assert.equal(view.pointCount, node.pointCount);
    const bounds = Bounds.stepTo(info.cube, key);
    ["X", "Y", "Z"].forEach((axis, a) => {
      const get = view.getter(axis);
      for (let i = 0; i < view.pointCount; ++i) {
        const inside = get(i) >= bounds[a] - 1e-7 && get(i) <= bounds[a + 3] + 1e-7;
        if (!inside) assert.fail(`${axis} ${get(i)} of ${name} is not in ${bounds}`);
      }
    });
    count += node.pointCount;
    views.push(view);
  }
  assert.equal(count, header.pointCount);
  const end = Math.max(...Object.values(nodes).map((node) => node.pointDataOffset + node.pointDataLength));
  assert.ok(end <= statSync(file).size);
  return { copc, nodes, views };
}

function plainView(file) {
  const bytes = readFileSync(file);
  const header = Las.Header.parse(bytes);
  const end = header.pointDataOffset + header.pointCount * header.pointDataRecordLength;
  return { header, view: Las.View.create(bytes.subarray(header.pointDataOffset, end), header, []) };
}

// The points of views, each a line of their dimensions, sorted. In formats 0 to 5 copc shows class 12
// as class 0 with the overlap flag of the later formats; the file keeps 12.
function sorted(views, names) {
  const asShown = (name, value) => (name === "Classification" && value === 12 ? 0 : value);
  const lines = [];
  for (const view of views) {
    const getters = names.map((name) => view.getter(name));
    for (let i = 0; i < view.pointCount; ++i) lines.push(getters.map((get, n) => asShown(names[n], get(i))).join(" "));
  }
  return lines.sort();
}

for (const [format, target] of [[0, 6], [1, 6], [2, 7], [3, 7], [6, 6], [7, 7], [8, 8]]) {
  for (const [points, extra] of [[1, 0], [3000, 5]]) {
    test(`copc reads ${points} points of format ${format}, ${extra} extra bytes`, async () => {
      const minor = format < 4 ? 2 : 4;
      const source = makeSample({ format, minor, points, extra, channels: format < 6 ? 1 : 4 });
      const { copc, views } = await open(made("convert", source, "copc.laz"));
      assert.equal(copc.header.pointDataRecordFormat, target);
      const before = plainView(source);
      assert.deepEqual(copc.header.scale, before.header.scale);
      assert.deepEqual(copc.header.offset, before.header.offset);
      const names = Object.keys(before.view.dimensions).filter(
        (name) => name !== "ScanAngle" && (format >= 6 || name !== "Overlap"),
      );
      assert.ok(names.includes("Classification") && names.includes("Intensity"));
      assert.deepEqual(sorted(views, names), sorted([before.view], names));
      if (format >= 6) assert.deepEqual(sorted(views, ["X", "ScanAngle"]), sorted([before.view], ["X", "ScanAngle"]));
      if (names.includes("GpsTime")) {
        const times = sorted([before.view], ["GpsTime"]).map(Number).sort((a, b) => a - b);
        assert.deepEqual(copc.info.gpsTimeRange, [times[0], times.at(-1)]);
      }
    });
  }
}

// Several levels, chunks and threads; the same bytes whatever their number.
test("copc reads an octree of 150000 points", async () => {
  const source = makeSample({ format: 7, points: 150000 });
  const bytes = readFileSync(source); // without its points far away
  for (let at = 375 + 4; at < bytes.length; at += 36) bytes.writeInt32LE(bytes.readInt32LE(at) % 300000, at);
  writeFileSync(source, bytes);
  const output = made("convert", source, "copc.laz", "--threads", "1");
  const { nodes, views } = await open(output);
  const sizes = Object.values(nodes).map((node) => node.pointCount);
  assert.ok(sizes.length > 5 && Math.max(...sizes) <= 100000, `${sizes}`);
  const names = ["X", "Y", "Z", "Classification", "Intensity", "GpsTime", "Red"];
  assert.deepEqual(sorted(views, names), sorted([plainView(source).view], names));
  for (const threads of ["2", "8"]) {
    const again = made("convert", source, "copc.laz", "--threads", threads);
    assert.ok(readFileSync(again).equals(readFileSync(output)), `${threads} threads`);
  }
});

test("copc finds the classes and confidences that classify writes", async () => {
  const source = makeSample({ format: 6, points: 3000 });
  const { copc, views } = await open(made("classify", source, "copc.laz"));
  assert.deepEqual(copc.eb.map(({ name }) => name), ["edge_class", "p_sharp", "p_smooth"]);
  const plain = made("classify", source, "laz");
  const [names, ...rows] = readFileSync(made("convert", plain, "csv"), "utf8").trim().split("\n");
  const columns = names.split(",");
  const wanted = ["x", "y", "z", "scalar_edge_class", "scalar_p_sharp"].map((name) => columns.indexOf(name));
  const number = (word, c) => (c === 4 ? Math.fround(Number(word)) : Number(word));
  const lines = rows.map((row) => row.split(",")).map((cells) => wanted.map((w, c) => number(cells[w], c)).join(" "));
  assert.deepEqual(sorted(views, ["X", "Y", "Z", "edge_class", "p_sharp"]), lines.sort());
});

test("copc finds the normals that normals writes, and the colours of other files", async () => {
  const rows = Array.from({ length: 500 }, (_, i) => [i % 20, Math.floor(i / 20), (i % 7) / 50, i % 256, 7, 255 - (i % 256)]);
  const text = fresh("xyz");
  writeFileSync(text, ["# x y z red green blue", ...rows.map((row) => row.join(" "))].join("\n"));
  const { copc, views } = await open(made("normals", text, "copc.laz"));
  assert.equal(copc.header.pointDataRecordFormat, 7);
  assert.deepEqual(copc.eb.map(({ name }) => name), ["NormalX", "NormalY", "NormalZ"]);
  const wanted = rows.map((row) => row.map((v, c) => (c < 3 ? v : 257 * v)).join(" ")).sort();
  const found = sorted(views, ["X", "Y", "Z", "Red", "Green", "Blue"]);
  const digits = (line) => line.split(" ").map((word) => Number(Number(word).toFixed(5))).join(" ");
  assert.deepEqual(found.map(digits).sort(), wanted.map(digits).sort());
});

test("copc opens a file without points", async () => {
  const source = makeSample({ format: 6, points: 0 });
  const copc = await Copc.create(made("convert", source, "copc.laz"));
  assert.equal(copc.header.pointCount, 0);
});
