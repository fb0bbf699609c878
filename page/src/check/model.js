// Reads a model file with three.js' loaders, and says where each vertex of its parts is in each frame of each clip. Everything is
// computed in double precision: three.js' own posing rounds to single precision, and `cscd` does not.
import { LoadingManager, Matrix4, PropertyBinding, Quaternion, Texture, Vector3 } from "three";
import { MeshoptDecoder } from "three/examples/jsm/libs/meshopt_decoder.module.js";
import { FBXLoader } from "three/examples/jsm/loaders/FBXLoader.js";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";
import { readSequence } from "./sequence.js";

const ASK = "the program takes such files, by the command cscd query";

// Extensions that say how a surface looks, where light comes from, or who made the file (scenes/import/gltf/extensions.cpp).
const HARMLESS = /^(KHR_(materials_|texture_|lights_punctual|xmp|techniques_webgl)|EXT_(lights_|texture_|mesh_features|instance_features|structural_metadata)|MSFT_(texture_dds|packing_)|CESIUM_primitive_outline|FB_ngon_encoding|GODOT_single_root)/;
const READ = ["KHR_mesh_quantization", "EXT_meshopt_compression", "KHR_meshopt_compression"];

// What three.js says on the console where it poses an FBX file otherwise than the file means.
const FBX_REFUSED = [
  [/more than 4 skinning weights/, "has vertices that follow more than four bones, and this page takes four"],
  [/multiple layers/, "has a clip of several layers, of which three.js takes one"],
  [/attached to more than one geometry/, "has a skeleton or a morph target that several meshes share, which three.js does not read"],
  [/Spherical XYZ/, "turns a node by spheric angles, which three.js does not know"],
];
// Frames a second by the number of FBX's time mode.
const FBX_RATES = [, 120, 100, 60, 50, 48, 30, 30, 30 / 1.001, 30 / 1.001, 25, 24, 1000, 24 / 1.001, , 96, 72, 60 / 1.001, 120 / 1.001];

// Has a reader read a file, and keeps what it says on the console.
async function reading(read, said = []) {
  const { warn } = console;
  console.warn = (...words) => said.push(words.join(" "));
  try {
    return await read();
  } catch (error) {
    const said = error instanceof TypeError || error instanceof RangeError ? "a value in it is none that three.js expects" : error.message.replace(/^THREE\.\w+: /, "").replace(/\.$/, "");
    throw new Error(`cannot be read (${said}); export it again, or try the program: cscd query`);
  } finally {
    console.warn = warn;
  }
}

// Returns a model: {parts, clips, fps, fpsFrom, up, centimetres, notes, node tree, and how to pose it}. Throws an Error with one
// sentence where the file cannot be read or posed as it means.
export async function readModel(files) {
  const models = files.filter(({ name }) => /\.(glb|gltf|fbx|obj)$/i.test(name));
  if (models.length === 0) throw new Error("is no .glb, .gltf, .fbx or .obj file; other formats are read by cscd query");
  const [{ name, bytes }] = models;
  if (/\.obj$/i.test(name)) return readSequence(models);
  if (models.length > 1) throw new Error(`${models.length} model files were given; give one, or the .obj files of one sequence`);
  return /\.fbx$/i.test(name) ? readFbx(bytes) : readGltf(bytes, files);
}

// ---- glTF ----

function partsOfGltf(bytes) {
  const view = new DataView(bytes), text = (from, size) => new TextDecoder().decode(new Uint8Array(bytes, from, size));
  if (bytes.byteLength < 20 || view.getUint32(0, true) !== 0x46546c67) return { json: JSON.parse(text(0, bytes.byteLength)) };
  const size = view.getUint32(12, true), rest = 28 + size <= bytes.byteLength ? view.getUint32(20 + size, true) : 0;
  return { json: JSON.parse(text(20, size)), body: bytes.slice(28 + size, 28 + size + rest) };
}

