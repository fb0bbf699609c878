// The colour of every triangle, by what the reader wants to tell apart.
import { bitOf } from "./data.js";
import { CLUSTERS, colourGroups, CROSSED, edgeNeighbours, GREY, groupNeighbours, ORANGE, PINK, RED, rgb, SKIN, SKY, TINTS, YELLOW } from "./palette.js";

// Ways of colouring that change from interval to interval.
const CHANGING = ["verdict", "depth", "cluster", "positive"];
const PAINT = CLUSTERS.map(rgb);

// Which cover of drvbc_fast a way of colouring is about: 0 is the first.
export const coverOf = (mode) => (mode.startsWith("cover") ? Number(mode.slice(5)) : 0);

// Ways of colouring that show how the engine works, which whoever makes it wants to see.
export const isOfEngine = (mode) => !["verdict", "depth", "place", "part", "often"].includes(mode);

// The ways of colouring that a recording has something to say in, as [name, text].
export function modesOf({ strategies, clip, place, part, events }) {
  const modes = [["verdict", "verdict"]], some = (what) => strategies.some(what);
  if (events.length > 0) modes.push(["depth", "depth"]);
  if (new Set(place).size > 1) modes.push(["place", clip.bones > 0 ? "bone" : "part"]);
  if (clip.bones > 0 && new Set(part).size > 1) modes.push(["part", "part"]);
  modes.push(["often", "how often"]);
  if (some((s) => s.has_clusters)) {
    modes.push(["atomic", "atomic cluster"]);
    modes.push(["cluster", some((s) => s.has_clusters && s.covers === 1 && !s.has_patches) ? "mega cluster" : "cluster in force"]);
    modes.push(["positive", "orientation"]);
  }
  for (const [c, text] of [[1, "second cover"], [2, "third cover"]])
    if (some((s) => s.covers > c)) modes.push([`cover${c}`, text]);
  if (some((s) => s.has_patches)) modes.push(["patch", "patch"]);
  return modes;
}

// The depth that the verdict names, or else that of the deepest vertex of the clip in another piece of the surface.
export function mostDepth(recording) {
  recording.mostDepth ??= recording.strategies[0].summary.headline?.depth.at_least || recording.insideDepth.reduce((a, b) => Math.max(a, b), 0);
  return recording.mostDepth;
}

// The numbers of the two places of a chosen event, what lies in the other first; empty where there is one place, or no event.
export const tinted = ({ texts }, chosen) => (chosen?.event && chosen.event.name !== chosen.event.other ? [chosen.event.name, chosen.event.other].map((name) => texts.indexOf(name)) : []);

export class Painter {
  constructor(recording) {
    this.recording = recording;
    this.neighbours = edgeNeighbours(recording.corners, recording.clip.vertices);
    this.colourings = new Map();
  }

  // Paints a look of the surface (surface.js) as strategy number `index` answers an interval.
  paint(look, index, mode, interval, chosen) {
    const tints = mode === "depth" ? tinted(this.recording, chosen) : [];
    const key = `${index} ${mode} ${CHANGING.includes(mode) ? interval : ""} ${tints}`;
    if (look.key === key) return;
    look.key = key;
    const strategy = this.recording.strategies[index], { triangles } = this.recording.clip, out = look.colours;
    const set = (t, [r, g, b]) => {
      out[4 * t] = r;
      out[4 * t + 1] = g;
      out[4 * t + 2] = b;
    };
    const skin = rgb(SKIN), skins = TINTS.map(rgb), { place } = this.recording;
    for (let t = 0; t < triangles; ++t) {
      set(t, skins[tints.indexOf(place[t])] ?? skin);
      out[4 * t + 3] = 255;
    }
    look.glow.visible = mode === "verdict" || mode === "depth";
    const setGlowing = (t, colour) => {
      set(t, colour);
      out[4 * t + 3] = 0;
    };
    look.colourTexture.needsUpdate = true;
    if (mode === "verdict") {
      const close = rgb(SKY), touched = rgb(ORANGE), crossed = rgb(CROSSED);
      if (strategy.close)
        for (let t = 0; t < triangles; ++t) if (bitOf(strategy.close, triangles, interval, t)) setGlowing(t, close);
      if (strategy.contacts[interval] > 0)
        for (let t = 0; t < triangles; ++t) if (bitOf(strategy.touched, triangles, interval, t)) setGlowing(t, touched);
      for (let i = 2 * strategy.crossingOffset[interval]; i < 2 * strategy.crossingOffset[interval + 1]; ++i) setGlowing(strategy.crossing[i], crossed);
      for (const t of this.recording.truths?.get(interval)?.pair ?? []) setGlowing(t, rgb(PINK));
    } else if (mode === "depth") {
      const depths = this.depthsAt(interval), most = mostDepth(this.recording) || 1, low = rgb(YELLOW), high = rgb(RED), { corners } = this.recording;
      if (depths.size === 0) return;
      for (let t = 0; t < triangles; ++t) {
        const deep = [0, 1, 2].map((k) => depths.get(corners[3 * t + k]) ?? -1), deepest = Math.min(most, Math.max(...deep));
        if (deepest >= 0) setGlowing(t, low.map((x, i) => x + (deepest / most) * (high[i] - x)));
      }
    } else if (mode === "often") {
      const often = this.oftenTouched(strategy), most = often.reduce((a, b) => Math.max(a, b), 1), low = rgb(YELLOW), high = rgb(RED);
      for (let t = 0; t < triangles; ++t)
        if (often[t] > 0) {
          const s = most > 1 ? Math.log(often[t]) / Math.log(most) : 1;
          set(t, low.map((x, i) => x + s * (high[i] - x)));
        }
    } else if (mode === "positive") {
      const not = rgb(RED);
      if (strategy.has_clusters)
        for (let t = 0; t < triangles; ++t) if (!bitOf(strategy.positive, triangles, interval, t)) set(t, not);
    } else {
      const groups = this.groupsOf(index, mode, interval), none = rgb(GREY);
      if (groups) for (let t = 0; t < triangles; ++t) set(t, groups.of[t] < 0 ? none : PAINT[groups.colours[groups.of[t]]]);
    }
  }

