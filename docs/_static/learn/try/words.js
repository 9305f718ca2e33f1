// The numbers about a triangulation, in words and in a table.

import { append } from "../dom.js";

const whole = (value) => value.toLocaleString("en-US");
const measure = (value) => String(Number(value.toPrecision(5)));
const angle = (value) => `${Number(value.toPrecision(3))}°`;

const ROWS = [
  ["points", "Points", whole],
  ["duplicates", "Duplicates", whole],
  ["triangles", "Triangles", whole],
  ["edges", "Edges", whole],
  ["hull", "Corners of the hull", whole],
  ["minAngle", "Smallest angle", angle],
  ["medianAngle", "Median angle", angle],
  ["area", "Area", measure],
  ["shortest", "Shortest edge", measure],
  ["mean", "Mean edge", measure],
  ["longest", "Longest edge", measure],
];

/** Write the numbers into a list of definitions. */
export function tell(table, summary) {
  table.replaceChildren();
  for (const [name, label, format] of ROWS) {
    const pair = append(table, "div", "try-pair");
    append(pair, "dt", "", label);
    append(pair, "dd", "", format(summary[name])).dataset.value = name;
  }
}

/** A sentence about a result, with the name of its file. */
export function describe({ summary, columns = [], note = "", reading, triangulating }, file = "") {
  const { points, triangles, duplicates } = summary;
  const twice = duplicates ? `, ${whole(duplicates)} of them duplicates` : "";
  const from = columns.length && columns.some((name) => !/^\d+$/.test(name))
    ? ` Columns: ${columns.join(", ")}.`
    : "";
  const read = reading === undefined ? "" : ` Read in ${reading.toFixed(0)} ms.`;
  const time = triangulating === undefined ? "" : `${read} Triangulated in ${triangulating.toFixed(0)} ms.`;
  const of = file && ` from ${file}`;
  return `${whole(points)} points${of}${twice}: ${whole(triangles)} triangles.${time}${from}${note ? ` ${note}` : ""}`;
}
