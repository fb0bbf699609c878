import uPlot from "uplot";
import { BLUE, GREEN, GREY, ORANGE, PINK, RED, SKY } from "./palette.js";

const byId = (id) => document.getElementById(id);
// One look of a strategy everywhere, as in scripts/lib/charts.py: a family has one colour, and dashes tell its members apart.
const LOOKS = [["base", "#000000"], ["aabb", SKY], ["mcd", ORANGE], ["selfccd", GREEN], ["embree", SKY], ["cgal_boxes", SKY], ["fcl", GREY], ["rvbc", PINK], ["drvbc", BLUE], ["drvbc_fast", RED]];
const FIRST_SHOWN = new Set(["base", "aabb", "mcd", "selfccd", "rvbc", "drvbc", "drvbc_fast", "drvbc_fast_complete"]);
const STAGES = [["refit", "#999999"], ["rv_update", SKY], ["traversal", ORANGE], ["elementary", BLUE]];
const COMPLETE_BASELINES = ["base", "aabb", "mcd", "selfccd", "embree", "cgal_boxes"];
const COUNTERS = [["bvot", "overlap tests of bounding volumes (Figure 11)"], ["pctp", "triangle pairs left by culling (Figure 12)"], ["elementary_tests", "elementary tests"], ["not_positive", "triangles that are not positive"]];

function element(tag, text, className) {
  const made = document.createElement(tag);
  if (text !== undefined) made.textContent = text;
  if (className) made.className = className;
  return made;
}
const short = (x) => (Math.abs(x) >= 1e5 || Number.isInteger(x) ? Math.round(x).toLocaleString("en") : String(Number(x.toPrecision(3))));
const withInterval = (cell) => short(cell.measured) + (cell.interval ? ` [${short(cell.interval[0])}, ${short(cell.interval[1])}]` : "");
const label = (record) => record.scene + (record.pipeline === "published" ? ", pipeline published" : "");
const dark = () => document.documentElement.classList.contains("dark");
function colourOf(name) {
  const row = LOOKS.filter(([known]) => name === known || name.startsWith(`${known}_`)).at(-1);
  const colour = row ? row[1] : GREY;
  return colour === "#000000" && dark() ? "#ffffff" : colour;
}
const dashOf = (name, index) => (LOOKS.some(([known]) => known === name) && !["embree", "cgal_boxes"].includes(name) ? [] : [[6, 4], [2, 3], [9, 3, 2, 3], [4, 2]][index % 4]);

class Report {
  constructor(data) {
    this.data = data;
    for (const claim of data.tables.claims) claim.verdict = claim.verdict.replaceAll(" ", "_");
    this.cells = new Map();
    for (const table of data.tables.tables)
      for (const row of table.rows)
        for (const cell of row.cells)
          if (cell.pipeline !== "published") this.cells.set(`${table.id} ${row.scene} ${cell.key}`, cell);
    // The speeds on top are those of this project's code: the other pipeline has its rows in the tables.
    this.today = data.records.filter((record) => record.pipeline !== "published");
    this.counter = "pctp";
    this.scene = label(data.records[0]);
    document.documentElement.classList.toggle("dark", window.matchMedia("(prefers-color-scheme: dark)").matches);
    byId("theme").addEventListener("click", () => {
      document.documentElement.classList.toggle("dark");
      this.drawCurves();
    });
    this.say();
    this.speed();
    this.makeCurves();
    this.stages();
    this.tables();
    this.claims();
    this.records();
    new ResizeObserver(() => this.plot && this.plot.setSize({ width: byId("chart").clientWidth, height: 380 })).observe(byId("chart"));
  }

  cell(table, scene, key) {
    const cell = this.cells.get(`${table} ${scene} ${key}`);
    return cell && cell.measured !== null ? cell : null;
  }

  // The complete baseline that drvbc_fast gains least against.
  bestBaseline(scene) {
    const rows = COMPLETE_BASELINES.map((name) => ({ name, cell: this.cell("engine", scene, `fast.over_${name}`) })).filter((row) => row.cell);
    return rows.sort((a, b) => a.cell.measured - b.cell.measured)[0];
  }

