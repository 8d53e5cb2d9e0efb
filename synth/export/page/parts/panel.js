// Beside the view: what was found, the shapes, the joints.

function headerOf(content, state, act) {
  const buttons = element("div", { className: "tools" },
    element("button", { type: "button", text: "Print", onclick: () => window.print() }),
    element("button", { type: "button", text: state.theme === "dark" ? "Light" : "Dark", onclick: act.theme }));
  const shape = content.shapes[state.shape];
  const number = shape && content.shapes.length > 1 ? `shape ${shape.number} of ${content.shapes.length}, ` : "";
  return element("header", {}, buttons,
    element("h1", { text: content.name }),
    content.live ? element("p", { className: "small", text: `As computed: ${content.headline}` })
      : element("p", { className: content.found ? "headline found" : "headline missed", text: `${content.found ? "✓" : "✗"} ${content.headline}` }),
    element("p", { className: "small", text: `${content.robot}, ${number}seed ${content.seed}, synth ${content.version}` }));
}

/** Buttons of which one is pressed. */
function choice(names, chosen, choose) {
  return names.map((name, index) => element("button", { type: "button", text: name, className: index === chosen ? "on" : "", ariaPressed: String(index === chosen), onclick: () => choose(index) }));
}

function shapesOf(content, state, act) {
  if (content.shapes.length < 2) return "";
  const names = content.shapes.map((shape) => `${shape.number}`);
  return element("section", { className: "screen" }, element("h2", { text: content.found ? "Shape" : "Nearest shapes found" }),
    element("div", { className: "chips row" }, ...choice(names, state.shape, act.shape)),
    element("p", { className: "small", text: `${content.shapes[state.shape].category}; all of them are compared below` }));
}

/** Sliders that move the arm within its limits; the one who holds it calls `show` with the joint angles. */
function jointsOf(content, state, act) {
  const shape = content.shapes[state.shape];
  if (!shape) return { node: "", show() {} };
  const tip = element("output", { className: "small" });
  const rows = shape.arm.limits.map((limits, joint) => {
    const value = element("output"), name = `Joint ${joint + 1}`;
    const slider = element("input", { type: "range", ariaLabel: name, min: deg(limits[0], 4), max: deg(limits[1], 4), step: "any" });
    slider.oninput = () => act.joints(state.joints.map((angle, k) => (k === joint ? within(limits, (Math.PI / 180) * slider.valueAsNumber) : angle)));
    const ends = element("span", { className: "ends small" }, element("span", { text: `${deg(limits[0], 0)}°` }), element("span", { text: `${deg(limits[1], 0)}°` }));
    return { slider, value, node: element("label", { className: "joint" }, element("span", { text: name }), slider, value, ends) };
  });
  const hold = content.instructions && state.shape === 0;
  const node = element("section", { className: "screen" }, element("h2", { text: "Joints" }), ...rows.map((row) => row.node), tip,
    hold ? element("button", { type: "button", className: "quiet", text: "To the posture in which the link is bent", onclick: () => act.joints(content.instructions.hold) }) : "");
  return {
    node,
    show(joints) {
      rows.forEach(({ slider, value }, k) => {
        slider.value = deg(joints[k], 4);
        value.textContent = `${deg(joints[k])}°`;
      });
      tip.textContent = `P5 at ${placeTold(tipOf(shape.arm, joints))}`;
    },
  };
}

/** Switches of what is shown in the view. */
function fillLayers(box, content, state, changed) {
  const there = { floor: content.floor !== null, obstacles: content.obstacles.length > 0, markers: content.shapes.some(({ arm }) => arm.markers), surface: content.shapes.length > 0, beyond: content.shapes.length > 0 };
  const switches = Object.entries(LAYERS).filter(([name]) => there[name] ?? true).map(([name, text]) => {
    const button = element("button", { type: "button", text, ariaPressed: String(state.layers[name]), className: state.layers[name] ? "on" : "" });
    button.onclick = () => {
      state.layers[name] = !state.layers[name];
      button.className = state.layers[name] ? "on" : "";
      button.ariaPressed = String(state.layers[name]);
      changed();
    };
    return button;
  });
  box.replaceChildren(...switches);
}
