// Reads the .obj files of a sequence: positions and faces. three.js' OBJLoader would give every corner a vertex of its own, so
// that the surface would fall apart; two kinds of lines are all that matters here.

const numberOf = (name) => Number(/(-?\d+)\.obj$/i.exec(name)?.[1] ?? NaN);

// Cuts a face into triangles: a quadrilateral along a diagonal inside it, the shorter one where both are (scenes/polygon).
function cut(face, positions) {
  const at = (k) => positions.slice(3 * face[k % 4], 3 * face[k % 4] + 3), less = (a, b) => a.map((x, i) => x - b[i]);
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]], dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  if (face.length !== 4) return face.slice(2).flatMap((_, k) => [face[0], face[k + 1], face[k + 2]]);
  const first = less(at(2), at(0)), second = less(at(3), at(1)), normal = cross(first, second);
  const inside = (k) => dot(cross(less(at(k + 1), at(k)), less(at(k + 2), at(k))), normal) > 0 && dot(cross(less(at(k + 2), at(k)), less(at(k + 3), at(k))), normal) > 0;
  const [a, b, c, d] = face, shorter = dot(first, first) <= dot(second, second) * (1 + 1e-9);
  return (inside(0) === inside(1) ? shorter : inside(0)) ? [a, b, c, a, c, d] : [a, b, d, b, c, d];
}

function read({ name, bytes }, withFaces) {
  const positions = [], faces = [];
  for (const line of new TextDecoder().decode(bytes).split(/\r\n|\r|\n/)) {
    if (line.startsWith("v ")) {
      const words = line.trim().split(/\s+/).slice(1, 4).map(Number);
      if (words.length < 3 || !words.every(Number.isFinite)) throw new Error(`${name}: the line "${line}" is no position`);
      positions.push(...words);
    } else if (withFaces && line.startsWith("f ")) {
      faces.push(line.trim().split(/\s+/).slice(1).map((word) => {
        const n = parseInt(word, 10);
        return n < 0 ? positions.length / 3 + n : n - 1;
      }));
    }
  }
  if (faces.some((face) => face.length < 3 || face.some((v) => !(v >= 0 && v < positions.length / 3)))) throw new Error(`${name}: a face names a vertex that does not exist`);
  return { positions: Float64Array.from(positions), faces };
}

export function readSequence(files) {
  if (files.length > 1 && files.some(({ name }) => Number.isNaN(numberOf(name)))) throw new Error("the .obj files are no sequence, whose names end with numbers, as walk.0001.obj");
  const sorted = [...files].sort((a, b) => numberOf(a.name) - numberOf(b.name)), { positions, faces } = read(sorted[0], true);
  const frames = sorted.map((file) => read(file, false).positions);
  const other = frames.findIndex((one) => one.length !== positions.length);
  if (other >= 0) throw new Error(`${sorted[other].name} has ${frames[other].length / 3} vertices, and ${sorted[0].name} ${positions.length / 3}; a sequence has one surface`);
  const corners = faces.flatMap((face) => cut(face, positions)), fps = 30, last = frames.length - 1;
  const notes = faces.some((face) => face.length > 4) ? ["faces with more than four corners are cut from their first corner, which cscd query does otherwise"] : [];
  const loose = positions.length / 3 - new Set(corners).size;
  if (loose > 0) notes.push(loose === 1 ? "1 vertex is of no face: a point that touches faces, and crosses nothing" : `${loose} vertices are of no face: points that touch faces, and cross nothing`);
  const clip = { name: "", number: 0, start: 0, seconds: last / fps, frames: frames.length, firstFrame: numberOf(sorted[0].name) || 0, second: (frame) => frame / fps };
  return {
    format: "OBJ", up: "y", because: "", centimetres: 0, fps, fpsFrom: "assumed", isSequence: true, vertexCount: positions.length / 3,
    notes,
    parts: [{ positions, corners }], names: ["the surface"], clips: [clip],
    sample: (_, frame, out) => out.set(frames[frame]),
  };
}