  say() {
    const scenes = this.today.map((record) => record.scene);
    const times = scenes.map((scene) => this.cell("engine", scene, "fast.median")).filter(Boolean).map((cell) => cell.measured);
    const gains = scenes.map((scene) => this.bestBaseline(scene)).filter(Boolean).map((row) => row.cell.measured);
    const range = (values) => (Math.min(...values) === Math.max(...values) ? short(values[0]) : `${short(Math.min(...values))} to ${short(Math.max(...values))}`);
    byId("headline").textContent = times.length === 0 ? `What ${scenes.length} records say`
      : `From a start that is known to be embedded, drvbc_fast answers the median interval in ${range(times)} ms` + (gains.length ? `, ${range(gains)} times faster than the fastest complete baseline.` : ".");
    const verdicts = this.data.tables.claims.filter((claim) => claim.verdict !== "not_measured");
    const reproduced = verdicts.filter((claim) => claim.verdict === "reproduced").length;
    const { environment } = this.data.tables.records[0];
    const sum = (key) => this.data.tables.records.reduce((total, record) => total + (record[key] || 0), 0);
    byId("summary").textContent = `${scenes.length} scene${scenes.length === 1 ? "" : "s"}; ${sum("verified_intervals")} intervals verified, ${sum("timed_intervals")} timed. ` +
      `${reproduced} of ${verdicts.length} claims of the paper that can be measured here are reproduced. ${environment.cpu}, ${environment.cores} cores, ${environment.compiler}, commit ${environment.commit.slice(0, 12)}${environment.dirty ? " with changes" : ""}, ${environment.date.slice(0, 10)}.`;
  }

  source(id, what) {
    const files = this.data.records.map((record) => record.file);
    const place = byId(id);
    place.append(`${what} From the records `);
    files.forEach((file, i) => {
      const link = element("a", file.split("/").at(-1));
      link.href = encodeURI(this.data.base + file);
      place.append(i ? ", " : "", link);
    });
    place.append("; made by ", element("code", this.data.command), ".");
  }

  speed() {
    const scenes = this.today.map((record) => record.scene);
    const rows = [
      ["one query of drvbc_fast, ms (median)", (scene) => this.cell("engine", scene, "fast.median")],
      ["times faster than the best complete baseline", (scene) => this.bestBaseline(scene)?.cell, (scene) => this.bestBaseline(scene)?.name],
      ["times faster than drvbc, the paper's method", (scene) => this.cell("engine", scene, "fast.over_drvbc")],
      ["drvbc: times faster than base", (scene) => this.cell("table2", scene, "speedup_base"), (scene) => {
        const published = this.cells.get(`table2 ${scene} speedup_base`)?.published;
        return published === null || published === undefined ? "" : `published ${short(published)}`;
      }],
    ];
    byId("speed-table").append(this.table(["", ...scenes], rows.map(([title, cell, note]) => [title, ...scenes.map((scene) => {
      const found = cell(scene), td = element("td", found ? withInterval(found) : "not in a table of these records", found ? "" : "none");
      if (note && note(scene)) td.append(element("small", note(scene)));
      return td;
    })])));
    this.source("speed-source", "Brackets hold 95 % intervals.");
  }

  table(head, rows) {
    const table = element("table"), top = element("tr");
    for (const name of head) top.append(element("th", name));
    table.append(top);
    for (const row of rows) {
      const tr = element("tr");
      for (const cell of row) tr.append(cell instanceof Node ? cell : element("td", cell));
      table.append(tr);
    }
    return table;
  }

  makeCurves() {
    const select = byId("scene");
    for (const record of this.data.records) select.append(new Option(label(record), label(record)));
    select.addEventListener("change", () => {
      this.scene = select.value;
      this.drawCurves();
    });
    const box = byId("counters");
    for (const [key, title] of COUNTERS) {
      const button = element("button", title);
      button.setAttribute("role", "radio");
      button.value = key;
      button.addEventListener("click", () => {
        this.counter = key;
        this.drawCurves();
      });
      box.append(button);
    }
    this.drawCurves();
    this.source("work-source", "Counted, not timed: the numbers are the same on every machine.");
  }

