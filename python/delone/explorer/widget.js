/* The notebook widget: a view of the trait `scene`, which sends picks, layers and moves to Python. */

import { show } from "./scene.js";

/* A copy of the bytes of a trait, aligned for typed arrays. */
const bytesOf = (data) => data.buffer.slice(data.byteOffset, data.byteOffset + data.byteLength);

function render({ model, el }) {
  const waiting = new Map(); // number of a move: how to settle its promise
  let last = 0;

  const move = (target) =>
    new Promise((resolve, reject) => {
      last += 1;
      const number = `${Date.now()}-${last}`;
      waiting.set(number, { resolve, reject });
      model.send({ kind: "move", number, ...target });
    });

  const shown = show(el, bytesOf(model.get("scene")), {
    layers: model.get("layers"),
    height: `${model.get("height")}px`,
    onPick({ triangle, vertex, x, y }) {
      const row = vertex >= 0 && shown.view.mesh.rows ? shown.view.mesh.rows[vertex] : vertex;
      model.set("selected", { triangle, vertex: row, x, y });
      model.save_changes();
    },
    onLayers(layers) {
      model.set("layers", layers);
      model.save_changes();
    },
  }, move);

  const changed = {
    "change:layers": () => shown.view.setLayers(model.get("layers")),
    "change:height": () => (shown.view.canvas.style.height = `${model.get("height")}px`),
    "msg:custom": ({ number, error }) => {
      const settled = waiting.get(number);
      waiting.delete(number);
      // The views of other cells take the scene of a move from the trait.
      if (!settled && !error) shown.replace(bytesOf(model.get("scene")), true);
      else if (settled && error) settled.reject(new Error(error));
      else if (settled) settled.resolve(bytesOf(model.get("scene")));
    },
  };
  for (const [event, act] of Object.entries(changed)) model.on(event, act);
  return () => {
    for (const [event, act] of Object.entries(changed)) model.off(event, act);
    shown.view.destroy();
  };
}

export default { render };
