// The compiled core, in the terms in which figures ask: as StoredCore of stored.js, for any points.

import { load as loadCore } from "./core/delone.js";

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

  /** Sign of the in-circle determinant of four rows, exact. */
  inside(points, ...rows) {
    return this.core.incircle(...rows.flatMap((row) => [points[2 * row], points[2 * row + 1]]));
  }
}

/** Load the core that the site has beside its figures. */
export async function load() {
  return new LiveCore(await loadCore());
}
