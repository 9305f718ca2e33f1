// Four points and two diagonals: the circle, and the six angles with each.

import { circles, dots, edges, fill, names, pairs } from "../layers.js";
import { circleAt, cornersOf, short, turn } from "../geometry.js";

const NAMES = ["a", "b", "c", "d"];
const DIAGONALS = [
  { triangles: Int32Array.of(0, 1, 2, 0, 2, 3), edge: [0, 2], other: [1, 3] },
  { triangles: Int32Array.of(0, 1, 3, 1, 2, 3), edge: [1, 3], other: [2, 0] },
];
// Where the number of an angle stands: so far from its corner.
const INSIDE = 95;

export default {
  panels: [{ view: [0, 0, 820, 680] }],
  ratio: 0.75,
  step: "Diagonal",
  names: NAMES,
  free: true,
  first: () => 0,

  states({ points, core }) {
    const possible = DIAGONALS.filter(({ triangles }) => turns(points, triangles));
    if (!possible.length) {
      throw new Error("a, b, c and d must go around counter-clockwise, no three of them on one line");
    }
    return possible.map((diagonal) => state(points, diagonal, core, possible.length));
  },
};

/** Whether both triangles are counter-clockwise. Points are small integers: the sign is exact. */
function turns(points, triangles) {
  return [0, 3].every((t) => turn(points, ...triangles.subarray(t, t + 3)) > 0);
}

function state(points, { triangles, edge, other }, core, count) {
  const angles = cornersOf(points, triangles);
  const least = angles.indexOf(Math.min(...angles));
  const all = Array.from(angles, (_, k) => k);
  const rest = all.filter((k) => k !== least);
  // The opposite corner in the circle of the first triangle.
  const [row] = [0, 1, 2, 3].filter((r) => !triangles.subarray(0, 3).includes(r));
  const inside = core.inside(points, ...triangles.subarray(0, 3), row);
  const legal = inside <= 0;
  const named = edge.map((r) => NAMES[r]).join("");
  const where = ["outside", "on", "inside"][inside + 1];
  return {
    legal,
    angles: Array.from(angles),
    layers: [[
      fill(points, triangles),
      circles([circleAt(points, triangles, 0)], { color: "second", width: 1.5, wash: 0.05 }),
      edges(points, triangles),
      pairs(points, edge, { color: legal ? "third" : "bad", width: 3.5 }),
      dots(points, null, { radius: 6 }),
      dots(points, [row], { color: legal ? "third" : "bad", radius: 8 }),
      numbers(points, triangles, angles, rest, "text"),
      numbers(points, triangles, angles, [least], "accent"),
      names(points, NAMES, { dx: 10, dy: -14, size: 16 }),
    ]],
    say:
      `The point ${NAMES[row]} is ${where} the circle of the other triangle: the edge ${named} is ` +
      `${legal ? "legal" : "illegal"}. The smallest of the six angles is ${short(angles[least])}°. ` +
      (count > 1 ? "" : `There is nothing to flip: ${other.map((r) => NAMES[r]).join("")} is not inside the quadrilateral.`),
  };
}

/** Some angles as numbers inside their corners. */
function numbers(points, triangles, angles, which, color) {
  const xy = which.flatMap((k) => {
    const t = k - (k % 3);
    const [x, y] = [0, 1].map((axis) => points[2 * triangles[k] + axis]);
    const middle = [0, 1].map((axis) =>
      [0, 1, 2].reduce((sum, j) => sum + points[2 * triangles[t + j] + axis], 0) / 3);
    const far = Math.hypot(middle[0] - x, middle[1] - y);
    const share = Math.min(1, INSIDE / far);
    return [x + share * (middle[0] - x), y + share * (middle[1] - y)];
  });
  const texts = which.map((k) => `${short(angles[k], 0)}°`);
  return names(xy, texts, { color, dx: 0, dy: 0, align: "center", size: color === "accent" ? 15 : 12 });
}
