// One tetrahedron in its sphere, made flatter from step to step.

import { dots, edges, fill, names, pairs } from "../layers.js";
import { short } from "../geometry.js";
import { projection, spin, spinControls } from "../spin.js";

const FACES = [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]];
const SIDES = [0, 1, 1, 2, 2, 3, 3, 0];
const DIAGONALS = [0, 2, 1, 3];

export default {
  fixed: true,
  panels: [{ view: [-64, -64, 64, 64], turns: true }],
  ratio: 0.66,
  step: "Flatter",
  first: () => 4,
  controls: spinControls(25, 14),
  turn: spin,

  states({ options, core, stored }) {
    const project = projection(options);
    return stored.heights.map((height) => {
      const corners = [[50, 0, -height], [0, 50, height], [-50, 0, -height], [0, -50, height]];
      const { volumes, minDihedral, maxDihedral } = core.tetrahedra(corners.flat());
      const radius = Math.hypot(50, height);
      const shortest = Math.min(100, Math.hypot(50, 50, 2 * height));
      // The volume of a regular tetrahedron in the same sphere.
      const regular = (8 * radius ** 3) / (9 * Math.sqrt(3));
      return {
        layers: [drawing(corners, radius, project)],
        say:
          `Dihedral angles from ${short(minDihedral[0])}° to ${short(maxDihedral[0])}°. The radius of the sphere is ` +
          `${short(radius / shortest, 3)} times the shortest edge. Volume: ${short((100 * volumes[0]) / regular)} % of ` +
          "that of a regular tetrahedron in the same sphere.",
      };
    });
  },
};

function drawing(corners, radius, project) {
  const xy = Float64Array.from(corners.flatMap((corner) => project(...corner)));
  const far = (face) => face.reduce((sum, row) => sum + project.depth(...corners[row]), 0);
  const behind = [...FACES].sort((f, g) => far(g) - far(f));
  const around = [];
  for (let k = 0; k <= 72; k += 1) {
    const angle = (2 * Math.PI * k) / 72;
    around.push(...project(radius * Math.cos(angle), radius * Math.sin(angle), 0));
  }
  const middle = (u, v) => [(xy[2 * u] + xy[2 * v]) / 2, (xy[2 * u + 1] + xy[2 * v + 1]) / 2];
  const said = ([u, v, w, z]) => `${short(dihedral(corners, u, v, w, z))}°`;
  const label = { dx: 0, dy: 0, align: "center" };
  return [
    { kind: "circles", circles: Float64Array.of(0, 0, radius), color: "muted", width: 1, wash: 0.04 },
    { kind: "path", xy: Float64Array.from(around), color: "muted", width: 1, dash: [3, 4] },
    ...behind.map((face) => fill(xy, face, { alpha: 0.5 })),
    edges(xy, FACES.flat(), { width: 2 }),
    pairs(xy, SIDES, { color: "second", width: 3 }),
    pairs(xy, DIAGONALS, { color: "accent", width: 3 }),
    dots(xy, null, { radius: 5 }),
    names(Float64Array.from(middle(0, 1)), [said([0, 1, 2, 3])], { color: "second", ...label }),
    names(Float64Array.from(middle(0, 2)), [said([0, 2, 1, 3])], { color: "accent", ...label }),
  ];
}

/** The angle between the faces at the edge u v, in degrees. */
function dihedral(corners, u, v, w, z) {
  const minus = (a, b) => a.map((value, i) => value - b[i]);
  const cross = ([a, b, c], [d, e, f]) => [b * f - c * e, c * d - a * f, a * e - b * d];
  const dot = (a, b) => a.reduce((sum, value, i) => sum + value * b[i], 0);
  const axis = minus(corners[v], corners[u]);
  const [m, n] = [w, z].map((row) => cross(axis, minus(corners[row], corners[u])));
  return (Math.atan2(Math.hypot(...cross(m, n)), dot(m, n)) * 180) / Math.PI;
}
