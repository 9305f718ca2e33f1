// Points nearly on a circle: Bowyer-Watson with rounded predicates goes wrong.

import { BESIDE } from "../methods/beside.js";

export default BESIDE;
