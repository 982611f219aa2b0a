// Small helpers to build elements.

export type Child = Node | string | null | undefined | false;
type Attributes = Record<string, string | number | boolean | null | undefined | ((e: any) => void)>;

function fill<E extends Element>(element: E, attributes: Attributes, children: Child[]): E {
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") element.addEventListener(name.slice(2), value);
    else if (value === true) element.setAttribute(name, "");
    else if (value !== null && value !== undefined && value !== false) element.setAttribute(name, String(value));
  }
  for (const child of children) if (child) element.append(child);
  return element;
}

/** An HTML element; an attribute `onX` is a listener for the event X. */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  return fill(document.createElement(tag), attributes, children);
}

/** An SVG element. */
export function svg<K extends keyof SVGElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): SVGElementTagNameMap[K] {
  return fill(document.createElementNS("http://www.w3.org/2000/svg", tag), attributes, children);
}

export interface Choice<T> {
  value: T;
  label: string;
}

let groups = 0;

/** One of a few: radio buttons that look like a switch, with the arrow keys of radio buttons. */
export function segmented<T>(
  label: string,
  choices: Choice<T>[],
  chosen: T,
  onChange: (value: T) => void,
): HTMLElement {
  const name = `choice${++groups}`;
  return h(
    "fieldset",
    { class: "segmented" },
    h("legend", {}, label),
    h(
      "span",
      { class: "segments" },
      ...choices.map(({ value, label: text }) =>
        h(
          "label",
          {},
          h("input", { type: "radio", name, checked: value === chosen, onchange: () => onChange(value) }),
          h("span", {}, text),
        ),
      ),
    ),
  );
}

/** One of many: a list to open. */
export function dropdown<T>(label: string, choices: Choice<T>[], chosen: T, onChange: (value: T) => void): HTMLElement {
  const list = h(
    "select",
    { onchange: () => onChange(choices[list.selectedIndex].value) },
    ...choices.map(({ value, label: text }) => h("option", { selected: value === chosen }, text)),
  );
  return h("label", { class: "dropdown" }, h("span", {}, label), list);
}

/** What a custom property such as --ink is now. */
export const css = (name: string): string => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
