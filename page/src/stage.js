// The canvas: one surface, seen by one camera, in a pane for each strategy that is shown; marks of contacts; and a small
// view of the whole surface while the camera is near.
import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/examples/jsm/lines/LineSegmentsGeometry.js";
import { BLUE, GREEN, PINK, RED, YELLOW } from "./palette.js";
import { Surface } from "./surface.js";

THREE.ColorManagement.enabled = false;  // colours are given as the screen shows them

const DOT_VERTEX = /* glsl */ `
  uniform float size;
  in float weight;
  in vec3 tint;
  out float vWeight;
  out vec3 vTint;
  void main() {
    vWeight = weight;
    vTint = tint;
    gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
    gl_PointSize = size * (0.35 + 0.65 * weight);
  }`;
const DOT_FRAGMENT = /* glsl */ `
  precision highp float;
  in float vWeight;
  in vec3 vTint;
  out vec4 outColour;
  void main() {
    float r = 2.0 * length(gl_PointCoord - 0.5);
    float edge = fwidth(r);
    float alpha = 1.0 - smoothstep(1.0 - edge, 1.0, r);
    if (alpha <= 0.0) discard;
    float inside = 1.0 - smoothstep(0.66 - edge, 0.66, r);
    outColour = vec4(mix(vec3(1.0), vTint, inside), alpha * (0.55 + 0.45 * vWeight));
  }`;

// Round dots of a size in pixels, which the surface does not hide.
function dots(colour, size) {
  const material = new THREE.ShaderMaterial({
    glslVersion: THREE.GLSL3, vertexShader: DOT_VERTEX, fragmentShader: DOT_FRAGMENT, transparent: true, depthTest: false,
    uniforms: { size: { value: size } },
  });
  const points = new THREE.Points(new THREE.BufferGeometry(), material);
  points.colour = new THREE.Color(colour);
  points.frustumCulled = false;
  points.renderOrder = 5;
  points.visible = false;
  return points;
}

// Lines of a width in pixels, which the surface does not hide.
function lines(colour, width, opacity = 1) {
  const material = new LineMaterial({ color: colour, linewidth: width, transparent: true, opacity, depthTest: false });
  const made = new LineSegments2(new LineSegmentsGeometry(), material);
  made.frustumCulled = false;
  made.renderOrder = 4;
  made.visible = false;
  return made;
}

// `colours` gives red, green and blue of every end, where the lines do not have one colour.
function setLines(object, numbers, colours) {
  object.visible = numbers.length > 0;
  if (!object.visible) return;
  object.geometry.dispose();
  object.geometry = new LineSegmentsGeometry();
  object.geometry.setPositions(numbers);
  if (colours) object.geometry.setColors(colours);
}

// `colours` gives red, green and blue of every dot, where the dots do not have one colour.
function setDots(object, numbers, weights, colours) {
  object.visible = numbers.length > 0;
  object.geometry.dispose();
  object.geometry = new THREE.BufferGeometry();
  object.geometry.setAttribute("position", new THREE.BufferAttribute(Float32Array.from(numbers), 3));
  object.geometry.setAttribute("weight", new THREE.BufferAttribute(Float32Array.from(weights), 1));
  const tints = colours || weights.flatMap(() => object.colour.toArray());
  object.geometry.setAttribute("tint", new THREE.BufferAttribute(Float32Array.from(tints), 3));
}

