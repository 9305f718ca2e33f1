/* A canvas view of a 2-D triangle mesh: layers, zoom, picking and dragging. No dependencies except the
   modules next to this one: mesh.js, colors.js and paint.js.

   import { MeshView } from "./view.js";
   const view = new MeshView(element, { label: "Delaunay triangulation", onPick: console.log });
   view.setMesh({ points, triangles });

Mesh, the argument of `setMesh`; everything except `points` is optional:

   points       Float64Array of 2n numbers: x0, y0, x1, y1, ...
   triangles    Int32Array of 3m rows of points, in either orientation
   vertexIds    Int32Array of n numbers shown for the points; by default their rows. Periodic meshes
                draw copies of points: several rows have the same number
   circles      Float64Array of 3m numbers: center and radius for each triangle; computed if missing
   dual         Float64Array of 4k numbers: x, y of both ends of edges of the Voronoi diagram
   hull         Int32Array of 2h rows of points: edges of the hull; by default the edges with one
                triangle
   constrained  Int32Array of 2s rows of points: segments
   quality      Float64Array of m numbers, colors of layer "quality"; by default smallest angles
   qualityName  what they are, for texts: "smallest angle"; qualityRange: [low, high] of the colors
   values       Float64Array of n numbers, such as heights, colors of layer "values"; NaN for none
   valuesName   what they are; valuesRange: [low, high] of the colors

Options of the constructor:

   label        what the mesh is, for screen readers
   layers       { name: boolean }; the names are in LAYERS. Layers without data stay empty
   controls     true (default): a toolbar with a checkbox for each layer, and zoom buttons
   height       CSS height of the canvas, "480px" by default; the width is that of the element
   wheel        "zoom" (default), or "modifier": zoom with Ctrl or Cmd only, so that pages scroll
   theme        "auto" (default): of the page or the system; "light", "dark"
   picking      true (default): a click selects a triangle and shows its numbers
   onPick       called with { triangle, vertex, x, y } after a click or Enter; -1 for none
   onDrag       makes points movable; called with { vertex, x, y, phase }, where phase is "start",
                "move" or "end" and vertex a row of `points`. The view moves the point; answer with
                setMesh(mesh, { keepView: true })
   onLayers     called with `layers` after a click on a checkbox
   movable      function of a row of `points`: whether that point may be moved; by default all

Methods and attributes:

   setMesh(mesh, { keepView })      show other arrays; keepView: do not fit, and keep a selected
                                    point, but no triangle: other triangles have its number
   setLayers({ name: boolean })     switch layers; `layers` has the current state
   fit(), zoomBy(factor, px, py), panBy(dx, dy)      in CSS pixels
   toScreen(x, y), toWorld(px, py)  arrays of two numbers
   pick(px, py)                     { triangle, vertex, x, y } without selecting
   select({ triangle, vertex })     select by numbers; select(null) deselects. `selected` has them
   say(text)                        show a text below the canvas, which screen readers read
   describe(selected)               the sentence that the live region gets
   draw()                           draw in the next frame; drawNow() draws and returns milliseconds
   stats                            { milliseconds, edges, merged, circles, circlesOff } of the last
                                    frame: `merged` counts edges shorter than 3 pixels, which are
                                    drawn as gray levels
   destroy()                        remove everything from the element

Keys: arrows pan, + and - zoom, 0 fits, Enter picks at the center, PageDown and PageUp select the
next and previous triangle, Escape deselects.

Colors are CSS variables, --delone-paper, -edge, -hull, -constraint, -circle, -dual, -point,
-selected, and the lists --delone-quality and --delone-values of colors from low to high. COLORS has
the default values for light and dark pages.

Coordinates on the screen are rounded, so picking is too: it is for looking, not for computing.
*/

import { readColors, STEPS } from "./colors.js";
import { anglesOf, circlesOf, edgesOf, rangeOf, side } from "./mesh.js";
import { Painter } from "./paint.js";

