// The compiled core, in the terms in which figures ask: as StoredCore of stored.js, for any points.

import { load as loadCore } from "./core/delone.js";
import { wrapSteps } from "./methods/wrap.js";

// Points that a refined mesh may add.
const MOST = 20_000;

// The steps of each method.
const METHODS = {
  "bowyer-watson": (core, points) => core.bowyerWatsonSteps(points).steps,
  incremental: (core, points) => core.incrementalSteps(points).steps,
  "divide-and-conquer": (core, points) => core.divideSteps(points).steps,
  sweep: (core, points) => core.sweepSteps(points).steps,
  lifting: wrapSteps,
};

class LiveCore {
  constructor(core) {
    this.live = true;
    this.core = core;
  }

  /** The triangles of flat coordinates, as flat rows. */
  delaunay(points) {
    return this.core.triangulate(Float64Array.from(points)).triangles;
  }

  /** Voronoi cells cut to a box: the corners of cell i are starts[i] to starts[i + 1]. */
  voronoi(points, box) {
    return this.core.voronoi(Float64Array.from(points), box);
  }

  /** The triangles with segments, flat pairs of rows, as edges. */
  constrain(points, segments) {
    return this.core.constrain(Float64Array.from(points), Int32Array.from(segments)).triangles;
  }

  /** The mesh of what segments enclose, without holes, whose angles are at least a bound. */
  refine(points, segments, holes, minAngle) {
    const [xy, ends] = [Float64Array.from(points), Int32Array.from(segments)];
    return this.core.mesh(xy, ends, { holes, minAngle, maxPoints: MOST });
  }

  /** Tetrahedra of points in 3-D, with their volumes and dihedral angles in degrees. */
  tetrahedra(points) {
    return this.core.tetrahedra(Float64Array.from(points));
  }

  /** The steps of a method, each with the triangles that it removes and adds. */
  method(name, points) {
    return METHODS[name](this.core, Float64Array.from(points));
  }

  /** A triangulation from left to right, and the flips to the Delaunay triangulation: four rows
   * u, v, p, q for each, where the edge u v becomes p q. */
  flips(points) {
    const xy = Float64Array.from(points);
    const start = this.core.scan(xy);
    return { start, sequence: this.core.flips(xy, start) };
  }

  /** Exact signs of a test, "orient2d" or "incircle", for lists of coordinates one after the other. */
  signs(test, exponent, coordinates) {
    return test === "incircle" ? this.core.incircles(coordinates) : this.core.orientations(coordinates);
  }

  /** Sign of the in-circle determinant of four rows, exact. */
  inside(points, ...rows) {
    return this.core.incircle(...rows.flatMap((row) => [points[2 * row], points[2 * row + 1]]));
  }
}

/** Load the core that the site has beside its figures. */
export async function load() {
  return new LiveCore(await loadCore());
}
