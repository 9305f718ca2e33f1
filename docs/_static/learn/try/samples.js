// Points to begin with. The random ones are the same on each visit.

export const SAMPLES = [
  ["random", "500 random points"],
  ["many", "10,000 random points"],
  ["most", "100,000 random points"],
  ["grid", "Grid: each square is a tie"],
  ["spiral", "Sunflower"],
  ["five", "Five points by hand"],
];

/** The points of a sample, flat. */
export function sample(name) {
  return MAKERS[name]();
}

const MAKERS = {
  random: () => random(500),
  many: () => random(10_000),
  most: () => random(100_000),

  // Those of the chapter with this title.
  five: () => Float64Array.of(0, 0, 4, 0, 4, 3, 0, 3, 2, 1),

  grid() {
    const points = new Float64Array(2 * 21 * 14);
    for (let k = 0; k < points.length / 2; k += 1) {
      points.set([k % 21, Math.floor(k / 21)], 2 * k);
    }
    return points;
  },

  spiral() {
    const golden = Math.PI * (3 - Math.sqrt(5));
    const points = new Float64Array(2 * 800);
    for (let k = 0; k < points.length / 2; k += 1) {
      const radius = 10 * Math.sqrt(k + 0.5);
      points.set([radius * Math.cos(golden * k), radius * Math.sin(golden * k)], 2 * k);
    }
    return points;
  },
};

/** Points in a rectangle of 1000 by 600, from a generator of Lehmer's kind. */
function random(count) {
  let state = 20_231;
  const next = () => (state = (state * 48_271) % 2_147_483_647) / 2_147_483_647;
  const points = new Float64Array(2 * count);
  for (let k = 0; k < count; k += 1) {
    points[2 * k] = 1000 * next();
    points[2 * k + 1] = 600 * next();
  }
  return points;
}