export const LAYERS = [
  "triangles", "quality", "values", "circles", "dual", "hull", "constraints", "points",
];

const NAMES = {
  triangles: "triangles", quality: "quality", values: "values", circles: "circumcircles",
  dual: "Voronoi diagram", hull: "hull", constraints: "segments", points: "points",
};

const NEAR = 10; // pixels around a point within which a click means it

function element(tag, attributes = {}, style = {}, text = "") {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  Object.assign(made.style, style); // through the object model, which strict policies allow
  made.textContent = text;
  return made;
}

export class MeshView {
  constructor(host, options = {}) {
    this.options = {
      label: "Triangle mesh", controls: true, height: "480px", wheel: "zoom", theme: "auto",
      picking: true, ...options,
    };
    this.layers = {
      triangles: true, quality: false, values: false, circles: false, dual: false, hull: true,
      constraints: true, points: null, ...options.layers, // points: null: if there are few
    };
    this.selected = null;
    this.stats = {};
    this.center = [0, 0];
    this.scale = 1;
    this.pointers = new Map();
    this.painter = new Painter(this);
    this.build(host);
    this.listen();
    this.setMesh({ points: new Float64Array(0) });
  }

  // ---- Elements ------------------------------------------------------------------------------

  build(host) {
    this.root = element("div", { class: "delone-view" }, { position: "relative" });
    this.canvas = element("canvas", {
      class: "delone-canvas", tabindex: "0", role: "application",
      "aria-roledescription": "mesh view",
      "aria-label": `${this.options.label}. Arrow keys pan, plus and minus zoom, 0 fits, Enter ` +
        "picks at the center, Page Down and Page Up select triangles.",
    }, {
      display: "block", width: "100%", height: this.options.height, boxSizing: "border-box",
      touchAction: this.options.wheel === "modifier" ? "pan-y" : "none",
    });
    this.status = element("div", { class: "delone-status", role: "status", "aria-live": "polite" },
      { minHeight: "1.5em", font: "13px system-ui, sans-serif", padding: "4px 2px" });
    this.toolbar = element("div", { class: "delone-controls", role: "group", "aria-label": "Layers" },
      { font: "13px system-ui, sans-serif", display: "flex", flexWrap: "wrap", gap: "4px 12px",
        alignItems: "center", padding: "4px 2px" });
    if (this.options.controls) this.root.append(this.toolbar);
    this.root.append(this.canvas, this.status);
    host.append(this.root);
    this.context = this.canvas.getContext("2d");
  }

  /* Checkboxes for the layers that have data, and buttons. */
  fillToolbar() {
    if (!this.options.controls) return;
    const focused = document.activeElement && document.activeElement.dataset.layer;
    this.toolbar.replaceChildren();
    for (const [text, title, act] of [
      ["fit", "Show everything", () => this.fit()],
      ["+", "Zoom in", () => this.zoomBy(1.5)],
      ["\u2212", "Zoom out", () => this.zoomBy(1 / 1.5)],
    ]) {
      const button = element("button", { type: "button", title, "aria-label": title }, {}, text);
      button.addEventListener("click", act);
      this.toolbar.append(button);
    }
    for (const name of LAYERS.filter((each) => this.hasLayer(each))) {
      const label = element("label", {}, { display: "inline-flex", gap: "4px" });
      const box = element("input", { type: "checkbox", "data-layer": name });
      box.checked = this.isOn(name);
      box.addEventListener("change", () => {
        this.setLayers({ [name]: box.checked });
        if (this.options.onLayers) this.options.onLayers({ ...this.layers });
      });
      label.append(box, this.layerName(name));
      this.toolbar.append(label);
      if (name === focused) box.focus();
    }
  }

  layerName(name) {
    if (name === "quality") return this.mesh.qualityName || "smallest angle";
    return name === "values" ? this.mesh.valuesName || "values" : NAMES[name];
  }

