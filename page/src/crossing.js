// Where two triangles cross: the segment that they share, from the points at which edges of one pierce the other.
export function crossingSegment(p, a, b) {
  const points = [];
  for (const [one, other] of [[a, b], [b, a]])
    for (let k = 0; k < 3; ++k) {
      const hit = pierce(p, one[k], one[(k + 1) % 3], other);
      if (hit) points.push(hit);
    }
  if (points.length < 2) return null;
  let best = null, longest = 0;
  for (let i = 0; i < points.length; ++i)
    for (let j = i + 1; j < points.length; ++j) {
      const length = Math.hypot(...points[i].map((x, axis) => x - points[j][axis]));
      if (length > longest) {
        longest = length;
        best = [...points[i], ...points[j]];
      }
    }
  return best;
}

const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

function pierce(p, from, to, triangle) {
  const at = (v) => [p[4 * v], p[4 * v + 1], p[4 * v + 2]];
  const origin = at(from), way = sub(at(to), origin), corner = at(triangle[0]);
  const e = sub(at(triangle[1]), corner), f = sub(at(triangle[2]), corner), q = cross(way, f), det = dot(e, q);
  if (det === 0) return null;
  const t = sub(origin, corner), u = dot(t, q) / det;
  if (u < 0 || u > 1) return null;
  const r = cross(t, e), v = dot(way, r) / det;
  if (v < 0 || u + v > 1) return null;
  const share = dot(f, r) / det;
  if (share < 0 || share > 1) return null;
  return [0, 1, 2].map((axis) => origin[axis] + share * way[axis]);
}
