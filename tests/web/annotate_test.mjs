// The annotator end to end: a real server, headless Chromium, a mouse that paints; then the same on the command line.
// Environment: PCEDNET the program, PCEDNET_SOURCE_DIR the repository, CHROMIUM the browser;
// SCREENSHOT, SCREENSHOT_PHONE and SCREENSHOT_LINES, if set, are where pictures of the page go.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { once } from "node:events";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";

import { painted, readPly, roof, writeRoof } from "./annotate_cloud.mjs";
import { launch, serve } from "./browser.mjs";

const LEAST_MCC = 0.6; // of the prediction from a few strokes, against the true labels
const folder = fs.mkdtempSync(path.join(os.tmpdir(), "pcednet-annotate-"));
const input = path.join(folder, "roof.ply");
const complaints = [];
let browser, page, server, saved;

function pcednet(...words) {
  const done = spawnSync(process.env.PCEDNET, words, { encoding: "utf8" });
  assert.equal(done.status, 0, `pcednet ${words.join(" ")}: ${done.stderr}`);
}

async function stop() {
  const ended = once(server.program, "exit");
  server.program.kill("SIGINT");
  await ended;
}

async function open(address = server.address, begin = async () => {}) {
  // In a context that outlives the page: to be closed with it cuts off what the page says as it leaves.
  const context = await browser.newContext({ viewport: { width: 960, height: 640 } });
  const opened = await context.newPage();
  opened.setDefaultTimeout(120_000);
  opened.on(
    "console",
    (m) =>
      ["error", "warning"].includes(m.type()) &&
      !/GPU stall|GL Driver Message/.test(m.text()) &&
      complaints.push(m.text()),
  );
  opened.on("pageerror", (e) => complaints.push(e.message));
  opened.on(
    "request",
    (r) =>
      !r.url().startsWith(new URL(server.address).origin) &&
      !/^(data|blob):/.test(r.url()) &&
      r.url() !== address &&
      complaints.push(`asks for ${r.url()}`),
  );
  await begin(opened);
  await opened.goto(address);
  await opened.waitForURL(server.address);
  await settled(opened);
  return opened;
}

const settled = (of) =>
  of.waitForFunction(
    () => annotator.store.now.progress === null && annotator.stage.isSettled && !annotator.client.isBusy,
  );

const state = (name) => page.evaluate((key) => annotator.store.now[key], name);

/** Pixels of the window where a place of the cloud is seen with nothing before it; null for those that are not. */
const pixelsOf = (places) =>
  page.evaluate((all) => {
    const { stage } = annotator;
    const { left, top } = stage.canvas.getBoundingClientRect();
    const { matrix: m } = stage.camera.view;
    const origin = annotator.store.now.session.origin;
    return all.map((place) => {
      const p = place.map((c, i) => c - origin[i]);
      const at = (r) => m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r];
      const [x, y] = [(at(0) / at(3) + 1) * 0.5 * stage.width, (1 - at(1) / at(3)) * 0.5 * stage.height];
      if (!(x > 5 && y > 5 && x < stage.width - 5 && y < stage.height - 60)) return null;
      const picked = stage.pick(x, y);
      if (!picked || Math.hypot(...picked.position.map((c, i) => c - p[i])) > 0.08) return null;
      return [x + left, y + top];
    });
  }, places);

/** A stroke of the brush from place to place; waits for the server's answer. */
async function stroke(key, places) {
  const pixels = (await pixelsOf(places)).filter(Boolean);
  assert.ok(pixels.length >= 2, `the stroke ${JSON.stringify(places[0])} can be seen`);
  const [first, ...rest] = pixels.filter((_, i) => i % 3 === 0 || i === pixels.length - 1);
  await page.keyboard.press(key);
  await page.mouse.move(...first);
  await page.mouse.down();
  for (const pixel of rest) await page.mouse.move(...pixel); // the page dabs in between
  await page.mouse.up();
  await settled(page);
}

