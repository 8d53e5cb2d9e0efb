// The scene: what is drawn of a shape at its joint angles, layer by layer.

const LAYERS = {
  surface: "Workspace", beyond: "Beyond the limits", targets: "Targets", obstacles: "Obstacles", markers: "Markers", axes: "Axes", floor: "Floor",
};
const COLOURS = {
  light: { back: [0.975, 0.977, 0.98], link: "#0072b2", rod: "#5d6b78", base: "#2f3740", axis: "#d55e00", surface: "#2a9d8f", found: "#008060", missed: "#c8372d", obstacle: "#a08a4a", floor: "#5a6672", ink: "#1c2126", reach: "#46525e" },
  dark: { back: [0.075, 0.086, 0.1], link: "#3aa0e0", rod: "#aab4be", base: "#7d8893", axis: "#f08a3c", surface: "#46c2b2", found: "#3ecf9a", missed: "#ff6b5e", obstacle: "#c9b26a", floor: "#9aa6b2", ink: "#e8ecf0", reach: "#aab4be" },
};
const FRAME = { x: ["#c8372d", [1, 0, 0]], y: ["#2e8b3d", [0, 1, 0]], z: ["#2f6fd0", [0, 0, 1]] };
const rgba = (hex, alpha = 1) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255).concat(alpha);

/** Lowest and highest coordinates of points. */
function boundsOf(points) {
  const along = (k, pick) => points.reduce((best, point) => pick(best, point[k]), points[0][k]);
  return [Math.min, Math.max].map((pick) => [0, 1, 2].map((k) => along(k, pick)));
}

/** What the view is fitted to: the targets, the arms and what the first shape reaches. */
function shownBounds(content) {
  const points = [...content.targets.positions, [0, 0, content.floor ?? 0]];
  for (const { arm } of content.shapes.slice(0, 1)) {
    const [first, second] = arm.limits;
    for (let i = 0; i <= 12; i++)
      for (let j = 0; j <= 12; j++)
        points.push(tipOf(arm, [first[0] + ((first[1] - first[0]) * i) / 12, second[0] + ((second[1] - second[0]) * j) / 12]));
    points.push(...arm.axis1.map((point) => moved(rigid(arm.joint1), point)));
  }
  return boundsOf(points);
}

/** The marks of the targets: balls where they are reached, crossed bars where they are missed. */
function targetMeshes(content, shape, size) {
  const { positions, on_path: onPath } = content.targets, named = new Set(content.targets.listed.map((each) => each.drawn));
  const many = positions.length > 60, marks = { found: [], missed: [] };
  positions.forEach((position, index) => {
    const found = Boolean(shape && shape.within[index]), large = named.has(index);
    if (onPath[index] && found && !large) return;
    const radius = large || !many ? size : size / 2;
    marks[found ? "found" : "missed"].push(found ? ballMesh(position, radius, large ? 16 : 8) : jackMesh(position, radius));
  });
  const ways = content.paths.map(({ points }) => tubeMesh(points, size / 4, 8, 2));
  return { found: joined(marks.found), missed: joined(marks.missed), paths: joined(ways) };
}

