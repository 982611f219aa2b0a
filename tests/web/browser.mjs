// Headless Chromium with WebGL in software. Environment: PCEDNET_SOURCE_DIR, whose web/ folder holds
// playwright-core, and CHROMIUM, the browser.
import { createRequire } from "node:module";
import path from "node:path";

const require = createRequire(path.join(process.env.PCEDNET_SOURCE_DIR, "web/package.json"));

export function launch() {
  return require("playwright-core").chromium.launch({
    executablePath: process.env.CHROMIUM,
    args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
}
