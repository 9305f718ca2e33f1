// Mouse, touch, wheel and keys of a picture.

const REACH = { mouse: 10, pen: 14, touch: 24 };
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
const [PAN, NUDGE] = [60, 8];

/** Let a picture be moved, and its points be dragged. `hand` has the functions
 * movable() -> whether points can be dragged, grab(row), drag(row, x, y), drop(row), say(text). */
export function listen(canvas, picture, hand) {
  const held = { pointers: new Map(), row: -1, byKeys: false };
  canvas.addEventListener("pointerdown", (event) => down(event, canvas, picture, hand, held));
  canvas.addEventListener("pointermove", (event) => move(event, canvas, picture, hand, held));
  for (const name of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(name, (event) => up(event, hand, held));
  }
  canvas.addEventListener("wheel", (event) => wheel(event, canvas, picture), { passive: false });
  canvas.addEventListener("keydown", (event) => press(event, picture, hand, held));
  canvas.addEventListener("blur", () => held.byKeys && release(hand, held));
}

const place = (event) => [event.offsetX, event.offsetY];

function down(event, canvas, picture, hand, held) {
  if (!picture.scene) return;
  canvas.setPointerCapture(event.pointerId);
  held.pointers.set(event.pointerId, place(event));
  if (held.pointers.size === 1 && hand.movable() && !event.shiftKey) {
    held.row = picture.nearest(...place(event), REACH[event.pointerType] ?? REACH.mouse);
    held.byKeys = false;
    if (held.row >= 0) hand.grab(held.row);
  } else {
    release(hand, held);
  }
}

function move(event, canvas, picture, hand, held) {
  const [px, py] = place(event);
  const before = held.pointers.get(event.pointerId);
  if (!before) {
    const over = picture.scene && hand.movable() && event.pointerType === "mouse";
    canvas.style.cursor = over && picture.nearest(px, py, REACH.mouse) >= 0 ? "pointer" : "grab";
    return;
  }
  if (held.row >= 0) {
    hand.drag(held.row, ...picture.camera.at(px, py));
  } else if (held.pointers.size === 2) {
    const [other] = [...held.pointers].filter(([id]) => id !== event.pointerId);
    pinch(picture, before, [px, py], other[1]);
  } else {
    picture.camera.pan(px - before[0], py - before[1]);
    picture.moved();
  }
  held.pointers.set(event.pointerId, [px, py]);
}

/** One of two fingers has moved; the other is the fixed point. */
function pinch(picture, before, now, other) {
  const far = (p) => Math.max(1, Math.hypot(p[0] - other[0], p[1] - other[1]));
  const middle = (p) => [(p[0] + other[0]) / 2, (p[1] + other[1]) / 2];
  const [from, to] = [middle(before), middle(now)];
  picture.camera.zoom(far(now) / far(before), ...from);
  picture.camera.pan(to[0] - from[0], to[1] - from[1]);
  picture.moved();
}

function up(event, hand, held) {
  if (!held.pointers.delete(event.pointerId)) return;
  if (!held.byKeys) release(hand, held);
}

function release(hand, held) {
  if (held.row >= 0) hand.drop(held.row);
  [held.row, held.byKeys] = [-1, false];
}

/** The wheel zooms in a picture that has the focus, or with Ctrl; else the page scrolls. */
function wheel(event, canvas, picture) {
  if (!picture.scene || (document.activeElement !== canvas && !event.ctrlKey)) return;
  event.preventDefault();
  const lines = event.deltaMode === 1 ? 20 : 1;
  picture.camera.zoom(Math.exp(-event.deltaY * lines * (event.ctrlKey ? 0.01 : 0.002)), ...place(event));
  picture.moved();
}

function press(event, picture, hand, held) {
  if (!picture.scene || event.altKey || event.metaKey || event.ctrlKey) return;
  const { camera, scene } = picture;
  const arrow = ARROWS[event.key];
  if (arrow && held.row >= 0) {
    const [x, y] = [scene.points[2 * held.row], scene.points[2 * held.row + 1]];
    const far = NUDGE * (event.shiftKey ? 0.1 : 1) / camera.scale;
    hand.drag(held.row, x + far * arrow[0], y - far * arrow[1]);
  } else if (arrow) {
    camera.pan(-PAN * arrow[0], -PAN * arrow[1]);
    picture.moved();
  } else if (["+", "=", "-", "0"].includes(event.key)) {
    turnTo(event.key, picture);
  } else if (event.key === "Enter" && hand.movable()) {
    take(picture, hand, held);
  } else if (event.key === "Escape" && held.row >= 0) {
    release(hand, held);
  } else {
    return;
  }
  event.preventDefault();
}

/** What a key, or the button with this sign, does to the camera. */
export function turnTo(sign, picture) {
  if (!picture.scene) return;
  if (sign === "0") picture.camera.fit(picture.scene.points);
  else picture.camera.zoom(sign === "-" ? 1 / 1.5 : 1.5);
  picture.moved();
}

/** Enter takes the point nearest to the middle, or lets it go. */
function take(picture, hand, held) {
  if (held.row >= 0) {
    release(hand, held);
    return;
  }
  const { width, height } = picture.camera;
  held.row = picture.nearest(width / 2, height / 2, Infinity);
  held.byKeys = true;
  hand.grab(held.row);
  hand.say("Arrow keys move the marked point, with Shift by a tenth. Enter lets go.");
}
