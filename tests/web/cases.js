// Runs calls of the module and returns their results as JSON: shared by Node and the browser.

/** Arrays and objects of typed arrays, as plain lists. */
function plain(value) {
  if (ArrayBuffer.isView(value)) return Array.from(value);
  if (Array.isArray(value) || value === null || typeof value !== "object") return value;
  return Object.fromEntries(Object.entries(value).map(([name, part]) => [name, plain(part)]));
}

/** All states of an algorithm forwards, backwards, and some out of order. */
function walked(steps) {
  const last = steps.length;
  const numbers = Array.from({ length: last + 1 }, (_, k) => k);
  const states = (order) => order.map((k) => plain(steps.at(k)));
  return {
    forwards: states(numbers),
    backwards: states(numbers.toReversed()),
    jumps: states([last, 0, last >> 1, last]),
    steps: steps.steps.map(plain),
  };
}

/** The points of a case whose coordinates JSON cannot write. */
const number = (text) => (typeof text === "string" ? Number(text) : text);

function run(core, { call, args }) {
  try {
    const given = args.map((arg) => (Array.isArray(arg) ? arg.map(number) : arg));
    const value = core[call](...given);
    return { value: call.endsWith("Steps") ? walked(value) : plain(value) };
  } catch (error) {
    return { error: error.name, message: error.message, rows: plain(error.rows ?? []) };
  }
}

export const answers = (core, cases) => cases.map((each) => run(core, each));
