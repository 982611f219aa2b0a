// Bundles pages into one file each, which opens from file:// without a server:
// `node build.mjs report` makes dist/report.html of report/index.html, main.ts and what they import.
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { build } from "esbuild";

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
    .replace("<!-- STYLE -->", () => `<style>${text(".css")}</style>`)
    .replace("<!-- SCRIPT -->", () => `<script type="module">${script}</script>`);
  await mkdir("dist", { recursive: true });
  await writeFile(`dist/${page}.html`, html);
  console.log(`dist/${page}.html ${Math.round(html.length / 1000)} kB`);
}
