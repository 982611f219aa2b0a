import "../shared/theme.css";
import "../shared/controls.css";
import "./style.css";
import { h } from "../shared/dom";
import { experimentSection } from "./experiment";
import { gallery } from "./gallery";
import { shownOrder, type Report } from "./study";

function masthead(report: Report): HTMLElement {
  const { studies } = report;
  const usual = studies.length === 1 ? studies[0].title : "Edge detection in point clouds: a study";
  const facts = [
    report.date,
    [...new Set(studies.map((s) => s.version).filter(Boolean))].map((v) => `pcednet ${v}`).join(", "),
    [...new Set(studies.map((s) => s.machine).filter(Boolean))].join("; "),
  ].filter(Boolean);
  return h("header", { class: "masthead" }, h("h1", {}, report.title || usual), h("p", {}, facts.join(" · ")));
}

function show(report: Report): void {
  const page = document.getElementById("page")!;
  const clouds = gallery(report);
  const order = shownOrder(report.studies);
  const sections = order.map((i) => experimentSection(report.studies[i], i));
  if (report.title) document.title = report.title;
  const link = (section: HTMLElement, name: string): HTMLElement =>
    h("li", {}, h("a", { href: `#${section.id}` }, name));
  page.replaceChildren(
    h(
      "nav",
      { "aria-label": "Experiments" },
      h(
        "ul",
        {},
        clouds && link(clouds, "Clouds"),
        ...sections.map((section, i) => link(section, report.studies[order[i]].title)),
      ),
    ),
    h(
      "main",
      {},
      masthead(report),
      clouds,
      ...sections,
      h("footer", {}, "Made by pcednet report. The page contains all its data and loads nothing."),
    ),
  );
}

const data: unknown = JSON.parse(document.getElementById("data")!.textContent!);
if (data !== null && typeof data === "object" && (data as Report).schema === "pcednet-report-1") {
  show(data as Report);
} else {
  document.getElementById("page")!.textContent = "This page has no data: pcednet report fills it.";
}
