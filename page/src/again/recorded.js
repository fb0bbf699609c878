// The surface of a recording (bench/query/view/engine_recording.h), as the library is asked about it: positions of all frames in double
// precision, and the names of its places.
import { Joints } from "../check/events.js";
import { Mesh } from "../check/mesh.js";
import { POINT, PreparedSurface } from "../check/prepared.js";

export class RecordedSurface extends PreparedSurface {
  constructor(header, { corners, place, part, place_number: numbers, rest, starts, ends }) {
    super();
    const { clip, engine, texts } = header, mesh = new Mesh(corners, clip.vertices);
    Object.assign(this, { header, mesh, rest, starts, ends, name: header.name, parent: engine.bone_parent });
    this.texts = texts.includes(POINT) ? texts : [...texts, POINT];
    this.size = rest.reduce((most, x) => Math.max(most, Math.abs(x)), 0);
    this.placeNumber = (t) => numbers[t];
    this.boneOf = (t) => numbers[t];  // parts have negative numbers
    this.placeOf = (t) => (t === undefined ? this.texts.indexOf(POINT) : place[t]);
    this.placeName = (t) => this.texts[this.placeOf(t)];
    this.partName = (t) => (t === undefined ? POINT : texts[part[t]]);
    this.boneName = () => null;
    this.joints = new Joints(mesh, rest, this.placeName, this.boneOf, this.parent);
    this.clip = { shown: clip, frames: engine.one_pose ? 1 : clip.frames };
  }

  row(all, i) { return all.subarray(3 * this.mesh.vertices * i, 3 * this.mesh.vertices * (i + 1)); }
  // The poses at both ends of an interval. A simulator's interval ends at a prediction, and not where the next one starts.
  startOf(clip, interval) { return this.row(this.starts, interval); }
  endOf(clip, interval) { return this.ends.length > 0 ? this.row(this.ends, interval) : this.row(this.starts, interval + 1); }

  keepsRest() { return !this.header.rest.left_out; }
  subjectOf() { return this.header.engine.subject; }
  notes() {
    const { rate } = this.header.engine;
    return [...(rate ? [rate] : []), "Answered in this page by cscd's library, from positions as exact as the program has them, every answer proven for straight lines between these frames"];
  }

  // Predicted ends of the intervals in which something is shown between its ends, as places on the grid: [intervals][3][vertices].
  otherEnds(contacts) {
    const { origin, step } = this.header.clip.grid, n = this.mesh.vertices, touching = this.ends.length === 0 ? [] : Array.from(contacts.keys()).filter((i) => contacts[i] > 0);
    const ends = new Uint16Array(3 * n * touching.length);
    touching.forEach((interval, row) => {
      const x = this.endOf(this.clip, interval);
      for (let v = 0; v < n; ++v) for (let k = 0; k < 3; ++k) ends[3 * n * row + k * n + v] = Math.round((x[3 * v + k] - origin[k]) / step);
    });
    return { ends, interval_of_end: Uint32Array.from(touching) };
  }
}