before(async () => {
  writeRoof(input, roof());
  server = await serve([input, "--model", "none"]);
  browser = await launch();
  page = await open();
});

after(async () => {
  await browser?.close();
  server?.program.kill("SIGKILL");
  fs.rmSync(folder, { recursive: true, force: true });
});

test("paints with the mouse, counts, trains by itself and shows a prediction", async () => {
  await page.evaluate(() => annotator.store.set({ radius: 0.016 }));
  for (const line of painted.sharp) await stroke("3", line);
  await page.evaluate(() => annotator.store.set({ radius: 0.035 }));
  for (const line of painted.flat) await stroke("1", line);
  const counts = await state("counts");
  assert.ok(counts[0] > 100 && counts[1] === 0 && counts[2] > 50, `${counts}`);
  assert.equal(await state("undo"), painted.sharp.length + painted.flat.length);
  await page.waitForFunction(
    () => annotator.store.now.runs.some((run) => run.current) && !annotator.store.now.training?.active,
  );
  await page.waitForFunction(
    (n) => annotator.store.now.runs.find((run) => run.current).painted === n,
    counts[0] + counts[2],
  );
  await settled(page);
  assert.equal(await state("mode"), "prediction");
  // What was painted is in the page as the server has it, and the prediction agrees with it.
  const [labelled, agreeing] = await page.evaluate(() =>
    annotator.stage.chunks.reduce(
      ([all, same], chunk) => {
        chunk.labels.forEach((label, i) => {
          if (label === 255) return;
          all += 1;
          same += Number(chunk.prediction[i] === label);
        });
        return [all, same];
      },
      [0, 0],
    ),
  );
  assert.equal(labelled, counts[0] + counts[2]);
  assert.ok(agreeing > 0.9 * labelled, `${agreeing} of ${labelled}`);
  if (process.env.SCREENSHOT) await page.screenshot({ path: process.env.SCREENSHOT });
});

test("undoes and redoes a stroke", async () => {
  const counts = await state("counts");
  await page.keyboard.press("Control+z");
  await settled(page);
  const undone = await state("counts");
  assert.ok(undone[0] < counts[0] && undone[2] === counts[2], `${undone}`);
  await page.keyboard.press("Control+Shift+z");
  await settled(page);
  assert.deepEqual(await state("counts"), counts);
});

test("erases within a lasso and paints within a polygon, by one stroke each", async () => {
  const counts = await state("counts");
  const [a, b] = await pixelsOf([painted.flat[0][1], painted.flat[0].at(-2)]);
  const round = [
    [a[0] - 12, a[1] - 25],
    [b[0] + 12, b[1] - 25],
    [b[0] + 12, b[1] + 25],
    [a[0] - 12, a[1] + 25],
  ];
  await page.keyboard.press("e");
  await page.keyboard.press("l");
  await page.mouse.move(...round[0]);
  await page.mouse.down();
  for (const corner of [...round.slice(1), round[0]]) await page.mouse.move(...corner, { steps: 5 });
  await page.mouse.up();
  await settled(page);
  const erased = await state("counts");
  assert.ok(erased[0] < counts[0] && erased[2] <= counts[2], `${erased}`);
  const pixels = () => page.evaluate(() => annotator.stage.canvas.toDataURL());
  // A prediction that arrives between two looks changes what is drawn: then look again.
  const moment = () =>
    page.evaluate(() => {
      const { predictionVersion, outOfDate, training } = annotator.store.now;
      return JSON.stringify([predictionVersion, outOfDate, training?.active]);
    });
  let before, left, again;
  do {
    before = await moment();
    await settled(page); // what has arrived by now is drawn
    left = await pixels();
    await page.evaluate(() => annotator.stage.redraw());
    await settled(page);
    again = await pixels();
  } while ((await moment()) !== before);
  assert.ok(again === left, "nothing of what was erased is left on the screen");
  await page.keyboard.press("1");
  await page.keyboard.press("g");
  for (const corner of round) await page.mouse.click(...corner);
  await page.keyboard.press("Enter");
  await settled(page);
  assert.ok((await state("counts"))[0] > counts[0]);
  for (let k = 0; k < 2; ++k) await page.keyboard.press("Control+z");
  await settled(page);
  assert.deepEqual(await state("counts"), counts);
  await page.keyboard.press("b");
});

