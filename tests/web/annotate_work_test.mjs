// What the annotator's page does with strokes, decisions and keys, in node: the parts that act on others, given fakes
// in their place. Environment: PCEDNET_SOURCE_DIR the repository.
import assert from "node:assert/strict";
import { test } from "node:test";

import { load } from "./bundle.mjs";

const {
  api,
  brush,
  commands,
  files,
  line_client,
  modes,
  preferences,
  reviewer,
  store,
  uncertain_client,
  views,
  words,
  work,
} = await load(
  "api",
  "brush",
  "commands",
  "files",
  "line_client",
  "modes",
  "preferences",
  "reviewer",
  "store",
  "uncertain_client",
  "views",
  "words",
  "work",
);

const turns = () => new Promise((done) => setTimeout(done, 5));

/** Requests that are answered by hand: `asked` are those that wait. */
function byHand() {
  const asked = [];
  const post = (path, body) => new Promise((answer, refuse) => asked.push({ path, body, answer, refuse }));
  return { asked, post, get: post };
}

const line = (decision = "open") => ({
  decision,
  middle: [0, 0, 0],
  normal: [0, 0, 1],
  path: [0, 0, 0, 1, 0, 0],
});

/** A reviewer of three lines at the first of them. */
function review({ lines = [line(), line(), line()], ask = async () => true } = {}) {
  const page = new store.Store({
    ...store.initialState,
    session: { spacing: 1 },
    writer: true,
    line: 0,
    lines: { ...store.initialState.lines, version: 1, lines },
  });
  const warnings = [];
  const server = byHand();
  const telling = { say() {}, warn: (text) => warnings.push(text) };
  const client = new line_client.LineClient(server, page, telling, () => true, ask);
  const stage = { camera: { visit() {}, nearby: (distance) => distance } };
  const its = new reviewer.Reviewer(stage, page, client);
  const decisions = () => page.now.lines.lines.map(({ decision }) => decision[0]).join("");
  return { page, client, its, warnings, asked: server.asked, decisions };
}

test("a notice stays as long as it takes to read it, at most eight seconds", () => {
  assert.ok(words.readingMs("Saved roof.ply") < 3500);
  assert.equal(words.readingMs("x".repeat(500)), 8000);
});

test("quick decisions are on one line after another, and are sent in their order", async () => {
  const { its, page, asked, decisions } = review();
  its.decide("accepted");
  its.decide("rejected");
  assert.equal(decisions(), "aro");
  assert.equal(page.now.line, 2);
  its.decide("accepted");
  assert.deepEqual(
    asked.map(({ body }) => body.lines),
    [[0]],
    "the second waits for the first",
  );
  for (let k = 0; k < 3; ++k) {
    asked[k].answer({});
    await turns();
  }
  assert.deepEqual(
    asked.map(({ path, body }) => [path, ...body.lines, body.decision]),
    [
      ["/api/lines/decide", 0, "accepted"],
      ["/api/lines/decide", 1, "rejected"],
      ["/api/lines/decide", 2, "accepted"],
    ],
  );
  assert.equal(decisions(), "ara");
});

test("an uncertain place of a cloud that is no longer looked at is not shown", async () => {
  const page = new store.Store(store.initialState);
  const warnings = [];
  const server = { ...byHand(), cloud: 0 };
  const telling = { say() {}, warn: (text) => warnings.push(text) };
  const client = new uncertain_client.UncertainClient(server, page, telling);
  const steps = [client.step(1), client.step(1), client.step(1)];
  for (const reply of ["answer", "refuse"]) {
    await turns();
    server.cloud += 1;
    server.asked.at(-1)[reply](reply === "answer" ? { rank: 1, of: 9 } : new Error("none"));
  }
  await turns();
  server.asked.at(-1).answer({ rank: 2, of: 5 });
  assert.deepEqual(await Promise.all(steps), [null, null, { rank: 2, of: 5 }]);
  assert.deepEqual([page.now.uncertain.rank, warnings], [2, []]);
});

test("decisions that the program does not take are taken back, with a notice", async () => {
  const { its, asked, warnings, decisions, client } = review();
  its.decide("accepted");
  its.decide("rejected");
  asked[0].answer({});
  await turns();
  // An answer to the first does not undo what is on its way.
  client.takeDecisions({ cloud: 0, version: 1, decision: "accepted", lines: [0] });
  assert.equal(decisions(), "aro");
  its.decide("rejected");
  asked[1].refuse(new Error("gone"));
  await turns();
  assert.equal(decisions(), "aoo");
  assert.deepEqual(warnings, ["The decision was not kept: gone"]);
  assert.equal(asked.length, 2);
});

