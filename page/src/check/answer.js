// Asks the library about every interval of a clip, and sums up what it says as `cscd query` does (bench/answer). Returns what a page
// of `cscd view` holds of a clip.
import { both, CLOSE, lengthText, many, momentAt, number } from "../words.js";
import { Events, isKnown } from "./events.js";
import { RestCrossings, tellApart } from "./mesh.js";

const [CLEAR, TOUCHES, CROSSES] = [0, 1, 2], WORDS = ["clear", "touches", "intersects_at_start", "undecided", "close"];
const MOST_NAMED = 5;  // pairs of places, in a sentence
const MOST_CONTACTS = 2000, MOST_PAIRS = 4000, MOST_POINTS = 20000;  // kept of an interval, for the page
const MOST_LISTED_PAIRS = 1000, MOST_LISTED = 200000;                // in the JSON: of an interval, and contacts of a clip

const share = (x) => Math.round(65535 * Math.min(1, Math.max(0, x)));

// What grows interval by interval: lists of numbers, by their names in the page.
const TYPES = { inside_count: Uint32Array, inside_vertex: Int32Array, inside_depth: Float32Array, curve_count: Uint32Array, curve_points: Uint32Array, curve_event: Uint32Array, curve_edge: Int32Array, curve_share: Uint16Array };
const OWN_TYPES = { verdict: Uint8Array, milliseconds: Float32Array, contacts: Uint32Array, start_pairs: Uint32Array, kept_contacts: Uint32Array, kept_pairs: Uint32Array, contact_kind: Uint8Array, contact_time: Uint16Array, contact_along: Uint16Array, contact_normal: Int8Array, contact_vertex: Int32Array, contact_place: Uint16Array, crossing: Int32Array };

// The features of a contact as text: equal texts are one pair of features.
const featuresOf = ({ edges, vertices }, i) => `${edges[i]} ${vertices.subarray(4 * i, 4 * i + 4).join()}`;

// Answers all intervals of a clip; `tell` is called with the number of intervals that are answered.
export function answerClip(surface, clip, settings, tell) {
  const answer = new ClipAnswer(surface, clip, settings);
  let end;
  for (let f = 0; f < answer.count; ++f) {
    const start = surface.startOf(clip, f, end);
    answer.add(start, (end = surface.endOf(clip, f)));
    tell(f + 1);
  }
  if (!answer.isPose) answer.end(surface.startOf(clip, answer.count, end));
  return answer.finish();
}

export class ClipAnswer {
  // `settings` say what counts: {thickness: {text, length}, ignores(a, b) of two triangles, asked: the same in words}, each of which
  // may be left out.
  constructor(surface, clip, { thickness = null, ignores = null, asked = "" } = {}) {
    const { mesh, atRest } = surface;
    Object.assign(this, { surface, clip, thickness, ignores, asked, isPose: clip.frames < 2, from: clip.shown.first_interval });
    this.keepsRest = surface.keepsRest(clip);
    this.rest = this.keepsRest ? new RestCrossings(mesh, [], atRest.met) : atRest.rest.anew();
    this.events = new Events(surface, this.rest, this.keepsRest ? [] : atRest.depths, ignores);
    this.lists = Object.fromEntries(Object.keys({ ...TYPES, ...OWN_TYPES }).map((name) => [name, []]));
    this.touched = [];
    this.close = [];
    this.touches = [];  // of each kept contact, with a thickness
    this.intervals = [];
    this.met = new Map();
    this.ignored = new Map();
    this.counts = [0, 0, 0, 0, 0];
    this.sums = { withLeftOut: 0, leftOutContacts: 0, withIgnored: 0, closeAtStart: 0, withCloseAtStart: 0, listed: 0, moves: false };
    this.count = Math.max(1, clip.frames - 1);
  }

  // The pairs of triangles that meet in a pose, what the library says of it, and which pairs pass through each other.
  meetings(start, startCrossings) {
    const { mesh, body } = this.surface, all = [];
    for (let i = 0; i < startCrossings.length; i += 2) all.push(mesh.pair(startCrossings[i], startCrossings[i + 1]));
    all.sort((a, b) => a - b);
    this.rest.follow(all);
    const ignored = this.ignores ? all.filter((pair) => this.ignores(...mesh.both(pair))) : [], isIgnored = new Set(ignored);
    const met = all.filter((pair) => !isIgnored.has(pair) && !this.rest.explains(pair));
    if (all.length === ignored.length) return { all, ignored, met, crossing: new Set(), found: { overlaps: [] } };
    const found = body.crossings(start);
    return { all, ignored, met, found, crossing: tellApart(mesh, start, met, found) };
  }

