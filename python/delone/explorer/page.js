/* The page of the command `delone explore`. */

import { show } from "./scene.js";

const host = document.getElementById("view");

/* The body of an answer; an error with the text of the server otherwise. */
async function bytes(answer) {
  if (!answer.ok) throw new Error((await answer.text()).trim() || `status ${answer.status}`);
  return answer.arrayBuffer();
}

const move = (target) =>
  fetch("move", { method: "POST", body: JSON.stringify(target) }).then(bytes, () => {
    throw new Error("The command has ended: start delone explore again.");
  });

try {
  const { name, scene } = await Promise.all([
    fetch("name").then((answer) => answer.text()),
    fetch("scene").then(bytes),
  ]).then(([name, scene]) => ({ name, scene }));
  document.title = `${name} - delone`;
  const shown = show(host, scene, { height: "auto" }, move);
  document.querySelector("h1").textContent = `${name}: ${shown.view.mesh.label}`;
  window.explored = shown.view; // for the console, and for tests
} catch (error) {
  host.textContent = `The mesh cannot be shown: ${error.message}`;
}