test("a search that would forget decisions asks first", async () => {
  const questions = [];
  let says = false;
  const ask = async (question) => (questions.push(question), says);
  const none = review({ ask });
  await none.client.find();
  assert.deepEqual([questions.length, none.asked.length], [0, 1]);
  const some = review({ ask, lines: [line("accepted"), line()] });
  await some.client.find();
  assert.match(questions[0], /^You have decided on 1 of 2 lines/);
  assert.equal(some.asked.length, 0);
  says = true;
  await some.client.find();
  assert.deepEqual([some.asked[0].path, some.asked[0].body], ["/api/lines/find", { cloud: 0, boundaries: false }]);
  some.page.set({ boundaries: true });
  await some.client.find();
  assert.deepEqual(some.asked[1].body, { cloud: 0, boundaries: true });
});

test("lines of another cloud do not touch those in view", async () => {
  const { client, asked, decisions, page } = review();
  client.takeDecisions({ cloud: 1, version: 1, decision: "rejected", lines: [0, 1] });
  await client.take({ cloud: 1, version: 2, searching: false });
  assert.equal(decisions(), "ooo");
  assert.deepEqual([asked.length, page.now.lines.version], [0, 1]);
});

/** A queue whose program answers by hand; `steps` are those that it has. */
function queue() {
  const server = byHand();
  const its = { ...server, painted: [], failures: [], waiting: [], known: { undo: 2, redo: 0 }, there: null };
  its.queue = new work.WorkQueue(
    server,
    {
      painted: (answer, kind) => {
        its.painted.push(kind);
        its.known = answer;
      },
      failed: (message) => its.failures.push(message),
      waits: (strokes) => its.waiting.push(strokes),
      isOpen: () => its.there !== null,
      steps: () => its.known,
      askSteps: async () => its.there,
      idle() {},
    },
    1,
  );
  return its;
}

for (const [name, there, wanted] of [
  ["undoes what was not undone", { undo: 2, redo: 0 }, ["undo", "stroke", "stroke"]],
  ["does not undo twice", { undo: 1, redo: 1 }, ["stroke", "stroke"]],
])
  test(`strokes after an undo survive the end of the program, which then ${name}`, async () => {
    const its = queue();
    its.queue.undo();
    its.queue.stroke({ id: "a" });
    its.queue.stroke({ id: "b" });
    its.asked[0].refuse(new TypeError("gone"));
    await turns();
    assert.equal(its.waiting.at(-1), 2, "an undo is no stroke");
    its.there = there;
    for (let k = 1; its.queue.isBusy; ++k) {
      await turns();
      its.asked[k]?.answer({ undo: 1, redo: 1 });
      await turns();
    }
    assert.deepEqual(its.painted, wanted);
    assert.deepEqual(
      its.asked.slice(-2).map(({ body }) => body.id),
      ["a", "b"],
    );
    assert.deepEqual([its.failures, its.waiting.at(-1)], [[], 0]);
  });

test("an undo is not sent again where others have painted since; what follows is", async () => {
  const its = queue();
  its.queue.undo();
  its.queue.stroke({ id: "a" });
  its.asked[0].refuse(new TypeError("gone"));
  its.there = { undo: 5, redo: 0 };
  while (its.asked.length < 2) await turns();
  its.asked[1].answer({ undo: 6, redo: 0 });
  await turns();
  assert.deepEqual(its.failures, ["The undo was not applied: other strokes came between"]);
  assert.deepEqual(its.painted, ["stroke"]);
});

test("a stroke that is refused takes no other with it; a program that is gone for good takes all", async () => {
  const its = queue();
  for (const id of ["a", "b", "c", "d"]) its.queue.stroke({ id });
  its.asked[0].refuse(new api.ApiError(400, "no"));
  await turns();
  its.asked[1].answer({ undo: 3, redo: 0 });
  await turns();
  its.asked[2].refuse(new TypeError("gone"));
  await turns();
  its.queue.giveUp();
  await turns();
  assert.deepEqual(its.failures, [
    "The stroke was not applied: no",
    "2 strokes were not applied: the program that it was for is gone",
  ]);
  assert.deepEqual(its.painted, ["stroke"]);
});

/** A brush whose every pixel is a place of the cloud. */
function painting() {
  const page = new store.Store({ ...store.initialState, session: { spacing: 1 }, radius: 3, paintClass: 2 });
  const strokes = [];
  const refreshed = [];
  const stage = {
    chunks: [],
    camera: { pixels: 10 },
    pick: (x, y) => ({ position: [x, y, 0], normal: [0, 0, 1], depth: 1 }),
    loader: { refresh: (layer) => refreshed.push(layer), resume() {} },
    redraw() {},
  };
  const its = new brush.Brush(stage, page, { paint: (stroke) => strokes.push(stroke) });
  return { page, its, strokes, refreshed };
}

