import * as THREE from "three";
import { crossingSegment } from "./crossing.js";
import { bitOf, loadRecording } from "./data.js";
import { BLUE, CLUSTERS, colourGroups, edgeNeighbours, GREY, groupNeighbours, ORANGE, PINK, RED, rgb, SKIN, YELLOW } from "./palette.js";
import { Stage } from "./stage.js";
import { Timeline } from "./timeline.js";
import { both, detailSentence, many, momentOf, momentText, VERDICTS, verdictSentence } from "./words.js";

const byId = (id) => document.getElementById(id);
const MOST_ROWS = 1500;  // of the list: browsers grow slow with more
const MOST_NORMALS = 40;  // beside that of the chosen contact
const MOST_LINES = 400;  // contacts whose features are outlined beside the chosen one

function element(tag, text, className) {
  const made = document.createElement(tag);
  if (text !== undefined) made.textContent = text;
  if (className) made.className = className;
  return made;
}

class Viewer {
  constructor(recording) {
    this.recording = recording;
    this.neighbours = edgeNeighbours(recording.corners, recording.clip.vertices);
    this.strategy = 0;
    this.mode = "verdict";
    this.together = false;
    this.bonesShown = false;
    this.normalsShown = true;
    this.playing = false;
    this.position = 0;  // in frames
    this.pinned = null;  // the moment of a chosen contact: {interval, t, predicted}
    this.anchor = null;
    this.chosen = null;  // the chosen contact or crossing: {interval, contact} or {interval, pair}
    this.modes = this.possibleModes();
    this.stage = new Stage(byId("canvas"), recording, upAxis(recording), () => this.placeInset());
    this.stage.beforeDraw = (now) => this.tick(now);
    this.stage.insetBox = () => (this.together ? null : this.insetBox());
    this.stage.onResize = () => this.namePanes();
    this.timeline = new Timeline(byId("timeline"), recording, (position) => this.seek(position));
    this.timelineLabel = (f) => {
      const { frame, seconds } = momentOf(recording, f);
      return seconds === null ? String(Math.round(frame)) : `${Math.round(frame)} · ${seconds.toFixed(2)} s`;
    };
    this.makeControls();
    this.applyTheme(window.matchMedia("(prefers-color-scheme: dark)").matches);
    this.stage.resize();
    this.choose();
    this.open();
  }

  get active() { return this.recording.strategies[this.strategy]; }

  // Which strategies have a pane.
  get shown() {
    return this.together ? this.recording.strategies.map((_, i) => i) : [this.strategy];
  }

  possibleModes() {
    const { strategies, clip, place, part } = this.recording;
    const clusters = strategies.some((s) => s.has_clusters);
    const modes = [["verdict", "verdict"]];
    if (clusters) modes.push(["atomic", "atomic cluster"], ["cluster", "cluster in force"], ["positive", "orientation"]);
    if (new Set(place).size > 1) modes.push(["place", clip.bones > 0 ? "bone" : "part"]);
    if (clip.bones > 0 && new Set(part).size > 1) modes.push(["part", "part"]);
    modes.push(["often", "how often"]);
    return modes;
  }

  makeControls() {
    const { strategies, clip } = this.recording;
    radios(byId("strategies"), strategies.map((s, i) => [String(i), s.name]), (value) => this.setStrategy(Number(value)));
    byId("strategies-row").hidden = false;
    byId("together-label").hidden = strategies.length < 2;
    byId("together").addEventListener("change", (event) => {
      this.together = event.target.checked;
      byId("stage").classList.toggle("together", this.together);
      this.choose();
    });
    radios(byId("modes"), this.modes, (value) => this.setMode(value));
    const toggle = (name, text, property) => {
      const button = element("button", text);
      button.id = `show-${name}`;
      button.setAttribute("aria-pressed", String(this[property]));
      button.addEventListener("click", () => {
        this[property] = !this[property];
        button.setAttribute("aria-pressed", String(this[property]));
        this.refresh();
      });
      byId("toggles").append(button);
    };
    toggle("normals", "normals", "normalsShown");
    if (clip.bones > 0) toggle("bones", "bones", "bonesShown");
    const up = element("button", "");
    up.id = "up";
    const nameUp = () => { up.textContent = `up: ${this.upName}`; };
    this.upName = upAxis(this.recording);
    nameUp();
    up.addEventListener("click", () => {
      const names = ["x", "y", "z", "-x", "-y", "-z"];
      this.upName = names[(names.indexOf(this.upName) + 1) % 6];
      nameUp();
      this.stage.setUp(this.upName);
      this.showWhole(false);
    });
    byId("toggles").append(up);

    const slider = byId("slider");
    slider.max = String(this.recording.intervals);
    slider.addEventListener("input", () => this.seek(Number(slider.value)));
    byId("play").addEventListener("click", () => this.setPlaying(!this.playing));
    byId("previous").addEventListener("click", () => this.stepMoment(-1));
    byId("next").addEventListener("click", () => this.stepMoment(1));
    byId("whole").addEventListener("click", () => this.showWhole(true));
    byId("inset").addEventListener("click", () => this.showWhole(true));
    byId("closer").addEventListener("click", () => this.showChosen(true));
    byId("theme").addEventListener("click", () => this.applyTheme(!document.documentElement.classList.contains("dark")));
    byId("list").addEventListener("click", (event) => {
      const row = event.target.closest("button");
      if (row && row.moment) this.select(row.moment, true);
    });
    document.addEventListener("keydown", (event) => this.key(event));
  }

