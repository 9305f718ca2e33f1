/**
 * The core of delone in the browser: exact and canonical, the same triangles as in Python.
 *
 * Points are flat arrays of coordinates: `[x0, y0, x1, y1, ...]`. Triangles are flat arrays of rows
 * of points, counter-clockwise, three for each triangle; `neighbors[3 * t + k]` is the triangle
 * across the edge opposite corner k of triangle t, or -1 outside. Every call throws a `DeloneError`
 * whose `name` and `message` are those of the Python exception.
 */

/** Loads the compiled core; by default `delone_web_bg.wasm` beside this module. */
export function load(source?: string | URL | BufferSource): Promise<Core>;

/** What a call throws: `name` is that of the Python class, for example "NonFiniteError". */
export class DeloneError extends Error {
  /** "DegenerateInputError", "NonFiniteError", "CrossingSegmentsError", "BudgetExceededError",
   * "ShapeError", "InputError", "LimitError", "HandleError", "MemoryError", "InternalError". */
  name: string;
  /** Rows: of bad points, of the points of a degenerate set along its line, or of the segments that
   * cross, two for each pair. */
  rows: Int32Array;
}

export type Method =
  | "auto"
  | "bowyer-watson"
  | "divide-and-conquer"
  | "incremental"
  | "sweep"
  | "lifting";

/** A flat array of coordinates; an array of numbers is copied into a Float64Array. */
export type Coordinates = Float64Array | readonly number[];
/** A flat array of rows. */
export type Rows = Int32Array | readonly number[];
export type Sign = -1 | 0 | 1;

export interface Triangulation {
  triangles: Int32Array;
  neighbors: Int32Array;
  /** Rows of the convex hull, counter-clockwise, from the lexicographically smallest point. Points
   * on its edges are left out. */
  hull: Int32Array;
  /** Pairs: a row, and the first row of the same coordinates. */
  duplicates: Int32Array;
}

/** Triangles over `points`: those given, then those added. */
export interface Mesh {
  points: Float64Array;
  triangles: Int32Array;
  neighbors: Int32Array;
  /** 1 where the edge opposite a corner is part of a segment. */
  constrained: Uint8Array;
  /** The edges that segments have become, two rows each. */
  subsegments: Int32Array;
  duplicates: Int32Array;
  /** How many points were added at crossings, or by refinement. */
  added: number;
  /** False if refinement reached `maxPoints`. */
  complete: boolean;
}

export interface ConstrainOptions {
  /** "error" (default): crossing segments throw; "split": their crossing becomes a vertex. */
  crossing?: "error" | "split";
  /** Splits segments until all triangles are Delaunay. */
  conforming?: boolean;
  /** Keeps only what the segments enclose. The default is false for `constrain`, true for `mesh`. */
  enclosed?: boolean;
  /** A point in each hole. */
  holes?: Coordinates;
  /** A limit on added points; 100,000 by default. */
  maxPoints?: number;
}

export interface MeshOptions extends ConstrainOptions {
  /** The smallest angle wanted, in degrees; 0 by default. */
  minAngle?: number;
  /** The largest area wanted; none by default. */
  maxArea?: number;
}

export interface Circles {
  /** x and y for each triangle; infinite where the center is beyond the range of doubles. */
  centers: Float64Array;
  radii: Float64Array;
}

/** Convex cells in the order of the points. */
export interface Cells {
  /** The corners of cell i are `starts[i]` to `starts[i + 1]`; none for a duplicate. */
  starts: Int32Array;
  /** x and y of each corner, counter-clockwise. */
  corners: Float64Array;
  /** The point across the edge that starts at each corner, or -1 along the box. */
  across: Int32Array;
  /** The area of each cell. */
  areas: Float64Array;
}

export interface Location {
  /** The triangle that contains each query, or -1 outside. */
  triangle: Int32Array;
  /** Barycentric weights of its corners, three for each query; NaN outside. */
  weights: Float64Array;
  /** The row of the nearest point. */
  nearest: Int32Array;
}

export interface Statistics {
  points: number;
  triangles: number;
  /** Points that repeat earlier ones. */
  duplicates: number;
  /** The area of each triangle. */
  areas: Float64Array;
  /** The smallest angle of each triangle, in degrees. */
  angles: Float64Array;
  area: number;
  minArea: number;
  maxArea: number;
  minAngle: number;
  medianAngle: number;
}

export interface Tetrahedra {
  /** Four rows each, positively oriented. */
  tetrahedra: Int32Array;
  neighbors: Int32Array;
  /** Faces of the convex hull, three rows each, counter-clockwise seen from outside. */
  hull: Int32Array;
  duplicates: Int32Array;
  volumes: Float64Array;
  /** The smallest and the largest dihedral angle of each, in degrees. */
  minDihedral: Float64Array;
  maxDihedral: Float64Array;
}

