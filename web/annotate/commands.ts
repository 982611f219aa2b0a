// Everything the page can do, each with a name and keys; the help is made of this list.

import type { Brush } from "./brush";
import { isOff, MOST_CLASSES, paintable, paletteOf } from "./classes";
import type { Client } from "./client";
import { modesOf } from "./modes";
import type { Outline } from "./outline";
import type { Pointer } from "./pointer";
import type { Reviewer } from "./reviewer";
import type { Stage } from "./stage";
import { NO_CLASS } from "./types";
import type { AppStore, Tool } from "./store";

export interface Command {
  /** As `Ctrl+Shift+Z`; the first is shown on buttons. */
  keys: string[];
  /** What it does now; empty if nothing. */
  readonly name: string;
  group: "Tools" | "Classes" | "View" | "Colours" | "Training" | "Lines" | "File";
  run(): void;
}

/** What commands act on. */
export interface Hands {
  store: AppStore;
  stage: Stage;
  client: Client;
  brush: Brush;
  outline: Outline;
  pointer: Pointer;
  reviewer: Reviewer;
  toggleClip(): void;
  /** Moves a slice by so many of its thicknesses. */
  slice(by: number): void;
  clearMeasure(): void;
  stepUncertain(by: 1 | -1): void;
  acceptUncertain(): void;
  editClasses(): void;
  save(): void;
  screenshot(): void;
  help(): void;
}

export function toggled(set: ReadonlySet<number>, item: number): Set<number> {
  const copy = new Set(set);
  if (!copy.delete(item)) copy.add(item);
  return copy;
}

const TURN = 0.12;
const SLIDE = 60;

/** What moves the view does nothing while an outline is open, whose corners are pixels of it. */
const unlessOutlined =
  (outline: Pick<Outline, "isOpen">, run: () => void): (() => void) =>
  () => {
    if (!outline.isOpen) run();
  };

function viewCommands({ store, stage, outline, slice, toggleClip }: Hands): Command[] {
  const { camera } = stage;
  const moves = (keys: string[], name: string, run: () => void): Command => ({
    keys,
    name,
    group: "View",
    run: unlessOutlined(outline, run),
  });
  const command = (keys: string[], name: string, run: () => void): Command => ({ keys, name, group: "View", run });
  return [
    moves(["F", "Home"], "fit the cloud to the view", () => stage.fit("first")),
    moves(["Z"], "from above", () => stage.fit("top")),
    moves(["Shift+Z"], "from below", () => stage.fit("bottom")),
    moves(["W"], "from the front", () => stage.fit("front")),
    moves(["Shift+W"], "from the back", () => stage.fit("back")),
    moves(["Q"], "from the right", () => stage.fit("right")),
    moves(["Shift+Q"], "from the left", () => stage.fit("left")),
    moves(["Shift+F"], "orthographic or perspective", () => store.set({ orthographic: !store.now.orthographic })),
    moves(["ArrowLeft"], "orbit left", () => camera.turn(-TURN, 0, camera.target)),
    moves(["ArrowRight"], "orbit right", () => camera.turn(TURN, 0, camera.target)),
    moves(["ArrowUp"], "orbit up", () => camera.turn(0, -TURN, camera.target)),
    moves(["ArrowDown"], "orbit down", () => camera.turn(0, TURN, camera.target)),
    moves(["Shift+ArrowLeft"], "pan left", () => camera.slide(-SLIDE, 0, camera.target)),
    moves(["Shift+ArrowRight"], "pan right", () => camera.slide(SLIDE, 0, camera.target)),
    moves(["Shift+ArrowUp"], "pan up", () => camera.slide(0, -SLIDE, camera.target)),
    moves(["Shift+ArrowDown"], "pan down", () => camera.slide(0, SLIDE, camera.target)),
    moves(["+", "="], "zoom in", () => camera.approach(1 / 1.2, camera.target)),
    moves(["-"], "zoom out", () => camera.approach(1.2, camera.target)),
    moves(["R"], "roll", () => camera.roll(Math.PI / 12)),
    command(["C"], "clipping box", toggleClip),
    command(["<"], "slice: one thickness back", () => slice(-1)),
    command([">"], "slice: one thickness on", () => slice(1)),
  ];
}

