// Tables: the scores of an experiment on one set, and one score on all sets.

import { h } from "../shared/dom";
import {
  METRICS,
  METRIC_NAMES,
  cloudsOf,
  expectedOf,
  formatCount,
  formatScore,
  positiveName,
  scoreOf,
  titleOf,
  type Group,
  type Metric,
  type Scores,
  type Spread,
  type Statistic,
  type Study,
} from "./study";
import { gallery } from "./look";
import { swatch } from "./marks";

interface Column<Row> {
  name: string;
  title?: string;
  /** By what the column sorts; null goes last. */
  key: (row: Row) => number | string | null;
  cell: (row: Row) => HTMLTableCellElement;
  /** Whether large comes first. */
  descending?: boolean;
}

/** A table whose column heads sort it. `details` are further rows behind a row's first cell. */
function sortableTable<Row>(
  caption: string,
  columns: Column<Row>[],
  rows: Row[],
  after: (row: Row) => HTMLTableRowElement[] = () => [],
): HTMLTableElement {
  const body = h("tbody");
  const lines = new Map(
    rows.map((row) => [row, [h("tr", {}, ...columns.map((column) => column.cell(row))), ...after(row)]]),
  );
  const heads = columns.map((column) =>
    h(
      "th",
      { scope: "col", title: column.title },
      h("button", { type: "button", onclick: () => sortBy(column) }, column.name),
    ),
  );
  function sortBy(column: Column<Row>): void {
    const head = heads[columns.indexOf(column)];
    const first = column.descending ? "descending" : "ascending";
    const second = column.descending ? "ascending" : "descending";
    const direction = head.getAttribute("aria-sort") === first ? second : first;
    for (const other of heads) other.removeAttribute("aria-sort");
    head.setAttribute("aria-sort", direction);
    const sign = direction === "ascending" ? 1 : -1;
    const sorted = [...rows].sort((a, b) => {
      const [x, y] = [column.key(a), column.key(b)];
      if (x === null || y === null) return Number(x === null) - Number(y === null);
      return sign * (typeof x === "number" && typeof y === "number" ? x - y : String(x).localeCompare(String(y)));
    });
    body.append(...sorted.flatMap((row) => lines.get(row)!));
  }
  body.append(...rows.flatMap((row) => lines.get(row)!));
  return h("table", {}, h("caption", {}, caption), h("thead", {}, h("tr", {}, ...heads)), body);
}

const scroller = (table: HTMLTableElement): HTMLElement =>
  h("div", { class: "scroller", tabindex: 0, role: "region", "aria-label": table.caption?.textContent ?? "" }, table);

/** Whether any group has several seeds: then every cell keeps room for a deviation. */
const haveSpread = (groups: Group[]): boolean => groups.some((g) => g.results.length > 1);

function scoreCell(spread: Spread | null, best: boolean, room: boolean): HTMLTableCellElement {
  const deviation = spread && spread.deviation !== null ? `±${formatScore(spread.deviation)}` : "";
  const after = room && h("span", { class: "deviation" }, deviation);
  if (!spread) return h("td", { class: "number none" }, "–", after);
  return h(
    "td",
    { class: best ? "number best" : "number", "data-value": spread.mean },
    h("span", { class: "value" }, formatScore(spread.mean)),
    after,
  );
}

/** The largest mean among groups that are comparable: of the same positive class, on as many clouds. */
export function isBest(groups: Group[], group: Group, statistic: Statistic, metric: Metric): boolean {
  const clouds = (g: Group): number => Math.min(...g.results.map((r) => r.clouds.length));
  const mean = (g: Group): number => scoreOf(g, statistic, metric)?.mean ?? -Infinity;
  const same = groups.filter((g) => g.set === group.set && g.positive === group.positive && mean(g) > -Infinity);
  const most = Math.max(...same.map(clouds));
  const rivals = same.filter((g) => clouds(g) === most);
  if (rivals.length < 2 || !rivals.includes(group)) return false;
  return rivals.every((g) => mean(g) <= mean(group));
}

const plainCell = (text: string, room: boolean): HTMLTableCellElement =>
  h("td", { class: "number" }, text, room && h("span", { class: "deviation" }));

function cloudLines(group: Group, extra: number, room: boolean): HTMLTableRowElement[] {
  return cloudsOf(group).map((cloud) =>
    h(
      "tr",
      { class: "cloud", hidden: true },
      h(
        "th",
        { scope: "row" },
        !gallery.has(group.set, cloud.name)
          ? cloud.name
          : h(
              "button",
              {
                type: "button",
                class: "look",
                title: "show it in 3D",
                onclick: () => gallery.show(group.set, cloud.name, group.study, group.variant.id),
              },
              cloud.name,
            ),
      ),
      ...Array.from({ length: extra }, (_, i) =>
        h("td", { class: "number" }, i === extra - 1 ? `${formatCount(cloud.points)} pts` : ""),
      ),
      ...METRICS.map((m) => plainCell(formatScore(cloud[m]), room)),
    ),
  );
}

function publishedLine(
  scores: Partial<Scores>,
  source: string | undefined,
  extra: number,
  room: boolean,
): HTMLTableRowElement {
  return h(
    "tr",
    { class: "published", title: source },
    h("th", { scope: "row" }, "published"),
    ...Array.from({ length: extra }, () => h("td")),
    ...METRICS.map((m) => {
      const value = scores[m];
      return plainCell(value === undefined ? "" : formatScore(value), room);
    }),
  );
}

