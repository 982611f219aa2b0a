// Messages that come and go, questions, and how to begin.

import { h } from "../shared/dom";

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