test("what is chosen during a stroke is for the next one", () => {
  const { page, its, strokes } = painting();
  its.press(0, 0);
  page.set({ paintClass: 0, radius: 9, protect: true, hidden: new Set([1]) });
  its.drag(100, 0);
  its.release();
  const { class: its_class, radius, protect, hidden } = strokes[0];
  assert.deepEqual([its_class, radius, protect, hidden], [2, 3, false, []]);
  assert.ok(strokes[0].centres.length > 2);
  its.press(0, 0);
  its.release();
  assert.deepEqual([strokes[1].class, strokes[1].radius, strokes[1].hidden], [0, 9, [1]]);
  assert.notEqual(strokes[0].id, strokes[1].id);
});

test("a stroke that is cancelled is not sent", () => {
  const { its, strokes, refreshed } = painting();
  its.press(0, 0);
  its.cancel();
  its.drag(50, 0);
  its.release();
  assert.deepEqual([strokes, refreshed, its.isDown], [[], ["labels"], false]);
});

/** The commands, with hands that write down what they do. */
function keys({ isOpen, isPainting = false }) {
  const done = [];
  const noting = (name) =>
    new Proxy({}, { get: (_, key) => (key === "target" ? [0, 0, 0] : () => void done.push(`${name} ${String(key)}`)) });
  const page = new store.Store({ ...store.initialState, training: { active: true } });
  const list = commands.commandsOf({
    store: page,
    stage: { camera: noting("camera"), fit: () => done.push("fit") },
    client: noting("client"),
    brush: noting("brush"),
    outline: { isOpen, cancel: () => done.push("outline cancel") },
    pointer: { cancel: () => isPainting && done.push("pointer cancel") > 0 },
    reviewer: noting("reviewer"),
    ...Object.fromEntries(
      ["toggleClip", "slice", "clearMeasure", "stepUncertain", "acceptUncertain"].map((key) => [
        key,
        () => done.push(key),
      ]),
    ),
  });
  return { press: (key) => list.find((command) => command.keys.includes(key)).run(), done, page };
}

const MOVING =
  "F Z Shift+Z W Shift+W Q Shift+Q Shift+F ArrowLeft ArrowUp Shift+ArrowLeft + - R N Shift+N Y J K A D".split(" ");

test("no key moves the view while an outline is open", () => {
  const closed = keys({ isOpen: false });
  MOVING.forEach(closed.press);
  assert.equal(closed.done.length, MOVING.length - 1); // and the store was told of Shift+F
  assert.ok(closed.page.now.orthographic);
  const open = keys({ isOpen: true });
  MOVING.forEach(open.press);
  assert.deepEqual(open.done, []);
  assert.ok(!open.page.now.orthographic);
  open.press("C");
  assert.deepEqual(open.done, ["toggleClip"]);
});

test("Escape cancels the stroke first, then the outline, then the training", () => {
  for (const [state, wanted] of [
    [{ isOpen: true, isPainting: true }, "pointer cancel"],
    [{ isOpen: true }, "outline cancel"],
    [{ isOpen: false }, "client cancel"],
  ]) {
    const { press, done } = keys(state);
    press("Escape");
    assert.deepEqual(done, [wanted]);
  }
});

test("colourings of a prediction are offered once there is one", () => {
  const session = { has_colours: false, file_labels: [], file_predicted: false, las_classes: [] };
  const now = { ...store.initialState, session };
  assert.deepEqual(modes.modesOf({ now }), ["normals", "labels", "feature"]);
  const predicted = modes.modesOf({ now: { ...now, hasPrediction: true } });
  assert.deepEqual(predicted, ["normals", "labels", "prediction", "confidence", "p_sharp", "feature"]);
});

test("colourings of the file are offered where it has such classes, errors where its labels are a truth", () => {
  const sharp = { id: 2, name: "sharp-edge", colour: [168, 0, 0], points: 9 };
  const session = { has_colours: false, file_labels: [sharp], file_predicted: false, las_classes: [] };
  const offered = (more, state = {}) => {
    const now = { ...store.initialState, hasPrediction: true, session: { ...session, ...more }, ...state };
    return modes.modesOf({ now }).filter((mode) => ["file", "las", "errors"].includes(mode));
  };
  assert.deepEqual(offered({}), ["file", "errors"]);
  assert.deepEqual(offered({ las_classes: [sharp] }), ["file", "las", "errors"]);
  assert.deepEqual(offered({ file_predicted: true }), ["file"]);
  assert.deepEqual(offered({ file_labels: [{ ...sharp, name: "pipe" }] }), ["file"]);
  assert.deepEqual(offered({}, { edges: false, classes: [{ ...sharp, name: "pipe" }] }), ["file"]);
  assert.deepEqual(offered({}, { hasPrediction: false }), ["file"]);
});

