// The live part: markers as they come, wanted against present, one arrow for what to do now, dials, the lock.

const SVG = "http://www.w3.org/2000/svg"; // a name that never leads anywhere
const LOCK = { closed: "M7 11V8a5 5 0 0 1 10 0v3", open: "M7 11V8a5 5 0 0 1 9.6-2" };
const BAR = 0.15; // m along axis 2, where a tilt is shown as a way
const ENLARGED = 8; // the arrow is drawn so many times as long as the way

function drawnSvg(tag, attributes, ...inside) {
  const made = document.createElementNS(SVG, tag);
  Object.entries(attributes).forEach(([name, value]) => made.setAttribute(name, value));
  made.append(...inside);
  return made;
}

function lockSign(closed) {
  return drawnSvg("svg", { viewBox: "0 0 24 24", class: "lock" },
    drawnSvg("path", { d: closed ? LOCK.closed : LOCK.open, fill: "none", stroke: "currentColor", "stroke-width": 2 }),
    drawnSvg("rect", { x: 4.5, y: 11, width: 15, height: 10.5, rx: 2.5, fill: "currentColor" }));
}

/** A dial from no miss to twice the tolerance: a needle for the miss expected, a bar up to where 19 of 20 are. */
function dialOf({ name, tolerance, expected_miss, miss_95, probability_within: chance }) {
  const expected = expected_miss ?? Infinity, most = miss_95 ?? Infinity; // JSON has no infinity
  const angle = (miss) => Math.PI * (1 - Math.min(miss / (2 * tolerance), 1));
  const at = (miss, radius) => `${50 + radius * Math.cos(angle(miss))} ${50 - radius * Math.sin(angle(miss))}`;
  const arc = (from, to, kind) => drawnSvg("path", { d: `M${at(from, 40)} A40 40 0 0 1 ${at(to, 40)}`, class: kind });
  const met = most <= tolerance;
  return element("figure", { className: met ? "dial found" : "dial missed" },
    drawnSvg("svg", { viewBox: "0 0 100 56" }, arc(0, tolerance, "inside"), arc(tolerance, 2 * tolerance, "outside"),
      drawnSvg("path", { d: `M${at(expected, 33)} A33 33 0 0 1 ${at(most, 33)}`, class: "spread" }),
      drawnSvg("path", { d: `M50 50 L${at(expected, 38)}`, class: "needle" })),
    element("figcaption", {}, element("b", { text: `${met ? "✓" : "✗"} ${name}` }),
      element("span", { text: `${mm(Math.ceil(1e4 * expected) / 1e4)} of ${+(1000 * tolerance).toFixed(3)} mm` }),
      element("span", { text: `${Math.min(Math.floor(100 * chance), 99)} % within` })));
}

/** Two notes up when the link may be locked, one down when it may no more. */
function makeSound() {
  let audio = null;
  const note = (pitch, after) => {
    const tone = audio.createOscillator(), loud = audio.createGain(), start = audio.currentTime + after;
    tone.frequency.value = pitch;
    loud.gain.setValueAtTime(0.12, start);
    loud.gain.exponentialRampToValueAtTime(0.001, start + 0.35);
    tone.connect(loud).connect(audio.destination);
    tone.start(start);
    tone.stop(start + 0.4);
  };
  return {
    toggle: () => (audio = audio ? void audio.close() : new AudioContext()) !== undefined && audio !== null,
    tell: (lock) => audio && (lock ? [note(660, 0), note(880, 0.15)] : note(330, 0)),
  };
}

