// The map from coordinates to pixels of a picture.

const MARGIN = 14;

export class Camera {
  constructor() {
    Object.assign(this, { scale: 1, x: 0, y: 0, width: 1, height: 1 });
  }

  /** Show all points. Halves, so that no difference of doubles overflows. */
  fit(points) {
    let [x0, y0, x1, y1] = [Infinity, Infinity, -Infinity, -Infinity];
    for (let k = 0; k < points.length; k += 2) {
      x0 = Math.min(x0, points[k]);
      x1 = Math.max(x1, points[k]);
      y0 = Math.min(y0, points[k + 1]);
      y1 = Math.max(y1, points[k + 1]);
    }
    [this.x, this.y] = [x0 / 2 + x1 / 2, y0 / 2 + y1 / 2];
    const [wide, high] = [x1 / 2 - x0 / 2, y1 / 2 - y0 / 2].map((half) => Math.max(half, 1e-300));
    const [width, height] = [this.width, this.height].map((size) => Math.max(size - 2 * MARGIN, 1));
    this.scale = Math.min(width / wide, height / high) / 2;
    this.home = this.scale;
  }

  px(x) {
    return (x - this.x) * this.scale + this.width / 2;
  }

  py(y) {
    return (this.y - y) * this.scale + this.height / 2;
  }

  /** Coordinates of a pixel. */
  at(px, py) {
    return [(px - this.width / 2) / this.scale + this.x, this.y - (py - this.height / 2) / this.scale];
  }

  pan(dx, dy) {
    this.x -= dx / this.scale;
    this.y += dy / this.scale;
  }

  /** Zoom by a factor; the coordinates at a pixel stay there. */
  zoom(factor, px = this.width / 2, py = this.height / 2) {
    const [x, y] = this.at(px, py);
    const least = this.home / 8;
    this.scale = Math.max(least, Math.min(this.scale * factor, this.home * 1e9));
    const [nx, ny] = this.at(px, py);
    this.x += x - nx;
    this.y += y - ny;
  }

  copy() {
    return Object.assign(new Camera(), this);
  }
}
