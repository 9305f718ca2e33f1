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

/** What a live triangulation answers to edits, and its state after each of them. */
function edited(core, xy, edits) {
  const live = core.live(xy);
  const answers = edits.map(([name, ...args]) => {
    try {
      return { value: plain(live[name](...args.map(numbers))), state: plain(live.state()) };
    } catch (error) {
      return { error: error.name, message: error.message, state: plain(live.state()) };
    }
  });
  live.free();
  return answers;
}

const numbers = (arg) => (Array.isArray(arg) ? arg.map(number) : number(arg));

/** The points of a case whose coordinates JSON cannot write. */
const number = (text) => (typeof text === "string" ? Number(text) : text);

function run(core, { call, args }) {
  try {
    if (call === "edited") return { value: edited(core, ...args) };
    const given = args.map((arg) => (Array.isArray(arg) ? arg.map(number) : arg));
    const value = core[call](...given);
    return { value: call.endsWith("Steps") ? walked(value) : plain(value) };
  } catch (error) {
    return { error: error.name, message: error.message, rows: plain(error.rows ?? []) };
  }
}

export const answers = (core, cases) => cases.map((each) => run(core, each));
