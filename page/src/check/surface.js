// The surface of a model: all its parts, welded; the names of its places; and what crosses in it at rest.
import { many, number } from "../words.js";
import { Joints } from "./events.js";
import { Mesh } from "./mesh.js";
import { POINT, PreparedSurface } from "./prepared.js";
import { weld, weldedTriangles } from "./weld.js";

const PROBES = 32;  // poses in which seams are looked at, spread over all clips
const ordinal = (n) => n + (n % 100 >= 11 && n % 100 <= 13 ? "th" : ["th", "st", "nd", "rd"][n % 10] ?? "th");

function rawCorners({ parts }) {
  const corners = [], part = [];
  let first = 0;
  parts.forEach((one, p) => {
    for (const corner of one.corners) corners.push(first + corner);
    for (let i = 0; i < one.corners.length; i += 3) part.push(p);
    first += one.positions.length / 3;
  });
  return { corners, part };
}

function probesOf(model) {
  const clips = model.clips.slice(0, PROBES), each = Math.floor(PROBES / Math.max(1, clips.length));
  return clips.flatMap((clip) => Array.from({ length: each }, (_, i) => {
    const out = new Float64Array(3 * model.vertexCount), time = clip.start + (each === 1 ? 0.5 : i / (each - 1)) * clip.seconds;
    model.pose(clip.drives, time);
    model.skin((node) => node.matrixWorld, out);
    return out;
  }));
}

export class Surface extends PreparedSurface {
  constructor(model, name) {
    super();
    const raw = rawCorners(model), positions = new Float64Array(3 * model.vertexCount);
    Object.assign(this, { model, name, clips: model.clips, fps: model.fps, isSequence: model.isSequence === true });
    this.header = { import: { format: model.format, centimetres_per_unit: model.centimetres || null, fps: model.fps, fps_from: model.fpsFrom } };
    if (raw.corners.length === 0) throw new Error("holds no triangles; export it together with its mesh");
    const bound = this.isSequence ? null : model.bound();
    if (bound) model.skin((node) => bound.get(node), positions);
    else model.sample(model.clips[0], 0, positions);
    if (!positions.every(Number.isFinite)) throw new Error("has positions that are not finite in its bind pose; repair the model");
    const low = [Infinity, Infinity, Infinity], high = low.map((x) => -x);
    for (const v of raw.corners) for (let k = 0; k < 3; ++k) low[k] = Math.min(low[k], positions[3 * v + k]), high[k] = Math.max(high[k], positions[3 * v + k]);
    const welded = this.isSequence ? { ...weldedTriangles(raw.corners, Int32Array.from({ length: model.vertexCount }, (_, v) => v)) }
      : weld(raw.corners, positions, Math.hypot(...high.map((x, k) => x - low[k])), probesOf(model));
    // A sequence is taken as it is: its vertices of no face are points. Models hold many that mean nothing.
    const number = new Int32Array(model.vertexCount).fill(this.isSequence ? 0 : -1);
    for (const v of welded.corners) number[v] = 0;
    this.rawVertex = Array.from(number.keys()).filter((v) => number[v] === 0);
    this.rawVertex.forEach((v, i) => { number[v] = i; });
    this.mesh = new Mesh(Uint32Array.from(welded.corners, (v) => number[v]), this.rawVertex.length);
    Object.assign(this.header.import, { vertices: model.vertexCount, triangles: raw.part.length, collapsed_triangles: welded.collapsed, duplicate_triangles: welded.duplicate, components: this.mesh.components, chosen_triangles: this.mesh.triangles });
    if (welded.tolerance) this.header.import.weld = { tolerance: welded.tolerance, vertices: Array.from(welded.group).filter((group, v) => group !== v).length };
    this.raw = positions;
    this.rest = this.chosen(new Float64Array(3 * this.mesh.vertices));
    this.size = this.rest.reduce((most, x) => Math.max(most, Math.abs(x)), 0);
    this.nameParts(welded.source.map((t) => raw.part[t]));
    this.nameBones(bound);
    this.nameTriangles();
    this.joints = new Joints(this.mesh, this.rest, this.placeName, (t) => this.boneOf(t), this.parent);
  }

  // The vertices of the surface among all vertices.
  chosen(out) {
    this.rawVertex.forEach((v, i) => { for (let k = 0; k < 3; ++k) out[3 * i + k] = this.raw[3 * v + k]; });
    return out;
  }

  sample(clip, frame, out) {
    this.model.sample(clip.number < 0 ? null : clip, frame, this.raw);
    return this.chosen(out);
  }

  pose(clip, frame) { return this.sample(clip, Math.min(frame, clip.frames - 1), new Float64Array(3 * this.mesh.vertices)); }

  // The poses at both ends of an interval; `last` is the end of the one before.
  startOf(clip, interval, last) { return last ?? this.pose(clip, interval); }
  endOf(clip, interval) { return this.pose(clip, interval + 1); }

  // A file of one pose is asked about as it is: what crosses in it is not left out.
  keepsRest(clip) { return clip.frames < 2 && this.clips.every(({ frames }) => frames < 2); }

  // What a verdict on a clip is about.
  subjectOf({ frames, name, number }) {
    const { clips } = this;
    if (!frames || this.isSequence || clips.length === 0 || number < 0) return this.name;
    const title = name ? `clip '${name}'` : "clip";
    return `${this.name}, ${clips.length === 1 ? (name ? `${title} (the only one)` : "its only clip") : `${title} (${ordinal(number + 1)} of ${many(clips.length, "clip")})`}`;
  }

