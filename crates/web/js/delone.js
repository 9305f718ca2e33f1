// The core of delone in the browser and in Node; delone.d.ts describes what it offers.

import initialize, * as core from "./delone_web.js";

import {
  bowyerWatsonSteps,
  divideSteps,
  incrementalSteps,
  lawsonSteps,
  scan,
  sweepSteps,
} from "./steps.js";

const MAX_POINTS = 100_000;

/** What a call throws, named as in Python. */
export class DeloneError extends Error {
  constructor(name, message, rows = new Int32Array()) {
    super(message);
    this.name = name;
    this.rows = rows;
  }
}

let loading = null;

/** Loads the compiled core, once. */
export function load(source) {
  loading ??= bytes(source)
    .then((module) => initialize({ module_or_path: module }))
    .then(() => new Core())
    .catch((error) => {
      loading = null;
      throw error;
    });
  return loading;
}

/** What `initialize` takes: Node cannot fetch files. */
async function bytes(source) {
  const from = source ?? new URL("delone_web_bg.wasm", import.meta.url);
  if (from instanceof URL && from.protocol === "file:") {
    const { readFile } = await import("node:fs/promises");
    return readFile(from);
  }
  return from;
}

/** Runs a call of the compiled core; `take` reads its arrays. */
function ask(call, take) {
  let answer;
  try {
    answer = call();
  } catch (error) {
    throw new DeloneError("InternalError", `the core stopped: ${error.message}`);
  }
  try {
    if (answer.class) throw new DeloneError(answer.class, answer.message, answer.rows());
    return take(answer);
  } finally {
    answer.free();
  }
}

/** Coordinates as doubles: whole points of `size` coordinates. */
function doubles(values, size = 2, name = "points") {
  const array = values instanceof Float64Array ? values : Float64Array.from(values);
  whole(array, size, name);
  return array;
}

/** Rows as 32-bit integers. */
function integers(values, size, name) {
  const array = values instanceof Int32Array ? values : Int32Array.from(values);
  whole(array, size, name);
  return array;
}

function whole(array, size, name) {
  if (array.length % size === 0) return;
  const text = `${name} must have a multiple of ${size} numbers, got ${array.length}`;
  throw new DeloneError("ShapeError", text);
}

/** Chooses among the values of an option. */
function among(name, value, choices) {
  if (choices.includes(value)) return value;
  const names = choices.map((choice) => `'${choice}'`).join(", ");
  throw new DeloneError("InputError", `${name} must be one of ${names}, got '${value}'`);
}

const sortedMedian = (values) => {
  const sorted = Float64Array.from(values).sort();
  const half = sorted.length >> 1;
  return sorted.length % 2 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
};

class Core {
  constructor() {
    this.version = core.version();
    this.methods = Object.freeze(core.methods());
  }

  triangulate(xy, { method = "auto" } = {}) {
    const points = doubles(xy);
    among("method", method, this.methods);
    return ask(
      () => core.triangulate(points, method),
      (answer) => ({
        triangles: answer.integers(0),
        neighbors: answer.integers(1),
        hull: answer.integers(2),
        duplicates: answer.integers(3),
      }),
    );
  }

  constrain(xy, segments, options = {}) {
    return this.#meshed(xy, segments, { enclosed: false, ...options }, false);
  }

  mesh(xy, segments, options = {}) {
    return this.#meshed(xy, segments, { enclosed: true, ...options }, true);
  }

