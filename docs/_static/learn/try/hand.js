// A point that is dragged: the worker edits the triangulation, the picture changes around the point.

// Up to so many points, cells are computed anew with each move.
const FEW = 2000;

export class Hand {
  constructor(page) {
    this.page = page;
    this.row = -1;
    this.target = null;
    this.running = null;
    // Milliseconds of the last move: in the worker, there and back, and drawing.
    this.times = { update: 0, draw: 0, total: 0 };
  }

  movable() {
    return this.page.parts.layers.move.checked;
  }

  /** Let the worker make what moves need, before the first one. */
  prepare() {
    this.page.client.ask("hold").catch((problem) => this.page.fail(problem));
  }

  say(text) {
    this.page.say(text);
  }

  grab(row) {
    const { picture } = this.page;
    this.row = row;
    picture.mark(row);
    this.prepare();
  }

  /** Move the point, as soon as the last move is done; moves in between are left out. */
  drag(row, x, y) {
    this.target = { row, x, y };
    this.running ??= this.run().finally(() => {
      this.running = null;
    });
    return this.running;
  }

  async run() {
    try {
      while (this.target) {
        const target = this.target;
        this.target = null;
        await this.step(target);
      }
    } catch (problem) {
      this.page.fail(problem);
    }
  }

  async step({ row, x, y }) {
    const { page } = this;
    const { picture } = page;
    // The worker answers in order: these points are still the present ones when it does.
    if (page.reading) return;
    const start = performance.now();
    const changes = await page.client.ask("move", { row, x, y });
    const { scene } = picture;
    const updated = performance.now();
    const many = scene.points.length > 2 * FEW;
    if (scene.cells) scene.cells = null;
    picture.edit(changes, row, x, y);
    const end = performance.now();
    this.times = { update: updated - start, draw: end - updated, total: end - start };
    const count = changes.added.length / 3;
    this.say(
      `Point ${row}: ${count === 1 ? "1 triangle is" : `${count.toLocaleString("en-US")} triangles are`} new. ` +
        `Update ${ms(updated - start)}, drawing ${ms(end - updated)}.`,
    );
    if (!many && picture.shown.cells) await page.addCells();
  }

  /** All numbers, and the triangles in their order, once the point rests. */
  async drop() {
    const { page } = this;
    this.row = -1;
    await this.running;
    const { picture } = page;
    picture.marked = null;
    picture.show();
    if (!picture.scene.edited) return;
    try {
      page.settled(await page.client.ask("settle"));
    } catch (problem) {
      page.fail(problem);
    }
  }
}

const ms = (time) => `${time.toFixed(1)} ms`;
