/* What the view computes of a mesh: edges, circles, angles, ranges. */

/* The edges of triangles, each once: ends, and the triangles on both sides, -1 outside. */
export function edgesOf(triangles, npoints) {
  const m = triangles.length / 3;
  const ends = new Int32Array(triangles.length * 2);
  const neighbors = new Int32Array(triangles.length).fill(-1);
  const head = new Int32Array(npoints).fill(-1);
  const next = new Int32Array(triangles.length);
  const opposite = new Int32Array(triangles.length); // the half-edge that made the edge
  let count = 0;
  for (let t = 0; t < m; t++) {
    for (let k = 0; k < 3; k++) {
      const a = triangles[3 * t + ((k + 1) % 3)];
      const b = triangles[3 * t + ((k + 2) % 3)];
      const low = Math.min(a, b);
      const high = Math.max(a, b);
      let e = head[low];
      while (e >= 0 && ends[2 * e + 1] !== high) e = next[e];
      if (e < 0) {
        e = count++;
        ends[2 * e] = low;
        ends[2 * e + 1] = high;
        next[e] = head[low];
        head[low] = e;
        opposite[e] = 3 * t + k;
      } else if (neighbors[opposite[e]] < 0) {
        neighbors[opposite[e]] = t;
        neighbors[3 * t + k] = Math.floor(opposite[e] / 3);
      }
    }
  }
  const rim = [];
  for (let e = 0; e < count; e++) {
    if (neighbors[opposite[e]] < 0) rim.push(ends[2 * e], ends[2 * e + 1]);
  }
  return { ends: ends.subarray(0, 2 * count), neighbors, rim: Int32Array.from(rim) };
}

/* Twice the signed area of the triangle a, b, (x, y). */
export function side(p, a, b, x, y) {
  return (p[2 * a] - x) * (p[2 * b + 1] - y) - (p[2 * a + 1] - y) * (p[2 * b] - x);
}

/* Center and radius of the circle through the corners of each triangle. */
export function circlesOf(p, triangles) {
  const out = new Float64Array(triangles.length);
  for (let i = 0; i < triangles.length; i += 3) {
    const [a, b, c] = [triangles[i], triangles[i + 1], triangles[i + 2]];
    const bx = p[2 * b] - p[2 * a];
    const by = p[2 * b + 1] - p[2 * a + 1];
    const cx = p[2 * c] - p[2 * a];
    const cy = p[2 * c + 1] - p[2 * a + 1];
    const d = 2 * (bx * cy - by * cx);
    const x = (cy * (bx * bx + by * by) - by * (cx * cx + cy * cy)) / d;
    const y = (bx * (cx * cx + cy * cy) - cx * (bx * bx + by * by)) / d;
    out[i] = p[2 * a] + x;
    out[i + 1] = p[2 * a + 1] + y;
    out[i + 2] = Math.hypot(x, y);
  }
  return out;
}

/* The smallest angle of each triangle in degrees. */
export function anglesOf(p, triangles) {
  const out = new Float32Array(triangles.length / 3);
  for (let t = 0; t < out.length; t++) {
    let least = 180;
    for (let k = 0; k < 3; k++) {
      const [a, b, c] = [0, 1, 2].map((j) => triangles[3 * t + ((k + j) % 3)]);
      const ux = p[2 * b] - p[2 * a];
      const uy = p[2 * b + 1] - p[2 * a + 1];
      const vx = p[2 * c] - p[2 * a];
      const vy = p[2 * c + 1] - p[2 * a + 1];
      const angle = Math.atan2(Math.abs(ux * vy - uy * vx), ux * vx + uy * vy);
      least = Math.min(least, (angle * 180) / Math.PI);
    }
    out[t] = least;
  }
  return out;
}

export function rangeOf(values) {
  let low = Infinity;
  let high = -Infinity;
  for (const each of values) {
    if (each < low) low = each;
    if (each > high) high = each;
  }
  return low < high ? [low, high] : [low - 1, low + 1];
}
