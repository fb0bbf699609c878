// Asks the library about every interval of a clip, and sums up what it says as `cscd query` does (bench/answer). Returns what a page
// of `cscd view` holds of a clip.
import { both, lengthText, many, number } from "../words.js";
import { Events, isKnown } from "./events.js";
import { RestCrossings, tellApart } from "./mesh.js";

const [CLEAR, TOUCHES, CROSSES] = [0, 1, 2], WORDS = ["clear", "touches", "intersects_at_start"];
const MOST_CONTACTS = 2000, MOST_PAIRS = 4000, MOST_POINTS = 20000;  // kept of an interval, for the page
const MOST_LISTED_PAIRS = 1000, MOST_LISTED = 200000;                // in the JSON: of an interval, and contacts of a clip

const ordinal = (n) => n + (n % 100 >= 11 && n % 100 <= 13 ? "th" : ["th", "st", "nd", "rd"][n % 10] ?? "th");
const share = (x) => Math.round(65535 * Math.min(1, Math.max(0, x)));

// What grows interval by interval: lists of numbers, by their names in the page.
const TYPES = { inside_count: Uint32Array, inside_vertex: Int32Array, inside_depth: Float32Array, curve_count: Uint32Array, curve_points: Uint32Array, curve_event: Uint32Array, curve_edge: Int32Array, curve_share: Uint16Array };
const OWN_TYPES = { verdict: Uint8Array, milliseconds: Float32Array, contacts: Uint32Array, start_pairs: Uint32Array, kept_contacts: Uint32Array, kept_pairs: Uint32Array, contact_kind: Uint8Array, contact_time: Uint16Array, contact_along: Uint16Array, contact_normal: Int8Array, contact_vertex: Int32Array, contact_place: Uint16Array, crossing: Int32Array };

export class ClipAnswer {
  constructor(surface, clip) {
    const { mesh, atRest } = surface;
    Object.assign(this, { surface, clip, isPose: clip.frames < 2 });
    this.keepsRest = this.isPose && surface.clips.every(({ frames }) => frames < 2);  // a file of one pose is asked about as it is
    this.rest = this.keepsRest ? new RestCrossings(mesh, [], atRest.met) : atRest.rest.anew();
    this.events = new Events(surface, this.rest, this.keepsRest ? [] : atRest.depths);
    this.lists = Object.fromEntries(Object.keys({ ...TYPES, ...OWN_TYPES }).map((name) => [name, []]));
    this.touched = [];
    this.intervals = [];
    this.met = new Map();
    this.counts = [0, 0, 0];
    this.sums = { withLeftOut: 0, leftOutContacts: 0, listed: 0, moves: false };
    this.count = Math.max(1, clip.frames - 1);
  }

  // The pairs of triangles that meet in a pose, what the library says of it, and which pairs pass through each other.
  meetings(start, startCrossings) {
    const { mesh, body } = this.surface, all = [];
    for (let i = 0; i < startCrossings.length; i += 2) all.push(mesh.pair(startCrossings[i], startCrossings[i + 1]));
    all.sort((a, b) => a - b);
    this.rest.follow(all);
    const met = all.filter((pair) => !this.rest.explains(pair));
    if (all.length === 0) return { all, met, crossing: new Set(), found: { overlaps: [] } };
    const found = body.crossings(start);
    return { all, met, found, crossing: tellApart(mesh, start, met, found) };
  }

