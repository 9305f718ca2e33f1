// The picture of a scene, in two layers: a canvas in memory holds what has been drawn, the visible
// one shows it, moved or enlarged while the camera moves, with the dragged point on top.

import { Camera } from "./camera.js";
import { dotSize, drawing, projected } from "./draw.js";

// Milliseconds of drawing after which the page may do something else.
const SLICE = 10;
// Around what has changed, in pixels: half of a line or point.
const AROUND = 6;

const canvas = () => document.createElement("canvas");

export class Picture {
  constructor(visible, colors) {
    this.front = visible;
    this.colors = colors;
    this.camera = new Camera();
    this.shown = { triangles: true, cells: false, hull: true, points: true };
    this.scene = null;
    // Complete, for `drawn`, a camera; and the one that is being drawn.
    [this.back, this.next] = [canvas(), canvas()];
    this.drawn = null;
    this.job = null;
    this.marked = null;
    this.lastDraw = 0;
    // Whether the camera has moved since.
    this.stale = false;
  }

  setScene(scene) {
    this.scene = scene;
    this.marked = null;
    this.camera.fit(scene.points);
    this.draw();
  }

  /** Take the same triangles in another order: nothing has to be drawn. */
  exchange(scene) {
    scene.extent = this.scene.extent;
    this.scene = scene;
    this.show();
  }

  /** Take the size of the page. */
  resize(width, height, density) {
    const sizes = [Math.round(width * density), Math.round(height * density)];
    const { front, camera } = this;
    if (front.width === sizes[0] && front.height === sizes[1] && this.density === density) return;
    [front.width, front.height] = sizes;
    [this.next.width, this.next.height] = sizes;
    [camera.width, camera.height] = [width, height];
    this.density = density;
    this.drawn = null;
    if (this.scene && !camera.home) camera.fit(this.scene.points);
    this.draw();
  }

  /** Draw everything: at once what fits into a slice, the rest in further frames. */
  draw() {
    cancelAnimationFrame(this.waiting);
    clearTimeout(this.later);
    this.stale = false;
    const { scene, camera, next } = this;
    if (!scene || !camera.width) return;
    if (next.width !== this.front.width || next.height !== this.front.height) {
      [next.width, next.height] = [this.front.width, this.front.height];
    }
    const context = this.context(next);
    context.clearRect(0, 0, camera.width, camera.height);
    const taken = camera.copy();
    this.at = projected(scene.points, taken, this.at);
    this.job = { steps: this.steps(context, [0, 0, camera.width, camera.height]), taken };
    this.resume(0);
    if (this.job) this.show();
  }

  /** Draw on for a slice. */
  resume(spent) {
    cancelAnimationFrame(this.waiting);
    const start = performance.now();
    const { steps, taken } = this.job;
    do {
      if (!steps.next().done) continue;
      [this.back, this.next] = [this.next, this.back];
      [this.drawn, this.job] = [taken, null];
      this.lastDraw = spent + performance.now() - start;
      this.show();
      return;
    } while (performance.now() - start < SLICE);
    const sofar = spent + performance.now() - start;
    this.waiting = requestAnimationFrame(() => this.job && this.resume(sofar));
  }

  steps(context, area) {
    const { scene, camera, at, colors, shown, density } = this;
    // A line of one device pixel is drawn several times faster than a wider one.
    const hairline = 1 / density;
    return drawing(context, scene, { camera, at, colors, shown, area, hairline });
  }

  context(layer) {
    const context = layer.getContext("2d");
    context.setTransform(this.density, 0, 0, this.density, 0, 0);
    return context;
  }

  /** Copy what is drawn to the page, as the present camera sees it. */
  show() {
    const { camera, drawn, front } = this;
    const context = this.context(front);
    context.clearRect(0, 0, camera.width, camera.height);
    if (drawn) {
      const factor = camera.scale / drawn.scale;
      const [x, y] = drawn.at(0, 0);
      const [left, top] = [camera.px(x), camera.py(y)];
      context.drawImage(this.back, left, top, drawn.width * factor, drawn.height * factor);
    }
    this.drawMarked(context);
  }

