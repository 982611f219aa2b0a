// The LAS and LAZ that we write, read by copc and decompressed by laz-perf.
// node las_test.mjs PCEDNET LAS_SAMPLE
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, test } from "node:test";

const [pcednet, sample] = process.argv.slice(2);
for (const name of ["copc", "laz-perf"]) {
  if (existsSync(new URL(`node_modules/${name}`, import.meta.url))) continue;
  console.log(`skipped: ${name} is not installed; npm ci in tests/clients`);
  process.exit(77);
}
const { Las } = (await import("copc")).default;
const { createLazPerf } = (await import("laz-perf")).default;
const lazPerf = await createLazPerf();

const folder = mkdtempSync(join(tmpdir(), "pcednet-las-"));
after(() => rmSync(folder, { recursive: true }));
let files = 0;
const fresh = (extension) => join(folder, `${++files}.${extension}`);
// What a command makes of a file.
function made(command, input, extension) {
  const output = fresh(extension);
  execFileSync(pcednet, [command, input, "-o", output], { stdio: ["ignore", "ignore", "pipe"] });
  return output;
}
const OURS = ["edge_class", "p_sharp", "p_smooth"];

// LAS from tables of the standard, not from our code.
function makeSample({ format, minor = 4, points = 1000, extra = 0, channels = 1 }) {
  const path = fresh("las");
  const numbers = [format, minor, points, extra, channels].map(String);
  writeFileSync(path, execFileSync(sample, numbers, { maxBuffer: 1 << 28 }));
  return path;
}

function pointBytes(file) {
  const bytes = readFileSync(file);
  const header = Las.Header.parse(bytes);
  const end = header.pointDataOffset + header.pointCount * header.pointDataRecordLength;
  return bytes.subarray(header.pointDataOffset, end);
}

async function open(file) {
  const header = Las.Header.parse(readFileSync(file).subarray(0, 375));
  const vlrs = await Las.Vlr.walk(file, header);
  const fetch = (vlr) => Las.Vlr.fetch(file, vlr);
  const described = vlrs.find((v) => v.userId === "LASF_Spec" && v.recordId === 4);
  const extra = described ? Las.ExtraBytes.parse(await fetch(described)) : [];
  const contents = await Promise.all(
    vlrs.map(async (v) => [v.userId, v.recordId, v.description, Buffer.from(await fetch(v)).toString("hex")]),
  );
  return { header, contents, extra, view: Las.View.create(pointBytes(file), header, extra) };
}

const column = (view, name) => Array.from({ length: view.pointCount }, (_, i) => view.getter(name)(i));

// Columns by name; ours name themselves in the first line.
function csvColumns(file) {
  const [names, ...rows] = readFileSync(made("convert", file, "csv"), "utf8").trim().split("\n");
  const cells = rows.map((row) => row.split(",").map(Number));
  return Object.fromEntries(names.split(",").map((name, c) => [name, cells.map((row) => row[c])]));
}

for (const [format, minor] of [[0, 2], [1, 4], [2, 2], [3, 2], [6, 4], [7, 4], [8, 4]]) {
  test(`copc finds all in classified LAS 1.${minor}, point format ${format}`, async () => {
    const source = makeSample({ format, minor, points: 2500 });
    const classified = made("classify", source, "las");
    const [before, now] = [await open(source), await open(classified)];

    for (const [name, value] of Object.entries(before.header)) {
      if (["pointDataOffset", "vlrCount", "pointDataRecordLength", "evlrOffset"].includes(name)) continue;
      assert.deepEqual(now.header[name], value, name);
    }
    assert.equal(now.header.pointDataRecordLength, before.header.pointDataRecordLength + 9);
    const spec = now.contents.filter(([user, id]) => user === "LASF_Spec" && id === 4);
    assert.equal(spec.length, 1);
    const said = now.contents.filter(([user, id]) => user === "pcednet" && id === 1);
    assert.equal(said.length, 1);
    assert.match(Buffer.from(said[0][3], "hex").toString(), /^pcednet [0-9.]+\npcednet model general\npcednet seed 1\npcednet scales [0-9.e+-]+ to [0-9.e+-]+\n/);
    const others = now.contents.filter((record) => record !== spec[0] && record !== said[0]);
    assert.deepEqual(others, before.contents);
    assert.deepEqual(
      now.extra.map(({ name, type, length }) => [name, type, length]),
      [["edge_class", "unsigned", 1], ["p_sharp", "float", 4], ["p_smooth", "float", 4]],
    );

    assert.equal(now.view.pointCount, 2500);
    assert.deepEqual(Object.keys(now.view.dimensions), [...Object.keys(before.view.dimensions), ...OURS]);
    for (const name of Object.keys(before.view.dimensions)) {
      assert.deepEqual(column(now.view, name), column(before.view, name), name);
    }
    const ours = csvColumns(classified);
    for (const name of OURS) {
      const wanted = ours[`scalar_${name}`].map(name === "edge_class" ? Number : Math.fround);
      assert.deepEqual(column(now.view, name), wanted, name);
    }
    assert.ok(ours.scalar_p_sharp.some((value) => value > 0), "only zeros are compared");
    for (const axis of ["x", "y", "z"]) assert.deepEqual(column(now.view, axis.toUpperCase()), ours[axis], axis);
  });
}

