// Times the annotator's page on a cloud, in headless Chromium with WebGL in software.
//
//     CHROMIUM=/usr/bin/chromium PCEDNET_SOURCE_DIR=$PWD node bench/annotate_page_bench.mjs build/release/bin/pcednet scene.ply
import { spawn } from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import { performance } from "node:perf_hooks";

const { launch } = await import(path.join(process.env.PCEDNET_SOURCE_DIR, "tests/web/browser.mjs"));
const [program, input] = process.argv.slice(2);
const MIB = 2 ** 20;
const tell = (name, value) => console.log(`${name.padEnd(46)} ${value}`);
const seconds = (ms) => `${(ms / 1000).toFixed(2)} s`;
const mean = (values) => values.reduce((a, b) => a + b, 0) / values.length;

const server = spawn(program, ["annotate", input, "--no-browser"], { stdio: ["ignore", "pipe", "pipe"] });
const began = performance.now();
const address = await new Promise((done) => server.stdout.once("data", (text) => done(String(text).trim())));
await new Promise((done) => server.stderr.on("data", (text) => String(text).includes("ready") && done()));
tell("server ready", seconds(performance.now() - began));

const browser = await launch();
const page = await browser.newPage({ viewport: { width: 1280, height: 720 } });
page.setDefaultTimeout(300_000);
page.on("pageerror", (error) => console.error(error));
await page.addInitScript(() => {
  // What is on the card, by what is put there.
  const sizes = new Map();
  const bound = new Map();
  const card = (window.card = { bytes: 0, most: 0 });
  const of = WebGL2RenderingContext.prototype;
  const { bindBuffer, bufferData, deleteBuffer } = of;
  const set = (buffer, bytes) => {
    card.bytes += bytes - (sizes.get(buffer) ?? 0);
    card.most = Math.max(card.most, card.bytes);
    sizes.set(buffer, bytes);
  };
  of.bindBuffer = function (target, buffer) {
    bound.set(target, buffer);
    return bindBuffer.call(this, target, buffer);
  };
  of.bufferData = function (target, data, ...more) {
    set(bound.get(target), typeof data === "number" ? data : data.byteLength);
    return bufferData.call(this, target, data, ...more);
  };
  of.deleteBuffer = function (buffer) {
    set(buffer, 0);
    return deleteBuffer.call(this, buffer);
  };
  window.blocked = [];
  new PerformanceObserver((list) => window.blocked.push(...list.getEntries().map((e) => e.duration))).observe({ entryTypes: ["longtask"] });
});

const opened = performance.now();
await page.goto(address);
await page.waitForFunction(() => window.annotator?.stage.drawn.length > 0);
tell("page open to the first points drawn", seconds(performance.now() - opened));
const settled = () => page.waitForFunction(() =>
  annotator.store.now.progress === null && annotator.stage.isSettled && !annotator.client.isBusy);
await settled();
tell("page open to all drawn that is to be drawn", seconds(performance.now() - opened));

const state = async (name) => {
  const seen = await page.evaluate(() => ({
    drawn: annotator.stage.drawn.reduce((sum, { points }) => sum + points, 0),
    kept: annotator.stage.chunks.reduce((sum, { info }) => sum + info.points, 0),
    heap: performance.memory.usedJSHeapSize, card: card.bytes, most: card.most,
    blocked: Math.max(0, ...blocked.splice(0)),
  }));
  tell(`${name}: points drawn, kept`, `${seen.drawn}, ${seen.kept}`);
  tell(`${name}: script heap, card, card at most`, [seen.heap, seen.card, seen.most].map((b) => `${(b / MIB).toFixed(0)} MiB`).join(", "));
  tell(`${name}: script blocked at most`, `${seen.blocked.toFixed(0)} ms`);
};
await state("at rest");

