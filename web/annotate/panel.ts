// Parts of the side panel.

import { dropdown, h, segmented, type Child, type Choice } from "../shared/dom";

/** A section with a heading, which folds. */
export function section(title: string, open: boolean, ...children: Child[]): HTMLElement {
  return h("details", { class: "section", open }, h("summary", {}, h("h2", {}, title)), ...children);
}

/** A labelled check box that follows the state. */
export function checkbox(
  label: string,
  key: string,
  onChange: (on: boolean) => void,
): { element: HTMLElement; set(on: boolean): void } {
  const box = h("input", { type: "checkbox", onchange: () => onChange(box.checked) });
  return {
    element: h("label", { class: "check" }, box, h("span", {}, label), key && h("kbd", {}, key)),
    set: (on) => {
      box.checked = on;
    },
  };
}

export interface Slider {
  element: HTMLElement;
  set(value: number, text: string): void;
}

/** A labelled slider with its value in words beside it. */
export function slider(
  label: string,
  min: number,
  max: number,
  step: number,
  onInput: (value: number) => void,
): Slider {
  const input = h("input", { type: "range", min, max, step, oninput: () => onInput(Number(input.value)) });
  const words = h("output", {});
  return {
    element: h("label", { class: "range" }, h("span", {}, label), input, words),
    set: (value, text) => {
      input.value = String(value);
      input.setAttribute("aria-valuetext", text);
      words.textContent = text;
    },
  };
}

export const button = (label: string, onClick: () => void, key = "", kind = "plain"): HTMLButtonElement =>
  h("button", { type: "button", class: kind, onclick: unlessRefused(onClick) }, label, key && h("kbd", {}, key));

/** Lets a button be used or not. It keeps the focus: a disabled one would lose it to the page. */
export const allow = (button: HTMLButtonElement, on: boolean): void =>
  button.setAttribute("aria-disabled", String(!on));

/** What a click on a button does where it may be used. */
export const unlessRefused =
  (run: () => void) =>
  (event: Event): void => {
    if ((event.currentTarget as Element).getAttribute("aria-disabled") !== "true") run();
  };

/** Shows one of two buttons, which takes over the focus of the other. */
export function showOnly(shown: HTMLButtonElement, other: HTMLButtonElement): void {
  const hasFocus = document.activeElement === other;
  shown.hidden = false;
  other.hidden = true;
  if (hasFocus) shown.focus();
}

export interface Picker<T> {
  element: HTMLElement;
  set(value: T): void;
}

/** One of many, which follows the state and keeps the focus. */
export function list<T>(label: string, choices: Choice<T>[], onChange: (value: T) => void): Picker<T> {
  const element = h("div", { class: "row" }, dropdown(label, choices, choices[0]?.value, onChange));
  const select = element.querySelector("select")!;
  return {
    element,
    set: (value) => {
      select.selectedIndex = choices.findIndex((choice) => choice.value === value);
    },
  };
}

/** One of a few, which follows the state and keeps the focus. */
export function buttons<T>(label: string, choices: Choice<T>[], onChange: (value: T) => void): Picker<T> {
  const element = segmented(label, choices, undefined as T, onChange);
  const inputs = element.querySelectorAll("input");
  return {
    element,
    set: (value) =>
      choices.forEach((choice, i) => {
        inputs[i].checked = choice.value === value;
      }),
  };
}
