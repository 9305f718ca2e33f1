// The triangles of points in the plane, and the lower hull of the points lifted to a paraboloid.

import { circles, dots, edges, edgesOf, fill, names } from "../layers.js";
import { circleAt, short, triangleAt } from "../geometry.js";
import { projection, spin, spinControls } from "../spin.js";

// The middle of the picture is the lowest point of the paraboloid; its sides are 1 away.
const HALF = 300;
const FLOOR = -0.6;
const RINGS = [0.25, 0.5, 0.75, 1];
const TURN = 2 * Math.PI;

export default {
  panels: [
    { view: [0, 0, 600, 630], title: "In the plane: drag a point" },
    { view: [-1.2, -1.1, 1.2, 1.35], title: "Lifted: drag to turn", turns: true },
  ],
  ratio: 1,
  step: "Triangle",
  controls: spinControls(25, 12),
  first: () => 2,
  turn: spin,

  states({ points, options, core }) {
    const triangles = core.delaunay(points);
    const project = projection(options);
    const count = points.length / 2;
    const base = scenery(points, triangles, project);
    return Array.from({ length: triangles.length / 3 }, (_, t) => {
      const three = triangles.subarray(3 * t, 3 * t + 3);
      const circle = circleAt(points, triangles, t);
      const others = Array.from({ length: count }, (_, row) => row).filter((row) => !three.includes(row));
      const least = Math.min(...others.map((row) => heightAbove(points, circle, row)));
      return {
        triangles,
        layers: [
          [
            fill(points, triangles), fill(points, three, { color: "other" }), edges(points, triangles),
            circles([circle], { width: 2, wash: 0.06 }), dots(points), named(points, count),
          ],
          lifted(points, three, circle, base, project),
        ],
        say:
          `The plane through the lifted corners ${Array.from(three).join(", ")} cuts the paraboloid above the circle. ` +
          `The other ${others.length} points are above this plane: the circle is empty. ` +
          (least < 5e-4 ? "The lowest is almost in the plane, so almost on the circle." : `The lowest is ${short(least, 3)} above it.`),
      };
    });
  },

  click(figure, [x, y], panel) {
    const found = panel ? -1 : triangleAt(figure.points, figure.state.triangles, x, y);
    if (found >= 0) figure.show(found);
  },
};

/** Height of a lifted point above the plane of a circle: squared distance minus squared radius. */
function heightAbove(points, [x, y, radius], row) {
  const far = Math.hypot(points[2 * row] - x, points[2 * row + 1] - y);
  return (far * far - radius * radius) / (HALF * HALF);
}

function named(points, count) {
  return names(points, Array.from({ length: count }, (_, row) => String(row)));
}

/** Place in the plane of the drawing of a point of the picture, on the paraboloid or the floor. */
function placed(x, y, project, floor = false) {
  const [u, v] = [(x - HALF) / HALF, (y - HALF) / HALF];
  return project(u, v, floor ? FLOOR : u * u + v * v);
}

function all(points, project, floor) {
  const flat = [];
  for (let i = 0; i < points.length; i += 2) flat.push(...placed(points[i], points[i + 1], project, floor));
  return Float64Array.from(flat);
}

/** What all states share: the paraboloid, the floor, the points, and their hull. */
function scenery(points, triangles, project) {
  const top = all(points, project, false);
  const floor = all(points, project, true);
  const posts = [];
  for (let i = 0; i < top.length; i += 2) posts.push(floor[i], floor[i + 1], top[i], top[i + 1]);
  const bowl = [];
  for (const radius of RINGS) bowl.push(...curve((s) => [radius * Math.cos(TURN * s), radius * Math.sin(TURN * s)], project));
  for (let k = 0; k < 12; k += 1) {
    const [x, y] = [Math.cos((TURN * k) / 12), Math.sin((TURN * k) / 12)];
    bowl.push(...curve((s) => [s * RINGS.at(-1) * x, s * RINGS.at(-1) * y], project));
  }
  const grey = { color: "muted", width: 1 };
  return {
    top,
    floor,
    triangles,
    back: [
      { kind: "lines", segments: Float64Array.from(bowl), alpha: 0.4, ...grey },
      { kind: "lines", segments: edgesOf(floor, triangles), ...grey },
      { kind: "lines", segments: Float64Array.from(posts), dash: [2, 4], ...grey },
    ],
    hull: fill(top, triangles, { alpha: 0.55 }),
  };
}

/** A curve on the paraboloid over the plane, in 48 pieces. */
function curve(at, project) {
  const segments = [];
  for (let k = 0; k < 48; k += 1) {
    for (const s of [k / 48, (k + 1) / 48]) {
      const [u, v] = at(s);
      segments.push(...project(u, v, u * u + v * v));
    }
  }
  return segments;
}

function lifted(points, three, [x, y, radius], base, project) {
  const [u, v, r] = [(x - HALF) / HALF, (y - HALF) / HALF, radius / HALF];
  const around = curve((s) => [u + r * Math.cos(TURN * s), v + r * Math.sin(TURN * s)], project);
  return [
    ...base.back,
    fill(base.floor, three, { color: "other" }),
    base.hull,
    fill(base.top, three, { color: "other", alpha: 0.85 }),
    edges(base.top, base.triangles),
    { kind: "lines", segments: Float64Array.from(around), color: "accent", width: 2 },
    dots(base.top),
    dots(base.top, three, { color: "accent", radius: 6 }),
    named(base.top, points.length / 2),
  ];
}
