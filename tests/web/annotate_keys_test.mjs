// The page by its keys alone, and where they must do nothing. Environment as annotator.mjs.
import assert from "node:assert/strict";
import { test } from "node:test";

import { complainedOfNothing, openAnnotator } from "./annotator.mjs";

const its = openAnnotator("keys", { ready: () => (page = its.page) });
const { paint, settled, state } = its;
let page;

const focused = () =>
  page.evaluate(() => document.activeElement.getAttribute("aria-label") ?? document.activeElement.textContent);
const pressOn = async (name) => {
  await page.getByRole("button", { name }).focus();
  await page.keyboard.press("Enter");
};
const blur = () => page.evaluate(() => document.activeElement.blur());

test("a button keeps the focus while and after it works", async () => {
  await its.trainAfterStrokes(false);
  await paint(2, [[1, 0, 0.6]], 0.05);
  await paint(0, [[1, 0.15, 0.6]], 0.05);
  await pressOn("Save project");
  await page.locator(".notice", { hasText: "Saved" }).waitFor();
  assert.match(await focused(), /^Save project/);
  await pressOn(/^Train now/);
  await its.shown(1);
  await page.waitForFunction(() => !annotator.store.now.training?.active);
  assert.match(await focused(), /^Train now/);
  await pressOn("Find lines");
  await page.waitForFunction(() => annotator.store.now.lines.version > 0 && !annotator.store.now.lines.searching);
  assert.match(await focused(), /^Find lines/);
});

test("Undo of the last step does too, and Enter on it then does nothing", async () => {
  for (let left = 1; left >= 0; --left) {
    await pressOn("Undo");
    await page.waitForFunction((n) => annotator.store.now.undo === n, left);
    await settled();
  }
  assert.equal(await focused(), "Undo");
  assert.ok(await page.getByRole("button", { name: "Undo" }).isDisabled());
  await page.keyboard.press("Enter");
  await settled();
  assert.deepEqual([await state("undo"), await state("redo")], [0, 2]);
});

test("Enter paints only where the focus or the pointer is in the cloud", async () => {
  await page.mouse.move(5, 5);
  await blur();
  await page.keyboard.press("Enter");
  await settled();
  assert.deepEqual([await state("undo"), await state("redo")], [0, 2]);
  assert.equal(await page.evaluate(() => document.activeElement.tagName), "CANVAS", "ready for the next Enter");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => annotator.store.now.undo === 1);
  await settled();
});

test("a slider has PageUp and PageDown for itself", async () => {
  const before = await state("pointSize");
  await page.getByRole("slider", { name: "Point size" }).press("PageUp");
  assert.ok((await state("pointSize")) > before);
  await blur();
});

test("Enter in the name of a class takes the classes, Cancel does not", async () => {
  const dialog = page.getByRole("dialog", { name: "Classes" });
  const add = async (name) => {
    await page.keyboard.press("Shift+E");
    await dialog.getByRole("button", { name: "Add a class" }).click();
    await dialog.getByLabel("Name of the class").last().fill(name);
  };
  await add("pole");
  await dialog.getByRole("button", { name: "Cancel" }).click();
  await dialog.waitFor({ state: "hidden" });
  await add("Sharp edge");
  await page.keyboard.press("Enter");
  await dialog.getByText('There are two classes "Sharp edge".').waitFor();
  await dialog.getByLabel("Name of the class").last().fill("pipe");
  await page.keyboard.press("Enter");
  await dialog.waitFor({ state: "hidden" });
  await page.waitForFunction(() => annotator.store.now.classes.some((one) => one.name === "pipe"));
  assert.ok(!(await state("classes")).some((one) => one.name === "pole"));
});

test("a question is read out as it is written, not as its button", async () => {
  await pressOn("Save project");
  const question = page.getByRole("dialog", { name: /exists\. Replace the file\?/ });
  await question.getByRole("button", { name: "Cancel" }).click();
  await question.waitFor({ state: "hidden" });
});

test("a window that may only look offers no settings of the training", async () => {
  const second = await its.browser.newPage();
  await second.goto(its.server.address);
  await second.getByText("this one is read-only").waitFor();
  const auto = second.getByRole("checkbox", { name: "Train after each stroke" });
  assert.ok(await auto.isDisabled());
  assert.ok(await second.getByLabel("Start from").isDisabled());
  assert.ok(await second.getByRole("radio", { name: "2 classes" }).isDisabled());
  await second.getByRole("button", { name: "Take over" }).click();
  await second.waitForFunction(() => annotator.store.now.writer);
  assert.ok(await auto.isEnabled());
  await second.close();
});

complainedOfNothing(its);