  // Takes the next interval.
  add(start, end) {
    const { mesh, body, thickBody } = this.surface, index = this.intervals.length, { lists } = this, begin = performance.now();
    const touching = body.allContacts(start, end), answer = this.thickness ? thickBody.allContacts(start, end) : touching;
    const { all, ignored, met, crossing, found } = this.meetings(start, touching.startCrossings);
    const milliseconds = performance.now() - begin, kept = [], left = [];
    const doTouch = this.thickness && new Set(Array.from({ length: touching.count }, (_, i) => featuresOf(touching, i)));
    for (let i = 0; i < answer.count; ++i) {
      const sides = mesh.sidesOf(answer, i), pair = this.pairOf(sides);
      if (!pair) left.push(sides);
      else if (!this.rest.explainsContact(sides)) kept.push({ i, sides, pair, time: answer.times[i], touches: !doTouch || doTouch.has(featuresOf(answer, i)) });
    }
    const touches = met.length > 0 || kept.some((contact) => contact.touches);
    const verdict = crossing.size > 0 ? CROSSES : touches ? TOUCHES : kept.length > 0 ? CLOSE : CLEAR;
    const explained = { pairs: all.length - met.length - ignored.length, contacts: answer.count - kept.length - left.length };
    const atStart = this.thickness ? kept.filter(({ time }) => time === 0).length : 0;
    this.sums.moves ||= start.some((x, k) => Math.abs(end[k] - x) > 1e-9 * this.surface.size);
    this.sums.withLeftOut += explained.pairs + explained.contacts > 0;
    this.sums.leftOutContacts += explained.contacts;
    this.sums.withIgnored += ignored.length + left.length > 0;
    this.sums.closeAtStart += atStart;
    this.sums.withCloseAtStart += atStart > 0;
    this.meet(index, met, crossing, kept, verdict);
    this.countIgnored(ignored, left);
    ++this.counts[verdict];
    const bitsOf = (contacts) => {
      const bits = new Uint8Array(Math.ceil(mesh.triangles / 8));
      for (const { sides } of contacts) for (const t of sides.flat()) bits[t >> 3] |= 1 << (t & 7);
      return bits;
    };
    this.touched.push(bitsOf(kept.filter((contact) => contact.touches)));
    if (this.thickness) this.close.push(bitsOf(kept.filter((contact) => !contact.touches)));
    const pairs = Array.from(crossing, (pair) => mesh.both(pair)), few = kept.slice(0, MOST_CONTACTS);
    lists.verdict.push(verdict);
    lists.milliseconds.push(milliseconds);
    lists.contacts.push(kept.length);
    lists.start_pairs.push(pairs.length);
    lists.kept_contacts.push(few.length);
    lists.kept_pairs.push(Math.min(MOST_PAIRS, pairs.length));
    for (const { i, pair } of few) this.keep(answer, i, pair);
    if (this.thickness) for (const contact of few) this.touches.push(Number(contact.touches));
    for (const pair of pairs.slice(0, MOST_PAIRS)) lists.crossing.push(...pair);
    this.keepOverlaps(start, found, this.events.add(index, start, crossing, found));
    const row = {
      index: this.from + index, ...this.moment(index), verdict: WORDS[verdict], collides: verdict !== CLEAR, time: kept[0]?.time ?? null, starts_embedded: all.length === 0,
      start_pairs: pairs.slice(0, MOST_LISTED_PAIRS), start_pairs_total: pairs.length, start_touching: met.length - crossing.size,
      left_out: { start_pairs: explained.pairs, contacts: explained.contacts }, ms: { wall: milliseconds },
    };
    this.sums.listed += kept.length;
    if (kept.length === few.length && this.sums.listed <= MOST_LISTED) row.contacts = few.map(({ i, pair }) => this.contactOf(answer, i, pair));
    this.intervals.push(row);
  }

  // The pose in which the last interval ends: what crosses there may be deepest.
  end(pose) {
    const { all, ignored, met, crossing, found } = this.meetings(pose, this.surface.body.allContacts(pose, pose).startCrossings);
    this.keepOverlaps(pose, found, this.events.add(this.intervals.length, pose, crossing, found), true);
    const { frame, seconds } = this.moment(this.intervals.length);
    this.lastPose = { frame, seconds, pairs: Array.from(crossing).slice(0, MOST_LISTED_PAIRS).map((pair) => this.surface.mesh.both(pair)), pairs_total: crossing.size, touching: met.length - crossing.size, left_out: all.length - met.length - ignored.length };
  }

