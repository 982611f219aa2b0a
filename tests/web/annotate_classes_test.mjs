// Own classes in the browser. Environment as annotate_test.mjs; SCREENSHOT_CLASSES, if set, is where a picture goes, and
// SCREENSHOT_EDITOR one of the dialogue.
import assert from "node:assert/strict";
import fs from "node:fs";
import path from "node:path";
import { test } from "node:test";

import { readPly } from "./annotate_cloud.mjs";
import { complainedOfNothing, openAnnotator } from "./annotator.mjs";

const its = openAnnotator("classes", { height: 800, ready: () => (page = its.page) });
const { folder, paint, settled, state } = its;
let page;

const rows = () => page.locator(".classes:not(.clouds) .name").allTextContents();
const hasRows = (wanted) =>
  page.waitForFunction((n) => document.querySelectorAll(".classes:not(.clouds) .name").length === n, wanted);

test("replaces the edge classes by own ones before the first stroke", async () => {
  assert.deepEqual(await rows(), ["non-edge", "smooth edge", "sharp edge", "eraser"]);
  await page.getByRole("button", { name: /Classes…/ }).click();
  const dialog = page.getByRole("dialog", { name: "Classes" });
  await dialog.waitFor();
  await dialog.getByRole("checkbox").uncheck();
  const names = dialog.getByLabel("Name of the class");
  assert.equal(await names.count(), 2, "two classes at least");
  await names.nth(0).fill("face");
  await names.nth(1).fill("face");
  await dialog.getByRole("button", { name: "Use these classes" }).click();
  await dialog.getByText('There are two classes "face".').waitFor();
  await names.nth(1).fill("ledge");
  await dialog.getByRole("button", { name: "Add a class" }).click();
  await names.nth(2).fill("corner");
  await dialog.getByRole("button", { name: "Add a class" }).click();
  await dialog.getByRole("button", { name: "Remove" }).nth(3).click();
  await dialog.locator("input[type=color]").nth(2).fill("#c83296");
  if (process.env.SCREENSHOT_EDITOR) await page.screenshot({ path: process.env.SCREENSHOT_EDITOR });
  await dialog.getByRole("button", { name: "Use these classes" }).click();
  await page.waitForFunction(() => annotator.store.now.classes.length === 3 && !annotator.store.now.edges);
  await hasRows(4);
  assert.deepEqual(await rows(), ["face", "ledge", "corner", "eraser"]);
});

test("then begins with nothing and says where edges are needed", async () => {
  await page.waitForFunction(
    () => annotator.store.now.runs.length === 0 && annotator.store.now.settings.start === "random",
  );
  await settled();
  assert.equal(await state("mode"), "labels");
  await page.getByText("Shipped models know edges alone").waitFor();
  await page.getByText("Lines are of edge classes, which this project does not have.").waitFor();
  const options = await page.getByLabel("Start from").locator("option").allTextContents();
  assert.deepEqual(options, ["nothing"]);
  const modes = await page.getByLabel("Colour by").locator("option").allTextContents();
  assert.ok(!modes.includes("probability of a sharp edge"));
});

test("paints them by their keys, trains, and shows their colours", async () => {
  await page.keyboard.press("3");
  assert.equal(await state("paintClass"), 2);
  await page.keyboard.press("4");
  assert.equal(await state("paintClass"), 2, "there is no fourth class");
  await its.trainAfterStrokes(false);
  const [left, right, front, back] = [0.1, 1.9, 0.1, 1.3]; // of the lower roof, beside its edges
  await paint(
    0,
    [
      [left, 0.5, 0.6],
      [right, 0.5, 0.6],
      [1, front, 0.6],
      [1.6, back, 0.6],
      [1, 0, 0.3],
      [0, 0.7, 0.3],
    ],
    0.05,
  );
  await paint(
    1,
    [
      [0.6, 0, 0.6],
      [1, 0, 0.6],
      [1.4, 0, 0.6],
      [0, 0.6, 0.6],
      [0.8, 0.3, 1.1],
      [0.8, 0.3, 0.6],
    ],
    0.04,
  );
  await paint(
    2,
    [
      [0, 0, 0.6],
      [2, 0, 0.6],
      [0.4, 0.3, 1.1],
      [1.2, 0.3, 1.1],
    ],
    0.05,
  );
  const counts = await state("counts");
  assert.ok(
    counts.every((n) => n > 20),
    `${counts}`,
  );
  await page.getByRole("button", { name: "Train now" }).click();
  await page.waitForFunction(() => annotator.store.now.runs.some((run) => run.current && run.run === 1));
  await page.waitForFunction(() => annotator.store.now.mode === "prediction");
  await settled();
  const shares = await page.evaluate(() => {
    const said = annotator.stage.chunks.flatMap((c) => [...c.prediction]);
    return [0, 1, 2].map((id) => said.filter((s) => s === id).length / said.length);
  });
  assert.ok(shares[0] > 0.5 && shares[1] > 0.03 && shares[2] > 0.001 && shares[2] < 0.1, `${shares}`);
  const legend = await page.locator(".legend .entry").allTextContents();
  assert.deepEqual(legend, ["face", "ledge", "corner", "no label"]);
  if (process.env.SCREENSHOT_CLASSES) await page.screenshot({ path: process.env.SCREENSHOT_CLASSES });
});

test("renames, adds and removes what is not painted", async () => {
  await page.keyboard.press("Shift+E");
  const dialog = page.getByRole("dialog", { name: "Classes" });
  assert.ok(await dialog.getByRole("checkbox").isDisabled(), "edges stay out");
  assert.ok(await dialog.getByRole("button", { name: "Remove" }).first().isDisabled(), "it is painted");
  await dialog.getByLabel("Name of the class").nth(2).fill("tip");
  await dialog.getByRole("button", { name: "Add a class" }).click();
  await dialog.getByLabel("Name of the class").nth(3).fill("pipe");
  await dialog.getByRole("button", { name: "Use these classes" }).click();
  await dialog.waitFor({ state: "hidden" });
  await hasRows(5);
  assert.deepEqual(await rows(), ["face", "ledge", "tip", "pipe", "eraser"]);
  assert.equal((await state("runs")).length, 1, "names need no training");
  await page.keyboard.press("Shift+E");
  await dialog.getByRole("button", { name: "Remove" }).nth(3).click();
  await dialog.getByRole("button", { name: "Use these classes" }).click();
  await dialog.waitFor({ state: "hidden" });
  await hasRows(4);
  // The eye of a class hides its points, and the keys say their names.
  await page.keyboard.press("Shift+Digit3");
  assert.deepEqual(await page.evaluate(() => [...annotator.store.now.hidden]), [2]);
  await page.keyboard.press("Shift+Digit3");
  await page.keyboard.press("?");
  await page.getByText("paint tip").waitFor();
  await page.keyboard.press("Escape");
});

test("saves the cloud with their names", async () => {
  await page.getByRole("button", { name: "Save cloud" }).click();
  await page.locator(".notice", { hasText: "roof_annotated.ply" }).waitFor();
  const saved = path.join(folder, "roof_annotated.ply");
  const head = fs.readFileSync(saved).subarray(0, 2000).toString("latin1");
  assert.match(head, /comment pcednet class 2 #c83296 tip\n/);
  const counts = await state("counts");
  const painted = readPly(saved).column("scalar_painted_label");
  assert.equal(painted.filter((label) => label === 2).length, counts[2]);
});

complainedOfNothing(its);
