// What the figures of failure modes share: answers that may be errors, and how they are drawn.

import { dots, edges, edgesOf, fill, names } from "../layers.js";
import { NotStored } from "../stored.js";

export const LOW = [0, 0, 1000, 420];

/** A figure of the chapter: low, with numbered points that the reader may drag. */
export function failure(kind) {
  return { panels: [{ view: LOW }], ratio: 0.45, step: "Step", ...kind };
}

/** The triangles of points, or the error that the core raises for them. */
export function outcome(core, points) {
  try {
    return { triangles: core.delaunay(points), error: "" };
  } catch (error) {
    if (error instanceof NotStored) throw error;
    return { triangles: new Int32Array(), error: `${error.name}: ${error.message}.` };
  }
}

/** Points with one row a part of the way to a place, at whole numbers. */
export function part(points, row, to, share) {
  const moved = points.slice();
  for (const k of [0, 1]) {
    const from = points[2 * row + k];
    moved[2 * row + k] = Math.floor(from + (to[k] - from) * share + 0.5);
  }
  return moved;
}

/** The layers of points and their triangles. */
export function drawn(points, triangles, ...more) {
  const count = points.length / 2;
  // Numbers of more points would cover the picture of a phone.
  const all = count > 16 ? [] : Array.from({ length: count }, (_, row) => String(row));
  return [fill(points, triangles), edges(points, triangles), ...more, dots(points), names(points, all)];
}

/** A gray dot where a row is before a step moves it: there it is dragged. */
export function trace(points, row) {
  return dots(points, [row], { color: "muted", radius: 3 });
}

/** Edges, as coordinates, that the first triangles have and the second have not. */
export function onlyIn(points, first, second) {
  const [own, other] = [first, second].map((triangles) => edgesOf(points, triangles));
  const there = new Set();
  for (let i = 0; i < other.length; i += 4) {
    const [a, b, c, d] = other.slice(i, i + 4);
    there.add([a, b, c, d].join(" ")).add([c, d, a, b].join(" "));
  }
  const found = [];
  for (let i = 0; i < own.length; i += 4) {
    const edge = own.slice(i, i + 4);
    if (!there.has(edge.join(" "))) found.push(...edge);
  }
  return Float64Array.from(found);
}

/** Rows that have the coordinates of an earlier row: [row, earlier row]. */
export function repeats(points) {
  const first = new Map();
  const found = [];
  for (let row = 0; row < points.length / 2; row += 1) {
    const place = `${points[2 * row]} ${points[2 * row + 1]}`;
    if (first.has(place)) found.push([row, first.get(place)]);
    else first.set(place, row);
  }
  return found;
}
