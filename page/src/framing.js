// Where the camera goes: round the whole surface, or close to what was chosen.
import * as THREE from "three";

export class Framing {
  constructor(recording, stage, marker) {
    this.recording = recording;
    this.stage = stage;
    this.marker = marker;
    this.anchor = null;  // the vertex that the camera follows, null for the middle of the surface, or "none" for a camera at rest
    this.opened = false;
  }

  follow() { this.stage.follow(this.anchorPoint()); }

  anchorPoint() {
    if (this.anchor === "none") return null;
    return this.anchor === null ? this.stage.whole.center : this.stage.surface.point(this.anchor, new THREE.Vector3());
  }

  setAnchor(vertex) {
    this.anchor = vertex;
    this.stage.follow(null);
    this.follow();
  }

  // Shows the shown pose, and follows it. `room` is how much larger than the surface the view is.
  showWhole(smooth, room) {
    this.setAnchor(null);
    const direction = this.broadSide(), { center, distance } = this.stage.fit(direction, room);
    this.stage.look(center, distance, direction, smooth);
  }

  // Shows the surface of all frames, with a camera that does not move.
  showAllTimes(smooth) {
    this.setAnchor("none");
    const direction = this.broadSide(), { center, distance } = this.stage.fit(direction, 1.02, undefined, this.eachCornerOfFrames());
    this.stage.look(center, distance, direction, smooth);
  }

  // Visits the corners of the box of every frame.
  eachCornerOfFrames() {
    const { frameBoxes, clip } = this.recording, point = new THREE.Vector3();
    return (take) => {
      for (let f = 0; f < clip.frames; ++f)
        for (let corner = 0; corner < 8; ++corner)
          take(point.fromArray([0, 1, 2].map((axis) => frameBoxes[6 * f + 2 * axis + ((corner >> axis) & 1)])));
    };
  }

  // Looks at a moment that has a place, from where least hides it.
  showMoment(strategy, moment, point, smooth) {
    const { stage, marker } = this, { contact, pair, interval, event } = moment;
    this.setAnchor(event ? this.nearestVertex(point) : contact !== undefined ? strategy.contact_vertex[4 * contact] : this.recording.corners[3 * (moment.truth ? moment.truth.pair[0] : strategy.crossing[2 * pair])]);
    const whole = stage.surface.bounds(), points = [point];
    let spread = 0;  // of what lies near the moment's point
    const take = (other) => {
      const distance = other.distanceTo(point);
      if (distance > 0.2 * whole.radius) return;
      spread = Math.max(spread, distance);
      if (points.length < 4 && distance > 0.002 * whole.radius) points.push(other);
    };
    const { contactOffset, crossingOffset } = strategy;
    for (let c = contactOffset[interval]; c < contactOffset[interval + 1]; ++c) take(marker.contactPoint(strategy, interval, c));
    for (let i = crossingOffset[interval]; i < crossingOffset[interval + 1]; ++i) take(marker.pointOf(strategy, { interval, pair: i }));
    // Close enough to see single triangles there, and far enough to see what they belong to.
    const radius = Math.min(0.36 * whole.radius, Math.max(0.11 * whole.radius, 1.6 * spread, 8 * this.edgeNear(point, 0.1 * whole.radius)));
    if (!this.opened) {
      stage.controls.target.copy(whole.center);
      stage.camera.position.copy(this.broadSide()).multiplyScalar(3).add(whole.center);
      this.opened = true;
    }
    stage.look(point, stage.distanceFor(radius), stage.clearestDirection(points, whole.radius), smooth);
  }

  nearestVertex(point) {
    const { surface } = this.stage, place = new THREE.Vector3();
    let nearest = 0, least = Infinity;
    for (let v = 0; v < this.recording.clip.vertices; ++v) {
      const distance = surface.point(v, place).distanceToSquared(point);
      if (distance < least) [nearest, least] = [v, distance];
    }
    return nearest;
  }

  // The mean length of the edges of triangles that have a corner near a point; 0 where none has.
  edgeNear(point, distance) {
    const { surface } = this.stage, { corners } = this.recording, a = new THREE.Vector3(), b = new THREE.Vector3();
    let sum = 0, count = 0;
    for (let i = 0; i < corners.length; i += 3) {
      if (surface.point(corners[i], a).distanceTo(point) > distance) continue;
      sum += a.distanceTo(surface.point(corners[i + 1], b));
      ++count;
    }
    return count > 0 ? sum / count : 0;
  }

  // A direction from which the shown pose looks wide: a little above and beside the level one across its longest direction.
  broadSide() {
    const { surface, up } = this.stage, side = new THREE.Vector3(up.y, up.z, up.x), front = new THREE.Vector3().crossVectors(side, up);
    let xx = 0, xy = 0, yy = 0;
    const center = surface.bounds().center, point = new THREE.Vector3();
    for (let v = 0; v < this.recording.clip.vertices; v += 3) {
      surface.point(v, point).sub(center);
      const x = point.dot(side), y = point.dot(front);
      xx += x * x;
      xy += x * y;
      yy += y * y;
    }
    const angle = 0.5 * Math.atan2(2 * xy, xx - yy) + Math.PI / 2;  // across the longest level direction
    const direction = new THREE.Vector3().addScaledVector(side, Math.cos(angle)).addScaledVector(front, Math.sin(angle));
    if (direction.dot(new THREE.Vector3(0.2, 0.1, 1)) < 0) direction.negate();
    return direction.applyAxisAngle(up, 0.4).addScaledVector(up, 0.28).normalize();
  }
}
