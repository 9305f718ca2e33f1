// Five points, four triangles: center, radius and distances for each; without p4 there is a tie.

import { circles, dots, edges, fill, names, pairs } from "../layers.js";
import { circleAt, circleOf, counted, short } from "../geometry.js";

const NAMES = ["p0", "p1", "p2", "p3", "p4"];

export default {
  panels: [{ view: [-2.4, -4.3, 6.4, 5.3] }],
  ratio: 0.72,
  grid: 0.25,
  reset: "Back to the five points",
  step: "Triangle",
  names: NAMES,
  controls: [{ kind: "toggle", name: "four", label: "Delete p4", value: false }],

  states({ points, options, core }) {
    return options.four ? diagonals(points.slice(0, 8), core) : triangles(points, core);
  },
};

function triangles(points, core) {
  const found = core.delaunay(points);
  return Array.from({ length: found.length / 3 }, (_, t) => {
    const three = found.subarray(3 * t, 3 * t + 3);
    const circle = circleAt(points, found, t);
    const [x, y, radius] = circle;
    const others = [0, 1, 2, 3, 4].filter((row) => !three.includes(row));
    const far = others.map((row) => {
      const distance = Math.hypot(points[2 * row] - x, points[2 * row + 1] - y);
      return `${NAMES[row]} at ${short(distance, 3)}`;
    });
    const corners = Array.from(three, (row) => NAMES[row]).join(", ");
    return {
      layers: [[
        fill(points, three),
        edges(points, found),
        circles([circle], { width: 2, wash: 0.06 }),
        { kind: "dots", xy: Float64Array.of(x, y), color: "accent", radius: 3 },
        dots(points, null, { radius: 5 }),
        names(points, NAMES),
      ]],
      say:
        `${corners}: center (${short(x, 3)}, ${short(y, 3)}), radius ${short(radius, 3)}. ` +
        `From the center: ${far.join(", ")}. ${counted(found.length / 3, "triangle")}.`,
    };
  });
}

/** The four corners alone: one triangulation, or two if they are on one circle. */
function diagonals(points, core) {
  const found = core.delaunay(points);
  const shown = [found];
  const four = orderOf(found);
  const tie = four && core.inside(points, four[0], four[1], four[2], four[3]) === 0;
  if (tie) {
    const [a, b, c, d] = four;
    shown.push(Int32Array.of(a, b, d, b, c, d));
  }
  return shown.map((triangulation, i) => ({
    layers: [[
      fill(points, triangulation.subarray(0, 3)),
      edges(points, triangulation),
      ...(tie ? [pairs(points, i ? [four[1], four[3]] : [four[0], four[2]], { color: "accent", width: 2.5 })] : []),
      circles([circleOf(points, ...found.subarray(0, 3))], { width: 2, wash: 0.06 }),
      dots(points, null, { radius: 5 }),
      names(points, NAMES.slice(0, 4)),
    ]],
    say: tie
      ? `All four points are on one circle, and it is empty with either diagonal. ` +
        (i ? "This one is as valid." : "delone always takes this one.")
      : `The four points are not on one circle: ${counted(triangulation.length / 3, "triangle")}, one valid answer.`,
  }));
}

/** The corners of two triangles in order around them, the shared edge between first and third. */
function orderOf(triangles) {
  if (triangles.length !== 6) return null;
  const [first, second] = [triangles.subarray(0, 3), triangles.subarray(3)];
  const apex = first.findIndex((row) => !second.includes(row));
  const [b, c, a] = [0, 1, 2].map((k) => first[(apex + k) % 3]);
  return [a, b, c, second.find((row) => !first.includes(row))];
}
