// Cells and triangles of the same points; each part of one has a partner in the other.

import { circles, dots, edges, fill, names, pairs } from "../layers.js";
import { circleAt, counted, triangleAt, turn } from "../geometry.js";

const VIEW = [0, 0, 1000, 600];
const FAR = 4000;

export default {
  panels: [{ view: VIEW }],
  step: "Number",
  controls: [
    {
      kind: "choice", name: "pair", label: "Show", value: "point",
      options: [["point", "a point and its cell"], ["edge", "an edge and its ridge"], ["triangle", "a triangle and its vertex"]],
    },
  ],
  first: (states) => Math.floor(states.length / 2),

  states({ points, options, core }) {
    const triangles = core.delaunay(points);
    const { starts, corners } = core.voronoi(points, VIEW);
    const rings = Array.from({ length: points.length / 2 }, (_, row) =>
      Float64Array.from(corners.slice(2 * starts[row], 2 * starts[row + 1])),
    );
    const drawn = { points, triangles, rings };
    return MAKERS[options.pair](drawn).map(({ below = [], above = [], at, say }) => ({
      triangles,
      at,
      layers: [[
        ...below,
        edges(points, triangles, { color: "muted", width: 1.1 }),
        outlines(rings),
        ...above,
        dots(points),
        names(points, rings.map((_, row) => String(row)), { color: "muted" }),
      ]],
      say,
    }));
  },

  click(figure, [x, y]) {
    if (figure.options.pair === "triangle") {
      const found = triangleAt(figure.points, figure.state.triangles, x, y);
      if (found >= 0) figure.show(found);
      return;
    }
    const far = figure.states.map(({ at }) => Math.hypot(at[0] - x, at[1] - y));
    figure.show(far.indexOf(Math.min(...far)));
  },
};

const MAKERS = { point: pointStates, edge: edgeStates, triangle: triangleStates };

/** The outlines of cells as one layer. */
function outlines(rings) {
  const segments = rings.flatMap((ring) => {
    const sides = [];
    for (let i = 0; i < ring.length; i += 2) {
      const j = (i + 2) % ring.length;
      sides.push(ring[i], ring[i + 1], ring[j], ring[j + 1]);
    }
    return sides;
  });
  return { kind: "lines", segments: Float64Array.from(segments), color: "second", width: 1.8 };
}

function cell(ring, color = "fill") {
  return { kind: "path", xy: ring, closed: true, fill: true, color };
}

/** For each edge u < v its triangles: [u, v, triangle to its left or -1, to its right or -1]. */
function edgesWithTriangles(triangles) {
  const found = new Map();
  for (let t = 0; t < triangles.length; t += 3) {
    for (let k = 0; k < 3; k += 1) {
      const [u, v] = [triangles[t + k], triangles[t + ((k + 1) % 3)]];
      const [low, high, side] = u < v ? [u, v, 2] : [v, u, 3];
      const name = `${low} ${high}`;
      if (!found.has(name)) found.set(name, [low, high, -1, -1]);
      found.get(name)[side] = t / 3;
    }
  }
  return [...found.values()].sort((e, f) => e[0] - f[0] || e[1] - f[1]);
}

function pointStates({ points, triangles, rings }) {
  const all = edgesWithTriangles(triangles);
  return rings.map((ring, row) => {
    const mine = all.filter(([u, v]) => u === row || v === row);
    const open = mine.some(([, , left, right]) => left < 0 || right < 0);
    return {
      at: [points[2 * row], points[2 * row + 1]],
      below: [cell(ring)],
      above: [
        pairs(points, mine.flatMap(([u, v]) => [u, v]), { color: "accent", width: 2.2 }),
        dots(points, [row], { color: "accent", radius: 8 }),
      ],
      say:
        `The cell of point ${row}: all places that are nearer to it than to any other point. ` +
        `It touches the cells of its ${counted(mine.length, "neighbor")} in the triangulation. ` +
        (open ? "The point is on the hull, so its cell is unbounded; the picture cuts it." : "It is a closed polygon."),
    };
  });
}

function edgeStates({ points, triangles }) {
  return edgesWithTriangles(triangles).map(([u, v, left, right]) => {
    const centers = [left, right].map((t) => (t < 0 ? null : circleAt(points, triangles, t)));
    const ends = centers.map((center, side) => center ?? beyond(points, u, v, side, centers[1 - side]));
    const crosses = turnOf(points, u, v, ends[0]) >= 0 && turnOf(points, u, v, ends[1]) <= 0;
    const segments = Float64Array.of(ends[0][0], ends[0][1], ends[1][0], ends[1][1]);
    const open = left < 0 || right < 0;
    return {
      at: [(points[2 * u] + points[2 * v]) / 2, (points[2 * u + 1] + points[2 * v + 1]) / 2],
      above: [
        pairs(points, [u, v], { color: "accent", width: 3 }),
        { kind: "lines", segments, color: "accent", width: 3 },
        dots(points, [u, v], { color: "accent", radius: 7 }),
      ],
      say:
        `The edge between ${u} and ${v}, and its ridge: the places that have both as their nearest points. ` +
        "The ridge is part of the perpendicular bisector. " +
        (open ? "At an edge of the hull it goes on forever. " : "") +
        (crosses ? "Here they cross." : "Here they do not cross: an angle opposite the edge is obtuse."),
    };
  });
}

/** A far place on the bisector of u v, on the given side: 0 left, 1 right. */
function beyond(points, u, v, side, [x, y]) {
  const [dx, dy] = [points[2 * v] - points[2 * u], points[2 * v + 1] - points[2 * u + 1]];
  const far = (side ? 1 : -1) * (FAR / Math.hypot(dx, dy));
  return [x + dy * far, y - dx * far];
}

function turnOf(points, u, v, [x, y]) {
  const three = [points[2 * u], points[2 * u + 1], points[2 * v], points[2 * v + 1], x, y];
  return turn(three, 0, 1, 2);
}

function triangleStates({ points, triangles, rings }) {
  return Array.from({ length: triangles.length / 3 }, (_, t) => {
    const three = triangles.subarray(3 * t, 3 * t + 3);
    const [x, y, radius] = circleAt(points, triangles, t);
    const inside = triangleAt(points, three, x, y) === 0;
    const [x0, y0, x1, y1] = VIEW;
    const seen = x >= x0 && x <= x1 && y >= y0 && y <= y1;
    const where = seen
      ? inside ? "It is inside the triangle." : "It is outside the triangle, which has an obtuse angle."
      : "It is outside the picture: the triangle has an obtuse angle.";
    return {
      at: [x, y],
      below: [...Array.from(three, (row) => cell(rings[row])), fill(points, three, { color: "other" })],
      above: [
        circles([[x, y, radius]], { width: 2 }),
        { kind: "dots", xy: Float64Array.of(x, y), color: "accent", radius: 6 },
        dots(points, three, { color: "accent", radius: 7 }),
      ],
      say:
        `Triangle ${Array.from(three).join(", ")}: the center of its circle is the vertex where the three cells meet. ` +
        `No point is nearer to that place. ${where}`,
    };
  });
}
