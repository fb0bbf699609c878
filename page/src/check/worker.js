// Reads, poses and answers beside the page, which stays free. Takes {files, engine} once, and posts {kind}: "read", "frames" and
// "answer" of each clip, "progress" in between, and at last "done" or "refused".
import init, { SelfCollision } from "cscd";
import { answerClip } from "./answer.js";
import { readModel } from "./model.js";
import { post, teller } from "./post.js";
import { Surface } from "./surface.js";

const MOST_BYTES = 400 * 2 ** 20;  // of positions on the grid, which the page holds
const PLACES = 65535;

// All frames of a clip as places on a grid, [frames][3][vertices], with bones; and how the viewer reads them.
function framesOf(surface, clip) {
  const { mesh, fps } = surface, frames = Math.max(2, clip.frames), n = mesh.vertices, x = new Float64Array(3 * n);  // one pose is shown as two
  const low = [Infinity, Infinity, Infinity], high = low.map((value) => -value), bones = new Float32Array(6 * surface.bones.length * frames);
  const at = (f) => surface.sample(clip, Math.min(f, clip.frames - 1), x);
  for (let f = 0; f < frames; ++f) {
    at(f);
    for (let i = 0; i < x.length; ++i) {
      if (!Number.isFinite(x[i])) throw new Error(`clip '${clip.name}' has a position that is not finite; repair the animation`);
      if (x[i] < low[i % 3]) low[i % 3] = x[i];
      if (x[i] > high[i % 3]) high[i % 3] = x[i];
    }
    if (surface.bones.length > 0) bones.set(surface.bonesNow(), 6 * surface.bones.length * f);
  }
  const step = Math.max(Math.max(...high.map((value, k) => value - low[k])) / PLACES, Number.MIN_VALUE), places = new Uint16Array(3 * n * frames);
  for (let f = 0; f < frames; ++f) {
    at(f);
    for (let v = 0; v < n; ++v) for (let k = 0; k < 3; ++k) places[3 * n * f + k * n + v] = Math.round((x[3 * v + k] - low[k]) / step);
  }
  const seconds = Array.from({ length: frames }, (_, f) => (clip.frames < 2 ? 0 : clip.second(f)));
  return {
    shown: {
      frames, first_interval: 0, all_intervals: frames - 1, vertices: n, triangles: mesh.triangles, bones: surface.bones.length, fps, first_frame: clip.firstFrame,
      frame_number: seconds.map((s) => s * fps + clip.firstFrame), seconds, grid: { origin: low, step },
    },
    arrays: { places, ends: new Uint16Array(0), interval_of_end: new Uint32Array(0), bones, corners: mesh.corners.slice(), place: surface.place.slice(), part: surface.part.slice() },
  };
}

async function check({ files, engine }) {
  const [{ name }] = files.filter(({ name }) => /\.(glb|gltf|fbx|obj)$/i.test(name)).concat(files);
  const loading = init(engine), surface = new Surface(await readModel(files), name), { model, mesh } = surface;
  const clips = model.clips.length > 0 ? model.clips : [{ name: "", number: -1, start: 0, seconds: 0, frames: 1, firstFrame: 0 }];
  const frames = clips.reduce((sum, clip) => sum + Math.max(2, clip.frames), 0), most = Math.floor(MOST_BYTES / (6 * mesh.vertices));
  if (frames > most) throw new Error(`has ${frames.toLocaleString("en")} frames of ${mesh.vertices.toLocaleString("en")} vertices, more than the ${most.toLocaleString("en")} that this page holds; ask cscd query`);
  const title = (clip) => clip.name || (clip.number < 0 ? "one pose" : `clip ${clip.number}`);
  post("read", {
    header: { schema: "cscd.view/1", name, kind: "model", up: { axis: model.up, because: model.because }, engine_colours: false, thickness: "", texts: surface.texts, true_motion: null, notes: model.notes.map((note) => `${note}.`).join(" "), ...surface.header },
    clips: clips.map(title), intervals: clips.reduce((sum, clip) => sum + Math.max(1, clip.frames - 1), 0),
  });
  const tell = teller();
  let done = 0;
  for (const [number, clip] of clips.entries()) {
    const { arrays, shown } = framesOf(surface, clip);
    clip.shown = shown;
    post("frames", { number, clip: shown }, arrays);
    if (!surface.body) {
      await loading;
      surface.prepare(SelfCollision);
    }
    const { arrays: answers, ...said } = answerClip(surface, clip, {}, (interval) => tell({ number, interval, done: ++done }));
    post("answer", { number, ...said }, answers);
  }
  post("done", {});
}

// What is no Error of ours is a value of the file that was taken for another.
const sentence = (error) => (error instanceof TypeError ? "cannot be read (a value in it is of another kind than it should be); export it again, or ask cscd query" : error.message || String(error));
onmessage = ({ data }) => check(data).catch((error) => post("refused", { text: sentence(error), name: data.files[0].name }));
