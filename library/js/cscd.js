// The package's interface: README.md shows how to use it, cscd.d.ts says what each function takes and returns.
// The engine is cscd.wasm, whose functions are those of bindings.cpp.

let engine = null;  // the functions of cscd.wasm, and its memory
let asked = null;   // of the call of trueMotion() in progress: the caller's functions, and the error of one

// ---- Loading ----

const text = (address, size) => new TextDecoder().decode(new Uint8Array(engine.memory.buffer, address, size));

// Fills a list of doubles with what a function of the caller returns.
function fill(list, name, ...times) {
  try {
    const given = asked.paths[name](...times);
    const numbers = reals(typeof given === "number" ? [given] : given, name);
    new Float64Array(engine.memory.buffer, call("resize", list, numbers.length), numbers.length).set(numbers);
    return 1;
  } catch (error) {
    asked.error = error;
    return 0;
  }
}

const imports = {
  cscd: {
    path_positions: (time, list) => fill(list, "positions", time),
    path_acceleration: (from, to, list) => fill(list, "acceleration", from, to),
  },
  // What the C library asks of its surroundings: no files, no variables, and a clock, which no answer depends on.
  wasi_snapshot_preview1: {
    environ_sizes_get: (count, size) => {
      new Uint32Array(engine.memory.buffer, count, 1)[0] = new Uint32Array(engine.memory.buffer, size, 1)[0] = 0;
      return 0;
    },
    environ_get: () => 0,
    clock_time_get: (clock, precision, time) => {
      new BigUint64Array(engine.memory.buffer, time, 1)[0] = BigInt(Math.round(1e6 * performance.now()));
      return 0;
    },
    fd_close: () => 8,
    fd_seek: () => 8,
    fd_write: () => 8,
    proc_exit: (status) => { throw new Error(`cscd.wasm ended with status ${status}`); },
  },
};

async function compile(source) {
  if (source instanceof WebAssembly.Module) return source;
  if (source instanceof ArrayBuffer || ArrayBuffer.isView(source)) return WebAssembly.compile(source);
  if (String(source).startsWith("file:") && globalThis.process?.versions?.node) {
    const { readFile } = await import("node:fs/promises");
    return WebAssembly.compile(await readFile(new URL(source)));
  }
  const response = await fetch(source);
  if (!response.ok) throw new Error(`${source}: ${response.status} ${response.statusText}; give init() the place of cscd.wasm`);
  return WebAssembly.compile(await response.arrayBuffer());
}

let loading = null;

export default function init(source = new URL("cscd.wasm", import.meta.url)) {
  loading ??= compile(source).then(async (module) => {
    engine = (await WebAssembly.instantiate(module, imports)).exports;
    engine._initialize();
  }).catch((error) => {
    loading = engine = null;  // so that another source can be tried
    throw error;
  });
  return loading;
}

// ---- Calls ----

// Calls a function of the engine, and throws its error.
function call(name, ...values) {
  const value = engine[name](...values);
  const failure = engine.failure();
  if (failure === 0) return value;
  const said = text(engine.text(), engine.text_size());
  throw failure === 1 ? new RangeError(said) : new Error(said);
}

// Runs `use` with an address and a size for each array, in memory of the engine that holds the arrays.
function withArrays(arrays, use) {
  const places = [];
  try {
    for (const array of arrays) {
      const Type = array instanceof Float32Array ? Float64Array : array.constructor;
      const address = call("allocate", array.length * Type.BYTES_PER_ELEMENT);
      places.push(address, array.length);
      new Type(engine.memory.buffer, address, array.length).set(array);
    }
    return use(...places);
  } finally {
    for (let i = 0; i < places.length; i += 2) engine.release(places[i]);
  }
}

// Reads what the last call has found: integers and doubles, in the order of bindings.cpp.
class Found {
  #integers = engine.integers();
  #numbers = engine.numbers();

