// Points that come to lie on one line: flatter triangles, then an error.

import { anglesOf, counted, short } from "../geometry.js";
import { dots } from "../layers.js";
import { drawn, failure, outcome, part, trace } from "../methods/failures.js";

const MOVED = 3;
const LEVEL = 160;

export default failure({
  states({ points, core, stored }) {
    const to = [points[2 * MOVED], LEVEL];
    const straight = points.every((value, i) => i % 2 === 0 || i === 2 * MOVED + 1 || value === LEVEL);
    return stored.shares.map((share) => {
      const now = part(points, MOVED, to, 1 - share);
      const { triangles, error } = outcome(core, now);
      const high = now[2 * MOVED + 1] - LEVEL;
      return {
        layers: [drawn(now, triangles, trace(points, MOVED), dots(now, [MOVED], { color: "accent", radius: 8 }))],
        say: error ||
          `${straight ? `Row ${MOVED} is ${high} above the line: ` : ""}${counted(triangles.length / 3, "triangle")}, ` +
          `smallest angle ${short(anglesOf(now, triangles)[0], 2)}°. Thin, but correct: the signs are exact.`,
      };
    });
  },
});
