// Words over the view: names beside what they name, and values under the pointer.

const mm = (value, digits = 1) => (1000 * value).toFixed(digits).replace(/^-(0\.?0*)$/, "$1");
const deg = (value, digits = 1) => ((180 / Math.PI) * value).toFixed(digits).replace(/^-(0\.?0*)$/, "$1");
const placeTold = (point) => `${mm(point[0])}, ${mm(point[1])}, ${mm(point[2])} mm`;

/** An element with its class, text and what it holds. */
function element(tag, { text, ...properties } = {}, ...inside) {
  const made = Object.assign(document.createElement(tag), properties);
  if (text !== undefined) made.textContent = text;
  made.append(...inside);
  return made;
}

/** All that has a name in the view: where, what it is called, what is told of it. */
function namedPoints(content, state, size) {
  const found = [], shape = content.shapes[state.shape];
  if (state.layers.targets)
    for (const { drawn, number, name, tolerance } of content.targets.listed) {
      const met = Boolean(shape && shape.within[drawn]), miss = shape ? `miss ${shape.missed_by[drawn]} of ${tolerance} mm` : "no shape";
      const at = content.targets.positions[drawn];
      found.push({ at, text: `${met ? "✓" : "✗"} ${name}`, kind: met ? "target found" : "target missed", told: [`${number} ${name}, ${met ? "reached" : "missed"}`, placeTold(at), miss] });
    }
  if (state.layers.markers && shape && shape.arm.markers)
    for (const [name, at] of Object.entries(pointsOf(shape.arm, state.joints))) found.push({ at, text: name, kind: "marker", told: [name, placeTold(at)] });
  if (state.layers.obstacles)
    for (const { name, centre, ends } of content.obstacles.slice(0, 30)) {
      const at = centre || mixed(ends[0], ends[1], 0.5);
      found.push({ at, text: name, kind: "obstacle", told: [name, placeTold(at)] });
    }
  if (state.layers.axes) {
    for (const [name, [, axis]] of Object.entries(FRAME)) found.push({ at: scaled(axis, 0.115 * size), text: name, kind: "axis", told: [`${name} of the task frame`] });
  }
  return found;
}

const SIDES = [[10, -8], [-10, -8], [10, 9], [-10, 9], [0, -18], [0, 18], [18, 0], [-18, 0]];

/** Put names beside their points, each where it covers no other; places in shares of the view, so that it prints. */
function placeLabels(box, view, points) {
  const { width, height } = view.box(), projection = view.camera.projection(), taken = [];
  const made = [];
  for (const point of points) {
    const { x, y, before } = projected(projection, point.at);
    if (!before || Math.abs(x) > 1 || Math.abs(y) > 1) continue;
    const px = ((x + 1) / 2) * width, py = ((1 - y) / 2) * height, wide = 7 * point.text.length + 6;
    const free = SIDES.map(([dx, dy]) => ({ left: dx < 0 ? px + dx - wide : dx ? px + dx : px - wide / 2, top: py + dy - 8 }))
      .find(({ left, top }) => !taken.some((other) => left < other.left + other.wide && other.left < left + wide && Math.abs(top - other.top) < 15));
    if (!free) continue;
    taken.push({ ...free, wide }, { left: px - 5, top: py - 8, wide: 10 });
    const label = element("span", { className: `label ${point.kind}`, text: point.text });
    label.style.left = `${(100 * free.left) / width}%`;
    label.style.top = `${(100 * free.top) / height}%`;
    made.push(label);
  }
  box.replaceChildren(...made);
}

/** What is told of what is under the pointer: a named point, the link, or the workspace. */
function toldAt(content, state, view, allNamed, x, y) {
  const shape = content.shapes[state.shape], { width, height } = view.box(), projection = view.camera.projection();
  const apart = (at) => {
    const p = projected(projection, at);
    return p.before ? Math.hypot(((p.x - x) * width) / 2, ((p.y - y) * height) / 2) : Infinity;
  };
  const nearest = (points) => points.map((point) => ({ point, off: apart(point.at) })).reduce((a, b) => (b.off < a.off ? b : a), { off: Infinity });
  const named = nearest(allNamed());
  if (named.off < 14) return { lines: named.point.told };
  if (!shape) return null;
  const { arm } = shape, { first } = poses(arm, state.joints), spaces = arm.centreline.length - 1;
  const link = nearest(arm.centreline.map((point, k) => ({ at: moved(first, point), k })));
  if (link.off < 9) return { lines: [`Link, ${((1000 * arm.length * link.point.k) / spaces).toFixed(0)} mm from P2`, placeTold(link.point.at)] };
  if (!state.layers.surface || !view.workspace) return null;
  const hit = jointsHit(view.workspace, view.camera.eye(), view.camera.ray(x, y));
  if (!hit) return null;
  const reachable = isReachable(arm, hit.joints, content.floor);
  if (!reachable && !state.layers.beyond) return null;
  const lines = [reachable ? "Workspace" : "Beyond limits or floor", placeTold(tipOf(arm, hit.joints)), `joints ${deg(hit.joints[0])}, ${deg(hit.joints[1])}°`];
  return { lines, joints: reachable ? hit.joints : null };
}

/** Tell what is under the pointer, and take the arm to where the workspace is clicked. */
function listenToPointer(canvas, hover, content, state, view, allNamed, goTo) {
  let pressed = null;
  const at = (event) => {
    const box = canvas.getBoundingClientRect();
    return [(2 * (event.clientX - box.left)) / box.width - 1, 1 - (2 * (event.clientY - box.top)) / box.height];
  };
  canvas.addEventListener("pointerdown", (event) => (pressed = [event.clientX, event.clientY]));
  canvas.addEventListener("pointermove", (event) => {
    const told = event.buttons ? null : toldAt(content, state, view, allNamed, ...at(event));
    hover.className = told ? "shown" : "";
    if (!told) return;
    hover.replaceChildren(...told.lines.map((text) => element("div", { text })));
    const box = canvas.getBoundingClientRect();
    hover.style.left = `${Math.min(event.clientX - box.left + 16, box.width - hover.offsetWidth - 8)}px`;
    hover.style.top = `${Math.min(event.clientY - box.top + 16, box.height - hover.offsetHeight - 8)}px`;
  });
  canvas.addEventListener("pointerleave", () => (hover.className = ""));
  canvas.addEventListener("pointerup", (event) => {
    if (!pressed || Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) > 4) return;
    const told = toldAt(content, state, view, allNamed, ...at(event));
    if (told && told.joints) goTo(told.joints);
  });
}
