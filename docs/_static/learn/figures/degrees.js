// A map at 60 degrees north, where a degree of longitude is half as long as one of latitude.

import { drawn, failure, onlyIn, outcome } from "../methods/failures.js";

export default failure({
  states({ points, core }) {
    const stretched = points.map((value, i) => (i % 2 ? value : 2 * value));
    const [meters, degrees] = [outcome(core, points), outcome(core, stretched)];
    const wrong = onlyIn(points, degrees.triangles, meters.triangles);
    const edge = wrong.length === 4 ? "edge" : "edges";
    const full = notEmpty(points, degrees.triangles, core);
    return [
      [degrees, `Longitude and latitude as x and y: ${wrong.length / 4} ${edge} (red) would not be there in meters, and on the ground ${full} of ${degrees.triangles.length / 3} circles are not empty.`],
      [meters, "Projected to meters first: all circles are empty on the ground."],
    ].map(([{ triangles, error }, text], i) => ({
      wrong: wrong.length / 4,
      layers: [drawn(points, triangles, { kind: "lines", segments: i ? new Float64Array() : wrong, color: "bad", width: 3 })],
      say: error || text,
    }));
  },
});

/** How many circles have a point inside. */
function notEmpty(points, triangles, core) {
  let count = 0;
  for (let t = 0; t < triangles.length; t += 3) {
    const three = triangles.subarray(t, t + 3);
    const rows = Array.from({ length: points.length / 2 }, (_, row) => row);
    count += rows.some((row) => !three.includes(row) && core.inside(points, ...three, row) > 0);
  }
  return count;
}
