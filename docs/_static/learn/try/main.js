// The page on which readers triangulate their own points.

import { colorsOf, watchTheme } from "../theme.js";
import { Client } from "./client.js";
import { Hand } from "./hand.js";
import { listen, turnTo } from "./input.js";
import { addPage } from "./parts.js";
import { Picture } from "./picture.js";
import { MAX_BYTES, tooManyBytes } from "./problem.js";
import { download, geojson, pointsCsv, SvgContext, trianglesCsv } from "./save.js";
import { Scene } from "./scene.js";
import { describe, tell } from "./words.js";
import { drawing } from "./draw.js";

// More points than this are not moved unless the reader says so: a press is meant for the picture.
const FEW = 2000;

class Page {
  constructor(element) {
    this.element = element;
    this.client = new Client();
    this.parts = addPage(element);
    this.picture = new Picture(this.parts.canvas, colorsOf(element));
    this.hand = new Hand(this);
    this.name = "points";
    this.busy = 0;
    this.reading = false;
    this.listen();
  }

  listen() {
    const { parts, picture, element } = this;
    parts.run.addEventListener("click", () => this.readText());
    parts.sample.addEventListener("change", () => this.readSample(parts.sample.value));
    parts.file.addEventListener("change", () => {
      if (parts.file.files.length) this.readFile(parts.file.files[0]);
      parts.file.value = "";
    });
    for (const name of ["dragenter", "dragover", "dragleave", "drop"]) {
      element.addEventListener(name, (event) => this.dropped(event));
    }
    for (const [name, box] of Object.entries(parts.layers)) {
      box.addEventListener("change", () => this.show(name, box.checked));
    }
    for (const [sign, button] of Object.entries(parts.zoom)) {
      button.addEventListener("click", () => turnTo(sign, picture));
    }
    for (const [kind, button] of Object.entries(parts.save)) {
      button.addEventListener("click", () => this.save(kind));
    }
    listen(parts.canvas, picture, this.hand);
    watchTheme(() => {
      picture.colors = colorsOf(element);
      picture.draw();
    });
    new ResizeObserver(() => this.resize()).observe(parts.frame);
    this.resize();
  }

  resize() {
    const width = this.parts.frame.clientWidth;
    if (!width) return;
    const height = Math.round(Math.max(260, Math.min(width * 0.62, window.innerHeight * 0.7)));
    this.parts.canvas.style.height = `${height}px`;
    this.picture.resize(width, height, window.devicePixelRatio || 1);
  }

  // Input.

  readText() {
    const { text } = this.parts;
    this.read("points", { content: text.value, source: "The text" });
  }

  async readFile(file) {
    if (file.size > MAX_BYTES) {
      this.fail(tooManyBytes(file.name, file.size));
      return;
    }
    const content = await file.arrayBuffer();
    const given = { content, source: file.name };
    await this.read(file.name.replace(/\.[^.]*$/, ""), given, [content], file.name);
  }

  dropped(event) {
    event.preventDefault();
    this.element.classList.toggle("try-over", ["dragenter", "dragover"].includes(event.type));
    const [file] = event.type === "drop" ? event.dataTransfer.files : [];
    if (file) this.readFile(file);
  }

  read(name, given, transfer = [], file = "") {
    const wanted = this.parts.columns.value.split(",").map((each) => each.trim()).filter(Boolean);
    this.parts.sample.value = "";
    return this.begin(name, "read", { ...given, wanted }, transfer, file);
  }

  readSample(name) {
    this.parts.sample.value = name;
    return name ? this.begin(name, "sample", { name }) : null;
  }

