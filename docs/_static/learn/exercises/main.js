// The exercises of a page: each element with data-exercise gets what an answer needs, and a verdict.
//
// The answer with its reason is in the page, closed; it opens when it is found. Nothing is stored,
// and nothing leaves the page.

import { append } from "../dom.js";
import { CHECKS } from "./checks.js";

let count = 0;

class Exercise {
  constructor(element) {
    this.element = element;
    this.solution = element.querySelector(".exercise-solution");
    this.task = element.querySelector(".exercise-task");
    this.task.id ||= `exercise-${(count += 1)}`;
    this.bar = append(element, "div", "exercise-bar");
    this.verdict = append(element, "p", "exercise-verdict");
    this.verdict.setAttribute("role", "status");
    element.insertBefore(this.bar, this.solution);
    element.insertBefore(this.verdict, this.solution);
    MAKERS[element.dataset.exercise](this);
  }

  button(text, press) {
    const made = append(this.bar, "button", "live-button", text);
    made.type = "button";
    made.addEventListener("click", press);
    return made;
  }

  /** Say that the answer is right, and show why. */
  right() {
    this.say("right", "Right.");
    this.solution.open = true;
  }

  wrong(reason) {
    this.say("wrong", reason ? `Wrong. ${reason}` : "Wrong. Try again.");
  }

  /** Say what is missing; the answer is not judged. */
  ask(text) {
    this.say("open", text);
  }

  say(kind, text) {
    this.element.dataset.verdict = kind;
    this.verdict.textContent = text;
  }
}

const MAKERS = {
  number(exercise) {
    const { answer, tolerance, hints } = exercise.element.dataset;
    const said = JSON.parse(hints);
    const input = append(exercise.bar, "input", "exercise-number");
    Object.assign(input, { type: "text", inputMode: "decimal", autocomplete: "off" });
    input.setAttribute("aria-labelledby", exercise.task.id);
    const check = () => {
      const given = numberOf(input.value);
      if (given === null) {
        exercise.ask("Write a number.");
      } else if (Math.abs(given - Number(answer)) <= Number(tolerance)) {
        exercise.right();
      } else {
        const near = Object.keys(said).find(
          (key) => key && Math.abs(given - Number(key)) <= Number(tolerance),
        );
        exercise.wrong(said[near ?? ""]);
      }
    };
    input.addEventListener("keydown", (event) => {
      if (event.key === "Enter") check();
    });
    exercise.button("Check", check);
  },

  choice(exercise) {
    const choices = JSON.parse(exercise.element.dataset.choices);
    const group = append(exercise.bar, "div", "exercise-choices");
    group.setAttribute("role", "radiogroup");
    group.setAttribute("aria-labelledby", exercise.task.id);
    const inputs = choices.map(([text]) => {
      const label = append(group, "label", "exercise-choice");
      const input = append(label, "input", "exercise-radio");
      Object.assign(input, { type: "radio", name: `choice-${exercise.task.id}` });
      append(label, "span", "exercise-text", text);
      return input;
    });
    exercise.button("Check", () => {
      const chosen = inputs.findIndex((input) => input.checked);
      if (chosen < 0) {
        exercise.ask("Choose an answer.");
      } else if (choices[chosen][1] === "") {
        exercise.right();
      } else {
        exercise.wrong(choices[chosen][1]);
      }
    });
  },

  figure(exercise) {
    const { figure: name, check } = exercise.element.dataset;
    const found = () => window.deloneFigures?.[name];
    exercise.button("Check the figure", () => {
      const figure = found();
      if (!figure) {
        exercise.ask("The figure is still loading.");
      } else if (!figure.core.live && !figure.kind.free) {
        exercise.ask(
          "This copy of the site comes without the compiled core, so its figures cannot be changed.",
        );
      } else {
        const missing = CHECKS[check](figure);
        if (missing) exercise.say("wrong", `Not yet. ${missing}`);
        else exercise.right();
      }
    });
    exercise.button("Go to the figure", () => {
      const figure = found();
      figure?.element.scrollIntoView({ block: "center" });
      (figure?.element.querySelector(".live-handle") ?? figure?.canvas)?.focus({ preventScroll: true });
    });
  },
};

/** The number in a text, with or without separators of thousands; null if it is not one. */
export function numberOf(text) {
  const plain = text.trim().replace(/^[−–]/, "-").replace(/(\d)[ \u00a0\u202f'](?=\d{3}(?!\d))/g, "$1");
  const grouped = /^[+-]?\d{1,3}(,\d{3})+(\.\d+)?$/.test(plain) ? plain.replace(/,/g, "") : plain;
  const value = /^[+-]?(\d+([.,]\d*)?|[.,]\d+)(e[+-]?\d+)?$/i.test(grouped)
    ? Number(grouped.replace(",", "."))
    : NaN;
  return Number.isFinite(value) ? value : null;
}

window.deloneExercises = [...document.querySelectorAll("[data-exercise]")].map(
  (element) => new Exercise(element),
);
