// The parts of the report about studies of their own: accuracy against time, growth, and history.
import { aligned, Chart, colourOf, dashOf, LINEAR, LOG, textOf } from "./charts.js";
import { byId, element, radios } from "./dom.js";
import { GREY } from "./palette.js";
import { tableOf } from "./tables.js";
import { number } from "./words.js";

// A thickness may be 0, which no logarithm has.
const scaleOf = (study) => (study === "thickness" ? LINEAR : LOG);
const distinct = (values) => [...new Set(values)];

// Joins points that lie between gaps of other series.
const SPAN = { spanGaps: true };

export function showAccuracy(study, { looks }) {
  const titles = Object.fromEntries(looks.groups);
  const sumsOf = (name) => Object.entries(study.data[`group ${name}`] || {}).map(([row, sum]) => ({ group: name, row, ...sum }));
  const points = Object.keys(titles).flatMap(sumsOf).filter((point) => point.ns), groups = distinct(points.map((point) => point.group));
  let group = groups[0];
  const wrong = (point) => (point.lost + point.invented + point.undecided) / point.queries;
  const rows = () => points.filter((point) => point.group === group);
  // A share of nothing is drawn on a line of its own, below all others.
  const floor = () => Math.min(...rows().map((point) => wrong(point) || 1 / point.queries)) / 5;
  const beaten = (point) => rows().some((other) => (other.ns < point.ns && wrong(other) <= wrong(point)) || (other.ns <= point.ns && wrong(other) < wrong(point)));
  const chart = new Chart(byId("accuracy-chart"), 360, () => {
    const place = (point) => ({ x: point.ns, y: Math.max(wrong(point), floor()) }), families = distinct(rows().map((point) => point.row.split("@")[0]));
    const kinds = families.flatMap((name) => [false, true].map((loses) => ({
      name, loses, points: rows().filter((point) => point.row.split("@")[0] === name && point.lost > 0 === loses),
    }))).filter((kind) => kind.points.length > 0);
    const front = rows().filter((point) => !beaten(point)).sort((a, b) => a.ns - b.ns);
    return {
      data: aligned([front.map(place), ...kinds.map((kind) => kind.points.map(place))]),
      series: [{ label: "no other is faster and more often right", stroke: GREY, width: 5, ...SPAN }, ...kinds.map(({ name, loses }) => ({
        label: loses ? `${name}, loses contacts` : name, stroke: colourOf(name), width: 0, paths: () => null,
        points: { show: true, size: 10, width: 2, stroke: colourOf(name), fill: loses ? getComputedStyle(document.documentElement).getPropertyValue("--panel") : colourOf(name) },
      }))],
      x: { label: "nanoseconds a query", scale: LOG },
      y: { label: "share wrong or undecided", scale: LOG, values: (_, ticks) => ticks.map((tick) => textOf(tick, (share) => (share < 1.5 * floor() ? "none" : share.toExponential(0)))) },
    };
  });
  const list = () => byId("accuracy-list").replaceChildren(tableOf(["test", "ns a query", "queries", "contacts lost", "invented", "undecided"],
    rows().sort((a, b) => wrong(a) - wrong(b) || a.ns - b.ns).map((point) => [point.row, number(point.ns), ...[point.queries, point.lost, point.invented, point.undecided].map((n) => n.toLocaleString("en"))])));
  radios(byId("accuracy-groups"), groups.map((name) => [name, titles[name]]), (name) => {
    group = name;
    choose();
  });
  const choose = () => {
    byId("accuracy-groups").update(group);
    chart.draw();
    list();
  };
  choose();
}

