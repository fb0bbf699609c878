// Marks in the scene: points, features and normals of contacts, lines where triangles cross, and observers.
import * as THREE from "three";
import { coverOf } from "./painter.js";

const MOST_NORMALS = 40;  // beside that of the chosen contact
const DENSE = 60;  // above so many contacts, their triangles show an area, and features are not outlined
const OBSERVER = "#20303c";  // an observer's colour where the surface is not coloured by its cluster

export class Marker {
  constructor(recording, stage, painter) {
    this.recording = recording;
    this.stage = stage;
    this.painter = painter;
  }

  // The point of a contact, on its first feature at its own time, whatever moment is shown.
  contactPoint(strategy, interval, c) {
    const { surface } = this.stage, t = strategy.contact_time[c] / 65535;
    const at = (v) => surface.pointAt(v, interval, t, true);
    const v = strategy.contact_vertex.subarray(4 * c, 4 * c + 2);
    return strategy.contact_kind[c] === 0 ? at(v[0]) : at(v[0]).lerp(at(v[1]), strategy.contact_along[c] / 65535);
  }

  // The place of a moment (moments.js), or null where there is none.
  pointOf(strategy, moment) {
    if (!moment) return null;
    if (moment.event) return new THREE.Vector3(...moment.event.point.map((x, axis) => this.recording.toView(x, axis)));
    if (moment.contact !== undefined) return this.contactPoint(strategy, moment.interval, moment.contact);
    if (moment.pair === undefined && !moment.truth) return null;
    const triangles = moment.truth ? moment.truth.pair : strategy.crossing.subarray(2 * moment.pair, 2 * moment.pair + 2);
    const { corners } = this.recording, sum = new THREE.Vector3(), point = new THREE.Vector3();
    for (const t of triangles)
      for (let k = 0; k < 3; ++k) sum.add(this.stage.surface.point(corners[3 * t + k], point));
    return sum.divideScalar(6);
  }

  // Marks what strategy number `index` says of an interval; `chosen` is the chosen moment of it, or null. Where colours show
  // depths, contacts would hide the curves.
  mark(marks, index, interval, chosen, normals, mode) {
    const strategy = this.recording.strategies[index], { surface } = this.stage;
    const from = strategy.contactOffset[interval], to = mode === "depth" ? from : strategy.contactOffset[interval + 1];
    const place = new THREE.Vector3();
    const edge = (out, a, b) => {
      surface.point(a, place).toArray(out, out.length);
      surface.point(b, place).toArray(out, out.length);
    };
    const feature = (out, c, second) => {
      const v = strategy.contact_vertex.subarray(4 * c, 4 * c + 4);
      if (strategy.contact_kind[c] === 1) edge(out, ...(second ? [v[2], v[3]] : [v[0], v[1]]));
      else if (second) for (const [a, b] of [[1, 2], [2, 3], [3, 1]]) edge(out, v[a], v[b]);
    };
    const points = [], weights = [], others = [], first = [], second = [], normal = [], at = [], way = this.wayOut(chosen);
    const addNormal = (c, share) => {
      const p = this.contactPoint(strategy, interval, c), n = strategy.contact_normal.subarray(3 * c, 3 * c + 3);
      const length = (share * this.stage.whole.radius) / 127;
      normal.push(p.x, p.y, p.z, p.x + length * n[0], p.y + length * n[1], p.z + length * n[2]);
    };
    for (let c = from; c < to; ++c) {
      this.contactPoint(strategy, interval, c).toArray(points, points.length);
      weights.push(c === from ? 0.6 : to - from > DENSE ? 0.15 : 0.3);
      if (to - from <= DENSE && !(chosen && chosen.contact === c)) {
        feature(others, c, false);
        feature(others, c, true);
      }
    }
    if (chosen && chosen.contact !== undefined) {
      feature(first, chosen.contact, false);
      feature(second, chosen.contact, true);
      this.contactPoint(strategy, interval, chosen.contact).toArray(at, 0);
      if (normals) addNormal(chosen.contact, 0.05);
    }
    if (normals) for (let c = from; c < to; c += Math.ceil((to - from) / MOST_NORMALS)) addNormal(c, 0.02);
    marks.setContacts(points, weights);
    marks.setChosen(at);
    const isChosen = (event) => Boolean(chosen && chosen.event && chosen.event.number === event);
    // Lines of other events are faint beside those of a chosen one.
    const crossings = this.curves(interval, (event) => !isChosen(event)), crossingGlow = this.curves(interval, (event) => !chosen?.event || isChosen(event));
    marks.crossings.material.opacity = chosen?.event ? 0.45 : 1;
    first.push(...this.curves(interval, isChosen));
    for (const [name, numbers] of Object.entries({ others, first, second, normals: normal, crossings, crossingGlow, way, wayGlow: way })) marks.setLines(name, numbers);
  }