test("paints without a mouse", async () => {
  const counts = await state("counts");
  await page.locator("canvas").first().focus();
  await page.keyboard.press("ArrowLeft");
  await settled(page);
  await page.keyboard.press("3");
  await page.keyboard.press("Enter");
  await settled(page);
  assert.ok((await state("counts"))[2] > counts[2]);
  await page.keyboard.press("Control+z");
  await settled(page);
  assert.deepEqual(await state("counts"), counts);
});

test("one finger paints or turns, two move the view and come nearer", async () => {
  const counts = await state("counts");
  const devtools = await page.context().newCDPSession(page);
  await devtools.send("Emulation.setTouchEmulationEnabled", { enabled: true, maxTouchPoints: 2 });
  const touch = (type, ...places) =>
    devtools.send("Input.dispatchTouchEvent", {
      type,
      touchPoints: places.map(([x, y], id) => ({ x, y, id })),
    });
  /** Fingers that go from places to places; the second follows the first. */
  const gesture = async (...tracks) => {
    await touch("touchStart", tracks[0][0]);
    if (tracks.length > 1) await touch("touchStart", ...tracks.map(([from]) => from));
    for (let k = 1; k <= 5; ++k) {
      await touch("touchMove", ...tracks.map(([from, to]) => from.map((c, i) => c + ((to[i] - c) * k) / 5)));
    }
    await touch("touchEnd");
    await settled(page);
  };
  const camera = () =>
    page.evaluate(() => {
      const { stage } = annotator;
      return { matrix: [...stage.camera.view.matrix], eye: stage.camera.view.eye, target: stage.camera.target };
    });
  const [a, b] = await pixelsOf([painted.flat[0][1], painted.flat[0].at(-2)]);
  const middle = a.map((c, i) => (c + b[i]) / 2);
  const near = ([x, y], dx, dy = 0) => [x + dx, y + dy];
  await page.keyboard.press("3");
  await page.keyboard.press("b");
  const before = await camera();
  await gesture([a, b]);
  const drawn = await state("counts");
  assert.ok(drawn[2] > counts[2], "one finger paints");
  assert.deepEqual(await camera(), before, "and leaves the view");
  const steps = await state("undo");
  await gesture([near(middle, -30), near(middle, -90)], [near(middle, 30), near(middle, 90)]);
  assert.deepEqual(await state("counts"), drawn, "two do not paint");
  assert.equal(await state("undo"), steps);
  assert.equal(
    await page.evaluate(() =>
      annotator.stage.chunks.reduce(
        (sum, chunk) => sum + chunk.labels.reduce((n, label) => n + Number(label !== 255), 0),
        0,
      ),
    ),
    drawn.reduce((x, y) => x + y),
    "what the first finger showed is gone",
  );
  const nearer = await camera();
  const place = painted.flat[0][1];
  const away = ({ eye }) => Math.hypot(...eye.map((c, i) => c - place[i]));
  assert.ok(away(nearer) < 0.6 * away(before), `${away(nearer)} of ${away(before)}`);
  await gesture([near(middle, -90), near(middle, -30)], [near(middle, 90), near(middle, 30)]);
  const back = await camera();
  assert.ok(Math.abs(away(back) / away(before) - 1) < 0.05, "together again: back again");
  await gesture([near(middle, -30), near(middle, 10)], [near(middle, 30), near(middle, 70)]);
  const slid = await camera();
  const forward = (m) => [m[3], m[7], m[11]];
  forward(slid.matrix).forEach((c, i) =>
    assert.ok(Math.abs(c - forward(back.matrix)[i]) < 1e-9, "sliding turns nothing"),
  );
  assert.notDeepEqual(slid.eye, back.eye);
  await page.keyboard.press("v");
  await gesture([middle, near(middle, 80, 40)]);
  const turned = await camera();
  assert.ok(
    forward(turned.matrix).some((c, i) => Math.abs(c - forward(slid.matrix)[i]) > 0.05),
    "one finger turns",
  );
  assert.deepEqual(await state("counts"), drawn);
  await devtools.send("Emulation.setTouchEmulationEnabled", { enabled: false });
  await page.keyboard.press("b");
  await page.keyboard.press("f");
  await page.keyboard.press("Control+z");
  await settled(page);
  assert.deepEqual(await state("counts"), counts);
});

