// Measures for drawing: circles, angles, counts. Rounded; what decides anything is in the core.

/** Center and radius of the circle through three points given by their rows. */
export function circleOf(points, a, b, c) {
  const [ax, ay] = [points[2 * a], points[2 * a + 1]];
  const [bx, by] = [points[2 * b] - ax, points[2 * b + 1] - ay];
  const [cx, cy] = [points[2 * c] - ax, points[2 * c + 1] - ay];
  const twice = 2 * (bx * cy - by * cx);
  const [b2, c2] = [bx * bx + by * by, cx * cx + cy * cy];
  const x = (cy * b2 - by * c2) / twice;
  const y = (bx * c2 - cx * b2) / twice;
  return [ax + x, ay + y, Math.hypot(x, y)];
}

/** The circle of triangle t. */
export function circleAt(points, triangles, t) {
  return circleOf(points, triangles[3 * t], triangles[3 * t + 1], triangles[3 * t + 2]);
}

/** The angle at each corner of triangles in degrees. */
export function cornersOf(points, triangles) {
  const angles = new Float64Array(triangles.length);
  for (let t = 0; t < triangles.length; t += 3) {
    for (let k = 0; k < 3; k += 1) {
      const [a, b, c] = [0, 1, 2].map((j) => triangles[t + ((k + j) % 3)]);
      const [ux, uy] = [points[2 * b] - points[2 * a], points[2 * b + 1] - points[2 * a + 1]];
      const [vx, vy] = [points[2 * c] - points[2 * a], points[2 * c + 1] - points[2 * a + 1]];
      angles[t + k] = (Math.atan2(Math.abs(ux * vy - uy * vx), ux * vx + uy * vy) * 180) / Math.PI;
    }
  }
  return angles;
}

/** All angles of triangles in degrees, ascending. */
export function anglesOf(points, triangles) {
  return cornersOf(points, triangles).sort();
}

/** Twice the signed area of a triangle of rows, rounded. */
export function turn(points, a, b, c) {
  return (
    (points[2 * b] - points[2 * a]) * (points[2 * c + 1] - points[2 * a + 1]) -
    (points[2 * b + 1] - points[2 * a + 1]) * (points[2 * c] - points[2 * a])
  );
}

/** The triangle that contains a position, or -1. */
export function triangleAt(points, triangles, x, y) {
  const inside = (u, v) =>
    (points[2 * v] - points[2 * u]) * (y - points[2 * u + 1]) -
      (points[2 * v + 1] - points[2 * u + 1]) * (x - points[2 * u]) >=
    0;
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = triangles.subarray(t, t + 3);
    if (inside(a, b) && inside(b, c) && inside(c, a)) return t / 3;
  }
  return -1;
}

/** Directed edges u, v, flat, whose reverse is not an edge of these triangles. */
export function boundaryOf(triangles) {
  const found = new Map();
  for (let t = 0; t < triangles.length; t += 3) {
    for (let k = 0; k < 3; k += 1) {
      const [u, v] = [triangles[t + k], triangles[t + ((k + 1) % 3)]];
      if (!found.delete(`${v} ${u}`)) found.set(`${u} ${v}`, [u, v]);
    }
  }
  return [...found.values()].flat();
}

/** A number for a sentence: at most so many digits after the point, no trailing zeros. */
export function short(value, digits = 1) {
  return String(Number(value.toFixed(digits)));
}

export function counted(count, word) {
  return `${count.toLocaleString("en-US")} ${word}${count === 1 ? "" : "s"}`;
}