export function showGrowth(study, { looks, tables }) {
  const { points, fits } = study.data, titles = Object.fromEntries(looks.studies), studies = Object.keys(titles).filter((name) => distinct(points.filter((point) => point.study === name).map((point) => point.size)).length > 1);
  let name = studies[0], scene = null;
  const select = byId("growth-scene");
  const rows = () => points.filter((point) => point.study === name && point.scene === scene);
  const chart = new Chart(byId("growth-chart"), 360, () => {
    const strategies = distinct(rows().map((point) => point.strategy)), mark = (strategy) => (rows().some((point) => point.strategy === strategy && point.marked) ? "*" : "");
    return {
      data: aligned(strategies.map((strategy) => rows().filter((point) => point.strategy === strategy).map((point) => ({ x: point.size, y: point.ms })))),
      series: strategies.map((strategy) => {
        const fit = fits.find((one) => one.study === name && one.scene === scene && one.strategy === strategy);
        return { label: fit ? `${strategy}${mark(strategy)} (grows as the power ${fit.exponent.toFixed(2)})` : strategy + mark(strategy), stroke: colourOf(strategy), dash: dashOf(strategy), points: { show: true, size: 6 }, ...SPAN };
      }),
      x: { label: titles[name], scale: scaleOf(name) },
      y: { label: "ms a query", scale: LOG },
    };
  });
  const list = () => {
    const strategies = distinct(rows().map((point) => point.strategy)), sizes = distinct(rows().map((point) => point.size));
    const cell = (size, strategy) => rows().find((point) => point.size === size && point.strategy === strategy);
    const shown = (point) => (point ? number(point.ms) + (point.marked ? "*" : "") : "–");
    byId("growth-list").replaceChildren(tableOf([titles[name], ...strategies.map((strategy) => `${strategy}, ms`)],
      sizes.map((size) => [size.toLocaleString("en"), ...strategies.map((strategy) => shown(cell(size, strategy)))])));
    byId("growth-note").textContent = rows().some((point) => point.marked) ? tables.mark_note : "";
  };
  const draw = () => {
    chart.draw();
    list();
  };
  const choose = () => {
    const scenes = distinct(points.filter((point) => point.study === name).map((point) => point.scene));
    if (!scenes.includes(scene)) [scene] = scenes;
    select.replaceChildren(...scenes.map((one) => new Option(one, one, false, one === scene)));
    byId("growth-studies").update(name);
    draw();
  };
  radios(byId("growth-studies"), studies.map((one) => [one, titles[one].split(",")[0]]), (chosen) => {
    name = chosen;
    choose();
  });
  select.addEventListener("change", () => {
    scene = select.value;
    draw();
  });
  choose();
}

// A scene, and what was timed of it. Only speedups of one measurement can be held against each other.
const measurementOf = ({ scene, over, measured }) => `${scene}, over ${over}: ${measured.timed_intervals.length} intervals`;

// How many times faster a row was at a commit, with the mark that says whether it answered everything.
const marked = ({ median, mark }) => number(median) + mark;

export function showHistory(history) {
  const places = distinct(history.courses.map(measurementOf)), select = byId("history-scene");
  select.append(...places.map((place) => new Option(place, place)));
  const courses = () => history.courses.filter((course) => measurementOf(course) === select.value);
  const commits = () => {
    const dates = new Map(courses().flatMap((course) => course.points.map((point) => [point.commit, point.committed])));
    return [...dates.keys()].sort((a, b) => new Date(dates.get(a)) - new Date(dates.get(b)));
  };
  const percent = (ratio) => `${ratio > 1 ? "+" : ""}${(100 * (ratio - 1)).toFixed(0)} %`;
  const chart = new Chart(byId("history-chart"), 320, () => {
    const order = commits(), shown = courses(), nameOf = (i) => (order[i] ? order[i].slice(0, 7) : "");
    return {
      data: aligned(shown.map((course) => course.points.map((point) => ({ x: order.indexOf(point.commit), y: point.median })))),
      series: shown.map((course) => ({ label: course.row + distinct(course.points.map((point) => point.mark)).join(""), stroke: colourOf(course.row), dash: dashOf(course.row), points: { show: true, size: 6 }, ...SPAN })),
      x: { label: "commit", scale: LINEAR, range: [-0.4, order.length - 0.6], name: nameOf, values: (_, ticks) => ticks.map((tick) => (Number.isInteger(tick) ? nameOf(tick) : "")) },
      y: { label: "times faster", scale: LOG },
      hooks: { draw: [(plot) => shown.forEach((course) => course.changes.forEach((change) => markChange(plot, order.indexOf(change.commit), course.points[change.first].median, percent(change.ratio), colourOf(course.row))))] },
    };
  });
  const list = () => {
    const rows = courses().flatMap((course) => course.changes.map((change) => [course.row, change.commit.slice(0, 10), marked(course.points[change.first - 1]), marked(course.points[change.first]), percent(change.ratio)]));
    byId("history-list").replaceChildren(rows.length > 0 ? tableOf(["row", "first commit of the new level", "times faster before", "at it", "level"], rows) : element("p", "No change of level was found."), element("p", history.note));
  };
  select.addEventListener("change", () => {
    chart.draw();
    list();
  });
  list();
}

// An arrow and the change of level at the first commit of a new level.
function markChange(plot, x, y, text, colour) {
  const left = plot.valToPos(x, "x", true), top = plot.valToPos(y, "y", true), { ctx } = plot, unit = devicePixelRatio;
  ctx.save();
  ctx.fillStyle = ctx.strokeStyle = colour;
  ctx.lineWidth = 1.5 * unit;
  ctx.font = `${11 * unit}px system-ui, sans-serif`;
  ctx.textAlign = "center";
  ctx.beginPath();
  ctx.moveTo(left, top - 22 * unit);
  ctx.lineTo(left, top - 7 * unit);
  ctx.moveTo(left - 4 * unit, top - 12 * unit);
  ctx.lineTo(left, top - 6 * unit);
  ctx.lineTo(left + 4 * unit, top - 12 * unit);
  ctx.stroke();
  ctx.fillText(text, left, top - 26 * unit);
  ctx.restore();
}
