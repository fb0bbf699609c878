// What a person asks of the page's engine, as the options of the program say it: --thickness, --ignore-neighbours and --ignore.
const CENTIMETRES = { mm: 0.1, cm: 1, m: 100, in: 2.54 };
const FORMS = "write 0.01 for a length in the units of the input, 5mm, 1cm, 0.1m or 0.5in where it tells its unit, or 0.2e for mean edges of its pose at rest";

// A length in the units of the positions (bench/command_line/written_length.h).
function lengthOf(text, { engine, import: file, name }) {
  const [, digits, unit] = /^(\d*\.?\d*(?:[eE][+-]?\d+)?)(e|mm|cm|m|in|)$/.exec(text) ?? [], number = digits ? Number(digits) : NaN;
  if (!Number.isFinite(number)) throw new Error(`thickness ${text}: is no length; ${FORMS}`);
  if (unit === "e") return number * engine.mean_edge;
  if (unit === "") return number;
  if (!file?.centimetres_per_unit) throw new Error(`thickness ${text}: ${name} does not tell how long its unit is; ${FORMS}`);
  return number * (CENTIMETRES[unit] / file.centimetres_per_unit);
}

// For each bone, those that are at most so many joints from it (bones_within() of bench/inputs/ignore.h).
function bonesWithin(parent, joints) {
  const next = parent.map((above, b) => [...(above >= 0 ? [above] : []), ...parent.flatMap((other, i) => (other === b ? [i] : []))]);
  return parent.map((_, b) => {
    const near = new Set([b]);
    for (let step = 0; step < joints; ++step) for (const from of Array.from(near)) for (const to of next[from]) near.add(to);
    return near;
  });
}

function diagonalOf(x) {
  const low = [Infinity, Infinity, Infinity], high = low.map((value) => -value);
  x.forEach((value, i) => {
    low[i % 3] = Math.min(low[i % 3], value);
    high[i % 3] = Math.max(high[i % 3], value);
  });
  return Math.hypot(...high.map((value, k) => value - low[k]));
}

// `asked` is {thickness, neighbours, pairs}: a text, a number of joints or null, and pairs of names of places. Returns what ClipAnswer
// takes. Throws an Error with one sentence.
export function settingsOf(surface, { thickness: text, neighbours, pairs }) {
  const { header, parent } = surface, length = text === "" ? 0 : lengthOf(text, header), diagonal = diagonalOf(surface.rest);
  if (length > diagonal) throw new Error(`thickness ${text}: is more than all of ${header.name} at rest, so that every pair of features is close; give less than ${diagonal}`);
  if (neighbours !== null && parent.length === 0) throw new Error(`${header.name} has no bones, and so no neighbours; choose a moment and ignore its pair`);
  const near = neighbours === null ? null : bonesWithin(parent, neighbours), both = new Set(pairs.flatMap(([a, b]) => [`${a}\0${b}`, `${b}\0${a}`]));
  const isNear = (a, b) => near !== null && a >= 0 && b >= 0 && near[a].has(b);
  return {
    thickness: length > 0 ? { text, length } : null,
    ignores: near || pairs.length > 0 ? (a, b) => isNear(surface.boneOf(a), surface.boneOf(b)) || both.has(`${surface.placeName(a)}\0${surface.placeName(b)}`) : null,
    asked: [...pairs.map(([a, b]) => `--ignore ${a}:${b}`), ...(near ? [`--ignore-neighbours ${neighbours}`] : [])].join(" "),
  };
}
