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
  await page.waitForFunction(() => window.report || document.getElementById("headline").textContent.startsWith("This report cannot"));
  require(await page.evaluate(() => window.report !== undefined), await page.textContent("#summary"));
  const openedIn = Date.now() - opened;
  const counts = await page.evaluate(() => ({
    intervals: window.report.data.records[0].counted_intervals.length, points: window.report.plot.data[0].length,
    strategies: window.report.data.records[0].strategies.filter((row) => row.counts.pctp).length, curves: window.report.plot.series.length - 1,
    cells: window.report.data.tables.tables.reduce((sum, table) => sum + table.rows.reduce((all, row) => all + row.cells.length, 0), 0),
    shown: document.querySelectorAll("#table-list td:not(:first-child)").length, claims: document.querySelectorAll("#claim-list tr").length - 1,
    expected: window.report.data.tables.claims.length, bars: document.querySelectorAll(".bar").length,
  }));
  require(counts.points === counts.intervals && counts.curves === counts.strategies, `the chart has ${counts.points} points and ${counts.curves} curves`);
  require(counts.shown === counts.cells, `${counts.shown} of ${counts.cells} cells of tables are shown`);
  require(counts.claims === counts.expected, "a claim is missing");
  require(counts.bars > 0, "no stage times are shown");
  const before = await page.evaluate(() => window.report.plot.data.slice(1));
  await page.click('#counters button[value="elementary_tests"]');
  require(JSON.stringify(before) !== JSON.stringify(await page.evaluate(() => window.report.plot.data.slice(1))), "another counter changes no curve");
  await page.click('#counters button[value="pctp"]');
  if (picture) await page.screenshot({ path: picture, fullPage: true });
  await page.click("#theme");
  if (picture) await page.screenshot({ path: picture.replace(/\.png$/, "-dark.png") });
  await page.setViewportSize({ width: 390, height: 844 });
  await page.waitForTimeout(150);
  require(await page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth), "the page is wider than a phone");
  require(complaints.length === 0, `the browser complains: ${complaints[0]}`);
  require(requests.length === 1, `the page asks for ${requests[1]}`);
  console.log(JSON.stringify({ page: file, opened_ms: openedIn, ...counts }));
} catch (error) {
  console.log(`${file}: ${error.message}`);
  process.exitCode = 1;
} finally {
  await browser.close();
}
