// The worker, as functions that return promises.

import { Problem } from "./problem.js";

export class Client {
  constructor() {
    this.worker = new Worker(new URL("worker.js", import.meta.url), { type: "module" });
    this.waiting = new Map();
    this.number = 0;
    this.worker.onmessage = ({ data: { id, value, error } }) => {
      const { done, failed } = this.waiting.get(id);
      this.waiting.delete(id);
      if (error) failed(new Problem(error.name, error.message, error.note));
      else done(value);
    };
    this.worker.onerror = (event) => {
      event.preventDefault();
      const problem = new Problem("InternalError", event.message || "the worker cannot be started");
      for (const { failed } of this.waiting.values()) failed(problem);
      this.waiting.clear();
    };
  }

  /** Call a function of worker.js. */
  ask(call, given = {}, transfer = []) {
    const id = (this.number += 1);
    return new Promise((done, failed) => {
      this.waiting.set(id, { done, failed });
      this.worker.postMessage({ id, call, ...given }, transfer);
    });
  }
}
