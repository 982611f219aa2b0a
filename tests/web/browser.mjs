// Headless Chromium with WebGL in software. Environment: PCEDNET_SOURCE_DIR, whose web/ folder holds
// playwright-core, and CHROMIUM, the browser.
import { spawn } from "node:child_process";
import { once } from "node:events";
import { createRequire } from "node:module";
import net from "node:net";
import path from "node:path";

const require = createRequire(path.join(process.env.PCEDNET_SOURCE_DIR, "web/package.json"));

export function launch() {
  return require("playwright-core").chromium.launch({
    executablePath: process.env.CHROMIUM,
    args: [
      "--no-sandbox",
      "--disable-dev-shm-usage",
      "--use-angle=swiftshader",
      "--enable-unsafe-swiftshader",
      "--disable-gpu-compositing", // WebGL alone is drawn by the slow imitation of a graphics card, not the page too
    ],
  });
}

/** A free port that the system gives to nobody by itself, so that it is still free when a program starts again. */
export async function lastingPort() {
  for (;;) {
    const port = 20_000 + Math.floor(12_000 * Math.random());
    const server = net.createServer();
    const free = once(server, "listening").then(
      () => true,
      () => false,
    );
    server.listen(port, "127.0.0.1");
    if (!(await free)) continue;
    server.close();
    await once(server, "close");
    return port;
  }
}

/**
 * Starts `pcednet annotate` with these words; its process, and the address and port that it prints. Without an
 * environment for it, it opens no browser.
 */
export function serve(words, environment) {
  return new Promise((done, fail) => {
    const program = spawn(process.env.PCEDNET, ["annotate", ...words, ...(environment ? [] : ["--no-browser"])], {
      env: { ...process.env, ...environment },
    });
    let text = "",
      errors = "";
    program.stdout.on("data", (data) => {
      text += data;
      const address = /http:\/\/127\.0\.0\.1:(\d+)\/\?token=\S+/.exec(text);
      if (address) done({ program, address: address[0], port: address[1] });
    });
    program.stderr.on("data", (data) => (errors += data));
    program.on("exit", (code) => fail(new Error(`pcednet annotate ended with ${code}: ${errors}`)));
  });
}