// The marks of one strategy in the shown interval.
export class Marks {
  constructor() {
    this.group = new THREE.Group();
    this.contacts = dots(BLUE, 13);
    this.chosen = dots(BLUE, 20);
    this.others = lines("#20303c", 1.2, 0.75);
    this.normals = lines(BLUE, 2);
    this.first = lines(BLUE, 4);
    this.second = lines(PINK, 4);
    this.crossings = lines(RED, 4);
    this.crossingGlow = lines("#5a1400", 7, 0.55);
    this.wayGlow = lines("#ffffff", 7, 0.8);
    this.way = lines(GREEN, 4);
    this.observers = dots(BLUE, 12);
    this.observerEdges = lines("#ffffff", 7, 0.8);
    this.observerSegments = lines("#ffffff", 3.5);
    this.observerSegments.material.vertexColors = true;
    this.group.add(this.observerEdges, this.observerSegments, this.observers, this.crossingGlow, this.crossings, this.others, this.second, this.first, this.normals, this.contacts, this.chosen, this.wayGlow, this.way);
    // The renderer would sort what is transparent by how far away its middle is.
    this.group.children.forEach((mark, i) => { mark.renderOrder += (i + 1) / 100; });
  }
  setContacts(numbers, weights) { setDots(this.contacts, numbers, weights); }
  setChosen(numbers) { setDots(this.chosen, numbers, numbers.length ? [1] : []); }
  setLines(name, numbers) { setLines(this[name], numbers); }
  setObservers(points, pointColours, segments, segmentColours) {
    this.observers.material.uniforms.size.value = points.length > 180 ? 8 : 12;  // more than 60 points would cover each other
    setDots(this.observers, points, new Array(points.length / 3).fill(0.8), pointColours);
    setLines(this.observerEdges, segments);
    setLines(this.observerSegments, segments, segmentColours);
  }
}

const easing = (t) => (t < 0.5 ? 4 * t * t * t : 1 - (2 - 2 * t) ** 3 / 2);