test("shows the features at any scale, and only what is in the box", async () => {
  const colours = page.getByRole("combobox", { name: "Colour by" });
  await colours.selectOption({ label: "feature" });
  await page.getByRole("combobox", { name: "Feature" }).selectOption({ index: 1 });
  await settled(page);
  const values = () =>
    page.evaluate(() => annotator.stage.chunks.reduce((sum, c) => sum + c.values.reduce((a, b) => a + b, 0), 0));
  const before = await values();
  await page.keyboard.press(".");
  await page.waitForTimeout(300);
  await settled(page);
  assert.notEqual(await values(), before);
  const seen = () =>
    page.evaluate(() => {
      const { stage } = annotator;
      return stage.pick(stage.width / 2, stage.height / 2) !== null;
    });
  await page.keyboard.press("f");
  await settled(page);
  assert.ok(await seen());
  await page.locator("summary", { hasText: "Clipping box" }).click();
  const bottom = page.getByRole("slider", { name: "z to" });
  await bottom.focus();
  await bottom.press("Home"); // nothing but the lowest points
  await settled(page);
  assert.ok(!(await seen()));
  await page.getByRole("button", { name: "Reset", exact: true }).click();
  await settled(page);
  assert.ok(await seen());
  await colours.selectOption({ label: "prediction" });
});

test("hides a class", async () => {
  const seen = () =>
    page.evaluate(() => {
      const { stage } = annotator;
      const at = (x, y) => stage.pick(x * stage.width, y * stage.height) !== null;
      let hits = 0;
      for (let i = 1; i < 20; ++i) for (let j = 1; j < 20; ++j) hits += Number(at(i / 20, j / 20));
      return hits;
    });
  const all = await seen();
  await page.keyboard.press("Shift+Digit1");
  const hidden = await seen();
  await page.keyboard.press("Shift+Digit1");
  assert.ok(hidden < 0.75 * all, `${hidden} of ${all}`);
  assert.equal(await seen(), all);
});

test("tells a second window that it may look, until it takes over", async () => {
  const second = await open();
  await second.getByText("Another window is painting this cloud; this one is read-only.").waitFor();
  await second.getByRole("button", { name: "Take over" }).click();
  await page.getByText("Another window is painting this cloud; this one is read-only.").waitFor();
  await second.waitForFunction(() => annotator.store.now.writer);
  await page.getByRole("button", { name: "Take over" }).click();
  await page.waitForFunction(() => annotator.store.now.writer);
  await second.waitForFunction(() => !annotator.store.now.writer);
  await second.close();
});

test("still paints after a reload, and in another window once the first is closed", async () => {
  await page.reload();
  await settled(page);
  await page.waitForFunction(() => annotator.store.now.writer);
  const second = await open();
  assert.equal(await second.evaluate(() => annotator.store.now.writer), false);
  await second.keyboard.press("Control+z");
  const refusal = second.locator(".notice", { hasText: "Take over to paint here." });
  await refusal.waitFor();
  const [{ y: legend }, notice] = [await second.locator(".legend").boundingBox(), await refusal.boundingBox()];
  assert.ok(notice.y + notice.height <= legend, "a notice leaves the legend free");
  await page.close({ runBeforeUnload: true });
  await second.waitForFunction(() => annotator.store.now.writer);
  page = second;
});

