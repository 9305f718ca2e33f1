// A point moves onto another: thin triangles, then a duplicate.

import { anglesOf, counted, short } from "../geometry.js";
import { dots } from "../layers.js";
import { drawn, failure, outcome, part, repeats, trace } from "../methods/failures.js";

const [MOVED, TARGET] = [5, 2];

export default failure({
  states({ points, core, stored }) {
    const to = points.subarray(2 * TARGET, 2 * TARGET + 2);
    return stored.shares.map((share) => {
      const now = part(points, MOVED, to, share);
      const { triangles, error } = outcome(core, now);
      const same = repeats(now).map(([row, first]) => `row ${row} repeats row ${first}`);
      const size = `${counted(triangles.length / 3, "triangle")} of ${points.length / 2} rows`;
      return {
        layers: [drawn(now, triangles, trace(points, MOVED), dots(now, [MOVED], { color: "accent", radius: 8 }))],
        say: error || (same.length
          ? `${size}: ${same.join(", ")}, which delone reports in duplicate_of. No triangle uses the later row.`
          : `${size}. All are different, so each is a corner; the smallest angle is ${short(anglesOf(now, triangles)[0], 2)}°.`),
      };
    });
  },
});