  #meshed(xy, segments, options, refine) {
    const points = doubles(xy);
    const ends = integers(segments, 2, "segments");
    const holes = doubles(options.holes ?? [], 2, "holes");
    const choices = new core.Choices();
    choices.split = among("crossing", options.crossing ?? "error", ["error", "split"]) === "split";
    choices.conforming = options.conforming ?? false;
    choices.enclosed = options.enclosed;
    choices.refine = refine;
    choices.min_angle = options.minAngle ?? 0;
    choices.max_area = options.maxArea ?? Infinity;
    choices.max_points = options.maxPoints ?? MAX_POINTS;
    try {
      return ask(() => core.mesh(points, ends, holes, choices), constrained);
    } finally {
      choices.free();
    }
  }

  hull(xy) {
    const points = doubles(xy);
    return ask(() => core.convex_hull(points), (answer) => answer.integers(0));
  }

  circumcircles(xy, triangles) {
    const points = doubles(xy);
    const corners = integers(triangles, 3, "triangles");
    const take = (answer) => answer.numbers(0);
    const centers = ask(() => core.circumcenters(points, corners), take);
    const radii = Float64Array.from({ length: corners.length / 3 }, (_, t) => {
      const row = corners[3 * t];
      return Math.hypot(centers[2 * t] - points[2 * row], centers[2 * t + 1] - points[2 * row + 1]);
    });
    return { centers, radii };
  }

  voronoi(xy, box) {
    const points = doubles(xy);
    return ask(
      () => core.cells(points, ...box),
      (answer) => ({
        starts: answer.integers(0),
        across: answer.integers(1),
        corners: answer.numbers(0),
        areas: answer.numbers(1),
      }),
    );
  }

  locate(xy, { triangles, neighbors }, queries) {
    const points = doubles(xy);
    const corners = integers(triangles, 3, "triangles");
    const across = integers(neighbors, 3, "neighbors");
    const at = doubles(queries, 2, "queries");
    return ask(
      () => core.locate(points, corners, across, at),
      (answer) => ({
        triangle: answer.integers(0),
        nearest: answer.integers(1),
        weights: answer.numbers(0),
      }),
    );
  }

  statistics(xy, { triangles, duplicates }) {
    const points = doubles(xy);
    const [angles, areas] = ask(
      () => core.qualities(points, integers(triangles, 3, "triangles")),
      (answer) => [answer.numbers(0), answer.numbers(1)],
    );
    const least = (values) => values.reduce((a, b) => Math.min(a, b), Infinity);
    return {
      points: points.length / 2,
      triangles: areas.length,
      duplicates: duplicates.length / 2,
      areas,
      angles,
      area: areas.reduce((a, b) => a + b, 0),
      minArea: least(areas),
      maxArea: -least(areas.map((area) => -area)),
      minAngle: least(angles),
      medianAngle: sortedMedian(angles),
    };
  }

  orientations(coordinates, { naive = false } = {}) {
    return core.orientations(finite(doubles(coordinates, 6, "coordinates")), naive);
  }

  incircles(coordinates, { naive = false } = {}) {
    return core.incircles(finite(doubles(coordinates, 8, "coordinates")), naive);
  }

  orient2d(...coordinates) {
    return this.orientations(coordinates)[0];
  }

  orient2dNaive(...coordinates) {
    return this.orientations(coordinates, { naive: true })[0];
  }

  incircle(...coordinates) {
    return this.incircles(coordinates)[0];
  }

  incircleNaive(...coordinates) {
    return this.incircles(coordinates, { naive: true })[0];
  }

  incirclesCanonical(coordinates) {
    return core.incircles_canonical(finite(doubles(coordinates, 8, "coordinates")));
  }

  incircleCanonical(...coordinates) {
    return this.incirclesCanonical(coordinates)[0];
  }

  /** The flips from `triangles` to the Delaunay triangulation: four rows each. */
  flips(xy, triangles) {
    const points = doubles(xy);
    const corners = integers(triangles, 3, "triangles");
    return ask(() => core.flips(points, corners), (answer) => answer.integers(1));
  }

  bowyerWatsonSteps(xy, { order } = {}) {
    return bowyerWatsonSteps(this, doubles(xy), order);
  }

  incrementalSteps(xy, { order } = {}) {
    return incrementalSteps(this, doubles(xy), order);
  }

  lawsonSteps(xy, triangles) {
    return lawsonSteps(this, doubles(xy), triangles);
  }

  divideSteps(xy) {
    return divideSteps(this, doubles(xy));
  }

  sweepSteps(xy) {
    return sweepSteps(this, doubles(xy));
  }

  scan(xy) {
    return scan(this, doubles(xy));
  }

  live(xy) {
    return new LiveTriangulation(doubles(xy));
  }

  tetrahedra(xyz) {
    const points = doubles(xyz, 3);
    return ask(
      () => core.tetrahedra(points),
      (answer) => ({
        tetrahedra: answer.integers(0),
        neighbors: answer.integers(1),
        hull: answer.integers(2),
        duplicates: answer.integers(3),
        volumes: answer.numbers(0),
        minDihedral: answer.numbers(1),
        maxDihedral: answer.numbers(2),
      }),
    );
  }
}

/** A triangulation that is edited in place. */
class LiveTriangulation {
  #live = new core.Live();

  constructor(points) {
    ask(() => this.#live.start(points), () => {});
  }

  move(row, x, y) {
    this.#check([row]);
    return ask(() => this.#live.relocate(row, x, y), changes);
  }

  insert(xy) {
    const points = doubles(xy);
    return ask(() => this.#live.insert(points), changes);
  }

  remove(rows) {
    const gone = integers(rows, 1, "rows");
    this.#check(gone);
    return ask(() => this.#live.remove(gone), changes);
  }

  state() {
    return ask(
      () => this.#live.state(),
      (answer) => ({
        rows: answer.integers(0),
        triangles: answer.integers(1),
        neighbors: answer.integers(2),
        duplicates: answer.integers(3),
        points: answer.numbers(0),
      }),
    );
  }

  free() {
    this.#live.free();
  }

  #check(rows) {
    const gone = Array.from(rows).filter((row) => !this.#live.has(row));
    if (!gone.length) return;
    const names = gone.slice(0, 5).join(", ") + (gone.length > 5 ? ", ..." : "");
    const text = gone.length === 1 ? `handle ${names} is not there` : `handles ${names} are not there`;
    throw new DeloneError("HandleError", text, Int32Array.from(gone));
  }
}

/** Triangles that went and came. */
const changes = (answer) => ({ gone: answer.integers(0), added: answer.integers(1) });

/** The arrays of a constrained triangulation or mesh. */
function constrained(answer) {
  const [added, complete] = answer.integers(5);
  return {
    points: answer.numbers(0),
    triangles: answer.integers(0),
    neighbors: answer.integers(1),
    constrained: Uint8Array.from(answer.integers(2)),
    subsegments: answer.integers(3),
    duplicates: answer.integers(4),
    added,
    complete: complete === 1,
  };
}

/** Predicates are defined for finite coordinates only. */
function finite(coordinates) {
  if (coordinates.every(Number.isFinite)) return coordinates;
  throw new DeloneError("NonFiniteError", "a coordinate is NaN or infinite");
}
