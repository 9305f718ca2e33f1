// A grid: each square is a tie, and has two valid diagonals.

import { counted } from "../geometry.js";
import { drawn, failure, onlyIn, outcome } from "../methods/failures.js";

export default failure({
  grid: 5,

  states({ points, core }) {
    const { triangles, error } = outcome(core, points);
    const ties = tiesOf(points, triangles, core);
    const reversed = reverse(points, core);
    const shown = [
      [triangles, "delone draws this diagonal in each square, by a rule about coordinates."],
      [reversed, "The rows in the opposite order: the same diagonals."],
      [flipped(triangles, ties, (_, i) => i % 2 === 0), "Every second diagonal the other way, as another library may return it: as valid."],
      [flipped(triangles, ties, () => true), "All diagonals the other way: as valid."],
    ];
    const many = 2 ** ties.length;
    const count = ties.length
      ? `${counted(ties.length, "tie")}, so ${many.toLocaleString("en-US")} valid triangulations. `
      : "No tie: one valid triangulation. ";
    return shown.map(([list, text]) => {
      const changed = onlyIn(points, list, triangles);
      return {
        ties: ties.length,
        layers: [drawn(points, list, { kind: "lines", segments: changed, color: "accent", width: 2.5 })],
        say: error || count + (ties.length || list === triangles ? text : ""),
      };
    });
  },
});

/** Pairs of triangles with all four corners on one circle, each triangle in one pair at most. */
function tiesOf(points, triangles, core) {
  const sides = new Map();
  const used = new Set();
  const found = [];
  for (let t = 0; t < triangles.length; t += 3) {
    for (let k = 0; k < 3; k += 1) {
      const [u, v, p] = [0, 1, 2].map((j) => triangles[t + ((k + j) % 3)]);
      sides.set(`${u} ${v}`, [t, p]);
      const [other, q] = sides.get(`${v} ${u}`) ?? [];
      if (other === undefined || used.has(t) || used.has(other)) continue;
      if (core.inside(points, u, v, p, q) !== 0) continue;
      used.add(t).add(other);
      found.push({ t, other, u, v, p, q });
    }
  }
  return found;
}

/** The triangles with the other diagonal in some ties. */
function flipped(triangles, ties, chosen) {
  const list = triangles.slice();
  ties.filter(chosen).forEach(({ t, other, u, v, p, q }) => {
    list.set([p, u, q], t);
    list.set([q, v, p], other);
  });
  return list;
}

/** The triangles that the core returns for the rows in the opposite order. */
function reverse(points, core) {
  const count = points.length / 2;
  const turned = points.map((_, i) => points[2 * (count - 1 - Math.floor(i / 2)) + (i % 2)]);
  return outcome(core, turned).triangles.map((row) => count - 1 - row);
}
