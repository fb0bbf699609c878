// Tests of the package in Node: node --test FOLDER, where FOLDER is the package's, built.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { readFile } from "node:fs/promises";
import test from "node:test";
import init, { SelfCollision } from "cscd";

// The package keeps its engine to itself; how much memory the engine has is asked of what is instantiated.
const { instantiate } = WebAssembly;
let instance;
WebAssembly.instantiate = async (...given) => (instance = await instantiate(...given));

// Two triangles, of which the second falls through the first.
const faces = new Uint32Array([0, 1, 2, 3, 4, 5]);
const before = new Float64Array([0, 0, 0, 4, 0, 0, 0, 4, 0, 1, 1, 1, 2, 1, 1, 1, 2, 2]);
const moved = (positions, z) => positions.map((x, i) => (i >= 9 && i % 3 === 2 ? x + z : x));
const after = moved(before, -2);
const asking = (options, ask) => {
  const body = new SelfCollision(faces, before, options);
  try {
    return ask(body);
  } finally {
    body.dispose();
  }
};
const refused = (type, sentence, call) => assert.throws(call, (error) => {
  assert.equal(error.constructor, type);
  assert.match(error.message, sentence);
  assert.doesNotMatch(error.message, /\n/);
  return true;
});

test("nothing answers before the engine is loaded, and a wrong place is named", async () => {
  refused(Error, /^the engine is not loaded; await init\(\) first$/, () => new SelfCollision(faces, before));
  await assert.rejects(init(new Uint8Array(4)), WebAssembly.CompileError);
  await Promise.all([init(), init()]);
});

test("a step says where and when", () => asking({}, (body) => {
  assert.deepEqual([body.vertexCount, body.faceCount, body.closed], [6, 2, false]);
  assert.equal(body.isFree(before, before), true);
  assert.equal(body.isFree(before, after), false);
  const answer = body.firstContact(before, after);
  assert.deepEqual(answer, {
    startCrossings: new Int32Array(0), count: 2, closeAtStart: 0, free: false, time: 0.5,
    edges: Uint8Array.of(0, 0), vertices: Int32Array.of(3, 0, 1, 2, 4, 0, 1, 2), faces: Int32Array.of(0, 0),
    times: Float64Array.of(0.5, 0.5), points: Float64Array.of(1, 1, 0, 2, 1, 0), normals: Float64Array.of(0, 0, 1, 0, 0, 1),
    weights: Float64Array.of(0.5, 0.25, 0.25, 0.25, 0.5, 0.25), normalVelocities: Float64Array.of(-2, -2),
  });
  assert.ok(body.allContacts(before, after).count > 2);
  assert.equal(body.largestStep(before, before), 1);
  assert.ok(Math.abs(body.largestStep(before, after, 0.5) - 0.25) < 1e-12);
}));

test("single precision and plain arrays are positions, too", () => asking({}, (body) => {
  assert.equal(body.firstContact(Float32Array.from(before), Array.from(after)).time, 0.5);
  const plain = new SelfCollision(Array.from(faces), Array.from(before));
  assert.equal(plain.firstContact(before, after).time, 0.5);
  plain.dispose();
}));

test("what is near, and how far vertices may move", () => asking({}, (body) => {
  assert.deepEqual(body.candidates(before, before, 0.5).vertexFace, new Int32Array(0));
  const near = body.candidates(before, before, 1.25);
  assert.ok([3, 4].every((v) => near.vertexFace.some((n, i) => i % 2 === 0 && n === v && near.vertexFace[i + 1] === 0)));
  const bounds = body.vertexBounds(before, 3);
  assert.equal(bounds.length, 6);
  assert.ok(bounds.every((bound) => bound > 0 && bound <= 3) && bounds[3] < 1);
}));

test("how a pose crosses itself", () => asking({}, (body) => {
  const crossing = moved(before, -1.5);
  assert.deepEqual(body.firstContact(crossing, crossing).startCrossings, Int32Array.of(0, 1));
  const { overlaps, touching } = body.crossings(crossing);
  assert.equal(touching, 0);
  assert.equal(overlaps.length, 1);
  const [{ curves, length, vertices, gradient }] = overlaps;
  assert.deepEqual([...new Set(curves.flatMap((curve) => Array.from(curve.faces)))].sort(), [0, 1]);
  assert.equal(curves[0].closed, false);
  assert.ok(Math.abs(length - Math.hypot(curves[0].points[3] - curves[0].points[0], curves[0].points[4] - curves[0].points[1])) < 1e-9);
  assert.equal(gradient.length, 3 * vertices.length);
  assert.deepEqual(body.crossings(before), { overlaps: [], touching: 0 });
}));

