// The large triangle of textbooks around the points: too small, it takes triangles of the hull away.

import { edges, fill } from "../layers.js";
import { drawn, failure, outcome } from "../methods/failures.js";
import { without } from "../methods/insertion.js";

export default failure({
  step: "Factor",
  first: () => 2,

  states({ points, core, stored }) {
    const right = outcome(core, points);
    const count = points.length / 2;
    return stored.factors.map((factor) => {
      const found = outcome(core, Float64Array.of(...points, ...around(points, factor))).triangles;
      const kept = [];
      for (let t = 0; t < found.length; t += 3) {
        const three = found.subarray(t, t + 3);
        if (three.every((row) => row < count)) kept.push(...three);
      }
      const triangles = Int32Array.from(kept);
      const lost = without(right.triangles, triangles);
      const [is, should] = [triangles.length / 3, right.triangles.length / 3];
      return {
        mark: String(factor),
        lost: lost.length / 3,
        layers: [drawn(
          points, triangles, fill(points, lost, { color: "bad", alpha: 0.5 }),
          edges(points, lost, { color: "bad", width: 2.5 }),
        )],
        say: right.error ||
          `The corners are ${factor === 1 ? "one width" : `${factor.toLocaleString("en-US")} widths`} away. ` +
          `There are ${is} triangles; 2n - h - 2 is ${should}. ` +
          (lost.length ? `${should - is} at the hull ${should - is === 1 ? "is" : "are"} lost (red).` : "None is lost."),
      };
    });
  },
});

/** The corners of the large triangle. */
function around(points, factor) {
  const [xs, ys] = [0, 1].map((k) => points.filter((_, i) => i % 2 === k));
  const [left, right, low, high] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  const [x, y] = [(left + right) / 2, (low + high) / 2];
  const far = Math.max(right - left, high - low) * factor;
  return [x - far, y - far, x + far, y - far, x, y + far];
}
