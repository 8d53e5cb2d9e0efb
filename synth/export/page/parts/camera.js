// Who looks at it: an eye that goes around a point, and the gestures that move it.

const VIEWS = { "3D": [-55, 22], Top: [-90, 89.9], Front: [-90, 0], Side: [0, 0] };
const OPENING = 0.5; // rad, from the lower to the upper edge of the view

function makeCamera([lowest, highest]) {
  const size = norm(minus(highest, lowest)) || 1;
  const home = { centre: mixed(lowest, highest, 0.5), far: 1.0, azimuth: VIEWS["3D"][0], elevation: VIEWS["3D"][1] };
  const camera = { ...home, aspect: 1 };

  camera.lookFrom = (name) => {
    [camera.azimuth, camera.elevation] = VIEWS[name];
    camera.centre = home.centre;
    camera.far = home.far;
  };
  /** Come close to a point. */
  camera.lookAt = (point, far) => Object.assign(camera, { centre: point, far });
  camera.distance = () => (camera.far * (0.41 * size)) / Math.tan(OPENING / 2) / Math.min(1, camera.aspect);
  camera.eye = () => {
    const a = (camera.azimuth * Math.PI) / 180, e = (camera.elevation * Math.PI) / 180;
    const away = [Math.cos(a) * Math.cos(e), Math.sin(a) * Math.cos(e), Math.sin(e)];
    return plus(camera.centre, scaled(away, camera.distance()));
  };
  camera.projection = () => {
    const far = camera.distance();
    const seen = lookingAt(camera.eye(), camera.centre, [0, 0, 1]);
    return times(perspective(OPENING, camera.aspect, 0.02 * far, far + 4 * size), seen);
  };
  /** The directions right and up in the view. */
  camera.sides = () => {
    const ahead = unit(minus(camera.centre, camera.eye())), right = unit(cross(ahead, [0, 0, 1]));
    return { ahead, right, up: cross(right, ahead) };
  };
  /** The direction of the ray through a point of the view, x and y from -1 to 1. */
  camera.ray = (x, y) => {
    const { ahead, right, up } = camera.sides(), t = Math.tan(OPENING / 2);
    return unit(plus(ahead, plus(scaled(right, x * t * camera.aspect), scaled(up, y * t))));
  };
  camera.turn = (across, up) => {
    camera.azimuth -= across;
    camera.elevation = Math.min(Math.max(camera.elevation + up, -89.9), 89.9);
  };
  camera.shift = (x, y) => {
    const { right, up } = camera.sides(), span = 2 * camera.distance() * Math.tan(OPENING / 2);
    camera.centre = minus(camera.centre, plus(scaled(right, x * span), scaled(up, -y * span)));
  };
  camera.approach = (factor) => {
    camera.far = Math.min(Math.max(camera.far * factor, 0.08), 4);
  };
  return camera;
}

/** Turn, shift and approach by mouse, fingers and keys; `changed` is called after each. */
function listenToGestures(canvas, camera, changed) {
  const held = new Map();
  const apart = () => {
    const [a, b] = [...held.values()];
    return { distance: Math.hypot(a.x - b.x, a.y - b.y), x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 };
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    held.set(event.pointerId, { x: event.clientX, y: event.clientY });
  });
  canvas.addEventListener("pointermove", (event) => {
    const last = held.get(event.pointerId);
    if (!last) return;
    const before = held.size === 2 ? apart() : null;
    const across = event.clientX - last.x, down = event.clientY - last.y;
    held.set(event.pointerId, { x: event.clientX, y: event.clientY });
    const height = canvas.clientHeight;
    if (before) {
      const after = apart();
      camera.approach(before.distance / Math.max(after.distance, 1));
      camera.shift((after.x - before.x) / height, (after.y - before.y) / height);
    } else if (event.shiftKey || event.buttons & 6) camera.shift(across / height, down / height);
    else camera.turn(0.35 * across, 0.35 * down);
    changed();
  });
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, (event) => held.delete(event.pointerId));
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    camera.approach(Math.exp(0.0012 * event.deltaY));
    changed();
  }, { passive: false });
  const keys = { ArrowLeft: [-6, 0], ArrowRight: [6, 0], ArrowUp: [0, -6], ArrowDown: [0, 6] };
  canvas.addEventListener("keydown", (event) => {
    if (keys[event.key]) camera.turn(...keys[event.key]);
    else if (event.key === "+") camera.approach(0.9);
    else if (event.key === "-") camera.approach(1.1);
    else return;
    event.preventDefault();
    changed();
  });
}
