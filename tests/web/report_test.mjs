// `pcednet report` from a study's folder to the page in a browser (headless Chromium, WebGL in software).
// Environment: PCEDNET the program, PCEDNET_SOURCE_DIR the repository, CHROMIUM the browser.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";

import { launch } from "./browser.mjs";
import { writeStudy } from "./fixture.mjs";

const KEYS = ["precision", "recall", "mcc", "f1", "accuracy", "iou"];
const folder = fs.mkdtempSync(path.join(os.tmpdir(), "pcednet-report-"));
const report = path.join(folder, "report.html");
const complaints = [];
let browser, page, methods, scales;

function pcednet(...words) {
  const done = spawnSync(process.env.PCEDNET, ["report", ...words], { encoding: "utf8" });
  return { code: done.status, words: done.stderr };
}

async function open(options) {
  const opened = await browser.newPage({ viewport: { width: 1280, height: 800 }, ...options });
  opened.setDefaultTimeout(120_000); // for busy machines
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
      r.url() !== pathToFileURL(report).href && !r.url().startsWith("data:") && complaints.push(`asks for ${r.url()}`),
  );
  await opened.goto(pathToFileURL(report).href);
  await opened.waitForSelector(".experiment canvas");
  await frames(opened);
  return opened;
}

/** Sets a switch, as a keyboard or a screen reader would find it. */
const choose = (where, name) => page.locator(where).getByRole("radio", { name, exact: true }).check();

const frames = (of) =>
  of.evaluate(
    () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(done)))),
  );

/** What the panel with that number shows: the shares of its pixels of some colours, and all of it. */
async function seen(of, panel) {
  await frames(of);
  const png = await of.locator(".label").nth(panel).screenshot();
  return of.evaluate(async (base64) => {
    const image = new Image();
    image.src = `data:image/png;base64,${base64}`;
    await image.decode();
    const context = new OffscreenCanvas(image.width, image.height).getContext("2d");
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, image.width, image.height);
    const shares = { red: 0, yellow: 0, pale: 0, blue: 0, picture: 0 };
    for (let i = 0; i < data.length; i += 4) {
      const [r, g, b] = [data[i], data[i + 1], data[i + 2]];
      const each = 4 / data.length;
      if (r > 90 && g < 40 && b < 40) shares.red += each;
      if (r > 150 && g > 110 && b < 130 && r - b > 80) shares.yellow += each;
      if (Math.min(r, g, b) > 130 && Math.max(r, g, b) - Math.min(r, g, b) < 6) shares.pale += each;
      if (b > 120 && b - r > 70) shares.blue += each;
      shares.picture = (Math.imul(shares.picture, 31) + ((r << 16) | (g << 8) | b)) | 0;
    }
    return shares;
  }, png.toString("base64"));
}

const format = (v) => v.toFixed(3).replace(/^(-?)0\./, "$1.");
const mean = (values) => values.reduce((a, b) => a + b, 0) / values.length;
const resultsOf = (study, variant, set) => study.results.filter((r) => r.variant === variant && r.set === set);

/** Name -> texts of its number cells, of the table at `selector`. */
const rowsOf = (of, selector) =>
  of
    .locator(selector)
    .first()
    .evaluate((table) =>
      [...table.querySelectorAll("tbody tr:not(.cloud):not(.published)")].map((row) => [
        row.querySelector("th").textContent,
        [...row.querySelectorAll("td.number:not(.quiet)")].map(
          (cell) => cell.querySelector(".value")?.textContent ?? "none",
        ),
      ]),
    );

before(async () => {
  ({ methods, scales } = writeStudy(folder));
  const made = pcednet(folder, "-o", report, "--clouds-per-set", "2", "--points", "950");
  assert.equal(made.code, 0, made.words);
  assert.match(made.words, /: 2 studies, \d+ clouds to look at/);
  browser = await launch();
  page = await open();
});

after(async () => {
  await browser?.close();
  fs.rmSync(folder, { recursive: true, force: true });
});

