/* Drawing of the layers of a view on its canvas: few paths, and only what is in the window.

   Edges shorter than a few pixels become gray levels of a grid of squares, and colored triangles are
   filled pixel by pixel, so that a frame takes time linear in the number of triangles and of pixels.
*/

import { rgbOf } from "./colors.js";

// Shorter edges merge into gray levels; a square of MERGED pixels has one level.
const MERGED = 3;
// More circles hide each other, and more dots the lines.
const MOST_CIRCLES = 3000;
const MOST_DOTS = 20000;
const FAR = 1e5; // pixels beyond which lines are clipped: canvases compute in single precision
const CHUNK = 4096; // segments of one path: rasterizers sort the segments of a path

const mix = (a, b, share) => a + share * (b - a);

/* A convex polygon cut to the window and a margin (Sutherland and Hodgman). */
function clipped(xy, [w, h]) {
  for (const [axis, sign, bound] of [[0, 1, -9], [0, -1, w + 9], [1, 1, -9], [1, -1, h + 9]]) {
    const kept = [];
    for (let i = 0; i < xy.length; i += 2) {
      const j = (i + 2) % xy.length;
      const from = sign * (xy[i + axis] - bound);
      const to = sign * (xy[j + axis] - bound);
      if (from >= 0) kept.push(xy[i], xy[i + 1]);
      if (from >= 0 !== to >= 0) {
        const share = from / (from - to);
        kept.push(mix(xy[i], xy[j], share), mix(xy[i + 1], xy[j + 1], share));
      }
    }
    xy = kept;
  }
  return xy;
}

/* Give all pixels whose centers are in a triangle a color. Rows and columns are half open, so that a
   center on a common edge belongs to one triangle. */
function fillPixels(pixels, width, height, color, ax, ay, bx, by, cx, cy) {
  const first = Math.max(0, Math.ceil(Math.min(ay, by, cy) - 0.5));
  const last = Math.min(height, Math.ceil(Math.max(ay, by, cy) - 0.5));
  for (let row = first; row < last; row++) {
    const y = row + 0.5;
    let from = Infinity;
    let to = -Infinity;
    if (ay <= y !== by <= y) {
      const x = ax + ((y - ay) / (by - ay)) * (bx - ax);
      from = to = x;
    }
    if (by <= y !== cy <= y) {
      const x = bx + ((y - by) / (cy - by)) * (cx - bx);
      if (x < from) from = x;
      if (x > to) to = x;
    }
    if (cy <= y !== ay <= y) {
      const x = cx + ((y - cy) / (ay - cy)) * (ax - cx);
      if (x < from) from = x;
      if (x > to) to = x;
    }
    const end = Math.min(width, Math.ceil(to - 0.5));
    for (let column = Math.max(0, Math.ceil(from - 0.5)); column < end; column++) {
      pixels[row * width + column] = color;
    }
  }
}

export class Painter {
  constructor(view) {
    this.view = view;
  }

  paint() {
    this.project();
    this.drawLayers();
    this.drawSelected();
  }

  /* Coordinates of all points on the screen. */
  project() {
    const p = this.view.mesh.points;
    const [w, h] = this.view.size;
    if (!this.screen || this.screen.length !== p.length) this.screen = new Float64Array(p.length);
    const [s, [cx, cy]] = [this.view.scale, this.view.center];
    for (let i = 0; i < p.length; i += 2) {
      this.screen[i] = w / 2 + (p[i] - cx) * s;
      this.screen[i + 1] = h / 2 - (p[i + 1] - cy) * s;
    }
  }

  drawLayers() {
    const { view } = this;
    const { colors, edges, mesh } = view;
    const thin = mesh.triangles.length > 9e3 ? 0.6 : 1;
    if (view.classes) this.drawFilled(view.classes);
    if (view.isOn("triangles")) this.strokeEdges(edges.ends, colors.edge, thin, true);
    if (view.isOn("circles")) this.drawCircles();
    if (view.isOn("dual")) this.drawDual();
    if (view.isOn("hull")) this.strokeEdges(mesh.hull || edges.rim, colors.hull, 2, false);
    if (view.isOn("constraints")) this.strokeEdges(mesh.constrained, colors.constraint, 2.5, false);
    if (view.isOn("points")) this.drawPoints();
  }

