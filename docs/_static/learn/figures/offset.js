// A survey of a few meters with coordinates in the millions, in double and in single precision.

import { anglesOf, counted, short } from "../geometry.js";
import { drawn, failure, onlyIn, outcome, repeats } from "../methods/failures.js";

export default failure({
  panels: [{ view: [0, 0, 10, 4.2] }],
  grid: 0.01,
  first: () => 1,

  states({ points, core, stored }) {
    const { origin } = stored;
    const single = points.map((value, i) => Math.fround(origin[i % 2] + value) - origin[i % 2]);
    const shown = [
      [points, "Doubles hold the full coordinates to a billionth of a meter."],
      [single, "Single precision: its numbers are 3 cm apart to the east, and 50 cm to the north."],
      [points.map((value) => Math.fround(value)), "An origin nearby was subtracted first: single precision is enough."],
    ];
    const right = outcome(core, points).triangles;
    return shown.map(([xy, text]) => {
      const { triangles, error } = outcome(core, xy);
      const moves = [];
      for (let i = 0; i < xy.length; i += 2) moves.push(points[i], points[i + 1], xy[i], xy[i + 1]);
      const wrong = onlyIn(xy, triangles, right).length / 4;
      const same = repeats(xy).length;
      return {
        layers: [drawn(
          xy, triangles,
          { kind: "lines", segments: onlyIn(xy, triangles, right), color: "bad", width: 2.5 },
          { kind: "lines", segments: Float64Array.from(moves), color: "accent", width: 2 },
        )],
        say: error ||
          `${text} ${wrong ? `${counted(wrong, "wrong edge")} (red)` : "No wrong edge"}, ` +
          `${same ? counted(same, "duplicate") : "no duplicate"}, smallest angle ${short(anglesOf(xy, triangles)[0], 2)}°.`,
      };
    });
  },
});
