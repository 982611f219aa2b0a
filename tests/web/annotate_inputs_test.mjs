// Inputs that are not everyday clouds: LAS in a national grid, three points. Environment as annotator.mjs.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { once } from "node:events";
import fs from "node:fs";
import path from "node:path";
import { test } from "node:test";

import { roof, writeRoof } from "./annotate_cloud.mjs";
import { complainedOfNothing, openAnnotator } from "./annotator.mjs";
import { serve } from "./browser.mjs";

const PLACE = [652000, 6862000, 300];
const its = openAnnotator("inputs", { prepare: writesGrid, ready: () => (page = its.page) });
const { folder, paint, settled, state } = its;
let page;

/** The roof somewhere in Europe, as LAS. */
function writesGrid(folder) {
  const [written, input] = ["grid.ply", "grid.las"].map((name) => path.join(folder, name));
  const there = roof().map((point) => ({ ...point, p: point.p.map((c, axis) => c + PLACE[axis]) }));
  writeRoof(written, there, "double");
  const done = spawnSync(process.env.PCEDNET, ["convert", written, "-o", input], { encoding: "utf8" });
  assert.equal(done.status, 0, done.stderr);
  return [input];
}

test("tells the coordinates of a national grid apart in the clipping box", async () => {
  const panel = page.locator("details.section", { hasText: "Clipping box" });
  await panel.locator("summary").click();
  const limits = async (axis) => {
    const read = async (side) => {
      const row = panel.locator("label", { hasText: `${axis} ${side}` });
      return Number((await row.textContent()).replace(`${axis} ${side}`, ""));
    };
    return [await read("from"), await read("to")];
  };
  const size = [2, 1.4, 1.1];
  for (const [i, axis] of ["x", "y", "z"].entries()) {
    const [from, to] = await limits(axis);
    assert.ok(Math.abs(from - PLACE[i]) < 0.02, `${axis} from ${from}`);
    assert.ok(Math.abs(to - PLACE[i] - size[i]) < 0.02, `${axis} to ${to}`);
  }
  const cut = await panel.locator("output").evaluateAll(
    (all) =>
      all.filter((output) => {
        const text = document.createRange();
        text.selectNodeContents(output);
        const { left, right } = text.getBoundingClientRect();
        return left < output.previousElementSibling.getBoundingClientRect().right || right > innerWidth - 8;
      }).length,
  );
  assert.equal(cut, 0, "every digit can be read");
  await page.getByRole("slider", { name: "x from" }).press("End");
  await settled();
  const [moved, end] = await limits("x");
  assert.ok(moved > PLACE[0] + 1.9 && moved <= end, `${moved} to ${end}`);
  await page.getByRole("button", { name: "Reset", exact: true }).click();
  await settled();
});

test("saves LAS as LAS, with what was painted", async () => {
  await its.trainAfterStrokes(false);
  await paint(2, [[1, 0, 0.6].map((c, axis) => c + PLACE[axis])], 0.05);
  const painted = (await state("counts"))[2];
  assert.ok(painted > 5);
  await page.getByRole("button", { name: "Save cloud" }).click();
  await page.locator(".notice", { hasText: "grid_annotated.las" }).waitFor();
  const saved = path.join(folder, "grid_annotated.las");
  assert.equal(fs.readFileSync(saved).subarray(0, 4).toString(), "LASF");
  const told = spawnSync(process.env.PCEDNET, ["info", saved], { encoding: "utf8" });
  assert.match(told.stdout, /painted_label/);
});

/** Serves three points while `look` runs. */
async function withThree(words, look) {
  const input = path.join(folder, "three.ply");
  const corners = [
    [0, 0, 0],
    [1, 0, 0],
    [0, 1, 0],
  ];
  writeRoof(
    input,
    corners.map((p) => ({ p, n: [0, 0, 1] })),
  );
  const { program, address } = await serve([input, ...words]);
  const few = await its.browser.newPage();
  try {
    await look(few, address);
  } finally {
    await few.close();
    const ended = once(program, "exit");
    program.kill("SIGKILL");
    await ended;
  }
}

test("opens three points and asks for no option that it lacks", () =>
  withThree([], async (few, address) => {
    await few.goto(address);
    await few.getByText("This is what model general finds.").waitFor();
    assert.match(await few.locator("header").textContent(), /3 points/);
    assert.doesNotMatch(await few.locator("body").innerText(), /s_min|s_max|NaN|undefined/);
  }));

test("offers nothing of a model as long as there is none", () =>
  withThree(["--model", "none", "--project", path.join(folder, "none.json")], async (few, address) => {
    await few.goto(address);
    await few.getByText("Paint points of two classes").waitFor();
    assert.ok(await few.getByRole("button", { name: "Save model" }).isDisabled());
    const colours = await few.getByLabel("Colour by").locator("option").allTextContents();
    assert.deepEqual(colours, ["normals", "painted labels", "feature"]);
    const menu = few.locator("details.more");
    await menu.locator("summary").click();
    const model = menu.getByText("model", { exact: true });
    assert.deepEqual([await model.getAttribute("href"), await model.getAttribute("aria-disabled")], [null, "true"]);
    // A click elsewhere closes the menu and paints nothing; so does Escape, and a choice.
    const { x, y, width, height } = await few.locator("canvas").first().boundingBox();
    await few.mouse.click(x + width / 2, y + height / 2);
    assert.equal(await menu.getAttribute("open"), null);
    await few.waitForTimeout(100);
    assert.equal(await few.evaluate(() => annotator.store.now.undo), 0);
    await menu.locator("summary").click();
    await few.keyboard.press("Escape");
    assert.equal(await menu.getAttribute("open"), null);
    await menu.locator("summary").click();
    const offer = few.waitForEvent("download");
    await menu.getByText("project", { exact: true }).click();
    assert.equal((await offer).suggestedFilename(), "none.json");
    assert.equal(await menu.getAttribute("open"), null);
  }));

