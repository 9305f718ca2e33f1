// Drawings in 3-D: a turn about the vertical axis, then a tilt, then parallel projection.

/** The controls of a drawing that starts at these angles, in degrees. */
export function spinControls(turn, tilt) {
  return [
    { kind: "range", name: "turn", label: "Turn", min: -180, max: 180, step: 1, value: turn, unit: "°" },
    { kind: "range", name: "tilt", label: "Tilt", min: -90, max: 90, step: 1, value: tilt, unit: "°" },
  ];
}

/** Turn a figure by a drag of so many pixels. */
export function spin(figure, dx, dy) {
  figure.change((changed) => {
    const { turn, tilt } = changed.options;
    changed.options = {
      ...changed.options,
      turn: Math.round(((((turn + dx / 2 + 180) % 360) + 360) % 360) - 180),
      tilt: Math.round(Math.min(90, Math.max(-90, tilt + dy / 2))),
    };
  });
}

/** The map from x, y, z to a plane; its `depth` grows away from the eye. At tilt 90 it looks down. */
export function projection({ turn, tilt }) {
  const [a, e] = [(turn * Math.PI) / 180, (tilt * Math.PI) / 180];
  const [ca, sa, ce, se] = [Math.cos(a), Math.sin(a), Math.cos(e), Math.sin(e)];
  const project = (x, y, z) => [x * ca - y * sa, (x * sa + y * ca) * se + z * ce];
  project.depth = (x, y, z) => (x * sa + y * ca) * ce - z * se;
  return project;
}
