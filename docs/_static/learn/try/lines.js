// Points in lines of text: delimiter, decimal mark and header are found as delone.io finds them.

import { chooseColumns, inDegrees } from "./columns.js";
import { IN_DEGREES, MAX_POINTS, quoted, tooManyPoints, unreadable } from "./problem.js";

const COMMENTS = ["#", "//", "%", "!"];
const NUMBER = /^[+-]?(?:(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?|inf(?:inity)?|nan)$/i;
const [SAMPLE_LINES, SAMPLE_ROWS] = [200, 50];
// Delimiters, each with a decimal mark; null is any white space.
const CANDIDATES = [
  [",", "."], [";", "."], ["\t", "."], ["|", "."], [null, "."], [";", ","], ["\t", ","],
];

/** The points of a text, and the line of each row. `wanted`: names of columns, or none. */
export function readLines(text, source, wanted = []) {
  const lines = text.split(/\r\n|\r|\n/);
  const layout = layoutOf(lines.slice(0, SAMPLE_LINES), source);
  const columns = chooseColumns(layout.names, wanted, source, layout.named);
  const rows = rowsOf(lines, layout.skip, source);
  const table = new Table(layout, source, lines, rows);
  const points = table.read(columns);
  const { claimed } = layout;
  if (claimed !== null && rows.length < claimed) {
    throw unreadable(
      `${source} declares ${claimed} points and contains ${rows.length}: it is truncated`,
    );
  }
  const names = columns.map((k) => layout.names[k]);
  const note = inDegrees(names) ? IN_DEGREES : "";
  return { points, lines: rows.map((line) => line + 1), columns: names, note };
}

/** The numbers of the lines that hold rows. */
function rowsOf(lines, skip, source) {
  const rows = [];
  for (let k = skip; k < lines.length; k += 1) {
    if (!isRow(lines[k])) continue;
    if (rows.length === MAX_POINTS) throw tooManyPoints(source);
    rows.push(k);
  }
  return rows;
}

function isComment(line) {
  const text = line.trimStart();
  return COMMENTS.some((mark) => text.startsWith(mark));
}

const isRow = (line) => line.trim() !== "" && !isComment(line);

/** Delimiter, decimal mark, names of columns, and what comes before the first row. */
function layoutOf(lines, source) {
  let [start, comment] = [0, ""];
  for (; start < lines.length && !isRow(lines[start]); start += 1) {
    comment = lines[start].trim().replace(/^[#/%!]+/, "").trim() || comment;
  }
  let rows = lines.slice(start).filter(isRow);
  if (!rows.length) throw unreadable(`${source} contains no rows of numbers`);
  let claimed = null;
  if (rows.length > 1 && /^\d+$/.test(rows[0].trim()) && rows[1].split(/[\s,;]+/).length > 1) {
    claimed = announced(rows[0].trim(), source);
    start = lines.indexOf(rows[0], start) + 1;
    rows = rows.slice(1);
  }
  const layout = split(rows.slice(0, SAMPLE_ROWS), source);
  if (layout.named) {
    start = lines.indexOf(rows[0], start) + 1;
  } else if (comment) {
    // A header behind a comment mark: # x y z
    const names = fieldsOf(comment, layout.delimiter);
    if (names.length === layout.names.length) Object.assign(layout, { names, named: true });
  }
  return { ...layout, skip: start, claimed };
}

/** A count that a file declares. */
function announced(text, source) {
  const short = text.replace(/^0+/, "") || "0";
  if (short.length > 18) {
    throw unreadable(`${source} is corrupt: it declares a number of ${short.length} digits`);
  }
  return Number(short);
}

/** The delimiter, decimal mark and header with which most fields become numbers. */
function split(rows, source) {
  const body = rows.length > 1 ? rows.slice(1) : rows;
  let best = null;
  for (const [delimiter, decimal] of CANDIDATES) {
    const fields = body.map((row) => fieldsOf(row, delimiter));
    const usual = commonest(fields.map((row) => row.length));
    const numbers = fields.flat().filter((field) => isNumber(field, decimal)).length;
    const better = !best || numbers > best.numbers || (numbers === best.numbers && usual > best.usual);
    if (usual > 1 && numbers && better) best = { numbers, usual, delimiter, decimal };
  }
  if (!best) {
    const last = quoted(rows.at(-1).slice(0, 60));
    throw unreadable(`${source}: its lines are not columns of numbers: ${last}`);
  }
  const { delimiter, decimal } = best;
  const first = fieldsOf(rows[0], delimiter);
  const named = !first.some((field) => isNumber(field, decimal));
  return { delimiter, decimal, named, names: named ? first : first.map((_, k) => String(k)) };
}

/** The most frequent number, the first of several. */
function commonest(numbers) {
  const counts = new Map();
  for (const number of numbers) counts.set(number, (counts.get(number) ?? 0) + 1);
  return [...counts].reduce((best, next) => (next[1] > best[1] ? next : best))[0];
}

const words = (text) => text.trim().split(/\s+/).filter(Boolean);

function fieldsOf(row, delimiter) {
  const fields = delimiter === null ? words(row) : row.split(delimiter);
  return fields.map((field) => field.trim().replace(/^"+|"+$/g, "").trim());
}

const isNumber = (field, decimal) => NUMBER.test(decimal === "." ? field : field.replaceAll(decimal, "."));

/** The rows below the header. */
class Table {
  constructor(layout, source, lines, rows) {
    Object.assign(this, { layout, source, lines, rows });
  }

  /** The chosen columns as doubles, flat. */
  read(columns) {
    this.refuseLongRows();
    const points = new Float64Array(this.rows.length * columns.length);
    for (let row = 0, at = 0; row < this.rows.length; row += 1) {
      const fields = this.fields(row);
      for (const column of columns) {
        const text = fields[column];
        if (text === undefined) throw this.short(row, fields.length);
        points[at++] = this.number(text, row, column);
      }
    }
    return points;
  }

  line(row) {
    const line = this.lines[this.rows[row]];
    return this.layout.decimal === "." ? line : line.replaceAll(this.layout.decimal, ".");
  }

  fields(row) {
    const line = this.line(row);
    const { delimiter } = this.layout;
    if (line.includes('"')) return unquoted(line, delimiter);
    return delimiter === null ? words(line) : line.split(delimiter);
  }

  number(text, row, column) {
    const plain = text.trim();
    if (NUMBER.test(plain)) {
      const value = Number(plain);
      // NaN here is one of Python's words for numbers that are not finite.
      return Number.isNaN(value) ? notFinite(plain) : value;
    }
    const { named, names } = this.layout;
    const name = named && column < names.length ? names[column] : String(column);
    const what = text ? `is ${quoted(text)}, not a number` : "is empty";
    return this.fail(`${this.place(row)}, column ${name} ${what}`);
  }

  place(row) {
    return `line ${this.rows[row] + 1} (row ${row})`;
  }

  short(row, count) {
    return unreadable(
      `${this.source}: ${this.place(row)} has only ${count} columns: is the file truncated?`,
    );
  }

  fail(message) {
    throw unreadable(`${this.source}: ${message}`);
  }

  /** Refuses fields beyond those of the first line: decimal commas look like this. */
  refuseLongRows() {
    const { delimiter, names } = this.layout;
    for (let row = 0; row < this.rows.length; row += 1) {
      const line = this.line(row);
      if (line.includes('"')) continue;
      const fields = delimiter === null ? words(line) : line.split(delimiter);
      if (fields.length <= names.length) continue;
      if (!fields.slice(names.length).some((field) => field.trim())) continue;
      this.fail(
        `${this.place(row)} has ${fields.length} columns, but the first has ${names.length}: ` +
          "are there decimal commas, or another delimiter?",
      );
    }
  }
}

const notFinite = (text) => {
  if (/nan/i.test(text)) return NaN;
  return text.startsWith("-") ? -Infinity : Infinity;
};

/** The fields of a line in which some are in quotes. */
function unquoted(line, delimiter) {
  const fields = [];
  let [field, inside, begun] = ["", false, false];
  const end = () => {
    if (begun || delimiter !== null) fields.push(field);
    [field, begun] = ["", false];
  };
  for (const letter of line) {
    if (letter === '"') [inside, begun] = [!inside, true];
    else if (!inside && (delimiter === null ? /\s/.test(letter) : letter === delimiter)) end();
    else [field, begun] = [field + letter, true];
  }
  end();
  return fields;
}