function bufferOf({ uri }, body, files) {
  if (uri === undefined) return body ?? new ArrayBuffer(0);
  if (uri.startsWith("data:")) return Uint8Array.from(atob(uri.slice(uri.indexOf(",") + 1)), (c) => c.charCodeAt(0)).buffer;
  const wanted = decodeURIComponent(uri).split("/").at(-1), found = files.find(({ name }) => name === wanted);
  if (!found) throw new Error(`names the file ${wanted}, which is not here; give both files together`);
  return found.bytes;
}

function refuseMatrix(matrix) {
  const given = new Matrix4().fromArray(matrix), parts = [new Vector3(), new Quaternion(), new Vector3()];
  const again = new Matrix4().compose(...(given.decompose(...parts), parts)).elements, most = Math.max(...matrix.map(Math.abs));
  if (again.some((x, i) => Math.abs(x - matrix[i]) > 1e-6 * most)) throw new Error(`has a node with a skewed matrix, which three.js does not keep; ${ASK}`);
}

async function readGltf(bytes, files) {
  const { json, body } = await reading(() => partsOfGltf(bytes));
  const known = (extension) => READ.includes(extension) || HARMLESS.test(extension);
  const unknown = (json.extensionsRequired ?? []).find((extension) => !known(extension));
  if (unknown) throw new Error(`needs the glTF extension ${unknown}, which this page does not read${unknown.includes("draco") ? `; ${ASK}` : "; switch it off in the exporter"}`);
  const notes = (json.extensionsUsed ?? []).filter((extension) => !known(extension)).map((extension) => `the optional glTF extension '${extension}' is not read`);
  for (const key of ["materials", "textures", "images", "samplers"]) delete json[key];
  for (const { primitives } of json.meshes ?? [])
    for (const primitive of primitives) {
      const { POSITION, JOINTS_0, WEIGHTS_0, JOINTS_1 } = primitive.attributes;
      if (JOINTS_1 !== undefined) throw new Error(`has vertices that follow more than four bones, and this page takes four; ${ASK}`);
      const moved = primitive.targets?.filter((target) => target.POSITION !== undefined).length ?? 0;
      if (moved > 0 && moved < primitive.targets.length) throw new Error(`has a morph target without positions beside others with them, which three.js takes for something else; ${ASK}`);
      primitive.attributes = JSON.parse(JSON.stringify({ POSITION, JOINTS_0, WEIGHTS_0 }));
      primitive.targets = moved > 0 ? primitive.targets.map((target) => ({ POSITION: target.POSITION })) : undefined;
      delete primitive.material;
    }
  for (const { matrix } of json.nodes ?? []) if (matrix) refuseMatrix(matrix);
  json.scenes ??= [{ nodes: (json.nodes ?? []).flatMap((_, n) => (json.nodes.some(({ children }) => children?.includes(n)) ? [] : [n])) }];
  const loader = new GLTFLoader().setMeshoptDecoder(MeshoptDecoder), buffers = (json.buffers ?? []).map((buffer) => bufferOf(buffer, body, files));
  loader.register((parser) => {
    parser.loadBuffer = async (i) => buffers[i];  // nothing is fetched
    return { name: "cscd" };
  });
  const { scene, animations, parser } = await reading(() => loader.parseAsync(json, ""));
  animations.forEach((clip, i) => { clip.name = json.animations[i].name ?? ""; });  // three.js makes names up
  const nodeOf = (mesh) => (parser.associations.get(mesh)?.nodes === undefined ? mesh.parent : mesh);  // a primitive of several
  return new Model(scene, animations, { nodeOf, nameOf: (node) => node.userData.name ?? "", format: "glTF 2", up: "y", because: "glTF files have it so", centimetres: 100, notes });
}

// ---- FBX ----

// The number of FBX's time mode: in binary files, behind the strings of the property and of its kind.
function timeModeOf(bytes) {
  const text = new TextDecoder("latin1").decode(bytes), plain = /"TimeMode",\s*"\w*",\s*"",\s*"",\s*(\d+)/.exec(text);
  if (plain) return Number(plain[1]);
  const at = text.indexOf("TimeModeS"), last = at < 0 ? -1 : text.indexOf("I", text.indexOf("enum", at) + 4);
  return last < 0 ? 0 : new DataView(bytes).getInt32(last + 1, true);
}

