import "../shared/theme.css";
import "../shared/controls.css";
import "./style.css";
import { css, h } from "../shared/dom";
import { Api } from "./api";
import { Brush } from "./brush";
import { curtain, header, hint, legend, presser, toolbar } from "./chrome";
import { ClipHandles, stepped } from "./clip_handles";
import { Client } from "./client";
import { refusalOf } from "./refusal";
import type { Saved } from "./files";
import { appearanceOf, paintColour, strokesOf, valuesQuery } from "./colouring";
import { bindKeys, commandsOf } from "./commands";
import { fileStrokes } from "./file_classes";
import { Measure } from "./measure";
import { Outline } from "./outline";
import { Overlay } from "./overlay";
import { cloudsPanel } from "./panel_clouds";
import { editClassesDialog } from "./class_editor";
import { classesPanel } from "./panel_classes";
import { runsPanel, trainingPanel, uncertainPanel } from "./panel_training";
import { clipPanel, toggledClip, viewPanel } from "./panel_view";
import { linesPanel } from "./panel_lines";
import { Pointer } from "./pointer";
import { keepPreferences } from "./preferences";
import { Reviewer } from "./reviewer";
import { Stage } from "./stage";
import { activeClip, initialState, Store, type State } from "./store";
import { helpDialog } from "./help";
import { ask, Notices } from "./words";

/** How near the view goes to an uncertain place. */
const VISIT_SPACINGS = 100;

