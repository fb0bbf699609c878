// Bundles the viewer and the report into one HTML page each, whose content policy allows its own script and style alone, and
// writes both as a C++ source. With the package of library/js, writes the two pages that hold the engine instead: the page that takes a
// file (check), or the viewer of `cscd view --with-engine` (again).
//
//   node build.mjs FOLDER-WITH-node_modules OUT.cpp
//   node build.mjs FOLDER-WITH-node_modules OUT.html PACKAGE check|again
import { createHash } from "node:crypto";
import { createRequire } from "node:module";
import { readFileSync, writeFileSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { deflateSync } from "node:zlib";

const here = dirname(fileURLToPath(import.meta.url));
const [packages, out, library, kind] = process.argv.slice(2);
const { build } = createRequire(join(packages, "package.json"))("esbuild");

async function bundle(entry) {
  const made = await build({
    entryPoints: [join(here, "src", entry)],
    bundle: true,
    minify: true,
    write: false,
    format: "iife",
    target: ["chrome110", "firefox115", "safari16.4"],
    nodePaths: [join(packages, "node_modules")],
    legalComments: "none",
    // Of the library in the worker, which gets its engine from the page.
    alias: library ? { cscd: join(resolve(library), "cscd.js") } : {},
    external: ["node:*"],
    define: { "import.meta.url": "undefined" },
  });
  return made.outputFiles[0].text.trim();
}

const digest = (text) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`;

const version = (name) => JSON.parse(readFileSync(join(packages, "node_modules", name, "package.json"), "utf8"));
const licence = (name) => `${name} ${version(name).version} (${version(name).license} licence)`;

// `allowed` says what the page may do beside running its own script; `held` what it holds in places of its own; `command` which command
// makes such pages.
async function pageOf(name, entry, licensed, { scripts = "", allowed = "", held = {}, command = name } = {}) {
  const script = (await bundle(entry)).replaceAll("</script", "<\\/script").replaceAll("<!--", "<\\!--");
  const style = await bundle(`${name}.css`);
  const policy = `default-src 'none'; script-src ${digest(script)}${scripts}; style-src ${digest(style)}; ${allowed}base-uri 'none'; form-action 'none'`;
  const part = (file) => readFileSync(join(here, "src", file), "utf8");
  const whole = Object.entries(held).reduce((text, [place, value]) => text.replace(`{{${place}}}`, () => value), part(`${name}.html`));
  return whole
    .replace("{{head}}", () => part("head.html").trim())
    .replaceAll("{{name}}", () => command)
    .replace("{{policy}}", () => policy)
    .replace("{{licences}}", () => licence(licensed))
    .replace("{{style}}", () => style)
    .replace("{{script}}", () => script);
}

// A literal of C++ holds what its delimiter is not part of; compilers limit the length of one literal, not of several in a row.
function literal(page) {
  const pieces = [];
  for (let i = 0; i < page.length; i += 8000) pieces.push(`R"page(${page.slice(i, i + 8000)})page"`);
  return pieces.join("\n");
}

const functionOf = (name, page) => `std::string_view ${name}() {
  static constexpr char kPage[] =
${literal(page)};
  return {kPage, sizeof kPage - 1};
}
`;

const packed = (bytes) => deflateSync(bytes, { level: 9 }).toString("base64");

// A page with an engine holds the viewer's elements, the engine, and the script of the worker that asks it.
async function pageWithEngine(name, command) {
  const view = /<header>.*<\/footer>/s.exec(readFileSync(join(here, "src/view.html"), "utf8"))[0];
  const { version } = JSON.parse(readFileSync(join(library, "package.json"), "utf8"));
  const held = { view, version, engine: packed(readFileSync(join(library, "cscd.wasm"))), worker: packed(await bundle(`${name}/worker.js`)) };
  return pageOf(name, `${name}.js`, "three", { command, scripts: " 'wasm-unsafe-eval'", allowed: "worker-src blob:; ", held });
}

if (library) {
  writeFileSync(out, await pageWithEngine(kind, kind === "again" ? "view" : kind));
} else {
  writeFileSync(
    out,
    `// Made by page/build.mjs.
// The standard asks compilers for literals of 65536 characters; those in use take longer ones.
#pragma GCC diagnostic ignored "-Woverlength-strings"

#include "bench/query/view/viewer_page.h"
namespace cscd::bench {
${functionOf("viewer_page", await pageOf("view", "main.js", "three"))}
${functionOf("report_page", await pageOf("report", "report.js", "uplot", { allowed: "frame-src 'self'; " }))}
}  // namespace cscd::bench
`,
  );
}
