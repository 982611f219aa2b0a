import { defineConfig, type Plugin } from "vite";

// Puts scripts and styles into the page itself, which then opens from file:// without a server.
// The mode names the page: `vite build --mode report` makes dist/report.html of report/index.html.
function onePage(name: string): Plugin {
  return {
    name: "one-page",
    enforce: "post",
    generateBundle(_, bundle) {
      const files = Object.values(bundle);
      const page = files.find((file) => file.fileName.endsWith(".html"));
      if (page?.type !== "asset") throw new Error("no page");
      let html = String(page.source);
      for (const file of files) {
        if (file === page) continue;
        const link = new RegExp(`<(script|link)[^>]*${file.fileName}[^>]*>(</script>)?`);
        if (!link.test(html)) throw new Error(`the page does not load ${file.fileName}`);
        const inlined =
          file.type === "chunk"
            ? `<script type="module">${file.code.replace(/<(?=\/script|!--)/gi, "\\x3c")}</script>`
            : `<style>${String(file.source)}</style>`;
        html = html.replace(link, () => inlined);
        delete bundle[file.fileName];
      }
      page.source = html;
      page.fileName = `${name}.html`;
    },
  };
}

export default defineConfig(({ mode }) => ({
  root: mode,
  base: "./",
  plugins: [onePage(mode)],
  build: {
    outDir: "../dist",
    emptyOutDir: false,
    target: "es2020",
    modulePreload: { polyfill: false },
    cssCodeSplit: false,
    assetsInlineLimit: 1e9,
    chunkSizeWarningLimit: 2000,
    reportCompressedSize: false,
  },
}));