function toolCommands({ store, brush, outline, pointer, client }: Hands): Command[] {
  const command = (keys: string[], name: string, run: () => void): Command => ({ keys, name, group: "Tools", run });
  const tool = (key: string, name: string, wanted: Tool): Command =>
    command([key], name, () => {
      outline.cancel();
      store.set({ tool: wanted });
    });
  return [
    tool("B", "brush", "brush"),
    tool("L", "lasso", "lasso"),
    tool("G", "polygon: click the corners, Enter closes it", "polygon"),
    tool("V", "navigate: the left button orbits", "navigate"),
    tool("U", "measure a distance: click two points", "measure"),
    command(["["], "smaller brush", () => brush.grow(1 / 1.2)),
    command(["]"], "larger brush", () => brush.grow(1.2)),
    command(["Enter"], "paint at the centre of the view; close the polygon", () =>
      outline.isOpen ? outline.close() : pointer.dab(),
    ),
    command(["Backspace"], "remove the polygon's last corner", () => outline.shorten()),
    command(["P"], "protect painted points", () => store.set({ protect: !store.now.protect })),
    command(["X"], "lasso and polygon: front points only", () => store.set({ frontOnly: !store.now.frontOnly })),
    command(["Ctrl+Z"], "undo the last stroke", () => client.undo()),
    command(["Ctrl+Shift+Z", "Ctrl+Y"], "redo", () => client.redo()),
  ];
}

function classCommands({ store, editClasses }: Hands): Command[] {
  const group = "Classes";
  /** A command on the class of a key. */
  const onClass = (index: number, prefix: string, words: string, run: (id: number) => void): Command => ({
    keys: [`${prefix}${index + 1}`],
    get name() {
      const its = paintable(store.now)[index];
      return its ? `${words} ${paletteOf(store.now)[its.id].name}` : "";
    },
    group,
    run: () => {
      const its = paintable(store.now)[index];
      if (its) run(its.id);
    },
  });
  const indices = Array.from({ length: MOST_CLASSES }, (_, index) => index);
  return [
    ...indices.map((index) =>
      onClass(index, "", "paint", (id) => {
        if (!isOff(id, store.now)) store.set({ paintClass: id });
      }),
    ),
    { keys: ["E", "0"], name: "erase", group, run: () => store.set({ paintClass: NO_CLASS }) },
    ...indices.map((index) =>
      onClass(index, "Shift+", "hide or show", (id) => store.set({ hidden: toggled(store.now.hidden, id) })),
    ),
    { keys: ["Shift+E"], name: "edit the classes", group, run: editClasses },
  ];
}

function colourCommands({ store }: Hands): Command[] {
  const command = (keys: string[], name: string, run: () => void): Command => ({ keys, name, group: "Colours", run });
  const step = (by: number): void => {
    const modes = modesOf(store);
    store.set({ mode: modes[(modes.indexOf(store.now.mode) + by + modes.length) % modes.length] });
  };
  const scale = (by: number): void => {
    const count = store.now.session?.scales.length ?? 1;
    store.set({ scale: Math.min(Math.max(store.now.scale + by, 0), count - 1) });
  };
  const size = (factor: number): void =>
    store.set({ pointSize: Math.min(Math.max(store.now.pointSize * factor, 0.3), 6) });
  return [
    command(["M"], "next colouring", () => step(1)),
    command(["Shift+M"], "previous colouring", () => step(-1)),
    command([","], "smaller scale of the feature", () => scale(-1)),
    command(["."], "larger scale of the feature", () => scale(1)),
    command(["I"], "eye-dome lighting", () => store.set({ eyeDome: !store.now.eyeDome })),
    command(["O"], "painted points on top", () => store.set({ paintOnTop: !store.now.paintOnTop })),
    command(["{"], "smaller points", () => size(1 / 1.15)),
    command(["}"], "larger points", () => size(1.15)),
  ];
}

function lineCommands({ store, outline, reviewer }: Hands): Command[] {
  const moves = (keys: string[], name: string, run: () => void): Command => ({
    keys,
    name,
    group: "Lines",
    run: unlessOutlined(outline, run),
  });
  return [
    moves(["J"], "next line", () => reviewer.step(1)),
    moves(["K"], "previous line", () => reviewer.step(-1)),
    moves(["A"], "accept the line", () => reviewer.decide("accepted")),
    moves(["D"], "reject the line", () => reviewer.decide("rejected")),
    {
      keys: ["H"],
      name: "hide or show lines",
      group: "Lines",
      run: () => store.set({ showLines: !store.now.showLines }),
    },
  ];
}

