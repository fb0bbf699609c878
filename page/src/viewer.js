// The viewer: what is shown of a recording, and when. Its parts: data (what the page holds), stage and surface (drawing), painter (colours),
// marker (points and lines), framing (camera), pointer (what is under it), list and timeline, captions (words), controls (buttons and keys).
import { Captions } from "./captions.js";
import { makeControls } from "./controls.js";
import { byId, prefersDark, setDark } from "./dom.js";
import { Framing } from "./framing.js";
import { MomentList } from "./list.js";
import { Marker } from "./marker.js";
import { momentsOf, openingOf, timeOf } from "./moments.js";
import { modesOf, Painter } from "./painter.js";
import { Pointer } from "./pointer.js";
import { Stage } from "./stage.js";
import { Timeline } from "./timeline.js";
import { momentOf, momentText } from "./words.js";

export class Viewer {
  constructor(recording) {
    this.recording = recording;
    this.ended = new AbortController();  // takes back what listens to the whole page
    this.strategy = 0;
    this.mode = "verdict";
    this.modes = modesOf(recording);
    this.together = false;
    this.bonesShown = false;
    this.observersShown = false;
    this.normalsShown = true;
    this.playing = false;
    this.position = 0;  // in frames
    this.pinned = null;  // the moment of a chosen contact: {interval, t, predicted}, and `at`, when that is in the interval
    this.chosen = null;  // the chosen moment (moments.js), or null
    this.upName = recording.header.up.axis;
    this.stage = new Stage(byId("canvas"), recording, this.upName, () => this.placeInset());
    this.stage.beforeDraw = (now) => this.tick(now);
    this.stage.insetBox = () => (this.together ? null : this.insetBox());
    this.stage.onResize = () => this.namePanes();
    this.painter = new Painter(recording);
    this.marker = new Marker(recording, this.stage, this.painter);
    this.framing = new Framing(recording, this.stage, this.marker);
    this.captions = new Captions(recording);
    this.pointer = new Pointer(recording, this.stage, this.painter, byId("pointed"), () => ({ interval: this.interval(), position: this.position }), this.ended.signal);
    this.list = new MomentList(recording, byId("list"), byId("list-title"), (moment) => this.select(moment, true));
    this.timeline = new Timeline(byId("timeline"), recording, (position) => this.seek(position));
    makeControls(this);
    this.setTheme(prefersDark());
    this.stage.resize();
    this.choose();
    this.open();
    this.listenToReport();
  }

  // Gives back what the page holds for it, before another viewer takes its place.
  end() {
    this.playing = false;
    this.ended.abort();
    this.stage.end();
  }

  get active() { return this.recording.strategies[this.strategy]; }
  get moments() { return momentsOf(this.recording, this.active); }

  // Which strategies have a pane.
  get shown() {
    return this.together ? this.recording.strategies.map((_, i) => i) : [this.strategy];
  }

  // --- Moments -----------------------------------------------------------------------------------------------------------

  interval() { return Math.min(this.recording.intervals - 1, Math.floor(this.pinned ? this.pinned.interval : this.position)); }

  momentAt(interval) { return this.moments.find((moment) => moment.interval === interval) || null; }

  pointOf(moment) { return this.marker.pointOf(this.active, moment); }

  open() {
    if (this.openLinked()) return;
    const moment = openingOf(this.recording, this.active);
    if (moment) this.select(moment, false);
    else {
      this.seek(Math.round(this.recording.intervals / 3));  // in motion, and not at rest
      this.showWhole(false);
    }
  }

