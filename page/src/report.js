// The report: the numbers of records in one page. Charts are in charts.js; accuracy, growth and history in studies.js.
import { Chart, colourOf, dashOf, LINEAR, LOG, redrawCharts, setLooks, textOf } from "./charts.js";
import { byId, element, isDark, prefersDark, radios, setDark } from "./dom.js";
import { showAccuracy, showGrowth, showHistory } from "./studies.js";
import { shapedTable, tableOf } from "./tables.js";
import { number } from "./words.js";

class Report {
  constructor(data) {
    this.data = data;
    this.number = number;
    for (const claim of data.tables.claims) claim.verdict = claim.verdict.replaceAll(" ", "_");
    setLooks(data.looks);
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

  // What the records say in words: of the engine first, then all else.
  say() {
    const { remarks, records } = this.data.tables, isHead = ({ name }) => name === "drvbc_fast", head = remarks.find(isHead);
    byId("headline").textContent = head ? `${head.name}: ${head.text}` : `What ${records.length} record${records.length === 1 ? " says" : "s say"}`;
    byId("summary").textContent = remarks.filter((one) => !isHead(one)).map(({ name, text }) => `${name ? `${name}: ` : ""}${text}.`).join(" ");
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
    const speed = this.data.tables.shaped.find(({ id }) => id === "speed");
    if (speed) byId("speed-table").append(shapedTable(speed));
    this.source("speed-source", "Brackets hold 95 % intervals, parentheses what was published.");
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
    radios(byId("counters"), this.data.looks.counters, (counter) => {
      this.counter = counter;
      choose();
    });
    byId("counters").update(this.counter);
    this.chart = new Chart(byId("chart"), 380, () => {
      const rows = this.record.strategies.filter((strategy) => strategy.counts[this.counter]);
      return {
        data: [this.record.counted_intervals, ...rows.map((strategy) => strategy.counts[this.counter].map((value) => (value > 0 ? value : null)))],
        series: rows.map((strategy) => ({
          label: strategy.name, stroke: colourOf(strategy.name), dash: dashOf(strategy.name), show: this.data.looks.first.includes(strategy.name),
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
    show(data, this.data);
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
    const key = element("p"), { looks } = this.data, { stages } = looks;
    for (const [, title, colour] of stages) {
      const item = element("span", undefined, "key"), swatch = element("i");
      swatch.style.background = colour;
      item.append(swatch, title);
      key.append(item);
    }
    box.append(key);
    this.data.records.forEach((record, n) => {
      const rows = record.strategies.filter((strategy) => strategy.stages && looks.first.includes(strategy.name));
      if (rows.length === 0) return;
      const details = element("details"), bars = element("div", undefined, "bars");
      details.open = n === 0;
      details.append(element("summary", this.nameOf(record)), bars);
      const total = (strategy) => stages.reduce((sum, [stage]) => sum + (strategy.stages[stage] || 0), 0);
      const most = Math.max(...rows.map(total));
      for (const strategy of rows) {
        const bar = element("span", undefined, "bar");
        for (const [stage, title, colour] of stages) {
          if (!strategy.stages[stage]) continue;
          const piece = element("i");
          piece.style.width = `${(100 * strategy.stages[stage]) / most}%`;
          piece.style.background = colour;
          piece.title = `${title}: ${number(strategy.stages[stage])} ms`;
          bar.append(piece);
        }
        bars.append(element("span", strategy.name), bar, element("span", `${number(total(strategy))} ms${strategy.marked ? "*" : ""}`));
      }
      box.append(details);
    });
    const marked = this.data.records.some((record) => record.strategies.some((strategy) => strategy.stages && strategy.marked));
    this.source("stage-source", `Means over the timed intervals, the median over the repetitions. ${marked ? `${this.data.tables.mark_note}. ` : ""}`);
  }

  // The paper's tables in the paper's shape, the times of all strategies, and folded away every figure of every table.
  tables() {
    const list = byId("table-list"), { shaped, tables, mark_note: note } = this.data.tables;
    for (const table of shaped) if (table.title) list.append(shapedTable(table));
    const every = element("details");
    every.append(element("summary", "Every figure, with its 95 % interval"));
    for (const table of tables) {
      const titles = table.rows.flatMap((row, n) => (n ? [] : row.cells.map((cell, i) => [i, cell])));
      const rows = titles.filter(([i]) => table.rows.some((row) => row.cells[i].measured !== null)).map(([i, { title, unit, pipeline }]) => [
        title + (unit ? `, ${unit}` : "") + (this.bothPipelines && pipeline && pipeline !== "both" ? `, pipeline ${pipeline}` : ""),
        ...table.rows.map((row) => {
          const cell = row.cells[i], td = element("td", cell.text || "–");
          if (cell.published !== null) td.append(element("small", `published ${cell.published}`));
          return td;
        })]);
      if (rows.length === 0) continue;
      const details = element("details"), wide = element("div", undefined, "wide");
      wide.append(tableOf(["", ...table.rows.map((row) => row.scene)], rows));
      details.append(element("summary", table.title), wide);
      every.append(details);
    }
    const marked = tables.some((table) => table.rows.some((row) => row.cells.some((cell) => cell.marked)));
    if (marked) every.append(element("p", note, "hint"));
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
      for (const one of figures) details.append(element("div", `${one.holds ? "✔" : "✖"} ${one.scene}: ${one.title} ${one.text}${one.today_text ? ` (${one.today_text} with this project's code)` : ""}`));
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
