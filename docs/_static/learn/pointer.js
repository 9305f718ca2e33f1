// Pointer and keyboard: drag a point, click at a place, Tab to a point and move it with the arrows.

import { append } from "./dom.js";
import { short } from "./geometry.js";

const REACH = 22;
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
// Arrows move by this part of the width of the view, with Shift by a tenth of it.
const NUDGE = 1 / 50;
// An arrow turns a drawing in 3-D as a drag by so many pixels does.
const TURN = 12;

/** Let a figure hear pointer and keys. */
export function listen(figure) {
  const { canvas, kind } = figure;
  let held = -1;
  let start = null;
  let turning = false;

  canvas.addEventListener("pointerdown", (event) => {
    const [px, py] = place(event);
    start = [px, py];
    held = nearest(figure, px, py);
    turning = held < 0 && turns(figure, px, py);
    if (held >= 0 || turning) canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    const [px, py] = place(event);
    if (start && turning) {
      kind.turn(figure, px - start[0], py - start[1]);
      start = [px, py];
    } else if (held >= 0 && !figure.marking?.()) {
      const [x, y] = figure.paints[0].at(px, py);
      if (!figure.move(held, x, y)) held = -1;
    } else if (held >= 0) {
      band(figure, held, px, py);
    } else if (!start) {
      const over = nearest(figure, px, py) >= 0;
      canvas.style.cursor = over ? "grab" : turns(figure, px, py) ? "move" : "default";
    }
  });
  canvas.addEventListener("pointerup", (event) => {
    const [px, py] = place(event);
    const row = nearest(figure, px, py);
    if (start && kind.mark && figure.marking?.()) {
      mark(figure, held, row);
    } else if (start && Math.hypot(px - start[0], py - start[1]) < 4 && held < 0 && kind.click) {
      const panel = figure.paints.findIndex((paint) => paint.contains(px, py));
      if (panel >= 0) kind.click(figure, figure.paints[panel].at(px, py), panel);
    }
    [held, start] = [-1, null];
  });
  canvas.addEventListener("pointercancel", () => {
    [held, start] = [-1, null];
  });
  // A touch on a point drags it; elsewhere it scrolls the page.
  canvas.addEventListener(
    "touchstart",
    (event) => {
      const box = canvas.getBoundingClientRect();
      const { clientX, clientY } = event.touches[0];
      const [px, py] = [clientX - box.left, clientY - box.top];
      if (turns(figure, px, py) || nearest(figure, px, py) >= 0) event.preventDefault();
    },
    { passive: false },
  );
  if (kind.turn) addTurning(figure);
  if (!kind.fixed) addHandles(figure);
}

/** Whether a pixel is in a panel that shows a drawing in 3-D, which a drag turns. */
function turns(figure, px, py) {
  const { kind, paints } = figure;
  return paints.some((paint, i) => kind.panels[i].turns && paint.contains(px, py));
}

/** A Tab stop on the canvas: arrows turn the drawing in 3-D. */
function addTurning(figure) {
  figure.canvas.tabIndex = 0;
  figure.canvas.addEventListener("keydown", (event) => {
    const arrow = ARROWS[event.key];
    if (!arrow) return;
    event.preventDefault();
    figure.kind.turn(figure, TURN * arrow[0], -TURN * arrow[1]);
  });
}

function place(event) {
  return [event.offsetX, event.offsetY];
}

/** The row of the point under a pixel, or -1. */
function nearest(figure, px, py) {
  if (figure.kind.fixed) return -1;
  const { points } = figure;
  let [found, least] = [-1, REACH];
  for (const paint of figure.paints.slice(0, figure.kind.grips ?? 1)) {
    for (let row = 0; row < points.length / 2; row += 1) {
      const far = Math.hypot(paint.x(points[2 * row]) - px, paint.y(points[2 * row + 1]) - py);
      if (far < least) [found, least] = [row, far];
    }
  }
  return found;
}

/** A line from a point to the pointer, while two points are marked by a drag. */
function band(figure, row, px, py) {
  figure.draw();
  const [paint] = figure.paints;
  const { context, colors } = paint;
  context.beginPath();
  context.moveTo(paint.x(figure.points[2 * row]), paint.y(figure.points[2 * row + 1]));
  context.lineTo(px, py);
  context.setLineDash([6, 4]);
  context.lineWidth = 2;
  context.strokeStyle = colors.accent;
  context.stroke();
  context.setLineDash([]);
}

/** Tell the kind which two points were marked: by a drag, or one after the other. */
function mark(figure, from, to) {
  if (from < 0 || to < 0) {
    figure.marked = -1;
  } else if (from !== to) {
    figure.marked = -1;
    figure.kind.mark(figure, from, to);
    return;
  } else if ((figure.marked ?? -1) < 0 || figure.marked === to) {
    figure.marked = figure.marked === to ? -1 : to;
  } else {
    const first = figure.marked;
    figure.marked = -1;
    figure.kind.mark(figure, first, to);
    return;
  }
  figure.change(() => {});
}

/** A Tab stop on each point: arrows move it, Enter marks it. */
function addHandles(figure) {
  const handles = [];
  const count = Math.min(figure.points.length / 2, figure.kind.handles ?? 40);
  const row = append(figure.frame, "div", "live-handles");
  row.setAttribute("role", "group");
  row.setAttribute("aria-label", "Points: arrow keys move the one in focus");
  for (let i = 0; i < count; i += 1) {
    const handle = append(row, "button", "live-handle");
    handle.type = "button";
    handle.addEventListener("keydown", (event) => press(figure, i, event));
    handles.push(handle);
  }
  figure.placeHandles = () => {
    const { points, paints } = figure;
    handles.forEach((handle, i) => {
      const [x, y] = [points[2 * i], points[2 * i + 1]];
      handle.style.left = `${paints[0].x(x)}px`;
      handle.style.top = `${paints[0].y(y)}px`;
      handle.setAttribute("aria-label", `${nameOf(figure, i)} at ${short(x, 3)}, ${short(y, 3)}`);
    });
  };
}

function nameOf(figure, row) {
  return figure.kind.names?.[row] ?? `Point ${row}`;
}

function press(figure, row, event) {
  const arrow = ARROWS[event.key];
  if (arrow) {
    event.preventDefault();
    const [x0, , x1] = figure.kind.panels[0].view;
    const width = (x1 - x0) * NUDGE * (event.shiftKey ? 0.1 : 1);
    const far = Math.max(figure.kind.grid ?? 1, width);
    const [x, y] = [figure.points[2 * row], figure.points[2 * row + 1]];
    figure.move(row, x + far * arrow[0], y + far * arrow[1]);
  } else if (event.key === "Enter" && figure.kind.mark) {
    event.preventDefault();
    mark(figure, row, row);
  }
}
