// The menu of what can be downloaded.

import { h } from "../shared/dom";
import type { Client } from "./client";
import type { Saved } from "./files";
import type { AppStore } from "./store";

export function downloadMenu(store: AppStore, client: Client): HTMLElement {
  const entry = (what: Saved): HTMLAnchorElement =>
    h(
      "a",
      {
        onclick: (event: Event) => {
          (event.currentTarget as HTMLAnchorElement).href = client.files.downloadAddress(what); // it holds the token
          menu.open = false;
        },
        download: "",
      },
      what,
    );
  const links = (["project", "model", "cloud"] as Saved[]).map((what) => ({ what, link: entry(what) }));
  const menu = h(
    "details",
    { class: "more" },
    h("summary", {}, "Download"),
    h("div", {}, ...links.map(({ link }) => link)),
  );
  closesByItself(menu);
  store.watch(["connected", "progress", "hasPrediction"], () => {
    const { connected, progress, hasPrediction } = store.now;
    for (const { what, link } of links) {
      const off = !connected || progress !== null || (what === "model" && !hasPrediction);
      if (off) link.removeAttribute("href");
      else link.href = "#";
      link.setAttribute("aria-disabled", String(off));
    }
  });
  return menu;
}

/** A click elsewhere, which does nothing else, and Escape close it. */
function closesByItself(menu: HTMLDetailsElement): void {
  addEventListener(
    "pointerdown",
    (event) => {
      if (!menu.open || menu.contains(event.target as Node)) return;
      event.preventDefault();
      event.stopPropagation();
      menu.open = false;
    },
    { capture: true },
  );
  addEventListener(
    "keydown",
    (event) => {
      if (!menu.open || event.key !== "Escape") return;
      event.stopPropagation();
      menu.open = false;
      menu.querySelector("summary")!.focus();
    },
    { capture: true },
  );
}
