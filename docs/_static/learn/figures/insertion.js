// Bowyer-Watson: for each point the circles that it lies in, the cavity, the star.

import { insertionStates } from "../methods/insertion.js";

export default {
  panels: [{ view: [0, 0, 1000, 600] }],
  step: "Step",
  first: (states) => Math.max(0, states.findIndex((state) => state.bad > 2)),
  states: ({ points, core }) => insertionStates(points, core),
};
