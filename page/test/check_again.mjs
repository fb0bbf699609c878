// Has the program write pages with the engine (page/src/again.js), answers them again in headless Chromium, and holds the answers
// against those of `cscd query` with the same settings. Exit status as check.mjs; 1 too where an answer differs in a verdict or a count.
//
//   node check_again.mjs FOLDER-WITH-node_modules PROGRAM [--pictures FOLDER] "INPUT WORDS"...
//
// WORDS are options of `cscd view`; of a file with several clips they have to say --clip.
import { execFile } from "node:child_process";
import { mkdirSync, mkdtempSync, rmSync, statSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { openBrowser, require } from "./browser.mjs";

const [packages, program, ...rest] = process.argv.slice(2);
const folder = rest[0] === "--pictures" ? rest.splice(0, 2)[1] : null;
const { browser, page, complaints, requests } = await openBrowser(packages, { width: 1200, height: 800 });
const scratch = mkdtempSync(join(tmpdir(), "cscd-again-"));
const run = (...words) => new Promise((done, fail) => {
  execFile(resolve(program), words, { maxBuffer: 2 ** 30 }, (error, out, errors) => (error && error.code !== 1 ? fail(new Error(errors.trim())) : done(out)));
});
const picture = async (name) => {
  if (!folder) return;
  mkdirSync(folder, { recursive: true });
  await page.waitForFunction(() => !window.cscd.stage.flight && !window.cscd.stage.requested);
  await page.screenshot({ path: join(folder, `${name}.png`) });
};
const said = () => page.textContent("#doing");
const summary = () => page.evaluate(() => window.cscd.active.summary);
const countsOf = ({ verdict, clear, touches, intersects_at_start: crosses, close, events }) => `${verdict}: ${clear} clear, ${close === undefined ? "" : `${close} close, `}${touches} touch, ${crosses} cross, ${events.length} events`;

// An answer is shown in steps, and its verdict may read as the one before.
const drawn = () => page.waitForFunction(() => window.again.shown === window.cscd.recording);

// Answers again as the bar is set. Returns the seconds that it took.
async function again() {
  const begun = Date.now();
  await page.click("#ask");
  await page.waitForFunction(() => !document.body.classList.contains("checking"), null, { timeout: 300000 });
  require((await said()).startsWith("Answered in this page, from exact positions, in "), `the page does not answer: ${await said()}`);
  await drawn();
  require(await page.evaluate(() => window.cscd.active.name === "the library"), "the page shows the program's answer as its own");
  return (Date.now() - begun) / 1000;
}

// Holds what is shown against the program's answer to the same.
async function compare(title, words, options) {
  const seconds = await again(), begun = Date.now(), answer = JSON.parse(await run("query", ...words, ...options, "--json", "-")), took = (Date.now() - begun) / 1000;
  const theirs = (answer.clips ?? [answer])[(await page.isVisible("#clips")) ? Number(await page.inputValue("#clips")) : 0].summary;
  const ours = await summary(), text = `${title} ${options.join(" ")}`;
  require(countsOf(ours) === countsOf(theirs), `${text}: the page says ${countsOf(ours)}, and cscd query ${countsOf(theirs)}`);
  require(JSON.stringify(ours.first_named) === JSON.stringify(theirs.first_named) || Math.abs(ours.first_named.frame - theirs.first_named.frame) < 1e-6, `${text}: the page names ${JSON.stringify(ours.first_named)} first, and cscd query ${JSON.stringify(theirs.first_named)}`);
  console.log(`${text}: the same verdict and counts (${countsOf(ours)}); ${seconds.toFixed(2)} s, cscd query ${took.toFixed(2)} s`);
  if (ours.sentence !== theirs.sentence) console.log(`  the page says: ${ours.sentence}\n  cscd query:    ${theirs.sentence}`);
}

async function use(input) {
  const words = input.split(" "), file = join(scratch, "page.html"), title = [basename(words[0]), ...words.slice(1)].join(" ");
  await run("view", ...words, "--with-engine", "-o", file);
  await page.goto(pathToFileURL(file).href);
  await page.waitForFunction(() => window.cscd || document.body.classList.contains("failed"));
  require(!(await page.evaluate(() => document.body.classList.contains("failed"))), `${title}: ${await page.evaluate(() => document.getElementById("details").textContent)}`);
  const opening = await page.textContent("#verdict"), recorded = countsOf(await summary());
  require(!(await page.isVisible("#recorded")), "the program's answers can be gone back to from themselves");
  console.log(`${title}: ${(statSync(file).size / 1e6).toFixed(2)} MB, ${recorded}`);
  await picture(`${words[0].replace(/.*\//, "")}-opening`);

  await compare(title, words, []);
  require(countsOf(await summary()) === recorded, "with unchanged settings the page answers otherwise than the program had");
  await page.fill("#thickness", "0.1e");
  await compare(title, words, ["--thickness", "0.1e"]);
  require((await page.textContent("#answered")).includes("Thickness 0.1e"), `the details do not name the thickness: ${await page.textContent("#answered")}`);
  await picture(`${words[0].replace(/.*\//, "")}-thick`);
  await page.click("#recorded");
  await drawn();
  require((await page.textContent("#verdict")) === opening, "the program's answers do not come back");
  await page.fill("#thickness", "");

  if (await page.isVisible("#neighbours")) {
    await page.selectOption("#neighbours", "1");
    await compare(title, words, ["--ignore-neighbours", "1"]);
    await page.selectOption("#neighbours", "");
    await page.click("#recorded");
    await drawn();
    require((await page.textContent("#verdict")) === opening, "the program's answers do not come back");
  }
  if (await page.evaluate(() => window.cscd.chosen !== null)) {
    await page.click("#ignore");
    const [pair] = await page.evaluate(() => window.again.pairs);
    await compare(title, words, ["--ignore", pair.join(":")]);
    require((await page.textContent("#answered")).includes("Ignored: "), "the details do not say what is ignored");
    await picture(`${words[0].replace(/.*\//, "")}-ignored`);
    await page.locator("#ignored button").first().click();
    require((await page.evaluate(() => window.again.pairs.length)) === 0, "a pair stays ignored");
  }

  // A length that is none is refused in one sentence, and what is shown stays.
  const shown = await page.textContent("#verdict");
  await page.fill("#thickness", "1 furlong");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => document.getElementById("doing").textContent.startsWith("Not answered: thickness 1 furlong: is no length; write 0.01"));
  require((await page.textContent("#verdict")) === shown, "a refusal changes what is shown");
  // What is asked can be stopped; a short clip may be answered before that.
  await page.fill("#thickness", "");
  await page.click("#ask");
  await page.click("#stop", { timeout: 2000 }).catch(() => {});
  await page.waitForFunction(() => !document.body.classList.contains("checking"));
  require(/^(Stopped\.|Answered )/.test(await said()), `a stop is not told: ${await said()}`);
}

try {
  for (const input of rest) await use(input);
  require(complaints.length === 0, `the browser complains: ${complaints.join("; ")}`);
  require(requests.every((url) => /^(file|blob):/.test(url)), `the page asks for ${requests.find((url) => !/^(file|blob):/.test(url))}`);
} catch (error) {
  console.log(error.message);
  process.exitCode = 1;
} finally {
  await browser.close();
  rmSync(scratch, { recursive: true });
}
