// The report: the numbers of records in one page. Charts are in charts.js; accuracy, growth and history in studies.js.
import { Chart, colourOf, dashOf, LINEAR, LOG, redrawCharts, short, textOf } from "./charts.js";
import { byId, element, isDark, prefersDark, radios, setDark } from "./dom.js";
import { BLUE, ORANGE, SKY } from "./palette.js";
import { showAccuracy, showGrowth, showHistory } from "./studies.js";
import { shapedTable, tableOf } from "./tables.js";

const FIRST_SHOWN = new Set(["base", "aabb", "mcd", "selfccd", "rvbc", "drvbc", "drvbc_fast", "drvbc_fast_complete"]);
const STAGES = [["refit", "#999999"], ["rv_update", SKY], ["traversal", ORANGE], ["elementary", BLUE]];
const COMPLETE_BASELINES = ["base", "aabb", "mcd", "selfccd", "embree", "cgal_boxes"];
const COUNTERS = [["bvot", "overlap tests of bounding volumes (Figure 11)"], ["pctp", "triangle pairs left by culling (Figure 12)"], ["elementary_tests", "elementary tests"], ["not_positive", "triangles that are not positive"]];

const withInterval = (cell) => short(cell.measured) + (cell.marked ? "*" : "") + (cell.interval ? ` [${short(cell.interval[0])}, ${short(cell.interval[1])}]` : "");

class Report {
  constructor(data) {
    this.data = data;
    for (const claim of data.tables.claims) claim.verdict = claim.verdict.replaceAll(" ", "_");
    // Cells by table, scene and key. Where records of both pipelines are given, the headline is about this project's.
    this.cells = new Map();
    for (const table of data.tables.tables)
      for (const row of table.rows)
        for (const cell of row.cells) if (cell.pipeline !== "published") this.cells.set(`${table.id} ${row.scene} ${cell.key}`, cell);
    this.scenes = [...new Set(data.records.map((record) => record.scene))];
    // Baselines find all contacts, so the row that they are compared with has to find them, too.
    this.findsAll = this.scenes.every((scene) => this.median(scene, "drvbc_fast_all")) ? "drvbc_fast_all" : "drvbc_fast_complete";
    this.bothPipelines = new Set(data.records.map((record) => record.pipeline)).size > 1;
    this.counter = "pctp";
    this.record = data.records[0];
    setDark(prefersDark());
    byId("theme").addEventListener("click", () => {
      setDark(!isDark());
      redrawCharts();
    });
    this.say();
    this.speed();
    this.curves();
    this.replay();
  }

  // What lies below the first view.
  finish() {
    const { data } = this;
    this.stages();
    this.tables();
    this.claims();
    this.study("accuracy", data.accuracy, showAccuracy);
    this.study("growth", data.growth, showGrowth);
    this.study("history", data.history, showHistory);
    this.records();
    this.openForPrint();
    this.whole = true;
  }

  nameOf(record) { return this.bothPipelines ? `${record.scene}, pipeline ${record.pipeline}` : record.scene; }

  cell(table, scene, key) {
    const cell = this.cells.get(`${table} ${scene} ${key}`);
    return cell && cell.measured !== null ? cell : null;
  }

  // What the median query takes a row, with refit.
  median(scene, row) { return this.cell("beside", scene, `${row}.with_refit_median`); }

  // The fastest complete baseline, and how many times faster the engine is when it is asked for all contacts, too.
  bestBaseline(scene) {
    const own = this.median(scene, this.findsAll);
    if (!own) return undefined;
    const rows = COMPLETE_BASELINES.map((name) => ({ name, cell: this.median(scene, name) })).filter((row) => row.cell)
      .map(({ name, cell }) => ({ name, cell: { measured: cell.measured / own.measured, marked: Boolean(cell.marked || own.marked) } }));
    return rows.sort((a, b) => a.cell.measured - b.cell.measured)[0];
  }

