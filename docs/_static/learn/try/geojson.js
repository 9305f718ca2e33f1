// Points of GeoJSON: points as they are, and the vertices of lines and areas.

import { IN_DEGREES, MAX_POINTS, tooManyPoints, unreadable } from "./problem.js";

// How many arrays the coordinates of a geometry have around each position.
const DEPTH = {
  Point: 0, MultiPoint: 1, LineString: 1, MultiLineString: 2, Polygon: 2, MultiPolygon: 3,
};

const CLOSED = "The last position of a ring repeats the first, and is left out. ";

/** The points of a text, and what else is to be said about them. */
export function readGeojson(text, source) {
  const found = new Positions(source);
  const root = parsed(text, source);
  const features = root?.type === "FeatureCollection" ? root.features : [root];
  if (!Array.isArray(features)) throw unreadable(`${source} cannot be read: it has no list of features`);
  features.forEach((feature, row) => {
    found.place = root.type === "FeatureCollection" ? `feature ${row}` : "its geometry";
    const geometry = feature?.type === "Feature" ? feature.geometry : feature;
    if (geometry !== null) found.add(geometry);
  });
  if (!found.xy.length) throw unreadable(`${source} contains no points`);
  return {
    points: Float64Array.from(found.xy),
    lines: null,
    columns: [],
    note: `${found.closed ? CLOSED : ""}${root.crs ? "" : IN_DEGREES}`,
  };
}

/** JSON; an error names the line. */
function parsed(text, source) {
  try {
    return JSON.parse(text);
  } catch (error) {
    throw unreadable(`${source} cannot be read: ${placed(error.message, text)}`);
  }
}

/** What a browser says about wrong JSON, after the line. */
function placed(message, text) {
  const reason = message
    .replace(/^JSON\.parse: /, "")
    .replace(/,? (in JSON )?at (position|line) .*$/s, "")
    .replace(/,? ?"[^]*" is not valid JSON$/, "");
  const [, named] = /line (\d+)/.exec(message) ?? [];
  const [, position] = /position (\d+)/.exec(message) ?? [];
  const line = named ?? text.slice(0, position ?? firstWrong(text)).split("\n").length;
  return `line ${line}: ${reason}`;
}

const TOKEN = /\s*(?:[{}[\]:,]|"(?:[^"\\\n]|\\.)*"|-?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?|true|false|null)/y;

/** Where a text stops to be tokens of JSON, for browsers that do not say it. */
function firstWrong(text) {
  let end = 0;
  for (TOKEN.lastIndex = 0; TOKEN.test(text); end = TOKEN.lastIndex);
  return end + /^\s*/.exec(text.slice(end))[0].length;
}

/** Positions of geometries, one after the other. */
class Positions {
  constructor(source) {
    Object.assign(this, { source, xy: [], place: "", closed: false });
  }

  add(geometry) {
    const { type, coordinates, geometries } = geometry ?? {};
    if (type === "GeometryCollection" && Array.isArray(geometries)) {
      geometries.forEach((each) => this.add(each));
    } else if (type in DEPTH) {
      this.nested(coordinates, DEPTH[type], type.endsWith("Polygon"));
    } else {
      this.refuse(type === undefined ? "has no type" : `has the unknown type ${JSON.stringify(type)}`);
    }
  }

  nested(coordinates, depth, area) {
    if (!Array.isArray(coordinates)) this.refuse("has no coordinates");
    if (depth === 0) {
      // An empty point.
      if (coordinates.length) this.position(coordinates);
      return;
    }
    if (depth > 1) {
      coordinates.forEach((part) => this.nested(part, depth - 1, area));
      return;
    }
    coordinates.forEach((each, k) => {
      const last = area && k === coordinates.length - 1 && k > 0;
      if (last && same(each, coordinates[0])) this.closed = true;
      else this.position(each);
    });
  }

  position(position) {
    const [x, y] = Array.isArray(position) ? position : [];
    if (typeof x !== "number" || typeof y !== "number") {
      this.refuse(`has a position that is not two numbers: ${JSON.stringify(position)}`.slice(0, 120));
    }
    if (this.xy.length === 2 * MAX_POINTS) throw tooManyPoints(this.source);
    this.xy.push(x, y);
  }

  refuse(what) {
    throw unreadable(`${this.source} cannot be read: ${this.place} ${what}`);
  }
}

const same = (a, b) => a?.[0] === b?.[0] && a?.[1] === b?.[1];
