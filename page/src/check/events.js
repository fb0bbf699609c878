// Pieces of the surface that lie in each other for some time, followed from frame to frame (bench/answer/overlap_events.h), and
// which of them only fold at joints (bench/answer/joints.h).
const DEEPER = 1.1;    // than at rest, by more than what bends there
const SHARE = 0.1;     // of the girth of the thinner limb, below which a joint only folds
const ROUNDING = 1e-9; // a share of the bound below which a depth is nothing but rounding

export const isKnown = ({ depth }) => depth.at_least > ROUNDING * depth.at_most;
const segmentsOf = ({ curves }) => curves.flatMap(({ faces }) => Array.from({ length: faces.length / 2 }, (_, i) => [faces[2 * i], faces[2 * i + 1]]));

// What most of the given keys name in `marks`, or undefined.
function mostNamed(marks, keys) {
  const count = new Map();
  for (const key of keys) for (const event of marks.get(key) ?? []) count.set(event, (count.get(event) ?? 0) + 1);
  return Array.from(count).reduce((best, one) => (one[1] > best[1] || (one[1] === best[1] && one[0] < best[0]) ? one : best), [undefined, 0])[0];
}
const mark = (marks, key, event) => (marks.has(key) ? marks.get(key).push(event) : marks.set(key, [event]));

// How deep the overlaps at rest are, and which triangles are near each (bench/answer/rest_depths.h).
export const restDepths = (mesh, { overlaps }) => overlaps.map((overlap) => ({
  depth: overlap.depth > 0 ? overlap.depth : overlap.depthBound,
  near: new Set(Array.from(new Set(segmentsOf(overlap).flat())).flatMap((t) => Array.from(mesh.within(t, 2)))),
}));

export class Events {
  // `rest` is what crosses at rest, `restDepths` how deep what lies in what there, and `ignores` says of two triangles whether they are
  // ignored; null where none are.
  constructor(surface, rest, restDepths, ignores) {
    const { mesh } = surface;
    Object.assign(this, { surface, mesh, rest, restDepths, ignores, all: [], vertices: new Map(), pairs: new Map(), goingOn: new Set() });
  }

  // Which side of each curve the deepest region lies on, where vertices of it lie beside the curve. Of two sides, that of the
  // vertex that comes first counts.
  sidesOf({ curves, regions: [deepest] }) {
    if (!deepest) return curves.map(() => 0);
    const place = new Map(Array.from(deepest.vertices, (v, i) => [v, i])), sides = new Map();
    for (let i = 0; i < deepest.bounds.length; i += 2) {
      const [c, side] = deepest.bounds.subarray(i, i + 2), { faces } = curves[c];
      let first = Infinity;
      for (let f = side; f < faces.length; f += 2) for (const v of this.mesh.cornersOf(faces[f])) first = Math.min(first, place.get(v) ?? Infinity);
      if (first < (sides.get(c)?.first ?? Infinity)) sides.set(c, { side, first });
    }
    return curves.map((_, c) => (sides.size > 0 ? sides.get(c)?.side : 0));
  }

  // The places between which most segments of the curves run, the one of the deepest region first.
  namesOf(overlap) {
    const { surface } = this, count = new Map(), sides = this.sidesOf(overlap);
    overlap.curves.forEach(({ faces }, c) => {
      for (let i = 0; sides[c] !== undefined && i < faces.length; i += 2) {
        const [own, other] = [faces[i + sides[c]], faces[i + 1 - sides[c]]], a = surface.placeNumber(own), b = surface.placeNumber(other), key = `${a} ${b}`;
        const entry = count.get(key) ?? count.set(key, { a, b, times: 0, own, other }).get(key);
        Object.assign(entry, { own, other, times: entry.times + 1 });
      }
    });
    const { own, other } = Array.from(count.values()).reduce((x, y) => (y.times - x.times || x.a - y.a || x.b - y.b) > 0 ? y : x);
    return [surface.placeName(own), surface.placeName(other)];
  }

  // Takes what overlaps at the start of an interval: `crossing` are the pairs of triangles that pass through each other there, and
  // `found` is what the library says. Returns the number of each overlap's event, or undefined.
  add(interval, x, crossing, found) {
    const { mesh, rest } = this, vertices = new Map(), pairs = new Map(), goingOn = new Set();
    const numbers = found.overlaps.map((overlap) => {
      const { curves, regions } = overlap, segments = segmentsOf(overlap);
      if (segments.length === 0) return undefined;
      const left = segments.filter(([a, b]) => !this.ignores?.(a, b)), ignored = segments.length - left.length;
      const explained = left.filter(([a, b]) => rest.explains(mesh.pair(a, b))).length;
      let atRest = null;
      if (2 * (left.length - explained) <= segments.length && ignored + explained > 0) {
        if (2 * ignored >= segments.length) return undefined;
        atRest = this.restDepths.filter(({ near }) => segments.some(([a, b]) => near.has(a) && near.has(b))).reduce((most, { depth }) => Math.max(most, depth), 0);
        if (!(overlap.depth > DEEPER * atRest)) return undefined;
      }
      const names = this.namesOf(overlap);
      const other = (region) => mesh.component[curves[region.bounds[0]].faces[1 - region.bounds[1]]];
      const marked = regions.filter(({ bounds }) => bounds.length > 0).flatMap((region) => Array.from(region.vertices, (v) => v * mesh.components + other(region)));
      const own = segments.map(([a, b]) => mesh.pair(a, b));
      const number = mostNamed(this.vertices, marked) ?? mostNamed(this.pairs, own)
        ?? Array.from(this.goingOn).find((n) => [...this.all[n].names].sort().join("\0") === [...names].sort().join("\0")) ?? this.all.push({ names, depth_at: [] }) - 1;
      this.extend(this.all[number], interval, x, overlap, names, segments, crossing, atRest);
      marked.forEach((key) => mark(vertices, key, number));
      own.forEach((key) => mark(pairs, key, number));
      goingOn.add(number);
      return number;
    });
    Object.assign(this, { vertices, pairs, goingOn });
    return numbers;
  }

