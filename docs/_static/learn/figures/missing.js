// Coordinates that are not numbers are an error; codes for missing values are numbers.

import { drawn, failure, outcome, trace } from "../methods/failures.js";
import { counted } from "../geometry.js";

const [FIRST, SECOND] = [3, 6];
const CODE = -9999;

export default failure({
  first: () => 1,

  states({ points, core }) {
    const put = (...changes) => {
      const changed = points.slice();
      for (const [i, value] of changes) changed[i] = value;
      return changed;
    };
    const without = points.filter((_, i) => i >> 1 !== FIRST);
    const shown = [
      [points, "All coordinates are numbers"],
      [put([2 * FIRST, NaN]), ""],
      [put([2 * FIRST, NaN], [2 * SECOND + 1, Infinity]), ""],
      [put([2 * FIRST, CODE]), `Row ${FIRST} has x = ${CODE}, a code for "no value". No program can know that it is not a place`],
      [without, `Row ${FIRST} is dropped before, so later rows have new numbers`],
    ];
    return shown.map(([xy, text]) => {
      const { triangles, error } = outcome(core, xy);
      const rows = [FIRST, SECOND].filter((row) => xy.length === points.length
        && [0, 1].some((k) => xy[2 * row + k] !== points[2 * row + k]));
      return {
        layers: [drawn(xy, triangles, ...rows.map((row) => trace(points, row)))],
        say: error || `${text}: ${counted(triangles.length / 3, "triangle")}.`,
      };
    });
  },
});
