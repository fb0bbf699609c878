// Line and point charts of the report (uPlot), in colours of the page, redrawn when the page turns dark or changes its width.
import uPlot from "uplot";
import { isDark } from "./dom.js";
import { GREY } from "./palette.js";
import { number } from "./words.js";

// The looks of strategies and elementary tests (bench/tables/looks.json), which the report has in its document.
let looks = { strategies: {}, tests: {} };
export const setLooks = (found) => { looks = found; };

const FIRST = " --first";
const baseOf = (name) => name.split("@")[0].replace(FIRST, "");

// The text of a value; none where there is no value.
export const textOf = (value, text = number) => (value === null || value === undefined ? "" : text(value));

// Black becomes white on a dark page.
const seen = (colour) => (colour === "#000000" && isDark() ? "#ffffff" : colour);

export const colourOf = (name) => seen(looks.strategies[baseOf(name)]?.colour ?? looks.tests[baseOf(name)] ?? GREY);

// Dashes are given in widths of the line, which is 1.6 pixels wide.
export const dashOf = (name) => (name.endsWith(FIRST) ? [1, 1.65] : looks.strategies[baseOf(name)]?.dash ?? []).map((part) => 1.6 * part);

const charts = [];
export const redrawCharts = () => charts.forEach((chart) => chart.draw());

export const LOG = 3, LINEAR = 1;  // what uPlot calls the distributions of a scale

// A chart in a box. `describe` returns what to draw: {data, series, x, y, hooks}; x and y are {label, scale, values,
// range}, and x.name gives the text of a value in the legend.
// Arrow keys move along the chart while it has the focus.
export class Chart {
  constructor(box, height, describe) {
    this.box = box;
    this.height = height;
    this.describe = describe;
    box.tabIndex = 0;
    box.addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(() => {
      if (this.plot && this.plot.width !== box.clientWidth) this.plot.setSize({ width: box.clientWidth, height });
    }).observe(box);
    charts.push(this);
    this.draw();
  }

  draw() {
    const { data, series, x, y, hooks } = this.describe();
    const style = getComputedStyle(document.documentElement), line = style.getPropertyValue("--line");
    const axis = ({ label, scale, values }) => {
      const isDecade = (tick) => Math.abs(Math.log10(tick) - Math.round(Math.log10(tick))) < 1e-9;
      const decades = (_, ticks) => {
        const some = ticks.filter(isDecade).length > 1;  // a scale within one decade names all that it marks
        return ticks.map((tick) => (!some || isDecade(tick) ? tick : null));
      };
      const filter = scale === LOG ? { filter: decades } : {};
      return {
        label, labelSize: 18, stroke: style.getPropertyValue("--soft"), grid: { stroke: line, width: 1, ...filter }, ticks: { stroke: line, ...filter },
        ...filter, values: values || ((_, ticks) => ticks.map((tick) => textOf(tick))),
      };
    };
    if (this.plot) this.plot.destroy();
    this.plot = new uPlot({
      width: this.box.clientWidth || 900, height: this.height, hooks,
      scales: { x: { time: false, distr: x.scale, range: x.range }, y: { distr: y.scale, range: y.range } },
      axes: [axis(x), { ...axis(y), size: 78 }],
      series: [{ label: x.label, value: (_, value) => textOf(value, x.name) }, ...series.map((one) => ({
        width: 1.6, points: { show: false }, value: (_, value) => textOf(value), ...one,
      }))],
    }, data, this.box);
  }

  key(event) {
    const way = { ArrowRight: 1, ArrowLeft: -1 }[event.key], { plot } = this;
    if (!way || !plot) return;
    event.preventDefault();
    const xs = plot.data[0], at = Math.min(xs.length - 1, Math.max(0, (plot.cursor.idx ?? -way) + way));
    plot.setCursor({ left: plot.valToPos(xs[at], "x"), top: plot.over.clientHeight / 2 });
  }
}

// Data of uPlot from points {x, y} of several series: one list of all x, and the y of each series there, or null.
export function aligned(series) {
  const xs = [...new Set(series.flatMap((points) => points.map(({ x }) => x)))].sort((a, b) => a - b);
  return [xs, ...series.map((points) => {
    const at = new Map(points.map(({ x, y }) => [x, y]));
    return xs.map((x) => at.get(x) ?? null);
  })];
}
