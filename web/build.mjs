// Bundles pages into one file each, which needs nothing else:
// `node build.mjs report` makes dist/report.html of report/index.html, main.ts and what they import.
import { createHash } from "node:crypto";
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { build } from "esbuild";

/** A policy under which a page runs its own script and style and speaks to its own server alone. */
function policy(script, style) {
  const hash = (text) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`;
  return (
    `<meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src ${hash(script)}; ` +
    `style-src ${hash(style)}; img-src data: blob:; connect-src 'self'; base-uri 'none'; form-action 'none'" />`
  );
}

for (const page of process.argv.slice(2)) {
  const { outputFiles } = await build({
    entryPoints: [`${page}/main.ts`],
    outdir: "dist",
    bundle: true,
    minify: true,
    write: false,
    format: "esm",
    target: "es2020",
    legalComments: "inline", // the licences of what is bundled
    charset: "utf8",
  });
  const text = (extension) => outputFiles.find((file) => file.path.endsWith(extension)).text;
  // Text that would end the script element, or begin a comment in it, is written another way.
  const script = text(".js").replace(/<(?=\/script|!--)/gi, "\\x3c");
  const html = (await readFile(`${page}/index.html`, "utf8"))
    .replace("<!-- POLICY -->", () => policy(script, text(".css")))
    .replace("<!-- STYLE -->", () => `<style>${text(".css")}</style>`)
    .replace("<!-- SCRIPT -->", () => `<script type="module">${script}</script>`);
  await mkdir("dist", { recursive: true });
  await writeFile(`dist/${page}.html`, html);
  console.log(`dist/${page}.html ${Math.round(html.length / 1000)} kB`);
}