  hasLayer(name) {
    const mesh = this.mesh;
    if (name === "points") return mesh.points.length > 0;
    if (name === "values" || name === "dual") return Boolean(mesh[name]);
    if (name === "constraints") return Boolean(mesh.constrained);
    if (name === "hull") return Boolean(mesh.hull) || mesh.triangles.length > 0;
    return mesh.triangles.length > 0;
  }

  isOn(name) {
    const set = this.layers[name];
    return this.hasLayer(name) && (set === null ? this.mesh.points.length <= 4000 : Boolean(set));
  }

  // ---- Data ----------------------------------------------------------------------------------

  setMesh(mesh, { keepView = false } = {}) {
    this.mesh = { triangles: new Int32Array(0), ...mesh };
    this.edges = edgesOf(this.mesh.triangles, this.mesh.points.length / 2);
    this.made = {}; // what is computed on first use: circles, quality, colors
    this.lastTriangle = 0;
    const vertex = keepView && this.selected ? this.selected.vertex : -1;
    const stays = vertex >= 0 && vertex < this.mesh.points.length / 2;
    this.selected = stays ? { triangle: -1, vertex } : null;
    if (!keepView) {
      this.say("");
      this.fit();
    }
    this.fillToolbar();
    this.draw();
  }

  setLayers(changed) {
    Object.assign(this.layers, changed);
    this.fillToolbar();
    this.draw();
  }

  get circles() {
    return (this.made.circles ??= this.mesh.circles || circlesOf(this.mesh.points, this.mesh.triangles));
  }

  get quality() {
    return (this.made.quality ??= this.mesh.quality || anglesOf(this.mesh.points, this.mesh.triangles));
  }

  /* The color number of each triangle, 0 to STEPS - 1, or -1 for none; null without a layer. */
  get classes() {
    const layer = ["quality", "values"].find((name) => this.isOn(name));
    if (!layer) return null;
    if (this.made.layer !== layer) {
      Object.assign(this.made, { layer, classes: this.classesOf(layer) });
    }
    return this.made.classes;
  }

  classesOf(layer) {
    const { triangles, values } = this.mesh;
    const of = layer === "quality" ? this.quality : values;
    const given = this.mesh[`${layer}Range`];
    const [low, high] = given || (this.mesh.quality || layer === "values" ? rangeOf(of) : [0, 60]);
    const out = new Int8Array(triangles.length / 3);
    for (let t = 0; t < out.length; t++) {
      const value = layer === "quality" ? of[t] :
        (of[triangles[3 * t]] + of[triangles[3 * t + 1]] + of[triangles[3 * t + 2]]) / 3;
      const share = (value - low) / (high - low);
      out[t] = Number.isNaN(share) ? -1 : Math.max(0, Math.min(STEPS - 1, Math.floor(share * STEPS)));
    }
    return out;
  }

  // ---- The window ----------------------------------------------------------------------------

  /* Read the size of the canvas, in CSS pixels; `size` is what was read last. */
  measure() {
    this.size = [this.canvas.clientWidth || 640, this.canvas.clientHeight || 480];
    return this.size;
  }

  fit() {
    const p = this.mesh.points;
    const [w, h] = this.measure();
    let [left, right, low, high] = [Infinity, -Infinity, Infinity, -Infinity];
    for (let i = 0; i < p.length; i += 2) {
      if (p[i] < left) left = p[i];
      if (p[i] > right) right = p[i];
      if (p[i + 1] < low) low = p[i + 1];
      if (p[i + 1] > high) high = p[i + 1];
    }
    if (!p.length) [left, right, low, high] = [0, 1, 0, 1];
    // Halves, since the difference of two doubles may exceed their range.
    this.center = [left / 2 + right / 2, low / 2 + high / 2];
    const fits = Math.min((0.46 * w) / (right / 2 - left / 2), (0.46 * h) / (high / 2 - low / 2));
    this.scale = Number.isFinite(fits) && fits > 0 ? fits : 1;
    this.fitted = true;
    this.draw();
  }

  toScreen(x, y) {
    const [w, h] = this.size;
    return [w / 2 + (x - this.center[0]) * this.scale, h / 2 - (y - this.center[1]) * this.scale];
  }

