// The algorithms step by step, for pages with a slider: a few hundred points, exact predicates.
//
// Each algorithm records which triangles a step removes and adds; the core decides all signs. The
// triangles of these algorithms are written as three rows from the smallest on.

const NONE = Object.freeze(new Int32Array());
/** The vertex at infinity: a ghost triangle lies beyond each edge of the hull. */
const GHOST = -1;

/** A triangle from its smallest row on, with the same orientation. */
function turned(a, b, c) {
  if (a < b && a < c) return [a, b, c];
  return b < c ? [b, c, a] : [c, a, b];
}

/** The numbers of all triangles of a list, as an array. */
const flat = (triangles) => Int32Array.from(triangles.flat());

/** Splits a flat array into triangles. */
const triples = (rows) =>
  Array.from({ length: rows.length / 3 }, (_, t) => turned(...rows.slice(3 * t, 3 * t + 3)));

function step(kind, removed, added, rest = {}) {
  return {
    kind,
    removed: flat(removed.map((t) => turned(...t))),
    added: flat(added.map((t) => turned(...t))),
    point: -1,
    before: null,
    after: null,
    cavity: NONE,
    left: NONE,
    right: NONE,
    circle: null,
    ...rest,
  };
}

/** Steps, with the triangles between them. */
class Steps {
  #now = 0;
  #alive = new Map();

  constructor(method, steps, start = []) {
    this.method = method;
    this.steps = steps;
    this.length = steps.length;
    for (const triangle of start) this.#alive.set(triangle.join(), triangle);
  }