  /** Ask for the triangulation of other points, and show it or what is wrong with them. */
  async begin(name, call, given, transfer, file = "") {
    const number = (this.busy += 1);
    this.reading = true;
    this.parts.element.classList.add("try-busy");
    this.parts.status.textContent = "Reading ...";
    try {
      const found = await this.client.ask(call, given, transfer);
      if (number !== this.busy) return;
      this.name = name;
      this.take(found, file);
    } catch (problem) {
      if (number === this.busy) this.fail(problem);
    } finally {
      if (number === this.busy) {
        this.reading = false;
        this.parts.element.classList.remove("try-busy");
      }
    }
  }

  /** Show a result; the text names the file, which the file chooser no longer does. */
  take(found, file) {
    const { parts, picture } = this;
    parts.problem.hidden = true;
    parts.element.classList.add("try-full");
    const scene = new Scene(found);
    parts.layers.move.checked = found.points.length <= 2 * FEW || found.movable === true;
    picture.setScene(scene);
    this.tell(found);
    parts.status.textContent = describe(found, file);
    this.addCells();
    if (this.hand.movable()) this.hand.prepare();
  }

  /** The result for points that have been moved. */
  settled(found) {
    this.parts.problem.hidden = true;
    this.picture.exchange(new Scene(found));
    this.tell(found);
    this.addCells();
  }

  tell({ summary }) {
    this.summary = summary;
    tell(this.parts.table, summary);
    this.parts.canvas.setAttribute("aria-label", describe({ summary }));
  }

  fail({ name, message, note }) {
    const { problem, status } = this.parts;
    status.textContent = "";
    problem.hidden = false;
    problem.textContent = `${name}: ${message}${note ? ` (${note})` : ""}`;
  }

  say(text) {
    this.parts.status.textContent = text;
  }

  // The picture.

  show(name, on) {
    if (name === "move") {
      if (on) this.hand.prepare();
      return;
    }
    this.picture.shown[name] = on;
    if (name === "cells" && on) this.addCells();
    else this.picture.draw();
  }

  /** Cells are computed when they are shown. */
  async addCells() {
    const { picture } = this;
    const { scene } = picture;
    if (!scene || scene.cells || !picture.shown.cells) return;
    const [x0, y0, x1, y1] = scene.box();
    const [dx, dy] = [(x1 / 2 - x0 / 2) / 5, (y1 / 2 - y0 / 2) / 5];
    try {
      const cells = await this.client.ask("cells", { box: [x0 - dx, y0 - dy, x1 + dx, y1 + dy] });
      if (picture.scene !== scene) return;
      scene.cells = cells;
      picture.draw();
    } catch (problem) {
      this.fail(problem);
    }
  }

  // Files.

  save(kind) {
    const { scene } = this.picture;
    if (!scene) return;
    if (kind === "svg") download(`${this.name}.svg`, "image/svg+xml", this.svg());
    if (kind === "geojson") {
      download(`${this.name}-triangles.geojson`, "application/geo+json", geojson(scene));
    }
    if (kind === "csv") download(`${this.name}-triangles.csv`, "text/csv", trianglesCsv(scene));
    if (kind === "points") download(`${this.name}-points.csv`, "text/csv", pointsCsv(scene));
  }

  svg() {
    const { scene, camera, at, colors, shown } = this.picture;
    const context = new SvgContext(camera.width, camera.height);
    const area = [0, 0, camera.width, camera.height];
    const style = { camera, at, colors, shown, area, hairline: 0.7 };
    for (const steps = drawing(context, scene, style); !steps.next().done; );
    return context.text();
  }
}

const element = document.querySelector("[data-try]");
if (element) window.deloneTry = start(element);

async function start(found) {
  const before = found.querySelector(".try-before");
  if (found.dataset.core !== "yes") {
    before.textContent =
      "This copy of the site comes without the compiled core, so this page cannot triangulate. " +
      "In a clone of delone, `make site` builds one with it.";
    return null;
  }
  before.remove();
  const page = new Page(found);
  try {
    await page.client.ask("ready");
  } catch (problem) {
    page.fail(problem);
    return page;
  }
  await page.readSample("random");
  return page;
}