  toWorld(px, py) {
    const [w, h] = this.size;
    return [this.center[0] + (px - w / 2) / this.scale, this.center[1] - (py - h / 2) / this.scale];
  }

  zoomBy(factor, px = this.size[0] / 2, py = this.size[1] / 2) {
    const [x, y] = this.toWorld(px, py);
    const scale = this.scale * factor;
    if (!(scale > 1e-300 && scale < 1e300)) return;
    this.scale = scale;
    const [qx, qy] = this.toScreen(x, y);
    this.panBy(px - qx, py - qy);
  }

  panBy(dx, dy) {
    this.center = [this.center[0] - dx / this.scale, this.center[1] + dy / this.scale];
    this.fitted = false;
    this.draw();
  }

  // ---- Picking -------------------------------------------------------------------------------

  pick(px, py) {
    const [x, y] = this.toWorld(px, py);
    return { triangle: this.triangleAt(x, y), vertex: this.vertexAt(px, py), x, y };
  }

  /* Whether a point is on the inner side of all edges: -1, or the first edge it is beyond. */
  beyond(t, x, y) {
    const { points, triangles } = this.mesh;
    const [a, b, c] = [triangles[3 * t], triangles[3 * t + 1], triangles[3 * t + 2]];
    const turn = side(points, a, b, points[2 * c], points[2 * c + 1]) < 0 ? -1 : 1;
    if (turn * side(points, b, c, x, y) < 0) return 0;
    if (turn * side(points, c, a, x, y) < 0) return 1;
    return turn * side(points, a, b, x, y) < 0 ? 2 : -1;
  }

  /* Walks over neighbors, from the triangle of the last call; holes and rounding end the walk. */
  triangleAt(x, y) {
    const m = this.mesh.triangles.length / 3;
    let t = this.lastTriangle < m ? this.lastTriangle : 0;
    for (let step = 0; m && step < 4 * Math.sqrt(m) + 16; step++) {
      const k = this.beyond(t, x, y);
      if (k < 0) return (this.lastTriangle = t);
      const next = this.edges.neighbors[3 * t + k];
      if (next < 0) break;
      t = next;
    }
    for (t = 0; t < m; t++) if (this.beyond(t, x, y) < 0) return (this.lastTriangle = t);
    return -1;
  }

  /* The nearest point within NEAR pixels. */
  vertexAt(px, py) {
    const p = this.mesh.points;
    const [x, y] = this.toWorld(px, py);
    let best = NEAR / this.scale;
    let found = -1;
    for (let i = 0; i < p.length; i += 2) {
      const dx = p[i] - x;
      const dy = p[i + 1] - y;
      if (dx > best || dx < -best || dy > best || dy < -best) continue;
      const distance = Math.hypot(dx, dy);
      if (distance < best) {
        best = distance;
        found = i / 2;
      }
    }
    return found;
  }

  select(selected) {
    const { triangle = -1, vertex = -1, ...rest } = selected || {};
    this.selected = triangle < 0 && vertex < 0 ? null : { triangle, vertex, ...rest };
    this.say(this.describe(this.selected));
    this.draw();
  }

  say(text) {
    this.status.textContent = text;
  }

  idOf(vertex) {
    return this.mesh.vertexIds ? this.mesh.vertexIds[vertex] : vertex;
  }

  describe(selected) {
    if (!selected) return "";
    const { triangles, points, values } = this.mesh;
    const said = [];
    const { triangle: t, vertex: v } = selected;
    if (t >= 0) {
      const corners = [0, 1, 2].map((k) => this.idOf(triangles[3 * t + k]));
      const quality = Number(this.quality[t].toPrecision(4));
      said.push(`Triangle ${t}: vertices ${corners.join(", ")}; ${this.layerName("quality")} ${quality}.`);
    }
    if (v >= 0) {
      const known = values && !Number.isNaN(values[v]);
      const value = known ? `; ${this.layerName("values")} ${values[v]}` : "";
      said.push(`Point ${this.idOf(v)} at (${points[2 * v]}, ${points[2 * v + 1]})${value}.`);
    }
    return said.join(" ");
  }