  key(event) {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const inField = event.target.matches("select, input[type=checkbox]");
    const onButton = event.target.matches("button");
    const large = event.shiftKey ? 10 : 1;
    const actions = {
      " ": () => this.setPlaying(!this.playing),
      ArrowRight: () => this.seek(Math.floor(this.position + 1e-6) + large),
      ArrowLeft: () => this.seek(Math.ceil(this.position - 1e-6) - large),
      Home: () => this.seek(0),
      End: () => this.seek(this.recording.intervals),
      n: () => this.stepMoment(1),
      p: () => this.stepMoment(-1),
      c: () => this.showChosen(true),
      w: () => this.showWhole(true),
      s: () => this.setStrategy((this.strategy + 1) % this.recording.strategies.length),
      d: () => byId("theme").click(),
    };
    const action = actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    const digit = Number(event.key);
    if (inField || (onButton && event.key === " ")) return;
    if (digit >= 1 && digit <= this.modes.length) this.setMode(this.modes[digit - 1][0]);
    else if (action) {
      event.preventDefault();
      action();
    }
  }

  applyTheme(dark) {
    document.documentElement.classList.toggle("dark", dark);
    this.dark = dark;
    for (const look of this.stage.looks) look.material.uniforms.dark.value = dark ? 1 : 0;
    this.stage.insetColour.set(getComputedStyle(document.documentElement).getPropertyValue("--panel").trim());
    this.timeline.draw();
    this.stage.requestDraw();
  }

  // --- Moments -----------------------------------------------------------------------------------------------------------

  interval() { return Math.min(this.recording.intervals - 1, Math.floor(this.pinned ? this.pinned.interval : this.position)); }

  momentsOf(strategy) {
    if (!strategy.moments) {
      strategy.moments = [];
      for (let i = 0; i < strategy.verdict.length; ++i)
        if (strategy.contacts[i] > 0 || strategy.start_pairs[i] > 0) strategy.moments.push(this.firstOf(strategy, i));
    }
    return strategy.moments;
  }

  // The first thing of an interval: a crossing at its start, or else its earliest contact.
  firstOf(strategy, interval) {
    const pair = strategy.crossingOffset[interval], contact = strategy.contactOffset[interval];
    if (strategy.crossingOffset[interval + 1] > pair) return { interval, pair };
    return { interval, contact: strategy.contactOffset[interval + 1] > contact ? contact : undefined };
  }

  namesOf(strategy, moment) {
    const { texts, place } = this.recording;
    if (moment.pair !== undefined)
      return [0, 1].map((side) => texts[place[strategy.crossing[2 * moment.pair + side]]]);
    if (moment.contact === undefined) return ["the surface", "the surface"];
    return [0, 1].map((side) => texts[strategy.contact_place[2 * moment.contact + side]]);
  }

  timeOf(strategy, moment) {
    return moment.contact === undefined ? 0 : strategy.contact_time[moment.contact] / 65535;
  }

  open() {
    const moments = this.momentsOf(this.active);
    if (moments.length > 0) this.select(moments[0], false);
    else {
      this.seek(Math.round(this.recording.intervals / 3));  // in motion, and not at rest
      this.showWhole(false);
    }
  }

