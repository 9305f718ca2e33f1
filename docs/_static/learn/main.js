// Starts the figures of a page: each element with data-live="NAME" is run by figures/NAME.js.

import { Figure } from "./shell.js";

window.deloneFigures = {};
let loading = null;

/** The compiled core, loaded once for all figures, or null where the site has none. */
function liveCore(element) {
  if (element.dataset.core !== "yes") return Promise.resolve(null);
  loading ??= import("./live.js")
    .then((module) => module.load())
    .catch((error) => {
      console.warn(`the compiled core cannot be loaded: ${error.message}`);
      return null;
    });
  return loading;
}

async function start(element) {
  const { live: name, stored: file } = element.dataset;
  const [module, stored, core] = await Promise.all([
    import(`./figures/${name}.js`),
    fetch(file).then((response) => response.json()),
    liveCore(element),
  ]);
  window.deloneFigures[name] = new Figure(element, module.default, stored, core);
}

const elements = [...document.querySelectorAll("[data-live]")];
window.deloneReady = Promise.all(elements.map(start));
