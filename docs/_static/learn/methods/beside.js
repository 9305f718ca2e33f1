// The states of rounded Bowyer-Watson beside the right triangles, point by point.

import { counted, short, turn } from "../geometry.js";
import { dots, edges, fill } from "../layers.js";
import { prefix, without } from "./insertion.js";
import { roundedRun } from "./rounded.js";

const VIEW = [0, 0, 600, 600];

export const BESIDE = {
  panels: [{ view: VIEW, title: "Floating point" }, { view: VIEW, title: "Exact" }],
  ratio: 1,
  step: "Points",
  first: (states) => states.length - 1,
  states: ({ points, core }) =>
    roundedRun(points).map((found, i) => state(points, i + 3, found, prefix(points, i + 3, core))),
};

/** The sum of the areas of triangles, rounded. */
function areaOf(points, triangles) {
  let sum = 0;
  for (let t = 0; t < triangles.length; t += 3) {
    sum += Math.abs(turn(points, triangles[t], triangles[t + 1], triangles[t + 2])) / 2;
  }
  return sum;
}

function state(points, count, found, exact) {
  const wrong = without(found, exact);
  const here = points.subarray(0, 2 * count);
  const late = points.subarray(2 * count);
  const last = Float64Array.from(here.subarray(-2));
  const rest = [
    dots(late, null, { color: "muted", radius: 3 }), dots(here), dots(last, null, { color: "accent", radius: 7 }),
  ];
  return {
    wrong: wrong.length / 3,
    mark: `${count}`,
    layers: [
      [
        ...Array.from({ length: wrong.length / 3 }, (_, t) =>
          fill(points, wrong.subarray(3 * t, 3 * t + 3), { color: "bad", alpha: 0.16 })),
        edges(points, found), edges(points, wrong, { color: "bad", width: 2 }), ...rest,
      ],
      [fill(points, exact, { alpha: 0.5 }), edges(points, exact), ...rest],
    ],
    say: `${count} points. Floating point: ${sentence(points, found, exact, wrong.length / 3)}`,
  };
}

/** What is wrong with some triangles. */
function sentence(points, found, exact, wrong) {
  const [sum, right] = [found.length / 3, exact.length / 3];
  const many = counted(sum, "triangle");
  if (!wrong && sum === right) return `${many}, all right.`;
  const number = sum === right ? `${many}, the right number,` : `${many} instead of ${right},`;
  const share = areaOf(points, found) / areaOf(points, exact);
  const much = Math.abs(share - 1) < 1e-9
    ? "together they have the right area: what is missing or too much is as thin as the rounding"
    : `together they have ${short(share, 2)} times the area of the hull, so they overlap`;
  return `${number} ${wrong || "none"} of them wrong; ${much}.`;
}