async function readFbx(bytes) {
  const said = [], manager = new LoadingManager();
  manager.addHandler(/./, { path: "-", setPath() {}, load: () => new Texture() });  // pictures do not matter
  globalThis.window ??= globalThis;  // which cameras ask
  const scene = await reading(() => new FBXLoader(manager).parse(bytes, "-"), said);
  const refused = FBX_REFUSED.find(([pattern]) => said.some((line) => pattern.test(line)));
  if (refused) throw new Error(`${refused[1]}; ${ASK}`);
  const nodes = [];
  scene.traverse((node) => nodes.push(node.name));
  const driven = new Set(scene.animations.flatMap(({ tracks }) => tracks.map(({ name }) => PropertyBinding.parseTrackName(name).nodeName)));
  const twice = [...driven].find((name) => nodes.indexOf(name) !== nodes.lastIndexOf(name));
  if (twice) throw new Error(`has several nodes with the name ${twice}, of which three.js moves one; ${ASK}`);
  const rate = FBX_RATES[timeModeOf(bytes)], notes = [
    "FBX is posed by three.js, which joins keys by straight lines and cuts polygons in its own way: where keys are farther apart than frames, or faces have four corners, cscd query may answer otherwise"];
  return new Model(scene, scene.animations, { nodeOf: (mesh) => mesh, nameOf: (node) => node.userData.originalName ?? node.name, format: "FBX", up: "y", because: "three.js turns FBX files so", centimetres: scene.userData.unitScaleFactor ?? 0, notes, rate });
}

// ---- Any of both ----

// Keys say a rate where those of a clip are evenly spaced, 20 to 240 a second (scenes/import/frame_rate.cpp).
function spacingOf({ tracks }) {
  const all = Float64Array.from(new Set(tracks.flatMap(({ times }) => Array.from(times)))).sort();
  const moments = all.filter((time, i) => i === 0 || time - all[i - 1] >= 1e-4), last = moments.length - 1;
  const gap = (moments[last] - moments[0]) / last, rate = 1 / gap;
  if (last < 2 || moments.some((time, i) => Math.abs(moments[0] + i * gap - time) > 0.02 * gap)) return null;
  if (!(rate >= 20 * (1 - 3e-4) && rate <= 240)) return null;
  return [Math.round(rate), Math.round(rate * 1.001) / 1.001].find((exact) => Math.abs(rate - exact) <= 3e-4 * exact) ?? rate;
}

function rateOf(animations, stated) {
  if (stated) return { fps: stated, fpsFrom: "file" };
  const rates = animations.map(spacingOf).filter((rate) => rate !== null);
  if (rates.length > 0 && rates.every((rate) => Math.abs(rate - rates[0]) <= 3e-4 * rates[0])) return { fps: rates[0], fpsFrom: "keys" };
  return { fps: 30, fpsFrom: "assumed" };
}

function numbersOf(attribute) {
  const out = new Float64Array(attribute.count * attribute.itemSize);
  for (let i = 0, at = 0; i < attribute.count; ++i)
    for (let k = 0; k < attribute.itemSize; ++k) out[at++] = attribute.getComponent(i, k);
  return out;
}

