// The clouds that are trained on together: which one is looked at.

import { h } from "../shared/dom";
import type { Client } from "./client";
import { count } from "./format";
import { section } from "./panel";
import type { AppStore } from "./store";

export function cloudsPanel(store: AppStore, client: Client): HTMLElement {
  const rows = h("ul", { class: "classes clouds" });
  const element = section(
    "Clouds",
    true,
    rows,
    h("p", { class: "summary" }, "One model learns from what is painted in all of them."),
  );
  let shown = "";
  store.watch(["clouds", "cloud"], () => {
    const { clouds, cloud } = store.now;
    element.hidden = clouds.length < 2;
    const files = clouds.map(({ file }) => file).join("/");
    if (files !== shown) {
      rows.replaceChildren(...clouds.map(({ file }, k) => cloudRow(file, () => client.look(k))));
      shown = files;
    }
    clouds.forEach(({ points, painted }, k) => {
      rows.children[k].querySelector("input")!.checked = k === cloud;
      const words = painted > 0 ? `${count(painted)} of ${count(points)} painted` : `${count(points)} points`;
      rows.children[k].querySelector(".count")!.textContent = words;
    });
  });
  return element;
}

const cloudRow = (file: string, look: () => void): HTMLElement =>
  h(
    "li",
    { class: "class" },
    h("label", {}, h("input", { type: "radio", name: "cloud", onchange: look }), h("span", { class: "name" }, file)),
    h("span", { class: "count" }),
  );
