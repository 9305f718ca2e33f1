// The states of Bowyer-Watson. The triangles before and after each insertion come from the core:
// those that disappear are the cavity, those that appear are the star.

import { boundaryOf, circleAt, counted } from "../geometry.js";
import { circles, dots, edges, fill, names, pairs } from "../layers.js";

/** The triangles of the first `count` points. */
export function prefix(points, count, core) {
  return core.delaunay(points.slice(0, 2 * count));
}

/** Triangles of one list that are not in another. */
export function without(triangles, others) {
  const key = (list, t) => Array.from(list.subarray(t, t + 3)).sort((u, v) => u - v).join(" ");
  const there = new Set();
  for (let t = 0; t < others.length; t += 3) there.add(key(others, t));
  const rest = [];
  for (let t = 0; t < triangles.length; t += 3) {
    if (!there.has(key(triangles, t))) rest.push(...triangles.subarray(t, t + 3));
  }
  return Int32Array.from(rest);
}

export function insertionStates(points, core) {
  const count = points.length / 2;
  let before = prefix(points, 3, core);
  const states = [{
    bad: 0,
    layers: [[
      fill(points, before), edges(points, before), waiting(points, 3), ...present(points, 3),
    ]],
    say: "Three points make the first triangle. The outside belongs to triangles with a vertex at infinity.",
  }];
  for (let row = 3; row < count; row += 1) {
    const after = prefix(points, row + 1, core);
    states.push(...threeStates(points, row, before, after));
    before = after;
  }
  return states;
}

/** The three pictures of one insertion. */
function threeStates(points, row, before, after) {
  const bad = without(before, after);
  const star = without(after, before);
  const around = star.length / 3;
  const bound = boundaryOf(star).filter((_, i, all) => !touches(all, i, row));
  const many = bad.length / 3;
  const list = Array.from({ length: many }, (_, t) => circleAt(points, bad, t));
  const fresh = { color: "accent", radius: 7 };
  const kept = without(before, bad);
  const seen = many
    ? `Point ${row} lies inside the circles of ${counted(many, "triangle")}`
    : `Point ${row} lies in no circle of a triangle`;
  const outside = around > many + 2 || !many ? ", and beyond edges of the hull" : "";
  const all = [waiting(points, row + 1), ...present(points, row)];
  return [
    {
      bad: many,
      layers: [[
        fill(points, bad, { color: "other" }), edges(points, before),
        circles(list, { width: 1.2, wash: 0.05 }), ...all, dots(points, [row], fresh),
      ]],
      say: `${seen}${outside}. They are bad.`,
    },
    {
      bad: many,
      layers: [[
        edges(points, kept), pairs(points, bound, { color: "accent", width: 2.5 }),
        ...all, dots(points, [row], fresh),
      ]],
      say: "The bad triangles are deleted. What is left of them is a star-shaped cavity, with its boundary.",
    },
    {
      bad: many,
      layers: [[
        fill(points, star), edges(points, after),
        edges(points, star, { color: "accent", width: 2 }), ...all, dots(points, [row], fresh),
      ]],
      say: `Point ${row} is connected with each edge of the boundary: ${counted(around, "new triangle")}, ${after.length / 3} in all.`,
    },
  ];
}

/** Whether the pair that contains position i has an end at a row. */
function touches(pairsFlat, i, row) {
  const first = i - (i % 2);
  return pairsFlat[first] === row || pairsFlat[first + 1] === row;
}

function present(points, count) {
  return [
    dots(points.subarray(0, 2 * count)),
    names(points.subarray(0, 2 * count), Array.from({ length: count }, (_, i) => String(i))),
  ];
}

/** Points that are not inserted yet. */
function waiting(points, from) {
  return dots(points.subarray(2 * from), null, { color: "muted", radius: 3 });
}
