// What a page says instead of a result: errors named as in Python, with its words.

export const MAX_POINTS = 100_000;
export const MAX_BYTES = 10_000_000;

/** An error of the input: `name` is the Python class, `note` names lines as the command does. */
export class Problem extends Error {
  constructor(name, message, note = "") {
    super(message);
    Object.assign(this, { name, note });
  }
}

export const IN_DEGREES =
  "Longitudes and latitudes are used as planar coordinates: distances are distorted.";

/** The error of a file that is not in its format. */
export const unreadable = (message) => new Problem("FileFormatError", message);

export function tooManyPoints(source) {
  const limit = MAX_POINTS.toLocaleString("en-US");
  return new Problem("LimitError", `${source} has more than ${limit} points, the most that this page takes`);
}

export function tooManyBytes(source, bytes) {
  const [size, limit] = [bytes, MAX_BYTES].map((count) => count.toLocaleString("en-US"));
  return new Problem("LimitError", `${source} has ${size} bytes; this page reads files of up to ${limit}`);
}

/** A text in quotes, as Python shows it. */
export function quoted(text) {
  const mark = text.includes("'") && !text.includes('"') ? '"' : "'";
  const escaped = text
    .replaceAll("\\", "\\\\")
    .replaceAll("\t", "\\t")
    .replaceAll("\r", "\\r")
    .replaceAll("\n", "\\n");
  return mark + (mark === "'" ? escaped.replaceAll("'", "\\'") : escaped) + mark;
}
