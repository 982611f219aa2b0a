// Modules of the annotator's page, for tests in node. Environment: PCEDNET_SOURCE_DIR the repository.
import { createRequire } from "node:module";
import path from "node:path";

const web = path.join(process.env.PCEDNET_SOURCE_DIR, "web");
const { build } = createRequire(path.join(web, "package.json"))("esbuild");

/** Those of the names, by name; they share what they import. */
export async function load(...names) {
  const { outputFiles } = await build({
    stdin: {
      resolveDir: path.join(web, "annotate"),
      contents: names.map((name) => `export * as ${name} from "./${name}";`).join(""),
    },
    bundle: true,
    write: false,
    format: "esm",
    platform: "node",
  });
  return import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].contents).toString("base64")}`);
}
