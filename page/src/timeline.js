// The bar under the slider: one column for each interval, as high as there are contacts (on a logarithmic scale), with the worst
// moments marked, and a line for the depth.
import { truthsOf } from "./moments.js";
import { ORANGE, PINK, RED, SKY, YELLOW } from "./palette.js";
import { CLOSE, lengthText, many, momentOf } from "./words.js";

export class Timeline {
  constructor(canvas, recording, seek) {
    this.canvas = canvas;
    this.recording = recording;
    const toFrame = (event) => {
      const box = canvas.getBoundingClientRect();
      return Math.min(1, Math.max(0, (event.clientX - box.left) / box.width)) * recording.intervals;
    };
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      seek(toFrame(event));
    });
    canvas.addEventListener("pointermove", (event) => {
      if (event.buttons & 1) seek(toFrame(event));
    });
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  // Where the marks stand: where the deepest places are deepest, or else in the middle of the intervals in which most touches.
  static worst({ events }, strategy, most = 3) {
    if (events.length > 0) return events.slice(0, most).map(({ deepest, time }) => deepest + time);
    const rank = Array.from(strategy.verdict, (_, i) => i).filter((i) => strategy.contacts[i] || strategy.start_pairs[i]);
    rank.sort((a, b) => strategy.start_pairs[b] - strategy.start_pairs[a] || strategy.contacts[b] - strategy.contacts[a] || a - b);
    const chosen = [];
    for (const i of rank)  // neighbours of a moment say the same as the moment
      if (chosen.length < most && chosen.every((other) => Math.abs(other - i) > Math.max(2, strategy.verdict.length / 25))) chosen.push(i);
    return chosen.map((i) => i + 0.5);
  }

  show(strategy, position) {
    this.strategy = strategy;
    this.position = position;
    this.draw();
  }

  // A line that is as high as what lies deepest in another piece of the surface at each start; folds at joints only where there is
  // nothing else.
  drawDepth(context, x, top, bottom, colour) {
    const { events, intervals } = this.recording, depth = new Float64Array(intervals), others = events.filter(({ atJoint }) => !atJoint);
    for (const { first, depths } of others.length > 0 ? others : events) depths.forEach((d, i) => { depth[first + i] = Math.max(depth[first + i], d); });
    const most = depth.reduce((a, b) => Math.max(a, b), 0);
    if (most === 0) return;
    this.label(context, lengthText(this.recording, most) + " deep", 0, top, colour);
    context.strokeStyle = colour;
    context.lineWidth = 1.5;
    context.beginPath();
    depth.forEach((d, i) => context.lineTo(x(i), bottom - (d / most) * (bottom - top)));
    context.stroke();
  }

  // What the top of the columns or of the line stands for, in whichever upper corner: `side` is 0 on the left, 1 on the right.
  label(context, text, side, top, colour) {
    const { width } = this.canvas.getBoundingClientRect(), long = context.measureText(text).width;
    context.globalAlpha = 0.8;
    context.fillStyle = getComputedStyle(document.documentElement).getPropertyValue("--panel").trim();
    context.fillRect(side * (width - long - 6), top - 13, long + 6, 12);
    context.globalAlpha = 1;
    context.fillStyle = colour;
    context.fillText(text, side * (width - long - 6) + 3, top - 3);
  }

  labelOf(position) {
    const { frame, seconds } = momentOf(this.recording, position);
    return seconds === null ? String(Math.round(frame)) : `${Math.round(frame)} · ${seconds.toFixed(2)} s`;
  }

  draw() {
    const { canvas, strategy, recording } = this;
    if (!strategy || !canvas.clientWidth) return;
    const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const context = canvas.getContext("2d");
    context.scale(ratio, ratio);
    const style = getComputedStyle(document.documentElement), colour = (name) => style.getPropertyValue(name).trim();
    const top = 24, bottom = height - 16, n = recording.intervals;
    const x = (frame) => (frame / n) * width;
    context.fillStyle = colour("--clear");
    context.globalAlpha = 0.45;
    context.fillRect(0, bottom - 3, width, 3);
    context.globalAlpha = 1;
    const amount = (i) => Math.log1p(strategy.contacts[i] + strategy.start_pairs[i]);
    let most = 1;
    for (let i = 0; i < n; ++i) most = Math.max(most, amount(i));
    for (let i = 0; i < n; ++i) {
      const verdict = strategy.verdict[i];
      if (verdict === 0) continue;
      context.fillStyle = verdict === 2 ? RED : verdict === 1 ? ORANGE : verdict === CLOSE ? SKY : YELLOW;
      const h = Math.max(4, (amount(i) / most) * (bottom - top));
      context.fillRect(x(i), bottom - h, Math.max(1.5, x(i + 1) - x(i) - 0.3), h);
    }
    context.fillStyle = PINK;
    for (const { interval, truth } of truthsOf(recording)) context.fillRect(x(interval + truth.at) - 2, top, 4, bottom - top);
    context.font = "11px system-ui, sans-serif";
    const count = strategy.verdict.reduce((a, _, i) => Math.max(a, strategy.contacts[i] + strategy.start_pairs[i]), 0);
    const crosses = strategy.start_pairs.some((pairs) => pairs > 0);
    if (count > 0) this.label(context, many(count, strategy.close ? "close pair" : "contact") + (crosses ? " and crossings" : ""), 1, top, colour("--text"));
    this.drawDepth(context, x, top, bottom, colour("--text"));
    context.fillStyle = colour("--text");
    for (const position of Timeline.worst(recording, strategy)) {
      const at = x(position);
      context.beginPath();
      context.moveTo(at - 5, 1);
      context.lineTo(at + 5, 1);
      context.lineTo(at, 9);
      context.fill();
    }
    context.fillStyle = colour("--soft");
    const step = niceStep(n, width / 85);
    let free = 0;  // where the next label may begin
    for (let f = 0; f <= n; f += step) {
      context.fillRect(Math.min(width - 1, x(f)), bottom, 1, 4);
      const text = this.labelOf(f), long = context.measureText(text).width;
      const left = Math.min(width - long, Math.max(0, x(f) - long / 2));
      if (left < free) continue;
      context.fillText(text, left, height - 2);
      free = left + long + 8;
    }
    context.fillStyle = colour("--text");
    context.fillRect(x(this.position) - 1, 0, 2, bottom);
  }
}

function niceStep(length, most) {
  const least = length / Math.max(1, most);
  for (let power = 1; ; power *= 10)
    for (const m of [1, 2, 5]) if (m * power >= least) return m * power;
}
