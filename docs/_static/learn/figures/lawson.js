// Lawson's flips, one per step, beside the angles of all triangles in ascending order.

import { circles, dots, edges, fill, names, pairs } from "../layers.js";
import { anglesOf, circleOf, counted, short } from "../geometry.js";

const VIEW = [0, 0, 600, 600];
// The bars fill a box of the second panel; the highest angle is at its top.
const [LEFT, BOTTOM, WIDTH, HEIGHT] = [55, 20, 530, 540];
const STRAIGHT = 180;

export default {
  panels: [{ view: VIEW, title: "Triangles" }, { view: VIEW, title: "All angles, sorted" }],
  ratio: 1,
  step: "Flip",
  first: () => 0,

  states({ points, core }) {
    const { start, sequence } = core.flips(points);
    const flips = Array.from({ length: sequence.length / 4 }, (_, k) =>
      sequence.subarray(4 * k, 4 * k + 4));
    const list = [start];
    for (const flip of flips) list.push(flipped(list.at(-1), flip));
    const angles = list.map((triangles) => anglesOf(points, triangles));
    return list.map((triangles, k) => ({
      mark: `${k} / ${flips.length}`,
      triangles,
      angles: Array.from(angles[k]),
      layers: [drawing(points, triangles, flips[k - 1], flips[k]), bars(angles[k], angles[k - 1])],
      say: sentence(angles, flips, k),
    }));
  },
};

/** The triangles after a flip, in the same rows. */
function flipped(triangles, [u, v, p, q]) {
  const found = Int32Array.from(triangles);
  const [first, second] = [[u, v, p], [v, u, q]].map((corners) => {
    for (let t = 0; t < found.length; t += 3) {
      if (corners.every((row) => found.subarray(t, t + 3).includes(row))) return t;
    }
    throw new Error("the flip is not in the triangulation");
  });
  found.set([p, u, q], first);
  found.set([q, v, p], second);
  return found;
}

/** The triangulation; the edge that comes is drawn over the one that goes. */
function drawing(points, triangles, last, next) {
  const layers = [edges(points, triangles)];
  if (last) {
    const [u, v, p, q] = last;
    layers.unshift(fill(points, [p, u, q, q, v, p]));
    layers.push(pairs(points, [p, q], { color: "second", width: 3 }));
  }
  if (next) {
    const [u, v, p, q] = next;
    layers.push(
      circles([circleOf(points, u, v, p)], { color: "accent", width: 1.2, wash: 0.04 }),
      pairs(points, [u, v], { color: "accent", width: 3 }),
      pairs(points, [p, q], { color: "accent", width: 1.5, dash: [5, 5] }),
      dots(points, [q], { color: "accent", radius: 7 }),
    );
  }
  const texts = Array.from({ length: points.length / 2 }, (_, row) => String(row));
  return [...layers, dots(points), names(points, texts, { color: "muted" })];
}

/** The first angle of the sorted list that differs, -1 if none does. */
function firstChange(now, before) {
  return now.findIndex((angle, i) => Math.abs(angle - before[i]) > 1e-9);
}

function bars(angles, before) {
  const wide = WIDTH / angles.length;
  const y = (angle) => BOTTOM + (HEIGHT * angle) / STRAIGHT;
  const box = (i) => [LEFT + wide * (i + 0.12), LEFT + wide * (i + 0.88)];
  const corners = (rows) => Float64Array.from(rows.flatMap((i) => {
    const [x0, x1] = box(i);
    const top = y(angles[i]);
    return [x0, BOTTOM, x1, BOTTOM, x1, top, x0, BOTTOM, x1, top, x0, top];
  }));
  const rows = Array.from(angles, (_, i) => i);
  const first = before ? firstChange(angles, before) : -1;
  const ticks = [0, 60, 120, 180];
  const scale = ticks.flatMap((angle) => [LEFT, y(angle), LEFT + WIDTH, y(angle)]);
  const layers = [
    { kind: "lines", segments: Float64Array.from(scale), color: "muted", width: 0.5 },
    names(ticks.flatMap((angle) => [LEFT, y(angle)]), ticks.map((angle) => `${angle}°`), { dx: -6, dy: 0, align: "right", color: "muted", size: 12 }),
    { kind: "fill", corners: corners(rows), color: "second", alpha: 0.55 },
  ];
  if (first >= 0) layers.push({ kind: "fill", corners: corners([first]), color: "accent" });
  if (before) {
    const tops = rows.flatMap((i) => [box(i)[0], y(before[i]), box(i)[1], y(before[i])]);
    layers.push({ kind: "lines", segments: Float64Array.from(tops), color: "text", width: 1.5 });
  }
  return layers;
}

function sentence(angles, flips, k) {
  const rest = flips.length - k;
  const least = `smallest angle ${short(angles[k][0])}°`;
  const next = rest
    ? `Next: ${flips[k][0]}-${flips[k][1]} is illegal, as point ${flips[k][3]} is in the circle.`
    : "No edge is illegal: the triangulation is Delaunay.";
  if (!k) return `${counted(angles[0].length / 3, "triangle")} from left to right, ${least}. ${next}`;
  const [u, v, p, q] = flips[k - 1];
  const first = firstChange(angles[k], angles[k - 1]);
  const change = first < 0
    ? "a tie, no angle has changed"
    : `the first angle that differs, number ${first + 1}, went from ${short(angles[k - 1][first])}° to ${short(angles[k][first])}°`;
  return `${u}-${v} became ${p}-${q}: ${change}; ${least}. ${next}`;
}
