// The elements of the page.

import { append } from "../dom.js";
import { MAX_BYTES, MAX_POINTS } from "./problem.js";
import { SAMPLES } from "./samples.js";

const LAYERS = [
  ["triangles", "Triangles", true],
  ["cells", "Voronoi cells", false],
  ["hull", "Hull", true],
  ["points", "Points", true],
  ["move", "Move points", true],
];
const ZOOM = [
  ["+", "+", "Zoom in"],
  ["-", "−", "Zoom out"],
  ["0", "Show all", "Show all points"],
];
const SAVE = [
  ["csv", "Triangles (CSV)"],
  ["geojson", "Triangles (GeoJSON)"],
  ["points", "Points (CSV)"],
  ["svg", "Picture (SVG)"],
];
const TEXT = "x,y\n0,0\n4,0\n4,3\n0,3\n2,1\n";

/** Add all of them, and return those that do something. */
export function addPage(element) {
  const input = addInput(element);
  const status = append(element, "p", "live-status try-status");
  status.setAttribute("role", "status");
  const problem = append(element, "p", "try-problem");
  problem.setAttribute("role", "alert");
  problem.hidden = true;
  const bar = append(element, "div", "live-controls try-layers");
  const layers = Object.fromEntries(LAYERS.map((layer) => [layer[0], checkbox(bar, layer)]));
  const zoomed = append(bar, "span", "live-group try-zoom");
  const zoom = Object.fromEntries(ZOOM.map(([sign, text, label]) => [sign, button(zoomed, text, label)]));
  const frame = append(element, "div", "live-frame try-frame");
  const table = append(element, "dl", "try-table");
  table.setAttribute("aria-label", "Statistics");
  const saving = append(element, "div", "live-controls try-saving");
  append(saving, "span", "live-label", "Save");
  const save = Object.fromEntries(SAVE.map(([kind, text]) => [kind, button(saving, text, `Save ${text}`)]));
  return { element, ...input, status, problem, layers, zoom, frame, canvas: canvas(frame), table, save };
}

function addInput(element) {
  const group = append(element, "div", "try-input");
  const label = append(group, "label", "try-label", "Points: paste x and y, one point per line, or GeoJSON");
  const text = append(group, "textarea", "try-text");
  Object.assign(text, { id: "try-text", rows: 6, spellcheck: false, value: TEXT });
  label.htmlFor = text.id;
  const bar = append(group, "div", "live-controls");
  const run = button(bar, "Triangulate", "Triangulate the text");
  run.classList.add("try-run");
  const file = chooser(bar);
  const sample = select(bar);
  const { input: columns } = field(bar, "input", "Columns", "try-columns");
  Object.assign(columns, { placeholder: "x,y or 0,1", size: 14, autocomplete: "off" });
  columns.classList.add("live-button");
  const size = MAX_BYTES / 1e6;
  append(
    group, "p", "try-hint",
    `Or drop a file here: CSV, text or GeoJSON, up to ${MAX_POINTS.toLocaleString("en-US")} points and ${size} MB.`,
  );
  return { text, run, file, sample, columns };
}

function button(parent, text, label) {
  const made = append(parent, "button", "live-button", text);
  made.type = "button";
  made.setAttribute("aria-label", label);
  return made;
}

function field(parent, tag, text, id) {
  const group = append(parent, "span", "live-group");
  const label = append(group, "label", "live-label", text);
  const input = append(group, tag, "");
  input.id = id;
  label.htmlFor = id;
  return { group, label, input };
}

function checkbox(parent, [name, text, checked]) {
  const { group, label, input } = field(parent, "input", text, `try-${name}`);
  Object.assign(input, { type: "checkbox", checked, className: "live-check" });
  group.insertBefore(input, label);
  return input;
}

function chooser(parent) {
  const { input } = field(parent, "input", "File", "try-file");
  Object.assign(input, { type: "file", accept: ".csv,.tsv,.txt,.xyz,.pts,.dat,.json,.geojson" });
  input.className = "try-file";
  return input;
}

function select(parent) {
  const { input } = field(parent, "select", "Sample", "try-sample");
  input.className = "live-select";
  for (const [value, text] of [["", "choose one"], ...SAMPLES]) append(input, "option", "", text).value = value;
  return input;
}

function canvas(frame) {
  const made = append(frame, "canvas", "live-canvas try-canvas");
  made.tabIndex = 0;
  made.setAttribute("role", "application");
  made.setAttribute("aria-label", "The picture of the triangulation");
  made.setAttribute("aria-describedby", "try-keys");
  const keys = append(
    frame.parentElement, "p", "try-hint",
    "Drag to move the picture, and scroll (once it has the focus) or pinch to zoom. Keys: arrows, +, - and 0; " +
      "Enter takes the point in the middle, which arrows then move.",
  );
  keys.id = "try-keys";
  return made;
}