test("paints if the window that painted leaves before this one hears of anything", async () => {
  let entered, left;
  const has = { entered: new Promise((done) => (entered = done)), left: new Promise((done) => (left = done)) };
  const opening = open(server.address, async (opened) => {
    await opened.route(/\/api\/(events|session)/, async (route) => {
      await has.left;
      await route.continue();
    });
    opened.on("response", (response) => new URL(response.url()).pathname === "/api/window" && entered());
  });
  await has.entered;
  const first = page.context();
  await page.close({ runBeforeUnload: true });
  while (first.pages().length > 0) await new Promise((done) => setTimeout(done, 100));
  left();
  page = await opening;
  await page.waitForFunction(() => annotator.store.now.writer);
  await page.unrouteAll({ behavior: "wait" });
});

test("paints again when the window that painted ends without a word", async () => {
  const second = await open();
  await second.getByRole("button", { name: "Take over" }).click();
  await page.waitForFunction(() => !annotator.store.now.writer);
  const session = await second.context().newCDPSession(second);
  session.send("Page.crash").catch(() => {}); // is never answered
  await page.waitForFunction(() => annotator.store.now.writer);
  await second.close();
});

for (const [name, width, height, room] of [
  ["phone", 390, 844, 300],
  ["tablet", 768, 1024, 450],
]) {
  test(`fits a ${name}: the cloud has room, nothing is cut off`, async () => {
    await page.setViewportSize({ width, height });
    await settled(page);
    const { canvas, cut } = await page.evaluate(() => {
      const closed = [...document.querySelectorAll("aside details:not([open])")];
      for (const section of closed) section.open = true;
      const { width, height } = annotator.stage.canvas.getBoundingClientRect();
      const names = [...document.querySelectorAll("header button, aside *")]
        .filter((e) => e.checkVisibility())
        .filter((e) => e.getBoundingClientRect().right > innerWidth || e.getBoundingClientRect().left < 0)
        .map((e) => `${e.tagName} ${e.textContent}`);
      for (const section of closed) section.open = false;
      return { canvas: { width, height }, cut: names };
    });
    assert.deepEqual(cut, []);
    await page.keyboard.press("?");
    const beyond = await page.locator("dialog.help").evaluate((dialog) => {
      const edge = dialog.getBoundingClientRect().right - parseFloat(getComputedStyle(dialog).paddingRight);
      return [...dialog.querySelectorAll("dd")].filter((dd) => dd.getBoundingClientRect().right > edge + 1).length;
    });
    assert.equal(beyond, 0, "the help keeps its margin");
    await page.keyboard.press("Escape");
    assert.ok(canvas.width > room && canvas.height > 350, JSON.stringify(canvas));
    // What does not fit below can be scrolled to.
    const last = page.locator("aside button:visible, aside input:visible").last();
    await last.scrollIntoViewIfNeeded();
    const box = await last.boundingBox();
    assert.ok(box.y >= 0 && box.y + box.height <= height, JSON.stringify(box));
    await page.evaluate(() => document.querySelector("aside").scrollTo(0, 0));
    if (name === "phone" && process.env.SCREENSHOT_PHONE) {
      await page.evaluate(() => document.querySelectorAll(".notice").forEach((notice) => notice.remove()));
      await page.evaluate(() => annotator.stage.fit("first"));
      await page.waitForTimeout(500); // the flight
      await settled(page);
      await page.screenshot({ path: process.env.SCREENSHOT_PHONE });
    }
    await page.setViewportSize({ width: 960, height: 640 });
    await settled(page);
  });
}

