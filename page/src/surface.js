// The moving surface: positions and normals of one moment, drawn with a colour for each triangle.
import * as THREE from "three";

const VERTEX = /* glsl */ `
  uniform highp sampler2D positions, normals;
  uniform highp sampler2D colours;
  uniform int vertexWidth, colourWidth;
  in float number;
  out vec3 vNormal;
  out vec3 vView;
  out vec3 vCorner;
  flat out vec4 vColour;
  void main() {
    int vertex = int(number), triangle = gl_VertexID / 3, corner = gl_VertexID - 3 * triangle;
    ivec2 at = ivec2(vertex % vertexWidth, vertex / vertexWidth);
    vec4 view = viewMatrix * vec4(texelFetch(positions, at, 0).xyz, 1.0);
    vNormal = mat3(viewMatrix) * texelFetch(normals, at, 0).xyz;
    vView = view.xyz;
    vCorner = vec3(corner == 0, corner == 1, corner == 2);
    vColour = texelFetch(colours, ivec2(triangle % colourWidth, triangle / colourWidth), 0);
    gl_Position = projectionMatrix * view;
  }`;

const FRAGMENT = /* glsl */ `
  precision highp float;
  in vec3 vNormal;
  in vec3 vView;
  in vec3 vCorner;
  flat in vec4 vColour;
  uniform float edges;
  uniform float dark;
  out vec4 outColour;
  void main() {
    vec3 face = normalize(cross(dFdx(vView), dFdy(vView)));
    vec3 n = normalize(vNormal);
    if (dot(n, n) < 0.5) n = face;  // a vertex without a normal
    if (!gl_FrontFacing) n = -n;
    if (dot(n, face) < 0.55) n = face;  // hard edges stay hard
    vec3 toEye = normalize(-vView);
    float sky = 0.5 + 0.5 * n.y;
    float key = max(dot(n, normalize(vec3(-0.35, 0.6, 0.75))), 0.0);
    float fill = max(dot(n, normalize(vec3(0.8, 0.1, 0.4))), 0.0);
    float rim = pow(1.0 - max(dot(n, toEye), 0.0), 3.0);
    vec3 base = pow(vColour.rgb, vec3(2.2));
    if (!gl_FrontFacing) base *= 0.65;
    vec3 light = mix(vec3(0.20, 0.20, 0.23), vec3(0.46, 0.48, 0.52), sky) + 0.62 * key * vec3(1.0, 0.98, 0.94) + 0.12 * fill;
    vec3 colour = base * light + rim * mix(0.03, 0.10, dark) * vec3(0.8, 0.9, 1.0);
    vec3 width = fwidth(vCorner);
    vec3 near = smoothstep(vec3(0.0), width * 1.1, vCorner);
    float line = 1.0 - min(min(near.x, near.y), near.z);
    float large = 1.0 - smoothstep(0.15, 0.4, max(max(width.x, width.y), width.z));
    colour *= 1.0 - edges * 0.30 * line * large;
    outColour = vec4(pow(colour, vec3(1.0 / 2.2)), 1.0);
  }`;

// Triangles whose colour has no opacity shine through what lies before them.
const GLOW_FRAGMENT = /* glsl */ `
  precision highp float;
  flat in vec4 vColour;
  out vec4 outColour;
  void main() {
    if (vColour.a > 0.5) discard;
    outColour = vec4(vColour.rgb, 0.55);
  }`;

const widthFor = (count) => Math.min(2048, Math.max(1, count));

function texture(data, width, height, format, type) {
  const made = new THREE.DataTexture(data, width, height, format, type);
  made.needsUpdate = true;
  return made;
}

export class Surface {
  constructor(recording) {
    this.recording = recording;
    const { vertices, triangles } = recording.clip;
    this.width = widthFor(vertices);
    const cells = this.width * Math.ceil(vertices / this.width);
    this.positions = new Float32Array(4 * cells);  // x y z and one unused number each, as textures have it
    this.normals = new Float32Array(4 * cells);
    this.positionTexture = texture(this.positions, this.width, cells / this.width, THREE.RGBAFormat, THREE.FloatType);
    this.normalTexture = texture(this.normals, this.width, cells / this.width, THREE.RGBAFormat, THREE.FloatType);
    this.colourWidth = widthFor(triangles);
    this.colourHeight = Math.ceil(triangles / this.colourWidth);
    this.geometry = new THREE.BufferGeometry();
    this.geometry.setAttribute("number", new THREE.BufferAttribute(Float32Array.from(recording.corners), 1));
    this.geometry.setDrawRange(0, 3 * triangles);
  }