  // A triangle of each side, both of which count against each other; undefined where all such pairs are ignored.
  pairOf([first, second]) {
    if (!this.ignores) return [first[0], second[0]];
    for (const s of first) for (const t of second) if (s !== t && !this.ignores(s, t)) return [s, t];
    return first.length === 0 ? [undefined, second[0]] : undefined;
  }

  // Adds what is ignored in an interval, by the places: pairs of triangles that meet, and both sides of contacts.
  countIgnored(pairs, contacts) {
    const { mesh, placeName } = this.surface, here = new Set();
    const entryOf = (a, b) => {
      const key = [placeName(a), placeName(b)].sort().join("\0"), entry = this.ignored.get(key) ?? this.ignored.set(key, { intervals: 0, contacts: 0, start_pairs: 0 }).get(key);
      if (!here.has(key)) here.add(key), ++entry.intervals;
      return entry;
    };
    for (const pair of pairs) ++entryOf(...mesh.both(pair)).start_pairs;
    for (const [[a], [b]] of contacts) ++entryOf(a, b).contacts;
  }

  keep({ edges, vertices, times, normals, weights }, i, pair) {
    const { lists, surface } = this;
    lists.contact_kind.push(edges[i]);
    lists.contact_time.push(share(times[i]));
    lists.contact_along.push(edges[i] ? share(weights[3 * i]) : 0);
    for (let k = 0; k < 3; ++k) lists.contact_normal.push(Math.round(127 * normals[3 * i + k]));
    for (let k = 0; k < 4; ++k) lists.contact_vertex.push(vertices[4 * i + k]);
    for (const t of pair) lists.contact_place.push(surface.placeOf(t));
  }

  contactOf({ edges, vertices, faces, times, points, normals, weights }, i, pair) {
    const three = (row) => Array.from(row.subarray(3 * i, 3 * i + 3)), own = Array.from(vertices.subarray(4 * i, 4 * i + 4));
    const out = { kind: edges[i] ? "ee" : "vf", vertices: own, time: times[i], point: three(points), normal: three(normals) };
    if (!edges[i]) Object.assign(out, { vertex: own[0], triangle: faces[i] });
    out[edges[i] ? "edge_parameters" : "barycentric"] = three(weights).slice(0, edges[i] ? 2 : 3);
    [out.first, out.second] = pair.map((t, side) => ({ part: this.surface.partName(t), bone: this.surface.boneName(own[side === 0 ? 0 : edges[i] ? 2 : 1]) }));
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
    const when = met.length > 0 ? 0 : kept[0].time, near = this.thickness ? CLOSE : TOUCHES, how = met.length === 0 ? near : verdict;
    if (this.first && when > 0) this.parted = true;
    if (!this.worst || crossing.size > this.worst.start_pairs || (crossing.size === this.worst.start_pairs && kept.length > this.worst.contacts))
      this.worst = { interval: index, time: when, start_pairs: crossing.size, contacts: kept.length };
    const take = (a, b, time, manner) => {
      const names = [placeName(a), placeName(b)], key = [...names].sort().join("\0"), meeting = { interval: index, time, how: manner, names };
      this.first ??= { ...meeting, time: when, how };
      if (this.parted) this.again ??= { ...meeting, time: when, how };
      if (!this.met.has(key)) this.met.set(key, { first: meeting, intervals: 0, contacts: 0, start_pairs: 0 });
      const entry = this.met.get(key);
      if (entry.first.interval === index && time < entry.first.time) entry.first = meeting;
      if (!here.has(key)) here.add(key), ++entry.intervals;
      return entry;
    };
    for (const pair of crossing) ++take(...mesh.both(pair), 0, CROSSES).start_pairs;
    for (const pair of met) if (!crossing.has(pair)) take(...mesh.both(pair), 0, TOUCHES);
    for (const { pair, time } of kept) ++take(...pair, time, near).contacts;
  }

  // ---- Numbers and words ----

  moment(interval, time = 0) { return momentAt(this.clip.shown, interval, time); }
  // The last pose starts no interval: its moment is the end of the last one.
  momentJson(interval, time) {
    const { from } = this;
    return { ...(interval === this.count ? { interval: from + interval - 1, time: 1 } : { interval: from + interval, time }), ...this.moment(interval, time) };
  }
  frame(interval, time) { return String(Math.round(100 * this.moment(interval, time).frame) / 100); }
  momentText(interval, time) {
    const { seconds } = this.moment(interval, time), late = this.clip.shown.first_frame !== 0 ? " into the clip" : "";
    return `frame ${this.frame(interval, time)}${seconds === null ? "" : ` (${number(seconds, 4)} s${late})`}`;
  }
  length(length) { return lengthText({ header: this.surface.header }, length); }

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

