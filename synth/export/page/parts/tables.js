// Beside the view: targets, ways, what to do, points, and the shapes side by side.

const section = (title, ...inside) => element("section", {}, element("h2", { text: title }), ...inside);
const listOf = (tag, texts) => element(tag, {}, ...texts.map((text) => element("li", { text })));
const cellsOf = (tag, texts) => texts.map((text) => element(tag, { text }));

function targetsOf(content, state, act) {
  const shape = content.shapes[state.shape], { listed, count } = content.targets;
  const heads = ["", "", "miss", "of, mm", ...(shape && shape.found ? ["joints 1, 2, °"] : []), ...(shape && shape.clear ? ["clear"] : [])];
  const rows = listed.map(({ drawn, number, name, tolerance, default: isDefault }) => {
    const met = Boolean(shape && shape.within[drawn]);
    const joints = shape && shape.found ? [`${deg(shape.joints[drawn][0], 2)}, ${deg(shape.joints[drawn][1], 2)}`] : [];
    const row = element("tr", { className: met ? "found" : "missed" }, ...cellsOf("td", [`${met ? "✓" : "✗"} ${number}`, name, shape ? shape.missed_by[drawn] : "–", tolerance + (isDefault ? "*" : ""), ...joints, ...(shape && shape.clear ? [shape.clear[drawn] ?? "–"] : [])]));
    if (shape) {
      row.classList.add("go");
      row.tabIndex = 0;
      row.title = "Show the arm there";
      row.onclick = () => act.joints(shape.joints[drawn]);
      row.onkeydown = (event) => event.key === "Enter" && row.onclick();
    }
    return row;
  });
  const notes = [];
  if (listed.length < count) notes.push(`${listed.length} of ${count} targets; all of them: see solution.json`);
  if (listed.some((each) => each.default)) notes.push("* the default: the task states none of its own, or this one");
  return section("Targets", element("div", { className: "wide" }, element("table", {}, element("thead", {}, element("tr", {}, ...cellsOf("th", heads))), element("tbody", {}, ...rows))),
    ...notes.map((text) => element("p", { className: "small", text })));
}

function waysOf(content, state, act) {
  const ways = content.shapes[state.shape]?.ways ?? [];
  if (!ways.length) return "";
  return section("Ways", element("ul", { className: "ways" }, ...ways.map(({ told, joints }) =>
    element("li", { className: joints.length ? "" : "missed" },
      joints.length ? element("button", { type: "button", className: "play", text: "▶", ariaLabel: "Show this way", onclick: () => act.play(joints) }) : "✗ ", told))));
}

/** What to do, for the shape that the page was made for; of another one how to get its page. */
function stepsOf(content, state) {
  const told = content.instructions;
  if (!told) return [];
  const shape = content.shapes[state.shape];
  if (state.shape !== 0) return [section("What to do", element("p", { text: `The steps and points are those of shape ${content.shapes[0].number}. For this one write a page of its own: synth guide solution.json --shape ${shape.number}` }))];
  const rows = told.points.map(({ name, told: numbers }) => element("tr", { className: /^P/.test(name) ? "main" : "" }, ...cellsOf("td", [name, ...numbers])));
  return [
    section("What to do", element("p", { text: told.base }), listOf("ol", told.steps), element("p", { className: "small", text: told.kind })),
    section(told.points_title, element("table", { className: "points" }, element("thead", {}, element("tr", {}, ...cellsOf("th", ["", "x", "y", "z"]))), element("tbody", {}, ...rows))),
  ];
}

function missedOf(content) {
  const parts = [];
  if (content.why.length) parts.push(section("Why", listOf("ul", content.why)));
  if (content.help.length) parts.push(section("What would help", listOf("ul", content.help)));
  if (!content.shapes.length) parts.push(element("p", { text: "There is no shape to bend the link to." }));
  return parts;
}

function comparedOf(content, state, act) {
  if (content.shapes.length < 2) return "";
  const on = (index) => (index === state.shape ? "on" : "");
  const heads = content.shapes.map(({ number }, index) => element("th", { className: on(index) }, element("button", { type: "button", className: `pick ${on(index)}`, text: `${number}`, title: `Show shape ${number}`, onclick: () => act.shape(index) })));
  const rows = content.compared.map(({ name, values }) => element("tr", {}, element("th", { text: name }), ...values.map((text, index) => element("td", { text, className: on(index) }))));
  return section("Shapes compared", element("div", { className: "wide" }, element("table", { className: "compared" }, element("thead", {}, element("tr", {}, element("th", { text: "shape" }), ...heads)), element("tbody", {}, ...rows))));
}