function open(page: HTMLElement): void {
  const store = new Store<State>(initialState);
  const api = new Api(new URLSearchParams(location.search).get("token") ?? "");
  const notices = new Notices();
  const client = new Client(api, store, notices);
  const canvas = h("canvas", {
    tabindex: 0,
    role: "application",
    "aria-label":
      "The cloud. Arrow keys orbit, Shift and arrow keys pan, Enter paints at the centre of the view; question mark lists all keys.",
  });
  const place = h("main", { class: "stage" }, canvas);
  const stage: Stage = new Stage(canvas, api, {
    arrived: () => store.set({ fetching: false }),
    moved: () => {
      overlay.follow();
      pointer.hoverSoon();
    },
    failed: (error) => notices.warn(error.message),
    isPainting: () => brush.isDown || client.isBusy,
    contextLost: (contextLost) => store.set({ contextLost }),
  });
  client.stage = stage;
  keepPreferences(store, () => localStorage);
  store.set({ eyeDome: !stage.isSoftware }); // a pass over all pixels costs a graphics card nothing
  const overlay: Overlay = new Overlay(stage);
  const brush: Brush = new Brush(stage, store, client);
  const outline = new Outline(stage, store, client, overlay);
  const pointer: Pointer = new Pointer(stage, store, brush, outline, overlay, {
    measured: (place) => measure.add(place),
    refused: () => notices.warn(refusalOf(store.now)),
    colour: () => paintColour(store.now),
  });

  client.leaving = () => pointer.finish();

  const measure = new Measure(overlay, store);
  new ClipHandles(overlay, store);
  const reviewer = new Reviewer(stage, store, client.lines);

  const save = async (what: Saved): Promise<void> => {
    const clouds = what === "cloud" ? store.now.clouds.map((_, k) => k) : [0];
    for (const cloud of clouds) {
      const path = await client.files.save(what, cloud, (problem) => ask(`${problem}. Replace the file?`, "Replace"));
      if (path) notices.say(`Saved ${path}`);
    }
  };
  const screenshot = async (): Promise<void> => {
    const blob = await stage.picture();
    if (!blob) return;
    const address = URL.createObjectURL(blob);
    h("a", { href: address, download: `${store.now.session?.name ?? "cloud"}.png` }).click();
    window.setTimeout(() => URL.revokeObjectURL(address), 10_000);
  };
  const stepUncertain = async (by: 1 | -1): Promise<void> => {
    const place = await client.uncertain.step(by);
    const { session } = store.now;
    if (!place || !session) return;
    stage.camera.visit(place.position, place.normal, stage.camera.nearby(session.spacing * VISIT_SPACINGS));
  };
  /** Paints the place with its own prediction and goes on. */
  const acceptUncertain = (): void => {
    const { uncertain, session } = store.now;
    const refusal = refusalOf(store.now);
    if (refusal) return notices.warn(refusal);
    if (!uncertain || !session) return;
    client.paint({
      id: crypto.randomUUID(),
      tool: "brush",
      class: uncertain.prediction,
      centres: [uncertain.position],
      radius: session.spacing * 0.5,
      protect: false,
      hidden: [],
      clip: null,
    });
    void stepUncertain(1);
  };
  const editClasses = (): void => {
    const refusal = refusalOf(store.now);
    if (refusal) notices.warn(refusal);
    else if (store.now.session) editClassesDialog(store.now, (table) => client.setClasses(table));
  };
  const takeFileLabels = (): void => {
    for (const stroke of fileStrokes(store.now)) client.paint(stroke);
    notices.say("Painted as in the file, one stroke a class: undo takes them back one by one.");
  };
  const commands = commandsOf({
    store,
    stage,
    client,
    brush,
    outline,
    pointer,
    reviewer,
    toggleClip: () => store.set({ clip: toggledClip(store.now) }),
    slice: (by) => {
      const { clip, session } = store.now;
      if (clip?.on && session) store.set({ clip: { on: true, box: stepped(clip.box, session.bounds, by) } });
    },
    clearMeasure: () => store.set({ measured: [] }),
    stepUncertain: (by) => void stepUncertain(by),
    acceptUncertain,
    save: () => void save("project"),
    screenshot: () => void screenshot(),
    editClasses,
    help: () => help.open(),
  });
  const help = helpDialog(commands);
  const press = presser(commands);
  bindKeys(commands, () => document.querySelector("dialog[open]") !== null || store.now.progress !== null);
  bindSpace(pointer);

  const foot = h("div", { class: "foot" }, notices.element, legend(store));
  place.append(overlay.element, hint(store), curtain(store, client), foot);
  page.replaceChildren(
    header(store, (what) => void save(what), client),
    toolbar(store, press),
    place,
    h(
      "aside",
      { "aria-label": "Settings" },
      cloudsPanel(store, client),
      classesPanel(store, brush, editClasses, takeFileLabels),
      viewPanel(store, press),
      trainingPanel(store, client),
      uncertainPanel(store, press),
      linesPanel(store, client, reviewer, press),
      clipPanel(store, stage, press),
      runsPanel(store, client),
    ),
    help.element,
  );

  const repaint = (): void => stage.setAppearance(appearanceOf(store.now, css("--stage")));
  store.watch(
    ["mode", "paintOnTop", "safePalette", "hidden", "clip", "pointSize", "eyeDome", "classes", "edges", "session"],
    repaint,
  );
  store.watch(["mode", "feature", "scale"], () => stage.loader.setValues(valuesQuery(store.now)));
  store.watch(["lines", "line", "showLines", "safePalette", "session"], () =>
    stage.setLines(strokesOf(store.now), store.now.session?.spacing ?? 0),
  );
  store.watch(["clip"], () => overlay.setClip(activeClip(store.now)));
  store.watch(["uncertain"], () => overlay.setMark(store.now.uncertain?.position ?? null));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", repaint);
  store.watch(["theme"], () => {
    document.documentElement.dataset.theme = store.now.theme;
    repaint();
  });
  store.watch(["orthographic"], () => stage.camera.setOrthographic(store.now.orthographic));
  addEventListener("pagehide", () => api.leave());
  addEventListener("beforeunload", (event) => client.isBusy && event.preventDefault());
  addEventListener("pageshow", ({ persisted }) => persisted && location.reload()); // it has left before
  client.start().catch((error: Error) => {
    store.set({ progress: { stage: `Cannot open the cloud: ${error.message}.`, fraction: 0 } });
  });
  Object.assign(window, { annotator: { store, stage, client } }); // for tests and the curious
}

/** The space bar, held, lets the left button turn the view. */
function bindSpace(pointer: Pointer): void {
  const set =
    (held: boolean) =>
    (event: KeyboardEvent): void => {
      if (event.code !== "Space" || (event.target as HTMLElement).matches("button, input, select, summary, a")) return;
      event.preventDefault();
      pointer.spaceHeld = held;
      pointer.hoverSoon();
    };
  addEventListener("keydown", set(true));
  addEventListener("keyup", set(false));
}

const page = document.getElementById("page")!;
try {
  open(page);
} catch (error) {
  console.error(error);
  page.textContent = "The cloud cannot be drawn: this browser does not support WebGL 2.";
}