  extend(event, interval, x, overlap, names, segments, crossing, atRest) {
    const { curves, regions: [deepest], depth, depthBound } = overlap, isNew = event.depth_at.length === 0;
    if (isNew) event.first = interval;
    event.last = interval;
    while (event.depth_at.length < interval - event.first + 1) event.depth_at.push(0);
    event.depth_at[interval - event.first] = Math.max(event.depth_at[interval - event.first], depth);
    if (!isNew && (depth < event.depth.at_least || (depth === event.depth.at_least && depthBound <= event.depth.at_most))) return;
    const known = deepest && deepest.depth > 0 && deepest.deepest >= 0;
    Object.assign(event, {
      names, deepest: interval, depth: { at_least: depth, at_most: depthBound }, at_rest: atRest, curves: curves.length, pairs: segments.length,
      crosses: atRest !== null || segments.some(([a, b]) => crossing.has(this.mesh.pair(a, b))), vertices: deepest?.vertices.length ?? 0, area: deepest?.area ?? 0,
      point: Array.from(known ? x.subarray(3 * deepest.deepest, 3 * deepest.deepest + 3) : curves[0].points.subarray(0, 3)), out: known ? Array.from(deepest.out) : null,
      other_is_open: deepest?.otherIsOpen ?? false,
    });
  }
}

// The circumference of a round limb whose corners have the same spread: the middle eigenvalue of their variance counts.
function girthOf({ weight, sum, squares }) {
  if (!(weight > 0)) return 0;
  const m = sum.map((s) => s / weight), c = (i, j) => squares[3 * i + j] / weight - m[i] * m[j], q = (c(0, 0) + c(1, 1) + c(2, 2)) / 3;
  const off = c(0, 1) ** 2 + c(0, 2) ** 2 + c(1, 2) ** 2, p = Math.sqrt(((c(0, 0) - q) ** 2 + (c(1, 1) - q) ** 2 + (c(2, 2) - q) ** 2 + 2 * off) / 6);
  if (!(p > 0)) return 2 * Math.PI * Math.sqrt(2 * Math.max(0, q));
  const b = (i, j) => (c(i, j) - (i === j ? q : 0)) / p;
  const half = (b(0, 0) * (b(1, 1) * b(2, 2) - b(1, 2) ** 2) - b(0, 1) * (b(0, 1) * b(2, 2) - b(1, 2) * b(0, 2)) + b(0, 2) * (b(0, 1) * b(1, 2) - b(1, 1) * b(0, 2))) / 2;
  const angle = Math.acos(Math.min(1, Math.max(-1, half))) / 3, most = q + 2 * p * Math.cos(angle), least = q + 2 * p * Math.cos(angle + (2 * Math.PI) / 3);
  return 2 * Math.PI * Math.sqrt(2 * Math.max(0, 3 * q - most - least));
}

export class Joints {
  // `x` is the pose at rest; `boneOf` gives the number of a triangle's bone, or -1; `parent` is that of each bone.
  constructor(mesh, x, placeOf, boneOf, parent) {
    const spread = new Map(), joined = (this.joined = new Set());
    const join = (a, b) => joined.add(`${a}\0${b}`).add(`${b}\0${a}`);
    for (let t = 0; t < mesh.triangles; ++t) {
      const name = placeOf(t), bone = boneOf(t), key = `${bone} ${name}`, [p, q, r] = mesh.cornersOf(t), d = (v, k) => x[3 * v + k] - x[3 * p + k];
      if (!spread.has(key)) spread.set(key, { name, bone, weight: 0, sum: [0, 0, 0], squares: new Array(9).fill(0) });
      const own = spread.get(key), weight = Math.hypot(d(q, 1) * d(r, 2) - d(q, 2) * d(r, 1), d(q, 2) * d(r, 0) - d(q, 0) * d(r, 2), d(q, 0) * d(r, 1) - d(q, 1) * d(r, 0)) / 6;
      for (const v of mesh.cornersOf(t)) {
        own.weight += weight;
        for (let i = 0; i < 3; ++i) {
          own.sum[i] += weight * x[3 * v + i];
          for (let j = 0; j < 3; ++j) own.squares[3 * i + j] += weight * x[3 * v + i] * x[3 * v + j];
        }
      }
      if (parent.length === 0) for (const v of mesh.cornersOf(t)) for (const other of mesh.around(v)) if (placeOf(other) !== name) join(name, placeOf(other));
    }
    this.girth = new Map();
    const nameOf = new Map();
    for (const { name, bone, ...own } of spread.values()) {
      this.girth.set(name, Math.min(this.girth.get(name) ?? Infinity, girthOf(own)));
      if (bone >= 0) nameOf.set(bone, name);
    }
    if (parent.length === 1) return;  // one node moves the whole surface, and has no joint
    for (const [bone, name] of nameOf) {
      join(name, name);
      if (nameOf.has(parent[bone])) join(name, nameOf.get(parent[bone]));
    }
  }

  join([a, b]) { return this.joined.has(`${a}\0${b}`); }
  fold(event) {
    if (!this.join(event.names)) return false;
    return (isKnown(event) ? event.depth.at_least : event.depth.at_most) < SHARE * Math.min(...event.names.map((name) => this.girth.get(name) ?? 0));
  }
}