  at(k) {
    if (!Number.isInteger(k) || k < 0 || k > this.length) {
      throw new RangeError(`there are the states 0 to ${this.length}, not ${k}`);
    }
    while (this.#now < k) {
      const { removed, added } = this.steps[this.#now++];
      this.#exchange(removed, added);
    }
    while (this.#now > k) {
      const { removed, added } = this.steps[--this.#now];
      this.#exchange(added, removed);
    }
    const order = (s, t) => s[0] - t[0] || s[1] - t[1] || s[2] - t[2];
    return flat([...this.#alive.values()].sort(order));
  }

  #exchange(old, young) {
    for (const triangle of triples(old)) this.#alive.delete(triangle.join());
    for (const triangle of triples(young)) this.#alive.set(triangle.join(), triangle);
  }
}

/** The predicates on rows of points. */
class Signs {
  constructor(core, points) {
    this.core = core;
    this.points = points;
  }

  at(...rows) {
    return rows.flatMap((row) => [this.points[2 * row], this.points[2 * row + 1]]);
  }

  orient(a, b, c) {
    return this.core.orient2d(...this.at(a, b, c));
  }

  /** Whether d lies in the circle, ties as in the triangulation. */
  inside(a, b, c, d) {
    return this.core.incircleCanonical(...this.at(a, b, c, d)) > 0;
  }

  /** For each row of three points, whether p is in their circle: one call for all. */
  insides(triangles, p) {
    return this.core.incirclesCanonical(this.gathered(triangles, p));
  }

  /** For each row of two points, on which side of them p is. */
  sides(edges, p) {
    return this.core.orientations(this.gathered(edges, p));
  }

  /** The coordinates of rows of points, each row followed by p. */
  gathered(lists, p) {
    const rows = lists.flatMap((list) => [...list, p]);
    return Float64Array.from({ length: 2 * rows.length }, (_, k) => {
      return this.points[2 * rows[k >> 1] + (k & 1)];
    });
  }

  /** Lexicographic order. */
  compare(a, b) {
    const [ax, ay, bx, by] = this.at(a, b);
    return ax - bx || ay - by || a - b;
  }

  same(a, b) {
    const [ax, ay, bx, by] = this.at(a, b);
    return ax === bx && ay === by;
  }

  /** Whether c, on the line through a and b, lies strictly between them. */
  between(a, b, c) {
    const [low, high] = this.compare(a, b) < 0 ? [a, b] : [b, a];
    return this.compare(low, c) < 0 && this.compare(c, high) < 0;
  }

  /** The rows of distinct points, each the first, in the order given. */
  distinct(order) {
    const count = this.points.length / 2;
    const first = new Map();
    const name = (row) => this.at(row).map((x) => x + 0).join();
    for (let row = 0; row < count; row++) {
      if (!first.has(name(row))) first.set(name(row), row);
    }
    const all = order ? Array.from(order) : Array.from({ length: count }, (_, row) => row);
    return [...new Set(all.map((row) => first.get(name(row))))];
  }
}

/** Triangles, ghosts included, by their directed edges. */
class Growing {
  constructor(signs) {
    this.signs = signs;
    this.apex = new Map();
  }

  add(a, b, c) {
    for (const [u, v, w] of [[a, b, c], [b, c, a], [c, a, b]]) this.apex.set(`${u},${v}`, w);
  }

  remove(a, b, c) {
    for (const [u, v] of [[a, b], [b, c], [c, a]]) this.apex.delete(`${u},${v}`);
  }

  across(u, v) {
    return this.apex.get(`${v},${u}`);
  }

  /** The ghosts whose outer half-plane or edge contains p. */
  seen(p) {
    const ghosts = [...this.triangles()].filter((triangle) => !isReal(triangle));
    // The ghost comes first, then its edge.
    const edges = ghosts.map(([, u, v]) => [u, v]);
    const sides = this.signs.sides(edges, p);
    const holds = (k) => sides[k] > 0 || (sides[k] === 0 && this.signs.between(...edges[k], p));
    return ghosts.filter((_, k) => holds(k));
  }

  /** All triangles, each once. */
  *triangles() {
    for (const [edge, w] of this.apex) {
      const [u, v] = edge.split(",").map(Number);
      if (u < v && u < w) yield [u, v, w];
    }
  }

  /** The triangles in conflict with p, and the edges around them. */
  cavity(p) {
    const real = [...this.triangles()].filter(isReal);
    const signs = this.signs.insides(real, p);
    const removed = [...real.filter((_, k) => signs[k] > 0), ...this.seen(p)];
    const inner = new Set(removed.map((t) => turned(...t).join()));
    const edges = [];
    for (const [a, b, c] of removed) {
      for (const [u, v] of [[a, b], [b, c], [c, a]]) {
        if (!inner.has(turned(v, u, this.across(u, v)).join())) edges.push([u, v]);
      }
    }
    return { removed, edges: chained(edges) };
  }
}

/** Edges one after the other around a cavity. */
function chained(edges) {
  const next = new Map(edges.map(([u, v]) => [u, v]));
  const chain = [];
  for (let u = edges[0][0]; chain.length < edges.length; u = next.get(u)) {
    chain.push([u, next.get(u)]);
  }
  return chain;
}

const isReal = (triangle) => !triangle.includes(GHOST);

/** The first three points that are not on one line, and the others in order. */
function begun(core, points, order) {
  const signs = new Signs(core, points);
  // Throws what a triangulation throws for these points.
  core.triangulate(points);
  const [a, b, ...rest] = signs.distinct(order);
  const third = rest.findIndex((c) => signs.orient(a, b, c) !== 0);
  if (third < 0) throw new RangeError("order names points of one line only");
  const [c] = rest.splice(third, 1);
  const first = signs.orient(a, b, c) > 0 ? [a, b, c] : [a, c, b];
  const mesh = new Growing(signs);
  mesh.add(...first);
  for (const [u, v] of [[0, 1], [1, 2], [2, 0]]) mesh.add(first[v], first[u], GHOST);
  return { signs, mesh, first, rest };
}

/** Insertion: the triangles whose circle contains the point are replaced by a star around it. */
export function bowyerWatsonSteps(core, points, order) {
  const { mesh, first, rest } = begun(core, points, order);
  const steps = [step("start", [], [first])];
  for (const p of rest) {
    const { removed, edges } = mesh.cavity(p);
    removed.forEach((triangle) => mesh.remove(...triangle));
    const added = edges.map(([u, v]) => [u, v, p]);
    added.forEach((triangle) => mesh.add(...triangle));
    const real = edges.filter((edge) => !edge.includes(GHOST));
    steps.push(
      step("insert", removed.filter(isReal), added.filter(isReal), {
        point: p,
        cavity: flat(real),
      }),
    );
  }
  return new Steps("bowyer-watson", steps);
}

/** Insertion into the triangle, on the edge or beyond the hull; then flips around the point. */
export function incrementalSteps(core, points, order) {
  const { signs, mesh, first, rest } = begun(core, points, order);
  const steps = [step("start", [], [first])];
  for (const p of rest) {
    const removed = holding(mesh, p);
    const edges = outline(mesh, removed);
    removed.forEach((triangle) => mesh.remove(...triangle));
    const added = edges.map(([u, v]) => [u, v, p]);
    added.forEach((triangle) => mesh.add(...triangle));
    const real = edges.filter((edge) => !edge.includes(GHOST));
    steps.push(
      step("insert", removed.filter(isReal), added.filter(isReal), {
        point: p,
        cavity: flat(real),
      }),
    );
    const waiting = real.slice();
    while (waiting.length) {
      const [u, v] = waiting.pop();
      if (mesh.apex.get(`${u},${v}`) !== p) continue;
      const q = mesh.across(u, v);
      if (q === GHOST || !signs.inside(u, v, p, q)) continue;
      const [old, young] = [[[u, v, p], [v, u, q]], [[p, u, q], [q, v, p]]];
      old.forEach((triangle) => mesh.remove(...triangle));
      young.forEach((triangle) => mesh.add(...triangle));
      steps.push(step("flip", old, young, { point: p, before: [u, v], after: [p, q] }));
      waiting.push([u, q], [q, v]);
    }
  }
  return new Steps("incremental", steps);
}

/** The triangle that contains p, both at an edge that does, or the ghosts that see it. */
function holding(mesh, p) {
  const real = [...mesh.triangles()].filter(isReal);
  const edges = real.flatMap(([a, b, c]) => [[a, b], [b, c], [c, a]]);
  const sides = mesh.signs.sides(edges, p);
  const found = real.findIndex((_, t) => sides.subarray(3 * t, 3 * t + 3).every((s) => s >= 0));
  if (found < 0) return mesh.seen(p);
  const on = sides.indexOf(0, 3 * found);
  if (on < 0 || on >= 3 * found + 3) return [real[found]];
  const [u, v] = edges[on];
  return [real[found], [v, u, mesh.across(u, v)]];
}

/** The edges around some triangles. */
function outline(mesh, triangles) {
  const inner = new Set(triangles.map((t) => turned(...t).join()));
  const edges = triangles.flatMap(([a, b, c]) => [[a, b], [b, c], [c, a]]);
  return edges.filter(([u, v]) => !inner.has(turned(v, u, mesh.across(u, v)).join()));
}

/** The triangles of a scan from left to right: each point is joined to the edges it sees. */
export function scan(core, points) {
  const signs = new Signs(core, points);
  core.triangulate(points);
  const rows = signs.distinct().sort((a, b) => signs.compare(a, b));
  const bend = rows.findIndex((_, k) => k > 1 && signs.orient(rows[0], rows[1], rows[k]) !== 0);
  const line = rows.slice(0, bend);
  const apex = rows[bend];
  const left = signs.orient(line[0], line[1], apex) > 0;
  const found = line.slice(1).map((v, k) => (left ? [line[k], v, apex] : [v, line[k], apex]));
  let hull = left ? [...line, apex] : [...line.toReversed(), apex];
  for (const p of rows.slice(bend + 1)) {
    const sees = hull.map((u, k) => signs.orient(u, hull[(k + 1) % hull.length], p) < 0);
    const n = hull.length;
    const start = sees.findIndex((seen, k) => seen && !sees[(k + n - 1) % n]);
    const kept = [hull[start], p];
    let k = start;
    for (; sees[k]; k = (k + 1) % n) found.push([hull[(k + 1) % n], hull[k], p]);
    for (; k !== start; k = (k + 1) % n) kept.push(hull[k]);
    hull = kept;
  }
  return flat(found);
}

/** Flips of the core, from the given triangles or those of a scan. */
export function lawsonSteps(core, points, triangles) {
  const start = triangles ? Int32Array.from(triangles) : scan(core, points);
  const sequence = core.flips(points, start);
  const steps = [];
  for (let k = 0; k < sequence.length; k += 4) {
    const [u, v, p, q] = sequence.subarray(k, k + 4);
    const [old, young] = [[[u, v, p], [v, u, q]], [[p, u, q], [q, v, p]]];
    steps.push(step("flip", old, young, { before: [u, v], after: [p, q] }));
  }
  return new Steps("lawson", steps, triples(start));
}

/** Halves in lexicographic order are triangulated and merged. */
export function divideSteps(core, points) {
  const signs = new Signs(core, points);
  core.triangulate(points);
  const rows = signs.distinct().sort((a, b) => signs.compare(a, b));
  const steps = [];
  const solve = (part) => {
    if (part.length < 4) {
      const made = triangulated(core, signs, part);
      if (made.length) steps.push(step("start", [], made));
      return made;
    }
    const half = part.length >> 1;
    const [left, right] = [part.slice(0, half), part.slice(half)];
    const before = [...solve(left), ...solve(right)];
    const after = triangulated(core, signs, part);
    const [old, young] = [before, after].map((list) => new Set(list.map((t) => t.join())));
    const removed = before.filter((t) => !young.has(t.join()));
    const added = after.filter((t) => !old.has(t.join()));
    const halves = { left: Int32Array.from(left), right: Int32Array.from(right) };
    steps.push(step("merge", removed, added, halves));
    return after;
  };
  solve(rows);
  return new Steps("divide-and-conquer", steps);
}

/** The triangles of some rows; none if they are on one line. */
function triangulated(core, signs, rows) {
  if (rows.every((row, k) => k < 2 || signs.orient(rows[0], rows[1], row) === 0)) return [];
  const { triangles } = core.triangulate(Float64Array.from(signs.at(...rows)));
  return triples(triangles.map((v) => rows[v]));
}

/** Fortune's sweep finds a triangle when its line leaves the circle, whose right end is thus the
 * order; rounding may exchange ends that nearly coincide, which changes no triangle. */
export function sweepSteps(core, points) {
  const { triangles } = core.triangulate(points);
  const { centers, radii } = core.circumcircles(points, triangles);
  const events = triples(triangles).map((triangle, t) => ({
    triangle,
    circle: [centers[2 * t], centers[2 * t + 1], radii[t]],
    end: centers[2 * t] + radii[t],
  }));
  events.sort((s, t) => s.end - t.end || s.circle[1] - t.circle[1] || 0);
  const steps = events.map(({ triangle, circle }) => step("event", [], [triangle], { circle }));
  return new Steps("sweep", steps);
}