  picked(px, py) {
    const found = this.pick(px, py);
    this.select(found);
    if (!this.selected) this.say("No triangle here.");
    if (this.options.onPick) this.options.onPick(found);
  }

  /* Select the next or previous triangle and move to it if it is outside the window. */
  step(by) {
    const m = this.mesh.triangles.length / 3;
    if (!m) return;
    const last = this.selected ? this.selected.triangle : by > 0 ? -1 : 0;
    const triangle = (last + by + m) % m;
    const corners = [0, 1, 2].map((k) => this.mesh.triangles[3 * triangle + k]);
    const [x, y] = [0, 1].map((j) => corners.reduce((sum, v) => sum + this.mesh.points[2 * v + j] / 3, 0));
    const [px, py] = this.toScreen(x, y);
    const [w, h] = this.size;
    if (!(px > 0 && px < w && py > 0 && py < h)) this.panBy(w / 2 - px, h / 2 - py);
    this.select({ triangle, vertex: -1 });
    if (this.options.onPick) this.options.onPick({ triangle, vertex: -1, x, y });
  }

  // ---- Input ---------------------------------------------------------------------------------

  listen() {
    const stop = (this.stopped = new AbortController());
    const on = (target, name, act, more) =>
      target.addEventListener(name, act, { signal: stop.signal, ...more });
    on(this.canvas, "pointerdown", (event) => this.pressed(event));
    on(this.canvas, "pointermove", (event) => this.moved(event));
    on(this.canvas, "pointerup", (event) => this.released(event));
    on(this.canvas, "pointercancel", (event) => this.released(event));
    on(this.canvas, "keydown", (event) => this.typed(event));
    on(this.canvas, "focus", () => this.draw());
    on(this.canvas, "blur", () => this.draw());
    on(this.canvas, "wheel", (event) => this.wheeled(event), { passive: false });
    on(matchMedia("(prefers-color-scheme: dark)"), "change", () => this.recolor());
    on(window, "resize", () => this.draw()); // also where only the size of pixels changes
    this.resized = new ResizeObserver(() => (this.fitted ? this.fit() : this.draw()));
    this.resized.observe(this.canvas);
    this.themed = new MutationObserver(() => this.recolor());
    for (const each of [document.documentElement, document.body]) {
      this.themed.observe(each, {
        attributes: true, attributeFilter: ["data-theme", "class", "style", "data-jp-theme-light"],
      });
    }
  }

  recolor() {
    this.palette = null;
    this.draw();
  }

  at(event) {
    const box = this.canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  pressed(event) {
    if (event.button) return;
    const [px, py] = this.at(event);
    this.canvas.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, [px, py]);
    this.press = { px, py, far: false, vertex: -1, grip: [0, 0] };
    const movable = this.options.movable || (() => true);
    if (this.options.onDrag && this.pointers.size === 1) {
      const vertex = this.vertexAt(px, py);
      if (vertex >= 0 && movable(vertex)) {
        const [vx, vy] = this.toScreen(...this.mesh.points.slice(2 * vertex, 2 * vertex + 2));
        Object.assign(this.press, { vertex, grip: [vx - px, vy - py] });
      }
    }
  }

  moved(event) {
    const [px, py] = this.at(event);
    const before = this.pointers.get(event.pointerId);
    if (!before) {
      if (this.options.onDrag) this.canvas.style.cursor = this.vertexAt(px, py) < 0 ? "" : "move";
      return;
    }
    const press = this.press;
    const others = [...this.pointers].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
    this.pointers.set(event.pointerId, [px, py]);
    if (others.length) {
      press.far = true;
      this.pinched(before, [px, py], others[0]);
      return;
    }
    const starts = !press.far && Math.hypot(px - press.px, py - press.py) > 3;
    press.far ||= starts;
    if (!press.far) return;
    if (press.vertex >= 0) this.dragged(px, py, starts ? "start" : "move");
    else this.panBy(px - before[0], py - before[1]);
  }