// A mesh: where its vertices are, which bones move them, and its morph targets.
function partOf(mesh, { nodeOf, nameOf }) {
  const { geometry, skeleton } = mesh, { position, skinIndex, skinWeight } = geometry.attributes;
  if (mesh.isInstancedMesh) throw new Error(`has a mesh that is drawn many times by one node (${nameOf(nodeOf(mesh))}), which this page does not pose; export it without EXT_mesh_gpu_instancing`);
  const corners = geometry.index ? Array.from(geometry.index.array) : Array.from({ length: position.count }, (_, i) => i);
  const part = { node: nodeOf(mesh), influences: mesh.morphTargetInfluences ?? [], positions: numbersOf(position), corners: corners.slice(0, corners.length - (corners.length % 3)), joints: [], bone: null, weight: null };
  const beyond = part.corners.find((v) => !(v < position.count));
  if (beyond !== undefined) throw new Error(`a mesh (${nameOf(part.node)}) names vertex ${beyond} of ${position.count}; repair the file`);
  part.targets = (geometry.morphAttributes.position ?? []).map(numbersOf);
  if (part.targets.length > 0 && !geometry.morphTargetsRelative) part.targets.forEach((target) => target.forEach((x, i) => { target[i] = x - part.positions[i]; }));
  if (!skeleton || !skinIndex) return part;
  part.joints = skeleton.bones.map((node, i) => ({ node, offset: new Matrix4().multiplyMatrices(skeleton.boneInverses[i], mesh.bindMatrix) }));
  part.bone = numbersOf(skinIndex);
  part.weight = numbersOf(skinWeight);
  for (let v = 0; v < part.weight.length; v += 4) {
    const sum = part.weight[v] + part.weight[v + 1] + part.weight[v + 2] + part.weight[v + 3];
    for (let k = v; sum > 0 && k < v + 4; ++k) part.weight[k] /= sum;
  }
  return part;
}

// Frames lie every 1 / fps seconds from the clip's first key, and one lies at its last key (scenes/import/clip_frames.cpp).
const framesOf = (seconds, fps) => {
  const frames = seconds * fps, whole = Math.round(frames);
  return (Math.abs(frames - whole) <= 1e-3 ? whole : Math.ceil(frames)) + 1;
};

// Times of keys that lie a hair beside a frame, on that frame, because times in files are rounded (put_keys_on_frames() of
// scenes/import/clip_frames.cpp). Neighbours that are meant for one frame stay where they are.
function onFrames(times, { start, seconds, fps, second }) {
  const meant = (time) => {
    const frame = Math.round((time - start) * fps), there = start + second(frame), rounding = Math.min(2 ** -21 * Math.abs(time), 0.25 / fps);
    return frame >= 0 && frame <= seconds * fps + 1 && Math.abs(there - time) <= Math.max(1e-3 / fps, rounding) ? there : time;
  };
  const own = Float64Array.from(times), there = own.map(meant);
  return own.map((time, i) => ((i === 0 || there[i - 1] < there[i]) && (i + 1 === own.length || there[i] < there[i + 1]) ? there[i] : time));
}

class Model {
  constructor(scene, animations, { rate, ...said }) {
    Object.assign(this, said, rateOf(animations, rate));
    this.scene = scene;
    this.nodes = [];  // parents first
    const add = (root) => root.traverse((node) => this.nodes.push(node));
    add(scene);
    this.parts = this.nodes.filter((node) => node.isMesh).map((mesh) => partOf(mesh, this));
    for (const { joints } of this.parts)
      for (let { node } of joints) {
        while (node.parent) node = node.parent;
        if (!this.nodes.includes(node)) add(node);
      }
    this.order = new Map(this.nodes.map((node, i) => [node, i]));
    this.atRest = this.nodes.map((node) => [node, node.position.clone(), node.quaternion.clone(), node.scale.clone(), node.morphTargetInfluences?.slice()]);
    this.clips = animations.map((clip, number) => this.clipOf(clip, number));
    this.vertexCount = this.parts.reduce((sum, { positions }) => sum + positions.length / 3, 0);
    this.names = this.parts.map(({ node }) => this.nameOf(node));
  }

  clipOf({ name, tracks }, number) {
    const long = tracks.filter(({ times }) => times.length > 1);  // a single key holds at all times
    const start = long.length ? Math.min(...long.map(({ times }) => times[0])) : 0;
    const seconds = long.length ? Math.max(...long.map(({ times }) => times.at(-1))) - start : 0;
    const frames = framesOf(seconds, this.fps), first = start * this.fps, whole = Math.round(first);
    const second = (frame) => (frame + 1 >= frames ? seconds : frame / this.fps);
    const drives = tracks.map((track) => {
      track.times = onFrames(track.times, { start, seconds, fps: this.fps, second });
      return { to: PropertyBinding.create(this.scene, track.name), from: track.createInterpolant(new Float64Array(track.getValueSize())) };
    });
    return { name, number, start, seconds, frames, drives, second, firstFrame: Math.abs(first - whole) <= 1e-3 ? whole : first };
  }

