// Draws the layers of a state: plain objects, each with a kind, a color and typed arrays.
// All lines of a layer are one path, so that ten thousand of them are one call of the canvas.

const MARGIN = 16;

/** The part of a canvas that shows one panel, and the map from its coordinates to pixels. */
export class Paint {
  constructor(context, colors, view, box) {
    const [x0, y0, x1, y1] = view;
    const inner = { width: box.width - 2 * MARGIN, height: box.height - 2 * MARGIN };
    this.context = context;
    this.colors = colors;
    this.box = box;
    this.scale = Math.max(1e-9, Math.min(inner.width / (x1 - x0), inner.height / (y1 - y0)));
    this.left = box.x + (box.width - this.scale * (x1 - x0)) / 2 - this.scale * x0;
    this.bottom = box.y + (box.height + this.scale * (y1 - y0)) / 2 + this.scale * y0;
  }

  x(value) {
    return this.left + this.scale * value;
  }

  y(value) {
    return this.bottom - this.scale * value;
  }

  /** Coordinates of a pixel. */
  at(px, py) {
    return [(px - this.left) / this.scale, (this.bottom - py) / this.scale];
  }

  contains(px, py) {
    const { x, y, width, height } = this.box;
    return px >= x && px <= x + width && py >= y && py <= y + height;
  }

  draw(layers) {
    const { context, box } = this;
    context.save();
    context.beginPath();
    context.rect(box.x, box.y, box.width, box.height);
    context.clip();
    for (const layer of layers) {
      context.globalAlpha = layer.alpha ?? 1;
      context.setLineDash(layer.dash ?? []);
      context.lineWidth = layer.width ?? 1.5;
      context.lineJoin = "round";
      const color = this.colors[layer.color ?? "edge"];
      context.strokeStyle = color;
      context.fillStyle = color;
      this[layer.kind](layer);
    }
    context.restore();
  }

  // The kinds of layers.

  lines({ segments }) {
    const { context } = this;
    context.beginPath();
    for (let i = 0; i < segments.length; i += 4) {
      context.moveTo(this.x(segments[i]), this.y(segments[i + 1]));
      context.lineTo(this.x(segments[i + 2]), this.y(segments[i + 3]));
    }
    context.stroke();
  }

  path({ xy, closed, fill }) {
    const { context } = this;
    context.beginPath();
    for (let i = 0; i < xy.length; i += 2) context.lineTo(this.x(xy[i]), this.y(xy[i + 1]));
    if (closed) context.closePath();
    if (fill) context.fill();
    else context.stroke();
  }

  fill({ corners }) {
    const { context } = this;
    context.beginPath();
    for (let i = 0; i < corners.length; i += 6) {
      context.moveTo(this.x(corners[i]), this.y(corners[i + 1]));
      context.lineTo(this.x(corners[i + 2]), this.y(corners[i + 3]));
      context.lineTo(this.x(corners[i + 4]), this.y(corners[i + 5]));
      context.closePath();
    }
    context.fill();
  }

  circles({ circles, wash }) {
    const { context } = this;
    context.beginPath();
    for (let i = 0; i < circles.length; i += 3) {
      const [x, y, radius] = circles.slice(i, i + 3);
      context.moveTo(this.x(x + radius), this.y(y));
      context.arc(this.x(x), this.y(y), this.scale * radius, 0, 2 * Math.PI);
    }
    context.stroke();
    if (wash) {
      context.globalAlpha = wash;
      context.fill();
    }
  }

  dots({ xy, radius = 4, ring }) {
    const { context } = this;
    context.beginPath();
    for (let i = 0; i < xy.length; i += 2) {
      const [x, y] = [this.x(xy[i]), this.y(xy[i + 1])];
      context.moveTo(x + radius, y);
      context.arc(x, y, radius, 0, 2 * Math.PI);
    }
    context.fill();
    if (ring) {
      context.strokeStyle = this.colors.paper;
      context.stroke();
    }
  }

  labels({ xy, texts, dx = 9, dy = -9, align = "left", size = 13 }) {
    const { context } = this;
    context.font = `${size}px system-ui, sans-serif`;
    context.textAlign = align;
    context.textBaseline = "middle";
    context.lineWidth = 4;
    context.strokeStyle = this.colors.paper;
    texts.forEach((text, i) => {
      const [x, y] = [this.x(xy[2 * i]) + dx, this.y(xy[2 * i + 1]) + dy];
      context.strokeText(text, x, y);
      context.fillText(text, x, y);
    });
  }

  /** Cells of a square, each in the color whose name its number selects. */
  cells({ values, columns, palette, square: [x0, y0, x1, y1] }) {
    const rows = values.length / columns;
    const [width, height] = [(x1 - x0) / columns, (y1 - y0) / rows];
    palette.forEach((name, value) => {
      this.context.fillStyle = this.colors[name];
      this.context.beginPath();
      for (let i = 0; i < values.length; i += 1) {
        if (values[i] !== value) continue;
        const [column, row] = [i % columns, Math.floor(i / columns)];
        const [left, top] = [this.x(x0 + column * width), this.y(y0 + (row + 1) * height)];
        // A sliver more than the cell: no seams.
        this.context.rect(left, top, this.scale * width + 0.4, this.scale * height + 0.4);
      }
      this.context.fill();
    });
  }
}