test("goes near an uncertain place, marks it, and back", async () => {
  await page.keyboard.press("f");
  await page.waitForTimeout(500); // the flight
  const rank = (wanted) =>
    page.waitForFunction(
      (n) => annotator.store.now.uncertain?.rank === (n ?? annotator.store.now.uncertain?.of),
      wanted,
    );
  const away = () =>
    page.evaluate(() => {
      const { eye } = annotator.stage.camera.view;
      return Math.hypot(...annotator.store.now.uncertain.position.map((c, i) => c - eye[i]));
    });
  const mark = page.locator(".mark");
  assert.equal(await mark.getAttribute("visibility"), "hidden");
  const far = await page.evaluate(() => Math.hypot(...annotator.stage.camera.view.eye));
  await page.keyboard.press("n");
  await rank(1);
  await page.waitForTimeout(500); // the flight
  await settled(page);
  assert.ok((await away()) < 0.6 * far, `${await away()} of ${far}`);
  assert.equal(await mark.getAttribute("visibility"), "visible");
  assert.ok(
    (await mark.getAttribute("class")) !== (await page.locator(".overlay circle").first().getAttribute("class")),
  );
  const [at, view] = [await mark.boundingBox(), await page.locator("canvas").first().boundingBox()];
  assert.ok(Math.abs(at.x + at.width / 2 - view.x - view.width / 2) < 0.1 * view.width, "it is in the middle");
  await page.keyboard.press("n");
  await rank(2);
  await page.keyboard.press("Shift+N");
  await rank(1);
  await page.keyboard.press("Shift+N");
  await rank(null);
});

test("saves beside the input and says where", async () => {
  // Training after the redo may be under way: what is saved must be what is shown.
  await page.waitForFunction(() => !annotator.store.now.training?.active);
  saved = {};
  for (const what of ["project", "model", "cloud"]) {
    await page.getByRole("button", { name: `Save ${what}` }).click();
    const notice = page.locator(".notice", { hasText: `Saved ${folder}` }).last();
    await notice.waitFor();
    saved[what] = /Saved (.*)×$/.exec(await notice.textContent())[1];
    await notice.getByRole("button", { name: "Close" }).click();
    assert.ok(fs.statSync(saved[what]).size > 0);
  }
});