  /** The camera has moved: show the picture there, and draw it anew, soon if that is slow. */
  moved() {
    if (this.lastDraw < SLICE) {
      this.draw();
      return;
    }
    cancelAnimationFrame(this.waiting);
    [this.job, this.stale] = [null, true];
    this.show();
    clearTimeout(this.later);
    this.later = setTimeout(() => this.draw(), 120);
  }

  /** Make an edit of the scene, and draw only where it has changed something. */
  edit(changes, row, x, y) {
    const { camera } = this;
    while (this.job) this.resume(0);
    if (!this.drawn || this.stale) {
      this.change(changes, row, x, y);
      this.draw();
      return;
    }
    const dirty = new Box();
    dirty.add(this.at, changes.gone, [row]);
    this.change(changes, row, x, y);
    [this.at[2 * row], this.at[2 * row + 1]] = [camera.px(x), camera.py(y)];
    // Triangles around the point may only have changed their shape.
    dirty.add(this.at, changes.added, this.marked.star, [row]);
    this.repaint(dirty.pixels(AROUND, camera));
  }

  change(changes, row, x, y) {
    const { scene } = this;
    scene.apply(changes);
    [scene.points[2 * row], scene.points[2 * row + 1]] = [x, y];
    this.marked = { row, star: scene.star(row) };
  }

  /** Draw a part again. */
  repaint(area) {
    const [left, top, right, bottom] = area;
    const context = this.context(this.back);
    context.save();
    context.beginPath();
    context.rect(left, top, right - left, bottom - top);
    context.clip();
    context.clearRect(left, top, right - left, bottom - top);
    for (const steps = this.steps(context, area); !steps.next().done; );
    context.restore();
    this.show();
  }

  /** Mark a point, and the triangles around it. */
  drawMarked(context) {
    if (!this.marked || !this.scene) return;
    const { row, star } = this.marked;
    const { scene, camera, colors } = this;
    const { points } = scene;
    const px = (v) => camera.px(points[2 * v]);
    const py = (v) => camera.py(points[2 * v + 1]);
    context.beginPath();
    for (let k = 0; k < star.length; k += 3) {
      context.moveTo(px(star[k]), py(star[k]));
      context.lineTo(px(star[k + 1]), py(star[k + 1]));
      context.lineTo(px(star[k + 2]), py(star[k + 2]));
      context.closePath();
    }
    context.globalAlpha = 0.45;
    context.fillStyle = colors.accent;
    context.fill();
    context.globalAlpha = 1;
    context.beginPath();
    context.arc(px(row), py(row), Math.max(dotSize(scene, camera), 3) + 2, 0, 2 * Math.PI);
    context.lineWidth = 2;
    context.strokeStyle = colors.accent;
    context.fillStyle = colors.paper;
    context.fill();
    context.stroke();
  }

  /** Mark a point. */
  mark(row) {
    this.marked = { row, star: this.scene.star(row) };
    this.show();
  }

  /** The row of the point that is nearest to a pixel, if it is closer than `reach`; else -1. */
  nearest(px, py, reach) {
    const { points } = this.scene;
    let [found, least] = [-1, reach];
    for (let row = 0; row < points.length / 2; row += 1) {
      const [dx, dy] = [this.camera.px(points[2 * row]) - px, this.camera.py(points[2 * row + 1]) - py];
      const far = Math.hypot(dx, dy);
      if (far < least) [found, least] = [row, far];
    }
    return found;
  }
}

/** A box around points of the screen. */
class Box {
  constructor() {
    Object.assign(this, { left: Infinity, top: Infinity, right: -Infinity, bottom: -Infinity });
  }

  add(at, ...lists) {
    for (const row of lists.flatMap((rows) => Array.from(rows))) {
      const [x, y] = [at[2 * row], at[2 * row + 1]];
      this.left = Math.min(this.left, x);
      this.right = Math.max(this.right, x);
      this.top = Math.min(this.top, y);
      this.bottom = Math.max(this.bottom, y);
    }
  }

  /** Whole pixels around it, in the picture. */
  pixels(around, { width, height }) {
    return [
      Math.max(0, Math.floor(this.left - around)),
      Math.max(0, Math.floor(this.top - around)),
      Math.min(width, Math.ceil(this.right + around)),
      Math.min(height, Math.ceil(this.bottom + around)),
    ];
  }
}
