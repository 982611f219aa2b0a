// The annotator that corrects a model: what a new user sees first, how strokes are judged, and what the page says when
// the program is gone. Environment as annotate_test.mjs; SCREENSHOT_START, if set, is where a picture of the start goes.
import assert from "node:assert/strict";
import { once } from "node:events";
import fs from "node:fs";
import path from "node:path";
import { test } from "node:test";

import { roof, writeRoof } from "./annotate_cloud.mjs";
import { complainedOfNothing, openAnnotator } from "./annotator.mjs";
import { lastingPort, serve } from "./browser.mjs";

const its = openAnnotator("start", {
  prepare: async (folder) => {
    writeRoof(path.join(folder, "roof.ply"), roof());
    return [path.join(folder, "roof.ply"), "--model", "scan", "--port", await lastingPort()];
  },
  ready: () => (page = its.page),
});
const { folder, paint, settled, shown, trainAfterStrokes } = its;
const input = path.join(folder, "roof.ply");
let page;

async function kill() {
  const ended = once(its.server.program, "exit");
  its.server.program.kill("SIGKILL");
  await ended;
}

/** Shares of the page's points predicted as 0, 1, 2, 3. */
const predicted = () =>
  page.evaluate(() => {
    const count = [0, 0, 0, 0];
    let all = 0;
    for (const { prediction } of annotator.stage.chunks) prediction.forEach((c) => (c < 4 && ++count[c], ++all));
    return count.map((n) => n / all);
  });

test("shows at once what the model finds, boundary too", async () => {
  await shown(0);
  await page.getByText("This is what model scan finds. Paint where it is wrong.").waitFor();
  await page.waitForFunction(() => annotator.stage.chunks.some((c) => c.prediction.includes(3)));
  const shares = await predicted();
  assert.ok(shares[0] > 0.5 && shares[2] > 0.02 && shares[3] > 0.005, `${shares}`);
  assert.equal(
    await page.getByRole("combobox", { name: "Start from" }).locator(":checked").textContent(),
    "model scan",
  );
  assert.ok((await page.locator(".legend").textContent()).includes("boundary"));
  await settled();
  if (process.env.SCREENSHOT_START) await page.screenshot({ path: process.env.SCREENSHOT_START });
});

test("cuts no number beside the curve of the loss", async () => {
  const { written, cut } = await page.evaluate(async () => {
    const written = [];
    const cut = [];
    const canvas = CanvasRenderingContext2D.prototype;
    const { fillText } = canvas;
    canvas.fillText = function (text, x, y, ...more) {
      const width = this.measureText(text).width;
      const left = this.getTransform().transformPoint({ x, y }).x;
      written.push(text);
      if (left - (this.textAlign === "right" ? width : 0) < 0) cut.push(text);
      fillText.call(this, text, x, y, ...more);
    };
    const training = {
      run: 1,
      active: true,
      epochs: 3,
      epoch: [1, 2, 3],
      loss: [0.171551, 0.17153, 0.17149],
      context: [],
    };
    annotator.store.set({ training });
    while (!written.includes("3")) await new Promise((done) => setTimeout(done, 20));
    canvas.fillText = fillText;
    annotator.store.set({ training: { ...training, active: false } });
    return { written, cut };
  });
  // What is shown is what the start finds: no training has made it.
  await page.locator(".curves").waitFor({ state: "hidden" });
  await page.evaluate(() => annotator.store.set({ training: null }));
  assert.ok(
    written.some((text) => /^0\.171\d+$/.test(text)),
    `${written}`,
  );
  assert.deepEqual(cut, []);
});

test("darkens what lies behind with eye-dome lighting, and nothing else", async () => {
  /** The first pixel, which is background, and the mean brightness of all others of another colour. */
  const look = () =>
    page.evaluate(async () => {
      const image = await createImageBitmap(await annotator.stage.picture());
      const context = new OffscreenCanvas(image.width, image.height).getContext("2d");
      context.drawImage(image, 0, 0);
      const { data } = context.getImageData(0, 0, image.width, image.height);
      const first = [...data.slice(0, 3)];
      let sum = 0,
        points = 0;
      for (let i = 0; i < data.length; i += 4) {
        if (first.every((c, k) => c === data[i + k])) continue;
        sum += data[i] + data[i + 1] + data[i + 2];
        points += 1;
      }
      return { first, points, mean: sum / points };
    });
  const press = async () => {
    await page.keyboard.press("i");
    await page.waitForTimeout(50);
    await settled();
  };
  assert.equal(await page.getByRole("checkbox", { name: "Eye-dome lighting" }).isChecked(), false, "without a card");
  const plain = await look();
  await press();
  const lit = await look();
  assert.deepEqual(lit.first, plain.first);
  assert.ok(Math.abs(lit.points / plain.points - 1) < 0.02, `${lit.points} points, ${plain.points} before`);
  assert.ok(lit.mean < 0.98 * plain.mean && lit.mean > 0.7 * plain.mean, `${lit.mean}, ${plain.mean} before`);
  await press();
  assert.deepEqual(await look(), plain);
});

