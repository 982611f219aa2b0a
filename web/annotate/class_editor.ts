// The dialogue in which the classes are chosen.

import { h } from "../shared/dom";
import { EDGE_CLASSES, freshColour, hexOf, MOST_CLASSES, ownClasses, repeatedName, wantedTable } from "./classes";
import type { Draft, WantedClass } from "./classes";
import { count } from "./format";
import { button } from "./panel";
import type { State } from "./store";

const LONGEST_NAME = 40;

/** Opens the dialogue; `save` throws what the program says against a choice. */
export function editClassesDialog(state: State, save: (table: WantedClass[]) => Promise<void>): void {
  const isPainted = state.undo > 0 || state.redo > 0 || state.counts.some((n) => n > 0);
  const rows = h("ul", { class: "drafts" });
  const drafts: { draft: Draft; element: HTMLElement }[] = [];
  const problem = h("p", { class: "problem", role: "alert" });
  const note = h("p", { class: "summary" });

  const addRow = (draft: Draft, painted = 0): HTMLInputElement => {
    const colour = h("input", {
      type: "color",
      value: draft.colour,
      "aria-label": `Colour of ${draft.name || "the new class"}`,
      oninput: () => (draft.colour = colour.value),
    });
    const name = h("input", {
      type: "text",
      value: draft.name,
      maxlength: LONGEST_NAME,
      required: true,
      placeholder: "name",
      "aria-label": "Name of the class",
      oninput: () => (draft.name = name.value),
    });
    const remove = button("Remove", () => {
      drafts.splice(
        drafts.findIndex((one) => one.draft === draft),
        1,
      );
      element.remove();
      follow();
      add.focus();
    });
    remove.disabled = painted > 0;
    if (painted > 0) remove.title = "Erase its points first";
    const element = h(
      "li",
      {},
      colour,
      name,
      h("span", { class: "count" }, painted > 0 ? `${count(painted)} painted` : ""),
      remove,
    );
    drafts.push({ draft, element });
    rows.append(element);
    return name;
  };
  const addNew = (): void => {
    const name = addRow({ id: null, name: "", colour: freshColour(drafts.map((one) => one.draft.colour)) });
    follow();
    name.focus();
  };
  const add = button("Add a class", addNew);
  const edges = h("input", { type: "checkbox", checked: state.edges, disabled: isPainted, onchange: () => follow() });
  const follow = (): void => {
    problem.textContent = "";
    if (!edges.checked) while (drafts.length < 2) addNew();
    add.disabled = drafts.length + (edges.checked ? EDGE_CLASSES : 0) >= MOST_CLASSES;
    note.textContent = !edges.checked
      ? "Own classes alone are learnt from your strokes, from nothing. Boundary and lines are of edge classes: there are none then."
      : drafts.length > 0
        ? "The model keeps what it knows of edges and learns the further classes from your strokes."
        : "The classes of every shipped model.";
    if (isPainted) note.textContent += " After the first stroke edges can no longer be left out or taken in.";
  };
  const dialog = h(
    "dialog",
    { class: "question class-editor", "aria-labelledby": "class-editor-title" },
    h(
      "form",
      {
        method: "dialog",
        onsubmit: (event: SubmitEvent) => {
          event.preventDefault();
          const twice = repeatedName(
            drafts.map((one) => one.draft),
            edges.checked,
          );
          if (twice) return void (problem.textContent = `There are two classes "${twice}".`);
          const table = wantedTable(
            state,
            drafts.map((one) => one.draft),
            edges.checked,
            isPainted,
          );
          save(table).then(
            () => dialog.close(),
            (error: Error) => (problem.textContent = sentence(error.message)),
          );
        },
      },
      h("h2", { id: "class-editor-title" }, "Classes"),
      h("label", { class: "check" }, edges, h("span", {}, "Edges: non-edge, smooth edge, sharp edge, boundary")),
      rows,
      h("div", { class: "adding" }, add),
      note,
      problem,
      h(
        "div",
        { class: "buttons" },
        button("Cancel", () => dialog.close()),
        h("button", { class: "plain strong" }, "Use these classes"),
      ),
    ),
  );
  for (const { id, name, colour } of ownClasses(state)) {
    addRow({ id, name, colour: hexOf(colour) }, state.counts[id]);
  }
  follow();
  dialog.addEventListener("close", () => dialog.remove());
  document.body.append(dialog);
  dialog.showModal();
}

/** What the program says, for people: `classes: a name has ...` is about what they look at. */
function sentence(message: string): string {
  const words = message.replace(/^classes: /, "");
  return `${words.charAt(0).toUpperCase()}${words.slice(1)}.`;
}
