// A headless Chromium with one page that keeps what the browser complains about and asks for. Ends the process with status 77
// where there is no Chromium.
import { accessSync, constants } from "node:fs";
import { createRequire } from "node:module";
import { join, resolve } from "node:path";

function chromiumOfThisMachine() {
  for (const path of [process.env.CSCD_CHROMIUM, "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"])
    try {
      if (path) {
        accessSync(path, constants.X_OK);
        return path;
      }
    } catch { /* the next one */ }
  return null;
}

export function require(holds, what) {
  if (!holds) throw new Error(what);
}

export async function openBrowser(packages, viewport) {
  const executablePath = chromiumOfThisMachine();
  if (!executablePath) {
    console.log("skipped: there is no Chromium here (Debian's package chromium, or CSCD_CHROMIUM)");
    process.exit(77);
  }
  const { chromium } = createRequire(join(resolve(packages), "package.json"))("playwright-core");
  const browser = await chromium.launch({
    executablePath, args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
  const page = await browser.newPage({ viewport, reducedMotion: "reduce" });  // software takes long to draw flights of the camera
  const complaints = [], requests = [];
  page.on("console", (message) => { if (["error", "warning"].includes(message.type())) complaints.push(message.text()); });
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("request", (request) => requests.push(request.url()));
  page.on("dialog", (dialog) => complaints.push(`a dialog: ${dialog.message()}`));
  return { browser, page, complaints, requests };
}