  // How deep each vertex lies in another piece of the surface, where one does at the start of an interval.
  depthsAt(interval) {
    const { insideOffset, insideVertex, insideDepth } = this.recording, depths = new Map();
    for (let i = insideOffset[interval]; i < insideOffset[interval + 1]; ++i)
      depths.set(insideVertex[i], Math.max(insideDepth[i], depths.get(insideVertex[i]) ?? 0));
    return depths;
  }

  // The colour in which an observer is drawn, by the number of its cluster: that of its triangles. Null where the surface is
  // not coloured by the clusters that it looks at.
  observerColour(index, mode, interval) {
    if (mode !== "cluster" && coverOf(mode) === 0) return null;
    const groups = this.groupsOf(index, mode, interval);
    return groups ? (cluster) => CLUSTERS[groups.colours[cluster]] : null;
  }

  // The group of every triangle, negative for none, and the colour of every group; null where the strategy has none.
  groupsOf(index, mode, interval) {
    const strategy = this.recording.strategies[index];
    if (mode === "place" || mode === "part") return this.coloured(mode, this.recording[mode]);
    if (mode === "patch") return strategy.has_patches ? this.coloured(`patch ${index}`, strategy.patch) : null;
    const cover = coverOf(mode);
    if (cover > 0) return strategy.covers > cover ? this.coloured(`${mode} ${index}`, strategy[`cover${cover}.cluster`]) : null;
    if (!strategy.has_clusters) return null;
    const atomic = this.coloured(`atomic ${index}`, strategy.atomic);
    if (mode === "atomic") return atomic;
    const n = strategy.atomic_clusters, label = strategy.cluster_of_atomic.subarray(interval * n, (interval + 1) * n);
    const neighbours = atomic.neighbours.map(() => new Set());
    atomic.neighbours.forEach((row, a) => {
      for (const b of row) if (label[a] !== label[b]) neighbours[label[a]].add(label[b]);
    });
    // A cluster keeps the colour of the atomic cluster that it is named after, where no neighbour has it.
    const colours = colourGroups(neighbours, (g) => atomic.colours[g]);
    return { of: Int32Array.from(strategy.atomic, (a) => label[a]), colours };
  }

  // The colour of the places of one name, by its number.
  placeColour(number) { return CLUSTERS[this.coloured("place", this.recording.place).colours[number]]; }

  coloured(name, of) {
    if (!this.colourings.has(name)) {
      let groups = 0;
      for (const g of of) groups = Math.max(groups, g + 1);
      const neighbours = groupNeighbours(this.neighbours, (t) => of[t], groups);
      this.colourings.set(name, { of, neighbours, colours: colourGroups(neighbours, (g) => g) });
    }
    return this.colourings.get(name);
  }

  // In how many intervals each triangle has a feature of a contact or of a close pair, or crosses another at the start.
  oftenTouched(strategy) {
    if (!strategy.often) {
      const { triangles } = this.recording.clip;
      strategy.often = new Uint32Array(triangles);
      for (let i = 0; i < strategy.verdict.length; ++i) {
        if (strategy.verdict[i] === 0) continue;
        const crossing = new Set(strategy.crossing.subarray(2 * strategy.crossingOffset[i], 2 * strategy.crossingOffset[i + 1]));
        for (let t = 0; t < triangles; ++t) strategy.often[t] += bitOf(strategy.touched, triangles, i, t) || (strategy.close && bitOf(strategy.close, triangles, i, t)) || crossing.has(t) ? 1 : 0;
      }
    }
    return strategy.often;
  }
}