  // A look of the surface in colours of its own, [triangles] of 4 bytes.
  makeLook() {
    const colours = new Uint8Array(4 * this.colourWidth * this.colourHeight).fill(255);
    const colourTexture = texture(colours, this.colourWidth, this.colourHeight, THREE.RGBAFormat, THREE.UnsignedByteType);
    const material = new THREE.ShaderMaterial({
      glslVersion: THREE.GLSL3, vertexShader: VERTEX, fragmentShader: FRAGMENT, side: THREE.DoubleSide,
      uniforms: {
        positions: { value: this.positionTexture }, normals: { value: this.normalTexture }, colours: { value: colourTexture },
        vertexWidth: { value: this.width }, colourWidth: { value: this.colourWidth }, edges: { value: 1 }, dark: { value: 0 },
      },
    });
    const glow = new THREE.ShaderMaterial({
      glslVersion: THREE.GLSL3, vertexShader: VERTEX, fragmentShader: GLOW_FRAGMENT, side: THREE.DoubleSide, uniforms: material.uniforms,
      depthTest: false, depthWrite: false, transparent: true,
    });
    const group = new THREE.Group();
    [material, glow].forEach((m, i) => {
      const mesh = new THREE.Mesh(this.geometry, m);
      mesh.frustumCulled = false;
      mesh.renderOrder = i;
      group.add(mesh);
    });
    return { group, glow: group.children[1], colours, colourTexture, material };
  }

  // Moves the surface to the share t of the way from frame to frame + 1, or to the end that was predicted of that interval.
  pose(frame, t, predicted) {
    const { places, middle, clip } = this.recording;
    const n = clip.vertices, from = 3 * n * frame;
    const [target, to] = this.end(frame, t, predicted);
    for (let axis = 0; axis < 3; ++axis)
      for (let v = 0, a = from + axis * n, b = to + axis * n; v < n; ++v, ++a, ++b)
        this.positions[4 * v + axis] = ((1 - t) * places[a] + t * target[b]) / 65535 - middle[axis];
    this.computeNormals();
    this.positionTexture.needsUpdate = true;
    this.normalTexture.needsUpdate = true;
  }

  // The sum of the area vectors of the triangles round each vertex; the shader gives it length 1.
  computeNormals() {
    const { corners } = this.recording, p = this.positions, out = this.normals;
    out.fill(0);
    for (let i = 0; i < corners.length; i += 3) {
      const a = 4 * corners[i], b = 4 * corners[i + 1], c = 4 * corners[i + 2];
      const ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], uz = p[b + 2] - p[a + 2];
      const vx = p[c] - p[a], vy = p[c + 1] - p[a + 1], vz = p[c + 2] - p[a + 2];
      const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
      out[a] += x; out[a + 1] += y; out[a + 2] += z;
      out[b] += x; out[b + 1] += y; out[b + 2] += z;
      out[c] += x; out[c + 1] += y; out[c + 2] += z;
    }
    for (let i = 0; i < out.length; i += 4) {
      const length = Math.hypot(out[i], out[i + 1], out[i + 2]) || 1;
      out[i] /= length;
      out[i + 1] /= length;
      out[i + 2] /= length;
    }
  }

  // The array that holds the places at the end of an interval, and where they begin in it.
  end(frame, t, predicted) {
    const { places, ends, endOfInterval, clip } = this.recording, n = 3 * clip.vertices;
    if (t > 0 && predicted && endOfInterval.has(frame)) return [ends, n * endOfInterval.get(frame)];
    return [places, n * (t > 0 ? frame + 1 : frame)];
  }

  // One vertex at any moment.
  pointAt(vertex, frame, t, predicted) {
    const { places, middle, clip } = this.recording, n = clip.vertices;
    const [target, to] = this.end(frame, t, predicted);
    const at = (axis) => ((1 - t) * places[3 * n * frame + axis * n + vertex] + t * target[to + axis * n + vertex]) / 65535 - middle[axis];
    return new THREE.Vector3(at(0), at(1), at(2));
  }

  point(vertex, into) {
    return into.set(this.positions[4 * vertex], this.positions[4 * vertex + 1], this.positions[4 * vertex + 2]);
  }

  // The mean length of the edges of the shown pose, from some of them.
  meanEdge() {
    const { corners } = this.recording, a = new THREE.Vector3(), b = new THREE.Vector3();
    const stride = 3 * Math.max(1, Math.floor(corners.length / 3 / 500));
    let sum = 0, count = 0;
    for (let i = 0; i + 1 < corners.length; i += stride, ++count) sum += this.point(corners[i], a).distanceTo(this.point(corners[i + 1], b));
    return sum / count;
  }

  // The sphere round the box of the shown pose.
  bounds() {
    const box = new THREE.Box3(), point = new THREE.Vector3();
    for (let v = 0; v < this.recording.clip.vertices; ++v) box.expandByPoint(this.point(v, point));
    return box.getBoundingSphere(new THREE.Sphere());
  }
}