/** One step of an algorithm. All arrays are flat; absent parts are empty arrays or null. */
export interface Step {
  /** What happens: "start", "insert", "flip", "merge", "event". */
  kind: "start" | "insert" | "flip" | "merge" | "event";
  /** Triangles that the step removes and adds, three rows each, from the smallest row on. */
  removed: Int32Array;
  added: Int32Array;
  /** The point that is inserted, or whose event it is; -1 without one. */
  point: number;
  /** For "flip": the edge that goes, and the edge that comes. */
  before: [number, number] | null;
  after: [number, number] | null;
  /** For "insert": boundary edges of the cavity, two rows each, counter-clockwise. */
  cavity: Int32Array;
  /** For "merge": the rows of both halves. For collinear halves there are only these. */
  left: Int32Array;
  right: Int32Array;
  /** For "event": center x, center y and radius of the circle; the sweep line, x = center + radius,
   * reaches its right end at the step. */
  circle: [number, number, number] | null;
}

/** Steps of an algorithm, and the triangles between them. */
export interface Steps {
  method: "bowyer-watson" | "lawson" | "incremental" | "divide-and-conquer" | "sweep";
  steps: Step[];
  /** steps.length: there are the states 0 (nothing, or the given triangles) to `length`. */
  length: number;
  /** The triangles after the first k steps, sorted; the last state is the triangulation. Moves from
   * the last state asked for, forward or backward. */
  at(k: number): Int32Array;
}

/** Triangles by rows of points, the smallest first, that an edit takes and makes. */
export interface Changes {
  gone: Int32Array;
  added: Int32Array;
}

/** A triangulation that is edited in place, in microseconds for each point. After any edits it is
 * what `triangulate` makes of the points. Points on one line have no triangles, and no error. An
 * edit that throws changes nothing. */
export interface LiveTriangulation {
  /** Moves the point of a row. */
  move(row: number, x: number, y: number): Changes;
  /** Adds points, whose rows are the next numbers. */
  insert(xy: Coordinates): Changes;
  /** Removes the points of these rows; the numbers are not used again. */
  remove(rows: Rows): Changes;
  /** The rows that are there, and their points and triangles. Triangles and duplicates name points
   * by their position in `rows` and `points`. */
  state(): {
    rows: Int32Array;
    points: Float64Array;
    triangles: Int32Array;
    neighbors: Int32Array;
    duplicates: Int32Array;
  };
  /** Gives the memory back. */
  free(): void;
}

export interface Core {
  readonly version: string;
  readonly methods: readonly Method[];

  triangulate(xy: Coordinates, options?: { method?: Method }): Triangulation;
  /** Segments are pairs of rows. */
  constrain(xy: Coordinates, segments: Rows, options?: ConstrainOptions): Mesh;
  /** A constrained triangulation, refined. */
  mesh(xy: Coordinates, segments: Rows, options?: MeshOptions): Mesh;

  /** A triangulation to edit, for example while a point is dragged. */
  live(xy: Coordinates): LiveTriangulation;

  hull(xy: Coordinates): Int32Array;
  circumcircles(xy: Coordinates, triangles: Rows): Circles;
  /** Cells of the points, clipped to the box `[left, bottom, right, top]`. */
  voronoi(xy: Coordinates, box: readonly [number, number, number, number]): Cells;
  locate(xy: Coordinates, triangulation: Triangulation | Mesh, queries: Coordinates): Location;
  statistics(xy: Coordinates, triangulation: Triangulation | Mesh): Statistics;

  /** Signs: positive where c lies left of the line from a to b. */
  orient2d(ax: number, ay: number, bx: number, by: number, cx: number, cy: number): Sign;
  /** Positive where d lies in the circle through a, b, c, which are counter-clockwise. */
  incircle(
    ax: number, ay: number, bx: number, by: number,
    cx: number, cy: number, dx: number, dy: number,
  ): Sign;
  /** The same formulas in plain floating point: sometimes wrong. */
  orient2dNaive: Core["orient2d"];
  incircleNaive: Core["incircle"];
  /** Many at once: six or eight coordinates for each sign. */
  orientations(coordinates: Coordinates, options?: { naive?: boolean }): Int8Array;
  incircles(coordinates: Coordinates, options?: { naive?: boolean }): Int8Array;
  /** Never 0 for four distinct points: ties as in all triangulations here. */
  incircleCanonical: Core["incircle"];
  incirclesCanonical(coordinates: Coordinates): Int8Array;

  /** Steps of insertion with cavities, in the order of the rows, or in `order`. */
  bowyerWatsonSteps(xy: Coordinates, options?: { order?: Rows }): Steps;
  /** Steps of insertion with flips; each inserts a point or flips one edge. */
  incrementalSteps(xy: Coordinates, options?: { order?: Rows }): Steps;
  /** Flips from the given triangles; without them, from those of a scan from left to right. */
  lawsonSteps(xy: Coordinates, triangles?: Rows): Steps;
  /** Merges of halves, the smallest first; halves are cut at vertical lines. */
  divideSteps(xy: Coordinates): Steps;
  /** The triangles in the order in which Fortune's sweep, from left to right, finds them. */
  sweepSteps(xy: Coordinates): Steps;
  /** The flips alone: four rows u, v, p, q for each, where the edge u v became p q. */
  flips(xy: Coordinates, triangles: Rows): Int32Array;
  /** The triangles of a scan from left to right: not Delaunay, the start of flips. */
  scan(xy: Coordinates): Int32Array;

  /** The 3-D Delaunay triangulation of `[x0, y0, z0, x1, ...]`. */
  tetrahedra(xyz: Coordinates): Tetrahedra;
}
