// node node.mjs FOLDER < cases.json > answers.json
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

import { answers } from "./cases.js";

const { load } = await import(pathToFileURL(`${process.argv[2]}/delone.js`));
const cases = JSON.parse(readFileSync(0, "utf8"));
process.stdout.write(JSON.stringify(answers(await load(), cases)));