  // Takes the next interval.
  add(start, end) {
    const { mesh, body } = this.surface, index = this.intervals.length, { lists } = this, begin = performance.now();
    const answer = body.allContacts(start, end), { all, met, crossing, found } = this.meetings(start, answer.startCrossings);
    const milliseconds = performance.now() - begin, kept = [];
    for (let i = 0; i < answer.count; ++i) {
      const sides = mesh.sidesOf(answer, i);
      if (!this.rest.explainsContact(sides)) kept.push({ i, sides, time: answer.times[i] });
    }
    const verdict = crossing.size > 0 ? CROSSES : met.length > 0 || kept.length > 0 ? TOUCHES : CLEAR;
    this.sums.moves ||= start.some((x, k) => Math.abs(end[k] - x) > 1e-9 * this.surface.size);
    this.sums.withLeftOut += all.length > met.length || answer.count > kept.length;
    this.sums.leftOutContacts += answer.count - kept.length;
    this.meet(index, met, crossing, kept, verdict);
    ++this.counts[verdict];
    const bits = new Uint8Array(Math.ceil(mesh.triangles / 8));
    for (const { sides } of kept) for (const t of sides.flat()) bits[t >> 3] |= 1 << (t & 7);
    this.touched.push(bits);
    const pairs = Array.from(crossing, (pair) => mesh.both(pair)), few = kept.slice(0, MOST_CONTACTS);
    lists.verdict.push(verdict);
    lists.milliseconds.push(milliseconds);
    lists.contacts.push(kept.length);
    lists.start_pairs.push(pairs.length);
    lists.kept_contacts.push(few.length);
    lists.kept_pairs.push(Math.min(MOST_PAIRS, pairs.length));
    for (const { i, sides } of few) this.keep(answer, i, sides);
    for (const pair of pairs.slice(0, MOST_PAIRS)) lists.crossing.push(...pair);
    this.keepOverlaps(start, found, this.events.add(index, start, crossing, found));
    const row = {
      index, ...this.moment(index), verdict: WORDS[verdict], collides: verdict !== CLEAR, time: kept[0]?.time ?? null, starts_embedded: all.length === 0,
      start_pairs: pairs.slice(0, MOST_LISTED_PAIRS), start_pairs_total: pairs.length, start_touching: met.length - crossing.size,
      left_out: { start_pairs: all.length - met.length, contacts: answer.count - kept.length }, ms: { wall: milliseconds },
    };
    this.sums.listed += kept.length;
    if (kept.length === few.length && this.sums.listed <= MOST_LISTED) row.contacts = few.map(({ i, sides }) => this.contactOf(answer, i, sides));
    this.intervals.push(row);
  }

  // The pose in which the last interval ends: what crosses there may be deepest.
  end(pose) {
    const { all, met, crossing, found } = this.meetings(pose, this.surface.body.allContacts(pose, pose).startCrossings);
    this.keepOverlaps(pose, found, this.events.add(this.intervals.length, pose, crossing, found), true);
    const { frame, seconds } = this.moment(this.intervals.length);
    this.lastPose = { frame, seconds, pairs: Array.from(crossing).slice(0, MOST_LISTED_PAIRS).map((pair) => this.surface.mesh.both(pair)), pairs_total: crossing.size, touching: met.length - crossing.size, left_out: all.length - met.length };
  }

  keep({ edges, vertices, times, normals, weights }, i, sides) {
    const { lists, surface } = this;
    lists.contact_kind.push(edges[i]);
    lists.contact_time.push(share(times[i]));
    lists.contact_along.push(edges[i] ? share(weights[3 * i]) : 0);
    for (let k = 0; k < 3; ++k) lists.contact_normal.push(Math.round(127 * normals[3 * i + k]));
    for (let k = 0; k < 4; ++k) lists.contact_vertex.push(vertices[4 * i + k]);
    for (const [t] of sides) lists.contact_place.push(surface.placeOf(t));
  }

  contactOf({ edges, vertices, faces, times, points, normals, weights }, i, sides) {
    const three = (row) => Array.from(row.subarray(3 * i, 3 * i + 3)), own = Array.from(vertices.subarray(4 * i, 4 * i + 4));
    const out = { kind: edges[i] ? "ee" : "vf", vertices: own, time: times[i], point: three(points), normal: three(normals) };
    if (!edges[i]) Object.assign(out, { vertex: own[0], triangle: faces[i] });
    out[edges[i] ? "edge_parameters" : "barycentric"] = three(weights).slice(0, edges[i] ? 2 : 3);
    [out.first, out.second] = sides.map(([t], side) => ({ part: this.surface.partName(t), bone: this.surface.boneName(own[side === 0 ? 0 : edges[i] ? 2 : 1]) }));
    return out;
  }

