// Bundles the viewer into one HTML page whose content policy allows its own script and style alone, and writes the page as
// a C++ source.
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

async function bundle(entry, loader) {
  const made = await build({
    entryPoints: [join(here, "src", entry)],
    bundle: true,
    minify: true,
    write: false,
    format: "iife",
    target: ["chrome110", "firefox115", "safari16.4"],
    nodePaths: [join(packages, "node_modules")],
    legalComments: "none",
    loader,
  });
  return made.outputFiles[0].text.trim();
}

const digest = (text) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`;

const script = (await bundle("main.js")).replaceAll("</script", "<\\/script").replaceAll("<!--", "<\\!--");
const style = await bundle("view.css");
const policy = `default-src 'none'; script-src ${digest(script)}; style-src ${digest(style)}; base-uri 'none'; form-action 'none'`;
const licence = JSON.parse(readFileSync(join(packages, "node_modules", "three", "package.json"), "utf8"));
const page = readFileSync(join(here, "src", "view.html"), "utf8")
  .replace("{{policy}}", () => policy)
  .replace("{{licences}}", () => `three.js ${licence.version}, ${licence.license} licence, three.js authors`)
  .replace("{{style}}", () => style)
  .replace("{{script}}", () => script);

// A literal of C++ holds what its delimiter is not part of; compilers limit the length of one literal, not of several in a row.
const pieces = [];
for (let i = 0; i < page.length; i += 8000) pieces.push(`R"page(${page.slice(i, i + 8000)})page"`);
writeFileSync(
  out,
  `// Made by page/build.mjs.
#include "bench/view/viewer_page.h"
namespace cscd::bench {
std::string_view viewer_page() {
  static constexpr char kPage[] =
${pieces.join("\n")};
  return {kPage, sizeof kPage - 1};
}
}  // namespace cscd::bench
`,
);