test("begins with a brush thin enough for an edge, which may be made thinner", async () => {
  const inSpacings = () => page.evaluate(() => annotator.store.now.radius / annotator.store.now.session.spacing);
  const first = await inSpacings();
  assert.ok(first >= 1.5 && first <= 2, `${first}`);
  for (let i = 0; i < 12; ++i) await page.keyboard.press("[");
  assert.ok((await inSpacings()) < 0.75);
  await page.evaluate((r) => annotator.store.set({ radius: r * annotator.store.now.session.spacing }), first);
});

test("shows another model's answer as soon as it is chosen, without a stroke", async () => {
  const start = page.getByRole("combobox", { name: "Start from" });
  await start.selectOption({ label: "model worn" });
  await page.getByText("This is what model worn finds.").waitFor();
  await page.locator(".notice", { hasText: "Model worn knows no smooth edges: it learns two classes." }).waitFor();
  await start.selectOption({ label: "model scan" });
  await page.getByText("This is what model scan finds.").waitFor();
  assert.equal((await its.state("settings")).classes, 3, "as before the model of two");
});

test("learns from one stroke, and says that this is too little to tell how right it is", async () => {
  const before = await predicted();
  const hint = page.getByText("Paint where the prediction is wrong.");
  assert.ok(await hint.isVisible());
  await trainAfterStrokes(false);
  await paint(0, [[0.2, 0.7, 0.6]], 0.1);
  assert.ok(await hint.isHidden(), "nobody who paints needs it");
  await page.getByText("prediction, out of date").waitFor();
  await trainAfterStrokes(true);
  await shown(1);
  await page.getByText("prediction, out of date").waitFor({ state: "detached" });
  await page.getByText("Not enough strokes to tell how right it is").waitFor();
  await settled();
  // Two networks, two curves: the loss of the second is of other samples.
  const { epoch, loss, context } = await its.state("training");
  assert.deepEqual([epoch.length, loss.length, context.length], [30, 30, 30]);
  loss.forEach((of, k) => assert.deepEqual([of === null, context[k] === null], [k >= 15, k < 15], `epoch ${k + 1}`));
  await page.locator(".curves").getByText("of the context network").waitFor();
  const now = await predicted();
  before.forEach((share, c) => assert.ok(Math.abs(share - now[c]) < 0.05, `class ${c}: ${share}, then ${now[c]}`));
});

test("judges by whole strokes once there are two of two classes", async () => {
  await paint(0, [[1.6, 0.7, 0.6]], 0.1);
  await paint(2, [[1, 0, 0.6]], 0.02);
  await paint(2, [[1.6, 0, 0.6]], 0.02);
  await page.getByText(/Right on held-out strokes: [\d.]+ %; model scan: [\d.]+ %\./).waitFor();
});

test("takes every step between uncertain places, however slow the answers", async () => {
  await page.route("**/api/uncertain*", async (route) => {
    await new Promise((resolve) => setTimeout(resolve, 300));
    await route.continue();
  });
  for (const key of ["n", "n", "Shift+N", "Shift+N"]) await page.keyboard.press(key);
  await page.waitForFunction(() => {
    const { uncertain } = annotator.store.now;
    return uncertain && uncertain.rank === uncertain.of; // before the first
  });
  await page.unroute("**/api/uncertain*");
});

test("accepts what is predicted at an uncertain place", async () => {
  await page.keyboard.press("n");
  await page.waitForFunction(() => annotator.store.now.uncertain?.rank === 1);
  await page.getByText(/Place 1 of \d+: [a-z -]+, confidence [\d.]+ %/).waitFor();
  const before = await page.evaluate(() => {
    const { counts, uncertain } = annotator.store.now;
    return { painted: counts[0] + counts[1] + counts[2], of: uncertain.prediction, counts };
  });
  await page.getByRole("button", { name: "It is right" }).click();
  await page.waitForFunction((was) => annotator.store.now.counts[was.of] > was.counts[was.of], before);
  await page.keyboard.press("Control+z");
  await page.waitForFunction((n) => annotator.store.now.counts.reduce((a, b) => a + b) === n, before.painted);
});

const painted = () =>
  page.evaluate(() => annotator.stage.chunks.reduce((n, c) => n + c.labels.filter((l) => l < 3).length, 0));

/** Painted points once all answers of the program have come. */
async function finallyPainted() {
  let before = -1;
  for (let now = await painted(); now !== before; now = await painted()) {
    before = now;
    await page.waitForTimeout(1000);
  }
  return before;
}

/** Where a stroke of the mouse begins. */
async function aim() {
  await page.evaluate(() => annotator.stage.fit("first"));
  await settled();
  const box = await page.locator("canvas").first().boundingBox();
  await page.evaluate(() => annotator.store.set({ radius: 0.1, paintClass: 1, tool: "brush" }));
  return [box.x + box.width / 2, box.y + box.height / 2];
}

