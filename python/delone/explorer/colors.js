/* Colors of the view: CSS variables of the page, with defaults for light and dark pages. */

export const COLORS = {
  light: {
    paper: "#ffffff", edge: "#5b7083", hull: "#1d2a36", constraint: "#b3372f", circle: "#3f7f4f",
    dual: "#a0522d", point: "#16202a", selected: "#b000b8",
    quality: "#8c1d18,#dd7a4a,#f3d9a4,#a9c9dc,#3d6fa5",
    values: "#2b1d5c,#2f5d8c,#2f9585,#8cc152,#f7e34a",
  },
  dark: {
    paper: "#14181c", edge: "#7f93a6", hull: "#e6edf3", constraint: "#ff7b6b", circle: "#77c98a",
    dual: "#e0a070", point: "#f0f4f8", selected: "#ff6bff",
    quality: "#d9534a,#c9824f,#8f8560,#5c8fb0,#7fb2e5",
    values: "#4a3a8c,#3a6fa3,#35a893,#9ad05f,#f9ea6b",
  },
};

export const STEPS = 64; // colors of a scale

/* STEPS colors between the colors of a list, as arrays of red, green and blue. */
export function scaleOf(list) {
  const stops = list.split(",").map((each) => rgbOf(each.trim()));
  return Array.from({ length: STEPS }, (_, i) => {
    const at = (i / (STEPS - 1)) * (stops.length - 1);
    const k = Math.min(Math.floor(at), stops.length - 2);
    return [0, 1, 2].map((j) => Math.round(stops[k][j] + (at - k) * (stops[k + 1][j] - stops[k][j])));
  });
}

const probe = typeof OffscreenCanvas === "undefined" ? null : new OffscreenCanvas(1, 1);

/* Red, green and blue of any CSS color, which a canvas converts to #rrggbb or rgba(). */
export function rgbOf(color) {
  const context = (probe || document.createElement("canvas")).getContext("2d");
  context.fillStyle = "#000000";
  context.fillStyle = color;
  const found = context.fillStyle;
  if (found[0] === "#") return [1, 3, 5].map((i) => parseInt(found.slice(i, i + 2), 16));
  return found.match(/[\d.]+/g).slice(0, 3).map(Number);
}

/* Whether a dark page is wanted: by the option, the page (Sphinx, Jupyter, VS Code) or the system. */
function isDark(theme) {
  if (theme !== "auto") return theme === "dark";
  const { documentElement: html, body } = document;
  if (html.dataset.theme === "dark" || html.dataset.theme === "light") return html.dataset.theme === "dark";
  if (body.dataset.jpThemeLight) return body.dataset.jpThemeLight === "false";
  if (body.classList.contains("vscode-dark")) return true;
  if (body.classList.contains("vscode-light")) return false;
  return matchMedia("(prefers-color-scheme: dark)").matches;
}

/* The colors of an element: its CSS variables, or COLORS. */
export function readColors(root, theme) {
  const style = getComputedStyle(root);
  const defaults = COLORS[isDark(theme) ? "dark" : "light"];
  const found = {};
  for (const [name, color] of Object.entries(defaults)) {
    found[name] = style.getPropertyValue(`--delone-${name}`).trim() || color;
  }
  for (const name of ["quality", "values"]) found[name] = scaleOf(found[name]);
  found.ink = rgbOf(found.edge);
  return found;
}
