// The shell of a figure: canvas, controls, status line, pointer and keyboard.
//
// A figure kind is an object:
//   panels    list of {view: [x0, y0, x1, y1], title}: what is drawn side by side
//   controls  list of controls besides the step, see controls.js
//   reset     text of the button that brings back the points of the page
//   ratio     height of the canvas divided by its width
//   fixed     true if points cannot be dragged; `handles`: at most so many points have a Tab stop
//   free      true if points can be moved without the core, too
//   states    function of {points, options, core, stored}: the list of states
// A state is {layers: [layers of panel 0, ...], say, mark}; `mark` is shown beside the slider instead
// of the number of the step. States are made together and never changed:
// the slider only selects one, so that going back shows the same picture.

import { addControls } from "./controls.js";
import { append } from "./dom.js";
import { listen } from "./pointer.js";
import { Paint } from "./paint.js";
import { NotStored, StoredCore } from "./stored.js";
import { colorsOf, watchTheme } from "./theme.js";

const WITHOUT_CORE =
  "This copy of the site comes without the compiled core: here only the stored steps can be shown. " +
  "In a clone of delone, `make site` builds one with it.";
const NARROW = 520;

export class Figure {
  constructor(element, kind, stored, core) {
    Object.assign(this, { element, kind, stored });
    this.core = core ?? new StoredCore(stored);
    this.points = Float64Array.from(stored.points.flat());
    this.options = Object.fromEntries(
      (kind.controls ?? []).filter((c) => c.name).map((c) => [c.name, c.value]),
    );
    this.step = 0;
    this.lastFrame = { update: 0, draw: 0, total: 0 };
    this.build();
    this.compute();
    this.step = Math.min(kind.first?.(this.states) ?? 0, this.states.length - 1);
    this.refresh();
    watchTheme(() => this.draw());
    new ResizeObserver(() => this.draw()).observe(this.frame);
  }

  build() {
    const { element } = this;
    element.querySelector(".live-picture")?.remove();
    this.frame = append(element, "div", "live-frame");
    this.canvas = append(this.frame, "canvas", "live-canvas");
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", element.dataset.alt);
    this.status = append(element, "p", "live-status");
    this.status.setAttribute("role", "status");
    this.controls = addControls(this);
    listen(this);
  }

  /** Make all states of the present points and options. */
  compute() {
    const { points, options, core, stored } = this;
    this.states = this.kind.states({ points, options, core, stored, figure: this });
    this.step = Math.min(this.step, this.states.length - 1);
  }

  get state() {
    return this.states[this.step];
  }

  /** Apply a change of points or options; where it has no answer, go back and say why. */
  change(apply) {
    const before = [this.points.slice(), { ...this.options }, this.step];
    const start = performance.now();
    try {
      apply(this);
      this.compute();
      this.refresh(start);
      return true;
    } catch (error) {
      [this.points, this.options, this.step] = before;
      this.compute();
      this.refresh();
      this.say(error instanceof NotStored ? WITHOUT_CORE : error.message);
      return false;
    }
  }

  move(row, x, y) {
    const [x0, y0, x1, y1] = this.kind.panels[0].view;
    const grid = this.kind.grid ?? 1;
    const at = (value, low, high) =>
      Math.round(Math.min(Math.max(value, low), high) / grid) * grid;
    return this.change((figure) => {
      figure.points = figure.points.slice();
      figure.points[2 * row] = at(x, x0, x1);
      figure.points[2 * row + 1] = at(y, y0, y1);
      figure.moved = row;
    });
  }

  show(step) {
    this.step = Math.min(Math.max(step, 0), this.states.length - 1);
    this.refresh();
  }

  reset() {
    this.change((figure) => {
      figure.points = Float64Array.from(figure.stored.points.flat());
      figure.options = { ...figure.controls.defaults };
      figure.step = 0;
      figure.marked = -1;
    });
  }

  refresh(start = performance.now()) {
    const computed = performance.now();
    this.draw();
    const end = performance.now();
    this.lastFrame = { update: computed - start, draw: end - computed, total: end - start };
    this.controls.refresh();
    this.say(this.state.say);
  }

  say(text) {
    if (this.status.textContent !== text) this.status.textContent = text;
  }

  /** The boxes of the panels in CSS pixels: side by side, one below the other if narrow. */
  boxes(width) {
    const { panels, ratio = 0.6 } = this.kind;
    const count = panels.length;
    const stacked = count > 1 && width < NARROW;
    const each = stacked || count === 1 ? width : width / count;
    const heights = panels.map((panel) => each * (panel.ratio ?? ratio));
    const tallest = Math.max(...heights);
    let top = 0;
    return panels.map((_, i) => {
      const height = stacked ? heights[i] : tallest;
      const box = { x: stacked ? 0 : i * each, y: stacked ? top : 0, width: each, height };
      top += height;
      return box;
    });
  }

  draw() {
    const width = this.frame.clientWidth;
    if (!width) return;
    const boxes = this.boxes(width);
    const height = Math.ceil(Math.max(...boxes.map((box) => box.y + box.height)));
    const density = window.devicePixelRatio || 1;
    if (this.canvas.width !== Math.round(width * density)
        || this.canvas.height !== Math.round(height * density)) {
      this.canvas.width = Math.round(width * density);
      this.canvas.height = Math.round(height * density);
      this.canvas.style.height = `${height}px`;
    }
    const context = this.canvas.getContext("2d");
    context.setTransform(density, 0, 0, density, 0, 0);
    const colors = colorsOf(this.element);
    this.paints = this.kind.panels.map(
      (panel, i) => new Paint(context, colors, this.state.views?.[i] ?? panel.view, boxes[i]),
    );
    if (this.kind.paint) {
      this.kind.paint(this, context);
    } else {
      context.clearRect(0, 0, width, height);
      this.paints.forEach((paint, i) => paint.draw(this.state.layers[i]));
    }
    this.paints.forEach((paint, i) => this.title(context, paint, this.kind.panels[i].title));
    this.placeHandles?.();
  }

  title(context, paint, text) {
    if (!text) return;
    context.font = "600 13px system-ui, sans-serif";
    context.textAlign = "center";
    context.textBaseline = "top";
    context.fillStyle = paint.colors.muted;
    context.fillText(text, paint.box.x + paint.box.width / 2, paint.box.y + 2);
  }
}
