// Gives models to the page that takes a file (page/src/check.html) in headless Chromium, and holds its verdicts against those of
// `cscd query`. Prints a line for every clip that differs, and a line for each file. Exit status as check.mjs; 1 too where a glTF
// file, or a sequence, has another verdict than the program gives.
//
//   node check_file.mjs FOLDER-WITH-node_modules PAGE PROGRAM [--pictures FOLDER] MODEL-OR-FOLDER...
import { execFile } from "node:child_process";
import { existsSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, dirname, join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { openBrowser, require } from "./browser.mjs";

const [packages, file, program, ...rest] = process.argv.slice(2);
const folder = rest[0] === "--pictures" ? rest.splice(0, 2)[1] : null;
const modelsIn = (path) => (statSync(path).isDirectory() ? readdirSync(path).sort().flatMap((name) => modelsIn(join(path, name))) : /\.(glb|gltf|fbx)$/i.test(path) ? [path] : []);
const models = rest.filter((path) => existsSync(path)).flatMap(modelsIn);

const { browser, page, complaints, requests } = await openBrowser(packages, { width: 1200, height: 800 });
const scratch = mkdtempSync(join(tmpdir(), "cscd-check-"));
const picture = async (name) => {
  if (!folder) return;
  mkdirSync(folder, { recursive: true });
  await page.waitForFunction(() => !window.cscd || (!window.cscd.stage.flight && !window.cscd.stage.requested));
  await page.screenshot({ path: join(folder, `${name}.png`) });
};
const run = (words) => new Promise((done) => {
  execFile(resolve(program), words, { maxBuffer: 2 ** 30, cwd: scratch }, (error, out, errors) => done({ failed: error !== null, out, errors: errors.trim() }));
});
const isBusy = () => page.evaluate(() => document.body.classList.contains("checking"));

// Gives the page files by the button, and waits for the end. Returns {refusal}, or the answers as JSON with times.
async function give(paths) {
  await page.evaluate(() => { window.longest = 0; });
  const begun = Date.now();
  await page.setInputFiles("#files", paths);
  await page.waitForFunction(() => document.body.className === "" || (document.body.className === "asking" && document.getElementById("refusal").textContent !== ""), null, { timeout: 300000 });
  const seconds = (Date.now() - begun) / 1000, refusal = await page.textContent("#refusal");
  if (refusal) return { refusal };
  return { seconds, json: await page.evaluate(() => window.check.json()), longest: await page.evaluate(() => window.longest) };
}

// The saved answers hold nothing that `cscd query --json` does not have.
const schema = JSON.parse(readFileSync(new URL("../../bench/answer/query.schema.json", import.meta.url), "utf8")).definitions;
function requireKnown(kind, value) {
  const known = (definition) => [...Object.keys(definition.properties ?? {}), ...(definition.allOf ?? []).flatMap((part) => known(part.$ref ? schema[part.$ref.split("/").at(-1)] : part))];
  for (const key of Object.keys(value ?? {})) require(known(schema[kind]).includes(key), `the saved answers have a field ${key} of ${kind}, which cscd query does not have`);
}

const clipsOf = (json) => json.clips ?? [json];
const countsOf = ({ summary: { clear, touches, intersects_at_start: crosses, events } }) => `${clear} clear, ${touches} touch, ${crosses} cross, ${events.length} events`;
const deepestOf = ({ summary: { headline } }) => headline?.depth.at_least ?? 0;

// Compares one file; returns whether its verdicts are those of the program.
async function compare(paths, name) {
  const [given, begun] = [await give(paths), Date.now()], query = await run(["query", paths[0], "--json", "-"]), seconds = (Date.now() - begun) / 1000;
  if (given.refusal || query.failed) {
    console.log(`${name}: ${given.refusal ? `refused: ${given.refusal}` : `answered in ${given.seconds} s`}; cscd query ${query.failed ? query.errors.split("\n").at(-1) : "answers"}`);
    return Boolean(given.refusal) || !query.failed;
  }
  const theirs = clipsOf(JSON.parse(query.out)), ours = clipsOf(given.json);
  let same = ours.length === theirs.length, exact = 0, deep = 0;
  ours.forEach((own, i) => {
    const other = theirs[i];
    if (!other || own.summary.verdict !== other.summary.verdict) same = false;
    if (other && countsOf(own) === countsOf(other)) ++exact;
    else console.log(`  ${name}, clip ${i}: ${own.summary.verdict} (${countsOf(own)}); cscd ${other ? `${other.summary.verdict} (${countsOf(other)})` : "has no such clip"}`);
    if (other) deep = Math.max(deep, Math.abs(deepestOf(own) - deepestOf(other)) / (deepestOf(other) || 1));
    if (other && own.summary.sentence !== other.summary.sentence) console.log(`  ${name}, clip ${i} says: ${own.summary.sentence}\n    cscd: ${other.summary.sentence}`);
  });
  console.log(`${name}: ${same ? "the same verdicts" : "OTHER VERDICTS"} of ${ours.length} clips, ${exact} with the same counts, deepest off by ${(100 * deep).toPrecision(2)} %; ${given.seconds.toFixed(2)} s, cscd query ${seconds.toFixed(2)} s; longest block ${Math.round(given.longest)} ms`);
  return same;
}

try {
  await page.addInitScript(() => new PerformanceObserver((list) => { for (const { duration } of list.getEntries()) window.longest = Math.max(window.longest ?? 0, duration); }).observe({ type: "longtask" }));
  await page.goto(pathToFileURL(resolve(file)).href);
  await page.waitForFunction(() => window.check);
  await picture("asks");

  // Files that are no models are refused in one sentence, and the page goes on.
  for (const [name, text, said] of [["plain.txt", "hello", "is no .glb"], ["broken.glb", "glTF", "broken.glb: cannot be read ("], ["broken.fbx", "Kaydara", "broken.fbx: cannot be read ("], ["broken.gltf", "{}", "broken.gltf: cannot be read ("], ["no.gltf", JSON.stringify({ asset: { version: "2.0" }, buffers: [{ uri: "no.bin", byteLength: 4 }] }), "names the file no.bin, which is not here"], ["a.gltf", JSON.stringify({ asset: { version: "2.0" }, extensionsRequired: ["ACME_bend"] }), "needs the glTF extension ACME_bend"]]) {
    writeFileSync(join(scratch, name), text);
    const { refusal } = await give([join(scratch, name)]);
    require(refusal?.includes(said), `${name} is not refused with "${said}": ${refusal}`);
    await picture(`refuses-${name}`);
  }

  // Sequences of three frames in which something falls through a triangle: another triangle, and a point.
  for (const [name, below, verdict] of [["fall", (z) => `v 1 1 ${z}\nv 2 1 ${z}\nv 1 2 ${z}\nf 4/1 5/2 6/3\n`, "touches itself in 1 of 2 intervals"],
    ["point", (z) => `v 1 1 ${z}\n`, "a point touches the surface"]]) {
    const frames = [0.5, -0.5, -1].map((z, i) => {
      const path = join(scratch, `${name}.${i}.obj`);
      writeFileSync(path, `v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n${below(z)}`);
      return path;
    });
    require(await compare(frames, `${name}.0.obj`), "a sequence has another verdict");
    require((await page.textContent("#verdict")).includes(verdict), `the page says: ${await page.textContent("#verdict")}`);
  }

  const wrong = [], answered = [];
  for (const path of models) {
    const beside = dirname(path), own = /\.gltf$/i.test(path) ? readdirSync(beside).filter((name) => readFileSync(path, "utf8").includes(`"${name}"`) && statSync(join(beside, name)).isFile()).map((name) => join(beside, name)) : [];
    const same = await compare([path, ...own.filter((other) => other !== path)], basename(path));
    if (!same && !/\.fbx$/i.test(path)) wrong.push(basename(path));
    if (!(await page.isVisible("#drop"))) answered.push(path);
    await picture(basename(path));
  }
  require(wrong.length === 0, `other verdicts than cscd query: ${wrong.join(", ")}`);

  // What is dropped is taken, too; it can be stopped, and the answers can be saved.
  const large = answered.find((path) => basename(path) === "horse.glb") ?? answered.at(-1);
  if (large) {
    const bytes = readFileSync(large).toString("base64");
    const drop = () => page.evaluate(([name, text]) => {
      const files = new DataTransfer();
      files.items.add(new File([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))], name));
      document.body.dispatchEvent(new DragEvent("drop", { dataTransfer: files, bubbles: true, cancelable: true }));
    }, [basename(large), bytes]);
    await drop();
    await page.waitForFunction(() => document.body.className === "checking unanswered" || document.body.className === "");
    await picture("working");
    if (await isBusy()) await page.click("#stop", { timeout: 2000 }).catch(() => {});  // a small file is answered meanwhile
    await page.waitForFunction(() => !document.body.classList.contains("checking"));
    require(/stopped|answered/i.test(await page.textContent("#doing") + await page.textContent("#refusal")), "a stop is not told");
    await drop();
    await page.waitForFunction(() => document.body.className === "", null, { timeout: 300000 });
    const [download] = await Promise.all([page.waitForEvent("download"), page.click("#save")]);
    const saved = JSON.parse(readFileSync(await download.path(), "utf8"));
    for (const { schema: own, fields_of: whose, ...clip } of clipsOf(saved)) {
      requireKnown("clip", clip);
      requireKnown("summary", clip.summary);
      requireKnown("headline", clip.summary.headline);
      clip.summary.events.forEach((event) => requireKnown("event", event));
      for (const { contacts = [], ...interval } of clip.intervals) {
        requireKnown("interval", interval);
        contacts.forEach((contact) => requireKnown("contact", contact));
      }
    }
    require(saved.schema === "cscd.check/1" && clipsOf(saved).every(({ intervals }) => intervals.length > 0), "the saved answers are not whole");
    if ((await page.locator("#clips option").count()) > 1) {
      const before = await page.textContent("#verdict");
      const other = page.locator(`#clips option:not([value="${await page.locator("#clips").inputValue()}"])`).first();
      await page.selectOption("#clips", await other.getAttribute("value"));
      await page.waitForFunction((said) => document.getElementById("verdict").textContent !== said, before);
    }
  }
  await page.click("#another");
  require(await page.isVisible("#drop"), "the page does not ask for another file");
  require(complaints.length === 0, `the browser complains: ${complaints.join("; ")}`);
  require(requests.every((url) => /^(file|blob):/.test(url)), `the page asks for ${requests.find((url) => !/^(file|blob):/.test(url))}`);
  console.log(`${basename(file)}: ${(statSync(file).size / 1e6).toFixed(2)} MB`);
} catch (error) {
  console.log(`${file}: ${error.message}`);
  process.exitCode = 1;
} finally {
  await browser.close();
  rmSync(scratch, { recursive: true });
}
