// Compiled by TypeScript and not run: each question with the types that cscd.d.ts promises, and what it has to refuse.
import init, { SelfCollision, type Answer, type Options, type PathsAnswer } from "cscd";

await init(new URL("cscd.wasm", import.meta.url));
const options: Options = {
  thickness: 0.1, vertexThickness: new Float64Array(3), labels: [0, 0, 1], preparation: new Uint8Array(0),
  obstacles: [{ faces: [0, 1, 2], positions: new Float32Array(9) }],
  exclude: { rigid: [true], groupsThatIgnoreEachOther: [[0, 1]], facePairs: Int32Array.of(0, 1), ongoing: true },
};
const at: Float64Array | Float32Array = new Float32Array(9);
const body = new SelfCollision(new Uint32Array(3), at, options);
const answer: Answer = body.firstContact(at, at);
const time: number | null = answer.time;
const points: Float64Array = body.allContacts(at, at).points;
const bounds: Float64Array = body.vertexBounds(at, 1);
const share: number = body.largestStep(at, at);
const near: Int32Array = body.candidates(at, at, share).edgeEdge;
const out: Float64Array | undefined = body.crossings(at).overlaps[0]?.regions[0]?.out;
const verdict: PathsAnswer["verdict"] = body.trueMotion({ positions: () => at, acceleration: () => 1 }, 0, 1).verdict;
const again: Options = { preparation: body.preparation() };
console.log(time, points, bounds, near, out, verdict, again, body.isFree(at, at), body.closed);
body.dispose();

// @ts-expect-error: faces are whole numbers
new SelfCollision(new Float64Array(3), at);
// @ts-expect-error: no such option
new SelfCollision([], at, { thicknes: 1 });
// @ts-expect-error: a radius is missing
body.candidates(at, at);
// @ts-expect-error: read-only
body.closed = true;