  say() {
    const { scenes } = this;
    const { caution } = this.data;  // nothing is said of speed or of claims where nothing may be claimed
    const times = caution ? [] : scenes.map((scene) => this.cell("engine", scene, "fast.median")).filter((cell) => cell && !cell.marked).map((cell) => cell.measured);
    const gains = scenes.map((scene) => this.bestBaseline(scene)).filter((row) => row && !row.cell.marked).map((row) => row.cell.measured);
    const range = (values) => (Math.min(...values) === Math.max(...values) ? short(values[0]) : `${short(Math.min(...values))} to ${short(Math.max(...values))}`);
    byId("headline").textContent = times.length === 0 ? `What ${scenes.length} records say`
      : `From a start that is known to be embedded, drvbc_fast answers the median interval in ${range(times)} ms` + (gains.length ? `, and ${this.findsAll} finds all contacts ${range(gains)} times faster than the fastest complete baseline.` : ".");
    const verdicts = this.data.tables.claims.filter((claim) => claim.verdict !== "not_measured");
    const reproduced = verdicts.filter((claim) => claim.verdict === "reproduced").length;
    const { environment } = this.data.tables.records[0];
    const sum = (key) => this.data.tables.records.reduce((total, record) => total + (record[key] || 0), 0);
    byId("summary").textContent = (caution ? `Beware: ${caution}. Nothing is claimed from that. ` : "") + `${scenes.length} scene${scenes.length === 1 ? "" : "s"}; ${sum("verified_intervals")} intervals verified, ${sum("timed_intervals")} timed. ` +
      (verdicts.length ? `${reproduced} of ${verdicts.length} claims of the paper that can be measured here are reproduced. ` : "") + `${environment.cpu}, ${environment.cores} cores, ${environment.compiler}, commit ${environment.commit.slice(0, 12)}${environment.dirty ? " with changes" : ""}, ${environment.date.slice(0, 10)}.`;
  }

  linkTo(file) {
    const link = element("a", file.split("/").at(-1));
    link.href = encodeURI(this.data.base + file);
    return link;
  }

  source(id, what) {
    const files = this.data.records.map((record) => record.file);
    const place = byId(id);
    place.append(`${what} From the records `);
    files.forEach((file, i) => place.append(i ? ", " : "", this.linkTo(file)));
    place.append("; made by ", element("code", this.data.command), ".");
  }

  speed() {
    const { scenes } = this;
    const rows = [
      ["one query of drvbc_fast, ms (median)", (scene) => this.cell("engine", scene, "fast.median")],
      [`all contacts, ${this.findsAll}: times faster than the best complete baseline`, (scene) => this.bestBaseline(scene)?.cell, (scene) => this.bestBaseline(scene)?.name],
      ["first contact, drvbc_fast: times faster than drvbc, the paper's method", (scene) => this.cell("engine", scene, "fast.over_drvbc")],
      ["drvbc: times faster than base", (scene) => this.cell("table2", scene, "speedup_base"), (scene) => textOf(this.cells.get(`table2 ${scene} speedup_base`)?.published, (published) => `published ${short(published)}`)],
    ];
    const measured = rows.filter(([, cell]) => scenes.some((scene) => cell(scene)));
    byId("speed-table").append(tableOf(["", ...scenes], measured.map(([title, cell, note]) => [title, ...scenes.map((scene) => {
      const found = cell(scene), td = element("td", found ? withInterval(found) : "–");
      if (note && note(scene)) td.append(element("small", note(scene)));
      return td;
    })])));
    this.source("speed-source", "Brackets hold 95 % intervals.");
  }

  curves() {
    const select = byId("scene");
    this.data.records.forEach((record, i) => select.append(new Option(this.nameOf(record), String(i))));
    const choose = () => {
      byId("counters").update(this.counter);
      this.chart.draw();
      this.showReplay();
    };
    select.addEventListener("change", () => {
      this.record = this.data.records[Number(select.value)];
      choose();
    });
    radios(byId("counters"), COUNTERS, (counter) => {
      this.counter = counter;
      choose();
    });
    byId("counters").update(this.counter);
    this.chart = new Chart(byId("chart"), 380, () => {
      const rows = this.record.strategies.filter((strategy) => strategy.counts[this.counter]);
      return {
        data: [this.record.counted_intervals, ...rows.map((strategy) => strategy.counts[this.counter].map((value) => (value > 0 ? value : null)))],
        series: rows.map((strategy, i) => ({
          label: strategy.name, stroke: colourOf(strategy.name), dash: dashOf(strategy.name, i), show: FIRST_SHOWN.has(strategy.name),
          value: (_, value) => textOf(value, (count) => count.toLocaleString("en")),
        })),
        x: { label: "interval", scale: LINEAR },
        y: { label: "an interval", scale: LOG },
        hooks: { setCursor: [(plot) => this.point(plot.cursor.idx)] },
      };
    });
    this.source("work-source", "Counted, not timed: the numbers are the same on every machine.");
  }

