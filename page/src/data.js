// Reads what `cscd view` put into the page: a header in JSON, and arrays of numbers that are compressed one by one. What the viewer
// shows is made of both by recordingOf(), which the pages that answer by themselves (check.js, again.js) call, too.

import { chosenClip } from "./clips.js";

const TYPES = {
  u8: Uint8Array, u16: Uint16Array, u32: Uint32Array, i8: Int8Array, i16: Int16Array, i32: Int32Array, f32: Float32Array, f64: Float64Array,
};

export function fromBase64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

export async function inflate(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}

// Undoes PositionCoder (bench/query/view/position_coder.h). Returns [frames][3][vertices] places on the grid.
function decodePlaces(bytes, frames, vertices) {
  const n = 3 * vertices;
  const places = new Uint16Array(frames * n);
  for (let f = 0, at = 0; f < frames; ++f) {
    const predictor = bytes[at++];
    const low = at, high = at + n, here = f * n, last = here - n, older = last - n;
    at += 2 * n;
    let miss = 0;
    for (let i = 0; i < n; ++i) {
      const coded = bytes[low + i] | (bytes[high + i] << 8);
      miss += (coded >>> 1) ^ -(coded & 1);
      const prediction = predictor === 0 ? 0 : predictor === 1 ? places[last + i] : 2 * places[last + i] - places[older + i];
      places[here + i] = prediction + miss;  // modulo 2^16
    }
  }
  return places;
}

// Bits and clusters come as differences from the interval before.
function undoDifferences(bytes, perInterval) {
  for (let i = perInterval; i < bytes.length; ++i) bytes[i] ^= bytes[i - perInterval];
  return bytes;
}

function offsets(counts) {
  const out = new Uint32Array(counts.length + 1);
  for (let i = 0; i < counts.length; ++i) out[i + 1] = out[i] + counts[i];
  return out;
}

function strategyOf(row, arrays, prefix) {
  const strategy = { ...row };
  for (const [name, values] of Object.entries(arrays))
    if (name.startsWith(prefix)) strategy[name.slice(prefix.length)] = values;
  strategy.contactOffset = offsets(strategy.kept_contacts);
  strategy.crossingOffset = offsets(strategy.kept_pairs);
  // One entry for each cover. The observers of interval i have the numbers offset[i] to offset[i + 1] - 1, and `place` holds
  // twelve numbers for each of them: where its head is at the start and at the end of the interval, then the same of its tail.
  strategy.observers = Array.from({ length: row.covers || 0 }, (_, c) => ({
    offset: offsets(strategy[`cover${c}.observer_count`]),
    cluster: strategy[`cover${c}.observer_cluster`],
    place: strategy[`cover${c}.observer_place`],
  }));
  return strategy;
}

// The least and the greatest place of every frame along x, y and z, [frames][3][2], as shares of the grid.
function boxesOf(places, { frames, vertices }) {
  const boxes = new Float64Array(6 * frames);
  for (let row = 0; row < 3 * frames; ++row) {
    let low = 65535, high = 0;
    for (let at = row * vertices; at < (row + 1) * vertices; ++at) {
      if (places[at] < low) low = places[at];
      if (places[at] > high) high = places[at];
    }
    boxes[2 * row] = low / 65535;
    boxes[2 * row + 1] = high / 65535;
  }
  return boxes;
}

// Whether a triangle's bit is set in the row of an interval.
export const bitOf = (bytes, triangles, interval, t) => (bytes[interval * Math.ceil(triangles / 8) + (t >> 3)] >> (t & 7)) & 1;

// An event of the summary, with intervals that count from the recording's first. It is deepest at the start of interval
// `deepest`, where `time` is 0, or in the last pose, which is the end of the last interval.
function eventOf({ clip, strategies }, number) {
  const event = strategies[0].summary.events[number], from = (moment) => moment.interval - clip.first_interval;
  return { number, name: event.first, other: event.second, out: event.out, atJoint: event.at_joint, first: from(event.begins), deepest: from(event.deepest), time: event.deepest.time, last: from(event.ends), point: event.point, depths: event.depth_at };
}

