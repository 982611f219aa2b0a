// Two clouds trained on together, in the browser. Environment as annotate_test.mjs; SCREENSHOT_CLOUDS, if set, is where
// a picture goes.
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { test } from "node:test";

import { roof, writeRoof } from "./annotate_cloud.mjs";
import { complainedOfNothing, openAnnotator } from "./annotator.mjs";

const its = openAnnotator("clouds", { prepare: writesTwo, ready: () => (page = its.page) });
const { folder, settled, state } = its;
let page;

const looksAt = (file) => page.waitForFunction((name) => annotator.store.now.session?.file === name, file);

/** The second is half as large, far away and thinner. */
function writesTwo(folder) {
  const inputs = ["roof.ply", "barn.ply"].map((name) => path.join(folder, name));
  writeRoof(inputs[0], roof());
  const second = roof().filter((_, i) => i % 2 === 0);
  writeRoof(
    inputs[1],
    second.map((point) => ({ ...point, p: point.p.map((c) => c / 2 + 50) })),
  );
  return inputs;
}

/** A dab in the middle of the view with the mouse. */
async function dab(key) {
  await page.evaluate(() => annotator.stage.fit("first"));
  await settled();
  const box = await page.locator("canvas").first().boundingBox();
  await page.keyboard.press(key);
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  await settled();
}

test("lists both and shows what the model finds in each", async () => {
  const names = await page.locator(".clouds .name").allTextContents();
  assert.deepEqual(names, ["roof.ply", "barn.ply"]);
  const sharp = () =>
    page.evaluate(() => annotator.stage.chunks.reduce((n, c) => n + c.prediction.filter((p) => p === 2).length, 0));
  await settled();
  const first = await sharp();
  await page.getByRole("radio", { name: "barn.ply" }).check({ force: true });
  await looksAt("barn.ply");
  await settled();
  const points = await page.evaluate(() => annotator.stage.chunks.reduce((n, c) => n + c.labels.length, 0));
  assert.equal(points, await page.evaluate(() => annotator.store.now.session.points));
  assert.ok(first > 500 && (await sharp()) > 200);
  assert.equal(await page.locator("h1").textContent(), "barn");
  if (process.env.SCREENSHOT_CLOUDS) await page.screenshot({ path: process.env.SCREENSHOT_CLOUDS });
});

test("paints in each; one model learns from both, and the one in view shows it", async () => {
  await its.trainAfterStrokes(false);
  await dab("1");
  const [there] = [await state("counts")];
  assert.ok(there[0] > 0);
  await page.keyboard.press("PageDown");
  await looksAt("roof.ply");
  await settled();
  assert.deepEqual(await state("counts"), there, "counts are of all clouds");
  const labels = () =>
    page.evaluate(() => annotator.stage.chunks.reduce((n, c) => n + c.labels.filter((l) => l < 3).length, 0));
  assert.equal(await labels(), 0, "nothing is painted here");
  await dab("2");
  const both = await state("clouds");
  assert.ok(
    both.every(({ painted }) => painted > 0),
    JSON.stringify(both),
  );
  assert.equal(await labels(), both[0].painted);
  await page.getByRole("button", { name: "Train now" }).click();
  await page.waitForFunction(() => annotator.store.now.runs.some((run) => run.current && run.run === 1));
  const run = (await state("runs")).find(({ current }) => current);
  assert.equal(run.painted, both[0].painted + both[1].painted);
});

test("takes a stroke in the other cloud back, and says where it was", async () => {
  await page.keyboard.press("PageUp");
  await looksAt("barn.ply");
  await settled();
  await page.keyboard.press("Control+z");
  await page.getByText("That was in roof.ply.").waitFor();
  await page.waitForFunction(() => annotator.store.now.clouds[0].painted === 0);
  assert.ok((await state("clouds"))[1].painted > 0);
});

test("paints nothing while another cloud is opened", async () => {
  await page.keyboard.press("PageDown");
  await looksAt("roof.ply");
  await settled();
  await page.keyboard.press("l");
  const before = await state("undo");
  let open;
  const isOpen = new Promise((done) => (open = done));
  await page.route(/session\?cloud=1/, async (route) => {
    await isOpen;
    await route.continue();
  });
  await page.keyboard.press("PageUp");
  await page.getByText("Opening barn.ply").waitFor();
  const { x, y, width, height } = await page.locator("canvas").first().boundingBox();
  const at = (right, down) => page.mouse.move(x + right * width, y + down * height, { steps: 5 });
  await at(0.1, 0.1);
  await page.mouse.down();
  for (const [right, down] of [
    [0.9, 0.1],
    [0.9, 0.9],
    [0.1, 0.9],
  ])
    await at(right, down);
  await page.mouse.up();
  open();
  await looksAt("barn.ply");
  await settled();
  assert.equal(await state("undo"), before);
  await page.unroute(/session\?cloud=1/);
  await page.keyboard.press("b");
});

/** Looks at the next cloud, or with PageUp at the one before. */
async function go(key, file) {
  await page.keyboard.press(key);
  await looksAt(file);
  await settled();
}

