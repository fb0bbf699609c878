// Continuous self-collision detection of a deforming triangle mesh, in WebAssembly.
//
// In a step every vertex moves in a straight line at constant speed, from its place in `start` (t = 0) to its
// place in `end` (t = 1). What touches is decided exactly, for the coordinates as they are given. The header of
// the C++ library, library/include/cscd/cscd.h, states each promise in full; its errors carry the same sentences
// here. A wrong value is a RangeError, a wrong type a TypeError, and a lack of memory an Error.
//
// Arrays are flat: three coordinates a vertex, three corners a triangle, counter-clockwise seen from outside.

/** Three coordinates a vertex, [3 * vertices]. Float32Array is read exactly; Float64Array is copied fastest. */
export type Positions = Float64Array | Float32Array | readonly number[];
/** Three corners a triangle, [3 * faces]. */
export type Faces = Uint32Array | Int32Array | Uint16Array | readonly number[];
/** Whole numbers of 32 bits. */
export type Integers = Int32Array | readonly number[];
/** Two numbers a pair. */
export type Pairs = Integers | readonly (readonly [number, number])[];

/** A surface that the mesh collides with. Its vertices and faces are numbered behind those of the mesh. */
export interface Obstacle {
  faces: Faces;
  positions: Positions;
}

/** What does not count as a collision. */
export interface Exclusions {
  /** One entry a vertex: vertices that never collide with each other. */
  rigid?: readonly boolean[] | Uint8Array;
  /** The group of each vertex, from 0. */
  group?: Integers;
  groupsThatIgnoreEachOther?: Pairs;
  vertexPairs?: Pairs;
  facePairs?: Pairs;
  /** Vertices joined by at most so many edges do not collide. */
  rings?: number;
  /** Nor do vertices that are nearer than this in the reference positions. */
  restDistance?: number;
  /** Leave out what lies within an overlap of the start. */
  ongoing?: boolean;
}

export interface Options {
  /** Whether positions are searched for numbers that are not finite; true. */
  checkPositions?: boolean;
  /** Whether answers say which faces cross at the start; true. */
  checkStart?: boolean;
  exclude?: Exclusions;
  obstacles?: readonly Obstacle[];
  /** What preparation() of another object has returned, for the same faces and reference positions. */
  preparation?: Uint8Array;
  /** The part that each vertex belongs to, such as the bone that it follows most. */
  labels?: Integers;
  /** How near features may come before they count as contacts, in the unit of the positions; 0. */
  thickness?: number;
  /** More thickness for each vertex, of the mesh and then of obstacles. */
  vertexThickness?: Positions;
}

/** Contacts by time. Row i of each array is that of contact i. */
export interface Answer {
  /** Nothing touches, and nothing crosses at the start. */
  free: boolean;
  /** The earliest time of contact, in [0, 1], or null. */
  time: number | null;
  /** Pairs of faces that cross at the start, [2 * pairs]. */
  startCrossings: Int32Array;
  /** How many contacts there are, and how many of them are there at the start already. */
  count: number;
  closeAtStart: number;
  /** 1 where two edges touch, 0 where a vertex touches a face. */
  edges: Uint8Array;
  /** The vertex and the corners of the face, or the ends of both edges, [4 * count]. */
  vertices: Int32Array;
  /** The face, or -1. */
  faces: Int32Array;
  times: Float64Array;
  /** Where, on the first feature, [3 * count]. */
  points: Float64Array;
  /** Unit vectors from the second feature towards the side from which the first came, [3 * count]. */
  normals: Float64Array;
  /** Weights of the face's corners; or the shares of the way along both edges, and 0; [3 * count]. */
  weights: Float64Array;
  /** Of the first feature away from the second, in lengths a step. */
  normalVelocities: Float64Array;
}

export interface Candidates {
  /** A vertex and a face, [2 * pairs]. */
  vertexFace: Int32Array;
  /** The ends of one edge and of another, [4 * pairs]. */
  edgeEdge: Int32Array;
}

