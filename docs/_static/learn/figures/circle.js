// Each triangle with its circle, one per step; points can be dragged.

import { circles, dots, edges, fill } from "../layers.js";
import { anglesOf, circleAt, counted, short, triangleAt } from "../geometry.js";

export default {
  panels: [{ view: [0, 0, 1000, 600] }],
  step: "Triangle",
  controls: [{ kind: "toggle", name: "all", label: "All circles", value: false }],
  first: (states) => Math.floor(states.length / 2),

  states({ points, options, core }) {
    const triangles = core.delaunay(points);
    const count = triangles.length / 3;
    const [least] = anglesOf(points, triangles);
    const every = Array.from({ length: count }, (_, t) => circleAt(points, triangles, t));
    const sum = `${counted(count, "triangle")}, smallest angle ${short(least)}°.`;
    return every.map((circle, t) => {
      const three = triangles.subarray(3 * t, 3 * t + 3);
      return {
        triangle: t,
        triangles,
        layers: [[
          fill(points, three),
          ...(options.all ? [circles(every, { color: "muted", width: 0.8 })] : []),
          edges(points, triangles),
          circles([circle], { width: 2, wash: 0.08 }),
          dots(points),
          dots(points, three, { color: "accent", radius: 6 }),
        ]],
        say: `The circle of triangle ${t + 1} contains no points. ${sum}`,
      };
    });
  },

  click(figure, [x, y]) {
    const found = triangleAt(figure.points, figure.state.triangles, x, y);
    if (found >= 0) figure.show(found);
  },
};