test("a page that opens after the cloud was loaded tells of the cloud, too, and the terminal does", async () => {
  const input = path.join(folder, "mesh.obj");
  fs.writeFileSync(input, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n");
  const { program, address } = await serve([input]);
  let told = "";
  program.stderr.on("data", (data) => (told += data));
  const few = await its.browser.newPage();
  try {
    const { origin, search } = new URL(address);
    for (let state = ""; state !== "ready"; )
      ({ state } = await (await fetch(`${origin}/api/session${search}`)).json());
    await few.goto(address);
    await few.locator(".notice.warning", { hasText: "2 faces are not used, only their vertices" }).waitFor();
    await few.locator(".notice.warning", { hasText: "no normals in the file: estimated" }).waitFor();
    while (!/warning: mesh\.obj: 2 faces are not used/.test(told)) await few.waitForTimeout(20);
    // So few points are far apart: a hundred spacings away the cloud would be a speck.
    await few.locator("canvas").first().focus();
    await few.keyboard.press("n");
    await few.waitForFunction(() => annotator.store.now.uncertain !== null);
    const away = await few.evaluate(() => annotator.stage.camera.pose.distance);
    assert.ok(away <= (1.5 * Math.SQRT2) / 2 + 1e-9, `${away} from a square of 1`);
  } finally {
    await few.close();
    const ended = once(program, "exit");
    program.kill("SIGKILL");
    await ended;
  }
});

test("a notice on a phone leaves the cloud in sight, and a tap removes it", async () => {
  const phone = await its.browser.newPage({ viewport: { width: 400, height: 800 }, hasTouch: true, isMobile: true });
  await phone.goto(its.server.address);
  await phone.waitForFunction(() => annotator.store.now.progress === null);
  const long =
    "no normals in the file: estimated from the 12 nearest points and oriented consistently (1 connected part, open: up)";
  await phone.evaluate((text) => annotator.client.words.warn(text), long);
  const notice = phone.locator(".notice", { hasText: new RegExp(`^no normals`) });
  const [{ height }, view] = [await notice.boundingBox(), await phone.locator("main").boundingBox()];
  assert.ok(height < 0.14 * view.height, `${height} of ${view.height}`);
  const tops = await phone.locator("header .saves > *").evaluateAll((all) => all.map((one) => one.offsetTop));
  assert.ok(Math.max(...tops) - Math.min(...tops) < 5, `all that saves in one row: ${tops}`);
  for (const other of ["a", "b", "c", "d"]) {
    await phone.evaluate((text) => annotator.client.words.warn(text), other + long);
  }
  const [all, stage] = [await phone.locator(".notices").boundingBox(), await phone.locator("main").boundingBox()];
  assert.ok(all.height < 0.3 * stage.height, `${all.height} of ${stage.height} by five notices`);
  await phone.setViewportSize({ width: 740, height: 360 });
  const [across, last] = [await notice.boundingBox(), await phone.getByRole("button", { name: "Keys" }).boundingBox()];
  assert.ok(across.height < 45, `${across.height} of a phone on its side`);
  assert.ok(last.y + last.height <= 360, "all tools are in sight");
  await notice.tap({ position: { x: 20, y: 10 } });
  assert.equal(await notice.count(), 0);
  await phone.close();
});

test("says that it fetches the points until there are some", () =>
  withThree(["--project", path.join(folder, "fetching.json")], async (few, address) => {
    let release;
    const released = new Promise((done) => (release = done));
    await few.route("**/api/node/0/points*", (route) => released.then(() => route.continue()));
    await few.goto(address);
    await few.getByText("Fetching the points").waitFor();
    release();
    await few.getByText("Fetching the points").waitFor({ state: "hidden" });
    await few.waitForFunction(() => annotator.stage.chunks.length === 1);
  }));

test("shows a prediction that comes while the page opens", () =>
  withThree(["--model", "none", "--project", path.join(folder, "opening.json")], async (few, address) => {
    const { origin, searchParams } = new URL(address);
    const headers = { "X-Pcednet-Token": searchParams.get("token"), "Content-Type": "application/json" };
    const ask = async (place, body) => {
      const answer = await fetch(`${origin}/api/${place}`, body && { method: "POST", headers, body });
      return answer.json();
    };
    let release, asked;
    const released = new Promise((done) => (release = done));
    const first = new Promise((done) => (asked = done));
    await few.route("**/api/session", async (route) => {
      const response = await route.fetch();
      if ((await response.json()).state === "ready") {
        asked();
        await released;
      }
      await route.fulfill({ response });
    });
    await few.goto(address);
    await first;
    await few.waitForFunction(() => annotator.client.events.readyState === EventSource.OPEN);
    headers["X-Window"] = (await ask("window", "{}")).window;
    await ask(`window/${headers["X-Window"]}/take`, "{}");
    await ask("settings", JSON.stringify({ start: "general" }));
    await few.waitForFunction(() => annotator.store.now.predictionVersion > 0); // the page hears of it
    release();
    await few.waitForFunction(() => annotator.stage.chunks.some((c) => c.prediction.some((said) => said < 3)));
    assert.equal(await few.evaluate(() => annotator.store.now.mode), "prediction");
    await few.unrouteAll({ behavior: "ignoreErrors" }); // a look at the session may be on its way
  }));

complainedOfNothing(its);