  // Opens at the interval that the address names, as in hand.html#interval=37. Returns whether it names one.
  openLinked() {
    const interval = Number(/[#&]interval=(\d+)/.exec(window.location.hash)?.[1] ?? NaN) - this.recording.clip.first_interval;
    if (!(interval >= 0 && interval < this.recording.intervals)) return false;
    this.showInterval(interval);
    return true;
  }

  showInterval(interval) {
    const moment = this.momentAt(interval);
    if (moment) this.select(moment, false);
    else {
      this.seek(interval);
      this.showWhole(false);
    }
  }

  // A report (report.js) that holds this page in a frame tells which interval is under the pointer.
  listenToReport() {
    const { signal } = this.ended;
    window.addEventListener("hashchange", () => this.openLinked(), { signal });
    window.addEventListener("message", ({ data }) => {
      const interval = Number(data?.interval) - this.recording.clip.first_interval;
      if (Number.isInteger(interval) && interval >= 0 && interval < this.recording.intervals && interval !== this.interval()) this.seek(interval);
    }, { signal });
  }

  stepMoment(way) {
    const here = this.interval();
    const next = way > 0 ? this.moments.find((m) => m.interval > here) : this.moments.findLast((m) => m.interval < here);
    if (next) this.select(next, true);
  }

  select(moment, smooth) {
    this.setPlaying(false);
    const t = timeOf(this.active, moment);
    this.chosen = moment;
    if (moment.event) this.mode = "depth";
    // The other end of an interval of the true motion is a pose within it.
    this.pinned = { interval: moment.interval, t: moment.truth ? 1 : t, at: t,
      predicted: moment.truth ? true : !moment.event && !this.recording.truths && this.recording.endOfInterval.has(moment.interval) };
    this.position = moment.interval + t;
    this.refresh();
    this.showChosen(smooth);
  }

  seek(position) {
    this.pinned = null;
    this.position = Math.min(this.recording.intervals, Math.max(0, position));
    if (!this.chosen || this.chosen.interval !== this.interval()) this.chosen = this.momentAt(this.interval());
    this.refresh();
  }

  setPlaying(playing) {
    this.playing = playing;
    this.lastTick = null;
    byId("play").classList.toggle("playing", playing);
    byId("play").setAttribute("aria-label", playing ? "Pause" : "Play");
    if (playing) {
      if (this.position >= this.recording.intervals) this.position = 0;
      this.stage.requestDraw();
    }
  }

  tick(now) {
    if (!this.playing) return;
    if (this.lastTick !== null) {
      const frames = ((now - this.lastTick) / 1000) * this.recording.clip.fps * Number(byId("speed").value);
      const next = this.position + frames;
      this.seek(next >= this.recording.intervals ? 0 : next);
    }
    this.lastTick = now;
    this.stage.requestDraw();
  }

  // --- Choices -----------------------------------------------------------------------------------------------------------

  setStrategy(index) {
    this.strategy = index;
    this.choose();
    this.chosen = this.momentAt(this.interval());
    this.refresh();
  }

  setTogether(together) {
    this.together = together;
    byId("stage").classList.toggle("together", together);
    this.choose();
  }

  setMode(mode) {
    this.mode = mode;
    this.refresh();
  }

  setUp(name) {
    this.upName = name;
    this.stage.setUp(name);
    this.showWhole(false);
  }

  setTheme(dark) {
    setDark(dark);
    this.dark = dark;
    for (const look of this.stage.looks) look.material.uniforms.dark.value = dark ? 1 : 0;
    this.stage.insetColour.set(getComputedStyle(document.documentElement).getPropertyValue("--panel").trim());
    this.timeline.draw();
    this.stage.requestDraw();
  }

  // Brings everything that goes by the chosen strategies up to date.
  choose() {
    this.captions.sayVerdict(this.active);
    this.stage.setLooks(this.shown.length);
    for (const look of this.stage.looks) {
      look.key = null;
      look.material.uniforms.dark.value = this.dark ? 1 : 0;
    }
    this.namePanes();
    this.refresh();
  }

  namePanes() {
    this.captions.namePanes(this.stage.panes, this.shown.map((s) => this.recording.strategies[s]));
  }

  // --- What is shown -----------------------------------------------------------------------------------------------------

  refresh() {
    const { stage, active, mode } = this, interval = this.interval();
    const pose = this.pinned || { interval, t: this.position - interval, predicted: false };
    const key = `${pose.interval} ${pose.t} ${pose.predicted}`;
    if (key !== this.poseKey) {
      stage.surface.pose(pose.interval, pose.t, pose.predicted);
      this.poseKey = key;
      stage.whole = stage.surface.bounds();
      stage.meanEdge = stage.surface.meanEdge();
      this.framing.follow();
    }
    stage.setBones(this.bonesShown, pose.interval, pose.at ?? pose.t);
    const chosen = this.chosen && this.chosen.interval === interval ? this.chosen : null;
    this.shown.forEach((s, i) => {
      const look = stage.looks[i];
      this.painter.paint(look, s, mode, interval, chosen);
      this.marker.mark(look.marks, s, interval, s === this.strategy ? chosen : null, this.normalsShown, mode);
      this.marker.markObservers(look.marks, s, mode, interval, pose.at ?? pose.t, this.observersShown);
    });
    stage.setInsetPoint(this.pointOf(this.chosen));
    for (const box of ["modes", "engine-modes"]) byId(box).update(mode);
    byId("strategies").update(String(this.strategy));
    byId("slider").value = String(this.position);
    const { frame, seconds } = momentOf(this.recording, this.position);
    byId("clock").textContent = `frame ${frame.toFixed(2)}` + (seconds === null ? "" : ` · ${seconds.toFixed(3)} s`);
    byId("slider").setAttribute("aria-valuetext", momentText(this.recording, this.position));
    this.timeline.show(active, this.position);
    this.captions.sayInterval(active, interval, pose.predicted);
    this.captions.sayLegend(active, interval, mode, chosen, this.observersShown, (number) => this.painter.placeColour(number));
    this.captions.sayPanes(this.shown.map((s) => this.recording.strategies[s]), interval);
    this.list.show(active, this.chosen, this.playing);
    stage.requestDraw();
  }

  // Where nothing touches, no moment matters more than another: all of the clip is shown, from where the camera stays.
  showWhole(smooth) {
    if (this.moments.length === 0 && !this.together) return this.framing.showAllTimes(smooth);
    this.framing.showWhole(smooth, this.together ? 1.3 : 1.06);  // side by side, names need room
  }

  showChosen(smooth) {
    const point = this.pointOf(this.chosen);
    if (point) this.framing.showMoment(this.active, this.chosen, point, smooth);
    else this.showWhole(smooth);
  }

  // Where the small view of the whole surface lies on the stage, or null while it is hidden.
  insetBox() {
    const stage = byId("stage").getBoundingClientRect(), box = byId("inset").getBoundingClientRect();
    if (!box.width) {
      byId("inset").hidden = false;
      return null;
    }
    return { x: box.left - stage.left, y: box.top - stage.top, w: box.width, h: box.height };
  }

  placeInset() {
    const hidden = !this.stage.insetShown || this.together, inset = byId("inset");
    if (inset.hidden === hidden) return;
    inset.hidden = hidden;
    if (!hidden) this.stage.requestDraw();
  }
}

// Says in the viewer's place why a recording cannot be shown.
export function fail(error) {
  document.body.classList.add("failed");
  byId("verdict").textContent = "This page cannot be shown.";
  byId("details").textContent = error instanceof RangeError
    ? "The recording is larger than this browser can hold; write it again with fewer frames: cscd view INPUT --frames A:B"
    : error instanceof SyntaxError ? "The page is damaged. Write it again with cscd view."
    : String(error.message || error);
  console.warn(error);
}

// Throws where the browser lacks what a viewer needs.
export function requireBrowser() {
  if (!document.createElement("canvas").getContext("webgl2")) throw new Error("This browser has no WebGL 2, which draws the surface; switch it on, or use another browser.");
  if (typeof DecompressionStream === "undefined") throw new Error("This browser cannot unpack what the page holds; use one from 2023 or later.");
}
