// A mesh of a ball in three states; tetrahedra with an angle below a bound are filled.

import { dots, edgesOf, fill } from "../layers.js";
import { counted, short } from "../geometry.js";
import { projection, spin, spinControls } from "../spin.js";

const NAMES = ["Delaunay", "After flips", "After flips and moves"];
const BIN = 5;
const BINS = 15;

export default {
  fixed: true,
  panels: [
    { view: [-310, -310, 310, 310], turns: true, title: "Drag to turn" },
    { view: [-6, -12, 106, 84], title: "Smallest dihedral angles" },
  ],
  ratio: 0.9,
  step: "State",
  controls: [
    { kind: "range", name: "below", label: "Fill below", min: 1, max: 40, step: 1, value: 10, unit: "°" },
    ...spinControls(25, 14),
  ],
  turn: spin,

  states({ options, stored }) {
    const project = projection(options);
    const counts = stored.meshes.map(({ angles }) => histogram(angles));
    const high = Math.max(...counts.flat());
    return stored.meshes.map((mesh, i) => {
      const { angles, tetrahedra, moved } = mesh;
      const low = angles.filter((angle) => angle < options.below).length;
      return {
        low,
        layers: [ball(mesh, options.below, project), bars(counts[0], counts[i], high, options.below)],
        say:
          `${NAMES[i]}: ${counted(tetrahedra.length / 4, "tetrahedron").replace("tetrahedrons", "tetrahedra")}, ` +
          `${low || "none"} with a dihedral angle below ${options.below}°. The smallest angle is ${short(Math.min(...angles))}°.` +
          (moved.length ? ` ${moved.length} vertices (orange) have moved.` : " No vertex has moved."),
      };
    });
  },
};

function ball({ points, tetrahedra, angles, moved }, below, project) {
  const xy = [];
  const depth = [];
  for (let i = 0; i < points.length; i += 3) {
    const place = points.slice(i, i + 3);
    xy.push(...project(...place));
    depth.push(project.depth(...place));
  }
  const flat = [];
  const faces = [];
  for (let t = 0; t < tetrahedra.length; t += 4) {
    const four = tetrahedra.slice(t, t + 4);
    const own = [0, 1, 2, 3].map((k) => four.filter((_, j) => j !== k));
    if (angles[t / 4] < below) flat.push(...own.flat());
    faces.push(...own);
  }
  // The origin is inside: a face of the surface is in front if its middle is.
  const front = surface(faces).filter((face) => face.reduce((sum, row) => sum + depth[row], 0) < 0);
  const line = (triangles, style) => ({ kind: "lines", segments: edgesOf(xy, triangles), ...style });
  return [
    line(faces.flat(), { color: "muted", width: 1, alpha: 0.25 }),
    fill(xy, flat, { color: "accent", alpha: 0.55 }),
    line(flat, { color: "accent", width: 1.5 }),
    line(front.flat(), { color: "edge", width: 1, alpha: 0.55 }),
    dots(xy, null, { radius: 2.5 }),
    dots(xy, moved, { color: "accent", radius: 6 }),
  ];
}

/** The faces that belong to one tetrahedron. */
function surface(faces) {
  const found = new Map();
  for (const face of faces) {
    const name = [...face].sort((u, v) => u - v).join(" ");
    if (!found.delete(name)) found.set(name, face);
  }
  return [...found.values()];
}

function histogram(angles) {
  const counts = new Array(BINS).fill(0);
  for (const angle of angles) counts[Math.min(BINS - 1, Math.floor(angle / BIN))] += 1;
  return counts;
}

/** Bars of a histogram over the outlines of the first: 100 wide for 75 degrees, 70 high for the highest. */
function bars(before, now, high, below) {
  const bar = (count, i) => {
    const [left, right, top] = [(100 * i) / BINS + 0.6, (100 * (i + 1)) / BINS - 0.6, (70 * count) / high];
    return Float64Array.of(left, 0, right, 0, right, top, left, top);
  };
  const at = (angle) => (100 * angle) / (BIN * BINS);
  const ticks = [0, 15, 30, 45, 60, 75];
  return [
    ...now.map((count, i) => {
      const color = BIN * (i + 1) <= below ? "accent" : "second";
      return { kind: "path", xy: bar(count, i), closed: true, fill: true, color, alpha: 0.8 };
    }),
    ...(before === now ? [] : before).map((count, i) => (
      { kind: "path", xy: bar(count, i), closed: true, color: "muted", width: 1, dash: [3, 2] }
    )),
    { kind: "lines", segments: Float64Array.of(0, 0, 100, 0), color: "edge", width: 1 },
    { kind: "lines", segments: Float64Array.of(at(below), 0, at(below), 72), color: "accent", dash: [4, 4] },
    {
      kind: "labels", xy: Float64Array.from(ticks.flatMap((angle) => [at(angle), 0])),
      texts: ticks.map((angle) => `${angle}°`), dx: 0, dy: 12, align: "center", size: 12, color: "muted",
    },
  ];
}
