// Files of a result: triangles as CSV or GeoJSON, the picture as SVG.

/** Rows of corners, numbered as the points were given. */
export function trianglesCsv({ triangles, count }) {
  const rows = ["a,b,c"];
  for (let k = 0; k < 3 * count; k += 3) {
    rows.push(`${triangles[k]},${triangles[k + 1]},${triangles[k + 2]}`);
  }
  return `${rows.join("\n")}\n`;
}

/** The points, which may have been dragged. */
export function pointsCsv({ points }) {
  const rows = ["x,y"];
  for (let k = 0; k < points.length; k += 2) rows.push(`${points[k]},${points[k + 1]}`);
  return `${rows.join("\n")}\n`;
}

/** Triangles as polygons, with their corners as v0, v1, v2: as `delone triangulate` writes them. */
export function geojson({ points, triangles, count }) {
  const features = [];
  for (let k = 0; k < 3 * count; k += 3) {
    const rows = Array.from(triangles.subarray(k, k + 3));
    const ring = [...rows, rows[0]].map((row) => [points[2 * row], points[2 * row + 1]]);
    const properties = { v0: rows[0], v1: rows[1], v2: rows[2] };
    const geometry = { type: "Polygon", coordinates: [ring] };
    features.push(JSON.stringify({ type: "Feature", properties, geometry }));
  }
  return `{"type":"FeatureCollection","features":[\n${features.join(",\n")}\n]}\n`;
}

/** The picture: a context that writes what is drawn. */
export class SvgContext {
  constructor(width, height) {
    Object.assign(this, { width, height, parts: [], path: [], globalAlpha: 1, lineWidth: 1 });
  }

  beginPath() {
    this.path = [];
  }

  moveTo(x, y) {
    this.path.push(`M${number(x)} ${number(y)}`);
  }

  lineTo(x, y) {
    this.path.push(`${this.path.length ? "L" : "M"}${number(x)} ${number(y)}`);
  }

  closePath() {
    this.path.push("Z");
  }

  /** Circles only. */
  arc(x, y, radius) {
    const [r, d] = [number(radius), number(2 * radius)];
    this.path.push(`M${number(x - radius)} ${number(y)}a${r} ${r} 0 1 0 ${d} 0a${r} ${r} 0 1 0 -${d} 0`);
  }

  fillRect(x, y, width, height) {
    const [w, h] = [number(width), number(height)];
    this.path.push(`M${number(x)} ${number(y)}h${w}v${h}h-${w}z`);
  }

  stroke() {
    this.write(`fill="none" stroke="${this.strokeStyle}" stroke-width="${number(this.lineWidth)}"`);
  }

  fill() {
    this.write(`fill="${this.fillStyle}" fill-opacity="${this.globalAlpha}"`);
  }

  write(style) {
    if (this.path.length) this.parts.push(`<path ${style} d="${this.path.join("")}"/>`);
  }

  text() {
    const [width, height] = [Math.round(this.width), Math.round(this.height)];
    return (
      `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" ` +
      `viewBox="0 0 ${width} ${height}" stroke-linejoin="round">${this.parts.join("\n")}</svg>\n`
    );
  }
}

const number = (value) => String(Math.round(value * 100) / 100);

/** Hand a text to the reader as a file. */
export function download(name, type, text) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
