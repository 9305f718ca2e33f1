// The lower hull of the points lifted to the paraboloid, wrapped facet by facet from its border.
// The orientation of four lifted points is the in-circle test, so no height is ever computed.

/** The steps, as those of the core for the other methods. */
export function wrapSteps(core, points) {
  const at = (rows) => rows.flatMap((row) => [points[2 * row], points[2 * row + 1]]);
  const orient = (...rows) => core.orient2d(...at(rows));
  const inside = (...rows) => core.incircleCanonical(...at(rows)) > 0;
  const before = (v, w) => points[2 * v] - points[2 * w] || points[2 * v + 1] - points[2 * w + 1];
  // Throws what a triangulation throws for these points.
  core.triangulate(points);
  const rows = Array.from({ length: points.length / 2 }, (_, row) => row)
    .filter((row, _, all) => all.findIndex((other) => before(row, other) === 0) === row);
  const first = rows.reduce((u, w) => (before(w, u) < 0 ? w : u));
  const second = rows.filter((w) => w !== first).reduce((v, w) => {
    const side = orient(first, v, w);
    return side < 0 || (side === 0 && before(w, v) < 0) ? w : v;
  });
  const [waiting, done, steps] = [[[first, second]], new Set(), []];
  while (waiting.length) {
    const [u, v] = waiting.shift();
    const left = rows.filter((w) => w !== u && w !== v && orient(u, v, w) > 0);
    if (done.has(`${u},${v}`) || !left.length) continue;
    const w = left.reduce((apex, other) => (inside(u, v, apex, other) ? other : apex));
    for (const edge of [[u, v], [v, w], [w, u]]) done.add(edge.join());
    waiting.push([w, v], [u, w]);
    steps.push({ kind: "wrap", removed: [], added: [u, v, w], before: [u, v], point: w });
  }
  return steps;
}
