// How the annotator shows a cloud: framing, views along the axes, orthographic, the clipping box, slices, measuring,
// painted points, dark and light. Environment as annotate_test.mjs.
import assert from "node:assert/strict";
import { test } from "node:test";

import { complainedOfNothing, openAnnotator } from "./annotator.mjs";

const its = openAnnotator("view", {
  ready: async () => {
    page = its.page;
    await its.trainAfterStrokes(false);
    await settled();
  },
});
const { settled, state } = its;
let page;

/** The flight is over, all is drawn. */
async function arrived() {
  const place = () => page.evaluate(() => [annotator.stage.width, ...annotator.stage.camera.view.matrix].join());
  let before,
    now = await place();
  do {
    before = now;
    await page.waitForTimeout(450);
    await settled();
    now = await place();
  } while (now !== before);
}

async function press(key) {
  await page.keyboard.press(key);
  await arrived();
}

/** Pixels of the canvas where places of the cloud are drawn. */
const seenAt = (places) =>
  page.evaluate((all) => {
    const { stage, store } = annotator;
    const { matrix: m } = stage.camera.view;
    return all.map((place) => {
      const p = place.map((c, i) => c - store.now.session.origin[i]);
      const at = (r) => m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r];
      return [(at(0) / at(3) + 1) * 0.5 * stage.width, (1 - at(1) / at(3)) * 0.5 * stage.height];
    });
  }, places);

/** What is drawn: the colour of the corner, how many pixels differ from it, where, and how many are of a rim's blue. */
const look = () =>
  page.evaluate(async () => {
    const image = await createImageBitmap(await annotator.stage.picture());
    const context = new OffscreenCanvas(image.width, image.height).getContext("2d");
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, image.width, image.height);
    const first = [...data.slice(0, 3)];
    const box = { left: Infinity, right: -1, top: Infinity, bottom: -1 };
    let points = 0,
      rims = 0;
    for (let i = 0; i < data.length; i += 4) {
      if (first.every((c, k) => c === data[i + k])) continue;
      const [x, y] = [(i / 4) % image.width, Math.floor(i / 4 / image.width)];
      points += 1;
      box.left = Math.min(box.left, x / image.width);
      box.right = Math.max(box.right, x / image.width);
      box.top = Math.min(box.top, y / image.height);
      box.bottom = Math.max(box.bottom, y / image.height);
      if (data[i + 2] > 200 && data[i + 2] - data[i] > 80) rims += 1;
    }
    return { first, points, box, rims };
  });

test("frames the cloud itself: whole, in the middle, as large as there is room", async () => {
  for (const [width, height] of [
    [1280, 720],
    [700, 900],
  ]) {
    await page.setViewportSize({ width, height });
    await arrived();
    await press("f");
    const { box } = await look();
    const [across, down] = [box.right - box.left, box.bottom - box.top];
    assert.ok(Math.max(across, down) > 0.75 && Math.max(across, down) < 0.9, JSON.stringify(box));
    assert.ok(
      Math.abs(box.right + box.left - 1) < 0.05 && Math.abs(box.top + box.bottom - 1) < 0.05,
      JSON.stringify(box),
    );
  }
  await page.setViewportSize({ width: 1280, height: 720 });
});

