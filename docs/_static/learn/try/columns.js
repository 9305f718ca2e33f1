// Which columns are x and y: the rules and words of delone.io.

import { unreadable } from "./problem.js";

const WORDS = {
  x: ["x", "lon", "long", "lng", "longitude", "easting", "east", "e", "xcoord", "coordx"],
  y: ["y", "lat", "latitude", "northing", "north", "n", "ycoord", "coordy"],
};
const UNITS = ["m", "ft", "km", "mm", "cm", "deg", "degrees", "degree", "meters", "metres", "feet", "dd"];

/** The positions of x and y: by the names wanted, by the usual names, or the first ones. */
export function chooseColumns(names, wanted, source, named) {
  if (wanted.length) {
    if (wanted.length < 2 || wanted.length > 3) {
      throw unreadable(`${source}: give two or three columns (x,y or x,y,z)`);
    }
    return wanted.slice(0, 2).map((name) => findColumn(names, name, source));
  }
  if (!named) {
    if (names.length < 2) throw unreadable(`${source} has fewer than two numeric columns`);
    return [0, 1];
  }
  const [x, y] = ["x", "y"].map((role) => recognized(names, role, source));
  if (x < 0 || y < 0) {
    throw unreadable(
      `${source}: which columns are x and y? Choose them (--columns x,y or x,y,z) from ${listed(names)}`,
    );
  }
  return [x, y];
}

const DEGREES = ["lon", "long", "lng", "longitude", "lat", "latitude"];

/** Whether columns are longitudes and latitudes by their names. */
export const inDegrees = (names) => names.every((name) => DEGREES.includes(wordOf(name)));

/** The position of a column given by its name, in any case, or by its number from 0. */
function findColumn(names, wanted, source) {
  const text = wanted.trim();
  const same = names.filter((name) => name === text).length;
  if (same > 1) {
    throw unreadable(`${source} has ${same} columns '${text}': choose one by number from 0`);
  }
  if (same === 1) return names.indexOf(text);
  const folded = names.map((name) => name.trim().toLowerCase());
  const low = text.toLowerCase();
  if (folded.filter((name) => name === low).length === 1) return folded.indexOf(low);
  if (/^\d{1,9}$/.test(text) && Number(text) < names.length) return Number(text);
  throw unreadable(`${source} has no column '${text}'; its columns are ${listed(names)}`);
}

function recognized(names, role, source) {
  const words = names.map(wordOf);
  // The single letter takes precedence over every synonym.
  const wins = words.includes(role) ? role : words.find((word) => WORDS[role].includes(word));
  if (wins === undefined) return -1;
  const same = words.filter((word) => word === wins).length;
  if (same > 1) {
    throw unreadable(
      `${source}: which column is ${role}? ${same} are named ${wins}; choose ` +
        `(--columns) by number from 0 among ${listed(names)}`,
    );
  }
  return words.indexOf(wins);
}

/** The word of a name: "Depth [m]" is depth, "X_COORD" is xcoord. */
function wordOf(name) {
  const parts = name.toLowerCase().match(/[a-z]+|\d+/g) ?? [];
  if (parts.length > 1 && UNITS.includes(parts.at(-1))) parts.pop();
  return parts.join("");
}

function listed(names) {
  return names.length ? names.slice(0, 20).join(", ") + (names.length > 20 ? ", ..." : "") : "none";
}
