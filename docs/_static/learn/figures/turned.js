// A turned grid, whose rows are nearly on lines: Bowyer-Watson with rounded predicates goes wrong.

import { BESIDE } from "../methods/beside.js";

export default BESIDE;
