// Opens the page of `cscd report` in headless Chromium. Exit status as check.mjs.
//
//   node check_report.mjs FOLDER-WITH-node_modules PAGE [PICTURE.png]
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { openBrowser, require } from "./browser.mjs";

const [packages, file, picture] = process.argv.slice(2);
const { browser, page, complaints, requests } = await openBrowser(packages, { width: 1200, height: 900 });
try {
  const opened = Date.now();
  await page.goto(pathToFileURL(resolve(file)).href);
  await page.waitForFunction(() => window.report?.whole || document.getElementById("headline").textContent.startsWith("This report cannot"));
  require(await page.evaluate(() => window.report !== undefined), await page.textContent("#summary"));
  const openedIn = Date.now() - opened;
  const counts = await page.evaluate(() => ({
    intervals: window.report.data.records[0].counted_intervals.length, points: window.report.plot.data[0].length,
    strategies: window.report.data.records[0].strategies.filter((row) => row.counts.pctp).length, curves: window.report.plot.series.length - 1,
    figures: window.report.data.tables.tables.reduce((sum, table) => sum + table.rows.reduce((all, row) => all + row.cells.filter((cell) => cell.measured !== null).length, 0), 0),
    shown: [...document.querySelectorAll("#table-list details td:not(:first-child)")].filter((cell) => !cell.textContent.startsWith("–")).length,
    lines: window.report.data.tables.shaped.filter((table) => table.title).reduce((sum, table) => sum + table.lines.length, 0), shownLines: document.querySelectorAll("#table-list .shaped tr:not(.note):has(td)").length,
    claims: Math.max(0, document.querySelectorAll("#claim-list tr").length - 1),
    expected: window.report.data.tables.claims.filter((claim) => claim.verdict !== "not_measured").length, bars: document.querySelectorAll(".bar").length,
  }));
  require(counts.points === counts.intervals && counts.curves === counts.strategies, `the chart has ${counts.points} points and ${counts.curves} curves`);
  require(counts.shown === counts.figures, `${counts.shown} of ${counts.figures} figures of tables are shown`);
  require(counts.shownLines === counts.lines, `${counts.shownLines} of ${counts.lines} lines of the paper's tables are shown`);
  require(!/no record|not run in this record|does not count|not in a table/.test(await page.textContent("main")), "a cell says at length that it has no figure");
  require(counts.claims === counts.expected, "a claim is missing");
  // Numbers that charts format are those that cscd writes.
  const other = await page.evaluate(() => window.report.data.tables.tables.flatMap((table) => table.rows.flatMap((row) => row.cells))
    .find(({ measured, text }) => typeof measured === "number" && text.split(/[ *]/)[0] !== window.report.number(measured)));
  require(!other, `a number is not ${other?.text}`);
  require(counts.bars > 0, "no stage times are shown");
  const before = await page.evaluate(() => window.report.plot.data.slice(1));
  await page.click('#counters button[value="elementary_tests"]');
  require(JSON.stringify(before) !== JSON.stringify(await page.evaluate(() => window.report.plot.data.slice(1))), "another counter changes no curve");
  await page.click('#counters button[value="pctp"]');

  // The other studies, where the report has records of them.
  const studies = await page.evaluate(() => ["accuracy", "growth", "history"].filter((name) => window.report.data[name]));
  for (const name of ["accuracy", "growth", "history"])
    require((await page.locator(`#${name}`).isVisible()) === studies.includes(name), `${name} is shown without a record, or hidden with one`);
  for (const name of studies) {
    require((await page.locator(`#${name}-chart canvas`).count()) === 1, `${name} has no chart`);
    require((await page.textContent(`#${name}-source`)).includes("made by cscd"), `${name} does not say what made it`);
  }
  if (studies.includes("accuracy")) {
    const rows = await page.evaluate(() => Object.values(window.report.data.accuracy.data["group hard"]).filter((sum) => sum.ns).length);
    await page.click('#accuracy-groups button[value="hard"]');
    require((await page.locator("#accuracy-list tr").count()) === rows + 1, "the list of tests does not hold every test");
  }

  // The replay shows the interval under the pointer, and the one that arrow keys move to.
  const views = await page.evaluate(() => Object.keys(window.report.data.views).length);
  if (views > 0) {
    await page.click("#show-replay");
    const replay = await page.waitForSelector("#replay").then((frame) => frame.contentFrame());
    await replay.waitForFunction(() => window.cscd);
    await page.locator("#chart .u-over").hover({ position: { x: 200, y: 100 } });
    await replay.waitForFunction((interval) => window.cscd.interval() === interval, await page.evaluate(() => window.report.interval));
    await page.mouse.move(5, 5);
    await page.focus("#chart");
    const before = await page.evaluate(() => window.report.interval);
    await page.keyboard.press("ArrowRight");
    require((await page.evaluate(() => window.report.interval)) !== before, "arrow keys do not move along the chart");
    require((await page.textContent("#interval-link")).startsWith("interval "), "no link leads to the replay");
  }
  require((await page.locator("img, object, embed, link").count()) === 0, "a name became an element");
  if (picture) await page.screenshot({ path: picture, fullPage: true });
  await page.click("#theme");
  if (picture) await page.screenshot({ path: picture.replace(/\.png$/, "-dark.png") });
  await page.setViewportSize({ width: 390, height: 844 });
  await page.waitForFunction(() => document.documentElement.scrollWidth <= window.innerWidth, null, { timeout: 10000 })
    .catch(() => { throw new Error("the page is wider than a phone"); });
  require(complaints.length === 0, `the browser complains: ${complaints[0]}`);
  require(requests.length === (views > 0 ? 2 : 1), `the page asks for ${requests.at(-1)}`);
  const painted = await page.evaluate(() => performance.getEntriesByName("first-contentful-paint")[0].startTime);
  console.log(JSON.stringify({ page: file, first_view_ms: Math.round(painted), opened_ms: openedIn, ...counts }));
} catch (error) {
  console.log(`${file}: ${error.message}`);
  process.exitCode = 1;
} finally {
  await browser.close();
}
