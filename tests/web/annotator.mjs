// What the browser tests of the annotator share: a folder with clouds, the program that serves them, and its page.
// Environment: PCEDNET the program, PCEDNET_SOURCE_DIR the repository, CHROMIUM the browser.
import assert from "node:assert/strict";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import { after, before, test } from "node:test";

import { roof, writeRoof } from "./annotate_cloud.mjs";
import { launch, serve } from "./browser.mjs";

/**
 * Before the tests of a file: writes its clouds, serves those that `prepare` returns (words of the command line) and
 * opens the page; then it calls `ready`. After the tests it removes all again. By default the cloud is the roof.
 */
export function openAnnotator(name, { height = 720, prepare = writesRoof, ready = () => {} } = {}) {
  const its = {
    folder: fs.mkdtempSync(path.join(os.tmpdir(), `pcednet-${name}-`)),
    complaints: [],
    browser: null,
    page: null,
    server: null,

    /** All is drawn and nothing is asked for. */
    settled: () =>
      its.page.waitForFunction(
        () => annotator.store.now.progress === null && annotator.stage.isSettled && !annotator.client.isBusy,
      ),

    /** A part of the page's state. */
    state: (key) => its.page.evaluate((name) => annotator.store.now[name], key),

    /** The answer of a run is there; without a number of any. */
    shown: (run) =>
      its.page.waitForFunction(
        (number) => annotator.store.now.runs.some((r) => r.current && (number === null || r.run === number)),
        run ?? null,
      ),

    /** Checks or unchecks training after each stroke, until the program knows. */
    async trainAfterStrokes(on) {
      const told = its.page.waitForResponse((answer) => new URL(answer.url()).pathname === "/api/settings");
      await its.page.getByRole("checkbox", { name: "Train after each stroke" }).setChecked(on);
      await told;
    },

    /** A stroke of the brush round places of the cloud, by the page's own means. */
    async paint(edgeClass, places, radius) {
      await its.stroke(edgeClass, places, radius);
      await its.settled();
    },

    /** As paint() without waiting. */
    stroke: (edgeClass, places, radius) =>
      its.page.evaluate(
        ([c, centres, r]) => {
          const { origin } = annotator.store.now.session;
          annotator.client.paint({
            id: crypto.randomUUID(),
            tool: "brush",
            class: c,
            centres: centres.map((p) => p.map((x, axis) => x - origin[axis])),
            radius: r,
            protect: false,
            hidden: [],
            clip: null,
          });
        },
        [edgeClass, places, radius],
      ),
  };

  before(async () => {
    its.server = await serve(await prepare(its.folder));
    its.browser = await launch();
    its.page = await its.browser.newPage({ viewport: { width: 1280, height } });
    its.page.setDefaultTimeout(120_000);
    its.page.on("pageerror", (e) => its.complaints.push(e.message));
    // From the start: the first requests after a later first route would pass it by.
    await its.page.route(/^about:/, (route) => route.continue());
    await its.page.goto(its.server.address);
    await its.settled();
    await its.shown();
    await ready();
  });

  after(async () => {
    await its.browser?.close();
    its.server?.program.kill("SIGKILL");
    fs.rmSync(its.folder, { recursive: true, force: true });
  });
  return its;
}

/** The last test of a file. */
export const complainedOfNothing = (its) => test("complained of nothing", () => assert.deepEqual(its.complaints, []));

function writesRoof(folder) {
  const input = path.join(folder, "roof.ply");
  writeRoof(input, roof());
  return [input];
}