const orbit = await page.evaluate(async () => {
  const { camera } = annotator.stage;
  const about = camera.target;
  const times = [];
  for (let last = performance.now(), end = last + 5000; last < end;) {
    camera.turn(0.02, 0, about);
    const now = await new Promise(requestAnimationFrame);
    times.push(performance.now() - last);
    last = performance.now();
  }
  return { times, points: annotator.stage.budget.moving };
});
orbit.times.sort((a, b) => a - b);
tell("orbit: frames a second, slowest of 20", `${(1000 / mean(orbit.times)).toFixed(1)}, ${orbit.times[Math.floor(0.95 * orbit.times.length)].toFixed(0)} ms`);
tell("orbit: points a frame", orbit.points);
const turned = performance.now();
await settled();
tell("orbit to all drawn again", seconds(performance.now() - turned));
await state("after the orbit");

// Into it and about, as somebody who looks for places to paint.
for (let look = 0; look < 12; ++look) {
  await page.evaluate((k) => {
    const { stage, store } = annotator;
    const { min, max } = store.now.session.bounds;
    const at = min.map((low, i) => low + (max[i] - low) * [0.2, 0.5, 0.8][(k * (i + 1)) % 3]);
    stage.camera.fit(false, { min: at.map((c) => c - 0.1), max: at.map((c) => c + 0.1) });
  }, look);
  await settled();
}
await state("after twelve looks from near");

await page.keyboard.press("f");
await page.waitForTimeout(500);
await settled();
await page.keyboard.press("3");
const strokes = { answered: [], shown: [] };
for (let k = 0; k < 8; ++k) {
  const [x, y] = [560 + 20 * k, 330 + 10 * k];
  await page.mouse.move(x, y);
  await page.waitForTimeout(200);
  const undo = await page.evaluate(() => annotator.store.now.undo);
  await page.mouse.down();
  const start = performance.now();
  for (let i = 1; i <= 10; ++i) await page.mouse.move(x + 4 * i, y);
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  strokes.shown.push((performance.now() - start) / 10);
  const lifted = performance.now();
  await page.mouse.up();
  await page.waitForFunction((n) => !annotator.client.isBusy && annotator.store.now.undo > n, undo);
  strokes.answered.push(performance.now() - lifted);
}
tell("stroke: a step of the mouse, shown", `${mean(strokes.shown).toFixed(0)} ms`);
tell("stroke: lifted to answered, mean, slowest", `${mean(strokes.answered).toFixed(0)} ms, ${Math.max(...strokes.answered).toFixed(0)} ms`);
tell("painted points", await page.evaluate(() => annotator.store.now.counts.join(", ")));
await state("painting");

tell("a pick", `${(await page.evaluate(() => {
  const { stage } = annotator;
  const start = performance.now();
  for (let k = 0; k < 50; ++k) stage.pick(stage.width * (0.2 + 0.012 * k), stage.height * 0.5);
  return (performance.now() - start) / 50;
})).toFixed(1)} ms`);

// The middle of the first row of pixels that shows the ground.
const [x, y] = await page.evaluate(() => {
  const { stage } = annotator;
  const { left, top } = stage.canvas.getBoundingClientRect();
  for (let down = stage.height - 100;; down -= 10) {
    if (stage.pick(stage.width / 2, down)) return [left + stage.width / 2, top + down - 20];
  }
});
await page.keyboard.press("1");
await page.mouse.move(x, y);
await page.mouse.down();
await page.mouse.move(x + 60, y, { steps: 5 });
const trained = performance.now();
await page.mouse.up();
await page.waitForFunction(() => annotator.store.now.runs.some((run) => run.current && run.run > 0));
await settled();
tell("stroke to a new prediction shown", seconds(performance.now() - trained));
await state("predicted");
tell("server's memory at most", `${(Number(/VmHWM:\s+(\d+)/.exec(fs.readFileSync(`/proc/${server.pid}/status`, "utf8"))[1]) / 1024).toFixed(0)} MiB`);
await browser.close();
server.kill("SIGINT");