  stepMoment(way) {
    const moments = this.momentsOf(this.active), here = this.interval();
    const next = way > 0 ? moments.find((m) => m.interval > here) : moments.findLast((m) => m.interval < here);
    if (next) this.select(next, true);
  }

  select(moment, smooth) {
    this.setPlaying(false);
    const t = this.timeOf(this.active, moment);
    this.chosen = moment;
    this.pinned = { interval: moment.interval, t, predicted: this.recording.endOfInterval.has(moment.interval) };
    this.position = moment.interval + t;
    this.refresh();
    this.showChosen(smooth);
  }

  seek(position) {
    this.pinned = null;
    this.position = Math.min(this.recording.intervals, Math.max(0, position));
    const interval = this.interval();
    if (!this.chosen || this.chosen.interval !== interval) {
      const moment = this.momentsOf(this.active).find((m) => m.interval === interval);
      this.chosen = moment || null;
    }
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
      let next = this.position + frames;
      if (next >= this.recording.intervals) next = 0;
      this.seek(next);
    }
    this.lastTick = now;
    this.stage.requestDraw();
  }

  // --- What is shown -----------------------------------------------------------------------------------------------------

  setStrategy(index) {
    this.strategy = index;
    this.choose();
    const moment = this.momentsOf(this.active).find((m) => m.interval === this.interval());
    this.chosen = moment || null;
    this.refresh();
  }

  setMode(mode) {
    this.mode = mode;
    this.refresh();
  }

  // Brings everything that goes by the chosen strategies up to date.
  choose() {
    const first = this.momentsOf(this.active)[0];
    let described = null;
    if (first) {
      const [a, b] = this.namesOf(this.active, first);
      described = { position: first.interval + this.timeOf(this.active, first), crossing: first.pair !== undefined, a, b };
    }
    const verdict = byId("verdict"), bad = first !== undefined;
    const { undecided } = this.active.summary;
    verdict.className = bad ? "bad" : undecided > 0 ? "" : "good";
    verdict.replaceChildren(element("span", bad ? "\u2716 " : undecided > 0 ? "? " : "\u2714 ", "mark"),
      document.createTextNode(verdictSentence(this.recording, this.active, described)));
    byId("details").textContent = detailSentence(this.recording, this.active);
    document.title = `${this.recording.header.name}: cscd view`;
    this.stage.setLooks(this.shown.length);
    for (const look of this.stage.looks) {
      look.key = null;
      look.material.uniforms.dark.value = this.dark ? 1 : 0;
    }
    this.namePanes();
    this.listFor = null;
    this.refresh();
  }

  namePanes() {
    const panes = byId("panes");
    panes.replaceChildren();
    if (!this.together) return;
    this.stage.panes.forEach((pane, i) => {
      const strategy = this.recording.strategies[this.shown[i]];
      const box = element("div", undefined, "pane");
      Object.assign(box.style, {
        left: `${pane.x}px`, top: `${pane.y}px`, width: `${pane.w}px`, height: `${pane.h}px`,
        borderLeftWidth: pane.x > 1 ? "1px" : "0", borderTopWidth: pane.y > 1 ? "1px" : "0",
      });
      const name = element("p", strategy.name, "pane-name");
      name.append(element("small", ""));
      box.append(name);
      panes.append(box);
    });
  }

  refresh() {
    const interval = this.interval();
    const pose = this.pinned || { interval, t: this.position - interval, predicted: false };
    const key = `${pose.interval} ${pose.t} ${pose.predicted}`;
    if (key !== this.poseKey) {
      this.stage.surface.pose(pose.interval, pose.t, pose.predicted);
      this.poseKey = key;
      this.stage.whole = this.stage.surface.bounds();
      this.stage.meanEdge = this.stage.surface.meanEdge();
      this.stage.follow(this.anchorPoint());
    }
    this.stage.setBones(this.bonesShown, pose.interval, pose.t);
    this.shown.forEach((s, i) => {
      const strategy = this.recording.strategies[s], look = this.stage.looks[i];
      this.colour(look, strategy, s, interval);
      this.mark(look.marks, strategy, interval, s === this.strategy);
    });
    this.stage.setInsetPoint(this.pointOf(this.chosen));
    byId("modes").update(this.mode);
    byId("strategies").update(String(this.strategy));
    byId("slider").value = String(this.position);
    const { frame, seconds } = momentOf(this.recording, this.position);
    byId("clock").textContent = `frame ${frame.toFixed(2)}` + (seconds === null ? "" : ` · ${seconds.toFixed(3)} s`);
    byId("slider").setAttribute("aria-valuetext", momentText(this.recording, this.position));
    this.timeline.show(this.active, this.position, this.timelineLabel);
    this.say(interval);
    this.fillList();
    this.stage.requestDraw();
  }

  say(interval) {
    const { active } = this;
    const contacts = active.contacts[interval], pairs = active.start_pairs[interval];
    const text = [];
    if (pairs > 0) text.push(`${many(pairs, "pair")} of triangles cross at this start`);
    if (contacts > 0) text.push(`${many(contacts, "contact")} in this interval`);
    if (this.pinned && this.pinned.predicted) text.push("shown: the simulator's step before the contact is resolved");
    byId("moment").textContent = text.join(" · ");
    const legend = byId("legend");
    const item = (colour, what) => {
      const span = element("span"), swatch = element("i");
      swatch.style.background = colour;
      span.append(swatch, what);
      return span;
    };
    const rows = [];
    if (this.mode === "verdict") {
      if (contacts > 0) rows.push(item(ORANGE, "touches"));
      if (pairs > 0) rows.push(item(RED, "crosses"));
      if (contacts === 0 && pairs === 0) rows.push(item(SKIN, `this interval is ${VERDICTS[active.verdict[interval]]}`));
    } else if (this.mode === "positive") rows.push(item(SKIN, "positive: seen from behind throughout the interval"), item(RED, "not positive"));
    else if (this.mode === "often") rows.push(item(SKIN, "never"), item(YELLOW, "once"), item(RED, "most often"));
    else if (this.mode === "atomic" || this.mode === "cluster") {
      const cluster = `one colour for each cluster${active.name.startsWith("drvbc_fast") ? " of the first cover" : ""}`;
      rows.push(element("b", !active.has_clusters ? `${active.name} has no clusters`
        : this.mode === "atomic" ? `${cluster}, as made in advance` : `${cluster} that has one observer in this interval`));
    } else rows.push(element("b", { place: "one colour for each name", part: "one colour for each part" }[this.mode]));
    if (this.chosen && this.chosen.contact !== undefined && this.chosen.interval === interval)
      rows.push(item(BLUE, "first feature, point and normal"), item(PINK, "second feature"));
    legend.replaceChildren(...rows);

    this.shown.forEach((s, i) => {
      const small = byId("panes").children[i]?.querySelector("small");
      if (small) small.textContent = this.paneText(this.recording.strategies[s], interval);
    });
    const facts = [["interval", String(interval + this.recording.clip.first_interval)], ["verdict", VERDICTS[active.verdict[interval]]],
      ["answered by", active.answered_by[active.answerer[interval]] + (active.proven[interval] ? ", proven" : ", not proven")],
      ["triangle pairs left by culling", active.pairs[interval].toLocaleString("en")],
      ["elementary tests", active.tests[interval].toLocaleString("en")]];
    if (active.has_clusters)
      facts.push(["clusters in force", active.clusters[interval].toLocaleString("en")],
        ["positive", `${this.positiveShare(active, interval)} % of triangles`]);
    facts.push(["time of this answer here", `${Number(active.milliseconds[interval].toPrecision(3))} ms, one try`]);
    byId("facts").replaceChildren(...facts.flatMap(([name, value]) => [element("dt", name), element("dd", value)]));
  }

  paneText(strategy, interval) {
    const parts = [`${many(strategy.pairs[interval], "pair")} left by culling`];
    if (strategy.has_clusters) {
      parts.push(many(strategy.clusters[interval], "cluster"));
      parts.push(`${this.positiveShare(strategy, interval)} % positive`);
    }
    return parts.join(" · ");
  }

  positiveShare(strategy, interval) {
    const { triangles } = this.recording.clip;
    strategy.shares ??= new Map();
    if (!strategy.shares.has(interval)) {
      let count = 0;
      for (let t = 0; t < triangles; ++t) count += bitOf(strategy.positive, triangles, interval, t);
      strategy.shares.set(interval, ((100 * count) / triangles).toFixed(1));
    }
    return strategy.shares.get(interval);
  }

  // --- Colours -----------------------------------------------------------------------------------------------------------

  colour(look, strategy, index, interval) {
    const changes = ["verdict", "cluster", "positive"].includes(this.mode);
    const key = `${index} ${this.mode} ${changes ? interval : ""}`;
    if (look.key === key) return;
    look.key = key;
    const { triangles } = this.recording.clip, out = look.colours;
    const set = (t, [r, g, b]) => {
      out[4 * t] = r;
      out[4 * t + 1] = g;
      out[4 * t + 2] = b;
    };
    const skin = rgb(SKIN), paint = CLUSTERS.map((hex) => rgb(hex));
    for (let t = 0; t < triangles; ++t) {
      set(t, skin);
      out[4 * t + 3] = 255;
    }
    look.glow.visible = this.mode === "verdict";
    const setGlowing = (t, colour) => {
      set(t, colour);
      out[4 * t + 3] = 0;
    };
    if (this.mode === "verdict") {
      const touched = rgb(ORANGE), crossed = rgb(RED);
      if (strategy.contacts[interval] > 0)
        for (let t = 0; t < triangles; ++t) if (bitOf(strategy.touched, triangles, interval, t)) setGlowing(t, touched);
      for (let i = 2 * strategy.crossingOffset[interval]; i < 2 * strategy.crossingOffset[interval + 1]; ++i) setGlowing(strategy.crossing[i], crossed);
    } else if (this.mode === "often") {
      const often = this.oftenTouched(strategy), most = Math.max(1, ...often), low = rgb(YELLOW), high = rgb(RED);
      for (let t = 0; t < triangles; ++t)
        if (often[t] > 0) {
          const s = most > 1 ? Math.log(often[t]) / Math.log(most) : 1;
          set(t, low.map((x, i) => x + s * (high[i] - x)));
        }
    } else if (this.mode === "place" || this.mode === "part") {
      const of = this.recording[this.mode], colours = this.groupColours(this.mode, of);
      for (let t = 0; t < triangles; ++t) set(t, paint[colours[of[t]]]);
    } else if (!strategy.has_clusters) {
      return;  // one colour: it has none
    } else if (this.mode === "atomic") {
      const colours = this.groupColours(`atomic ${index}`, strategy.atomic);
      for (let t = 0; t < triangles; ++t) set(t, paint[colours[strategy.atomic[t]]]);
    } else if (this.mode === "cluster") {
      const colours = this.groupColours(`atomic ${index}`, strategy.atomic), n = strategy.atomic_clusters;
      const of = strategy.cluster_of_atomic.subarray(interval * n, (interval + 1) * n);
      const merged = colourGroups(this.mergedNeighbours(index, strategy, of), (g) => colours[g]);
      for (let t = 0; t < triangles; ++t) set(t, paint[merged[of[strategy.atomic[t]]]]);
    } else if (this.mode === "positive") {
      const not = rgb(RED);
      for (let t = 0; t < triangles; ++t) if (!bitOf(strategy.positive, triangles, interval, t)) set(t, not);
    }
    look.colourTexture.needsUpdate = true;
  }

  groupColours(name, of) {
    this.colourings ??= new Map();
    if (!this.colourings.has(name)) {
      let groups = 0;
      for (const g of of) groups = Math.max(groups, g + 1);
      const neighbours = groupNeighbours(this.neighbours, (t) => of[t], groups);
      this.colourings.set(name, colourGroups(neighbours, (g) => g));
      this.colourings.set(`${name} neighbours`, neighbours);
    }
    return this.colourings.get(name);
  }

  mergedNeighbours(index, strategy, of) {
    const atomic = this.colourings.get(`atomic ${index} neighbours`);
    const merged = atomic.map(() => new Set());
    atomic.forEach((row, a) => {
      for (const b of row) if (of[a] !== of[b]) merged[of[a]].add(of[b]);
    });
    return merged;
  }

  // In how many intervals each triangle has a feature of a contact, or crosses another at the start.
  oftenTouched(strategy) {
    if (!strategy.often) {
      const { triangles } = this.recording.clip;
      strategy.often = new Uint32Array(triangles);
      for (let i = 0; i < strategy.verdict.length; ++i) {
        if (strategy.verdict[i] === 0) continue;
        const crossing = new Set(strategy.crossing.subarray(2 * strategy.crossingOffset[i], 2 * strategy.crossingOffset[i + 1]));
        for (let t = 0; t < triangles; ++t) strategy.often[t] += bitOf(strategy.touched, triangles, i, t) || crossing.has(t) ? 1 : 0;
      }
    }
    return strategy.often;
  }

  // --- Marks of contacts -------------------------------------------------------------------------------------------------

  // The point of a contact, on its first feature at its own time, whatever moment is shown.
  contactPoint(strategy, interval, c) {
    const { surface } = this.stage, t = strategy.contact_time[c] / 65535;
    const at = (v) => surface.pointAt(v, interval, t, true);
    const v = strategy.contact_vertex.subarray(4 * c, 4 * c + 2);
    return strategy.contact_kind[c] === 0 ? at(v[0]) : at(v[0]).lerp(at(v[1]), strategy.contact_along[c] / 65535);
  }

  pointOf(moment) {
    if (!moment) return null;
    if (moment.contact !== undefined) return this.contactPoint(this.active, moment.interval, moment.contact);
    if (moment.pair === undefined) return null;
    const { corners } = this.recording, sum = new THREE.Vector3(), point = new THREE.Vector3();
    for (let i = 0; i < 2; ++i)
      for (let k = 0; k < 3; ++k) sum.add(this.stage.surface.point(corners[3 * this.active.crossing[2 * moment.pair + i] + k], point));
    return sum.divideScalar(6);
  }

  mark(marks, strategy, interval, active) {
    const { surface } = this.stage, { corners } = this.recording;
    const from = strategy.contactOffset[interval], to = strategy.contactOffset[interval + 1];
    const chosen = active && this.chosen && this.chosen.interval === interval ? this.chosen : null;
    const place = new THREE.Vector3();
    const edge = (out, a, b) => {
      surface.point(a, place).toArray(out, out.length);
      surface.point(b, place).toArray(out, out.length);
    };
    const feature = (out, c, second) => {
      const v = strategy.contact_vertex.subarray(4 * c, 4 * c + 4);
      if (strategy.contact_kind[c] === 1) edge(out, ...(second ? [v[2], v[3]] : [v[0], v[1]]));
      else if (second) for (const [a, b] of [[1, 2], [2, 3], [3, 1]]) edge(out, v[a], v[b]);
    };
    const points = [], weights = [], others = [];
    for (let c = from; c < to; ++c) {
      this.contactPoint(strategy, interval, c).toArray(points, points.length);
      weights.push(c === from ? 0.6 : to - from > 60 ? 0.15 : 0.3);
      if (c - from < MOST_LINES && !(chosen && chosen.contact === c)) {
        feature(others, c, false);
        feature(others, c, true);
      }
    }
    marks.setContacts(points, weights);
    marks.setLines("others", others);
    const first = [], second = [], normal = [], at = [];
    if (chosen && chosen.contact !== undefined) {
      const c = chosen.contact, point = this.contactPoint(strategy, interval, c);
      feature(first, c, false);
      feature(second, c, true);
      point.toArray(at, 0);
      const n = strategy.contact_normal.subarray(3 * c, 3 * c + 3);
      if (this.normalsShown) {
        const length = (0.05 * this.stage.whole.radius) / 127;
        normal.push(point.x, point.y, point.z, point.x + length * n[0], point.y + length * n[1], point.z + length * n[2]);
      }
    }
    if (this.normalsShown)
      for (let c = from; c < to; c += Math.ceil((to - from) / MOST_NORMALS)) {
        const p = this.contactPoint(strategy, interval, c), n = strategy.contact_normal.subarray(3 * c, 3 * c + 3);
        const length = (0.02 * this.stage.whole.radius) / 127;
        normal.push(p.x, p.y, p.z, p.x + length * n[0], p.y + length * n[1], p.z + length * n[2]);
      }
    marks.setLines("first", first);
    marks.setLines("second", second);
    marks.setLines("normals", normal);
    marks.setChosen(at);
    const crossings = [];
    for (let i = strategy.crossingOffset[interval]; i < strategy.crossingOffset[interval + 1]; ++i) {
      const [a, b] = [0, 1].map((side) => {
        const t = strategy.crossing[2 * i + side];
        return corners.subarray(3 * t, 3 * t + 3);
      });
      const segment = crossingSegment(surface.positions, a, b);
      if (segment) crossings.push(...segment);
    }
    marks.setLines("crossings", crossings);
    marks.setLines("crossingGlow", crossings);
  }

  // --- Camera ------------------------------------------------------------------------------------------------------------

  // What the camera follows: a vertex of the contact that was looked at last, or else the middle of the surface.
  anchorPoint() {
    return this.anchor === null ? this.stage.whole.center : this.stage.surface.point(this.anchor, new THREE.Vector3());
  }

  setAnchor(vertex) {
    this.anchor = vertex;
    this.stage.follow(null);
    this.stage.follow(this.anchorPoint());
  }

  showWhole(smooth) {
    this.setAnchor(null);
    const direction = this.broadSide(), { center, distance } = this.stage.fit(direction, this.together ? 1.3 : 1.06);  // room for names
    this.stage.look(center, distance, direction, smooth);
  }

  showChosen(smooth) {
    const point = this.pointOf(this.chosen);
    if (!point) {
      this.showWhole(smooth);
      return;
    }
    const { contact, pair } = this.chosen, { contact_vertex: vertex, crossing } = this.active;
    this.setAnchor(contact !== undefined ? vertex[4 * contact] : this.recording.corners[3 * crossing[2 * pair]]);
    const { stage } = this, whole = stage.surface.bounds();
    const { contactOffset } = this.active, { interval } = this.chosen;
    const points = [point];
    let spread = 0;
    for (let c = contactOffset[interval]; c < contactOffset[interval + 1]; ++c) {
      const other = this.contactPoint(this.active, interval, c), distance = other.distanceTo(point);
      if (distance > 0.2 * whole.radius) continue;
      spread = Math.max(spread, distance);
      if (points.length < 4 && distance > 0.002 * whole.radius) points.push(other);
    }
    const radius = Math.min(0.36 * whole.radius, Math.max(0.17 * whole.radius, 1.6 * spread, 8 * stage.meanEdge));
    if (!this.opened) {
      stage.controls.target.copy(whole.center);
      stage.camera.position.copy(this.broadSide()).multiplyScalar(3).add(whole.center);
      this.opened = true;
    }
    const direction = stage.clearestDirection(points, whole.radius);
    stage.look(point, stage.distanceFor(radius), direction, smooth);
  }

  // A direction from which the shown pose looks wide: a little above and beside the level one across its longest direction.
  broadSide() {
    const { surface, up } = this.stage, side = new THREE.Vector3(up.y, up.z, up.x), front = new THREE.Vector3().crossVectors(side, up);
    let xx = 0, xy = 0, yy = 0;
    const center = surface.bounds().center, point = new THREE.Vector3();
    for (let v = 0; v < this.recording.clip.vertices; v += 3) {
      surface.point(v, point).sub(center);
      const x = point.dot(side), y = point.dot(front);
      xx += x * x;
      xy += x * y;
      yy += y * y;
    }
    const angle = 0.5 * Math.atan2(2 * xy, xx - yy) + Math.PI / 2;  // across the longest level direction
    const direction = new THREE.Vector3().addScaledVector(side, Math.cos(angle)).addScaledVector(front, Math.sin(angle));
    if (direction.dot(new THREE.Vector3(0.2, 0.1, 1)) < 0) direction.negate();
    return direction.applyAxisAngle(up, 0.4).addScaledVector(up, 0.28).normalize();
  }

  insetBox() {
    const stage = byId("stage").getBoundingClientRect(), box = byId("inset").getBoundingClientRect();
    if (!box.width) {
      byId("inset").hidden = false;
      return null;
    }
    return { x: box.left - stage.left, y: box.top - stage.top, w: box.width, h: box.height };
  }

  placeInset() {
    const hidden = !this.stage.insetShown || this.together;
    const inset = byId("inset");
    if (inset.hidden !== hidden) {
      inset.hidden = hidden;
      if (!hidden) this.stage.requestDraw();
    }
  }

  // --- The list ----------------------------------------------------------------------------------------------------------

  fillList() {
    const { active } = this, moments = this.momentsOf(active), list = byId("list");
    if (this.listFor !== active) {
      this.listFor = active;
      this.rowOf = new Map();
      byId("list-title").textContent = moments.length ? `${many(moments.length, "moment")} with contact` : "No contact";
      const rows = moments.slice(0, MOST_ROWS).map((moment) => {
        const row = element("button");
        row.moment = moment;
        row.append(element("span", both(...this.namesOf(active, moment), moment.pair !== undefined ? "crosses" : "touches"), "what"),
          element("span", momentText(this.recording, moment.interval + this.timeOf(active, moment)), "when"));
        const counts = [];
        if (active.start_pairs[moment.interval] > 0) counts.push(many(active.start_pairs[moment.interval], "crossing pair"));
        if (active.contacts[moment.interval] > 0) counts.push(many(active.contacts[moment.interval], "contact"));
        row.append(element("span", counts.join(", "), "many"));
        this.rowOf.set(moment.interval, row);
        return row;
      });
      if (moments.length > MOST_ROWS) rows.push(element("p", `and ${moments.length - MOST_ROWS} more: use the timeline`));
      if (moments.length === 0) rows.push(element("p", "Nothing touches. Play the clip, or look at how the method sees the surface."));
      list.replaceChildren(...rows);
      this.expanded = null;
    }
    const interval = this.chosen ? this.chosen.interval : null;
    if (this.expanded !== interval && !this.playing) {
      list.querySelectorAll(".one").forEach((row) => row.remove());
      this.expanded = interval;
      const row = this.rowOf.get(interval);
      if (row) {
        const contacts = [];
        const from = active.contactOffset[interval], to = active.contactOffset[interval + 1];
        for (let c = from; c < Math.min(to, from + 200); ++c) {
          const one = element("button", undefined, "one");
          one.moment = { interval, contact: c };
          one.append(element("span", `${both(...this.namesOf(active, one.moment), "touches")} (${active.contact_kind[c] === 0 ? "vertex, face" : "edge, edge"})`, "what"),
            element("span", `t = ${this.timeOf(active, one.moment).toFixed(4)}`, "when"));
          contacts.push(one);
        }
        if (active.contacts[interval] > contacts.length) {
          const more = element("p", `and ${many(active.contacts[interval] - contacts.length, "more contact")}`, "one");
          contacts.push(more);
        }
        row.after(...contacts);
      }
    }
    for (const row of list.querySelectorAll("[aria-current]")) row.removeAttribute("aria-current");
    const here = this.chosen && (this.chosen.contact !== undefined
      ? Array.from(list.querySelectorAll("button.one")).find((row) => row.moment.contact === this.chosen.contact) : null);
    const row = here || this.rowOf.get(interval);
    if (row) {
      row.setAttribute("aria-current", "true");
      const box = row.getBoundingClientRect(), frame = list.getBoundingClientRect();
      if (box.top < frame.top || box.bottom > frame.bottom) list.scrollTop += box.top - frame.top - 60;
    }
  }
}