test("options change what counts", () => {
  const time = (options) => asking(options, (body) => body.firstContact(before, after).time);
  assert.equal(time({ thickness: 0.5 }), 0.25);
  assert.equal(time({ vertexThickness: [0.25, 0.25, 0.25, 0.25, 0.25, 0.25] }), 0.25);
  for (const exclude of [{ facePairs: [[0, 1]] }, { vertexPairs: [0, 1, 2].flatMap((a) => [[a, 3], [a, 4], [a, 5]]) },
                         { rigid: Array(6).fill(true) }, { rigid: new Uint8Array(6).fill(1) },
                         { group: [1, 1, 1, 2, 2, 2], groupsThatIgnoreEachOther: [[1, 2]] }, { restDistance: 10 }])
    assert.equal(time({ exclude }), null, Object.keys(exclude)[0]);
  assert.equal(time({ exclude: { rings: 1, ongoing: true }, labels: [0, 0, 0, 1, 1, 1], checkPositions: true }), 0.5);
  assert.equal(asking({ checkStart: false }, (body) => body.firstContact(after, after).startCrossings.length), 0);
});

test("obstacles rest, are placed and move", () => {
  const floor = { faces: [0, 1, 2], positions: [-9, -9, -9, 9, -9, -9, 0, 9, -9] };
  asking({ obstacles: [floor] }, (body) => {
    assert.equal(body.isFree(before, before), true);
    const raised = floor.positions.map((x, i) => (i % 3 === 2 ? -1 : x));
    body.placeObstacle(0, raised);
    assert.equal(body.isFree(before, before), true);
    body.moveObstacle(0, raised, raised.map((x, i) => (i % 3 === 2 ? 1 : x)));
    const answer = body.firstContact(before, before);
    assert.equal(answer.time, 0.5);
    assert.ok(answer.vertices.some((v) => v >= 6));
  });
});

test("what preparing finds serves another object", () => {
  const bytes = asking({}, (body) => body.preparation());
  assert.ok(bytes instanceof Uint8Array && bytes.length > 0);
  assert.equal(asking({ preparation: bytes }, (body) => body.firstContact(before, after).time), 0.5);
  refused(RangeError, /^preparation: /, () => asking({ preparation: bytes.subarray(1) }, () => {}));
});

test("paths that are not straight", () => asking({}, (body) => {
  const falling = { positions: (time) => moved(before, -2 * time * time), acceleration: () => 4, positionError: 1e-12 };
  assert.equal(body.trueMotion(falling, 0, 0.5).verdict, "clear");
  const hit = body.trueMotion({ ...falling, acceleration: () => new Float64Array(6).fill(4) }, 0, 1);
  assert.equal(hit.verdict, "touches");
  assert.deepEqual(Array.from(hit.faces).sort(), [0, 1]);
  assert.ok(hit.span[0] <= Math.SQRT1_2 && Math.SQRT1_2 <= hit.span[1] && hit.span[1] - hit.span[0] < 0.1);
  const own = new TypeError("no positions today");
  assert.throws(() => body.trueMotion({ ...falling, positions: () => { throw own; } }, 0, 1), (error) => error === own);
  refused(RangeError, /^paths: positions at 0 are 3 numbers for 6 vertices; give 3 a vertex$/,
    () => body.trueMotion({ ...falling, positions: () => [0, 0, 0] }, 0, 1));
  // A function that asks the object which is asking it.
  refused(Error, /ask another object there$/, () => body.trueMotion(
    { ...falling, positions: (time) => (body.isFree(before, before), falling.positions(time)) }, 0, 1));
  assert.equal(body.firstContact(before, after).time, 0.5);
}));