  pose(drives, time) {
    for (const [node, position, quaternion, scale, influences] of this.atRest) {
      node.position.copy(position);
      node.quaternion.copy(quaternion);
      node.scale.copy(scale);
      influences?.forEach((x, i) => { node.morphTargetInfluences[i] = x; });
    }
    for (const { to, from } of drives) to.setValue(from.evaluate(time), 0);
    for (const node of this.nodes) {
      node.quaternion.normalize();
      node.updateMatrix();
      if (node.parent) node.matrixWorld.multiplyMatrices(node.parent.matrixWorld, node.matrix);
      else node.matrixWorld.copy(node.matrix);
    }
  }

  // All vertices of all parts in a frame of a clip, [3 * vertexCount]; of no clip, at rest.
  sample(clip, frame, out) {
    if (clip) this.pose(clip.drives, clip.start + clip.second(frame));
    else this.pose([], 0);
    this.skin((node) => node.matrixWorld, out);
  }

  // Where each node was when vertices were bound to it (bind_pose() of scenes/character/pose.cpp).
  bound() {
    this.pose([], 0);
    const bound = new Map();
    for (const { joints } of this.parts) {
      if (joints.length === 0) continue;
      const top = joints.reduce((a, b) => (this.order.get(b.node) < this.order.get(a.node) ? b : a));
      const toWorld = new Matrix4().multiplyMatrices(top.node.matrixWorld, top.offset);
      for (const { node, offset } of joints)
        if (!bound.has(node) && offset.determinant() !== 0) bound.set(node, new Matrix4().multiplyMatrices(toWorld, offset.clone().invert()));
    }
    for (const node of this.nodes)
      if (!bound.has(node)) bound.set(node, node.parent ? new Matrix4().multiplyMatrices(bound.get(node.parent), node.matrix) : node.matrix.clone());
    return bound;
  }

  skin(worldOf, out) {
    let at = 0;
    for (const { node, influences: shares, positions, joints, bone, weight, targets } of this.parts) {
      const own = worldOf(node).elements, maps = joints.map((joint) => new Matrix4().multiplyMatrices(worldOf(joint.node), joint.offset).elements);
      for (let v = 0; v < positions.length; v += 3) {
        let x = positions[v], y = positions[v + 1], z = positions[v + 2], moved = false;
        for (let t = 0; t < targets.length; ++t)
          if (shares[t]) x += shares[t] * targets[t][v], y += shares[t] * targets[t][v + 1], z += shares[t] * targets[t][v + 2];
        let a = 0, b = 0, c = 0;
        for (let k = (4 * v) / 3, end = k + 4; weight && k < end; ++k) {
          const w = weight[k], m = maps[bone[k]];
          if (w === 0 || !m) continue;
          moved = true;
          a += w * (m[0] * x + m[4] * y + m[8] * z + m[12]);
          b += w * (m[1] * x + m[5] * y + m[9] * z + m[13]);
          c += w * (m[2] * x + m[6] * y + m[10] * z + m[14]);
        }
        out[at++] = moved ? a : own[0] * x + own[4] * y + own[8] * z + own[12];
        out[at++] = moved ? b : own[1] * x + own[5] * y + own[9] * z + own[13];
        out[at++] = moved ? c : own[2] * x + own[6] * y + own[10] * z + own[14];
      }
    }
  }

  // The node that moves each vertex most.
  mainNodes() {
    return this.parts.flatMap(({ node, positions, joints, bone, weight }) => Array.from({ length: positions.length / 3 }, (_, v) => {
      let most = -1;
      for (let k = 4 * v; weight && k < 4 * v + 4; ++k) if (weight[k] > 0 && (most < 0 || weight[k] > weight[most])) most = k;
      return most < 0 ? node : joints[bone[most]].node;
    }));
  }
}
