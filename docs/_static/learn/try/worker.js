// Reads, triangulates and edits beside the page, which stays free to draw and to be scrolled.
//
// A message {id, call, ...arguments} is answered by {id, value} or {id, error}.

import { load } from "../core/delone.js";
import { read } from "./read.js";
import { sample } from "./samples.js";
import { Slots } from "./slots.js";
import { rimOf, summary } from "./summary.js";

const loading = load();
let core = null;
// The points that are shown, and the triangulation that edits them once one is dragged.
let points = new Float64Array();
let live = null;
let [slots, rim] = [null, null];
// Triangles as they were made last.
let triangles = null;

const CALLS = {
  ready: () => ({ version: core.version }),

  /** Points of a text or of the bytes of a file, triangulated. */
  read({ content, source, wanted }) {
    const start = performance.now();
    const found = read(content, source, wanted);
    const reading = performance.now() - start;
    return { ...begun(found.points, found.lines, source), ...notes(found), reading };
  },

  sample: ({ name }) => ({ ...begun(sample(name)), movable: name === "many" }),

  cells: ({ box }) => core.voronoi(points, box),

  /** Make what moves need. */
  hold() {
    live ??= core.live(points);
    slots ??= new Slots(triangles, points.length / 2);
    return {};
  },

  /** Move a point: what has changed, and the hull where it may have. */
  move({ row, x, y }) {
    CALLS.hold();
    const changes = live.move(row, x, y);
    points[2 * row] = x;
    points[2 * row + 1] = y;
    return { ...changes, ...slots.apply(changes), hull: atRim(changes, row) ? hull() : null };
  },

  /** Everything about the points as they are now. */
  settle: () => made(),
};

function notes({ columns, note = "" }) {
  return { columns, note };
}

/** Take new points. */
function begun(found, lines = null, source = "") {
  const before = points;
  points = found;
  try {
    const answer = made();
    live?.free();
    live = null;
    return answer;
  } catch (error) {
    points = before;
    throw withLines(error, lines, source);
  }
}

/** The triangulation of the points, and numbers about it. The page gets a copy of the points. */
function made() {
  const start = performance.now();
  const found = core.triangulate(points);
  const triangulating = performance.now() - start;
  rim = rimOf(points.length / 2, found);
  [slots, triangles] = [null, found.triangles.slice()];
  return {
    points: points.slice(),
    triangles: found.triangles,
    hull: found.hull,
    rim: rim.slice(),
    summary: summary(points, found, core.statistics(points, found)),
    triangulating,
  };
}

/** Whether a change touches the boundary; what it touches may become boundary. */
function atRim({ gone, added }, moved) {
  if (!rim[moved] && ![gone, added].some((rows) => rows.some((row) => rim[row]))) return false;
  for (const rows of [gone, added]) rows.forEach((row) => (rim[row] = 1));
  return true;
}

/** The hull; none of points on one line. */
function hull() {
  try {
    return core.hull(points);
  } catch {
    return new Int32Array();
  }
}

/** Name the lines of bad rows, as the command does. */
function withLines(error, lines, source) {
  const rows = error.name === "NonFiniteError" ? Array.from(error.rows ?? []) : [];
  if (lines && rows.length) {
    const named = rows.map((row) => lines[row]).join(", ");
    error.note = `${rows.length === 1 ? "line" : "lines"} ${named} of ${source}`;
  }
  return error;
}

onmessage = async ({ data: { id, call, ...given } }) => {
  try {
    core ??= await loading;
    const value = CALLS[call](given);
    const parts = Object.values(value).filter(ArrayBuffer.isView);
    postMessage({ id, value }, parts.map((part) => part.buffer));
  } catch (error) {
    const { name, message, note = "" } = error;
    postMessage({ id, error: { name, message, note } });
  }
};
