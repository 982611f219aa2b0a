// Makes the pages of the documentation: node build.mjs OUT COMMANDS.json
//
// Pages and menu are what docs/README.md lists; README.md is the first page. Links to other files of
// the repository become pages with their text. Nothing is loaded from elsewhere, and all of it works
// from disk, the search included. A link or anchor that leads nowhere is an error.
import fs from "node:fs";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { commandPage, cppPage } from "./reference.mjs";
import { markdown, textOf } from "./markdown.mjs";
import { layout } from "./layout.mjs";

const here = path.dirname(fileURLToPath(import.meta.url));
const root = path.resolve(here, "../..");
const [out, commandsFile] = process.argv.slice(2);
const read = (file) => fs.readFileSync(path.join(root, file), "utf8");
const errors = [];

/** docs/annotate.md is annotate.html; README.md index.html, docs/README.md contents.html, bench/README.md bench.html. */
function addressOf(file) {
  const { dir, name } = path.parse(file);
  if (name !== "README") return name.toLowerCase() + ".html";
  return dir === "" ? "index.html" : dir === "docs" ? "contents.html" : path.basename(dir) + ".html";
}

/** The sections of the table in docs/README.md: [{title, links: [{file, title}]}]. */
function readMenu() {
  const menu = [{ title: "Begin", links: [] }];
  for (const line of read("docs/README.md").split("\n")) {
    const section = /^\| \*\*(.*?)\*\* \|/.exec(line);
    if (section) menu.push({ title: section[1], links: [] });
    const cell = /^\| (.*?) \|/.exec(line)?.[1] ?? "";
    for (const [, target] of cell.matchAll(/\]\((.*?\.md)\)/g)) {
      menu.at(-1).links.push({ file: path.normalize(path.join("docs", target)) });
    }
  }
  const afterUse = menu.findIndex((section) => section.title === "Use") + 1;
  menu.splice(afterUse, 0, { title: "Reference", links: Object.keys(made).map((file) => ({ file })) });
  return menu;
}

const made = {
  "docs/commands.html": () => commandPage(JSON.parse(fs.readFileSync(commandsFile, "utf8"))),
  "docs/cpp.html": () => cppPage(root),
};
const menu = readMenu();
const files = ["docs/README.md", ...menu.flatMap((section) => section.links.map((link) => link.file))];
const pages = new Map(); // by file: {address, title, html, headings}
for (const file of files) {
  const source = file.endsWith(".md") ? read(file) : made[file]();
  pages.set(file, { file, address: file.endsWith(".md") ? addressOf(file) : path.basename(file), source });
}

const copied = new Set(); // images
const sources = new Set(); // files of the repository that become pages
const anchors = new Map(); // page address -> ids
const wanted = []; // links to check: {from, address, anchor}

/** Where a link of `file` leads on the site. */
function resolve(file, link) {
  if (/^[a-z]+:/.test(link)) return link;
  const [target, anchor] = link.split("#");
  const found = target === "" ? file : path.normalize(path.join(path.dirname(file), target));
  if (pages.has(found)) {
    const address = pages.get(found).address;
    if (anchor) wanted.push({ from: file, address, anchor });
    return address + (anchor ? "#" + anchor : "");
  }
  const place = path.join(root, found);
  if (!fs.existsSync(place)) errors.push(`${file}: ${link} is not there`);
  else if (/\.(png|svg|jpg)$/.test(found)) {
    copied.add(found);
    return "images/" + path.basename(found);
  } else if (found.endsWith(".md")) errors.push(`${file}: ${link} is not in the table of docs/README.md`);
  else if (fs.statSync(place).isFile()) {
    sources.add(found);
    return "source/" + found.replaceAll("/", "-") + ".html";
  }
  return null; // a folder: its name, without a link
}

/** The address of a picture of `file`, and its size, so that the page does not move when it comes. */
function picture(file, link) {
  const address = resolve(file, link);
  const place = path.join(root, path.dirname(file), link);
  const head = fs.existsSync(place) ? fs.readFileSync(place).subarray(16, 24) : Buffer.alloc(8);
  return { address, width: head.readUInt32BE(0), height: head.readUInt32BE(4) };
}

const search = [];
for (const page of pages.values()) {
  const { html, headings } = markdown(
    page.source,
    (link) => resolve(page.file, link),
    (link) => picture(page.file, link),
  );
  Object.assign(page, { html, headings, title: headings[0]?.text ?? page.address });
  anchors.set(page.address, new Set(headings.map((heading) => heading.id)));
  for (const part of html.split(/(?=<h[1-4] id=)/)) {
    const head = /^<h[1-4] id="(.*?)">(.*?)<\/h/s.exec(part);
    const text = textOf(part.replace(/^<h.*?<\/h\d>/s, ""));
    search.push({
      page: page.title,
      url: page.address + (head ? "#" + head[1] : ""),
      title: head ? textOf(head[2]) : page.title,
      text,
    });
  }
}
for (const link of wanted) {
  if (!anchors.get(link.address).has(link.anchor))
    errors.push(`${link.from}: no heading #${link.anchor} in ${link.address}`);
}

for (const section of menu) {
  for (const link of section.links)
    Object.assign(link, { address: pages.get(link.file).address, title: pages.get(link.file).title });
}
fs.rmSync(out, { recursive: true, force: true });
for (const folder of ["images", "source", "assets"]) fs.mkdirSync(path.join(out, folder), { recursive: true });
const write = (name, text) => fs.writeFileSync(path.join(out, name), text);
/** Writes a page. An id that is there twice, as of a heading and of the frame, leads to the wrong place. */
function writePage(name, html) {
  const ids = [...html.matchAll(/<[^>]* id="([^"]*)"/g)].map(([, id]) => id);
  for (const id of new Set(ids.filter((id, i) => ids.indexOf(id) < i)))
    errors.push(`${name}: the id ${id} is there twice`);
  write(name, html);
}
for (const page of pages.values()) writePage(page.address, layout({ menu, ...page, base: "" }));
for (const file of sources) {
  const language =
    { ".cpp": "cpp", ".h": "cpp", ".py": "python", ".sh": "sh", ".sbatch": "sh" }[path.extname(file)] ?? "text";
  const fence = "`````";
  const { html } = markdown(`# ${file}\n\n${fence}${language}\n${read(file)}\n${fence}\n`, () => null);
  writePage(
    `source/${file.replaceAll("/", "-")}.html`,
    layout({ menu, html, headings: [], title: file, address: "", base: "../" }),
  );
}
for (const file of copied) fs.copyFileSync(path.join(root, file), path.join(out, "images", path.basename(file)));
for (const file of ["style.css", "page.js"]) fs.copyFileSync(path.join(here, file), path.join(out, "assets", file));
fs.copyFileSync(path.join(root, "packaging/pcednet.svg"), path.join(out, "assets/pcednet.svg"));
fs.copyFileSync(path.join(here, "node_modules/minisearch/dist/umd/index.js"), path.join(out, "assets/minisearch.js"));
write("assets/search.js", `window.pcednetPages = ${JSON.stringify(search)};\n`);

for (const error of errors) console.error(`build.mjs: ${error}`);
if (errors.length) process.exit(1);
console.log(`${pages.size} pages, ${sources.size} sources, ${copied.size} pictures in ${out}`);