  drawCurves() {
    for (const button of byId("counters").children) button.setAttribute("aria-checked", String(button.value === this.counter));
    const record = this.data.records.find((row) => label(row) === this.scene);
    const rows = record.strategies.filter((strategy) => strategy.counts[this.counter]);
    const style = getComputedStyle(document.documentElement), text = style.getPropertyValue("--soft"), line = style.getPropertyValue("--line");
    const axis = { stroke: text, grid: { stroke: line, width: 1 }, ticks: { stroke: line } };
    const isDecade = (tick) => Math.abs(Math.log10(tick) - Math.round(Math.log10(tick))) < 1e-9;
    const decades = (_, ticks) => ticks.map((tick) => (isDecade(tick) ? tick : null));
    const series = rows.map((strategy, i) => ({
      label: strategy.name, stroke: colourOf(strategy.name), width: 1.6, dash: dashOf(strategy.name, i), show: FIRST_SHOWN.has(strategy.name), points: { show: false },
      value: (_, value) => (value === null || value === undefined ? "" : value.toLocaleString("en")),
    }));
    const data = [record.counted_intervals, ...rows.map((strategy) => strategy.counts[this.counter].map((value) => (value > 0 ? value : null)))];
    if (this.plot) this.plot.destroy();
    this.plot = new uPlot({
      width: byId("chart").clientWidth || 900, height: 380, scales: { x: { time: false }, y: { distr: 3 } },
      axes: [{ ...axis, label: "interval", labelSize: 18 }, { ...axis, grid: { ...axis.grid, filter: decades }, ticks: { ...axis.ticks, filter: decades }, filter: decades, size: 95, values: (_, ticks) => ticks.map((tick) => (tick === null ? "" : tick.toLocaleString("en"))) }],
      series: [{ label: "interval" }, ...series],
    }, data, byId("chart"));
    this.points = data[0].length;
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
      details.append(element("summary", label(record)), bars);
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

  tables() {
    this.data.tables.tables.forEach((table, n) => {
      if (table.rows.length === 0) return;
      const details = element("details"), wide = element("div", undefined, "wide");
      details.open = n < 3;
      const two = table.rows[0].cells.some((cell) => cell.pipeline === "published");
      const titles = table.rows[0].cells.map((cell) => cell.title + (cell.unit ? `, ${cell.unit}` : "") + (two && cell.pipeline !== "both" ? `, ${cell.pipeline}` : ""));
      wide.append(this.table(["", ...table.rows.map((row) => row.scene)], titles.map((title, n) => [title, ...table.rows.map((row) => {
        const cell = row.cells[n];
        const td = cell.measured === null ? element("td", cell.reason, "none") : element("td", withInterval(cell));
        if (cell.published !== null) td.append(element("small", `published ${short(cell.published)}`));
        return td;
      })])));
      details.append(element("summary", table.title), wide);
      byId("table-list").append(details);
    });
    const { published } = this.data.tables;
    this.source("tables-source", `Published: ${published.source} (${published.machine}).`);
  }

  claims() {
    const rows = this.data.tables.claims.map((claim) => {
      const quote = element("td", `“${claim.quote}” (${claim.where})`, "text");
      const verdict = element("td", claim.verdict.replaceAll("_", " "), `text verdict ${claim.verdict}`);
      const evidence = element("td", claim.verdict === "not_measured" ? claim.why : "", "text");
      if (claim.evidence.length > 0) {
        const details = element("details");
        details.append(element("summary", `${claim.evidence.filter((one) => one.holds).length} of ${claim.evidence.length} figures hold`));
        for (const one of claim.evidence) details.append(element("div", `${one.holds ? "✔" : "✖"} ${one.scene}: ${one.title} ${one.measured === null || one.measured === undefined ? one.reason || "not measured" : short(one.measured)}${one.today === undefined ? "" : ` (${short(one.today)} with today's code)`}`));
        evidence.append(details);
      }
      return [quote, verdict, element("td", claim.expectation, "text"), evidence];
    });
    byId("claim-list").append(this.table(["claim", "verdict", "holds where", "evidence"], rows));
    this.source("claims-source", "");
  }

  records() {
    const rows = this.data.tables.records.map((record, i) => {
      const link = element("a", this.data.records[i].file.split("/").at(-1)), cell = element("td", undefined, "text");
      link.href = encodeURI(this.data.base + this.data.records[i].file);
      cell.append(link);
      const command = element("td", undefined, "text");
      command.append(element("code", record.command.join(" ")));
      return [label(record), cell, `${record.environment.date.slice(0, 10)}`, record.environment.commit.slice(0, 12), command];
    });
    byId("record-list").append(this.table(["scene", "record", "date", "commit", "made by"], rows));
  }
}

try {
  window.report = new Report(JSON.parse(byId("header").textContent));
} catch (error) {
  byId("headline").textContent = "This report cannot be shown.";
  byId("summary").textContent = String(error.message || error);
  console.warn(error);
}
