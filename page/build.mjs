// Bundles the viewer and the report into one HTML page each, whose content policy allows its own script and style alone, and
// writes both as a C++ source.
//
//   node build.mjs FOLDER-WITH-node_modules OUT.cpp
import { createHash } from "node:crypto";
import { createRequire } from "node:module";
import { readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const [packages, out] = process.argv.slice(2);
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
  });
  return made.outputFiles[0].text.trim();
}

const digest = (text) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`;

const version = (name) => JSON.parse(readFileSync(join(packages, "node_modules", name, "package.json"), "utf8"));
const licence = (name) => `${name} ${version(name).version} (${version(name).license} licence)`;

// `frames` says which pages the page may show in frames; nothing otherwise.
async function pageOf(name, entry, library, frames = "") {
  const script = (await bundle(entry)).replaceAll("</script", "<\\/script").replaceAll("<!--", "<\\!--");
  const style = await bundle(`${name}.css`);
  const policy = `default-src 'none'; script-src ${digest(script)}; style-src ${digest(style)}; ${frames}base-uri 'none'; form-action 'none'`;
  const part = (file) => readFileSync(join(here, "src", file), "utf8");
  return part(`${name}.html`)
    .replace("{{head}}", () => part("head.html").trim())
    .replaceAll("{{name}}", () => name)
    .replace("{{policy}}", () => policy)
    .replace("{{licences}}", () => licence(library))
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

writeFileSync(
  out,
  `// Made by page/build.mjs.
// The standard asks compilers for literals of 65536 characters; those in use take longer ones.
#pragma GCC diagnostic ignored "-Woverlength-strings"

#include "bench/query/view/viewer_page.h"
namespace cscd::bench {
${functionOf("viewer_page", await pageOf("view", "main.js", "three"))}
${functionOf("report_page", await pageOf("report", "report.js", "uplot", "frame-src 'self'; "))}
}  // namespace cscd::bench
`,
);