test("errors say what the library says", () => {
  refused(RangeError, /^faces: 4 numbers are no whole rows; give three numbers for each row$/,
    () => new SelfCollision([0, 1, 2, 3], before));
  refused(RangeError, /^faces: triangle 1 names vertex 6, /, () => new SelfCollision([0, 1, 2, 3, 4, 6], before));
  refused(RangeError, /triangle 1 names vertex 4294967295; an index is at most 2147483647$/,
    () => new SelfCollision([0, 1, 2, 3, 4, 4294967295], before));
  asking({}, (body) => {
    refused(RangeError, /^end positions: 1 rows for 6 vertices/, () => body.isFree(before, [0, 0, 0]));
    refused(RangeError, /^end positions: vertex 4 .*finite/, () => body.isFree(before, before.with?.(13, NaN) ?? before.map((x, i) => (i === 13 ? NaN : x))));
    refused(RangeError, /^largest_step: safety 2; give a number in \(0, 1\]$/, () => body.largestStep(before, after, 2));
    assert.equal(body.isFree(before, after), false);  // an error leaves the object as it was
  });
  refused(RangeError, /^exclude, rings: -1; give at least 0$/, () => asking({ exclude: { rings: -1 } }, () => {}));
  for (const [length, written] of [[-1, "-1"], [-0.1, "-0.1"], [-1200000, "-1200000"], [-1e-4, "-1e-04"], [-1e23, "-1e+23"],
                                   [-4294967296.5, "-4294967296.5"], [Infinity, "inf"], [NaN, "nan"]])
    assert.throws(() => asking({ thickness: length }, () => {}), { message: RegExp(`^options: thickness is ${written.replace("+", "\\+")}; `) });
});

test("wrong types are refused", () => {
  refused(TypeError, /^faces: give a Uint32Array of vertices, three a triangle, or an array$/, () => new SelfCollision("012", before));
  refused(TypeError, /^faces: entry 2 is 0.5; give vertices/, () => new SelfCollision([0, 1, 0.5], before));
  refused(RangeError, /^faces: names a vertex below 0$/, () => new SelfCollision(Int32Array.of(0, 1, -1), before));
  refused(TypeError, /^reference positions: give a Float64Array of numbers, or an array$/, () => new SelfCollision(faces, Uint8Array.of(1)));
  refused(TypeError, /^options: thicknes is not known; choose from checkPositions, /, () => asking({ thicknes: 1 }, () => {}));
  refused(TypeError, /^thickness: give a number$/, () => asking({ thickness: "1" }, () => {}));
  refused(TypeError, /^checkStart: give true or false$/, () => asking({ checkStart: 1 }, () => {}));
  refused(RangeError, /^vertexPairs: 3 numbers are no whole pairs/, () => asking({ exclude: { vertexPairs: [1, 2, 3] } }, () => {}));
  asking({}, (body) => refused(TypeError, /^radius: give a number$/, () => body.candidates(before, after)));
});

test("an object that is disposed of answers no more, and its memory is used again", () => {
  const body = new SelfCollision(faces, before);
  body.dispose();
  body.dispose();
  refused(Error, /^this SelfCollision has been disposed of; make another one$/, () => body.isFree(before, after));
  const useSome = () => {
    for (let i = 0; i < 500; ++i) {
      asking({}, (other) => other.allContacts(before, after));
      assert.throws(() => new SelfCollision([0, 1, 2, 3], before));
      assert.throws(() => asking({}, (other) => other.isFree(before, [0, 0, 0])));
    }
  };
  useSome();
  const reached = instance.exports.memory.buffer.byteLength;
  useSome();
  assert.equal(instance.exports.memory.buffer.byteLength, reached);
});

test("the package is small, and asks its surroundings for nothing but what cscd.js gives", async () => {
  const { gzipSync } = await import("node:zlib");
  const module = readFileSync(new URL("../cscd.wasm", import.meta.url));
  assert.ok(module.length <= 1_500_000 && gzipSync(module, { level: 9 }).length <= 500_000);
  const asks = WebAssembly.Module.imports(new WebAssembly.Module(module)).map((entry) => entry.name);
  assert.deepEqual(asks.sort(), ["clock_time_get", "environ_get", "environ_sizes_get", "fd_close", "fd_seek", "fd_write",
    "path_acceleration", "path_positions", "proc_exit"]);
});

test("the example of the README", async () => {
  const page = await readFile(new URL("../README.md", import.meta.url), "utf8");
  const printed = [];
  const log = console.log;
  console.log = (...values) => printed.push(values);
  try {
    const { writeFile } = await import("node:fs/promises");
    await writeFile(new URL("example.mjs", import.meta.url), /```js\n(.*?)```/s.exec(page)[1]);
    await import("./example.mjs");
  } finally {
    console.log = log;
  }
  assert.deepEqual(printed[0], [false, 0.5, Float64Array.of(1, 1, 0, 2, 1, 0)]);
  assert.ok(Math.abs(printed[1][0][11] - 0.1) < 1e-9);
});