  get plot() { return this.chart.plot; }

  // --- The replay --------------------------------------------------------------------------------------------------------

  replay() {
    const frame = byId("replay");
    byId("show-replay").addEventListener("click", () => {
      this.replayShown = !this.replayShown;
      byId("show-replay").setAttribute("aria-pressed", String(this.replayShown));
      this.showReplay();
    });
    frame.addEventListener("load", () => this.point(this.interval === undefined ? null : this.record.counted_intervals.indexOf(this.interval)));
    this.replayShown = false;
    this.showReplay();
  }

  // Shows the replay of the chosen scene where it was asked for and was written.
  showReplay() {
    const page = this.data.views[this.record.scene], frame = byId("replay"), shown = Boolean(page && this.replayShown);
    byId("show-replay").hidden = !page;
    byId("replay-missing").hidden = Boolean(page);
    frame.hidden = !shown;
    if (shown && frame.getAttribute("src") !== page) frame.setAttribute("src", page);
    this.sayInterval();
  }

  // The interval under the pointer, as the place in the list of counted intervals: the replay shows it.
  point(index) {
    if (index === null || index === undefined || index < 0) return;
    this.interval = this.record.counted_intervals[index];
    if (!byId("replay").hidden) byId("replay").contentWindow.postMessage({ interval: this.interval }, "*");
    this.sayInterval();
  }

  sayInterval() {
    const page = this.data.views[this.record.scene], place = byId("interval-link");
    place.replaceChildren();
    if (!page || this.interval === undefined) return;
    const link = element("a", `interval ${this.interval} of ${this.record.scene} in 3D`);
    link.href = `${encodeURI(page)}#interval=${this.interval}`;
    place.append(link);
  }

  // --- Other parts -------------------------------------------------------------------------------------------------------

  // A part about a study of its own, which is hidden where no record of it was given.
  study(name, data, show) {
    byId(name).hidden = !data;
    document.querySelector(`nav a[href="#${name}"]`).hidden = !data;
    if (!data) return;
    show(data);
    const place = byId(`${name}-source`);
    place.append("From ", this.linkTo(data.file || data.folder));
    if (data.environment) place.append(`, measured on ${data.environment.cpu}, ${data.environment.date.slice(0, 10)}, commit ${data.environment.commit.slice(0, 12)}`);
    place.append("; made by ", element("code", data.command ? data.command.join(" ") : "cscd history --json"), ".");
  }

  // Print shows what is folded away on the screen.
  openForPrint() {
    let closed = [];
    window.addEventListener("beforeprint", () => {
      closed = [...document.querySelectorAll("details:not([open])")];
      for (const one of closed) one.open = true;
    });
    window.addEventListener("afterprint", () => { for (const one of closed) one.open = false; });
  }

  stages() {
    const box = byId("stage-chart");
    const key = element("p");
    for (const [stage, colour] of STAGES) {
      const item = element("span", undefined, "key"), swatch = element("i");
      swatch.style.background = colour;
      item.append(swatch, stage);
      key.append(item);
    }
    box.append(key);
    this.data.records.forEach((record, n) => {
      const rows = record.strategies.filter((strategy) => strategy.stages && FIRST_SHOWN.has(strategy.name));
      if (rows.length === 0) return;
      const details = element("details"), bars = element("div", undefined, "bars");
      details.open = n === 0;
      details.append(element("summary", this.nameOf(record)), bars);
      const total = (strategy) => STAGES.reduce((sum, [stage]) => sum + (strategy.stages[stage] || 0), 0);
      const most = Math.max(...rows.map(total));
      for (const strategy of rows) {
        const bar = element("span", undefined, "bar");
        for (const [stage, colour] of STAGES) {
          if (!strategy.stages[stage]) continue;
          const piece = element("i");
          piece.style.width = `${(100 * strategy.stages[stage]) / most}%`;
          piece.style.background = colour;
          piece.title = `${stage}: ${short(strategy.stages[stage])} ms`;
          bar.append(piece);
        }
        bars.append(element("span", strategy.name), bar, element("span", `${short(total(strategy))} ms`));
      }
      box.append(details);
    });
    this.source("stage-source", "Means over the timed intervals, the median over the repetitions.");
  }