/** The answer of the program may come after the page has said what it will be. */
async function expectPainted(points) {
  for (let i = 0; i < 100 && (await painted()) !== points; ++i) await page.waitForTimeout(100);
  assert.equal(await painted(), points);
}

test("asks before it is left while strokes are on their way to a slow program", async () => {
  const held = [];
  let slow = true;
  await page.route("**/api/stroke*", (route) => (slow ? held.push(route) : route.continue()));
  const before = await its.state("undo");
  for (const edgeClass of [1, 2]) await its.stroke(edgeClass, [[0.2, 0.7, 0.6]], 0.1);
  const left = page.reload().then(
    () => assert.fail("left without a question"),
    () => {}, // dismissed
  );
  const [question] = await Promise.race([once(page, "dialog"), left]);
  assert.equal(question.type(), "beforeunload");
  await question.dismiss();
  slow = false;
  for (const route of held) await route.continue();
  await settled();
  assert.equal(await its.state("undo"), before + 2);
  await page.unrouteAll();
  for (const undo of [before + 1, before]) {
    await page.keyboard.press("Control+z");
    await page.waitForFunction((steps) => annotator.store.now.undo === steps, undo);
  }
  await settled();
});

test("loses no stroke and goes on by itself when the program is killed and started again", async () => {
  await settled();
  const second = await its.browser.newPage();
  await second.goto(its.server.address);
  await second.getByText("this one is read-only").waitFor();
  const kept = await finallyPainted();
  const eye = () => page.evaluate(() => [...annotator.stage.camera.view.matrix]);
  const middle = await aim();
  await page.mouse.move(...middle);
  await page.mouse.down();
  await kill(); // in the middle of the stroke
  await page.mouse.move(middle[0] + 20, middle[1], { steps: 3 });
  const drawn = await painted();
  assert.ok(drawn > kept, "the stroke is drawn");
  await page.mouse.up();
  await page.getByText("Start it again as before, and this page goes on. One stroke waits.").waitFor();
  await expectPainted(drawn);
  const view = await eye();
  await page.mouse.down();
  await page.mouse.up();
  await page.getByText("pcednet does not answer: nothing can be painted.").waitFor();
  for (const name of ["Save project", "Save cloud", "Train now", "Find lines", /^Classes/]) {
    assert.ok(await page.getByRole("button", { name }).isDisabled(), `${name}`);
  }
  await page.keyboard.press("Control+s");
  await page.locator(".notice span", { hasText: /^pcednet does not answer$/ }).waitFor();
  const before = its.server.address;
  let asked = 0; // the first answer gets lost, and the program is ready before the second arrives
  const session = (url) => url.pathname === "/api/session";
  await page.route(session, async (route) => {
    if (++asked === 1) {
      await second.waitForFunction(() => annotator.store.now.connected && annotator.store.now.writer);
      return route.abort();
    }
    const response = await route.fetch();
    if (asked === 2) await page.evaluate(() => annotator.client.events.dispatchEvent(new MessageEvent("ready")));
    await page.waitForTimeout(500);
    await route.fulfill({ response });
  });
  its.server = await serve([input]);
  assert.equal(its.server.address, before);
  await page.waitForFunction(() => annotator.store.now.undo === 5 && annotator.store.now.connected);
  await page.unrouteAll({ behavior: "wait" });
  assert.ok(asked > 2);
  assert.equal(await page.locator(".notice span", { hasText: /^pcednet does not answer/ }).count(), 0);
  await settled();
  assert.deepEqual(await eye(), view, "the view is as it was");
  await expectPainted(drawn);
  assert.ok(await page.evaluate(() => annotator.store.now.writer));
  await second.getByText("this one is read-only").waitFor();
  await second.close();
  await page.waitForFunction(() => annotator.store.now.runs.some((r) => r.current && r.run > 1));
  await page.keyboard.press("Control+z");
  await page.waitForFunction(() => annotator.store.now.undo === 4);
  await settled();
  await expectPainted(kept);
});

test("takes back what the program never got if it starts at another address, and says so", async () => {
  await settled();
  const kept = await finallyPainted();
  const middle = await aim();
  await page.mouse.move(...middle);
  await page.mouse.down();
  await kill();
  fs.rmSync(path.join(folder, "roof_annotation.json.address"));
  await page.mouse.move(middle[0] + 20, middle[1], { steps: 3 });
  assert.ok((await painted()) > kept, "the stroke is drawn");
  await page.mouse.up();
  its.server = await serve([input, "--port", its.server.port]);
  await page.getByText("pcednet was started again: open the address that it printed.").waitFor();
  await page.getByText("The stroke was not applied").waitFor();
  await expectPainted(kept);
  await page.goto(its.server.address);
  await settled();
  assert.equal(await page.evaluate(() => annotator.store.now.undo), 4);
  await page.waitForFunction(() => annotator.store.now.writer);
});

complainedOfNothing(its);
