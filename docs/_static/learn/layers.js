// Makes layers (see paint.js) of points, triangles and circles. Points are x0, y0, x1, y1, ...;
// triangles are rows of points, three numbers each.

/** Edges of triangles as coordinates, each edge once. */
export function edgesOf(points, triangles) {
  const segments = [];
  const seen = new Set();
  const count = points.length / 2;
  for (let t = 0; t < triangles.length; t += 3) {
    for (let k = 0; k < 3; k += 1) {
      const [u, v] = [triangles[t + k], triangles[t + ((k + 1) % 3)]];
      const key = u < v ? u * count + v : v * count + u;
      if (seen.has(key)) continue;
      seen.add(key);
      segments.push(points[2 * u], points[2 * u + 1], points[2 * v], points[2 * v + 1]);
    }
  }
  return Float64Array.from(segments);
}

/** Coordinates of pairs of rows. */
export function segmentsOf(points, pairs) {
  return Float64Array.from(pairs.flatMap((row) => [points[2 * row], points[2 * row + 1]]));
}

/** Coordinates of rows. */
export function rowsOf(points, rows) {
  return segmentsOf(points, Array.from(rows));
}

export function edges(points, triangles, style = {}) {
  return { kind: "lines", segments: edgesOf(points, triangles), color: "edge", ...style };
}

export function pairs(points, rows, style = {}) {
  return { kind: "lines", segments: segmentsOf(points, rows), ...style };
}

export function fill(points, triangles, style = {}) {
  return { kind: "fill", corners: rowsOf(points, triangles), color: "fill", ...style };
}

export function dots(points, rows, style = {}) {
  const xy = rows ? rowsOf(points, rows) : Float64Array.from(points);
  return { kind: "dots", xy, color: "point", radius: 4.5, ...style };
}

export function names(points, texts, style = {}) {
  return { kind: "labels", xy: Float64Array.from(points), texts, color: "text", ...style };
}

export function circles(list, style = {}) {
  return { kind: "circles", circles: Float64Array.from(list.flat()), color: "accent", ...style };
}
