// The answers that the site stores for its figures: what the compiled core would say, for the
// points that a figure starts with. Python writes them when the site is built.

/** Asked for something that is not stored: the figure then keeps its last picture. */
export class NotStored extends Error {}

/** The name under which an answer is stored; extensions/live_steps.py makes the same. */
export function keyOf(name, ...parts) {
  return [name, ...parts.map((part) => Array.from(part).join(" "))].join(":");
}

/** Answers as the core does, for stored questions only. */
export class StoredCore {
  constructor(stored) {
    this.live = false;
    this.answers = stored.answers;
  }

  ask(name, ...parts) {
    const found = this.answers[keyOf(name, ...parts)];
    if (found === undefined) throw new NotStored();
    if (found.error) throw Object.assign(new Error(found.error), { name: found.name });
    return found;
  }

  delaunay(points) {
    return Int32Array.from(this.ask("delaunay", points));
  }

  voronoi(points, box) {
    return this.ask("voronoi", points, box);
  }

  constrain(points, segments) {
    return Int32Array.from(this.ask("constrain", points, segments).triangles);
  }

  refine(points, segments, holes, minAngle) {
    const found = this.ask("refine", points, segments, holes, [minAngle]);
    return { ...found, triangles: Int32Array.from(found.triangles) };
  }

  tetrahedra(points) {
    return this.ask("tetrahedra", points);
  }

  method(name, points) {
    return this.ask("method", [name], points);
  }

  flips(points) {
    const { start, sequence } = this.ask("flips", points);
    return { start: Int32Array.from(start), sequence: Int32Array.from(sequence) };
  }

  /** Signs of a test for the cells whose distance has an exponent. */
  signs(test, exponent) {
    return Int8Array.from(this.ask("signs", [test], [exponent]), (digit) => Number(digit) - 1);
  }

  /** Sign of the in-circle determinant of four rows. Stored points are integers below 2000: the
   * determinant is then exact in doubles. */
  inside(points, a, b, c, d) {
    const [dx, dy] = [points[2 * d], points[2 * d + 1]];
    const [ax, ay, bx, by, cx, cy] = [a, b, c].flatMap((row) => [
      points[2 * row] - dx,
      points[2 * row + 1] - dy,
    ]);
    return Math.sign(
      (ax * ax + ay * ay) * (bx * cy - by * cx) +
        (bx * bx + by * by) * (cx * ay - cy * ax) +
        (cx * cx + cy * cy) * (ax * by - ay * bx),
    );
  }
}