  /* A grid of squares for what is smaller than a pixel or two. */
  newGrid() {
    const [w, h] = this.view.size;
    const columns = Math.ceil(w / MERGED);
    const rows = Math.ceil(h / MERGED);
    return { columns, rows, count: new Float32Array(columns * rows) };
  }

  /* Paint a grid: `color` returns red, green, blue and alpha (0 to 1) of square i, or null. */
  paintGrid(grid, color) {
    const image = new ImageData(grid.columns, grid.rows);
    for (let i = 0; i < grid.count.length; i++) {
      const found = grid.count[i] ? color(i) : null;
      if (!found) continue;
      image.data.set(found, 4 * i);
    }
    const small = document.createElement("canvas");
    Object.assign(small, { width: grid.columns, height: grid.rows });
    small.getContext("2d").putImageData(image, 0, 0);
    this.view.context.imageSmoothingEnabled = true;
    this.view.context.drawImage(small, 0, 0, grid.columns * MERGED, grid.rows * MERGED);
  }

  /* Strokes of pairs of points; those shorter than MERGED pixels as gray levels, if wanted. */
  strokeEdges(ends, color, width, merging) {
    const [s, [w, h], context] = [this.screen, this.view.size, this.view.context];
    const grid = merging ? this.newGrid() : null;
    context.strokeStyle = color;
    context.lineWidth = width;
    context.beginPath();
    let [drawn, merged] = [0, 0];
    for (let e = 0; e < ends.length; e += 2) {
      const [a, b] = [2 * ends[e], 2 * ends[e + 1]];
      const x0 = s[a];
      const y0 = s[a + 1];
      const x1 = s[b];
      const y1 = s[b + 1];
      if ((x0 < 0 && x1 < 0) || (x0 > w && x1 > w) || (y0 < 0 && y1 < 0) || (y0 > h && y1 > h)) continue;
      const [dx, dy] = [x1 - x0, y1 - y0];
      if (grid && dx < MERGED && dx > -MERGED && dy < MERGED && dy > -MERGED) {
        const column = Math.floor((x0 + dx / 2) / MERGED);
        const row = Math.floor((y0 + dy / 2) / MERGED);
        if (column >= 0 && row >= 0 && column < grid.columns && row < grid.rows) {
          grid.count[row * grid.columns + column] += Math.sqrt(dx * dx + dy * dy);
        }
        merged++;
        continue;
      }
      this.line(x0, y0, x1, y1);
      if (++drawn % CHUNK === 0) {
        context.stroke();
        context.beginPath();
      }
    }
    context.stroke();
    if (merged) {
      const [r, g, b] = this.view.colors.ink;
      // A stroke of the width covers this share of the square.
      const share = width / (MERGED * MERGED);
      this.paintGrid(grid, (i) => [r, g, b, 255 * (1 - Math.exp(-grid.count[i] * share))]);
    }
    this.view.stats.edges += drawn;
    this.view.stats.merged += merged;
  }

  /* Add a line to the path, clipped if it reaches far beyond the window. */
  line(x0, y0, x1, y1) {
    if (Math.abs(x0) > FAR || Math.abs(y0) > FAR || Math.abs(x1) > FAR || Math.abs(y1) > FAR) {
      const [w, h] = this.view.size;
      let [from, to] = [0, 1];
      for (const [p, d, size] of [[x0, x1 - x0, w], [y0, y1 - y0, h]]) {
        if (!Number.isFinite(d) || (d === 0 && (p < -9 || p > size + 9))) return;
        if (d === 0) continue;
        const [t, u] = [(-9 - p) / d, (size + 9 - p) / d];
        from = Math.max(from, Math.min(t, u));
        to = Math.min(to, Math.max(t, u));
      }
      if (from > to) return;
      [x0, y0, x1, y1] = [mix(x0, x1, from), mix(y0, y1, from), mix(x0, x1, to), mix(y0, y1, to)];
    }
    this.view.context.moveTo(x0, y0);
    this.view.context.lineTo(x1, y1);
  }