/** The middle of the view, in pixels of the window. */
async function middle() {
  const { x, y, width, height } = await page.locator("canvas").first().boundingBox();
  return [x + width / 2, y + height / 2];
}

test("keeps the view, the clipping box, the uncertain place and the lines of each", async () => {
  await page.waitForFunction(() => !annotator.store.now.training?.active);
  const look = () =>
    page.evaluate(() => {
      const { clip, uncertain, lines, line } = annotator.store.now;
      const { matrix } = annotator.stage.camera.view;
      return {
        clip,
        rank: uncertain?.rank,
        decisions: lines.lines.map((one) => one.decision),
        line,
        matrix: [...matrix],
      };
    });
  const find = async () => {
    await page.getByRole("button", { name: "Find lines" }).click();
    await page.waitForFunction(() => {
      const { lines } = annotator.store.now;
      return lines.version > 0 && !lines.searching;
    });
  };
  await find();
  for (const key of ["n", "n", "j", "a", "d", "c"]) {
    await page.keyboard.press(key);
    await page.waitForTimeout(100);
  }
  await page.waitForTimeout(500); // the flight
  await page.keyboard.press("ArrowLeft");
  await settled();
  const barn = await look();
  assert.deepEqual([barn.rank, barn.clip.on, barn.line], [2, true, 2]);
  assert.deepEqual(barn.decisions.slice(0, 3), ["accepted", "rejected", "open"]);
  await go("PageDown", "roof.ply");
  const roof = await look();
  assert.deepEqual([roof.rank, roof.clip, roof.line, roof.decisions], [undefined, null, null, []]);
  await find();
  await go("PageUp", "barn.ply");
  assert.deepEqual(await look(), barn);
  assert.equal(await page.locator(".mark").getAttribute("visibility"), "visible");
  await page.keyboard.press("c");
  await page.keyboard.press("f");
});

test("ends a stroke, and cancels an outline, before another cloud is shown", async () => {
  await settled();
  await page.evaluate(() => annotator.stage.fit("first"));
  await settled();
  const painted = async () => (await state("clouds")).map((cloud) => cloud.painted);
  const before = await painted();
  const [x, y] = await middle();
  await page.keyboard.press("b");
  await page.keyboard.press("3");
  await page.mouse.move(x - 40, y);
  await page.mouse.down();
  await page.mouse.move(x - 10, y, { steps: 3 });
  await go("PageDown", "roof.ply");
  await page.mouse.move(x + 40, y, { steps: 3 });
  await page.mouse.up();
  await settled();
  const after = await painted();
  assert.equal(after[0], before[0], "nothing in the roof");
  assert.ok(after[1] > before[1], "what was drawn in the barn");
  assert.equal(await page.locator(".notice", { hasText: "That was in barn" }).count(), 0);
  await page.keyboard.press("g");
  for (const [dx, dy] of [
    [-40, -40],
    [40, -40],
    [40, 40],
  ])
    await page.mouse.click(x + dx, y + dy);
  const outline = page.locator(".outline");
  assert.notEqual(await outline.getAttribute("d"), "");
  await go("PageUp", "barn.ply");
  assert.equal(await outline.getAttribute("d"), "");
  await page.keyboard.press("Enter");
  await settled();
  assert.deepEqual(await painted(), after);
  await page.keyboard.press("b");
});

test("knows what was painted, and set, while another cloud was opened", async () => {
  const painted = async () => (await state("clouds")).map((cloud) => cloud.painted);
  const [roof, barn] = await painted();
  await page.evaluate(() => {
    const { api } = annotator.client;
    const get = api.get.bind(api);
    annotator.asked = 0;
    api.get = async (path) => {
      const answer = await get(path);
      if (path === "/api/session" && ++annotator.asked === 1) await new Promise((go) => (annotator.answer = go));
      return answer;
    };
  });
  await page.keyboard.press("PageDown");
  await page.waitForFunction(() => annotator.answer);
  await its.stroke(1, [[50.8, 50, 50.2]], 0.15);
  await page.waitForFunction((before) => annotator.store.now.clouds[1].painted !== before, barn);
  await its.trainAfterStrokes(true);
  await page.evaluate(() => annotator.answer()); // of before the stroke
  await looksAt("roof.ply");
  await settled();
  const after = await painted();
  assert.equal(after[0], roof);
  assert.ok(after[1] > barn, `${after[1]} points, ${barn} before`);
  assert.ok((await state("settings")).auto, "what was set meanwhile");
  assert.ok((await page.evaluate(() => annotator.asked)) > 1, "asked again");
});

test("saves each beside its input", async () => {
  await page.waitForFunction(() => !annotator.store.now.training?.active);
  await page.getByRole("button", { name: "Save clouds" }).click();
  for (const name of ["roof_annotated.ply", "barn_annotated.ply"]) {
    await page.locator(".notice", { hasText: name }).waitFor();
    assert.ok(fs.statSync(path.join(folder, name)).size > 0);
  }
});

complainedOfNothing(its);