test("says what is wrong with a folder", () => {
  const other = fs.mkdtempSync(path.join(folder, "other-"));
  const to = path.join(other, "page.html");
  assert.match(pcednet(path.join(other, "none"), "-o", to).words, /none: no such folder/);
  assert.equal(pcednet(path.join(other, "none"), "-o", to).code, 3);
  fs.writeFileSync(path.join(other, "cloud.ply"), "");
  assert.match(pcednet(path.join(other, "cloud.ply"), "-o", to).words, /cloud\.ply: is no folder/);
  const empty = pcednet(other, "-o", to);
  assert.equal(empty.code, 4);
  assert.match(empty.words, /no study in it; give the folder that `pcednet study methods --test/);
  fs.writeFileSync(path.join(other, "methods.json"), "{");
  const broken = pcednet(other, "-o", to);
  assert.equal(broken.code, 3);
  assert.match(broken.words, /methods\.json/);
  assert.ok(!fs.existsSync(to));
  const again = pcednet(folder, "-o", report);
  assert.equal(again.code, 2);
  assert.match(again.words, /--overwrite/);
});

test("counts one study as one", () => {
  const one = fs.mkdtempSync(path.join(folder, "one-"));
  fs.copyFileSync(path.join(folder, "scales.json"), path.join(one, "scales.json"));
  assert.match(pcednet(one, "-o", path.join(one, "page.html")).words, /: 1 study, 0 clouds to look at/);
});

test("replaces nothing that it reads", () => {
  const study = path.join(folder, "methods.json");
  const before = fs.readFileSync(study);
  const page = path.join(folder, "other.html");
  for (const words of [
    ["-o", study],
    ["-o", page, "--json", study],
    ["-o", page, "--json", page],
  ]) {
    const refused = pcednet(folder, ...words, "--clouds-per-set", "1", "--overwrite");
    assert.equal(refused.code, 2, refused.words);
    assert.match(refused.words, /is the input|named twice/);
  }
  assert.deepEqual(fs.readFileSync(study), before);
  assert.ok(!fs.existsSync(page));
});

test("shows every score of a set, of both statistics, as the study has them", async () => {
  const section = "#experiment-0";
  for (const statistic of ["median", "pooled"]) {
    await choose(section, statistic);
    for (const set of ["default", "cad"]) {
      await choose(section, set);
      const rows = await rowsOf(page, `${section} .part table`);
      assert.deepEqual(
        rows,
        methods.variants.map(({ id, title }) => [
          title,
          KEYS.map((k) => format(mean(resultsOf(methods, id, set).map((r) => r[statistic][k])))),
        ]),
      );
    }
  }
  await choose(section, "median");
  await choose(section, "default");
});

test("shows one score on all sets, with published figures beside", async () => {
  const rows = await rowsOf(page, "#experiment-0 .overview table");
  assert.deepEqual(
    rows,
    methods.variants.map(({ id, title }) => [
      title,
      ["default", "cad"].map((set) => format(mean(resultsOf(methods, id, set).map((r) => r.median.mcc)))),
    ]),
  );
  assert.equal(await page.locator("#experiment-0 .overview .beside").textContent(), "(.856)");
  assert.match(await page.locator("#experiment-0 tr.published").first().textContent(), /published\.856/);
});

test("gives the deviation over the seeds", async () => {
  const values = resultsOf(methods, "pcednet", "default").map((r) => r.median.mcc);
  const deviation = Math.sqrt(values.reduce((s, v) => s + (v - mean(values)) ** 2, 0) / 2);
  const cell = page.locator("#experiment-0 .overview tbody tr").nth(1).locator("td").first();
  assert.equal(await cell.locator(".deviation").textContent(), `±${format(deviation)}`);
});

test("marks the best and sorts by any column", async () => {
  const table = page.locator("#experiment-0 .part table").first();
  const best = await table.locator("td.best").first().locator("xpath=..").locator("th").textContent();
  assert.equal(best, "PCEDNet");
  const names = () => table.locator("tbody tr:not(.cloud):not(.published) th").allTextContents();
  await table.getByRole("button", { name: "MCC" }).click();
  assert.deepEqual(await names(), ["PCEDNet", "CNN", "Covariance analysis"]);
  await table.getByRole("button", { name: "MCC" }).click();
  assert.deepEqual(await names(), ["Covariance analysis", "CNN", "PCEDNet"]);
  await table.getByRole("button", { name: "Method" }).click();
  assert.deepEqual(await names(), ["CNN", "Covariance analysis", "PCEDNet"]);
});

test("opens a method into its clouds, and a cloud into its picture", async () => {
  const table = page.locator("#experiment-0 .part table").first();
  assert.equal(await table.locator("tr.cloud:visible").count(), 0);
  await table.getByRole("button", { name: "Covariance analysis" }).press("Enter");
  const shown = table.locator("tr.cloud:visible");
  assert.equal(await shown.count(), 3);
  const [{ clouds }] = resultsOf(methods, "ca", "default");
  for (const [i, cloud] of clouds.entries()) {
    const text = await shown.nth(i).locator("td").allTextContents();
    assert.deepEqual(
      text.slice(-6),
      KEYS.map((k) => format(cloud[k])),
    );
  }
  assert.equal(await shown.locator("button").count(), 2, "two of the three clouds are in the page");
  await shown.nth(1).locator("button").click();
  assert.match(await page.locator(".gallery .note").textContent(), /^cube1\.ply: 950 of its 1.000 points/);
});

test("draws charts for each method and the sweep", async () => {
  assert.equal(await page.locator("#experiment-0 .panels figure").count(), 3);
  assert.equal(await page.locator("#experiment-0 .panels circle").count(), 9);
  const [
    {
      clouds: [first],
    },
  ] = resultsOf(methods, "ca", "default");
  const dot = page.locator("#experiment-0 .panels circle").first();
  const [x, y] = [Number(await dot.getAttribute("cx")), Number(await dot.getAttribute("cy"))];
  assert.ok(Math.abs(x - (26 + first.precision * 156)) < 0.01);
  assert.ok(Math.abs(y - (8 + (1 - first.recall) * 158)) < 3);
  assert.equal(await page.locator("#experiment-1 .uplot").count(), 1);
  assert.equal(await page.locator("#experiment-1 .uplot .u-series").count(), 3, "the x and two sets");
  const picture = await page.locator("#experiment-1 .uplot canvas").evaluate(
    (canvas) =>
      canvas
        .getContext("2d")
        .getImageData(0, 0, canvas.width, canvas.height)
        .data.filter((v, i) => i % 4 === 3 && v > 0).length,
  );
  assert.ok(picture > 1000);
  assert.equal(await page.locator("#experiment-0 .uplot").count(), 2, "loss and score of the curves");
});

test("shows names as text, and the command", async () => {
  assert.equal(await page.locator("#experiment-0 h2").textContent(), methods.title);
  assert.equal(await page.locator("#experiment-1 code").textContent(), scales.command);
});

test("is printed with its colours, the whole command, and no buttons that do nothing on paper", async () => {
  await page.emulateMedia({ media: "print" });
  await page.setViewportSize({ width: 400, height: 800 });
  const seen = await page.evaluate(() => ({
    swatch: getComputedStyle(document.querySelector(".swatch")).printColorAdjust,
    wide: [...document.querySelectorAll(".command code")].filter((code) => code.scrollWidth > code.clientWidth).length,
    buttons: [...document.querySelectorAll("nav, .controls, .chips, .copy")].filter((one) => one.checkVisibility())
      .length,
  }));
  assert.deepEqual(seen, { swatch: "exact", wide: 0, buttons: 0 });
  await page.setViewportSize({ width: 1280, height: 800 });
  await page.emulateMedia({ media: null });
});

test("has its clouds on paper, and nothing cut off at the right", async () => {
  await frames(page);
  const colours = await page.evaluate(async () => {
    const image = await createImageBitmap(document.querySelector(".stage canvas")); // between two drawings
    const context = new OffscreenCanvas(image.width, image.height).getContext("2d");
    context.drawImage(image, 0, 0);
    return new Set(new Uint32Array(context.getImageData(0, 0, image.width, image.height).data.buffer)).size;
  });
  assert.ok(colours > 50, `${colours} colours`);
  await page.emulateMedia({ media: "print" });
  const overflows = await page.evaluate(() =>
    [...document.querySelectorAll(".scroller, .stage, .plot")].map((one) => getComputedStyle(one).overflowX),
  );
  assert.ok(overflows.length > 5);
  assert.deepEqual([...new Set(overflows)], ["visible"]);
  await page.emulateMedia({ media: null });
});

test("draws the clouds in the colours of their classes", async () => {
  assert.ok((await page.locator(".label").count()) >= 3);
  for (const panel of [0, 1, 2]) {
    const shares = await seen(page, panel);
    for (const colour of ["red", "yellow", "pale", "blue"])
      assert.ok(shares[colour] > 0.004, `panel ${panel}: ${colour}`);
  }
  await choose(".gallery", "colour-blind safe");
  const safe = await seen(page, 0);
  assert.ok(safe.red < 0.001 && safe.blue > 0.004, JSON.stringify(safe));
  await choose(".gallery", "as in the paper");
});

test("shows errors: none of the truth, some of a method", async () => {
  await choose(".gallery", "errors");
  assert.ok((await seen(page, 0)).blue < 0.0005);
  assert.ok((await seen(page, 1)).blue > 0.002);
  await choose(".gallery", "classes");
});

test("turns all clouds together, by mouse and by keys", async () => {
  const pictures = async () => [(await seen(page, 0)).picture, (await seen(page, 1)).picture];
  await page.getByRole("button", { name: "Reset" }).click();
  const start = await pictures();
  const box = await page.locator(".label").nth(1).boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2 + 60, box.y + box.height / 2 + 20, { steps: 4 });
  await page.mouse.up();
  const dragged = await pictures();
  assert.notEqual(dragged[0], start[0], "the panel beside turns too");
  assert.notEqual(dragged[1], start[1]);
  await page.keyboard.press("ArrowLeft");
  assert.notEqual((await pictures())[0], dragged[0]);
});

test("adds and removes panels", async () => {
  const chip = page.locator(".chips label").last();
  const before = await page.locator(".label").count();
  const on = await chip.locator("input").isChecked();
  await chip.locator("input").click();
  assert.equal(await page.locator(".label").count(), before + (on ? -1 : 1));
});

for (const [name, options] of [
  ["a phone", { viewport: { width: 390, height: 844 } }],
  ["the dark", { colorScheme: "dark" }],
]) {
  test(`fits ${name}`, async () => {
    const other = await open(options);
    const [wide, background] = await other.evaluate(() => [
      document.documentElement.scrollWidth - window.innerWidth,
      getComputedStyle(document.body).backgroundColor,
    ]);
    assert.ok(wide <= 0, `${wide} pixels too wide`);
    // 4.5 to 1, as the guidelines for accessible pages ask for.
    const contrasts = await other.evaluate(() => {
      const light = (colour) => {
        const linear = colour
          .match(/[\d.]+/g)
          .slice(0, 3)
          .map((c) => (c > 10 ? ((c / 255 + 0.055) / 1.055) ** 2.4 : c / 255 / 12.92));
        return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2] + 0.05;
      };
      const paper = light(getComputedStyle(document.body).backgroundColor);
      return [...document.querySelectorAll("td, .deviation, .beside, .note")].map((one) => {
        const ink = light(getComputedStyle(one).color);
        return Math.max(ink, paper) / Math.min(ink, paper);
      });
    });
    assert.ok(contrasts.length > 20 && Math.min(...contrasts) >= 4.5, `${Math.min(...contrasts)}`);
    if (name === "the dark") assert.match(background, /rgb\((\d|[1-5]\d), /);
    assert.ok((await seen(other, 0)).pale > 0.004);
    await other.emulateMedia({ media: "print" });
    const [paper, darkest] = await other.evaluate(() => {
      const plot = document.querySelector(".uplot canvas");
      const { data } = plot.getContext("2d").getImageData(0, 0, plot.width, plot.height);
      let least = 255; // of the axes' letters
      for (let i = 0; i < data.length; i += 4) {
        if (data[i + 3] > 200) least = Math.min(least, Math.max(data[i], data[i + 1], data[i + 2]));
      }
      return [getComputedStyle(document.body).backgroundColor, least];
    });
    assert.match(paper, /rgb\(2[3-5]\d, 2[3-5]\d, 2[3-5]\d\)/, "paper is light");
    assert.ok(darkest < 130, `letters of a plot: ${darkest}`);
    await other.close();
  });
}

test("draws a line in the legend as in the plot, and error bars within its axes", async () => {
  const markers = page.locator("#experiment-0 .uplot").first().locator(".u-series .u-marker");
  const styles = await markers.evaluateAll((all) => all.map((m) => getComputedStyle(m).borderTopStyle));
  assert.deepEqual(styles.slice(-2), ["solid", "dashed"], "training, held out");
  // Nothing of the lines' colour below the axis of the second plot, whose first error bar is the longest.
  const below = await page
    .locator("#experiment-0 .uplot")
    .nth(1)
    .evaluate((plot) => {
      const canvas = plot.querySelector("canvas");
      const over = plot.querySelector(".u-over");
      const scale = canvas.height / canvas.getBoundingClientRect().height;
      const bottom = Math.ceil((over.offsetTop + over.offsetHeight) * scale) + 2;
      const { data } = canvas.getContext("2d").getImageData(0, bottom, canvas.width, canvas.height - bottom);
      let coloured = 0;
      for (let i = 0; i < data.length; i += 4) coloured += Number(data[i + 3] > 0 && data[i + 2] > data[i] + 60);
      return coloured;
    });
  assert.equal(below, 0);
});

test("puts the comparison of methods first, with a row for each in its charts, and the user's title and date", async () => {
  const other = fs.mkdtempSync(path.join(os.tmpdir(), "pcednet-report-more-"));
  const long = "A method with a name that is far longer than the margin of any chart";
  const both = (study) =>
    study.results.flatMap((r) => (r.set === "default" ? [r, { ...r, positive: "sharp", clouds: r.clouds }] : [r]));
  const additions = { ...scales, experiment: "additions", title: "Additions" };
  const mixed = { ...methods, variants: methods.variants.map((v) => (v.id === "ca" ? { ...v, title: long } : v)) };
  // On two of the three clouds this one does better: that is no comparison.
  const part = methods.results.find((r) => r.variant === "ca" && r.set === "default");
  mixed.variants.push({ ...methods.variants[0], id: "part", title: "Part" });
  const slower = ({ seconds }) => Object.fromEntries(Object.entries(seconds).map(([stage, s]) => [stage, 1000 * s]));
  mixed.results = [
    ...both(methods),
    ...methods.results.filter((r) => r.set === "cad").map((r) => ({ ...r, seconds: slower(r) })),
    { ...part, variant: "part", clouds: part.clouds.slice(0, 2), median: { ...part.median, mcc: 0.99 } },
  ];
  for (const study of [additions, mixed]) {
    fs.writeFileSync(path.join(other, `${study.experiment}.json`), JSON.stringify(study));
  }
  const made = path.join(other, "made.html");
  const words = ["--clouds-per-set", "0", "--title", "Old town <1>", "--date", "May 2027"];
  assert.equal(pcednet(other, "-o", made, ...words).code, 0);
  const opened = await browser.newPage({ viewport: { width: 1280, height: 800 } });
  await opened.goto(pathToFileURL(made).href);
  assert.deepEqual(await opened.locator("main h2").allTextContents(), [methods.title, "Additions"]);
  assert.equal(await opened.locator("h1").textContent(), "Old town <1>");
  assert.match(await opened.locator(".masthead p").textContent(), /^May 2027 · /);
  const section = opened.locator("main section.experiment").first();
  const seconds = section.locator("section.part", { has: opened.getByRole("heading", { name: "Seconds" }) });
  const rows = await seconds.locator(".row-name").allTextContents();
  assert.equal(rows.length, 4, "each method once, though it is scored twice");
  for (const name of await section.locator(".row-name").all()) {
    const [left, wide] = await name.evaluate((text) => [text.getBBox().x, text.getComputedTextLength()]);
    assert.ok(left >= 0 && wide > 0, `${await name.textContent()} begins at ${left}`);
  }
  assert.ok((await section.locator(".row-name title").allTextContents()).includes(long), "the whole name on hovering");
  const best = await section.locator(".part table").first().locator("td.best").locator("xpath=..").allTextContents();
  const axis = () => seconds.locator('svg[aria-label="seconds, logarithmic"] .tick').allTextContents();
  const ofDefault = await axis();
  await section.getByRole("radio", { name: "cad", exact: true }).check();
  assert.ok(ofDefault.length > 4, `it reaches to the slower set: ${ofDefault}`);
  assert.deepEqual(await axis(), ofDefault, "one axis for all sets");
  assert.ok(best.length > 0 && best.every((row) => !row.startsWith("Part")), best.join("; "));
  await opened.close();
  fs.rmSync(other, { recursive: true, force: true });
});

test("draws lines over the clouds, with their number and length, as long as they are wanted", async () => {
  assert.equal(await page.getByRole("checkbox", { name: "Lines", exact: true }).count(), 0, "none were asked for");
  const [made, data] = ["lines.html", "lines.json"].map((name) => path.join(folder, name));
  assert.equal(pcednet(folder, "-o", made, "--lines", "--clouds-per-set", "1", "--json", data).code, 0);
  const [{ lines, predictions }] = JSON.parse(fs.readFileSync(data)).scenes;
  assert.equal(lines.length, 12, "a cube");
  const opened = await browser.newPage({ viewport: { width: 1280, height: 800 } });
  await opened.goto(pathToFileURL(made).href);
  const words = await opened.locator(".label p:last-child").allTextContents();
  assert.match(words[0], /^12 lines, length (12|(11\.9|12\.0)\d*)$/);
  assert.ok(words[1].startsWith(`${predictions[0].lines.length} lines, length `), words[1]);
  const box = opened.getByRole("checkbox", { name: "Lines", exact: true });
  assert.ok(await box.isChecked());
  assert.match(await opened.locator(".gallery .key").textContent(), /line of a sharp edge/);
  await opened.locator(".gallery").getByRole("radio", { name: "errors", exact: true }).check(); // no red points
  const { red } = await seen(opened, 0);
  assert.ok(red > 0.01, `${red} of the pixels`);
  await box.uncheck();
  assert.ok((await seen(opened, 0)).red < 0.0005);
  assert.equal(await opened.locator(".label").first().textContent(), "Truth");
  assert.doesNotMatch(await opened.locator(".gallery .key").textContent(), /line/);
  await opened.close();
});

test("shows the titles of the clouds on a ground of their own", async () => {
  const ground = await page
    .locator(".label p")
    .first()
    .evaluate((p) => getComputedStyle(p).backgroundColor);
  const [red, green, blue, cover] = ground.match(/[\d.]+/g).map(Number);
  assert.ok(Math.max(red, green, blue) < 60 && cover > 0.7, ground);
});

test("asked for nothing and complained of nothing", () => {
  assert.deepEqual(complaints, []);
});
