// Numbers about a triangulation.

/** Whether each point is on the boundary. */
export function rimOf(count, { triangles, neighbors }) {
  const rim = new Uint8Array(count);
  for (let k = 0; k < neighbors.length; k += 1) {
    if (neighbors[k] >= 0) continue;
    const first = k - (k % 3);
    rim[triangles[first + ((k + 1) % 3)]] = 1;
    rim[triangles[first + ((k + 2) % 3)]] = 1;
  }
  return rim;
}

/** Counts and extremes; lengths and angles are rounded. */
export function summary(points, { triangles, neighbors, hull, duplicates }, statistics) {
  const lengths = edgeLengths(points, triangles, neighbors);
  return {
    points: points.length / 2,
    duplicates: duplicates.length / 2,
    triangles: triangles.length / 3,
    edges: lengths.count,
    hull: hull.length,
    minAngle: statistics.minAngle,
    medianAngle: statistics.medianAngle,
    area: statistics.area,
    shortest: lengths.least,
    mean: lengths.sum / lengths.count,
    longest: lengths.most,
  };
}

function edgeLengths(points, triangles, neighbors) {
  const found = { count: 0, sum: 0, least: Infinity, most: 0 };
  for (let k = 0; k < triangles.length; k += 1) {
    const first = k - (k % 3);
    const [u, v] = [triangles[first + ((k + 1) % 3)], triangles[first + ((k + 2) % 3)]];
    // An edge between two triangles is counted in one of them.
    if (neighbors[k] >= 0 && u > v) continue;
    const length = Math.hypot(
      points[2 * u] - points[2 * v], points[2 * u + 1] - points[2 * v + 1],
    );
    found.count += 1;
    found.sum += length;
    found.least = Math.min(found.least, length);
    found.most = Math.max(found.most, length);
  }
  return found;
}