test("finds lines, goes through them, and downloads those that are accepted", async () => {
  await page.evaluate(() => annotator.stage.fit("first"));
  await settled(page);
  /** Pixels of the canvas that are red, or whose blue is that of the line looked at. */
  const coloured = () =>
    page.evaluate(async () => {
      const { canvas } = annotator.stage;
      const flat = Object.assign(document.createElement("canvas"), { width: canvas.width, height: canvas.height });
      const context = flat.getContext("2d");
      context.drawImage(canvas, 0, 0);
      const { data } = context.getImageData(0, 0, flat.width, flat.height);
      const n = { red: 0, chosen: 0 };
      for (let i = 0; i < data.length; i += 4) {
        const [r, g, b] = data.subarray(i, i + 3);
        if (r === 168 && g === 0 && b === 0) n.red += 1;
        if (b > 230 && r < 60 && g > 130) n.chosen += 1;
      }
      return n;
    });
  const before = await coloured();
  await page.getByRole("button", { name: "Find lines" }).click();
  await page.waitForFunction(() => annotator.store.now.lines.version === 1);
  await settled(page);
  const drawn = await coloured();
  assert.ok(drawn.red > before.red + 500, `${JSON.stringify(before)} then ${JSON.stringify(drawn)}`);
  const found = (await state("lines")).lines;
  assert.ok(found.length >= 12, `${found.length} lines`);

  // To the first, to the last, and back: the view turns there, the line stands out, its facts are shown.
  /** Where the window shows a place: 0 in the middle, 1 at the border. */
  const offCentre = (place) =>
    page.evaluate(([x, y, z]) => {
      const m = annotator.stage.camera.view.matrix;
      const row = (i) => m[i] * x + m[i + 4] * y + m[i + 8] * z + m[i + 12];
      return Math.max(Math.abs(row(0) / row(3)), Math.abs(row(1) / row(3)));
    }, place);
  const first = found[0].middle;
  await page.keyboard.press("j");
  await page.waitForTimeout(500); // the flight
  await settled(page);
  assert.ok((await offCentre(first)) < 0.1, `${await offCentre(first)}`);
  assert.ok((await coloured()).chosen > 50);
  const panel = page.locator("details.section", { hasText: "Find lines" });
  await panel.getByText(`Line 1 of ${found.length}`).waitFor();
  await panel.getByText(`${found[0].kind}, sharp edge`).waitFor();
  await panel.getByRole("button", { name: /^Previous/ }).click();
  assert.equal(await state("line"), found.length - 1);
  await panel.getByRole("button", { name: /^Next/ }).click();
  assert.equal(await state("line"), 0);

  // The first is accepted, which leads to the second; that is rejected; the rest are accepted at once.
  await page.keyboard.press("a");
  await page.waitForFunction(() => annotator.store.now.line === 1);
  await page.keyboard.press("d");
  await page.waitForFunction(() => annotator.store.now.line === 2);
  await panel.getByText(`${found.length} lines: 1 accepted, 1 rejected.`).waitFor();
  // Downloads wait for the program to have heard of it, however slowly.
  await page.route("**/api/lines/decide", async (route) => {
    await new Promise((resolve) => setTimeout(resolve, 400));
    await route.continue();
  });
  await page.getByRole("button", { name: "Accept the rest" }).click();
  await panel.getByText(`${found.length} lines: ${found.length - 1} accepted, 1 rejected.`).waitFor();
  const download = async (name, extension = name.toLowerCase()) => {
    const [offer] = await Promise.all([
      page.waitForEvent("download"),
      page.getByRole("button", { name, exact: true }).click(),
    ]);
    assert.equal(offer.suggestedFilename(), `roof_lines.${extension}`);
    return fs.readFileSync(await offer.path(), "utf8");
  };
  const { features } = JSON.parse(await download("GeoJSON"));
  await page.unroute("**/api/lines/decide");
  const rejected = found[1];
  const accepted = found.filter((line) => line !== rejected);
  assert.deepEqual(
    features.map(({ properties }) => properties.kind),
    accepted.map(({ kind }) => kind),
  );
  features.forEach(({ properties }, i) => assert.ok(Math.abs(properties.length - accepted[i].length) < 1e-9));
  assert.match(await download("DXF"), /LINE\r?\n/);
  for (const [arcs, words] of [
    ["flat", "for FreeCAD and LibreCAD."],
    ["none", "DXF has polylines only, for CloudCompare."],
    ["all", "DXF has all arcs and circles as such."],
  ]) {
    await panel.getByRole("radio", { name: arcs, exact: true }).check();
    await panel.getByText(words).waitFor();
    const offered = page.waitForEvent("download");
    await page.getByRole("button", { name: "DXF", exact: true }).click();
    assert.equal(new URL((await offered).url()).searchParams.get("dxf_arcs"), arcs);
  }
  assert.match(await download("GeoPackage", "gpkg"), /^SQLite format 3/);
  const drawnLines = (await download("OBJ")).split("\n").filter((line) => line.startsWith("l "));
  assert.equal(drawnLines.length, accepted.length);

  // Another window shows the same decisions; hidden lines are gone.
  const second = await open();
  assert.deepEqual(
    await second.evaluate(() => annotator.store.now.lines.lines.map(({ decision }) => decision)),
    found.map((line) => (line === rejected ? "rejected" : "accepted")),
  );
  await second.close();
  await page.evaluate(() => annotator.stage.fit("first"));
  await settled(page);
  if (process.env.SCREENSHOT_LINES) {
    await page.getByRole("button", { name: "GeoJSON" }).scrollIntoViewIfNeeded();
    await page.evaluate(() => document.querySelectorAll(".notice").forEach((notice) => notice.remove()));
    await page.screenshot({ path: process.env.SCREENSHOT_LINES });
  }
  await page.keyboard.press("h");
  await settled(page);
  const hidden = await coloured();
  assert.ok(hidden.red < drawn.red - 500 && hidden.chosen === 0, JSON.stringify(hidden));
});