  // How it was answered, in sentences.
  notes() {
    const { fps, fpsFrom } = this.model;
    return [`${number(fps)} frames a second, ${{ file: "as the file says", keys: "as the keys of the file are spaced", assumed: "because the file does not say" }[fpsFrom]}`,
      "Posed by three.js and answered in this page by cscd's library, every answer proven for straight lines between these frames"];
  }

  // A part is called as its node; two of one name, and the components of one part, are told apart by number.
  nameParts(partOf) {
    const { mesh, model } = this, components = new Map();
    partOf.forEach((p, t) => components.set(p, (components.get(p) ?? new Set()).add(mesh.component[t])));
    const names = model.names.map((name, p) => (name || `mesh ${p}`) + (name && model.names.filter((other) => other === name).length > 1 ? ` (part ${p})` : ""));
    this.partName = (t) => (t === undefined ? POINT : names[partOf[t]] + (components.get(partOf[t]).size > 1 ? `, component ${mesh.component[t]}` : ""));
  }

  // Bones are the nodes that move vertices of the surface (scenes/character/skeleton.h).
  nameBones(bound) {
    const { model, rawVertex, raw } = this;
    Object.assign(this, { bones: [], parent: [], bone: null });
    if (!bound) return;
    const load = new Map(), used = new Set(rawVertex), add = (node, weight, v) => {
      if (!load.has(node)) load.set(node, [0, 0, 0, 0]);
      const own = load.get(node);
      own[3] += weight;
      for (let k = 0; k < 3; ++k) own[k] += weight * raw[3 * v + k];
    };
    let v = 0;
    for (const { node, positions, joints, bone, weight } of model.parts)
      for (let own = 0; own < positions.length / 3; ++own, ++v) {
        if (!used.has(v)) continue;
        const moving = weight ? [0, 1, 2, 3].map((k) => 4 * own + k).filter((k) => weight[k] > 0) : [];
        if (moving.length === 0) add(node, 1, v);
        for (const k of moving) add(joints[bone[k]].node, weight[k], v);
      }
    this.bones = model.nodes.filter((node) => load.has(node));
    const number = new Map(this.bones.map((node, i) => [node, i])), main = model.mainNodes();
    this.parent = this.bones.map((node) => {
      do node = node.parent; while (node && !number.has(node));
      return node ? number.get(node) : -1;
    });
    this.bone = Int32Array.from(rawVertex, (raw) => number.get(main[raw]) ?? -1);
    const head = (b) => Array.from(bound.get(this.bones[b]).elements.slice(12, 15)), inverse = (b) => bound.get(this.bones[b]).clone().invert().elements;
    this.tails = this.bones.map((node, b) => {
      const below = this.parent.flatMap((parent, i) => (parent === b ? [head(i)] : [])), own = load.get(node), m = inverse(b);
      let tail = [0, 1, 2].map((k) => below.reduce((sum, one) => sum + one[k] / below.length, 0));
      if (below.length === 0 || tail.every((x, k) => x === head(b)[k])) tail = [0, 1, 2].map((k) => own[k] / own[3]);
      return [0, 1, 2].map((k) => m[k] * tail[0] + m[4 + k] * tail[1] + m[8 + k] * tail[2] + m[12 + k]);
    });
  }

  nameOfBone(bone) { return this.model.nameOf(this.bones[bone]) || `bone ${bone}`; }
  boneName(vertex) { return this.bone && this.bone[vertex] >= 0 ? this.nameOfBone(this.bone[vertex]) : null; }
  boneOf(t) {
    if (!this.bone) return -1;
    const [a, b, c] = this.mesh.cornersOf(t);
    return this.bone[this.bone[b] === this.bone[c] ? b : a];
  }

  // A triangle's place is the bone that moves most of its corners, or else its part.
  nameTriangles() {
    const { mesh } = this, texts = [], number = new Map(), numberOf = (text) => {
      if (!number.has(text)) number.set(text, texts.push(text) - 1);
      return number.get(text);
    };
    this.place = new Uint16Array(mesh.triangles);
    this.part = new Uint16Array(mesh.triangles);
    for (let t = 0; t < mesh.triangles; ++t) {
      const bone = this.boneOf(t);
      this.part[t] = numberOf(this.partName(t));
      this.place[t] = bone < 0 ? this.part[t] : numberOf(this.nameOfBone(bone));
    }
    const hasPoints = this.rawVertex.some((_, v) => mesh.around(v).length === 0);
    const point = hasPoints ? numberOf(POINT) : 0;
    if (texts.length > 65536) throw new Error("has more than 65536 names of bones and parts; ask cscd query");
    this.texts = texts;
    const labels = new Map();  // of parts, in the order in which they come
    for (let t = 0; t < mesh.triangles; ++t) if (!labels.has(this.part[t])) labels.set(this.part[t], labels.size);
    this.placeNumber = (t) => (this.boneOf(t) < 0 ? -1 - labels.get(this.part[t]) : this.boneOf(t));
    this.placeOf = (t) => (t === undefined ? point : this.place[t]);
    this.placeName = (t) => texts[this.placeOf(t)];
  }

  // Where the head and the tail of each bone are in the pose that was sampled last.
  bonesNow() {
    return this.bones.flatMap(({ matrixWorld: { elements: m } }, b) => [m[12], m[13], m[14], ...[0, 1, 2].map((k) => m[k] * this.tails[b][0] + m[4 + k] * this.tails[b][1] + m[8 + k] * this.tails[b][2] + m[12 + k])]);
  }
}
