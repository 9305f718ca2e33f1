// The predicates as one writes them first, in the numbers of JavaScript, which are doubles; and
// Bowyer-Watson on them, with a vertex at infinity. Wrong signs are the point of it.

const INFINITE = -1;

/** Twice the signed area of a triangle, from the differences to its first point. */
export function orientRounded(ax, ay, bx, by, cx, cy) {
  return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
}

/** Positive for d inside the circle of a, b, c, from the differences to d. */
export function incircleRounded(ax, ay, bx, by, cx, cy, dx, dy) {
  const [adx, ady, bdx, bdy, cdx, cdy] = [ax - dx, ay - dy, bx - dx, by - dy, cx - dx, cy - dy];
  const [a2, b2, c2] = [adx * adx + ady * ady, bdx * bdx + bdy * bdy, cdx * cdx + cdy * cdy];
  return adx * (bdy * c2 - b2 * cdy) - ady * (bdx * c2 - b2 * cdx) + a2 * (bdx * cdy - bdy * cdx);
}

/** The triangles after the first three points, and after each further one, flat. */
export function roundedRun(points) {
  const at = (rows) => rows.flatMap((row) => [points[2 * row], points[2 * row + 1]]);
  const conflicts = (triangle, row) => {
    const k = triangle.indexOf(INFINITE);
    if (k < 0) return incircleRounded(...at([...triangle, row])) > 0;
    return orientRounded(...at([triangle[(k + 1) % 3], triangle[(k + 2) % 3], row])) > 0;
  };
  const [a, b, c] = orientRounded(...at([0, 1, 2])) < 0 ? [0, 2, 1] : [0, 1, 2];
  let triangles = [[a, b, c], [b, a, INFINITE], [c, b, INFINITE], [a, c, INFINITE]];
  const found = [triangles];
  for (let row = 3; row < points.length / 2; row += 1) {
    const bad = new Set(triangles.filter((triangle) => conflicts(triangle, row)));
    const edges = new Map();
    for (const [u, v, w] of bad) {
      for (const edge of [[u, v], [v, w], [w, u]]) edges.set(edge.join(), edge);
    }
    const around = [...edges.values()].filter(([u, v]) => !edges.has(`${v},${u}`));
    triangles = triangles.filter((triangle) => !bad.has(triangle));
    triangles.push(...around.map(([u, v]) => [u, v, row]));
    found.push(triangles);
  }
  return found.map((list) =>
    Int32Array.from(list.filter((triangle) => !triangle.includes(INFINITE)).flat()));
}
