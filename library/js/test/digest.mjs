// Prints what digest.py prints, of the package's answers: digest.mjs FILE PASSES
import { createHash } from "node:crypto";
import { readFileSync } from "node:fs";
import init, { SelfCollision } from "cscd";

const file = readFileSync(process.argv[2]);
const bytes = file.buffer.slice(file.byteOffset, file.byteOffset + file.length);
const [faceCount, vertexCount, stepCount] = new Int32Array(bytes, 0, 3);
const [thickness] = new Float64Array(bytes, 16, 1);
const faces = new Uint32Array(bytes, 24, 3 * faceCount);
const first = 24 + 12 * faceCount + 4 * (faceCount % 2), size = 24 * vertexCount;
const steps = Array.from({ length: stepCount }, (_, i) =>
  [0, 1].map((end) => new Float64Array(bytes, first + size * (2 * i + end), 3 * vertexCount)));

const digest = createHash("sha256"), times = {};
const add = (Type, numbers) => digest.update(new Uint8Array(Type.from(numbers, (n) => n + 0).buffer));
let contacts = 0;
function addAnswer(answer) {
  contacts += answer.count;
  for (const ids of [answer.startCrossings, answer.edges, answer.vertices, answer.faces]) add(Int32Array, ids);
  for (const numbers of [answer.times, answer.points, answer.normals]) add(Float64Array, numbers);
}
function addSorted(pairs, columns) {
  const rows = Array.from({ length: pairs.length / columns }, (_, i) => pairs.subarray(columns * i, columns * (i + 1)));
  rows.sort((a, b) => a.map((n, k) => n - b[k]).find((difference) => difference !== 0) ?? 0);
  for (const row of rows) add(Int32Array, row);
}
function ask(name, asked, question, take) {
  for (const given of asked) take(question(...given));
  const least = new Float64Array(asked.length).fill(Infinity);
  for (let pass = 0; pass < Number(process.argv[3]); ++pass)
    asked.forEach((given, i) => {
      const begin = process.cpuUsage();
      question(...given);
      const { user, system } = process.cpuUsage(begin);
      least[i] = Math.min(least[i], (user + system) / 1000);
    });
  least.sort();
  if (least[0] < Infinity) times[name] = (least[(least.length - 1) >> 1] + least[least.length >> 1]) / 2;
}

await init();
const body = new SelfCollision(faces, steps[0][0]);
ask("first contact", steps, (start, end) => body.firstContact(start, end), addAnswer);
ask("all contacts", steps, (start, end) => body.allContacts(start, end), addAnswer);
ask("largest step", steps, (start, end) => body.largestStep(start, end), (share) => add(Float64Array, [share]));
const thick = new SelfCollision(faces, steps[0][0], { thickness });
ask("all contacts, with a thickness", steps, (start, end) => thick.allContacts(start, end), addAnswer);
thick.dispose();
ask("candidates", steps.slice(-3), (start, end) => body.candidates(start, end, 0),
  (near) => { addSorted(near.vertexFace, 2), addSorted(near.edgeEdge, 4); });
ask("vertex bounds", steps.slice(-3), (start) => body.vertexBounds(start, 0.01), (bounds) => add(Float64Array, bounds));
ask("prepare", [[]], () => new SelfCollision(faces, steps[0][0]).dispose(), () => {});
body.dispose();
console.log(JSON.stringify({ digest: digest.digest("hex"), contacts, ms: times }));