  // The curves of events at a start, and how deep which vertices lie in the other sheet. Each point of a curve lies on an edge of the
  // triangles that cross there. The pose that ends the clip starts no interval.
  keepOverlaps(x, { overlaps }, numbers, isEnd) {
    const { lists, surface: { mesh } } = this, inside = lists.inside_vertex.length, curvesBefore = lists.curve_points.length;
    let room = MOST_POINTS;
    overlaps.forEach(({ curves, regions }, o) => {
      if (numbers[o] === undefined || isEnd) return;
      for (const { faces, points, closed } of curves) {
        const segments = faces.length / 2, count = points.length / 3 + closed;
        if (count > room) continue;
        room -= count;
        for (let i = 0; i < count; ++i) {
          const at = i % (points.length / 3), near = [at - 1, at].map((s) => (closed ? (s + segments) % segments : s)).filter((s) => s >= 0 && s < segments);
          const [from, to, along] = nearestEdge(mesh, x, points.subarray(3 * at, 3 * at + 3), near.flatMap((s) => [faces[2 * s], faces[2 * s + 1]]));
          lists.curve_edge.push(from, to);
          lists.curve_share.push(share(along));
        }
        lists.curve_points.push(count);
        lists.curve_event.push(numbers[o]);
      }
      for (const { vertices, distances } of regions) vertices.forEach((v, k) => { lists.inside_vertex.push(v); lists.inside_depth.push(distances[k]); });
    });
    if (isEnd) return;
    lists.inside_count.push(lists.inside_vertex.length - inside);
    lists.curve_count.push(lists.curve_points.length - curvesBefore);
  }

  // Adds what meets in an interval to who met whom.
  meet(index, met, crossing, kept, verdict) {
    if (verdict === CLEAR) {
      this.parted ||= this.first !== undefined;
      return;
    }
    const { mesh, placeName } = this.surface, here = new Set();
    const when = met.length > 0 ? 0 : kept[0].time;
    if (!this.worst || crossing.size > this.worst.start_pairs || (crossing.size === this.worst.start_pairs && kept.length > this.worst.contacts))
      this.worst = { interval: index, time: when, start_pairs: crossing.size, contacts: kept.length };
    const take = (a, b, time, how) => {
      const names = [placeName(a), placeName(b)], key = [...names].sort().join("\0"), meeting = { interval: index, time, how, names };
      this.first ??= { ...meeting, time: when, how: verdict };
      if (this.parted) this.again ??= { ...meeting, time: when, how: verdict };
      if (!this.met.has(key)) this.met.set(key, { first: meeting, intervals: 0, contacts: 0, start_pairs: 0 });
      const entry = this.met.get(key);
      if (entry.first.interval === index && time < entry.first.time) entry.first = meeting;
      if (!here.has(key)) here.add(key), ++entry.intervals;
      return entry;
    };
    for (const pair of crossing) ++take(...mesh.both(pair), 0, CROSSES).start_pairs;
    for (const pair of met) if (!crossing.has(pair)) take(...mesh.both(pair), 0, TOUCHES);
    for (const { sides, time } of kept) ++take(sides[0][0], sides[1][0], time, TOUCHES).contacts;
  }

  // ---- Numbers and words ----

  moment(interval, time = 0) {
    const { clip, surface: { fps } } = this, of = (f) => (this.isPose ? 0 : clip.second(f));
    const seconds = time === 0 ? of(interval) : (1 - time) * of(interval) + time * of(interval + 1);
    return { frame: seconds * fps + clip.firstFrame, seconds };
  }
  // The last pose starts no interval: its moment is the end of the last one.
  momentJson(interval, time) {
    return { ...(interval === this.count ? { interval: interval - 1, time: 1 } : { interval, time }), ...this.moment(interval, time) };
  }
  frame(interval, time) { return String(Math.round(100 * this.moment(interval, time).frame) / 100); }
  momentText(interval, time) { return `frame ${this.frame(interval, time)} (${number(this.moment(interval, time).seconds, 4)} s${this.clip.firstFrame !== 0 ? " into the clip" : ""})`; }
  length(length) { return lengthText({ header: this.surface.header }, length); }