export class Stage {
  constructor(canvas, recording, up, onDraw) {
    this.canvas = canvas;
    this.recording = recording;
    this.renderer = canvas.renderer ??= new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true });  // one for all recordings
    this.renderer.setClearColor(0, 0);
    this.renderer.autoClear = false;
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
    this.surface = new Surface(recording);
    this.meanEdge = 0;
    this.insetColour = new THREE.Color("#ffffff");
    this.scene = new THREE.Scene();
    this.skeleton = lines("#101820", 2.2, 0.85);
    this.joints = dots(YELLOW, 8);
    this.scene.add(this.skeleton, this.joints);
    this.insetDot = dots(RED, 18);
    this.scene.add(this.insetDot);
    this.camera = new THREE.PerspectiveCamera(32, 1, 0.001, 50);
    this.insetCamera = new THREE.PerspectiveCamera(32, 1, 0.01, 50);
    this.looks = [];
    this.panes = [];
    this.insetShown = false;
    this.insetPoint = null;
    this.setUp(up);
    this.requested = false;
    this.onDraw = onDraw;
    this.frameTimes = [];
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(canvas);
  }

  end() {
    this.ended = true;
    this.observer.disconnect();
    this.controls.dispose();
    // Once the next stage has drawn, which then finds the shaders compiled.
    setTimeout(() => this.scene.traverse(({ geometry, material }) => {
      geometry?.dispose();
      material?.dispose();
      for (const { value } of Object.values(material?.uniforms ?? {})) if (value?.isTexture) value.dispose();
    }), 2000);
  }

  setUp(axis) {
    const sign = axis[0] === "-" ? -1 : 1, of = (name) => (axis.at(-1) === name ? sign : 0);
    this.up = new THREE.Vector3(of("x"), of("y"), of("z"));
    this.camera.up.copy(this.up);
    this.insetCamera.up.copy(this.up);
    // OrbitControls reads the camera's up direction when it is made.
    const target = this.controls ? this.controls.target : new THREE.Vector3();
    if (this.controls) this.controls.dispose();
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.zoomToCursor = true;
    this.controls.target.copy(target);
    this.controls.addEventListener("change", () => this.requestDraw());
    this.controls.addEventListener("start", () => { this.flight = null; });
  }

  // One look for each strategy that is shown, with the marks of that strategy.
  setLooks(count) {
    while (this.looks.length < count) {
      const look = this.surface.makeLook();
      look.marks = new Marks();
      this.scene.add(look.group, look.marks.group);
      this.looks.push(look);
    }
    this.shown = count;
    this.layOut();
    this.requestDraw();
  }

  layOut() {
    const { clientWidth: w, clientHeight: h } = this.canvas, n = this.shown || 1;
    let columns = 1;
    for (let c = 1, best = 0; c <= n; ++c) {  // the panes in which a square fits largest
      const side = Math.min(w / c, h / Math.ceil(n / c));
      if (side > best * 1.001) {
        best = side;
        columns = c;
      }
    }
    const rows = Math.ceil(n / columns);
    this.panes = Array.from({ length: n }, (_, i) => ({
      x: (i % columns) * w / columns, y: Math.floor(i / columns) * h / rows, w: w / columns, h: h / rows,
    }));
  }

  resize() {
    const { clientWidth: w, clientHeight: h } = this.canvas;
    if (!w || !h) return;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.renderer.setSize(w, h, false);
    this.layOut();
    this.requestDraw();
    if (this.onResize) this.onResize();
  }

  requestDraw() {
    if (this.requested || this.ended) return;
    this.requested = true;
    requestAnimationFrame((now) => {
      this.requested = false;
      if (!this.ended) this.step(now);
    });
  }

  step(now) {
    const begin = performance.now();
    if (this.flight) this.fly(now);
    if (this.beforeDraw) this.beforeDraw(now);
    this.draw();
    this.frameTimes.push({ at: now, cpu: performance.now() - begin });
    if (this.frameTimes.length > 600) this.frameTimes.shift();
    if (this.flight) this.requestDraw();
  }

  draw() {
    const { renderer, camera, scene } = this;
    const { clientHeight: height } = this.canvas;
    renderer.setScissorTest(true);
    const distance = camera.position.distanceTo(this.controls.target);
    camera.near = distance / 300;
    camera.far = distance + 6;
    // Edges are drawn where the mean edge is long enough on the screen.
    const pixels = (this.meanEdge * this.panes[0].h) / (2 * distance * Math.tan(THREE.MathUtils.degToRad(camera.fov / 2)));
    const edges = THREE.MathUtils.smoothstep(pixels, 7, 20);
    const draw = (index, pane, view, inset) => {
      this.looks.forEach((look, i) => {
        look.group.visible = i === index;
        look.marks.group.visible = i === index && !inset;
        look.material.uniforms.edges.value = inset ? 0 : edges;
      });
      this.skeleton.visible = this.bonesShown && !inset;
      this.joints.visible = this.bonesShown && !inset;
      this.insetDot.visible = inset && this.insetPoint !== null;
      view.aspect = pane.w / pane.h;
      view.updateProjectionMatrix();
      const y = height - pane.y - pane.h;
      renderer.setViewport(pane.x, y, pane.w, pane.h);
      renderer.setScissor(pane.x, y, pane.w, pane.h);
      renderer.setClearColor(this.insetColour, inset ? 0.93 : 0);
      renderer.clear();
      renderer.render(scene, view);
    };
    this.panes.forEach((pane, i) => draw(i, pane, camera, false));
    this.insetShown = this.whole && this.insetPoint !== null && distance < 0.55 * this.distanceFor(this.whole.radius);
    const box = this.insetBox && this.insetShown ? this.insetBox() : null;
    if (box) {
      const away = new THREE.Vector3().subVectors(camera.position, this.controls.target).normalize();
      const { center, distance: from } = this.fit(away, 1.25, box, this.eachVertex(2000));  // some of the vertices tell enough
      this.insetCamera.position.copy(center).addScaledVector(away, from);
      this.insetCamera.lookAt(center);
      this.insetCamera.near = 0.01;
      draw(0, box, this.insetCamera, true);
    }
    if (this.onDraw) this.onDraw();
  }

  // How far the camera has to be for a sphere to fit.
  distanceFor(radius) {
    const pane = this.panes[0] || { w: 1, h: 1 };
    const half = Math.tan(THREE.MathUtils.degToRad(this.camera.fov / 2)) * Math.min(1, pane.w / pane.h);
    return radius / Math.sin(Math.atan(half));
  }

  setInsetPoint(point) {
    this.insetPoint = point;
    if (point) setDots(this.insetDot, [point.x, point.y, point.z], [1]);
  }

  // Visits the vertices of the shown pose, or about `most` of them.
  eachVertex(most = Infinity) {
    const { surface, recording } = this, stride = Math.max(1, Math.floor(recording.clip.vertices / most)), point = new THREE.Vector3();
    return (take) => {
      for (let v = 0; v < recording.clip.vertices; v += stride) take(surface.point(v, point));
    };
  }

  // The point to look at along a direction, and the distance from it, at which all points that `each` visits just fit.
  fit(direction, margin = 1.06, pane = this.panes[0], each = this.eachVertex()) {
    const { surface, up } = this;
    const right = new THREE.Vector3().crossVectors(up, direction).normalize(), above = new THREE.Vector3().crossVectors(direction, right);
    const low = [1e9, 1e9], high = [-1e9, -1e9], axes = [right, above];
    each((x) => axes.forEach((axis, i) => {
      const along = x.dot(axis);
      low[i] = Math.min(low[i], along);
      high[i] = Math.max(high[i], along);
    }));
    const middle = low.map((x, i) => (x + high[i]) / 2);
    const tangent = Math.tan(THREE.MathUtils.degToRad(this.camera.fov / 2));
    let far = 0;
    each((x) => {
      const across = Math.max((Math.abs(x.dot(right) - middle[0]) * pane.h) / pane.w, Math.abs(x.dot(above) - middle[1]));
      far = Math.max(far, x.dot(direction) + (margin * across) / tangent);
    });
    const depth = (this.whole || surface.bounds()).center.dot(direction);
    const center = new THREE.Vector3().addScaledVector(right, middle[0]).addScaledVector(above, middle[1]).addScaledVector(direction, depth);
    return { center, distance: Math.max(1e-3, far - depth) };
  }

  // Moves the camera along with a point of the surface, so that what is looked at stays in view.
  follow(point) {
    if (this.followed && point && !this.flight) {
      const way = new THREE.Vector3().subVectors(point, this.followed);
      this.camera.position.add(way);
      this.controls.target.add(way);
      this.controls.update();
    }
    this.followed = point ? point.clone() : null;
  }

  // Moves the camera so that a point is seen along a direction, from a distance.
  look(center, distance, direction, smooth) {
    const position = new THREE.Vector3().copy(direction).multiplyScalar(distance).add(center);
    if (!smooth || window.matchMedia("(prefers-reduced-motion: reduce)").matches) {
      this.flight = null;
      this.controls.target.copy(center);
      this.camera.position.copy(position);
      this.controls.update();
    } else {
      this.flight = {
        from: this.camera.position.clone(), to: position, fromTarget: this.controls.target.clone(), toTarget: center.clone(),
        begin: performance.now(), length: 550,
      };
    }
    this.requestDraw();
  }

  fly(now) {
    const { from, to, fromTarget, toTarget, begin, length } = this.flight;
    const t = Math.min(1, Math.max(0, (now - begin) / length)), s = easing(t);
    this.controls.target.lerpVectors(fromTarget, toTarget, s);
    // The direction turns and the distance changes, so that the camera does not pass through the surface.
    const a = new THREE.Vector3().subVectors(from, fromTarget), b = new THREE.Vector3().subVectors(to, toTarget);
    const turn = new THREE.Quaternion().setFromUnitVectors(a.clone().normalize(), b.clone().normalize());
    const part = new THREE.Quaternion().slerp(turn, s);
    const distance = Math.exp((1 - s) * Math.log(a.length()) + s * Math.log(b.length()));
    this.camera.position.copy(a.normalize().applyQuaternion(part).multiplyScalar(distance)).add(this.controls.target);
    if (t === 1) {
      this.flight = null;
      this.camera.position.copy(to);
    }
    this.controls.update();
  }

  // The direction from which the fewest triangles of the shown pose hide the points, of some all round. Directions near the
  // one in use, and those from a little above, come first where several are as good.
  clearestDirection(points, size) {
    const directions = this.directionsAllRound();
    const hidden = new Float64Array(directions.length);
    for (const point of points) addHidden(point, 0.006 * size, this.surface.positions, this.recording.corners, directions, hidden);
    const current = new THREE.Vector3().subVectors(this.camera.position, this.controls.target).normalize();
    let best = 0, least = Infinity;
    directions.forEach((d, i) => {
      let cost = 3 * hidden[i];  // and what hides it nearly
      directions.forEach((e, j) => { if (j !== i && d.dot(e) > 0.9) cost += 0.25 * Math.min(hidden[j], 2 * points.length); });
      cost = cost / points.length + 0.5 * Math.abs(d.dot(this.up) - 0.25) + 0.3 * (1 - d.dot(current));
      if (cost < least) {
        least = cost;
        best = i;
      }
    });
    return directions[best];
  }

  directionsAllRound() {
    const { up } = this, side = new THREE.Vector3(up.y, up.z, up.x), front = new THREE.Vector3().crossVectors(side, up);
    const directions = [];
    for (const elevation of [-0.9, -0.5, -0.15, 0.2, 0.55, 0.9, 1.3])
      for (let a = 0; a < 24; ++a) {
        const azimuth = (a * Math.PI) / 12, level = Math.cos(elevation);
        directions.push(new THREE.Vector3()
          .addScaledVector(side, level * Math.cos(azimuth)).addScaledVector(front, level * Math.sin(azimuth))
          .addScaledVector(up, Math.sin(elevation)));
      }
    return directions;
  }

  setBones(shown, frame, t) {
    this.bonesShown = shown && this.recording.clip.bones > 0;
    if (!this.bonesShown) return;
    const { bones, clip, toView } = this.recording, n = 6 * clip.bones;
    const segments = [], joints = [];
    for (let i = 0; i < n; ++i) {
      const a = bones[frame * n + i], b = bones[Math.min(frame + 1, clip.frames - 1) * n + i];
      segments.push(toView((1 - t) * a + t * b, i % 3));
    }
    for (let b = 0; b < clip.bones; ++b) joints.push(...segments.slice(6 * b, 6 * b + 3));
    setLines(this.skeleton, segments);
    setDots(this.joints, joints, new Array(clip.bones).fill(0.7));
  }
}

