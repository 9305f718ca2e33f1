// Colors of the figures: read from the style sheet, so that light and dark mode are one mechanism.

const NAMES = [
  "text", "muted", "edge", "point", "accent", "second", "third", "fill", "other", "bad", "paper",
];

/** The colors of a figure as an object, from the properties --live-NAME of its element. */
export function colorsOf(element) {
  const style = getComputedStyle(element);
  return Object.fromEntries(
    NAMES.map((name) => [name, style.getPropertyValue(`--live-${name}`).trim()]),
  );
}

/** Call a function whenever the theme of the page or of the system changes. */
export function watchTheme(changed) {
  const page = document.documentElement;
  new MutationObserver(changed).observe(page, { attributeFilter: ["data-theme"] });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", changed);
}