  /* Triangles in colors: each pixel has the color of the triangle at its center. Paths would take
     ten times as long, and smoothing would leave gaps between neighbors. */
  drawFilled(classes) {
    const { view, screen: s } = this;
    const { triangles } = view.mesh;
    const { width, height } = view.canvas;
    const scale = view.colors[view.isOn("quality") ? "quality" : "values"];
    const image = new ImageData(width, height);
    const words = new Uint32Array(scale.length); // the bytes red, green, blue, alpha as one number
    new Uint8Array(words.buffer).set(scale.flatMap((each) => [...each, 255]));
    const pixels = new Uint32Array(image.data.buffer);
    const ratio = width / view.size[0];
    for (let t = 0; t < classes.length; t++) {
      if (classes[t] < 0) continue;
      const a = 2 * triangles[3 * t];
      const b = 2 * triangles[3 * t + 1];
      const c = 2 * triangles[3 * t + 2];
      fillPixels(
        pixels, width, height, words[classes[t]],
        s[a] * ratio, s[a + 1] * ratio, s[b] * ratio, s[b + 1] * ratio, s[c] * ratio, s[c + 1] * ratio,
      );
    }
    const layer = document.createElement("canvas");
    Object.assign(layer, { width, height });
    layer.getContext("2d").putImageData(image, 0, 0);
    view.context.drawImage(layer, 0, 0, ...view.size);
  }

  /* Add a triangle to the path, clipped to the window if it reaches far beyond. */
  triangle(ax, ay, bx, by, cx, cy) {
    const { context } = this.view;
    const most = Math.max(ax, bx, cx, ay, by, cy, -ax, -bx, -cx, -ay, -by, -cy);
    if (most < FAR) {
      context.moveTo(ax, ay);
      context.lineTo(bx, by);
      context.lineTo(cx, cy);
      context.closePath();
    } else if (Number.isFinite(most)) {
      const xy = clipped([ax, ay, bx, by, cx, cy], this.view.size);
      for (let i = 0; i < xy.length; i += 2) context[i ? "lineTo" : "moveTo"](xy[i], xy[i + 1]);
      context.closePath();
    }
  }

  drawCircles() {
    const [[w, h], c, context] = [this.view.size, this.view.circles, this.view.context];
    const shown = [];
    for (let i = 0; i < c.length && shown.length <= MOST_CIRCLES; i += 3) {
      const [x, y] = this.view.toScreen(c[i], c[i + 1]);
      const r = c[i + 2] * this.view.scale;
      if (x + r < 0 || x - r > w || y + r < 0 || y - r > h || !Number.isFinite(x + y + r)) continue;
      shown.push([x, y, r]);
    }
    this.view.stats.circlesOff = shown.length > MOST_CIRCLES;
    if (this.view.stats.circlesOff) return;
    this.view.stats.circles = shown.length;
    context.strokeStyle = this.view.colors.circle;
    context.lineWidth = 0.8;
    context.beginPath();
    for (const [x, y, r] of shown) this.circle(x, y, r);
    context.stroke();
  }

  /* Add a circle to the path; of a huge one the part in the window, as a chain of lines. */
  circle(x, y, r) {
    if (r < FAR) {
      this.view.context.moveTo(x + r, y);
      this.view.context.arc(x, y, r, 0, 2 * Math.PI);
      return;
    }
    const [w, h] = this.view.size;
    const toward = Math.atan2(h / 2 - y, w / 2 - x);
    const half = Math.min(Math.PI, (2 * (w + h)) / r);
    for (let i = 0; i < 64; i++) {
      const [from, to] = [i, i + 1].map((k) => toward + half * (k / 32 - 1));
      this.line(x + r * Math.cos(from), y + r * Math.sin(from), x + r * Math.cos(to), y + r * Math.sin(to));
    }
  }