  // The paper's tables in the paper's shape, the times of all strategies, and folded away every figure of every table.
  tables() {
    const list = byId("table-list"), { shaped, tables } = this.data;
    for (const table of shaped) if (table.columns.length > 0) list.append(shapedTable(table));
    const every = element("details");
    every.append(element("summary", "Every figure, with its 95 % interval"));
    for (const table of tables.tables) {
      const titles = table.rows.flatMap((row, n) => (n ? [] : row.cells.map((cell, i) => [i, cell])));
      const rows = titles.filter(([i]) => table.rows.some((row) => row.cells[i].measured !== null)).map(([i, { title, unit, pipeline }]) => [
        title + (unit ? `, ${unit}` : "") + (this.bothPipelines && pipeline && pipeline !== "both" ? `, pipeline ${pipeline}` : ""),
        ...table.rows.map((row) => {
          const cell = row.cells[i], td = element("td", cell.measured === null ? "–" : withInterval(cell));
          if (cell.published !== null) td.append(element("small", `published ${short(cell.published)}`));
          return td;
        })]);
      if (rows.length === 0) continue;
      const details = element("details"), wide = element("div", undefined, "wide");
      wide.append(tableOf(["", ...table.rows.map((row) => row.scene)], rows));
      details.append(element("summary", table.title), wide);
      every.append(details);
    }
    const marked = tables.tables.some((table) => table.rows.some((row) => row.cells.some((cell) => cell.marked)));
    if (marked) every.append(element("p", this.data.mark_note, "hint"));
    list.append(every);
    const { published } = this.data.tables;
    this.source("tables-source", `Published: ${published.source} (${published.machine}).`);
  }

  claims() {
    const { claims } = this.data.tables, measured = claims.filter((claim) => claim.verdict !== "not_measured");
    const rows = measured.map((claim) => {
      const quote = element("td", `“${claim.quote}” (${claim.where})`, "text");
      const verdict = element("td", claim.verdict.replaceAll("_", " "), `text verdict ${claim.verdict}`);
      const evidence = element("td", undefined, "text"), details = element("details");
      const figures = claim.evidence.filter((one) => one.measured !== undefined);
      details.append(element("summary", `${figures.filter((one) => one.holds).length} of ${figures.length} figures hold`));
      for (const one of figures) details.append(element("div", `${one.holds ? "✔" : "✖"} ${one.scene}: ${one.title} ${short(one.measured)}${one.today === undefined ? "" : ` (${short(one.today)} with this project's code)`}`));
      evidence.append(details);
      return [quote, verdict, element("td", claim.expectation, "text"), evidence];
    });
    if (rows.length > 0) byId("claim-list").append(tableOf(["claim", "verdict", "holds where", "evidence"], rows));
    const others = claims.filter((claim) => claim.verdict === "not_measured").map((claim) => claim.id);
    this.source("claims-source", others.length ? `Not measured: ${others.join(", ")}.` : "");
  }

  records() {
    const rows = this.data.tables.records.map((record, i) => {
      const cell = element("td", undefined, "text"), command = element("td", undefined, "text");
      cell.append(this.linkTo(this.data.records[i].file));
      command.append(element("code", record.command.join(" ")));
      return [this.nameOf(this.data.records[i]), cell, `${record.environment.date.slice(0, 10)}`, record.environment.commit.slice(0, 12), command];
    });
    byId("record-list").append(tableOf(["scene", "record", "date", "commit", "made by"], rows));
  }
}

attempt(() => {
  window.report = new Report(JSON.parse(byId("header").textContent));
  requestAnimationFrame(() => setTimeout(() => attempt(() => window.report.finish())));  // when the first view is painted
});

function attempt(work) {
  try {
    work();
  } catch (error) {
    fail(error);
  }
}

function fail(error) {
  byId("headline").textContent = "This report cannot be shown.";
  byId("summary").textContent = error instanceof SyntaxError ? "The page is damaged. Write it again with cscd report." : String(error.message || error);
  console.warn(error);
}
