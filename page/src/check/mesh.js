// The surface as a mesh, and what crosses in it at rest.

// Rows of numbers, one a key: row(key) are those that were added to the key.
function rowsOf(keys, entries) {
  const offset = new Uint32Array(keys + 1), values = new Uint32Array(entries.length / 2), next = offset.slice();
  for (let i = 0; i < entries.length; i += 2) ++offset[entries[i] + 1];
  for (let k = 0; k < keys; ++k) offset[k + 1] += offset[k];
  next.set(offset);
  for (let i = 0; i < entries.length; i += 2) values[next[entries[i]]++] = entries[i + 1];
  return (key) => values.subarray(offset[key], offset[key + 1]);
}

function disjointSets(count) {
  const above = Int32Array.from({ length: count }, (_, i) => i);
  const root = (i) => {
    while (above[i] !== i) i = above[i] = above[above[i]];
    return i;
  };
  return { root, unite: (a, b) => { above[Math.max(root(a), root(b))] = Math.min(root(a), root(b)); } };
}

export class Mesh {
  constructor(corners, vertices) {
    this.corners = corners;
    this.vertices = vertices;
    this.triangles = corners.length / 3;
    this.around = rowsOf(vertices, Array.from(corners).flatMap((v, i) => [v, Math.floor(i / 3)]));
    const sets = disjointSets(vertices), number = new Map();
    for (let i = 0; i < corners.length; ++i) sets.unite(corners[i], corners[i - (i % 3)]);
    this.component = Int32Array.from({ length: this.triangles }, (_, t) => {
      const root = sets.root(corners[3 * t]);
      if (!number.has(root)) number.set(root, number.size);
      return number.get(root);
    });
    this.components = number.size;
  }

  cornersOf(t) { return this.corners.subarray(3 * t, 3 * t + 3); }
  // A pair of triangles as one number.
  pair(a, b) { return a < b ? a * this.triangles + b : b * this.triangles + a; }
  both(pair) { return [Math.floor(pair / this.triangles), pair % this.triangles]; }

  // The triangles that have both features of a contact, from the first feature and from the second.
  sidesOf({ edges, vertices, faces }, i) {
    const at = (k) => vertices[4 * i + k], ofEdge = (a, b) => Array.from(this.around(a)).filter((t) => this.cornersOf(t).includes(b));
    return edges[i] ? [ofEdge(at(0), at(1)), ofEdge(at(2), at(3))] : [Array.from(this.around(at(0))), [faces[i]]];
  }

  within(t, rings) {
    const inside = new Set([t]);
    for (let ring = 0; ring < rings; ++ring) for (const s of Array.from(inside)) for (const v of this.cornersOf(s)) for (const next of this.around(v)) inside.add(next);
    return inside;
  }
}

// Whether two triangles that meet have corners on both sides of each other's plane, by more than rounding.
export function straddle(mesh, x, a, b) {
  const straddles = (s, t) => {
    const [p, q, r] = mesh.cornersOf(s), d = (v, k) => x[3 * v + k] - x[3 * p + k];
    const n = [d(q, 1) * d(r, 2) - d(q, 2) * d(r, 1), d(q, 2) * d(r, 0) - d(q, 0) * d(r, 2), d(q, 0) * d(r, 1) - d(q, 1) * d(r, 0)];
    let low = 0, high = 0;
    for (const v of mesh.cornersOf(t)) {
      const side = n[0] * d(v, 0) + n[1] * d(v, 1) + n[2] * d(v, 2);
      const rounding = 1e-14 * (Math.abs(n[0]) + Math.abs(n[1]) + Math.abs(n[2])) * (Math.abs(x[3 * v]) + Math.abs(x[3 * v + 1]) + Math.abs(x[3 * v + 2]) + Math.abs(d(v, 0)) + Math.abs(d(v, 1)) + Math.abs(d(v, 2)));
      low += side < -rounding;
      high += side > rounding;
    }
    return low > 0 && high > 0;
  };
  return straddles(a, b) && straddles(b, a);
}

// Whether two triangles of different components have the same three corners.
function coincide(mesh, x, a, b) {
  if (mesh.component[a] === mesh.component[b]) return false;
  return mesh.cornersOf(a).every((v) => mesh.cornersOf(b).some((w) => x[3 * v] === x[3 * w] && x[3 * v + 1] === x[3 * w + 1] && x[3 * v + 2] === x[3 * w + 2]));
}

