// Clouds that come with labels and classes: seen, and painted from. Environment as annotator.mjs.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { test } from "node:test";

import { roof } from "./annotate_cloud.mjs";
import { complainedOfNothing, openAnnotator } from "./annotator.mjs";

const asked = [];
const its = openAnnotator("file", { prepare: writesLas, ready: () => (page = its.page) });
const { paint, settled, state } = its;
let page;

/** The roof as LAS: sharp edges and others labelled, above the box buildings, below ground. */
function writesLas(folder) {
  const [written, input] = ["roof.ply", "roof.las"].map((name) => path.join(folder, name));
  const points = roof();
  const head = [
    "ply",
    "format ascii 1.0",
    `element vertex ${points.length}`,
    ...["x", "y", "z"].map((name) => `property double ${name}`),
    ...["label", "Classification"].map((name) => `property uchar ${name}`),
    "end_header",
  ];
  const rows = points.map(({ p, sharp }) => [...p.map((c) => c.toFixed(5)), sharp ? 2 : 0, p[2] > 0.6 ? 6 : 2]);
  fs.writeFileSync(written, [...head, ...rows.map((row) => row.join(" ")), ""].join("\n"));
  const done = spawnSync(process.env.PCEDNET, ["convert", written, "-o", input], { encoding: "utf8" });
  assert.equal(done.status, 0, done.stderr);
  return [input, "--model", "scan"];
}

const colourBy = (label) => page.getByRole("combobox", { name: "Colour by" }).selectOption({ label });
const legend = () => page.locator(".legend").innerText();

/** Points of each byte of a layer. */
const counted = (layer) =>
  page.evaluate((name) => {
    const counts = {};
    for (const chunk of annotator.stage.chunks) for (const byte of chunk[name]) counts[byte] = (counts[byte] ?? 0) + 1;
    return counts;
  }, layer);

/** The share of the points' pixels that are of a hue: red less green, green less blue. */
const shareOf = (isSuch) =>
  page.evaluate(async (text) => {
    const such = new Function("r", "g", "b", `return ${text}`);
    const image = await createImageBitmap(await annotator.stage.picture());
    const context = new OffscreenCanvas(image.width, image.height).getContext("2d");
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, image.width, image.height);
    const first = [...data.slice(0, 3)];
    let found = 0,
      points = 0;
    for (let i = 0; i < data.length; i += 4) {
      const [r, g, b] = data.slice(i, i + 3);
      if (first.every((c, k) => Math.abs(c - data[i + k]) < 3)) continue;
      points += 1;
      if (such(r, g, b)) found += 1;
    }
    return found / points;
  }, isSuch);

test("shows the classes of LAS by their names, fetched only when asked for", async () => {
  page.on("request", (request) => asked.push(new URL(request.url()).searchParams.get("of")));
  await page.reload();
  await settled();
  assert.ok(asked.includes("labels"));
  assert.ok(!asked.includes("las_classes") && !asked.includes("file_labels"), `${asked}`);
  await colourBy("LAS classes");
  await settled();
  const session = await state("session");
  const points = Object.fromEntries(session.las_classes.map((its) => [its.id, its.points]));
  assert.deepEqual(Object.keys(points), ["2", "6"]);
  assert.deepEqual(await counted("values"), points);
  assert.match(await legend(), /LAS classes\s+2 ground\s+6 building$/);
  const [brown, orange] = [await shareOf("r > g && g > b && r < 180"), await shareOf("r > 150 && r > 1.8 * g")];
  assert.ok(brown > 0.3 && orange > 0.1, `${brown} ground, ${orange} buildings`);
});

test("shows no class before it is known, however slow the network", async () => {
  const grey = () => shareOf("b > 1.04 * r && b < 1.3 * r"); // as what has no label; non-edge is white
  await page.reload();
  await settled();
  let release;
  const released = new Promise((done) => (release = done));
  await page.route("**/api/values?of=file_labels*", (route) => released.then(() => route.continue()));
  await colourBy("labels of the file");
  await page.waitForTimeout(300);
  assert.ok((await grey()) > 0.95, `${await grey()}`);
  release();
  await settled();
  assert.ok((await grey()) < 0.1, `${await grey()}`);
  await page.unroute("**/api/values?of=file_labels*");
});

test("shows the labels of the file in the colours of the classes", async () => {
  await colourBy("labels of the file");
  await settled();
  const { 0: none, 2: sharp } = await counted("values");
  assert.ok(sharp > 1000 && none > 5 * sharp, `${sharp} sharp, ${none} others`);
  assert.match(await legend(), /labels of the file\s+non-edge\s+sharp edge$/);
  const red = await shareOf("r > 80 && g < 30 && b < 30");
  assert.ok(red > 0.02 && red < 0.4, `${red}`);
});

test("compares the prediction with the labels of the file", async () => {
  await colourBy("errors of prediction");
  await settled();
  assert.match(
    await legend(),
    /errors of prediction\s+true negative\s+true positive\s+false positive\s+false negative\s+no label$/,
  );
  const { 1: tp = 0, 2: fp = 0, 3: fn = 0 } = await counted("values");
  const predicted = await counted("prediction");
  const labels = Object.fromEntries((await state("session")).file_labels.map(({ id, points }) => [id, points]));
  assert.equal(tp + fp, predicted[2]);
  assert.equal(tp + fn, labels[2]);
  assert.ok(tp > 100 && fn > 100, `${[tp, fp, fn]}`);
  const blue = await shareOf("b > 1.5 * r && b > 80");
  assert.ok(blue > 0.01 && blue < 0.3, `${blue} of false negatives`);
  await colourBy("labels of the file");
  await settled();
});

test("paints what is unpainted as in the file, within the clipping box, a class at a time", async () => {
  const all = await counted("values");
  await its.trainAfterStrokes(false);
  await paint(2, [[1, 0, 0.3]], 0.1); // on a face
  const wrong = (await state("counts"))[2];
  assert.ok(wrong > 20);
  const take = page.getByRole("button", { name: "As in the file" });
  await page.evaluate(() => {
    const { min, max } = structuredClone(annotator.store.now.session.bounds);
    max[0] = 0;
    annotator.store.set({ clip: { on: true, box: { min, max } } });
  });
  await take.click();
  await settled();
  const half = await state("counts");
  assert.ok(half[0] > 0.3 * all[0] && half[0] < 0.7 * all[0], `${half} of ${JSON.stringify(all)}`);
  await page.evaluate(() => annotator.store.set({ clip: null }));
  await take.click();
  await settled();
  const sum = (counts) => counts.reduce((a, b) => a + b);
  assert.equal(sum(await state("counts")), all[0] + all[2]);
  assert.ok((await state("counts"))[0] > all[0] - wrong - 1, "what was painted before is kept");
  assert.equal(await state("undo"), 5);
  for (let i = 0; i < 4; ++i) await page.keyboard.press("Control+z");
  await settled();
  assert.deepEqual(await state("counts"), [0, 0, wrong]);
});

complainedOfNothing(its);