function makeView(canvas, content, state) {
  const drawing = makeDrawing(canvas), bounds = shownBounds(content), camera = makeCamera(bounds);
  if (!drawing) return { camera, drawing, redraw() {}, workspace: null };
  const { gl, stored, removed, draw } = drawing;
  const size = norm(minus(bounds[1], bounds[0])), mark = 0.0065 * size;
  const frame = Object.fromEntries(Object.entries(FRAME).map(([name, [, axis]]) =>
    [name, stored(tubeMesh([[0, 0, 0], scaled(axis, 0.1 * size)], 0.0014 * size, 8, 2))]));
  const obstacles = stored(joined(content.obstacles.map((each) =>
    each.size ? boxMesh(each.centre, each.size, each.axes) : tubeMesh(norm(minus(each.ends[1], each.ends[0])) ? each.ends : [each.ends[0]], each.radius, 36, 10))));
  const plane = stored(planeMesh(content.floor ?? 0, mixed(...bounds, 0.5), size));
  const ball = stored(ballMesh([0, 0, 0], 1, 20));
  let kept = {}, view = null;

  /** Make the meshes of the shape that is shown, and let those of the last one go. */
  function load() {
    Object.values(kept).forEach(removed);
    const shape = content.shapes[state.shape], marks = targetMeshes(content, shape, mark);
    kept = Object.fromEntries(Object.entries({ ...marks, ...(shape ? armMeshes(shape.arm) : {}) }).map(([name, mesh]) => [name, stored(mesh)]));
    view.workspace = shape ? workspaceOf(shape.arm) : null;
    if (shape) kept.surface = stored(view.workspace);
    view.loaded = state.shape;
  }

  function redraw() {
    if (view.loaded !== state.shape) load();
    const { width: wide, height: high } = view.box(), width = Math.round(wide * state.pixels), height = Math.round(high * state.pixels);
    if (width && height && (canvas.width !== width || canvas.height !== height)) Object.assign(canvas, { width, height });
    camera.aspect = canvas.width / canvas.height;
    const colours = COLOURS[state.theme], shape = content.shapes[state.shape], eye = camera.eye();
    const { right, up } = camera.sides(), on = state.layers;
    const key = unit(plus(plus(unit(minus(eye, camera.centre)), scaled(up, 0.9)), scaled(right, -0.5)));
    const common = { projection: camera.projection(), eye, key, flatness: 0, pose: IDENTITY };
    const solid = (mesh, colour, more = {}) => mesh && draw("solid", mesh, { ...common, colour: rgba(colour, more.alpha), ...more });
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(...colours.back, 1);
    gl.enable(gl.DEPTH_TEST);
    gl.depthMask(true);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT | gl.STENCIL_BUFFER_BIT);

    const pose = shape && poses(shape.arm, state.joints);
    if (shape) {
      solid(kept.base, colours.base, { pose: pose.base });
      if (!state.ghost) {
        solid(kept.link, colours.link, { pose: pose.first });
        solid(kept.rod, colours.rod, { pose: pose.second });
      }
      if (on.axes) {
        solid(kept.axis1, colours.axis, { pose: pose.base, flatness: 0.6 });
        solid(kept.axis2, colours.axis, { pose: pose.second, flatness: 0.6 });
      }
      const spots = Object.values(pointsOf(shape.arm, state.joints)), tip = spots.pop();
      const shownBall = (at, radius, colour) => solid(ball, colour, { pose: [radius, 0, 0, 0, 0, radius, 0, 0, 0, 0, radius, 0, ...at, 1] });
      if (!state.ghost) shownBall(tip, 1.35 * Math.max(shape.arm.rod_radius, 0.006), colours.rod);
      if (on.markers && shape.arm.markers) spots.forEach((at) => shownBall(at, 0.75 * mark, colours.ink));
    }
    if (on.targets) {
      solid(kept.found, colours.found, { flatness: 0.25 });
      solid(kept.missed, colours.missed, { flatness: 0.25 });
      solid(kept.paths, colours.ink, { flatness: 0.5 });
    }
    if (on.axes) for (const name in frame) solid(frame[name], FRAME[name][0], { flatness: 0.5 });
    view.more.forEach((paint) => paint({ solid, ball, colours, mark }));
    if (pose && state.ghost) {
      gl.enable(gl.CULL_FACE);
      solid(kept.link, colours.link, { pose: pose.first, alpha: 0.35 });
      solid(kept.rod, colours.rod, { pose: pose.second, alpha: 0.35 });
      gl.disable(gl.CULL_FACE);
    }

    gl.depthMask(false);
    if (on.floor && content.floor !== null) {
      if (pose) shadow(pose);
      draw("floor", plane, { ...common, colour: rgba(colours.floor, 0.4), middle: camera.centre, extent: size });
    }
    if (on.surface && shape) {
      gl.enable(gl.CULL_FACE);
      const [first, second] = shape.arm.limits;
      for (const side of [gl.FRONT, gl.BACK]) {
        gl.cullFace(side);
        draw("surface", kept.surface, { ...common, colour: rgba(colours.surface), limits: [...first, ...second], floorHeight: (content.floor ?? -1e6) - 1e-6, beyond: on.beyond ? 1 : 0 });
      }
      gl.disable(gl.CULL_FACE);
    }
    if (on.obstacles) {
      gl.enable(gl.CULL_FACE);
      for (const side of [gl.FRONT, gl.BACK]) {
        gl.cullFace(side);
        solid(obstacles, colours.obstacle, { alpha: 0.24, flatness: 0.2 });
      }
      gl.disable(gl.CULL_FACE);
    }
    gl.depthMask(true);
    view.drawn();
  }

  /** What lies under the arm, straight down on the floor; each spot once, whatever is above it. */
  function shadow(pose) {
    const down = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, content.floor + 0.0006, 1];
    const dark = { projection: camera.projection(), colour: [0, 0, 0, state.theme === "dark" ? 0.35 : 0.13], flatness: 1, eye: camera.eye(), key: [0, 0, 1] };
    gl.enable(gl.STENCIL_TEST);
    gl.stencilFunc(gl.EQUAL, 0, 1);
    gl.stencilOp(gl.KEEP, gl.KEEP, gl.INCR);
    for (const [mesh, at] of [[kept.base, pose.base], [kept.link, pose.first], [kept.rod, pose.second]])
      draw("solid", mesh, { ...dark, pose: times(down, at) });
    gl.disable(gl.STENCIL_TEST);
  }

  view = { camera, drawing, redraw, mark, size, workspace: null, loaded: null, more: [], drawn() {},
    box: () => ({ width: canvas.clientWidth, height: canvas.clientHeight }),
  };
  return view;
}

/** The square on which the floor is drawn. */
function planeMesh(height, middle, size) {
  const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]];
  return {
    positions: corners.flatMap(([x, y]) => [middle[0] + 3 * size * x, middle[1] + 3 * size * y, height]),
    normals: corners.flatMap(() => [0, 0, 1]),
    triangles: [0, 1, 2, 0, 2, 3],
  };
}
