// Names what is under the pointer: the place on the surface, and how deep it lies in another piece of it.
import * as THREE from "three";
import { lengthText, momentText } from "./words.js";

export class Pointer {
  // `label` is where the name is written; `shown` says which interval and which position, in frames, the stage shows. `signal` ends it.
  constructor(recording, stage, painter, label, shown, signal) {
    Object.assign(this, { recording, stage, painter, label, shown });
    this.event = null;  // the last one that is not answered yet
    const later = (event) => {
      if (event.buttons === 0 || event.type === "click") {
        if (!this.event) requestAnimationFrame(() => this.name());
        this.event = event;
      } else this.hide();
    };
    for (const type of ["pointermove", "click"]) stage.canvas.addEventListener(type, later, { signal });
    for (const type of ["pointerleave", "wheel"]) stage.canvas.addEventListener(type, () => this.hide(), { passive: true, signal });
  }

  hide() { this.label.textContent = ""; }

  name() {
    const { offsetX: x, offsetY: y } = this.event, { recording } = this;
    this.event = null;
    const pane = this.stage.panes.find((p) => x >= p.x && x < p.x + p.w && y >= p.y && y < p.y + p.h), triangle = pane ? this.triangleAt(pane, x, y) : -1;
    if (triangle < 0) return this.hide();
    const { interval, position } = this.shown(), depths = this.painter.depthsAt(interval);
    const deepest = Math.max(...[0, 1, 2].map((k) => depths.get(recording.corners[3 * triangle + k]) ?? 0));
    const parts = [recording.texts[recording.place[triangle]], deepest > 0 ? `${lengthText(recording, deepest)} deep` : "", momentText(recording, position)];
    this.label.textContent = parts.filter(Boolean).join(" · ");
    const left = Math.min(x + 14, this.stage.canvas.clientWidth - this.label.offsetWidth - 6);
    Object.assign(this.label.style, { left: `${left}px`, top: `${y + 16}px` });
  }

  // The number of the triangle that the surface shows there; -1 where it shows none.
  triangleAt(pane, x, y) {
    const { camera, surface } = this.stage, { corners } = this.recording, p = surface.positions;
    const ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2((2 * (x - pane.x)) / pane.w - 1, 1 - (2 * (y - pane.y)) / pane.h), camera);
    const { origin: o, direction: d } = ray.ray;
    let found = -1, nearest = Infinity;
    for (let i = 0; i < corners.length; i += 3) {
      const a = 4 * corners[i], b = 4 * corners[i + 1], c = 4 * corners[i + 2];
      const ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], uz = p[b + 2] - p[a + 2], vx = p[c] - p[a], vy = p[c + 1] - p[a + 1], vz = p[c + 2] - p[a + 2];
      const hx = d.y * vz - d.z * vy, hy = d.z * vx - d.x * vz, hz = d.x * vy - d.y * vx, det = ux * hx + uy * hy + uz * hz;
      if (det === 0) continue;
      const sx = o.x - p[a], sy = o.y - p[a + 1], sz = o.z - p[a + 2], s = (sx * hx + sy * hy + sz * hz) / det;
      if (s < 0 || s > 1) continue;
      const qx = sy * uz - sz * uy, qy = sz * ux - sx * uz, qz = sx * uy - sy * ux, t = (d.x * qx + d.y * qy + d.z * qz) / det;
      if (t < 0 || s + t > 1) continue;
      const far = (vx * qx + vy * qy + vz * qz) / det;
      if (far > 0 && far < nearest) [nearest, found] = [far, i / 3];
    }
    return found;
  }
}