  pinched(before, now, other) {
    const was = Math.hypot(before[0] - other[0], before[1] - other[1]);
    const is = Math.hypot(now[0] - other[0], now[1] - other[1]);
    this.panBy((now[0] - before[0]) / 2, (now[1] - before[1]) / 2);
    if (was > 1) this.zoomBy(is / was, (now[0] + other[0]) / 2, (now[1] + other[1]) / 2);
  }

  /* Move the point in a copy of the array, whose owner may share it. */
  dragged(px, py, phase) {
    const { vertex, grip } = this.press;
    const [x, y] = this.toWorld(px + grip[0], py + grip[1]);
    if (vertex >= this.mesh.points.length / 2) return;
    if (!this.made.moved) {
      this.mesh.points = Float64Array.from(this.mesh.points);
      this.made = { moved: true };
    }
    this.mesh.points[2 * vertex] = x;
    this.mesh.points[2 * vertex + 1] = y;
    this.options.onDrag({ vertex, x, y, phase });
    this.draw();
  }

  released(event) {
    if (!this.pointers.delete(event.pointerId) || this.pointers.size) return;
    const [px, py] = this.at(event);
    if (this.press.far && this.press.vertex >= 0) this.dragged(px, py, "end");
    else if (!this.press.far && this.options.picking && event.type === "pointerup") this.picked(px, py);
  }

  wheeled(event) {
    if (this.options.wheel === "modifier" && !event.ctrlKey && !event.metaKey) return;
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 16 : 1; // deltas in lines or in pixels
    const delta = Math.max(-120, Math.min(120, event.deltaY * lines));
    this.zoomBy(Math.exp(-delta / 250), ...this.at(event));
  }

  typed(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const [w, h] = this.size;
    const acts = {
      ArrowLeft: () => this.panBy(w / 10, 0), ArrowRight: () => this.panBy(-w / 10, 0),
      ArrowUp: () => this.panBy(0, h / 10), ArrowDown: () => this.panBy(0, -h / 10),
      "+": () => this.zoomBy(1.25), "=": () => this.zoomBy(1.25), "-": () => this.zoomBy(0.8),
      0: () => this.fit(), Enter: () => this.picked(w / 2, h / 2),
      PageDown: () => this.step(1), PageUp: () => this.step(-1), Escape: () => this.select(null),
    };
    if (!acts[event.key]) return;
    event.preventDefault();
    acts[event.key]();
  }

  // ---- Drawing -------------------------------------------------------------------------------

  draw() {
    if (this.frame || this.stopped.signal.aborted) return;
    this.frame = requestAnimationFrame(() => this.drawNow());
  }

  get colors() {
    return (this.palette ??= readColors(this.root, this.options.theme));
  }

  drawNow() {
    const start = performance.now();
    if (this.frame) cancelAnimationFrame(this.frame);
    this.frame = 0;
    const [w, h] = this.measure();
    const ratio = window.devicePixelRatio || 1;
    const [width, height] = [Math.round(w * ratio), Math.round(h * ratio)];
    if (this.canvas.width !== width || this.canvas.height !== height) {
      Object.assign(this.canvas, { width, height });
    }
    const context = this.context;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.fillStyle = this.colors.paper;
    context.fillRect(0, 0, w, h);
    context.lineJoin = "round";
    this.stats = { edges: 0, merged: 0, circles: 0, circlesOff: false };
    this.painter.paint();
    if (this.canvas.matches(":focus-visible")) this.painter.drawCross();
    this.stats.milliseconds = performance.now() - start;
    return this.stats.milliseconds;
  }

  destroy() {
    this.stopped.abort();
    this.resized.disconnect();
    this.themed.disconnect();
    if (this.frame) cancelAnimationFrame(this.frame);
    this.root.remove();
  }
}