test("looks along an axis, and in parallel", async () => {
  // The corners of the roof's ground, clockwise from the origin as seen from above.
  const ground = [0, 0.6].flatMap((z) => [
    [0, 0, z],
    [2, 0, z],
    [2, 1.4, z],
    [0, 1.4, z],
  ]);
  await press("z");
  const tapered = await seenAt(ground);
  assert.ok(tapered[1][0] > tapered[0][0] + 100 && tapered[3][1] < tapered[0][1] - 100, "x to the right, y up");
  assert.ok(
    Math.hypot(tapered[0][0] - tapered[4][0], tapered[0][1] - tapered[4][1]) > 10,
    "what is below looks smaller",
  );
  await press("Shift+F");
  assert.ok(await page.getByRole("checkbox", { name: "Orthographic" }).isChecked());
  const parallel = await seenAt(ground);
  for (const i of [0, 1, 2, 3]) {
    assert.ok(
      Math.hypot(parallel[i][0] - parallel[i + 4][0], parallel[i][1] - parallel[i + 4][1]) < 1.5,
      `corner ${i}`,
    );
  }
  const share = (points) => Math.abs(points[5][0] - points[4][0]);
  assert.ok(Math.abs(share(parallel) / share(tapered) - 1) < 0.3, "about as large as in perspective");
  // The wheel still keeps what is under the pointer where it is, and picking works.
  const box = await page.locator("canvas").first().boundingBox();
  const at = [box.x + parallel[5][0] - 40, box.y + parallel[5][1] - 40];
  const under = () =>
    page.evaluate(([x, y]) => annotator.stage.pick(x, y)?.position, [parallel[5][0] - 40, parallel[5][1] - 40]);
  const before = await under();
  await page.mouse.move(...at);
  await page.mouse.wheel(0, -300);
  await page.waitForTimeout(400);
  await settled();
  const after = await under();
  assert.ok(Math.hypot(...before.map((c, i) => c - after[i])) < 0.02, `${before} then ${after}`);
  const nearer = await seenAt(ground);
  assert.ok(share(nearer) > 1.3 * share(parallel));
  for (const [key, axis, sign] of [
    ["w", 1, 1],
    ["Shift+W", 1, -1],
    ["q", 0, -1],
    ["Shift+Q", 0, 1],
    ["Shift+Z", 2, 1],
  ]) {
    await press(key);
    const forward = await page.evaluate(() => {
      const { matrix: m } = annotator.stage.camera.view;
      return [m[3], m[7], m[11]];
    });
    assert.ok(sign * forward[axis] > 0.999, `${key}: ${forward}`);
  }
  await press("Shift+F");
  await press("f");
});

test("shows what it turns about while it turns", async () => {
  const box = await page.locator("canvas").first().boundingBox();
  const middle = [box.x + box.width / 2, box.y + box.height / 2];
  const pivot = page.locator(".pivot");
  assert.equal(await pivot.getAttribute("visibility"), "hidden");
  await page.mouse.move(...middle);
  await page.mouse.down({ button: "right" });
  await page.mouse.move(middle[0] + 30, middle[1], { steps: 3 });
  assert.equal(await pivot.getAttribute("visibility"), "visible");
  await page.mouse.up({ button: "right" });
  assert.equal(await pivot.getAttribute("visibility"), "hidden");
  await press("f");
});

test("clips nothing at first, then what is dragged away by a handle", async () => {
  const all = await look();
  assert.equal(await page.locator(".handle:visible").count(), 0);
  await press("c");
  const boxed = await look();
  assert.ok(Math.abs(boxed.points / all.points - 1) < 0.001, `${boxed.points} of ${all.points}`);
  const handle = page.locator('.handle[data-face="z max"]');
  const { x, y, width, height } = await handle.boundingBox();
  const top = (await state("clip")).box.max[2];
  await page.mouse.move(x + width / 2, y + height / 2);
  await page.mouse.down();
  await page.mouse.move(x + width / 2, y + height / 2 + 60, { steps: 6 });
  await page.mouse.up();
  await settled();
  const { clip, session, counts } = await page.evaluate(() => annotator.store.now);
  assert.ok(clip.box.max[2] < top - 0.05, `${clip.box.max}`);
  assert.deepEqual(clip.box.max.slice(0, 2), session.bounds.max.slice(0, 2));
  assert.deepEqual(counts, [0, 0, 0], "a handle paints nothing");
  const moved = await handle.boundingBox();
  assert.ok(Math.abs(moved.y - y - 60) < 4, `the handle follows the mouse: ${moved.y - y}`);
  assert.ok((await look()).points < 0.95 * all.points);
});

test("shows a slice across an axis and steps through the cloud", async () => {
  await page.locator("summary", { hasText: "Clipping box" }).click();
  await page.getByRole("button", { name: "Slice x" }).click();
  await settled();
  const { clip, session } = await page.evaluate(() => annotator.store.now);
  const thickness = clip.box.max[0] - clip.box.min[0];
  assert.ok(Math.abs(thickness / (session.bounds.max[0] - session.bounds.min[0]) - 0.04) < 1e-6);
  await page.keyboard.press(">");
  await settled();
  const next = (await state("clip")).box;
  assert.ok(Math.abs(next.min[0] - clip.box.max[0]) < 1e-9);
  const { points } = await look();
  assert.ok(points > 200);
  await page.getByRole("button", { name: "Reset", exact: true }).click();
  await settled();
  assert.ok((await look()).points > 4 * points);
});