  meetingText({ names, how }) { return both(...names, how === CROSSES ? "crosses" : how === CLOSE ? "comes close to" : "touches").replace(/^it /, "the surface "); }

  predicate(named) {
    const { counts, count, sums } = this, of = (n) => `${n} of ${many(count, "interval")}`, frames = this.isPose ? " in its one pose" : ` in frames ${this.frame(0)} to ${this.frame(count)}`;
    const isDeeper = this.events.all.some(({ at_rest }) => at_rest !== null), rest = `what crosses at rest${isDeeper ? ", which comes to lie deeper than there" : ""}`;
    const exceptions = [...(sums.withLeftOut > 0 || isDeeper ? [rest] : []), ...(sums.withIgnored > 0 ? ["what is ignored"] : [])].join(" and ");
    const apart = exceptions && `, apart from ${exceptions}`, near = this.thickness ? `within ${this.thickness.text} of itself` : "itself";
    if (!this.first) {
      const still = !sums.moves && !this.isPose, where = still ? "" : frames, [come, comes] = this.thickness ? ["come", "comes"] : ["touch", "touches"];
      return `${still ? `does not move${frames}, and ` : ""}${exceptions ? `${comes} ${near}${where} only in ${exceptions}` : `does not ${come} ${near}${where}`}`;
    }
    const alone = this.onlyFolds(named.names) ? ", only at joints and less deep than a tenth of the limb's girth" : "";
    if (this.isPose) return `${counts[CROSSES] ? "crosses itself" : counts[TOUCHES] ? "touches itself" : `comes ${near}`} in its one pose${alone}${apart}: ${counts[CROSSES] ? `${many(this.worst.start_pairs, "pair")} of triangles, ` : ""}${this.meetingText(named)}`;
    let text = counts[CROSSES] ? `crosses itself at the start of ${of(counts[CROSSES])}` : "";
    if (counts[TOUCHES]) text += text ? ` and touches itself in ${counts[TOUCHES]} more` : `touches itself in ${of(counts[TOUCHES])}`;
    if (counts[CLOSE]) text += `${text ? " and " : ""}comes ${near} in ${text ? `${counts[CLOSE]} more` : of(counts[CLOSE])}`;
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
    const { counts, count, worst, sums, surface, thickness } = this, out = [];
    if (!this.isPose) out.push(`${many(count, "interval")}: ${counts[CLEAR]} clear, ${thickness ? `${counts[CLOSE]} close, ` : ""}${counts[TOUCHES]} touch, ${counts[CROSSES]} cross at their start`);
    if (thickness) out.push(`Thickness ${thickness.text}${sums.closeAtStart > 0 ? `; ${many(sums.closeAtStart, "pair")} of features ${sums.closeAtStart === 1 ? "is" : "are"} this close at the start of ${many(sums.withCloseAtStart, "interval")}` : ""}`);
    if (worst && !this.isPose) out.push(`Worst: interval ${this.from + worst.interval}, from ${this.momentText(worst.interval)}: ${worst.start_pairs ? `${many(worst.start_pairs, "pair")} of triangles cross at its start, and ` : ""}${many(worst.contacts, thickness ? "close pair" : "contact")}`);
    if (this.ignores) out.push(this.ignoredText());
    if (this.rest.crossing.length > 0) out.push(`Crosses at rest${surface.isSequence ? " (the first frame)" : ""}: ${many(this.rest.crossing.length, "pair")} of triangles; left out of ${many(sums.withLeftOut, "interval")}, with ${many(sums.leftOutContacts, "contact")}`);
    if (this.lastPose?.pairs_total > 0) out.push(`Ends crossed: ${many(this.lastPose.pairs_total, "pair")} of triangles cross in its last pose`);
    out.push(...surface.notes());
    return out.map((line) => `${line[0].toUpperCase()}${line.slice(1)}.`).join(" ");
  }