export function commandsOf(hands: Hands): Command[] {
  const { client, outline, store } = hands;
  const stepCloud = (by: number): void => {
    const { cloud, clouds } = store.now;
    client.look((cloud + by + clouds.length) % clouds.length);
  };
  const cloudCommand = (key: string, words: string, by: number): Command => ({
    keys: [key],
    get name() {
      return store.now.clouds.length > 1 ? words : "";
    },
    group: "File",
    run: () => stepCloud(by),
  });
  const command = (keys: string[], name: string, group: Command["group"], run: () => void): Command => ({
    keys,
    name,
    group,
    run,
  });
  const moves = (keys: string[], name: string, run: () => void): Command =>
    command(keys, name, "Training", unlessOutlined(outline, run));
  return [
    ...toolCommands(hands),
    ...classCommands(hands),
    ...viewCommands(hands),
    ...colourCommands(hands),
    moves(["N"], "next uncertain place", () => hands.stepUncertain(1)),
    moves(["Shift+N"], "previous uncertain place", () => hands.stepUncertain(-1)),
    moves(["Y"], "the prediction at the uncertain place is right", hands.acceptUncertain),
    command(["T"], "train now", "Training", () => client.train()),
    command(["Escape"], "cancel the stroke, outline, measurement, training or search for lines", "Training", () => {
      if (hands.pointer.cancel()) return;
      if (outline.isOpen) outline.cancel();
      else if (store.now.measured.length > 0) hands.clearMeasure();
      else if (store.now.training?.active || store.now.lines.searching) client.cancel();
    }),
    ...lineCommands(hands),
    cloudCommand("PageDown", "next cloud", 1),
    cloudCommand("PageUp", "previous cloud", -1),
    command(["Ctrl+S"], "save the project", "File", hands.save),
    command(["Shift+S"], "screenshot", "File", hands.screenshot),
    command(["?"], "show these keys", "File", hands.help),
  ];
}

type KeyPress = Pick<
  KeyboardEvent,
  "key" | "code" | "ctrlKey" | "metaKey" | "shiftKey" | "altKey" | "getModifierState"
>;

/** The names that a key event may have as the commands spell them, the likeliest first. */
export function spellings(event: KeyPress): string[] {
  const { key, code, ctrlKey, metaKey, shiftKey, altKey } = event;
  const typed = key.length === 1 ? key.toUpperCase() : key;
  // Alt types the brackets of many keyboards; all else with it belongs to the browser.
  if (altKey || event.getModifierState("AltGraph")) return /^[!-/:-@[-`{-~]$/.test(typed) ? [typed] : [];
  const control = ctrlKey || metaKey ? "Ctrl+" : "";
  const shift = shiftKey ? "Shift+" : "";
  const byKey = `${control}${/^[A-Z]$/.test(typed) || key.length > 1 ? shift : ""}${typed}`;
  if (/^[A-Z0-9]$/.test(typed)) return [byKey];
  const [, digit, letter] = /^(?:Digit(\d)|Key([A-Z]))$/.exec(code) ?? [];
  // `!` and `&` are the key of 1, shifted here and not there.
  if (digit) return [`${control}${shift}${digit}`, byKey];
  // A letter of another alphabet.
  return letter && key.length === 1 && key > "~" ? [byKey, `${control}${shift}${letter}`] : [byKey];
}

/** Runs commands by keys, except where keys belong to a control. */
export function bindKeys(commands: Command[], isBlocked: () => boolean): void {
  const byKey = new Map(commands.flatMap((command) => command.keys.map((key) => [key, command] as const)));
  addEventListener("keydown", (event) => {
    const at = event.target as HTMLElement;
    const name = spellings(event).find((one) => byKey.get(one)?.name);
    if (!name || isBlocked()) return;
    if (at.matches("select, input[type=text], input[type=number]") && !name.startsWith("Ctrl+")) return;
    if (at.matches("input") && name.includes("Arrow")) return;
    if (at.matches("input[type=range]") && ["Home", "PageUp", "PageDown"].includes(name)) return;
    if (at.matches("button, summary, a, input") && ["Enter", "Backspace"].includes(name)) return;
    event.preventDefault();
    byKey.get(name)!.run();
  });
}