test("predicts the true edges from those few strokes", () => {
  const truth = roof();
  const said = readPly(saved.cloud).column("scalar_edge_class");
  assert.equal(said.length, truth.length);
  const n = { tp: 0, fp: 0, tn: 0, fn: 0 };
  truth.forEach(({ sharp }, i) => {
    n[said[i] === 2 ? (sharp ? "tp" : "fp") : sharp ? "fn" : "tn"] += 1;
  });
  const mcc = (n.tp * n.tn - n.fp * n.fn) / Math.sqrt((n.tp + n.fp) * (n.tp + n.fn) * (n.tn + n.fp) * (n.tn + n.fn));
  console.log(`MCC ${mcc.toFixed(3)}`);
  assert.ok(said.includes(3), "the surface ends somewhere");
  assert.ok(mcc > LEAST_MCC, `MCC ${mcc} ${JSON.stringify(n)}`);
});

test("gives the same on the command line: model, classes", () => {
  const model = path.join(folder, "again.safetensors");
  pcednet("train", "--project", saved.project, "-o", model);
  assert.ok(fs.readFileSync(model).equals(fs.readFileSync(saved.model)), "the model has the same bytes");
  const classified = path.join(folder, "again.ply");
  pcednet("classify", input, "--model", model, "-o", classified);
  assert.deepEqual(readPly(classified).column("scalar_edge_class"), readPly(saved.cloud).column("scalar_edge_class"));
});

test("opens the project as it was left, in a browser that the desktop starts", async () => {
  const counts = await state("counts");
  await page.close();
  await stop();
  const programs = path.join(folder, "bin");
  fs.mkdirSync(programs);
  fs.writeFileSync(path.join(programs, "xdg-open"), `#!/bin/sh\nprintf %s "$1" > ${folder}/given\n`, { mode: 0o755 });
  server = await serve([input, "--project", saved.project], {
    PATH: `${programs}:${process.env.PATH}`,
    XDG_RUNTIME_DIR: folder,
  });
  const given = path.join(folder, "given");
  for (let i = 0; i < 500 && !(fs.existsSync(given) && fs.statSync(given).size > 0); ++i) {
    await new Promise((done) => setTimeout(done, 20));
  }
  page = await open(pathToFileURL(fs.readFileSync(given, "utf8")).href);
  assert.deepEqual(await state("counts"), counts);
  assert.ok((await state("undo")) > 0);
});

test("restores a run of before the restart", async () => {
  const model = async () => {
    const address = new URL(await page.evaluate(() => annotator.client.files.downloadAddress("model")), server.address)
      .href;
    for (;;) {
      // refused as long as the run is being trained again
      const answer = await page.request.get(address);
      if (answer.ok()) return answer.body();
      assert.equal(answer.status(), 409);
      await page.waitForTimeout(50);
    }
  };
  // The one that was shown comes back by itself.
  assert.ok((await model()).equals(fs.readFileSync(saved.model)), "the model that was saved");
  const runs = await state("runs");
  const current = runs.find((run) => run.current);
  assert.ok(current.run > 1, "there was a run before");
  await page.locator("summary", { hasText: "Runs" }).click();
  for (const { run, painted, loss } of [runs.find((one) => one.run === 1), current]) {
    await page.getByRole("button", { name: `Restore run ${run}`, exact: true }).click();
    await page.getByRole("button", { name: `Restore run ${run}`, exact: true }).waitFor({ state: "detached" });
    // Where the program is slow, the first run may have learnt from the same strokes.
    const same = painted === current.painted && loss === current.loss;
    assert.equal((await model()).equals(fs.readFileSync(saved.model)), same, `run ${run}`);
  }
});

test("complained of nothing and asked for nothing else", () => assert.deepEqual(complaints, []));