// Returns what recordingOf() takes, {header, arrays}, and laterArray(name), which unpacks one of the arrays that only the page's own
// engine asks for: those whose names begin with "exact.".
export async function loadRecording() {
  const text = document.getElementById("header");
  const packed = document.getElementById("arrays");
  if (!text || !packed) throw new Error("this page holds no recording; write one with: cscd view INPUT");
  const whole = JSON.parse(text.textContent), clip_number = whole.clips ? chosenClip(whole) : 0;
  const header = whole.clips ? { ...whole, ...whole.clips[clip_number] } : whole;
  if (header.schema !== "cscd.view/1") throw new Error(`this page cannot show a recording of the form ${header.schema}`);
  const bytes = fromBase64(packed.textContent);
  packed.remove();
  const arrays = {};
  const prefix = whole.clips ? `c${clip_number}.` : "", exact = `${prefix}exact.`;
  const unpack = async (section) => {
    const raw = await inflate(bytes.subarray(section.offset, section.offset + section.bytes))
      .catch(() => new ArrayBuffer(0));
    if (raw.byteLength !== section.raw) throw new Error(`The page is damaged: its array ${section.name} is not whole. Write it again with cscd view.`);
    return new TYPES[section.type](raw);
  };
  const laterArray = (name) => unpack(header.sections.find((section) => section.name === prefix + name));
  await Promise.all(header.sections.filter(({ name }) => name.startsWith(prefix) && !name.startsWith(exact)).map(async (section) => {
    arrays[section.name.slice(prefix.length)] = await unpack(section);
  }));

  const { clip } = header, rowBytes = Math.ceil(clip.triangles / 8);
  for (const [name, values] of Object.entries(arrays)) if (/^s\d+\.(touched|close|positive)$/.test(name)) undoDifferences(values, rowBytes);
  arrays.places = decodePlaces(arrays.positions, clip.frames, clip.vertices);
  arrays.ends = decodePlaces(arrays.predicted_ends, arrays.interval_of_end.length, clip.vertices);
  return { header, arrays, laterArray };
}

// Returns everything that the page shows. Lengths are scaled so that the clip's box has a longest side of 1, centred at the
// origin: `toView` scales a point of the scene. `places` and `ends` are positions on the grid, [frames][3][vertices].
export function recordingOf(header, arrays) {
  const { clip } = header, { places, ends } = arrays, intervals = clip.frames - 1;
  const endOfInterval = new Map(Array.from(arrays.interval_of_end, (interval, i) => [interval, i]));
  const side = clip.grid.step * 65535;
  const frameBoxes = boxesOf(places, clip);
  const middle = [0, 1, 2].map((axis) => {  // between the first and the last place that occur, on the grid
    const ends = frameBoxes.filter((_, i) => Math.floor(i / 2) % 3 === axis);
    return (ends.reduce((a, b) => Math.min(a, b)) + ends.reduce((a, b) => Math.max(a, b))) / 2;
  });
  return {
    header, clip, intervals, places, ends, endOfInterval, middle,
    frameBoxes: frameBoxes.map((x, i) => x - middle[Math.floor(i / 2) % 3]),
    length: side * Math.max(...[0, 2, 4].map((i) => frameBoxes[i + 1] - frameBoxes[i])),  // of the first frame, in the scene's unit
    texts: header.texts,
    corners: arrays.corners,
    place: arrays.place,
    part: arrays.part,
    bones: arrays.bones,
    insideOffset: offsets(arrays.inside_count),  // [intervals + 1], of what lies in another piece of the surface at the start
    insideVertex: arrays.inside_vertex,
    insideDepth: arrays.inside_depth,
    // The curves of interval i have the numbers curveOffset[i] to curveOffset[i + 1] - 1. Each point lies on an edge, at a share
    // of the way along it.
    curveOffset: offsets(arrays.curve_count),
    pointOffset: offsets(arrays.curve_points),
    curveEvent: arrays.curve_event,
    curveEdge: arrays.curve_edge,
    curveShare: arrays.curve_share,
    events: header.events.map(({ event, text }) => ({ text, ...eventOf(header, event) })),
    // By interval, where the true motion does anything; `at` is when, in the interval. Null where nobody asked for it.
    truths: header.true_motion && new Map(header.true_motion.map((truth) => [truth.interval, truth])),
    strategies: header.strategies.map((row, i) => strategyOf(row, arrays, `s${i}.`)),
    // A unit of observers' places is four steps of the grid.
    observerToView: (place, axis) => (4 * place) / 65535 - middle[axis],
    toView: (x, axis) => (x - clip.grid.origin[axis]) / side - middle[axis],
  };
}