/** A curve in which two sheets of the surface cross. */
export interface Curve {
  /** The faces of both sheets of each segment, [2 * segments]. */
  faces: Int32Array;
  /** The ends of the segments in order, [3 * points]. */
  points: Float64Array;
  closed: boolean;
}

/** What curves cut off one sheet. */
export interface Region {
  /** The curves that bound it, and whether it lies on their first or second sheet, [2 * curves]. */
  bounds: Int32Array;
  vertices: Int32Array;
  /** Of each vertex, the way to the nearest point of the skin that was gone through, [3 * vertices], and its length. */
  ways: Float64Array;
  distances: Float64Array;
  area: number;
  behind: boolean;
  otherIsOpen: boolean;
  depth: number;
  depthBound: number;
  /** The vertex with the largest distance, and its way. */
  deepest: number;
  out: Float64Array;
}

export interface Overlap {
  curves: Curve[];
  /** Deepest first. */
  regions: Region[];
  depth: number;
  depthBound: number;
  /** The length of the curves, and its gradient for `vertices`, [3 * vertices]. */
  length: number;
  vertices: Int32Array;
  gradient: Float64Array;
}

export interface Crossings {
  /** Deepest first. */
  overlaps: Overlap[];
  /** Pairs of faces that meet without passing through each other. */
  touching: number;
}

/** Vertices that do not move in straight lines. */
export interface Paths {
  /** Returns the positions at a time. */
  positions(time: number): Positions;
  /** Returns an upper bound of the acceleration between two times, for all vertices or for each. */
  acceleration(from: number, to: number): number | Positions;
  /** How far the positions may be from the paths, by rounding; 0. */
  positionError?: number;
}

export interface PathsAnswer {
  verdict: "clear" | "touches" | "close" | "intersects_at_start" | "undecided";
  /** The span of time that the verdict is about, [2]. */
  span: Float64Array;
  /** Of `close`: the largest distance of the two features. */
  within: number;
  /** Two faces that come together, or -1, [2]. */
  faces: Int32Array;
}

/**
 * Loads the engine, once; later calls wait for the first. `source` is where cscd.wasm lies, its bytes, or the
 * compiled module. Without it, cscd.wasm lies beside this module.
 */
export default function init(source?: string | URL | ArrayBuffer | ArrayBufferView | WebAssembly.Module): Promise<void>;

export class SelfCollision {
  /** Prepares a mesh. `reference` is a pose without crossings, such as the pose at rest. */
  constructor(faces: Faces, reference: Positions, options?: Options);
  /** Frees the memory of the engine that the object holds. Afterwards every other method throws. */
  dispose(): void;

  readonly vertexCount: number;
  readonly faceCount: number;
  /** Closed, manifold and consistently oriented. */
  readonly closed: boolean;

  /** Places an obstacle, counted from 0, where it rests in the steps from then on. */
  placeObstacle(obstacle: number, positions: Positions): void;
  /** Moves an obstacle in every step from then on. */
  moveObstacle(obstacle: number, start: Positions, end: Positions): void;

  /** Returns whether nothing touches and nothing crosses at the start. */
  isFree(start: Positions, end: Positions): boolean;
  /** Returns contacts of the earliest time, at least one where anything touches. */
  firstContact(start: Positions, end: Positions): Answer;
  allContacts(start: Positions, end: Positions): Answer;
  /** Returns 1 for a free step, otherwise `safety`, in (0, 1], times the earliest time; 0.9. */
  largestStep(start: Positions, end: Positions, safety?: number): number;
  /** Returns all pairs of features that come within `radius`, and some more. */
  candidates(start: Positions, end: Positions, radius: number): Candidates;
  /** Returns how far each vertex may move along any path, at most `cap`, so that nothing touches, [vertices]. */
  vertexBounds(positions: Positions, cap: number): Float64Array;
  /** Returns how the mesh crosses itself in a pose. */
  crossings(positions: Positions): Crossings;
  /** Answers for paths that are not straight. `resolution` 0 stands for a hundredth of the mean edge. */
  trueMotion(paths: Paths, from: number, to: number, resolution?: number): PathsAnswer;
  /** Returns what preparing has found out, for Options.preparation. */
  preparation(): Uint8Array;
}