  subject() {
    const { name, clips, isSequence } = this.surface;
    if (!this.clip.frames || isSequence || clips.length === 0 || this.clip.number < 0) return name;
    const title = this.clip.name ? `clip '${this.clip.name}'` : "clip";
    return `${name}, ${clips.length === 1 ? (this.clip.name ? `${title} (the only one)` : "its only clip") : `${title} (${ordinal(this.clip.number + 1)} of ${many(clips.length, "clip")})`}`;
  }

  eventText({ names: [first, second], crosses, depth, at_rest, vertices, ...event }) {
    const most = `at most ${this.length(depth.at_most)}`, span = event.first === event.last ? `frame ${this.frame(event.first)}` : `frames ${this.frame(event.first)} to ${this.frame(event.last)}, deepest at ${this.frame(event.deepest)}`;
    return `${first}${crosses ? " in " : " touches "}${first === second ? "itself" : second}`
      + (isKnown({ depth }) ? `: ${this.length(depth.at_least)} deep (${most})` : crosses ? `: ${most} deep, depth not known` : "")
      + `${at_rest === null ? "" : `, deeper than at rest (${this.length(at_rest)})`}${vertices > 0 ? `, ${vertices === 1 ? "1 vertex" : `${vertices.toLocaleString("en")} vertices`}` : ""}, ${span}`;
  }

  worstText({ names: [first, second], depth, at_rest, ...event }) {
    const deep = `${first} is ${this.length(depth.at_least)} deep in ${first === second ? "itself" : second}${at_rest === null ? "" : `, deeper than at rest (${this.length(at_rest)})`}`;
    if (this.isPose) return deep;
    const frame = ` at frame ${this.frame(event.deepest)}`;
    return deep + (event.first === event.last ? `,${frame} alone` : `, deepest${frame} (frames ${this.frame(event.first)} to ${this.frame(event.last)})`);
  }

  meetingText({ names, how }) { return both(...names, how === CROSSES ? "crosses" : "touches").replace(/^it /, "the surface "); }

  predicate(named) {
    const { counts, count, sums } = this, of = (n) => `${n} of ${many(count, "interval")}`, frames = this.isPose ? " in its one pose" : ` in frames ${this.frame(0)} to ${this.frame(count)}`;
    const isDeeper = this.events.all.some(({ at_rest }) => at_rest !== null), rest = `what crosses at rest${isDeeper ? ", which comes to lie deeper than there" : ""}`;
    const apart = sums.withLeftOut > 0 || isDeeper ? `, apart from ${rest}` : "";
    if (!this.first) {
      const still = !sums.moves && !this.isPose;
      return `${still ? `does not move${frames}, and ` : ""}${apart ? `touches itself${still ? "" : frames} only in ${rest}` : `does not touch itself${still ? "" : frames}`}`;
    }
    const alone = this.onlyFolds(named.names) ? ", only at joints and less deep than a tenth of the limb's girth" : "";
    if (this.isPose) return `${counts[CROSSES] ? "crosses" : "touches"} itself in its one pose${alone}: ${counts[CROSSES] ? `${many(this.worst.start_pairs, "pair")} of triangles, ` : ""}${this.meetingText(named)}`;
    let text = counts[CROSSES] ? `crosses itself at the start of ${of(counts[CROSSES])}` : "";
    if (counts[TOUCHES]) text += text ? ` and touches itself in ${counts[TOUCHES]} more` : `touches itself in ${of(counts[TOUCHES])}`;
    text += `${alone}${apart}, first${named === this.first ? "" : " away from joints"} at ${this.momentText(named.interval, named.time)}: ${this.meetingText(named)}`;
    if (named.interval === 0 && named.time === 0 && this.again && !this.onlyFolds(this.again.names)) text += `; once it had parted, again at ${this.momentText(this.again.interval, this.again.time)}: ${this.meetingText(this.again)}`;
    return text;
  }

