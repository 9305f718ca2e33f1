// The controls of a figure: the slider of steps with its buttons, and those that its kind lists:
//   {kind: "range", name, label, min, max, step, value, unit}
//   {kind: "choice", name, label, value, options: [[value, text], ...]}
//   {kind: "toggle", name, label, value}
//   {kind: "button", label, press: (figure) => change}

import { append } from "./dom.js";

let number = 0;

/** Add the controls to a figure; `refresh` makes them show its step and options. */
export function addControls(figure) {
  const bar = append(figure.element, "div", "live-controls");
  const parts = [];
  if (figure.kind.step) parts.push(stepper(figure, bar));
  for (const control of figure.kind.controls ?? []) parts.push(MAKERS[control.kind](figure, bar, control));
  if (!figure.kind.still) {
    button(bar, figure.kind.reset ?? "Reset", () => figure.reset()).classList.add("live-reset");
  }
  return {
    defaults: { ...figure.options },
    refresh: () => parts.forEach((part) => part?.()),
  };
}

function button(parent, text, press, label = text) {
  const made = append(parent, "button", "live-button", text);
  made.type = "button";
  made.setAttribute("aria-label", label);
  made.addEventListener("click", press);
  return made;
}

function labelled(parent, tag, text) {
  const group = append(parent, "span", "live-group");
  const label = append(group, "label", "live-label", text);
  const input = append(group, tag, `live-${tag}`);
  input.id = `live-${(number += 1)}`;
  label.htmlFor = input.id;
  return { group, input, label };
}

function stepper(figure, bar) {
  const { group, input } = labelled(bar, "input", figure.kind.step);
  group.classList.add("live-stepper");
  Object.assign(input, { type: "range", min: 0, step: 1, className: "live-range live-step" });
  const back = button(group, "◀", () => figure.show(figure.step - 1), "Step back");
  const next = button(group, "▶", () => figure.show(figure.step + 1), "Step forward");
  back.classList.add("live-back");
  next.classList.add("live-next");
  group.insertBefore(back, input);
  const count = append(group, "span", "live-count");
  input.addEventListener("input", () => figure.show(Number(input.value)));
  return () => {
    const last = figure.states.length - 1;
    Object.assign(input, { max: last, disabled: last === 0 });
    input.value = figure.step;
    const { mark } = figure.state;
    input.setAttribute("aria-valuetext", mark ?? `${figure.step + 1} of ${last + 1}`);
    back.disabled = figure.step === 0;
    next.disabled = figure.step === last;
    count.textContent = mark ?? `${figure.step + 1} / ${last + 1}`;
  };
}

/** Set an option of a figure. */
function set(figure, name, value) {
  figure.change((changed) => {
    changed.options = { ...changed.options, [name]: value };
  });
}

const MAKERS = {
  range(figure, bar, { name, label, min, max, step, unit = "", text }) {
    const { group, input } = labelled(bar, "input", label);
    Object.assign(input, { type: "range", min, max, step, className: "live-range" });
    input.dataset.option = name;
    const count = append(group, "span", "live-count");
    input.addEventListener("input", () => {
      set(figure, name, Number(input.value));
    });
    return () => {
      const value = figure.options[name];
      input.value = value;
      const shown = text ? text(value) : `${value}${unit}`;
      input.setAttribute("aria-valuetext", shown);
      count.textContent = shown;
    };
  },

  choice(figure, bar, { name, label, options }) {
    const { input } = labelled(bar, "select", label);
    input.dataset.option = name;
    for (const [value, text] of options) append(input, "option", "", text).value = value;
    input.addEventListener("change", () => set(figure, name, input.value));
    return () => {
      input.value = figure.options[name];
    };
  },

  toggle(figure, bar, { name, label }) {
    const { group, input, label: words } = labelled(bar, "input", label);
    Object.assign(input, { type: "checkbox", className: "live-check" });
    input.dataset.option = name;
    group.insertBefore(input, words);
    input.addEventListener("change", () => set(figure, name, input.checked));
    return () => {
      input.checked = figure.options[name];
    };
  },

  button(figure, bar, { label, press }) {
    button(bar, label, () => figure.change(press));
    return null;
  },
};
