// What is shown: points and triangles, which edits change in place.

export class Scene {
  constructor({ points, triangles, hull, rim }) {
    Object.assign(this, { points, triangles, hull, rim });
    this.count = triangles.length / 3;
    this.cells = null;
    this.edited = false;
  }

  /** The box around all points. */
  box() {
    let [x0, y0, x1, y1] = [Infinity, Infinity, -Infinity, -Infinity];
    for (let k = 0; k < this.points.length; k += 2) {
      x0 = Math.min(x0, this.points[k]);
      x1 = Math.max(x1, this.points[k]);
      y0 = Math.min(y0, this.points[k + 1]);
      y1 = Math.max(y1, this.points[k + 1]);
    }
    return [x0, y0, x1, y1];
  }

  /** The triangles around a point, as rows. */
  star(row) {
    const found = [];
    const { triangles, count } = this;
    for (let k = 0; k < 3 * count; k += 1) {
      if (triangles[k] === row) found.push(...triangles.subarray(k - (k % 3), k - (k % 3) + 3));
    }
    return found;
  }

  /** Make an edit: triangles are written to their places. */
  apply({ gone, added, hull, count, writes }) {
    this.count = count;
    if (3 * count > this.triangles.length) {
      const larger = new Int32Array(6 * count);
      larger.set(this.triangles);
      this.triangles = larger;
    }
    for (let k = 0; k < writes.length; k += 4) {
      this.triangles.set(writes.subarray(k + 1, k + 4), 3 * writes[k]);
    }
    if (hull) this.hull = hull;
    // What was inside may be boundary now, see `edges` of draw.js.
    for (const rows of [gone, added]) rows.forEach((row) => (this.rim[row] = 1));
    this.edited = true;
  }
}
