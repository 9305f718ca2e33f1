// The five methods on the same points: what each step removes and adds.

import { circles, dots, edges, fill, names, pairs } from "../layers.js";
import { circleOf, counted, short } from "../geometry.js";

const VIEW = [0, 0, 1000, 600];
// The beach line is drawn at so many heights.
const SAMPLES = 300;

export default {
  panels: [{ view: VIEW }],
  step: "Step",
  controls: [
    {
      kind: "choice", name: "method", label: "Method", value: "bowyer-watson",
      options: [
        ["bowyer-watson", "Bowyer-Watson"], ["incremental", "Insertion with flips"],
        ["divide-and-conquer", "Divide and conquer"], ["sweep", "Fortune's sweep"],
        ["lifting", "Lifting"],
      ],
    },
  ],
  first: (states) => Math.floor(states.length / 2),

  states({ points, options, core }) {
    const steps = core.method(options.method, points);
    const now = new Map();
    const start = "All methods start with the points alone, and end with the same triangles.";
    const states = [state(points, new Int32Array(), [], start, 0, steps.length)];
    steps.forEach((step, k) => {
      for (const triangle of triples(step.removed)) now.delete(keyOf(triangle));
      for (const triangle of triples(step.added)) now.set(keyOf(triangle), triangle);
      const triangles = Int32Array.from([...now.values()].flat());
      const { below = [], above = [], say } = PICTURES[step.kind](points, step);
      const last = k + 1 < steps.length ? "" : ` These are all ${counted(triangles.length / 3, "triangle")}.`;
      states.push(state(points, triangles, below, say + last, k + 1, steps.length, above));
    });
    return states;
  },
};

function triples(rows) {
  return Array.from({ length: rows.length / 3 }, (_, t) => Array.from(rows.slice(3 * t, 3 * t + 3)));
}

function keyOf(triangle) {
  return [...triangle].sort((u, v) => u - v).join();
}

function state(points, triangles, below, say, k, count, above = []) {
  const texts = Array.from({ length: points.length / 2 }, (_, row) => String(row));
  return {
    mark: `${k} / ${count}`,
    triangles,
    layers: [[
      ...below, edges(points, triangles), ...above, dots(points), names(points, texts, { color: "muted" }),
    ]],
    say,
  };
}

const GONE = { color: "bad", width: 1.2, dash: [5, 4] };
const ACCENT = { color: "accent", width: 2.5 };

/** What each kind of step shows below the triangles and above, and says. */
const PICTURES = {
  start(points, { added }) {
    return { below: [fill(points, added)], say: `The points ${Array.from(added).join(", ")} make a triangle.` };
  },

  insert(points, { removed, added, point }) {
    const [old, young] = [removed.length / 3, added.length / 3];
    const gone = old ? `${counted(old, "triangle")} (dashed) removed` : "no triangle removed";
    return {
      below: [fill(points, added), edges(points, removed, GONE)],
      above: [dots(points, [point], { color: "accent", radius: 8 })],
      say: `Point ${point} is inserted: ${gone}, ${young} added around it.`,
    };
  },

  flip(points, { added, before: [u, v], after: [p, q] }) {
    return {
      below: [
        fill(points, added), pairs(points, [u, v], GONE),
        circles([circleOf(points, u, v, p)], { color: "muted", width: 1 }),
      ],
      above: [pairs(points, [p, q], ACCENT), dots(points, [p], { color: "accent", radius: 8 })],
      say: `Point ${q} was in the circle of ${u}, ${v} and ${p}: the edge ${u}-${v} is flipped to ${p}-${q}.`,
    };
  },

  merge(points, { removed, added, left, right }) {
    const [l, r] = [counted(left.length, "point"), counted(right.length, "point")];
    return {
      below: [fill(points, added), edges(points, removed, GONE)],
      above: [
        dots(points, left, { color: "second", radius: 8 }),
        dots(points, right, { color: "third", radius: 8 }),
      ],
      say:
        `The left part (${l}, blue) and the right part (${r}, green) are merged: ` +
        `${counted(removed.length / 3, "triangle")} (dashed) removed, ${added.length / 3} added between them.`,
    };
  },

  event(points, { added, circle }) {
    const line = circle[0] + circle[2];
    const [, y0, , y1] = VIEW;
    return {
      below: [
        fill(points, added), circles([circle], { color: "accent", width: 1.3, dash: [6, 4] }),
        { kind: "path", xy: beach(points, line), color: "third", width: 2 },
      ],
      above: [
        { kind: "lines", segments: Float64Array.of(line, y0 - 50, line, y1 + 50), ...ACCENT },
        { kind: "dots", xy: Float64Array.of(line, circle[1]), color: "accent", radius: 5 },
      ],
      say:
        `The line (orange) reaches the end of the circle of ${Array.from(added).join(", ")}. Nothing else can be ` +
        `inside, so the triangle is final, and an arc of the beach line (green) vanishes.` +
        (line > VIEW[2] ? ` The line is at ${short(line, 0)}, right of the picture.` : ""),
    };
  },

  wrap(points, { added, before: [u, v], point }) {
    return {
      below: [fill(points, added), circles([circleOf(points, ...added)], { color: "accent", width: 1.3, wash: 0.05 })],
      above: [pairs(points, [u, v], ACCENT), dots(points, [point], { color: "accent", radius: 8 })],
      say:
        `At the edge ${u}-${v} (orange) a plane turns up from below until it touches the lifted point ${point}. ` +
        `It cuts the paraboloid above this circle, and all other lifted points are above it.`,
    };
  },
};

/** Where points and line are equally far away: the rightmost of the parabolas at each height. */
function beach(points, line) {
  const [, y0, , y1] = VIEW;
  const found = [];
  for (let i = 0; i <= SAMPLES; i += 1) {
    const y = y0 + ((y1 - y0) * i) / SAMPLES;
    let x = -1e4;
    for (let k = 0; k < points.length; k += 2) {
      const [px, dy] = [points[k], y - points[k + 1]];
      if (px < line) x = Math.max(x, (line * line - px * px - dy * dy) / (2 * (line - px)));
    }
    found.push(x, y);
  }
  return Float64Array.from(found);
}
