// Segments between points, forced one after the other to be edges; the reader draws more of them.

import { circles, dots, edges, edgesOf, fill, names, pairs } from "../layers.js";
import { circleAt, counted } from "../geometry.js";

export default {
  panels: [{ view: [0, 0, 1000, 600] }],
  step: "Segments",
  controls: [
    {
      kind: "choice", name: "pointer", label: "Pointer", value: "move",
      options: [["move", "moves points"], ["draw", "draws segments"]],
    },
    { kind: "toggle", name: "circles", label: "Circles", value: false },
    {
      kind: "button", label: "Remove all",
      press: (figure) => {
        figure.options = { ...figure.options, segments: [] };
      },
    },
  ],
  first: () => 1,

  states({ points, options, core, stored, figure }) {
    figure.marking = () => figure.options.pointer === "draw";
    const segments = options.segments ?? stored.segments;
    const states = [];
    let before = null;
    for (let count = 0; count <= segments.length; count += 2) {
      const some = segments.slice(0, count);
      const triangles = core.constrain(points, some);
      const bad = blocked(points, triangles, core);
      const gone = before ? goneEdges(points, before, triangles) : [];
      const around = options.circles ? bad.map((t) => circleAt(points, triangles, t)) : [];
      const corners = bad.flatMap((t) => [...triangles.subarray(3 * t, 3 * t + 3)]);
      const all = Array.from({ length: points.length / 2 }, (_, row) => String(row));
      const marked = (figure.marked ?? -1) >= 0 ? [figure.marked] : [];
      states.push({
        mark: String(count / 2),
        layers: [[
          fill(points, triangles),
          fill(points, corners, { color: "other" }),
          circles(around, { color: "muted", width: 1 }),
          { kind: "lines", segments: Float64Array.from(gone), color: "muted", dash: [3, 4] },
          edges(points, triangles),
          pairs(points, some, { color: "second", width: 4 }),
          pairs(points, some.slice(-2), { color: "accent", width: 4 }),
          dots(points),
          dots(points, marked, { color: "accent", radius: 8 }),
          names(points, all, { color: "muted" }),
        ]],
        say: marked.length
          ? `Point ${marked[0]} is the start of a segment; choose its end.`
          : sentence(some, gone.length / 4, bad.length, triangles.length / 3),
      });
      before = triangles;
    }
    return states;
  },

  /** Two points were chosen: the segment between them is added, or removed if there is one. */
  mark(figure, from, to) {
    figure.change((changed) => {
      const segments = [...(changed.options.segments ?? changed.stored.segments)];
      const at = segments.findIndex((row, i) => i % 2 === 0 && ends(segments, i, from, to));
      if (at < 0) segments.push(from, to);
      else segments.splice(at, 2);
      changed.options = { ...changed.options, segments };
      changed.step = at < 0 ? segments.length / 2 : changed.step;
    });
  },
};

function ends(segments, i, from, to) {
  const [u, v] = segments.slice(i, i + 2);
  return (u === from && v === to) || (u === to && v === from);
}

function sentence(some, gone, bad, count) {
  if (!some.length) return `No segments: the Delaunay triangulation, with ${counted(count, "triangle")}.`;
  const [u, v] = some.slice(-2);
  const first = gone
    ? `The segment from ${u} to ${v} crosses ${counted(gone, "edge")} (dotted), which ${gone === 1 ? "is" : "are"} replaced. `
    : `The segment from ${u} to ${v} was an edge already. `;
  const last = bad
    ? `In ${bad === 1 ? "one" : bad} of ${count} triangles (orange) the circle is not empty, but a segment hides what is inside.`
    : "All circles are still empty.";
  return first + last;
}

/** Triangles with a point inside their circle. */
function blocked(points, triangles, core) {
  const found = [];
  for (let t = 0; t < triangles.length / 3; t += 1) {
    const three = triangles.subarray(3 * t, 3 * t + 3);
    for (let row = 0; row < points.length / 2; row += 1) {
      if (!three.includes(row) && core.inside(points, ...three, row) > 0) {
        found.push(t);
        break;
      }
    }
  }
  return found;
}

/** Edges of the first triangles that the second do not have, as coordinates. */
function goneEdges(points, before, after) {
  const text = (flat, i) => flat.slice(i, i + 4).join(" ");
  const kept = edgesOf(points, after);
  const there = new Set();
  for (let i = 0; i < kept.length; i += 4) {
    const [a, b, c, d] = kept.slice(i, i + 4);
    there.add(text(kept, i)).add([c, d, a, b].join(" "));
  }
  const old = edgesOf(points, before);
  const gone = [];
  for (let i = 0; i < old.length; i += 4) {
    if (!there.has(text(old, i))) gone.push(...old.slice(i, i + 4));
  }
  return gone;
}