  onlyFolds(names) {
    const { joints } = this.surface, key = [...names].sort().join("\0");
    return joints.join(names) && this.events.all.every((event) => [...event.names].sort().join("\0") !== key || joints.fold(event));
  }

  sorted() { return Array.from(this.met).sort(([a], [b]) => (a < b ? -1 : 1)); }

  firstNamed() {
    if (!this.first || !this.onlyFolds(this.first.names)) return this.first;
    const others = this.sorted().map(([, { first }]) => first).filter(({ names }) => !this.onlyFolds(names));
    return others.reduce((a, b) => (b.interval < a.interval || (b.interval === a.interval && b.time < a.time) ? b : a), others[0]) ?? this.first;
  }

  details() {
    const { counts, count, worst, sums, surface } = this, { model } = surface, out = [];
    if (!this.isPose) out.push(`${many(count, "interval")}: ${counts[CLEAR]} clear, ${counts[TOUCHES]} touch, ${counts[CROSSES]} cross at their start`);
    if (worst && !this.isPose) out.push(`Worst: interval ${worst.interval}, from ${this.momentText(worst.interval)}: ${worst.start_pairs ? `${many(worst.start_pairs, "pair")} of triangles cross at its start, and ` : ""}${many(worst.contacts, "contact")}`);
    if (this.rest.crossing.length > 0) out.push(`Crosses at rest${surface.isSequence ? " (the first frame)" : ""}: ${many(this.rest.crossing.length, "pair")} of triangles; left out of ${many(sums.withLeftOut, "interval")}, with ${many(sums.leftOutContacts, "contact")}`);
    if (this.lastPose?.pairs_total > 0) out.push(`Ends crossed: ${many(this.lastPose.pairs_total, "pair")} of triangles cross in its last pose`);
    out.push(`${number(model.fps)} frames a second, ${{ file: "as the file says", keys: "as the keys of the file are spaced", assumed: "because the file does not say" }[model.fpsFrom]}`);
    out.push("Posed by three.js and answered in this page by cscd's library, every answer proven for straight lines between these frames");
    return out.map((line) => `${line[0].toUpperCase()}${line.slice(1)}.`).join(" ");
  }