  ignoredText() {
    const { sums } = this, rows = Array.from(this.ignored).sort(([a, x], [b, y]) => y.intervals - x.intervals || (a < b ? -1 : 1)), total = (key) => rows.reduce((sum, [, row]) => sum + row[key], 0);
    if (rows.length === 0) return `Ignored: nothing that touches (${this.asked})`;
    const names = rows.slice(0, MOST_NAMED).map(([key, { intervals }]) => `${both(...key.split("\0"), "and")} (${many(intervals, "interval")})`).join(", ");
    return `Ignored: ${names}${rows.length > MOST_NAMED ? `, and ${rows.length - MOST_NAMED} more` : ""}; ${many(total("contacts"), "contact")} and ${many(total("start_pairs"), "crossing pair")} of triangles in ${many(sums.withIgnored, "interval")} (${this.asked})`;
  }

  // What a page of cscd view holds of the clip: a header, and arrays.
  finish() {
    const { surface, events: { all: events }, counts, count, sums, thickness } = this, { joints } = surface, subject = surface.subjectOf(this.clip);
    const folds = (event) => joints.fold(event), excess = (event) => event.depth.at_least - (event.at_rest ?? 0), named = this.firstNamed();
    const worst = this.first ? events.filter((event) => isKnown(event) && !folds(event)).reduce((a, b) => (!a || excess(b) > excess(a) ? b : a), null) : null;
    const eventJson = (event) => ({
      first: event.names[0], second: event.names[1], begins: this.momentJson(event.first, 0), deepest: this.momentJson(event.deepest, 0), ends: this.momentJson(event.last, 0),
      depth: event.depth, at_rest: event.at_rest, point: event.point, out: event.out, vertices: event.vertices, area: event.area, other_is_open: event.other_is_open,
      pairs: event.pairs, curves: event.curves, crosses: event.crosses, at_joint: folds(event), depth_at: event.depth_at,
    });
    const met = this.sorted().map(([key, entry]) => ({ first: key.split("\0")[0], second: key.split("\0")[1], intervals: entry.intervals, contacts: entry.contacts, start_pairs: entry.start_pairs, at_joint: this.onlyFolds(key.split("\0")) })).sort((a, b) => b.intervals - a.intervals);
    const sentences = worst ? [`${subject}: ${this.worstText(worst)}.`] : [];
    const touching = met.filter((row) => row.start_pairs === 0 && !row.at_joint);
    if (worst && !thickness && touching.length > 0) sentences.push(`These only touch: ${touching.slice(0, 3).map(({ first, second }) => `${first} and ${first === second ? "itself" : second}`).join(", ")}${touching.length > 3 ? `, and ${many(touching.length - 3, "more pair")}` : ""}.`);
    sentences.push(worst ? `It ${this.predicate(named)}.` : `${subject}${subject === surface.name ? "" : ","} ${this.predicate(named)}.`);
    const { first, second, begins, deepest, ends, depth, at_rest } = worst ? eventJson(worst) : {};
    const summary = {
      verdict: WORDS[[CROSSES, TOUCHES, CLOSE].find((verdict) => counts[verdict] > 0) ?? CLEAR], sentence: sentences.join(" "),
      headline: worst && { event: events.indexOf(worst), text: this.worstText(worst), first, second, begins, deepest, ends, depth, at_rest },
      intervals: count, clear: counts[CLEAR], touches: counts[TOUCHES], intersects_at_start: counts[CROSSES], undecided: 0, proven: count,
      with_left_out: sums.withLeftOut, left_out_contacts: sums.leftOutContacts, first: this.first ? this.momentJson(this.first.interval, this.first.time) : null,
      first_named: named ? { ...this.momentJson(named.interval, named.time), first: named.names[0], second: named.names[1] } : null,
      worst: this.worst ? { ...this.momentJson(this.worst.interval, this.worst.time), start_pairs: this.worst.start_pairs, contacts: this.worst.contacts } : null,
      met, events: events.map(eventJson),
    };
    if (thickness) summary.close = counts[CLOSE];
    const order = events.map((_, i) => i).sort((a, b) => folds(events[a]) - folds(events[b]) || events[b].depth.at_least - events[a].depth.at_least || events[b].depth.at_most - events[a].depth.at_most);
    const arrays = Object.fromEntries(Object.entries(TYPES).map(([name, Type]) => [name, Type.from(this.lists[name])]));
    for (const [name, Type] of Object.entries(OWN_TYPES)) arrays[`s0.${name}`] = Type.from(this.lists[name]);
    const rowsOf = (rows) => rows.reduce((all, bits, i) => (all.set(bits, bits.length * i), all), new Uint8Array(rows[0].length * count));
    arrays["s0.touched"] = rowsOf(this.touched);
    if (thickness) Object.assign(arrays, { "s0.close": rowsOf(this.close), "s0.contact_touches": Uint8Array.from(this.touches) });
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
