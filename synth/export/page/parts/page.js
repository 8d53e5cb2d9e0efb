// The page: one state, and what is shown of it.

const content = JSON.parse(document.getElementById("content").textContent);
const [canvas, labels, hover] = ["#view canvas", "#labels", "#hover"].map((name) => document.querySelector(name));
const dark = matchMedia("(prefers-color-scheme: dark)");
const first = content.shapes[0];
const state = {
  shape: 0,
  joints: content.instructions ? content.instructions.hold : first ? first.joints[content.targets.listed[0]?.drawn ?? 0] : [0, 0],
  // While the link is bent only what is at hand is of interest.
  layers: Object.fromEntries(Object.keys(LAYERS).map((name) => [name, !(content.live ? ["beyond", "surface", "markers"] : ["beyond"]).includes(name)])),
  ghost: Boolean(content.live), // the arm is one that is wanted, and not there yet
  theme: dark.matches ? "dark" : "light",
  pixels: Math.min(window.devicePixelRatio || 1, 2),
};
const view = makeView(canvas, content, state);
view.drawn = () => placeLabels(labels, view, allNamed());
if (!view.drawing) document.getElementById("view").append(element("p", { className: "nothing", text: "This browser has no WebGL 2 to draw with; all else is beside." }));

let wanted = 0, playing = 0, joints = null, live = null;
/** All that has a name: of the solution, and of what is seen now. */
const allNamed = () => [...(live ? live.named() : []), ...namedPoints(content, state, view.size)];
/** Draw anew with the next picture of the screen; while it is printed nothing moves. */
function redraw() {
  wanted ||= requestAnimationFrame(() => {
    wanted = 0;
    view.redraw();
  });
}

const act = {
  joints(angles) {
    cancelAnimationFrame(playing);
    const { limits } = content.shapes[state.shape].arm;
    state.joints = angles.map((angle, k) => within(limits[k], angle));
    joints.show(state.joints);
    redraw();
  },
  shape(index) {
    state.shape = index;
    state.joints = content.shapes[index].joints[content.targets.listed[0]?.drawn ?? 0];
    fill();
  },
  theme() {
    setTheme(state.theme === "dark" ? "light" : "dark");
    fill();
  },
  /** Move the arm along a way, piece by piece, at 60 degrees a second. */
  play(way) {
    const lengths = way.slice(1).map((to, k) => Math.max(...to.map((angle, n) => Math.abs(angle - way[k][n]))));
    const start = performance.now();
    const step = (now) => {
      let left = ((now - start) / 1000) * (Math.PI / 3), k = 0;
      while (k < lengths.length - 1 && left > lengths[k]) left -= lengths[k++];
      const share = Math.min(1, left / (lengths[k] || 1));
      act.joints(mixed(way[k], way[k + 1] ?? way[k], share));
      if (share < 1) playing = requestAnimationFrame(step);
    };
    playing = requestAnimationFrame(step);
  },
};

function setTheme(name) {
  state.theme = name;
  document.documentElement.dataset.theme = name;
}

/** Fill the panel anew; its place is kept. */
function fill() {
  const panel = document.getElementById("panel"), top = panel.scrollTop;
  joints = jointsOf(content, state, act);
  panel.replaceChildren(...[headerOf(content, state, act), live && live.node, ...missedOf(content), ...(live ? [] : [shapesOf(content, state, act), joints.node]), ...stepsOf(content, state), targetsOf(content, state, act), ...(live ? [] : [waysOf(content, state, act), comparedOf(content, state, act)])].filter(Boolean));
  panel.scrollTop = top;
  joints.show(state.joints);
  redraw();
}

setTheme(state.theme);
if (content.live) live = makeLive(content, state, view, act);
fillLayers(document.getElementById("layers"), content, state, redraw);
document.getElementById("views").replaceChildren(...Object.keys(VIEWS).map((name) => element("button", { type: "button", text: name, onclick: () => { view.camera.lookFrom(name); redraw(); } })));
if (live) document.getElementById("views").append(element("button", { type: "button", text: "Close", onclick: () => { view.camera.lookAt(pointsOf(first.arm, state.joints).P3, 0.3); redraw(); } }));
listenToGestures(canvas, view.camera, redraw);
listenToPointer(canvas, hover, content, state, view, allNamed, (angles) => act.joints(angles));
dark.addEventListener("change", () => { setTheme(dark.matches ? "dark" : "light"); fill(); });
new ResizeObserver(redraw).observe(canvas);

// On paper all is light, and a picture of its own size stands for the view.
window.addEventListener("beforeprint", () => {
  if (!view.drawing) return;
  const { theme, pixels } = state, { box } = view;
  setTheme("light");
  Object.assign(view, { box: () => ({ width: 780, height: 520 }) });
  state.pixels = 2.5;
  view.redraw();
  document.getElementById("picture").src = canvas.toDataURL("image/png");
  window.addEventListener("afterprint", () => {
    Object.assign(view, { box });
    state.pixels = pixels;
    setTheme(theme);
    redraw();
  }, { once: true });
});
fill();