/** All scores of every variant on `set`; a row opens into its clouds. */
export function setTable(study: Study, groups: Group[], set: string, statistic: Statistic): HTMLElement {
  const scored = groups.filter((g) => g.set === set && g.results.some((r) => r[statistic]));
  const classes = [...new Set(scored.map((g) => g.positive))];
  const rows = classes.flatMap((positive) => scored.filter((g) => g.positive === positive)); // rivals together
  const mixed = new Set(rows.map((g) => g.positive)).size > 1;
  const counted = rows.some((g) => typeof g.variant.parameters === "number");
  const room = haveSpread(rows);
  const extra = Number(mixed) + Number(counted);
  const after = new Map<Group, HTMLTableRowElement[]>();
  rows.forEach((group) => {
    const published = expectedOf(study, group);
    const scores = published?.published[statistic];
    after.set(group, [
      ...(scores ? [publishedLine(scores, published.source, extra, room)] : []),
      ...cloudLines(group, extra, room),
    ]);
  });
  const columns: Column<Group>[] = [
    {
      name: "Method",
      key: (g) => titleOf(g.variant),
      cell: (g) => {
        const clouds = after.get(g)!.filter((row) => row.className === "cloud");
        const toggle = h(
          "button",
          {
            type: "button",
            class: "open",
            "aria-expanded": "false",
            title: g.variant.note,
            onclick: () => {
              const open = toggle.getAttribute("aria-expanded") === "false";
              toggle.setAttribute("aria-expanded", String(open));
              for (const row of clouds) row.hidden = !open;
            },
          },
          h("span", { class: "named" }, swatch(g.index), titleOf(g.variant)),
        );
        return h("th", { scope: "row" }, toggle);
      },
    },
  ];
  if (mixed) {
    columns.push({
      name: "Positive class",
      key: (g) => g.positive,
      cell: (g) => h("td", { class: "words" }, positiveName(g.positive)),
    });
  }
  if (counted) {
    columns.push({
      name: "Weights",
      key: (g) => g.variant.parameters ?? null,
      cell: (g) =>
        h(
          "td",
          { class: "number quiet" },
          typeof g.variant.parameters === "number" ? formatCount(g.variant.parameters) : "–",
        ),
    });
  }
  for (const metric of METRICS) {
    columns.push({
      name: METRIC_NAMES[metric],
      descending: true,
      key: (g) => scoreOf(g, statistic, metric)?.mean ?? null,
      cell: (g) => scoreCell(scoreOf(g, statistic, metric), isBest(rows, g, statistic, metric), room),
    });
  }
  return scroller(sortableTable(`${study.title}: ${set}, ${statistic}`, columns, rows, (g) => after.get(g)!));
}

/** One score of every variant on every set. */
export function overviewTable(study: Study, groups: Group[], statistic: Statistic, metric: Metric): HTMLElement {
  interface Row {
    group: Group;
    label: string;
    bySet: Map<string, Group>;
  }
  const rows: Row[] = [];
  for (const variant of study.variants) {
    const own = groups.filter((g) => g.variant === variant);
    const split = study.sets.some((s) => own.filter((g) => g.set === s.name).length > 1);
    for (const positive of split ? [...new Set(own.map((g) => g.positive))] : [null]) {
      const members = own.filter((g) => positive === null || g.positive === positive);
      if (members.length === 0) continue;
      const label = titleOf(variant) + (positive === null ? "" : `, ${positiveName(positive)}`);
      rows.push({ group: members[0], label, bySet: new Map(members.map((g) => [g.set, g])) });
    }
  }
  const classes = [...new Set(rows.map((row) => row.group.positive))];
  rows.sort((a, b) => classes.indexOf(a.group.positive) - classes.indexOf(b.group.positive)); // rivals together
  const room = haveSpread(groups);
  const columns: Column<Row>[] = [
    {
      name: "Method",
      key: (row) => row.label,
      cell: (row) => h("th", { scope: "row" }, h("span", { class: "named" }, swatch(row.group.index), row.label)),
    },
  ];
  for (const set of study.sets) {
    if (!groups.some((g) => g.set === set.name)) continue;
    columns.push({
      name: set.name,
      descending: true,
      title: `${set.clouds.length} clouds; positive class: ${positiveName(set.positive ?? "sharp")}`,
      key: (row) => {
        const group = row.bySet.get(set.name);
        return group ? (scoreOf(group, statistic, metric)?.mean ?? null) : null;
      },
      cell: (row) => {
        const group = row.bySet.get(set.name);
        if (!group) return scoreCell(null, false, room);
        const best = isBest(groups, group, statistic, metric);
        const cell = scoreCell(scoreOf(group, statistic, metric), best, room);
        const published = expectedOf(study, group)?.published[statistic]?.[metric];
        if (published !== undefined) {
          const source = `published: ${expectedOf(study, group)?.source ?? ""}`;
          cell.prepend(h("span", { class: "beside", title: source }, `(${formatScore(published)})`));
        }
        return cell;
      },
    });
  }
  return scroller(sortableTable(`${study.title}: ${METRIC_NAMES[metric]} on every set`, columns, rows));
}

/** A plain table of texts. */
export function plainTable(caption: string, heads: string[], rows: string[][]): HTMLElement {
  return scroller(
    h(
      "table",
      {},
      h("caption", {}, caption),
      h("thead", {}, h("tr", {}, ...heads.map((name) => h("th", { scope: "col" }, name)))),
      h(
        "tbody",
        {},
        ...rows.map(([name, ...cells]) =>
          h("tr", {}, h("th", { scope: "row" }, name), ...cells.map((cell) => h("td", { class: "number" }, cell))),
        ),
      ),
    ),
  );
}
