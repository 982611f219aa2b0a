// Markdown as the repository's host shows it: tables, anchors by heading, formulas, and indented code.
import hljs from "highlight.js/lib/common";
import katex from "katex";
import MarkdownIt from "markdown-it";

const escape = (text) =>
  text.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;").replace(/"/g, "&quot;");

export function textOf(html) {
  const entities = { "&lt;": "<", "&gt;": ">", "&quot;": '"', "&#39;": "'", "&amp;": "&" };
  return html
    .replace(/<annotation.*?<\/annotation>|<button.*?<\/button>/gs, "")
    .replace(/<[^>]*>/g, " ")
    .replace(/&(lt|gt|quot|#39|amp);/g, (entity) => entities[entity])
    .replace(/\s+/g, " ")
    .trim();
}

/** The anchor of a heading: lower case, no punctuation, hyphens for spaces. */
export const slug = (text) =>
  text
    .toLowerCase()
    .replace(/[^\p{L}\p{N} _-]/gu, "")
    .replace(/ /g, "-");

// MathML alone: no fonts, no style sheet; all browsers of today show it.
const formula = (text, displayMode) =>
  katex.renderToString(text, { displayMode, output: "mathml", throwOnError: true });

function highlight(code, language) {
  if (language === "math") return formula(code, true);
  const known = { sh: "bash", text: "plaintext", "": "plaintext" }[language] ?? language;
  return hljs.getLanguage(known) ? hljs.highlight(code, { language: known }).value : escape(code);
}

/** Code without the indent that all its lines share. */
function dedent(code) {
  const indents = code
    .split("\n")
    .filter((line) => line.trim())
    .map((line) => /^ */.exec(line)[0].length);
  const least = Math.min(...(indents.length ? indents : [0]));
  return code
    .split("\n")
    .map((line) => line.slice(least))
    .join("\n");
}

/**
 * The page's HTML and headings. resolve(link) is the new address of a link, or null for none; picture(link) the
 * address and size of a PNG.
 */
export function markdown(source, resolve, picture) {
  const headings = [];
  const taken = new Map();
  const engine = new MarkdownIt({ html: true, linkify: false, typographer: false });
  const { rules } = engine.renderer;

  const fence = (tokens, i) => {
    const language = (tokens[i].info ?? "").trim().split(/\s+/)[0];
    const code = highlight(dedent(tokens[i].content), language);
    return language === "math" ? `<div class="formula">${code}</div>\n` : `<pre><code>${code}</code></pre>\n`;
  };
  rules.fence = fence;
  // Indented blocks of commands are shell; others are formulas, files and what programs say.
  rules.code_block = (tokens, i) => {
    const isShell = /^\s*(pcednet|build\/|scripts\/|cmake|ctest|npm|sudo|apt|git|python3?) /m.test(tokens[i].content);
    tokens[i].info = isShell ? "sh" : "";
    return fence(tokens, i);
  };
  rules.heading_open = (tokens, i) => {
    const text = tokens[i + 1].children
      .filter((child) => ["text", "code_inline"].includes(child.type))
      .map((child) => child.content)
      .join("");
    const plain = slug(text);
    const count = taken.get(plain) ?? 0;
    taken.set(plain, count + 1);
    const id = count ? `${plain}-${count}` : plain;
    headings.push({ level: Number(tokens[i].tag[1]), text, id });
    return `<${tokens[i].tag} id="${id}">`;
  };
  rules.table_open = () => '<div class="table"><table>\n';
  rules.table_close = () => "</table></div>\n";
  rules.image = (tokens, i, options, env, self) => {
    const { address, width, height } = picture(tokens[i].attrGet("src"));
    return `<a class="picture" href="${address}"><img src="${address}" width="${width}" height="${height}" alt="${escape(self.renderInlineAsText(tokens[i].children, options, env))}" loading="lazy"></a>`;
  };
  const open = [];
  rules.link_open = (tokens, i) => {
    const target = resolve(tokens[i].attrGet("href"));
    open.push(target !== null);
    return target === null ? "" : `<a href="${escape(target)}">`;
  };
  rules.link_close = () => (open.pop() ? "</a>" : "");
  // $`...`$ is a formula within a line.
  engine.inline.ruler.before("backticks", "formula", (state, silent) => {
    const found = /^\$`([^`]+)`\$/.exec(state.src.slice(state.pos));
    if (!found) return false;
    if (!silent) state.push("html_inline", "", 0).content = formula(found[1], false);
    state.pos += found[0].length;
    return true;
  });
  return { html: engine.render(source), headings };
}