// Components of which every triangle lies exactly on one of another component, by pairs of both: a coat copied from a body.
function copiesIn(mesh, x) {
  const size = new Map(), same = new Map(), seen = new Map(), copies = new Set();
  for (let t = 0; t < mesh.triangles; ++t) {
    const c = mesh.component[t], key = Array.from(mesh.cornersOf(t), (v) => x.subarray(3 * v, 3 * v + 3).join()).sort().join();
    size.set(c, (size.get(c) ?? 0) + 1);
    for (const other of seen.get(key) ?? []) if (other !== c) same.set(`${other} ${c}`, (same.get(`${other} ${c}`) ?? 0) + 1);
    seen.set(key, [...(seen.get(key) ?? []), c]);
  }
  for (const [both, count] of same) {
    const [a, b] = both.split(" ").map(Number);
    if (count >= Math.min(size.get(a), size.get(b))) copies.add(both).add(`${b} ${a}`);
  }
  return copies;
}

// Tells the pairs of triangles that meet in a pose and pass through each other from those that only touch. `found` is what the
// library says of the pose. Pieces that lie in each other cross, though single triangles of theirs may only touch.
export function tellApart(mesh, x, met, found) {
  const crossing = new Set(), known = new Set(met), largest = x.reduce((most, value) => Math.max(most, Math.abs(value)), 0);
  for (const { curves, depth } of found.overlaps) {
    const pairs = curves.flatMap(({ faces }) => Array.from({ length: faces.length / 2 }, (_, i) => mesh.pair(faces[2 * i], faces[2 * i + 1])));
    const all = depth > 1e-12 * largest || pairs.some((pair) => straddle(mesh, x, ...mesh.both(pair)));
    if (all) for (const pair of pairs) if (known.has(pair)) crossing.add(pair);
  }
  if (mesh.components > 1 && met.some((pair) => !crossing.has(pair) && coincide(mesh, x, ...mesh.both(pair)))) {
    const copies = copiesIn(mesh, x);
    for (const pair of met) if (copies.has(mesh.both(pair).map((t) => mesh.component[t]).join(" "))) crossing.add(pair);
  }
  return new Set(met.filter((pair) => crossing.has(pair)));  // in order
}

// What crosses at rest is how a surface is made, and no collision (core/detect/start/rest_crossings.h): a pair explains itself,
// and between two components everything within two rings round it, until its place has parted.
export class RestCrossings {
  constructor(mesh, crossing, met) {
    this.mesh = mesh;
    this.pairs = new Map(crossing.map((pair, i) => [pair, i]));
    const sets = disjointSets(crossing.length), corner = new Map(), entries = [];
    crossing.forEach((pair, i) => {
      const [a, b] = mesh.both(pair);
      for (const v of mesh.cornersOf(a))
        for (const w of mesh.cornersOf(b)) {
          const key = Math.min(v, w) * mesh.vertices + Math.max(v, w);
          if (corner.has(key)) sets.unite(corner.get(key), i);
          else corner.set(key, i);
        }
      if (mesh.component[a] === mesh.component[b]) return;
      for (const t of mesh.within(a, 2)) entries.push(t, 2 * i);
      for (const t of mesh.within(b, 2)) entries.push(t, 2 * i + 1);
    });
    this.place = crossing.map((_, i) => sets.root(i));
    this.parted = new Set();
    this.near = rowsOf(mesh.triangles, entries);
    // What touches where something crosses is left out with it.
    this.crossing = met.filter((pair) => this.explains(pair));
    this.touching = met.filter((pair) => !this.explains(pair));
  }

  // The same for another clip, in which nothing has parted yet.
  anew() { return Object.assign(Object.create(RestCrossings.prototype), this, { parted: new Set() }); }

  // Calls take(number) with the crossings at rest that explain a pair, until it returns true; returns whether it did.
  someReason(pair, take) {
    const [a, b] = this.mesh.both(pair), near = this.near(a), others = this.near(b);
    if (this.pairs.has(pair) && take(this.pairs.get(pair))) return true;
    for (let i = 0, j = 0; i < near.length; ++i) {  // both rows ascend, and their entries for one crossing differ in the last bit
      while (j < others.length && others[j] < (near[i] & ~1)) ++j;
      if ((others[j] === (near[i] ^ 1) || (others[j] >> 1 === near[i] >> 1 && others[j + 1] === (near[i] ^ 1))) && take(near[i] >> 1)) return true;
    }
    return false;
  }

  explains(pair) { return this.pairs.size > 0 && this.someReason(pair, (i) => !this.parted.has(this.place[i])); }
  explainsContact(sides) { return this.pairs.size > 0 && sides[0].some((s) => sides[1].some((t) => s !== t && this.explains(this.mesh.pair(s, t)))); }

  // Takes all that meets in the next pose: places of which nothing crosses have parted.
  follow(met) {
    if (this.pairs.size === 0) return;
    const here = new Set();
    for (const pair of met) this.someReason(pair, (i) => void here.add(this.place[i]));
    for (const place of this.place) if (!here.has(place)) this.parted.add(place);
  }
}