// Adds to `hidden`, for each direction, how many triangles a ray meets that begins `lift` away from the point in it.
function addHidden(point, lift, p, corners, directions, hidden) {
  for (let t = 0; t < corners.length; t += 3) {
    const i = 4 * corners[t], j = 4 * corners[t + 1], k = 4 * corners[t + 2];
    const ax = p[i] - point.x, ay = p[i + 1] - point.y, az = p[i + 2] - point.z;
    const bx = p[j] - point.x, by = p[j + 1] - point.y, bz = p[j + 2] - point.z;
    const cx = p[k] - point.x, cy = p[k + 1] - point.y, cz = p[k + 2] - point.z;
    const mx = (ax + bx + cx) / 3, my = (ay + by + cy) / 3, mz = (az + bz + cz) / 3;
    const far = mx * mx + my * my + mz * mz;
    const reach = Math.max((ax - mx) ** 2 + (ay - my) ** 2 + (az - mz) ** 2, (bx - mx) ** 2 + (by - my) ** 2 + (bz - mz) ** 2,
      (cx - mx) ** 2 + (cy - my) ** 2 + (cz - mz) ** 2);
    for (let n = 0; n < directions.length; ++n) {
      const d = directions[n], along = mx * d.x + my * d.y + mz * d.z;
      if (far - along * along > reach || along < -reach) continue;
      // The ray passes the triangle where it is on one side of all three planes through the point and an edge.
      const u = d.x * (by * cz - bz * cy) + d.y * (bz * cx - bx * cz) + d.z * (bx * cy - by * cx);
      const v = d.x * (cy * az - cz * ay) + d.y * (cz * ax - cx * az) + d.z * (cx * ay - cy * ax);
      const w = d.x * (ay * bz - az * by) + d.y * (az * bx - ax * bz) + d.z * (ax * by - ay * bx);
      if (!((u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0))) continue;
      const sum = u + v + w;
      const distance = ((u * ax + v * bx + w * cx) * d.x + (u * ay + v * by + w * cy) * d.y + (u * az + v * bz + w * cz) * d.z) / sum;
      if (distance > lift) ++hidden[n];
    }
  }
}