  drawDual() {
    const { view } = this;
    const { context, scale, center: [cx, cy], size: [w, h], mesh: { dual } } = view;
    context.strokeStyle = view.colors.dual;
    context.lineWidth = 1;
    context.beginPath();
    for (let i = 0; i < dual.length; i += 4) {
      const x0 = w / 2 + (dual[i] - cx) * scale;
      const y0 = h / 2 - (dual[i + 1] - cy) * scale;
      const x1 = w / 2 + (dual[i + 2] - cx) * scale;
      const y1 = h / 2 - (dual[i + 3] - cy) * scale;
      if ((x0 < 0 && x1 < 0) || (x0 > w && x1 > w) || (y0 < 0 && y1 < 0) || (y0 > h && y1 > h)) continue;
      this.line(x0, y0, x1, y1);
      if (i % (4 * CHUNK) === 0) {
        context.stroke();
        context.beginPath();
      }
    }
    context.stroke();
  }

  drawPoints() {
    const [s, [w, h], context] = [this.screen, this.view.size, this.view.context];
    const grid = this.newGrid();
    const shown = [];
    for (let i = 0; i < s.length; i += 2) {
      if (!(s[i] >= 0 && s[i] < w && s[i + 1] >= 0 && s[i + 1] < h)) continue;
      if (shown.length < MOST_DOTS) shown.push(i);
      const square = Math.floor(s[i + 1] / MERGED) * grid.columns + Math.floor(s[i] / MERGED);
      grid.count[square] += 1;
    }
    if (shown.length >= MOST_DOTS) {
      const ink = rgbOf(this.view.colors.point);
      this.paintGrid(grid, (i) => [...ink, 255 * (1 - Math.exp(-grid.count[i] / 2))]);
      return;
    }
    const r = Math.max(1, Math.min(3.5, 60 / Math.sqrt(shown.length + 1)));
    context.fillStyle = this.view.colors.point;
    context.beginPath();
    for (const i of shown) {
      context.moveTo(s[i] + r, s[i + 1]);
      context.arc(s[i], s[i + 1], r, 0, 2 * Math.PI);
    }
    context.fill();
  }

  drawSelected() {
    if (!this.view.selected) return;
    const [s, context, { triangles }] = [this.screen, this.view.context, this.view.mesh];
    const { triangle: t, vertex: v } = this.view.selected;
    context.strokeStyle = context.fillStyle = this.view.colors.selected;
    context.lineWidth = 3;
    if (t >= 0) {
      const [a, b, c] = [0, 1, 2].map((k) => 2 * triangles[3 * t + k]);
      context.beginPath();
      this.triangle(s[a], s[a + 1], s[b], s[b + 1], s[c], s[c + 1]);
      context.globalAlpha = 0.35;
      context.fill();
      context.globalAlpha = 1;
      context.stroke();
    }
    if (t >= 0 && this.view.isOn("circles")) {
      const [x, y] = this.view.toScreen(this.view.circles[3 * t], this.view.circles[3 * t + 1]);
      const r = this.view.circles[3 * t + 2] * this.view.scale;
      context.beginPath();
      if (Number.isFinite(x + y + r)) this.circle(x, y, r);
      context.stroke();
    }
    if (v >= 0) {
      context.beginPath();
      context.arc(s[2 * v], s[2 * v + 1], 6, 0, 2 * Math.PI);
      context.stroke();
    }
  }

  /* The place where Enter picks. */
  drawCross() {
    const [w, h] = this.view.size;
    const context = this.view.context;
    context.strokeStyle = this.view.colors.hull;
    context.lineWidth = 1;
    context.beginPath();
    for (const [dx, dy] of [[9, 0], [0, 9]]) {
      context.moveTo(w / 2 - dx, h / 2 - dy);
      context.lineTo(w / 2 + dx, h / 2 + dy);
    }
    context.stroke();
  }
}
