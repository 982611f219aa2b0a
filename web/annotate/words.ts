// Messages that come and go, questions, and the list of keys.

import { h } from "../shared/dom";
import type { Command } from "./commands";

/** How long a message stays: as long as it takes to read it. */
export const readingMs = (text: string): number => Math.min(2500 + 45 * text.length, 8000);

const LOOKED_AT_MS = 1000;

export interface Words {
  say(text: string): void;
  warn(text: string): void;
  /** Takes back what is no longer so. */
  unsay(text: string): void;
}

export class Notices implements Words {
  readonly element = h("div", { class: "notices", "aria-live": "polite" });

  say(text: string): void {
    this.add(text, "notice");
  }

  warn(text: string): void {
    this.add(text, "notice warning");
  }

  /** Takes back what is no longer so. */
  unsay(text: string): void {
    for (const notice of [...this.element.children]) if (notice.firstChild?.textContent === text) notice.remove();
  }

  /** A click on it or a tap removes it; it stays while the pointer or the focus is on it. */
  private add(text: string, kind: string): void {
    this.unsay(text);
    const notice = h(
      "p",
      { class: kind, onclick: () => getSelection()?.isCollapsed !== false && notice.remove() },
      h("span", {}, text),
      h("button", { type: "button", "aria-label": "Close", onclick: () => notice.remove() }, "×"),
    );
    this.element.append(notice);
    const expire = (): void => {
      if (notice.matches(":hover, :focus-within")) window.setTimeout(expire, LOOKED_AT_MS);
      else notice.remove();
    };
    window.setTimeout(expire, readingMs(text));
  }
}

/** Asks in a dialogue; false if it is dismissed. */
export function ask(question: string, yes: string): Promise<boolean> {
  return new Promise((done) => {
    const dialog = h(
      "dialog",
      { class: "question", "aria-labelledby": "question-words" },
      h(
        "form",
        { method: "dialog" },
        h("p", { id: "question-words" }, question),
        h(
          "div",
          { class: "buttons" },
          h("button", { class: "plain", value: "" }, "Cancel"),
          h("button", { class: "plain strong", value: "yes" }, yes),
        ),
      ),
    );
    dialog.addEventListener("close", () => {
      dialog.remove();
      done(dialog.returnValue === "yes");
    });
    document.body.append(dialog);
    dialog.showModal();
  });
}

/** How to begin. */
export function hintWords(isPredicted: boolean, isTouched: boolean): string {
  const what = isPredicted ? "Paint where the prediction is wrong" : "Paint some points of each class";
  const how = isTouched
    ? "One finger paints, two pan and zoom; the Navigate tool orbits."
    : "Right button: orbit. Wheel: zoom. ?: all keys.";
  return `${what}. ${how}`;
}

const MOUSE: [string, string][] = [
  ["left button", "paint"],
  ["right button, or left with space held", "orbit about the point under the pointer"],
  ["middle button, or right with Shift", "pan"],
  ["wheel", "zoom about the point under the pointer"],
  ["wheel with Alt", "brush size"],
  ["one finger", "paint; orbit with the navigate tool"],
  ["two fingers", "pan and zoom"],
];

const list = (title: string, rows: [string[], string][], kind = "keys"): HTMLElement =>
  h(
    "section",
    {},
    h("h3", {}, title),
    h(
      "dl",
      { class: kind },
      ...rows.flatMap(([keys, name]) => [
        h("dt", {}, ...keys.map((key) => h("kbd", {}, key.replace("Arrow", "")))),
        h("dd", {}, name),
      ]),
    ),
  );

/** What each key and button does now. */
function lists(commands: Command[]): HTMLElement[] {
  const groups = [...new Set(commands.map((command) => command.group))];
  const keys = groups.map((group) =>
    list(
      group,
      commands.filter((c) => c.group === group && c.name).map((c) => [c.keys, c.name]),
    ),
  );
  const hands = list(
    "Mouse and fingers",
    MOUSE.map(([key, name]) => [[key], name]),
    "described",
  );
  return matchMedia("(pointer: coarse)").matches ? [hands, ...keys] : [...keys, hands];
}

/** The help, and what opens it. */
export function helpDialog(commands: Command[]): { element: HTMLDialogElement; open(): void } {
  const columns = h("div", { class: "columns" });
  const dialog = h(
    "dialog",
    { class: "help", "aria-labelledby": "help-title" },
    h(
      "form",
      { method: "dialog" },
      h("h2", { id: "help-title" }, "Keys"),
      h("button", { class: "plain" }, "Close", h("kbd", {}, "Esc")),
    ),
    columns,
  );
  dialog.addEventListener("click", (event) => {
    if (event.target === dialog) dialog.close();
  });
  return {
    element: dialog,
    open: () => {
      columns.replaceChildren(...lists(commands));
      dialog.showModal();
    },
  };
}
