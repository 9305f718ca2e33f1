// The places of triangles in an array, so that an edit writes only those that it changes.

export class Slots {
  constructor(triangles, points) {
    this.triangles = triangles.slice();
    this.points = points;
    this.count = triangles.length / 3;
    this.places = new Map();
    for (let t = 0; t < this.count; t += 1) this.places.set(this.key(t), t);
  }

  /** A triangle by its edge from the smallest row on, which no other one has. */
  key(t) {
    const [a, b, c] = this.triangles.subarray(3 * t, 3 * t + 3);
    return this.edge(a, b, c);
  }

  edge(a, b, c) {
    if (a < b && a < c) return a * this.points + b;
    return b < c ? b * this.points + c : c * this.points + a;
  }

  /** Make an edit; returns the number of triangles, and places with their new corners: four each. */
  apply({ gone, added }) {
    const free = [];
    for (let k = 0; k < gone.length; k += 3) {
      const key = this.edge(gone[k], gone[k + 1], gone[k + 2]);
      free.push(this.places.get(key));
      this.places.delete(key);
    }
    const written = new Map();
    for (let k = 0; k < added.length; k += 3) {
      const place = free.pop() ?? this.count++;
      this.write(place, added.subarray(k, k + 3), written);
    }
    this.close(free, written);
    const writes = [...written].flatMap(([place, three]) => [place, ...three]);
    return { count: this.count, writes: Int32Array.from(writes) };
  }

  /** The last triangles take the places that are left. */
  close(free, written) {
    for (const place of free.sort((a, b) => b - a)) {
      this.count -= 1;
      if (place === this.count) continue;
      this.write(place, this.triangles.slice(3 * this.count, 3 * this.count + 3), written);
      written.delete(this.count);
    }
  }

  write(place, three, written) {
    if (3 * place >= this.triangles.length) {
      const larger = new Int32Array(2 * this.triangles.length + 3);
      larger.set(this.triangles);
      this.triangles = larger;
    }
    this.triangles.set(three, 3 * place);
    this.places.set(this.key(place), place);
    written.set(place, three);
  }
}
