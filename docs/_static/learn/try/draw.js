// Draws a scene in steps: a generator that can be left between two of them.

// Edges, or points, of one step.
const LOT = 2000;

/** Screen coordinates of all points: x and y one after the other. */
export function projected(points, camera, target) {
  const flat = target?.length === points.length ? target : new Float64Array(points.length);
  for (let k = 0; k < points.length; k += 2) {
    flat[k] = camera.px(points[k]);
    flat[k + 1] = camera.py(points[k + 1]);
  }
  return flat;
}

/** Draw what lies in `area`, a box of pixels [left, top, right, bottom]. */
export function* drawing(context, scene, { camera, at, colors, shown, area, hairline }) {
  context.lineJoin = "round";
  const size = dotSize(scene, camera);
  if (shown.triangles) {
    fillHull(context, scene, at, colors.fill);
    context.lineWidth = size < 2.5 ? hairline : 1.2;
    context.strokeStyle = colors.edge;
    yield* edges(context, scene, at, area);
  }
  if (shown.cells && scene.cells) {
    context.lineWidth = size < 2.5 ? hairline : 1.3;
    context.strokeStyle = colors.second;
    yield* cells(context, scene.cells, camera, area);
  }
  if (shown.hull) {
    context.lineWidth = 2.2;
    context.strokeStyle = colors.accent;
    trace(context, scene.hull, at);
    context.stroke();
  }
  if (shown.points) {
    context.fillStyle = colors.point;
    yield* dots(context, at, area, size);
  }
}

/** The radius of points: large where there is room for it. */
export function dotSize(scene, camera) {
  const [x0, y0, x1, y1] = scene.extent ??= scene.box();
  const area = Math.max((x1 - x0) * camera.scale, 1) * Math.max((y1 - y0) * camera.scale, 1);
  return Math.max(0.6, Math.min(Math.sqrt(area / (scene.points.length / 2)) / 9, 4));
}

function trace(context, rows, at) {
  context.beginPath();
  for (const row of rows) context.lineTo(at[2 * row], at[2 * row + 1]);
  context.closePath();
}

function fillHull(context, scene, at, color) {
  context.fillStyle = color;
  context.globalAlpha = 0.35;
  trace(context, scene.hull, at);
  context.fill();
  context.globalAlpha = 1;
}

/** Each edge once: in the triangle that has it from the smaller row to the larger. An edge of the
 * boundary has only one triangle, so edges between points of the boundary are drawn anyway. */
function* edges(context, { triangles, count, rim }, at, [left, top, right, bottom]) {
  let waiting = 0;
  context.beginPath();
  for (let t = 0; t < 3 * count; t += 3) {
    const [a, b, c] = [triangles[t], triangles[t + 1], triangles[t + 2]];
    const [ax, ay, bx, by, cx, cy] = [
      at[2 * a], at[2 * a + 1], at[2 * b], at[2 * b + 1], at[2 * c], at[2 * c + 1],
    ];
    if ((ax < left && bx < left && cx < left) || (ax > right && bx > right && cx > right)) continue;
    if ((ay < top && by < top && cy < top) || (ay > bottom && by > bottom && cy > bottom)) continue;
    if (a < b || (rim[a] && rim[b])) {
      context.moveTo(ax, ay);
      context.lineTo(bx, by);
    }
    if (b < c || (rim[b] && rim[c])) {
      context.moveTo(bx, by);
      context.lineTo(cx, cy);
    }
    if (c < a || (rim[c] && rim[a])) {
      context.moveTo(cx, cy);
      context.lineTo(ax, ay);
    }
    waiting += 1;
    if (waiting === LOT) {
      context.stroke();
      yield;
      context.beginPath();
      waiting = 0;
    }
  }
  context.stroke();
}

/** The edges between two cells, each once. */
function* cells(context, { starts, across, corners }, camera, [left, top, right, bottom]) {
  let waiting = 0;
  context.beginPath();
  for (let row = 0; row + 1 < starts.length; row += 1) {
    const [begin, end] = [starts[row], starts[row + 1]];
    for (let k = begin; k < end; k += 1) {
      if (across[k] < row) continue;
      const next = k + 1 < end ? k + 1 : begin;
      const [ax, ay] = [camera.px(corners[2 * k]), camera.py(corners[2 * k + 1])];
      const [bx, by] = [camera.px(corners[2 * next]), camera.py(corners[2 * next + 1])];
      if ((ax < left && bx < left) || (ax > right && bx > right)) continue;
      if ((ay < top && by < top) || (ay > bottom && by > bottom)) continue;
      context.moveTo(ax, ay);
      context.lineTo(bx, by);
      waiting += 1;
    }
    if (waiting >= LOT) {
      context.stroke();
      yield;
      context.beginPath();
      waiting = 0;
    }
  }
  context.stroke();
}

function* dots(context, at, [left, top, right, bottom], size) {
  let waiting = 0;
  context.beginPath();
  for (let k = 0; k < at.length; k += 2) {
    const [x, y] = [at[k], at[k + 1]];
    if (x < left - size || x > right + size || y < top - size || y > bottom + size) continue;
    if (size < 1.6) {
      context.fillRect(x - size, y - size, 2 * size, 2 * size);
    } else {
      context.moveTo(x + size, y);
      context.arc(x, y, size, 0, 2 * Math.PI);
    }
    waiting += 1;
    if (waiting === LOT) {
      context.fill();
      yield;
      context.beginPath();
      waiting = 0;
    }
  }
  context.fill();
}
