// The inside of a polygon with holes, refined until no angle is below a bound.

import { dots, edges, fill, pairs } from "../layers.js";
import { anglesOf, counted, short } from "../geometry.js";

export default {
  panels: [{ view: [0, 0, 1000, 600] }],
  step: "Smallest angle",
  first: (states) => states.length - 3,

  states({ points, core, stored }) {
    const { segments, rings, bounds } = stored;
    const holes = rings.flatMap((ring) => middle(points, ring));
    return bounds.map((bound) => {
      const mesh = core.refine(points, segments, holes, bound);
      const { triangles } = mesh;
      const xy = Float64Array.from(mesh.points);
      const count = triangles.length / 3;
      const least = Array.from({ length: count }, (_, t) => anglesOf(xy, triangles.subarray(3 * t, 3 * t + 3))[0]);
      const worst = least.indexOf(Math.min(...least));
      const below = least.flatMap((angle, t) => (angle < bound - 1e-9 ? [...triangles.subarray(3 * t, 3 * t + 3)] : []));
      const added = xy.slice(points.length);
      return {
        mark: `${bound}°`,
        mesh,
        layers: [[
          fill(xy, triangles),
          fill(xy, triangles.subarray(3 * worst, 3 * worst + 3), { color: "other" }),
          fill(xy, below, { color: "bad", alpha: 0.45 }),
          edges(xy, triangles),
          pairs(xy, Array.from(mesh.subsegments), { color: "second", width: 2.5 }),
          { kind: "dots", xy: added, color: "accent", radius: 3 },
          dots(points, null, { radius: 5 }),
        ]],
        say:
          `${bound ? `Bound ${bound}°` : "No bound"}: ${counted(added.length / 2, "added point")}, ` +
          `${counted(xy.length / 2, "vertex").replace("vertexs", "vertices")} and ${counted(count, "triangle")}. ` +
          `The smallest angle is ${short(least[worst])}°` +
          (below.length ? `: in ${counted(below.length / 3, "triangle")} (red) a sharp or narrow place of the outline allows no better.` : " (orange)."),
      };
    });
  },
};

/** The middle of some rows, down to whole numbers: a place inside a hole. */
function middle(points, rows) {
  const mean = (k) => Math.floor(rows.reduce((sum, row) => sum + points[2 * row + k], 0) / rows.length);
  return [mean(0), mean(1)];
}
