// Bytes of a file, or a text, as points.

import { readGeojson } from "./geojson.js";
import { readLines } from "./lines.js";
import { MAX_BYTES, tooManyBytes, unreadable } from "./problem.js";

const SAMPLE = 1 << 16;

/** Points of `content`, a text or the bytes of a file. */
export function read(content, source, wanted) {
  const size = typeof content === "string" ? content.length : content.byteLength;
  if (size > MAX_BYTES) throw tooManyBytes(source, size);
  if (!size) throw unreadable(`${source} is empty`);
  const text = typeof content === "string" ? content : decoded(new Uint8Array(content), source);
  const json = /\.(geo)?json$/i.test(source) || /^\s*\{/.test(text);
  return json ? readGeojson(text, source) : readLines(text, source, wanted);
}

/** The text of a file: UTF-8, UTF-16 with a mark, or an old code page. */
function decoded(bytes, source) {
  const sample = bytes.subarray(0, SAMPLE);
  const [first, second] = bytes;
  if (first === 0xff && second === 0xfe) return new TextDecoder("utf-16le").decode(bytes);
  if (first === 0xfe && second === 0xff) return new TextDecoder("utf-16be").decode(bytes);
  if (sample.includes(0)) throw unreadable(`${source} is not a text file: it contains zero bytes`);
  try {
    return new TextDecoder("utf-8", { fatal: true }).decode(bytes);
  } catch {
    // Names of columns in an old code page; numbers are the same in all.
    return new TextDecoder("latin1").decode(bytes);
  }
}
