// What exercises ask of figures: each check returns "" if the figure is as asked for, else what is
// missing. Triangles come from the core, so that what is checked is what the package computes.

import { cornersOf, short } from "../geometry.js";

export const CHECKS = {
  flatTriangle({ points, core }) {
    const angles = cornersOf(points, core.delaunay(points));
    const largest = Math.max(...angles);
    return largest > 179 ? "" : `The largest angle is ${short(largest)}°.`;
  },

  twoNeighbors({ points, core, stored, options }) {
    if (options.four) return 'p4 is deleted: clear "Delete p4".';
    if (points.slice(0, 8).some((x, k) => x !== stored.points.flat()[k])) {
      return 'A corner has moved: "Back to the five points" brings it back.';
    }
    const around = neighborsOf(core.delaunay(points), 4);
    const names = [...around].sort().map((row) => `p${row}`).join(", ");
    return around.size === 2 ? "" : `The neighbors of p4 are ${names}.`;
  },

  bothLegal({ states }) {
    if (states.length < 2) return "Only one diagonal is possible: make the quadrilateral convex.";
    return states.every((state) => state.legal) ? "" : "One of the diagonals is illegal.";
  },

  eightNeighbors({ points, core }) {
    const triangles = core.delaunay(points);
    const rows = Array.from({ length: points.length / 2 }, (_, row) => row);
    const most = Math.max(
      ...rows.filter((row) => isInside(triangles, row)).map((row) => neighborsOf(triangles, row).size),
    );
    return most >= 8 ? "" : `The most neighbors that a point inside the hull has are ${most}.`;
  },

  fourEdges({ points, core, options, stored }) {
    const segments = options.segments ?? stored.segments;
    const before = edgesOf(core.delaunay(points));
    const after = edgesOf(core.constrain(points, segments));
    const gone = [...before].filter((edge) => !after.has(edge)).length;
    // One of the figure's own segments does not count.
    const own = stored.segments.join();
    if (segments.slice(0, stored.segments.length).join() === own && segments.length) {
      return 'Press "Remove all" first: the segment is to be yours.';
    }
    if (segments.length !== 2) return `There are ${segments.length / 2} segments; draw one.`;
    return gone >= 4 ? "" : `The segment removes ${gone} edge${gone === 1 ? "" : "s"}.`;
  },
};

function edgesOf(triangles) {
  const found = new Set();
  for (let t = 0; t < triangles.length; t += 3) {
    for (let k = 0; k < 3; k += 1) {
      const [u, v] = [triangles[t + k], triangles[t + ((k + 1) % 3)]];
      found.add(`${Math.min(u, v)} ${Math.max(u, v)}`);
    }
  }
  return found;
}

function neighborsOf(triangles, row) {
  const found = new Set();
  for (let t = 0; t < triangles.length; t += 3) {
    const three = triangles.slice(t, t + 3);
    if (three.includes(row)) three.forEach((v) => v !== row && found.add(v));
  }
  return found;
}

/** Whether triangles surround a vertex: as many as it has neighbors. */
function isInside(triangles, row) {
  let around = 0;
  for (let k = 0; k < triangles.length; k += 1) around += triangles[k] === row;
  return around === neighborsOf(triangles, row).size;
}