  // An arrow from the deepest point of a chosen event to the nearest place outside; empty where none is known.
  wayOut(chosen) {
    if (!chosen?.event?.out) return [];
    const from = this.pointOf(null, chosen), to = new THREE.Vector3(...chosen.event.point.map((x, axis) => this.recording.toView(x + chosen.event.out[axis], axis)));
    const along = to.clone().sub(from), length = along.length(), segments = [...from.toArray(), ...to.toArray()];
    const aside = new THREE.Vector3().crossVectors(along, Math.abs(along.x) < 0.5 * length ? new THREE.Vector3(1, 0, 0) : new THREE.Vector3(0, 1, 0)).setLength(0.15 * length);
    const back = from.clone().lerp(to, 0.7), across = new THREE.Vector3().crossVectors(along, aside).setLength(0.15 * length);
    for (const step of [aside, across]) for (const sign of [-1, 1]) segments.push(...to.toArray(), ...back.clone().addScaledVector(step, sign).toArray());
    return segments;
  }

  // The segments of the curves in which the surface crosses itself at the start of an interval, of the events that are wanted.
  curves(interval, isWanted) {
    const { curveOffset, curveEvent, pointOffset, curveEdge, curveShare } = this.recording, { surface } = this.stage, segments = [];
    const from = new THREE.Vector3(), to = new THREE.Vector3();
    for (let c = curveOffset[interval]; c < curveOffset[interval + 1]; ++c) {
      if (!isWanted(curveEvent[c])) continue;
      for (let i = pointOffset[c]; i < pointOffset[c + 1]; ++i) {
        surface.point(curveEdge[2 * i], from).lerp(surface.point(curveEdge[2 * i + 1], to), curveShare[i] / 65535);
        from.toArray(segments, segments.length);
        // Each point but the ends belongs to two segments.
        if (i > pointOffset[c] && i + 1 < pointOffset[c + 1]) from.toArray(segments, segments.length);
      }
    }
    return segments;
  }

  // Draws the observers of the cover that the colours are about, at the share t of an interval.
  markObservers(marks, index, mode, interval, t, shown) {
    const strategy = this.recording.strategies[index], points = [], pointColours = [], segments = [], segmentColours = [];
    const cover = strategy.covers > coverOf(mode) ? coverOf(mode) : 0;
    if (shown && strategy.observers?.[cover]) {
      const { offset, cluster, place } = strategy.observers[cover], colourOf = this.painter.observerColour(index, mode, interval);
      const colour = new THREE.Color();
      for (let o = offset[interval]; o < offset[interval + 1]; ++o) {
        const at = (end) => [0, 1, 2].map((axis) => this.recording.observerToView((1 - t) * place[12 * o + 6 * end + axis] + t * place[12 * o + 6 * end + 3 + axis], axis));
        const head = at(0), tail = at(1), long = Math.hypot(...head.map((x, axis) => x - tail[axis])) > 1e-6;
        colour.set(colourOf ? colourOf(cluster[o]) : OBSERVER);
        for (const end of long ? [head, tail] : [head]) {
          points.push(...end);
          pointColours.push(colour.r, colour.g, colour.b);
        }
        if (!long) continue;
        segments.push(...head, ...tail);
        for (let k = 0; k < 2; ++k) segmentColours.push(colour.r, colour.g, colour.b);
      }
    }
    marks.setObservers(points, pointColours, segments, segmentColours);
  }
}
