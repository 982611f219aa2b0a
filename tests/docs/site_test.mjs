// The pages that scripts/build_docs.sh makes: whole, as wide as the screen, and searched from disk.
// SCREENSHOTS=FOLDER leaves pictures of some pages there.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { launch } from "../web/browser.mjs";

const root = process.env.PCEDNET_SOURCE_DIR;
const folder = fs.mkdtempSync(path.join(os.tmpdir(), "pcednet-docs-"));
const site = path.join(folder, "site");
const pages = () => fs.readdirSync(site).filter((name) => name.endsWith(".html"));
const address = (name) => pathToFileURL(path.join(site, name)).href;
let browser;

before(async () => {
  const built = spawnSync(path.join(root, "scripts/build_docs.sh"), [site], { encoding: "utf8" });
  assert.equal(built.status, 0, built.stderr); // a link or anchor that leads nowhere is an error of the build
  browser = await launch();
});

after(async () => {
  await browser?.close();
  fs.rmSync(folder, { recursive: true });
});

test("every page of the table is there and none loads anything from elsewhere", () => {
  const names = pages();
  for (const name of [
    "index",
    "contents",
    "tutorial",
    "own-definition",
    "equations",
    "commands",
    "cpp",
    "changelog",
    "models",
    "bench",
  ]) {
    assert.ok(names.includes(`${name}.html`), name);
  }
  const all = [...names, ...fs.readdirSync(path.join(site, "source")).map((name) => `source/${name}`)];
  for (const name of all) {
    const html = fs.readFileSync(path.join(site, name), "utf8");
    const ids = [...html.matchAll(/<[^>]* id="([^"]*)"/g)].map(([, id]) => id);
    assert.equal(new Set(ids).size, ids.length, `${name}: each id once`);
    for (const [, link] of html.matchAll(/(?:href|src)="([^"]*)"/g)) {
      if (/^(https?|mailto):/.test(link)) {
        assert.ok(!/(?:src|<link[^>]*href)="https?:/.test(html), `${name} loads ${link}`);
        continue;
      }
      const [target, anchor] = link.split("#");
      const file = target ? path.join(site, path.dirname(name), target) : path.join(site, name);
      assert.ok(fs.existsSync(file), `${name}: ${link}`);
      if (anchor) assert.ok(fs.readFileSync(file, "utf8").includes(`id="${anchor}"`), `${name}: ${link}`);
    }
  }
});

test("the reference lists every option, and the C++ page every public header", () => {
  const help = spawnSync(process.env.PCEDNET, ["lines", "--help"], { encoding: "utf8" }).stdout;
  const commands = fs.readFileSync(path.join(site, "commands.html"), "utf8");
  const options = help.match(/^ {2}(--[a-z-]+)/gm).map((line) => line.trim());
  assert.ok(options.length > 15);
  for (const option of options) assert.ok(commands.includes(`<code>${option}</code>`), option);
  const cpp = fs.readFileSync(path.join(site, "cpp.html"), "utf8");
  for (const word of ["detect/classify.h", "find_lines", "PointCloud"]) assert.ok(cpp.includes(word), word);
});

for (const width of [390, 1280]) {
  test(`no page is wider than a screen of ${width}`, async () => {
    const tab = await browser.newPage({ viewport: { width, height: 844 } });
    tab.setDefaultTimeout(120_000); // for busy machines
    for (const name of pages()) {
      await tab.goto(address(name));
      const widest = await tab.evaluate(() => document.documentElement.scrollWidth);
      assert.ok(widest <= width, `${name} is ${widest} wide`);
      const cut = await tab.evaluate(
        () => [...document.querySelectorAll("img")].filter((i) => i.complete && i.naturalWidth === 0).length,
      );
      assert.equal(cut, 0, `${name} lacks pictures`);
      if (
        process.env.SCREENSHOTS &&
        ["index.html", "tutorial.html", "equations.html", "commands.html", "gallery.html", "cpp.html"].includes(name)
      ) {
        await tab.screenshot({ path: path.join(process.env.SCREENSHOTS, `${name}-${width}.png`) });
      }
    }
    await tab.close();
  });
}

test("the search finds from disk what is asked, and leads there", async () => {
  const tab = await browser.newPage({ viewport: { width: 1280, height: 844 } });
  const problems = [];
  tab.on("pageerror", (error) => problems.push(error.message));
  tab.on(
    "request",
    (request) => request.url().startsWith("file:") || request.url().startsWith("data:") || problems.push(request.url()),
  );
  await tab.goto(address("tutorial.html"));
  for (const [words, title] of [
    ["calibration", /Calibration/],
    ["s-max", /scales|command/i],
    ["--min-confidence", /lines|confidence/i],
    ["voxell", /engine|voxel/i],
  ]) {
    await tab.fill("#search", words);
    const first = await tab.locator("#search-results a").first().innerText({ timeout: 5000 });
    assert.match(first, title, words);
  }
  await tab.fill("#search", "zzzzqqq");
  assert.match(await tab.locator("#search-results").innerText(), /Nothing about/);
  await tab.fill("#search", "undo a stroke");
  if (process.env.SCREENSHOTS) await tab.screenshot({ path: path.join(process.env.SCREENSHOTS, "search.png") });
  await tab.fill("#search", "pratt");
  await tab.press("#search", "Enter");
  await tab.waitForURL(/(method|equations|cpp)\.html/);
  assert.deepEqual(problems, []);
  await tab.close();
});

test("on a phone the menu opens and leads to other pages", async () => {
  const tab = await browser.newPage({ viewport: { width: 390, height: 844 } });
  await tab.goto(address("tutorial.html"));
  assert.equal(await tab.locator("#nav").isVisible(), false);
  await tab.click("#menu");
  assert.equal((await tab.locator("#nav").boundingBox()).y, 52, "below the head");
  await tab.click("#menu");
  assert.equal(await tab.locator("#nav").isVisible(), false);
  await tab.click("#menu");
  if (process.env.SCREENSHOTS) await tab.screenshot({ path: path.join(process.env.SCREENSHOTS, "menu-390.png") });
  await tab.click("#nav a[href='gallery.html']");
  await tab.waitForURL(/gallery\.html/);
  await tab.close();
});