test("copc finds all in LAS that we make of other files", async () => {
  const rows = Array.from({ length: 500 }, (_, i) => [
    652000 + i / 8, 6862000 - i / 4, i / 2, 0.6, 0, -0.8, i % 256, 7, 255 - (i % 256),
  ]);
  const names = "x y z nx ny nz red green blue";
  const text = fresh("xyz");
  writeFileSync(text, [`# ${names}`, ...rows.map((row) => row.join(" "))].join("\n"));
  const { header, view, extra } = await open(made("convert", text, "las"));
  assert.deepEqual([header.minorVersion, header.pointDataRecordFormat, header.pointCount], [4, 7, 500]);
  assert.deepEqual([header.min, header.max], [[652000, 6861875.25, 0], [652062.375, 6862000, 249.5]]);
  assert.deepEqual(extra.map(({ name }) => name), ["NormalX", "NormalY", "NormalZ"]);
  const dimensions = ["X", "Y", "Z", "NormalX", "NormalY", "NormalZ", "Red", "Green", "Blue"];
  dimensions.forEach((name, c) => {
    const wanted = rows.map((row) => (c < 6 ? row[c] : 257 * row[c]));
    assert.deepEqual(column(view, name), wanted, name);
  });
});

// Decompresses a whole file to its point records.
function decompress(file) {
  const bytes = readFileSync(file);
  const memory = lazPerf._malloc(bytes.length);
  lazPerf.HEAPU8.set(bytes, memory);
  const zip = new lazPerf.LASZip();
  zip.open(memory, bytes.length);
  const stride = zip.getPointLength();
  const rows = Buffer.alloc(zip.getCount() * stride);
  const place = lazPerf._malloc(stride);
  for (let i = 0; i < zip.getCount(); ++i) {
    zip.getPoint(place);
    rows.set(lazPerf.HEAPU8.subarray(place, place + stride), i * stride);
  }
  zip.delete();
  lazPerf._free(place);
  lazPerf._free(memory);
  return rows;
}

for (const format of [0, 1, 2, 3, 6, 7, 8]) {
  const minor = format < 6 ? 2 : 4;
  // Chunks hold 50,000 points; the last of these files ends with a chunk of one point.
  const large = format === 3 || format === 7 ? [[50000, 0], [100001, 2]] : [[50001, 5]];
  const sizes = [[1, 0], [2, 3], ...large];
  for (const [points, extra] of sizes) {
    test(`laz-perf decompresses ${points} points of format ${format}, ${extra} extra bytes`, () => {
      const source = makeSample({ format, minor, points, extra });
      const [rows, wanted] = [decompress(made("convert", source, "laz")), pointBytes(source)];
      assert.equal(rows.length, wanted.length);
      assert.ok(rows.equals(wanted), `byte ${rows.findIndex((byte, i) => byte !== wanted[i])} differs`);
    });
  }
}

// Scanner channels that differ from point to point, or are all the same but not 0.
for (const format of [6, 7, 8]) {
  for (const channels of [2, 3, 4]) {
    test(`laz-perf decompresses ${channels} scanner channels of format ${format}`, () => {
      const points = channels === 3 ? 50500 : 3000; // two chunks, or one
      const source = makeSample({ format, points, extra: 4, channels });
      const [rows, wanted] = [decompress(made("convert", source, "laz")), pointBytes(source)];
      const seen = new Set();
      for (let at = 15; at < wanted.length; at += wanted.length / points) seen.add((wanted[at] >> 4) & 3);
      assert.equal(seen.size, channels, "the sample has fewer channels");
      assert.ok(rows.equals(wanted), `byte ${rows.findIndex((byte, i) => byte !== wanted[i])} differs`);
    });
  }

  test(`laz-perf decompresses points of format ${format} that are all of channel 2`, () => {
    const source = makeSample({ format, points: 3000, extra: 4 });
    const bytes = readFileSync(source);
    const { pointDataOffset, pointDataRecordLength } = Las.Header.parse(bytes);
    for (let i = 0; i < 3000; ++i) bytes[pointDataOffset + i * pointDataRecordLength + 15] |= 0x20;
    writeFileSync(source, bytes);
    assert.ok(decompress(made("convert", source, "laz")).equals(pointBytes(source)));
  });
}

for (const [format, channels] of [[7, 1], [6, 2], [7, 4], [8, 3]]) {
  test(`laz-perf decompresses what we classified, ${channels} channels of format ${format}`, () => {
    const source = makeSample({ format, points: 3000, channels });
    const packed = made("classify", made("convert", source, "laz"), "laz");
    assert.ok(decompress(packed).equals(pointBytes(made("classify", source, "las"))));
  });
}