/** A rigid transform that lays z along a direction at a place. */
function alongFrom(place, direction) {
  const z = unit(direction), x = unit(cross(Math.abs(z[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0], z)), y = cross(z, x);
  return [...x, 0, ...y, 0, ...z, 0, ...place, 1];
}

function makeLive(content, state, view, act) {
  const head = element("div", { className: "verdict waiting" }), words = element("p", { className: "words" });
  const enlarged = element("p", { className: "small", text: `Orange is what is seen, green where it is to be. The arrow is ${ENLARGED} times as long as the way.`, hidden: true }), dials = element("div", { className: "dials" });
  const full = element("ul", { className: "small" }), source = element("p", { className: "small" }), sound = makeSound();
  const switched = element("button", { type: "button", className: "quiet", text: "Sound on" });
  switched.onclick = () => (switched.textContent = sound.toggle() ? "Sound off" : "Sound on");
  const node = element("section", { id: "live" }, head, words, enlarged, dials, element("details", {}, element("summary", { text: "In full" }), full), source, switched);
  const arm = content.shapes[0].arm, base = rigid(arm.joint1), live = { node, markers: {}, check: null, locked: null, connection: "", up: "z", last: 0, frames: 0, delay: 0 };

  function tell(status, lock, title, message) {
    head.className = `verdict ${status}`;
    head.replaceChildren(lockSign(lock), element("div", {}, element("strong", { text: title }), element("div", { text: message })));
  }

  const TITLES = { lock: "Lock", correct: "Correct", best_possible: "Leave it", unusable: "Not to be used", moving: "Hold still" };
  function show(check) {
    if (live.locked !== check.lock && check.status !== "moving") {
      if (live.locked !== null) sound.tell(check.lock);
      live.locked = check.lock;
    }
    live.check = check;
    tell(check.status, check.lock, TITLES[check.status], check.message);
    words.textContent = check.correction ? check.correction.words : "";
    enlarged.hidden = !check.correction;
    dials.replaceChildren(...check.targets.slice(0, 12).map(dialOf));
    full.replaceChildren(...check.words.map((text) => element("li", { text: text.replace(/^• /, "") })));
    redraw();
  }

  function see({ count, at, markers, joints, up }) {
    Object.assign(live, { markers, up, last: performance.now(), frames: count, delay: Date.now() / 1000 - at });
    if (joints.some((angle, k) => Math.abs(angle - state.joints[k]) > 1e-4)) act.joints(joints);
    redraw();
  }

  /** What was told is of a while ago: nobody is to lock by it. */
  function forget(why) {
    if (!live.check) return;
    Object.assign(live, { check: null, markers: {} });
    tell("waiting", false, "Nothing seen", why);
    words.textContent = "";
    enlarged.hidden = true;
    dials.replaceChildren();
    full.replaceChildren();
    redraw();
  }

  function told() {
    const lost = live.last && performance.now() - live.last > 1500;
    if (lost || live.connection) forget(live.connection || "no marker is seen any more");
    const flow = !live.frames ? "no marker was seen yet" : lost ? "no marker is seen any more" : `${Object.keys(live.markers).length} markers, ${Math.max(0, 1000 * live.delay).toFixed(0)} ms old`;
    const turned = live.up === "z" ? "" : `by P1 and P2 ${live.up} is up in the stream: its frame was turned so that z is`;
    source.textContent = [live.connection, flow, turned, live.source].filter(Boolean).join("; ");
  }

  const events = new EventSource("/events");
  events.addEventListener("frame", (event) => see(JSON.parse(event.data)));
  events.addEventListener("check", (event) => show(JSON.parse(event.data)));
  events.addEventListener("source", (event) => (live.source = JSON.parse(event.data).message));
  events.onopen = () => (live.connection = "");
  events.onerror = () => (live.connection = "the connection was lost; trying again");
  setInterval(told, 250);
  tell("waiting", false, "Waiting", "for markers");

  /** The way that is worth most now: of the link's end, or of a point on axis 2 that shows the tilt. */
  live.arrow = () => {
    const { check } = live;
    if (!check || !check.correction) return null;
    const { move, rotate } = check.correction, { point, direction } = check.measured.axis2;
    const tilt = scaled(cross(rotate, direction), BAR), shift = norm(move) >= norm(tilt);
    return { from: moved(base, shift ? point : plus(point, scaled(direction, BAR))), way: minus(moved(base, shift ? move : tilt), moved(base, [0, 0, 0])) };
  };
  live.named = () => Object.entries(live.markers).map(([name, place]) => ({ at: moved(base, place), text: name, kind: "seen", told: [`${name} is at`, placeTold(moved(base, place))] }));

  /** Where the markers are to be: by the correction, or by the shape where there is none. */
  live.wanted = () => {
    const points = pointsOf(arm, state.joints), aim = live.check?.correction?.markers ?? {};
    return Object.fromEntries(Object.entries(points).filter(([name]) => name in live.markers).map(([name, at]) => [name, aim[name] && Math.abs(state.joints[1] - Math.PI) < 1e-3 ? moved(base, aim[name]) : at]));
  };

  const needle = view.drawing && view.drawing.stored(joined([tubeMesh([[0, 0, 0], [0, 0, 0.78]], 0.022, 16, 3), coneMesh([0, 0, 0.72], 0.07, 0.28)]));
  const stick = view.drawing && view.drawing.stored(tubeMesh([[0, 0, 0], [0, 0, 1]], 1, 12, 0));
  view.more.push(({ solid, ball, colours, mark }) => {
    const spot = (at, radius) => [radius, 0, 0, 0, 0, radius, 0, 0, 0, 0, radius, 0, ...at, 1];
    const bar = (a, b, radius, colour, alpha) => {
      const along = minus(b, a), pose = alongFrom(a, along);
      solid(stick, colour, { pose: times(pose, [radius, 0, 0, 0, 0, radius, 0, 0, 0, 0, norm(along), 0, 0, 0, 0, 1]), alpha, flatness: 0.3 });
    };
    const seen = Object.fromEntries(Object.entries(live.markers).map(([name, place]) => [name, moved(base, place)]));
    for (const pair of [["P1", "P2"], ["P3", "P4"], ["P4", "P5"], ["A2:-150", "A2:150"]])
      if (pair.every((name) => seen[name])) bar(seen[pair[0]], seen[pair[1]], 0.3 * mark, colours.axis);
    Object.values(seen).forEach((at) => solid(ball, colours.axis, { pose: spot(at, 0.9 * mark) }));
    const wanted = live.wanted();
    for (const name of Object.keys(wanted)) {
      bar(seen[name], wanted[name], 0.22 * mark, colours.found);
      solid(ball, colours.found, { pose: spot(wanted[name], 0.9 * mark) });
    }
    const arrow = live.arrow();
    if (arrow) {
      const length = ENLARGED * norm(arrow.way);
      solid(needle, colours.missed, { pose: times(alongFrom(arrow.from, arrow.way), [length, 0, 0, 0, 0, length, 0, 0, 0, 0, length, 0, 0, 0, 0, 1]), flatness: 0.35 });
    }
  });
  return live;
}
