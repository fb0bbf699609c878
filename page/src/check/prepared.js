// What both kinds of surfaces have in common that the library answers: that of a model file (surface.js) and that of a recording
// (again/recorded.js). Each has `mesh`, `rest` (the pose at rest) and the names of its places.
import { restDepths } from "./events.js";
import { RestCrossings, tellApart } from "./mesh.js";

const MOST_AT_REST = 500000;
export const POINT = "a point";  // a vertex of no face, for which no triangle stands

export class PreparedSurface {
  // Prepares the library for the surface, and finds what crosses at rest.
  prepare(SelfCollision) {
    const { mesh, rest } = this;
    this.body = new SelfCollision(mesh.corners, rest);
    const pairs = this.body.allContacts(rest, rest).startCrossings, met = [];
    for (let i = 0; i < pairs.length; i += 2) met.push(mesh.pair(pairs[i], pairs[i + 1]));
    if (met.length > MOST_AT_REST) throw new Error(`has ${met.length} pairs of triangles that cross at rest, too many to leave out; repair the surface`);
    const found = met.length > 0 ? this.body.crossings(rest) : { overlaps: [] };
    this.atRest = { met, depths: restDepths(mesh, found), rest: new RestCrossings(mesh, Array.from(tellApart(mesh, rest, met, found)), met) };
  }
}