test("a cloud that is looked at again is as it was left, but for what the prediction has overtaken", () => {
  const pose = { position: [1, 2, 3], turn: [0, 0, 0, 1], distance: 4 };
  const left = {
    ...store.initialState,
    clip: { on: true, box: { min: [0, 0, 0], max: [1, 1, 1] } },
    measured: [[1, 1, 1]],
    uncertain: { rank: 3 },
    predictionVersion: 5,
    lines: { version: 2 },
    line: 7,
    showLines: false,
  };
  const view = views.viewOf(left, pose);
  assert.equal(view.pose, pose);
  const { clip, measured, uncertain, line: chosen, showLines } = views.resumed(view, left);
  assert.deepEqual([clip, measured, uncertain, chosen, showLines], [left.clip, [[1, 1, 1]], { rank: 3 }, 7, false]);
  const later = views.resumed(view, { predictionVersion: 6, lines: { version: 3 } });
  assert.deepEqual([later.clip, later.uncertain, later.line, later.showLines], [left.clip, null, null, true]);
  assert.deepEqual(views.resumed(undefined, left).clip, null);
});

test("the first words are of fingers where there is no mouse", () => {
  assert.match(words.hintWords(true, false), /^Paint where the prediction is wrong\. Right button/);
  assert.match(words.hintWords(false, true), /^Paint some points of each class\. One finger paints/);
});

test("preferences come back; what is damaged does not", () => {
  const kept = new Map();
  const storage = { getItem: (key) => kept.get(key) ?? null, setItem: (key, value) => kept.set(key, value) };
  const first = new store.Store(store.initialState);
  preferences.keepPreferences(first, () => storage);
  first.set({ theme: "dark", safePalette: true, pointSize: 3, brush: 4, dxfArcs: "none", mode: "normals" });
  const second = new store.Store(store.initialState);
  preferences.keepPreferences(second, () => storage);
  const { theme, safePalette, pointSize, brush: spacings, dxfArcs, mode } = second.now;
  assert.deepEqual([theme, safePalette, pointSize, spacings, dxfArcs, mode], ["dark", true, 3, 4, "none", "labels"]);
  assert.deepEqual(preferences.readPreferences("{"), {});
  assert.deepEqual(preferences.readPreferences("null"), {});
  assert.deepEqual(preferences.readPreferences('{"theme":"pink","pointSize":1e9,"brush":2,"toString":1}'), {
    brush: 2,
  });
  preferences.keepPreferences(first, () => {
    throw new Error("no storage here");
  });
});

test("a saved or downloaded model that does not know all strokes is told", async () => {
  const page = new store.Store({ ...store.initialState, hasPrediction: true });
  const warnings = [];
  const server = { ...byHand(), address: (path) => path };
  const its = new files.Files(server, page, { say() {}, warn: (text) => warnings.push(text) });
  const save = async (what, left) => {
    const path = its.save(what, 0, async () => true);
    server.asked.pop().answer({ path: `a.${what}`, strokes_left_out: left });
    assert.equal(await path, `a.${what}`);
    return warnings.splice(0);
  };
  assert.deepEqual(await save("model", 0), []);
  assert.match((await save("model", 1))[0], /^This model does not know 1 stroke yet/);
  assert.match((await save("cloud", 3))[0], /^The prediction in this cloud does not know 3 strokes yet/);
  const replaced = its.save("model", 0, async () => true);
  server.asked.pop().refuse(new api.ApiError(409, "a.model exists"));
  await turns();
  assert.deepEqual(server.asked[0].body, { what: "model", cloud: 0, overwrite: true });
  server.asked.pop().answer({ path: "a.model", strokes_left_out: 2 });
  assert.equal(await replaced, "a.model");
  assert.match(warnings.splice(0)[0], /2 strokes/);
  assert.equal(its.downloadAddress("model"), "/api/download/model");
  page.set({ outOfDate: true });
  its.downloadAddress("project");
  assert.deepEqual(warnings, []);
  its.downloadAddress("model");
  assert.match(warnings[0], /does not know the last strokes yet/);
});
