// The list of keys and buttons.

import { h } from "../shared/dom";
import type { Command } from "./commands";

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
