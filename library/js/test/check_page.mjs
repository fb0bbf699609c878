// Opens a page in headless Chromium that runs the example of the package's README. Exit status: 0 the page prints what the
// example prints in Node, 1 it does not (one line says what), 77 there is no Chromium.
//
//   node check_page.mjs FOLDER-WITH-node_modules PACKAGE
import { readFileSync } from "node:fs";
import { createServer } from "node:http";
import { join } from "node:path";
import { openBrowser, require } from "../../../page/test/browser.mjs";

const [packages, folder] = process.argv.slice(2);
const example = /```js\n(.*?)```/s.exec(readFileSync(join(folder, "README.md"), "utf8"))[1];
const types = { js: "text/javascript", wasm: "application/wasm" };
const page = `<!doctype html><link rel="icon" href="data:,"><script type="importmap">{"imports": {"cscd": "/cscd.js"}}</script>
<script>window.printed = []; console.log = (...values) => window.printed.push(values.map(String).join(" "));</script>
<script type="module">${example}</script>`;
const server = createServer((request, response) => {
  const name = request.url.slice(1), type = types[name.split(".").pop()];
  response.setHeader("content-type", type ?? "text/html");
  response.end(type ? readFileSync(join(folder, name)) : page);
});
await new Promise((listening) => server.listen(0, "127.0.0.1", listening));

const browser = await openBrowser(packages, { width: 300, height: 200 });
try {
  await browser.page.goto(`http://127.0.0.1:${server.address().port}/`);
  await browser.page.waitForFunction(() => window.printed.length === 2, undefined, { timeout: 20000 })
    .catch(() => { throw new Error(`the example has not ended: ${browser.complaints.join("; ") || "no error"}`); });
  const printed = await browser.page.evaluate(() => window.printed);
  require(printed[0] === "false 0.5 1,1,0,2,1,0", `the example prints ${printed[0]}`);
  require(browser.complaints.length === 0, browser.complaints.join("; "));
  console.log(`the example ran in Chromium ${browser.browser.version()}: ${printed[0]}`);
} catch (error) {
  console.log(error.message);
  process.exitCode = 1;
} finally {
  await browser.browser.close();
  server.close();
}