  // What a page of cscd view holds of the clip: a header, and arrays.
  finish() {
    const { surface, events: { all: events }, counts, count, sums } = this, { joints } = surface;
    const folds = (event) => joints.fold(event), excess = (event) => event.depth.at_least - (event.at_rest ?? 0), named = this.firstNamed();
    const worst = this.first ? events.filter((event) => isKnown(event) && !folds(event)).reduce((a, b) => (!a || excess(b) > excess(a) ? b : a), null) : null;
    const eventJson = (event) => ({
      first: event.names[0], second: event.names[1], begins: this.momentJson(event.first, 0), deepest: this.momentJson(event.deepest, 0), ends: this.momentJson(event.last, 0),
      depth: event.depth, at_rest: event.at_rest, point: event.point, out: event.out, vertices: event.vertices, area: event.area, other_is_open: event.other_is_open,
      pairs: event.pairs, curves: event.curves, crosses: event.crosses, at_joint: folds(event), depth_at: event.depth_at,
    });
    const met = this.sorted().map(([key, entry]) => ({ first: key.split("\0")[0], second: key.split("\0")[1], intervals: entry.intervals, contacts: entry.contacts, start_pairs: entry.start_pairs, at_joint: this.onlyFolds(key.split("\0")) })).sort((a, b) => b.intervals - a.intervals);
    const sentences = worst ? [`${this.subject()}: ${this.worstText(worst)}.`] : [];
    const touching = met.filter((row) => row.start_pairs === 0 && !row.at_joint);
    if (worst && touching.length > 0) sentences.push(`These only touch: ${touching.slice(0, 3).map(({ first, second }) => `${first} and ${first === second ? "itself" : second}`).join(", ")}${touching.length > 3 ? `, and ${many(touching.length - 3, "more pair")}` : ""}.`);
    sentences.push(worst ? `It ${this.predicate(named)}.` : `${this.subject()}${this.subject() === surface.name ? "" : ","} ${this.predicate(named)}.`);
    const { first, second, begins, deepest, ends, depth, at_rest } = worst ? eventJson(worst) : {};
    const summary = {
      verdict: WORDS[counts[CROSSES] ? CROSSES : counts[TOUCHES] ? TOUCHES : CLEAR], sentence: sentences.join(" "),
      headline: worst && { event: events.indexOf(worst), text: this.worstText(worst), first, second, begins, deepest, ends, depth, at_rest },
      intervals: count, clear: counts[CLEAR], touches: counts[TOUCHES], intersects_at_start: counts[CROSSES], undecided: 0, proven: count,
      with_left_out: sums.withLeftOut, left_out_contacts: sums.leftOutContacts, first: this.first ? this.momentJson(this.first.interval, this.first.time) : null,
      first_named: named ? { ...this.momentJson(named.interval, named.time), first: named.names[0], second: named.names[1] } : null,
      worst: this.worst ? { ...this.momentJson(this.worst.interval, this.worst.time), start_pairs: this.worst.start_pairs, contacts: this.worst.contacts } : null,
      met, events: events.map(eventJson),
    };
    const order = events.map((_, i) => i).sort((a, b) => folds(events[a]) - folds(events[b]) || events[b].depth.at_least - events[a].depth.at_least || events[b].depth.at_most - events[a].depth.at_most);
    const arrays = Object.fromEntries(Object.entries(TYPES).map(([name, Type]) => [name, Type.from(this.lists[name])]));
    for (const [name, Type] of Object.entries(OWN_TYPES)) arrays[`s0.${name}`] = Type.from(this.lists[name]);
    const row = this.touched[0].length, touched = (arrays["s0.touched"] = new Uint8Array(row * count));
    this.touched.forEach((bits, i) => touched.set(bits, row * i));
    arrays["s0.proven"] = new Uint8Array(count).fill(1);
    arrays["s0.answerer"] = new Uint8Array(count);
    const rest = { pairs: this.rest.crossing.length, touching: this.rest.touching.length, left_out: !this.keepsRest };
    return {
      events: order.map((i) => ({ event: i, text: this.eventText(events[i]) })), rest, arrays,
      strategy: { name: "the library", answered_by: ["the library for WebAssembly"], covers: 0, has_clusters: false, has_patches: false, summary, sentences, details: this.details() },
      json: { one_pose: this.isPose, first_only: false, rest_crossings: rest, last_pose: this.lastPose ?? null, summary, intervals: this.intervals },
    };
  }
}

// The edge of some triangles that is nearest to a point, and the share of the way along it.
function nearestEdge({ corners }, x, p, triangles) {
  let best, least = Infinity;
  for (const t of triangles)
    for (let k = 0; k < 3; ++k) {
      const a = corners[3 * t + k], b = corners[3 * t + (k + 1) % 3];
      const wx = x[3 * b] - x[3 * a], wy = x[3 * b + 1] - x[3 * a + 1], wz = x[3 * b + 2] - x[3 * a + 2];
      const px = p[0] - x[3 * a], py = p[1] - x[3 * a + 1], pz = p[2] - x[3 * a + 2];
      const along = Math.min(1, Math.max(0, (wx * px + wy * py + wz * pz) / (wx * wx + wy * wy + wz * wz || 1)));
      const off = (px - along * wx) ** 2 + (py - along * wy) ** 2 + (pz - along * wz) ** 2;
      if (best === undefined || off < least) best = [a, b, along], least = off;
    }
  return best;
}
