// The same E57 files read by web-e57 (the Rust crate e57) and by us: the same coordinates and colours.
// node --experimental-wasm-modules e57_test.mjs PCEDNET E57_SAMPLE [FILE...]
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const [pcednet, sample, ...files] = process.argv.slice(2);
if (!existsSync(new URL("node_modules/web-e57", import.meta.url))) {
  console.log("skipped: web-e57 is not installed; npm ci in tests/clients");
  process.exit(77);
}
const { convertE57 } = await import("web-e57");
const folder = mkdtempSync(join(tmpdir(), "pcednet-e57-"));

// Rows of x y z red green blue; ours name their columns in the last comment.
const rows = (text) => {
  const lines = text.split("\n").filter((line) => line.trim());
  const names = lines.filter((line) => line.startsWith("# x y z")).at(-1)?.slice(2).split(" ");
  const columns = ["x", "y", "z", "red", "green", "blue"].map((name, i) => (names ? names.indexOf(name) : i));
  return lines
    .filter((line) => !line.startsWith("#"))
    .map((line) => line.trim().split(/\s+/).map(Number))
    .map((row) => columns.map((c) => row[c]));
};

try {
  const made = join(folder, "sample.e57");
  writeFileSync(made, execFileSync(sample));
  for (const file of [made, ...files]) {
    const theirs = rows(convertE57(new Uint8Array(readFileSync(file)), "XYZ"));
    const out = join(folder, "ours.xyz");
    execFileSync(pcednet, ["convert", file, "-o", out, "--overwrite"], { stdio: "ignore" });
    const ours = rows(readFileSync(out, "utf8"));
    if (ours.length === 0 || ours.length !== theirs.length) {
      throw new Error(`${file}: ${ours.length} points, not ${theirs.length}`);
    }
    ours.forEach((row, i) =>
      row.forEach((value, c) => {
        // Ours are written as short as a float needs where the file holds floats.
        // They round scaled colours down, we to the nearest.
        const allowed = c < 3 ? 1e-7 * Math.max(1, Math.abs(value)) : 1;
        if (!(Math.abs(value - theirs[i][c]) <= allowed)) {
          throw new Error(`${file}: point ${i}, column ${c}: ${value}, not ${theirs[i][c]}`);
        }
      }),
    );
    console.log(`ok ${file}: ${ours.length} points`);
  }
} finally {
  rmSync(folder, { recursive: true });
}