  integers(count) {
    const all = new Int32Array(engine.memory.buffer, this.#integers, count).slice();
    this.#integers += all.byteLength;
    return all;
  }
  numbers(count) {
    const all = new Float64Array(engine.memory.buffer, this.#numbers, count).slice();
    this.#numbers += all.byteLength;
    return all;
  }
  integer() { return this.integers(1)[0]; }
  number() { return this.numbers(1)[0]; }
  // Rows behind their count.
  integerRows(columns = 1) { return this.integers(columns * this.integer()); }
  numberRows(columns = 1) { return this.numbers(columns * this.integer()); }
  list(read) { return Array.from({ length: this.integer() }, read); }
}

// ---- What callers give ----

function listed(value, name, kinds, holds, Type, what) {
  if (kinds.some((Kind) => value instanceof Kind)) return value;
  if (!Array.isArray(value)) throw new TypeError(`${name}: give a ${kinds[0].name} of ${what}, or an array`);
  const wrong = value.findIndex((n) => !holds(n));
  if (wrong >= 0) throw new TypeError(`${name}: entry ${wrong} is ${String(value[wrong])}; give ${what}`);
  return Type.from(value);
}
const reals = (value, name) =>
  listed(value, name, [Float64Array, Float32Array], (n) => typeof n === "number", Float64Array, "numbers");
const isWhole = (least, most) => (n) => Number.isInteger(n) && n >= least && n <= most;
const integers = (value, name) =>
  listed(value, name, [Int32Array], isWhole(-(2 ** 31), 2 ** 31 - 1), Int32Array, "whole numbers of 32 bits");
const bytes = (value, name) => listed(value, name, [Uint8Array], isWhole(0, 255), Uint8Array, "whole numbers from 0 to 255");
function corners(value, name) {
  const all = listed(value, name, [Uint32Array, Int32Array, Uint16Array], isWhole(0, 2 ** 32 - 1), Uint32Array,
    "vertices, three a triangle");
  if (all instanceof Int32Array && all.some((v) => v < 0)) throw new RangeError(`${name}: names a vertex below 0`);
  return all instanceof Uint32Array ? all : Uint32Array.from(all);
}
function number(value, name) {
  if (typeof value === "number") return value;
  throw new TypeError(`${name}: give a number`);
}
function flag(value, name) {
  if (typeof value === "boolean") return Number(value);
  throw new TypeError(`${name}: give true or false`);
}
const flags = (value, name) => (Array.isArray(value) ? Uint8Array.from(value, (f) => flag(f, name)) : bytes(value, name));
const pairs = (value, name) => {
  const all = integers(Array.isArray(value) ? value.flat() : value, name);
  if (all.length % 2) throw new RangeError(`${name}: ${all.length} numbers are no whole pairs; give two a pair`);
  return all;
};

// Each option, and how what is given for it is read. The engine's name of fooBar is foo_bar.
const OPTIONS = {
  checkPositions: flag, checkStart: flag, thickness: number, vertexThickness: reals, labels: integers, preparation: bytes,
};
const EXCLUSIONS = {
  rigid: flags, group: integers, groupsThatIgnoreEachOther: pairs, vertexPairs: pairs, facePairs: pairs, rings: number,
  restDistance: number, ongoing: flag,
};

function setAll(to, given, known, where) {
  for (const [name, value] of Object.entries(given)) {
    if (value === undefined) continue;
    if (!Object.hasOwn(known, name)) throw new TypeError(`${where}: ${name} is not known; choose from ${Object.keys(known).join(", ")}`);
    const read = known[name](value, name), set = `set_${name.replace(/[A-Z]/g, (c) => `_${c.toLowerCase()}`)}`;
    if (typeof read === "number") call(set, to, read);
    else withArrays([read], (...place) => call(set, to, ...place));
  }
}

// Runs `use` with the engine's options.
function withOptions({ exclude = {}, obstacles = [], ...given }, use) {
  const options = call("options_make");
  try {
    setAll(options, given, OPTIONS, "options");
    setAll(options, exclude, EXCLUSIONS, "exclude");
    for (const { faces, positions } of obstacles)
      withArrays([corners(faces, "obstacle, faces"), reals(positions, "obstacle, positions")],
        (...places) => call("add_obstacle", options, ...places));
    return use(options);
  } finally {
    engine.options_drop(options);
  }
}

// ---- What it answers ----

function readAnswer() {
  const found = new Found();
  const startCrossings = found.integerRows(2), count = found.integer();
  const answer = {
    startCrossings,
    count,
    edges: Uint8Array.from(found.integers(count)),
    vertices: found.integers(4 * count),
    faces: found.integers(count),
    times: found.numbers(count),
    points: found.numbers(3 * count),
    normals: found.numbers(3 * count),
    weights: found.numbers(3 * count),
    normalVelocities: found.numbers(count),
  };
  answer.free = count === 0 && startCrossings.length === 0;
  answer.time = count === 0 ? null : answer.times[0];
  answer.closeAtStart = answer.times.filter((time) => time <= 0).length;
  return answer;
}

function readOverlap(found) {
  const curves = found.list(() => ({ faces: found.integerRows(2), points: found.numberRows(3), closed: found.integer() === 1 }));
  const regions = found.list(() => ({
    bounds: found.integerRows(2), vertices: found.integerRows(), ways: found.numberRows(3), distances: found.numberRows(),
    behind: found.integer() === 1, otherIsOpen: found.integer() === 1, deepest: found.integer(),
    area: found.number(), depth: found.number(), depthBound: found.number(), out: found.numbers(3),
  }));
  return {
    curves, regions, vertices: found.integerRows(), gradient: found.numberRows(3),
    depth: found.number(), depthBound: found.number(), length: found.number(),
  };
}

const VERDICTS = ["clear", "touches", "close", "intersects_at_start", "undecided"];

export class SelfCollision {
  #body = 0;

  constructor(faces, reference, options = {}) {
    if (!engine) throw new Error("the engine is not loaded; await init() first");
    const arrays = [corners(faces, "faces"), reals(reference, "reference positions")];
    this.#body = withOptions(options, (set) => withArrays(arrays, (...places) => call("make", ...places, set)));
  }

  dispose() {
    if (this.#body) engine.drop(this.#body);
    this.#body = 0;
  }

  #ask(name, ...values) {
    if (this.#body) return call(name, this.#body, ...values);
    throw new Error("this SelfCollision has been disposed of; make another one");
  }
  #askStep(name, start, end, ...values) {
    return withArrays([reals(start, "start positions"), reals(end, "end positions")],
      (...places) => this.#ask(name, ...places, ...values));
  }
  #askPose(name, positions, ...values) {
    return withArrays([reals(positions, "positions")], (...place) => this.#ask(name, ...place, ...values));
  }

  get vertexCount() { return this.#ask("vertex_count"); }
  get faceCount() { return this.#ask("face_count"); }
  get closed() { return this.#ask("closed") === 1; }

  placeObstacle(obstacle, positions) {
    withArrays([reals(positions, "positions")], (...place) => this.#ask("place_obstacle", number(obstacle, "obstacle"), ...place));
  }
  moveObstacle(obstacle, start, end) {
    withArrays([reals(start, "start positions"), reals(end, "end positions")],
      (...places) => this.#ask("move_obstacle", number(obstacle, "obstacle"), ...places));
  }

  isFree(start, end) { return this.#askStep("is_free", start, end) === 1; }
  firstContact(start, end) {
    this.#askStep("first_contact", start, end);
    return readAnswer();
  }
  allContacts(start, end) {
    this.#askStep("all_contacts", start, end);
    return readAnswer();
  }
  largestStep(start, end, safety = 0.9) { return this.#askStep("largest_step", start, end, number(safety, "safety")); }
  candidates(start, end, radius) {
    this.#askStep("candidates", start, end, number(radius, "radius"));
    const found = new Found();
    return { vertexFace: found.integerRows(2), edgeEdge: found.integerRows(4) };
  }
  vertexBounds(positions, cap) {
    this.#askPose("vertex_bounds", positions, number(cap, "cap"));
    return new Found().numbers(this.vertexCount);
  }
  crossings(positions) {
    this.#askPose("crossings", positions);
    const found = new Found();
    return { overlaps: found.list(() => readOverlap(found)), touching: found.integer() };
  }
  trueMotion(paths, from, to, resolution = 0) {
    const outer = asked;
    asked = { paths, error: null };
    try {
      this.#ask("true_motion", number(paths.positionError ?? 0, "positionError"), number(from, "from"), number(to, "to"),
        number(resolution, "resolution"));
    } catch (error) {
      throw asked.error ?? error;
    } finally {
      asked = outer;
    }
    const found = new Found();
    return { verdict: VERDICTS[found.integer()], faces: found.integers(2), span: found.numbers(2), within: found.number() };
  }
  preparation() {
    this.#ask("preparation");
    return Uint8Array.from(new Found().integerRows());
  }
}
// `using body = new SelfCollision(...)`, where the language has that.
if (Symbol.dispose) SelfCollision.prototype[Symbol.dispose] = SelfCollision.prototype.dispose;
