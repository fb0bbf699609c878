// Joins vertices that lie in one place, as `cscd` does (scenes/character/weld.h, scenes/import/surface.cpp): at the largest
// tolerance, up to a millionth of the diagonal, at which no triangle collapses and no edge gets a third triangle.
const DEFAULT = 1e-6, LEAST = 1e-8, SLACK = 100;

const distance = (x, a, b) => Math.hypot(x[3 * a] - x[3 * b], x[3 * a + 1] - x[3 * b + 1], x[3 * a + 2] - x[3 * b + 2]);

// Returns for each vertex the smallest one that leads a group within the tolerance.
function groupsOf(x, tolerance) {
  const largest = x.reduce((most, value) => Math.max(most, Math.abs(value)), 0), cell = Math.max(tolerance, largest * 1e-15, Number.MIN_VALUE);
  const leaders = new Map(), group = new Int32Array(x.length / 3);
  const key = (i, j, k) => (Math.imul(i % 2097152, 73856093) ^ Math.imul(j % 2097152, 19349663) ^ Math.imul(k % 2097152, 83492791)) | 0;
  for (let v = 0; v < group.length; ++v) {
    const i = Math.floor(x[3 * v] / cell), j = Math.floor(x[3 * v + 1] / cell), k = Math.floor(x[3 * v + 2] / cell);
    let found = v;
    for (let cube = 0; cube < 27; ++cube) {
      const near = leaders.get(key(i + (cube % 3) - 1, j + (Math.floor(cube / 3) % 3) - 1, k + Math.floor(cube / 9) - 1));
      for (let n = 0; near && n < near.length; ++n) if (near[n] < found && distance(x, near[n], v) <= tolerance) found = near[n];
    }
    group[v] = found;
    if (found !== v) continue;
    const own = key(i, j, k);
    if (leaders.has(own)) leaders.get(own).push(v);
    else leaders.set(own, [v]);
  }
  return group;
}

// Parts groups whose vertices are farther apart than the tolerance in another pose.
function splitGroups(group, x, tolerance) {
  const before = group.slice(), split = new Map();
  for (let v = 0; v < group.length; ++v) {
    if (before[v] === v || distance(x, v, before[v]) <= tolerance) continue;
    if (!split.has(before[v])) split.set(before[v], []);
    const parts = split.get(before[v]), joined = parts.find((other) => distance(x, v, other) <= tolerance);
    group[v] = joined ?? v;
    if (joined === undefined) parts.push(v);
  }
}

// The triangles with three corners of their own, each set of corners once. `source` says which each was.
export function weldedTriangles(corners, group) {
  const out = { corners: [], source: [], collapsed: 0, duplicate: 0 }, seen = new Set();
  for (let t = 0; 3 * t < corners.length; ++t) {
    const own = [0, 1, 2].map((k) => group[corners[3 * t + k]]);
    if (own[0] === own[1] || own[1] === own[2] || own[2] === own[0]) {
      ++out.collapsed;
      continue;
    }
    const key = own.slice().sort((a, b) => a - b).join();
    if (seen.has(key)) {
      ++out.duplicate;
      continue;
    }
    seen.add(key);
    out.corners.push(...own);
    out.source.push(t);
  }
  return out;
}

function crowdedEdges(corners) {
  const count = new Map();
  for (let i = 0; i < corners.length; ++i) {
    const a = corners[i], b = corners[i % 3 === 2 ? i - 2 : i + 1], key = Math.min(a, b) * 2 ** 26 + Math.max(a, b);
    count.set(key, (count.get(key) ?? 0) + 1);
  }
  return Array.from(count.values()).filter((triangles) => triangles > 2).length;
}

// `poses` are positions in poses of all clips, by which seams are told from what only lies there in the bind pose.
export function weld(corners, positions, diagonal, poses) {
  const at = (share) => {
    const group = groupsOf(positions, share * diagonal);
    for (const pose of poses) splitGroups(group, pose, SLACK * share * diagonal);
    const welded = weldedTriangles(corners, group);
    return { ...welded, group, tolerance: share, crowded: crowdedEdges(welded.corners) };
  };
  const exact = at(LEAST);
  for (let share = DEFAULT; share > LEAST * 1.5; share /= 10) {
    const tried = at(share);
    if (tried.collapsed <= exact.collapsed && tried.crowded <= exact.crowded) return tried;
  }
  return exact;
}