test("measures the distance between two points that are clicked", async () => {
  await press("f");
  const box = await page.locator("canvas").first().boundingBox();
  const corners = [
    [0, 0, 0.6],
    [2, 0, 0.6],
  ];
  await page.keyboard.press("u");
  for (const [x, y] of await seenAt(corners)) await page.mouse.click(box.x + x, box.y + y);
  const words = await page.locator(".measure-words").textContent();
  assert.ok(Math.abs(parseFloat(words) - 2) < 0.05, words);
  assert.deepEqual(await state("counts"), [0, 0, 0], "measuring paints nothing");
  await page.keyboard.press("Escape");
  assert.equal(await page.locator(".measure-words").textContent(), "");
  await page.keyboard.press("b");
});

test("tells painted points from predicted ones by their rim", async () => {
  const before = await look();
  assert.equal(before.rims, 0);
  const box = await page.locator("canvas").first().boundingBox();
  await page.evaluate(() => annotator.store.set({ radius: 0.1, pointSize: 3 }));
  await page.keyboard.press("1");
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.move(box.x + 5, box.y + 5);
  await settled();
  const { rims } = await look();
  assert.ok(rims > 100, `${rims}`);
  await page.getByText("prediction, out of date").waitFor();
  await page.evaluate(() => annotator.store.set({ mode: "labels" }));
  await settled();
  assert.equal((await look()).rims, 0);
});

test("says that strokes are newer than the prediction after a reload, too, and keeps how one likes to look", async () => {
  await page.evaluate(() => {
    const { store } = annotator;
    store.set({ mode: "prediction", pointSize: 2.5, safePalette: true, radius: 4 * store.now.session.spacing });
  });
  await page.reload();
  await arrived();
  await page.getByText("prediction, out of date").waitFor();
  const { pointSize, safePalette, radius, session } = await page.evaluate(() => annotator.store.now);
  assert.deepEqual([pointSize, safePalette], [2.5, true]);
  assert.ok(Math.abs(radius / session.spacing - 4) < 1e-9, `${radius / session.spacing}`);
  await page.evaluate(() => annotator.store.set({ pointSize: 1.7, safePalette: false, mode: "labels" }));
  await settled();
});

test("says that the graphics card is lost, and draws as before when it is back", async () => {
  const before = await look();
  const words = page.getByText("The browser has lost the graphics card");
  assert.ok(await words.isHidden());
  await page.evaluate(() => {
    const gl = annotator.stage.canvas.getContext("webgl2");
    window.card = gl.getExtension("WEBGL_lose_context");
    window.card.loseContext();
  });
  await words.waitFor();
  await page.evaluate(() => window.card.restoreContext());
  await words.waitFor({ state: "hidden" });
  await settled();
  const { first, points } = await look();
  assert.deepEqual(first, before.first);
  assert.ok(Math.abs(points / before.points - 1) < 0.01, `${points} points, ${before.points} before`);
});

test("tells what is chosen, and the colours, in forced colours, too", async () => {
  await page.emulateMedia({ forcedColors: "active" });
  const style = (selector, key) =>
    page.evaluate(([s, k]) => getComputedStyle(document.querySelector(s))[k], [selector, key]);
  assert.equal(await style(".class .swatch", "backgroundColor"), "rgb(255, 255, 255)");
  assert.equal(await style(".class:nth-child(3) .swatch", "backgroundColor"), "rgb(168, 0, 0)");
  for (const selector of [".tool[aria-pressed=true]", ".class:has(input:checked)", ".segments input:checked + span"]) {
    assert.equal(await style(selector, "outlineStyle"), "solid", selector);
  }
  assert.equal(await style(".tool[aria-pressed=false]", "outlineStyle"), "none");
  await page.emulateMedia({ forcedColors: "none" });
});

test("is light or dark as the user likes", async () => {
  const lightness = async () => (await look()).first.reduce((sum, c) => sum + c) / 3;
  const light = await lightness();
  assert.ok(light > 170, `${light}`);
  await page.getByRole("radio", { name: "dark" }).check({ force: true });
  await settled();
  assert.ok((await lightness()) < 70);
  const paper = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  assert.equal(paper, "rgb(22, 24, 28)");
  await page.emulateMedia({ colorScheme: "dark" });
  await page.getByRole("radio", { name: "light", exact: true }).check({ force: true });
  await settled();
  assert.equal(await lightness(), light);
  await page.emulateMedia({ colorScheme: null });
  await page.getByRole("radio", { name: "system" }).check({ force: true });
});

complainedOfNothing(its);
