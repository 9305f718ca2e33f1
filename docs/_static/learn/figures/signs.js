// The signs that rounded and exact predicates give for a grid of doubles near a line or a circle.

import { counted } from "../geometry.js";
import { incircleRounded, orientRounded } from "../methods/rounded.js";

const SIDE = 64;
const MIDDLE = 0.5;
const VIEW = [-0.5, -0.5, SIDE - 0.5, SIDE - 0.5];
// A number of these layers selects the color: sign + 1, then marked cells.
const PALETTE = ["second", "paper", "accent", "bad", "fill"];
const RAISED = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };
// The exact test, the words for its signs, and the rounded formula, for each choice.
const SIDES = ["right of the line", "on the line", "left of the line"];
const ORIENT = { test: "orient2d", words: SIDES };
const CHOICES = {
  a: { ...ORIENT, formula: orientRounded },
  b: { ...ORIENT, formula: (ax, ay, bx, by, cx, cy) => orientRounded(bx, by, cx, cy, ax, ay) },
  c: { ...ORIENT, formula: (ax, ay, bx, by, cx, cy) => orientRounded(cx, cy, ax, ay, bx, by) },
  circle: {
    test: "incircle",
    words: ["outside the circle", "on the circle", "inside the circle"],
    formula: incircleRounded,
  },
};

export default {
  panels: [{ view: VIEW, title: "Floating point" }, { view: VIEW, title: "Exact" }],
  ratio: 1,
  free: true,
  step: "Zoom",
  names: ["The marked cell"],
  controls: [
    {
      kind: "choice", name: "test", label: "Test", value: "a",
      options: [
        ["a", "orient2d, from a"], ["b", "orient2d, from b"], ["c", "orient2d, from c"],
        ["circle", "incircle"],
      ],
    },
    { kind: "toggle", name: "wrong", label: "Wrong signs only", value: false },
  ],
  first: (states) => states.length - 1,

  states({ points, options, core, stored }) {
    const choice = CHOICES[options.test];
    const fixed = stored.fixed[choice.test];
    const [column, row] = [points[0], points[1]].map((x) => Math.min(Math.max(x, 0), SIDE - 1));
    return stored.exponents.map((exponent) => {
      const coordinates = cellsOf(fixed, exponent);
      const exact = core.signs(choice.test, exponent, coordinates);
      const size = fixed.length + 2;
      const rounded = exact.map((_, i) =>
        Math.sign(choice.formula(...coordinates.subarray(size * i, size * (i + 1)))));
      return state({ choice, exponent, exact, rounded, column, row, only: options.wrong });
    });
  },

  click(figure, [x, y]) {
    figure.move(0, x, y);
  },
};

/** The fixed points and the point of each cell, one cell after the other. */
function cellsOf(fixed, exponent) {
  const size = fixed.length + 2;
  const found = new Float64Array(size * SIDE * SIDE);
  for (let i = 0; i < SIDE * SIDE; i += 1) {
    const [column, row] = [i % SIDE, Math.floor(i / SIDE)];
    found.set(fixed, size * i);
    found[size * i + size - 2] = MIDDLE + (column - SIDE / 2) * 2 ** -exponent;
    found[size * i + size - 1] = MIDDLE + (row - SIDE / 2) * 2 ** -exponent;
  }
  return found;
}

function state({ choice, exponent, exact, rounded, column, row, only }) {
  const wrong = exact.map((sign, i) => (sign === rounded[i] ? 0 : 1));
  const many = wrong.reduce((sum, one) => sum + one, 0);
  const here = SIDE * row + column;
  const cells = (values) =>
    ({ kind: "cells", values, columns: SIDE, palette: PALETTE, square: VIEW });
  const mark = { kind: "path", xy: boxOf(column, row), closed: true, color: "text", width: 2.5 };
  const said = [rounded, exact].map((signs) => choice.words[signs[here] + 1]);
  const share = `${counted(many, "sign")} of ${(SIDE * SIDE).toLocaleString("en-US")}`;
  return {
    wrong: many,
    mark: `2${raised(-exponent)}`,
    layers: [
      [cells(only ? wrong.map((one) => (one ? 3 : 4)) : rounded.map((sign) => sign + 1)), mark],
      [cells(exact.map((sign) => sign + 1)), mark],
    ],
    say:
      `${many ? share : "No sign"} ${many > 1 ? "are" : "is"} wrong; neighboring cells are 2${raised(-exponent)} apart. ` +
      `The marked point is at (${place(column, exponent)}, ${place(row, exponent)}): ` +
      `floating point says ${said[0]}, exactly it is ${said[1]}.`,
  };
}

function boxOf(column, row) {
  const [x0, y0, x1, y1] = [column - 1, row - 1, column + 1, row + 1];
  return Float64Array.of(x0, y0, x1, y0, x1, y1, x0, y1);
}

function raised(number) {
  return Array.from(String(number), (digit) => RAISED[digit]).join("");
}

/** A coordinate as one half and a multiple of the distance of cells. */
function place(cell, exponent) {
  const many = cell - SIDE / 2;
  if (!many) return "½";
  return `½ ${many < 0 ? "−" : "+"} ${Math.abs(many)}·2${raised(-exponent)}`;
}