function radios(box, choices, choose) {
  for (const [value, text] of choices) {
    const button = element("button", text);
    button.setAttribute("role", "radio");
    button.value = value;
    button.addEventListener("click", () => choose(value));
    box.append(button);
  }
  box.update = (chosen) => {
    for (const button of box.children) button.setAttribute("aria-checked", String(button.value === chosen));
  };
}

// Models say y, and so do most caches. A scene stands along the longest side of its box, with the side up that holds more of
// the surface.
function upAxis({ header, clip, places }) {
  if (header.kind !== "scene") return "y";
  const sides = [0, 1, 2].map((axis) => {
    let low = 65535, high = 0, sum = 0;
    for (let v = 0; v < clip.vertices; ++v) {
      const x = places[axis * clip.vertices + v];
      low = Math.min(low, x);
      high = Math.max(high, x);
      sum += x;
    }
    return { length: high - low, heavier: sum / clip.vertices > (low + high) / 2 };
  });
  const order = [1, 0, 2].sort((a, b) => sides[b].length - sides[a].length);
  return (sides[order[0]].heavier ? "" : "-") + "xyz"[order[0]];
}

function fail(error) {
  document.body.classList.add("failed");
  byId("verdict").textContent = "This page cannot be shown.";
  byId("details").textContent = error instanceof RangeError
    ? "The recording is larger than this browser can hold; write it again with fewer frames: cscd view INPUT --frames A:B"
    : String(error.message || error);
  console.warn(error);
}

async function begin() {
  const canvas = document.createElement("canvas");
  if (!canvas.getContext("webgl2")) throw new Error("This browser has no WebGL 2, which draws the surface; switch it on, or use another browser.");
  if (typeof DecompressionStream === "undefined") throw new Error("This browser cannot unpack the recording; use one from 2023 or later.");
  window.cscd = new Viewer(await loadRecording());
}

begin().catch(fail);
