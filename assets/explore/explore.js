import { Map2D, element, extent, frame, line } from "./charts.js";
import { Film } from "./film.js";
import { Live } from "./live.js";

// The token has become a cookie; it need not stay in the address.
if (location.search) history.replaceState(null, "", location.pathname);

const $ = id => document.getElementById(id);
const clamp = (v, low, high) => Math.min(high, Math.max(low, v));
const fixed = (v, digits) => (v === null || v === undefined ? "–" : v.toFixed(digits));

const facts = () => fetch("/run.json").then(answer => answer.json());
let run = await facts();
let last, first, firsts, breakStates;
const firstsOf = of => of.ruptures.filter(r => r.first_of_wire).map(r => r.wire);
function known() {
  last = run.states.length - 1;
  first = run.ruptures[0];
  firsts = firstsOf(run);
  breakStates = [...new Set(run.ruptures.map(r => r.state))].sort((a, b) => a - b);
}
known();
const stage = $("stage"), overlay = $("overlay"), canvas = $("picture");

// ---- What is looked at. -------------------------------------------------------------------------------------------
const view = {
  state: 0, azimuth: 0, elevation: 0, centre: [...run.body.axis, 0], height: 4 * run.body.radius, perspective: 0, colour: "stress",
  hidden_layers: [], hidden_wires: [], ghost_layers: [], explode: 0, theme: "dark",
};
let shown = null;        // the view of the picture on the screen
let now = null;          // what the server told of its state
let colours = null;      // of every particle, three bytes each
let chosen = null;       // what the server told of the selected wire
let past = null;         // its stress over the whole run
let particle = null;     // the particle that was clicked
let playing = false;
let fitted = false;      // the view shows everything, and was not moved since

// With a second run, each has half of the picture.
const panes = run.other ? 2 : 1;
const pane = () => {
  const { width, height } = stage.getBoundingClientRect();
  return { width: width / panes, height };
};

// ---- The socket: one view is asked for at a time, always the newest. -----------------------------------------------
let socket, number = 0, dirty = true, retry = 500;
const asked = new Map();
const say = message => { if (socket?.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message)); };

function connect() {
  socket = new WebSocket(`ws://${location.host}/socket`);
  socket.binaryType = "arraybuffer";
  socket.onopen = () => { retry = 500; trouble(""); asked.clear(); changed(); };
  socket.onmessage = ({ data }) => (typeof data === "string" ? heard(JSON.parse(data)) : received(data));
  socket.onclose = () => {
    if (live) live.heard(live.known, false);
    trouble("The connection is lost: strandsnap has ended, or the network is gone. Trying again …");
    setTimeout(connect, retry = Math.min(2 * retry, 10000));
  };
}

function trouble(text) {
  $("trouble").hidden = !text;
  $("trouble").textContent = text;
}

function sizeOf() {
  const { width, height } = stage.getBoundingClientRect();
  const sharp = Math.min(devicePixelRatio || 1, Math.sqrt(4e6 / Math.max(1, width * height)));
  return [width, height].map(side => clamp(Math.round(side * sharp), 16, 8192));
}

// A new picture is due; it is asked for before the next repaint.
const changed = () => { dirty = true; };

function tick(time) {
  if (playing) advance(time);
  if (dirty && socket?.readyState === WebSocket.OPEN) {
    dirty = false;
    number += 1;
    const copy = structuredClone(view);
    asked.set(number, { view: copy, time: performance.now() });
    if (asked.size > 300) asked.delete(asked.keys().next().value);
    say({ look: { number, size: sizeOf(), view: copy } });
  }
  requestAnimationFrame(tick);
}

async function received(data) {
  const [kind, of, width, height, micros] = new Uint32Array(data, 0, 5);
  const bytes = new Uint8Array(data, 20);
  if (kind === 3) { colours = bytes; drawMap(); return; }
  if (kind === 2) { keep(new Blob([bytes], { type: "image/png" }), "png"); return; }
  if (kind === 4) { film.received(bytes); return; }
  const picture = await createImageBitmap(new Blob([bytes], { type: kind ? "image/png" : "image/jpeg" }));
  if (kind === 0) say({ shown: of });
  const ask = asked.get(of);
  if (!ask || (shown && of < shown.number)) return;
  const whole = kind === 1;
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
  canvas.getContext("2d").drawImage(picture, 0, 0);
  shown = { number: of, view: ask.view, whole };
  for (const key of asked.keys()) if (key < of) asked.delete(key);
  $("waiting").hidden = true;
  const took = performance.now() - ask.time;
  if (!whole) {
    stage.dataset.latency = took.toFixed(0);
    $("speed").textContent = `${width} × ${height}, drawn in ${(micros / 1000).toFixed(0)} ms, seen after ${took.toFixed(0)} ms`;
  }
  stage.dataset.shown = of;
  stage.dataset.whole = whole ? "yes" : "no";
  drawOverlay();
}

function heard(message) {
  if (message.state) {
    now = message.state;
    // A run that goes on may grow out of the picture that showed all of it.
    if (fitted && live?.newest) { fit(); changed(); }
    drawNow(); drawMap(); drawOverlay();
  }
  if (message.wire !== undefined) { chosen = message.wire; drawChosen(); }
  if (message.history) { past = message.history; drawCurve(); }
  if (message.live) heardOfRun(message.live);
  if (message.film) film.heard(message.film);
  if (message.picked !== undefined) picked(message.number, message.picked);
  const words = message.command ?? message["film-command"];
  const text = words ? `${run.command} ${words}` : message.entry;
  if (text) {
    $("command-text").hidden = false;
    $("command-text").textContent = text;
    navigator.clipboard?.writeText($("command-text").textContent).catch(() => {});
  }
  if (message.error) {
    trouble(message.error);
    if (film.making) film.end("No film was made.");
  }
}
setInterval(() => say({ greet: null }), 20000);

// ---- A run that is still going. ----------------------------------------------------------------------------------------
const live = run.live ? new Live($, say, () => { if (live.newest) toState(last); }) : null;
function heardOfRun(state) {
  live.heard(state);
  if (state.extent !== run.extent) refresh();
}
let fetching = false, stale = false;
// Takes up what the run has told since; where it keeps fewer states now, the moment on the screen stays.
async function refresh() {
  if (fetching) { stale = true; return; }
  fetching = true;
  const { every, ruptures, states } = run, before = { breaks: ruptures.length, newest: states.at(-1).time_ms };
  try { run = await facts(); } finally { fetching = false; }
  known();
  trouble("");
  slider.max = last;
  $("headline").innerHTML = run.headline;
  if (before.breaks !== run.ruptures.length) tellBreaks(before.breaks);
  drawTicks();
  const state = live.newest ? last : clamp(view.state * every / run.every, 0, last);
  if (state !== view.state || before.newest !== run.states.at(-1).time_ms) toState(state);
  if (view.selected !== undefined) { say({ history: view.selected }); drawChosen(); }
  drawCurve(); drawWarnings(); markRows();
  if (stale) { stale = false; refresh(); }
}

// ---- The camera, as src/render/camera.rs has it: x of the picture is the strand's axis at azimuth 0. -----------------
const turned = ({ azimuth, elevation }) => {
  const [a, e] = [azimuth, elevation].map(deg => deg * Math.PI / 180);
  const [ca, sa, ce, se] = [Math.cos(a), Math.sin(a), Math.cos(e), Math.sin(e)];
  return ([x, y, z]) => {
    const right = ca * z - sa * x, near = -sa * z - ca * x;
    return [right, ce * y - se * near, se * y + ce * near];
  };
};
// World direction of a direction in the picture: the rotation's transpose.
const untwisted = (of, v) => {
  const rows = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map(turned(of));
  return rows.map(row => row[0] * v[0] + row[1] * v[1] + row[2] * v[2]);
};
const followOffset = () => (view.follow !== undefined && now?.follow_offset) || 0;
const spread = ([x, y, z]) => {
  const [ax, ay] = run.body.axis, apart = 1 + view.explode;
  return [ax + (x - ax) * apart, ay + (y - ay) * apart, z];
};
// Tangent of half the angle under which the eye sees the height of the picture.
const slopeOf = of => Math.tan(of.perspective * Math.PI / 360);
function projector(of, told, left) {
  const rotate = turned(of), { width, height } = pane(), scale = height / of.height;
  const centre = [of.centre[0], of.centre[1], of.centre[2] + (of.follow !== undefined ? told?.follow_offset ?? 0 : 0)];
  const slope = slopeOf(of);
  return p => {
    const [x, y, z] = rotate(p.map((v, k) => v - centre[k]));
    // As src/render/perspective.rs has it; what lies behind the eye is nowhere.
    const share = 1 - 2 * z * slope / of.height;
    if (share < 0.05) return [NaN, NaN, z];
    return [left + width / 2 + x / share * scale, height / 2 - y / share * scale, z];
  };
}
function move([dx, dy]) {
  const { height } = stage.getBoundingClientRect(), scale = view.height / height;
  const by = untwisted(view, [-dx * scale, dy * scale, 0]);
  fitted = false;
  view.centre = view.centre.map((c, k) => c + by[k]);
}
function zoom(factor, [x, y] = [0.5 / panes, 0.5]) {
  const { width, height } = pane();
  const before = view.height;
  fitted = false;
  view.height = clamp(before * factor, 0.02 * run.body.radius, 20 * Math.max(run.body.high[2] - run.body.low[2], run.body.radius));
  const scale = (before - view.height) / height;
  const by = untwisted(view, [(x * panes % 1 - 0.5) * width * scale, (0.5 - y) * height * scale, 0]);
  view.centre = view.centre.map((c, k) => c + by[k]);
}
function orbit(dx, dy) {
  view.azimuth = ((view.azimuth + dx + 540) % 360) - 180;
  view.elevation = ((view.elevation + dy + 540) % 360) - 180;
}

function fit() {
  fitted = true;
  delete view.follow;
  const reach = now?.reach ?? [0, 1, 2].map(k => [run.body.low[k], run.body.high[k]]);
  view.centre = reach.map(([low, high]) => (low + high) / 2);
  const rotate = turned(view), { width, height } = pane();
  const apart = 1 + view.explode;
  let [w, h] = [0, 0];
  for (let k = 0; k < 8; k++) {
    const corner = reach.map(([low, high], axis) => (axis < 2 ? apart : 1) * ((k >> axis) & 1 ? high - low : low - high) / 2);
    const [x, y, z] = rotate(corner), nearer = z * slopeOf(view);
    [w, h] = [Math.max(w, Math.abs(x) * height / width + nearer), Math.max(h, Math.abs(y) + nearer)];
  }
  view.height = 2.15 * Math.max(h, w);
}
const keepPlace = angles => () => Object.assign(view, angles);
const views = {
  break: () => {
    const rupture = ruptureOf(view.selected) ?? first;
    const z = rupture?.rest_z ?? (run.body.low[2] + run.body.high[2]) / 2;
    fitted = false;
    Object.assign(view, { azimuth: -20, elevation: facing(rupture), follow: z, height: 4.2 * run.body.radius });
    view.centre = [...run.body.axis, 0];
    uncover(rupture);
  },
  home: () => { Object.assign(view, { azimuth: -28, elevation: 22 }); fit(); },
  front: keepPlace({ azimuth: 0, elevation: 0 }), back: keepPlace({ azimuth: 0, elevation: 180 }),
  top: keepPlace({ azimuth: 0, elevation: 90 }), along: keepPlace({ azimuth: -90, elevation: 0 }),
};
// The turn about the axis that brings a break to the eye, a little from above.
function facing(rupture) {
  const at = rupture?.place;
  if (!at) return 12;
  const [x, y] = [at[0] - run.body.axis[0], at[1] - run.body.axis[1]];
  return Math.hypot(x, y) < 1e-3 ? 12 : Math.atan2(y, -x) * 180 / Math.PI;
}
// Takes off the layers that lie over a break.
function uncover(rupture) {
  if (!rupture) return;
  view.hidden_layers = run.layers.map((_, k) => k).filter(k => k > rupture.layer);
  for (const box of document.querySelectorAll("#layers input")) box.checked = !view.hidden_layers.includes(+box.dataset.layer);
}
function go(name) {
  views[name]();
  $("follow").checked = view.follow !== undefined;
  changed();
}
// An eye that sees the height of the picture under 30°.
$("perspective").onchange = ({ target }) => {
  view.perspective = target.checked ? 30 : 0;
  if (fitted) fit();
  changed();
};
document.querySelectorAll("[data-view]").forEach(button => { button.onclick = () => go(button.dataset.view); });
$("follow").onchange = ({ target }) => {
  if (target.checked) {
    // The section in the middle of the picture now; before loading it lay where strain had not yet moved it.
    const { z } = rest(view.centre[2]);
    fitted = false;
    Object.assign(view, { follow: z, centre: [view.centre[0], view.centre[1], 0] });
  } else {
    view.centre[2] += followOffset();
    delete view.follow;
  }
  changed();
};
function rest(z) {
  const [low, high] = now?.reach[2] ?? [0, 1];
  const share = clamp((z - low) / Math.max(high - low, 1e-9), 0, 1);
  return { z: run.body.low[2] + share * (run.body.high[2] - run.body.low[2]) };
}

// ---- Mouse, touch and keys. -----------------------------------------------------------------------------------------
const fingers = new Map();
let pressed = null;
const inside = event => {
  const box = stage.getBoundingClientRect();
  return [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
};
stage.oncontextmenu = event => event.preventDefault();
stage.onpointerdown = event => {
  stage.focus({ preventScroll: true });
  stage.setPointerCapture(event.pointerId);
  fingers.set(event.pointerId, [event.clientX, event.clientY]);
  if (fingers.size === 1) pressed = { at: [event.clientX, event.clientY], moved: false, pan: event.button > 0 || event.shiftKey };
  stage.classList.add("turning");
  $("tip").hidden = true;
};
stage.onpointermove = event => {
  const before = fingers.get(event.pointerId);
  if (!before) return hover(event);
  const at = [event.clientX, event.clientY];
  if (pressed && Math.hypot(at[0] - pressed.at[0], at[1] - pressed.at[1]) > 3) pressed.moved = true;
  const [dx, dy] = [at[0] - before[0], at[1] - before[1]];
  if (fingers.size === 2) {
    const other = [...fingers].find(([id]) => id !== event.pointerId)[1];
    const gap = p => Math.hypot(p[0] - other[0], p[1] - other[1]);
    zoom(gap(before) / Math.max(gap(at), 1));
    move([dx / 2, dy / 2]);
  } else if (pressed?.pan || event.shiftKey) {
    move([dx, dy]);
  } else {
    orbit(dx * 0.35, dy * 0.35);
  }
  fingers.set(event.pointerId, at);
  changed();
};
stage.onpointerup = stage.onpointercancel = event => {
  fingers.delete(event.pointerId);
  if (!fingers.size) stage.classList.remove("turning");
  if (event.type === "pointerup" && pressed && !pressed.moved && event.button === 0) ask(event, "click");
  if (!fingers.size) pressed = null;
};
stage.ondblclick = event => ask(event, "centre");
stage.onwheel = event => {
  event.preventDefault();
  zoom(Math.exp(clamp(event.deltaY, -300, 300) * (event.deltaMode ? 0.04 : 0.0015)), inside(event));
  changed();
};
stage.onpointerleave = () => { $("tip").hidden = true; };

const picks = new Map();
let pick = 0, resting;
function ask(event, why) {
  picks.set(++pick, { why, at: inside(event) });
  say({ pick: { number: pick, size: sizeOf(), at: inside(event), view } });
}
function hover(event) {
  clearTimeout(resting);
  $("tip").hidden = true;
  if (event.pointerType === "mouse") resting = setTimeout(() => ask(event, "hover"), 120);
}
function picked(which, found) {
  const { why, at } = picks.get(which) ?? {};
  picks.delete(which);
  if (why === "hover") return showTip(at, found);
  if (why === "centre" && found) {
    const [x, y] = spread(found.position);
    fitted = false;
    Object.assign(view, { follow: found.rest_z, centre: [x, y, 0] });
    $("follow").checked = true;
    changed();
  }
  if (why === "click") {
    particle = found;
    const wire = found?.wire ?? null;
    // The second run may have more wires than the first.
    select(wire !== null && wire < run.wires.length ? wire : null);
  }
}
const wireName = (k, of = run) => `Wire ${of.wires[k].number}, ${of.layers[of.wires[k].layer]} layer`;
function showTip([x, y], found) {
  const tip = $("tip");
  tip.hidden = !found;
  if (!found) return;
  const of = found.other ? run.other : run;
  const lines = [found.wire === null ? `Free sphere ${found.particle}` : wireName(found.wire, of)];
  if (found.stress !== null) lines.push(`true axial stress ${fixed(found.stress, 0)} MPa`, `plastic strain ${fixed(found.plastic_strain, 1)} %`);
  lines.push(`z ${fixed(found.position[2], 2)} mm, before loading ${fixed(found.rest_z, 2)} mm`);
  tip.textContent = lines.join("\n");
  const { width, height } = stage.getBoundingClientRect();
  tip.style.left = `${Math.min(x * width + 14, width - 240)}px`;
  tip.style.top = `${Math.min(y * height + 14, height - 80)}px`;
}

stage.onkeydown = event => {
  const step = event.shiftKey ? null : 5;
  const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
  const named = { Home: "home", b: "break", B: "break", 1: "front", 2: "back", 3: "top", 4: "along" }[event.key];
  if (arrows && step) orbit(...arrows.map(v => v * step));
  else if (arrows) move(arrows.map(v => v * -40));
  else if (event.key === "+" || event.key === "=") zoom(0.85);
  else if (event.key === "-") zoom(1 / 0.85);
  else if (named) go(named);
  else if (event.key === "[") toBreak(-1);
  else if (event.key === "]") toBreak(1);
  else if (event.key === ",") toState(Math.ceil(view.state) - 1);
  else if (event.key === ".") toState(Math.floor(view.state) + 1);
  else if (event.key === " ") play(!playing);
  else if (event.key === "p" || event.key === "P") $("perspective").click();
  else if (event.key === "k" || event.key === "K") film.add();
  else return;
  event.preventDefault();
  changed();
};

// ---- Time. ----------------------------------------------------------------------------------------------------------
const slider = $("slider");
slider.max = last;
function toState(state) {
  view.state = clamp(state, 0, last);
  slider.value = view.state;
  slider.setAttribute("aria-valuetext", moment(run.states[Math.round(view.state)]));
  if (view.selected !== undefined) say({ wire: { wire: view.selected, state: view.state } });
  changed();
}
const moment = s => (run.pulled ? `${fixed(s.x, 2)} % strain` : `${fixed(s.x, 4)} ms`);
slider.oninput = () => { leave(); toState(+slider.value); };
// Who goes to another moment looks there, and no longer at what comes.
function leave() {
  play(false);
  live?.follow(false);
}
function toBreak(direction) {
  leave();
  const next = direction > 0 ? breakStates.find(s => s > view.state + 1e-6) : breakStates.findLast(s => s < view.state - 1e-6);
  if (next !== undefined) toState(next);
}
$("before").onclick = () => toBreak(-1);
$("after").onclick = () => toBreak(1);
let frameTime = null;
function play(on) {
  playing = on;
  frameTime = null;
  if (on) live?.follow(false);
  if (on && view.state >= last) toState(0);
  $("play").textContent = on ? "⏸" : "▶";
  $("play").setAttribute("aria-label", on ? "Pause" : "Play");
  $("now").setAttribute("aria-live", on ? "off" : "polite");
}
$("play").onclick = () => play(!playing);
// The whole run takes twenty seconds at rate 1, whatever its length.
function advance(time) {
  const seconds = frameTime === null ? 0 : Math.min(0.2, (time - frameTime) / 1000);
  frameTime = time;
  const next = view.state + seconds * last / 20 * +$("rate").value;
  toState(next);
  if (next >= last) play(false);
}
function drawTicks() {
  const svg = $("ticks");
  svg.replaceChildren();
  const { width } = svg.getBoundingClientRect();
  svg.setAttribute("viewBox", `0 0 ${Math.max(width, 1)} 10`);
  for (const r of run.ruptures) {
    const x = 8 + r.state / Math.max(last, 1) * (width - 16);
    element(svg, "line", { x1: x, x2: x, y1: 0, y2: r.first_of_wire ? 9 : 5, class: "mark" });
  }
}

// ---- What is selected: a wire, in every picture and table. --------------------------------------------------------------
const ruptureOf = wire => run.ruptures.find(r => r.wire === wire);
function select(wire) {
  if (wire === null) { delete view.selected; chosen = null; } else {
    view.selected = wire;
    say({ wire: { wire, state: view.state } });
    say({ history: wire });
  }
  drawChosen(); drawCurve(); drawMap(); markRows(); drawOverlay();
  changed();
}
function toRupture(r) {
  leave();
  particle = null;
  toState(r.state);
  select(r.wire);
  fitted = false;
  Object.assign(view, { follow: r.rest_z, centre: [...run.body.axis, 0] });
  view.height = Math.min(view.height, 6 * run.body.radius);
  $("follow").checked = true;
  uncover(r);
}
function markRows() {
  for (const row of document.querySelectorAll("tbody tr")) {
    row.classList.toggle("selected", +row.dataset.wire === view.selected);
    row.classList.toggle("future", +row.dataset.state > view.state + 1e-6);
  }
}

// ---- Drawing: overlay, charts, tables. -------------------------------------------------------------------------------
function drawOverlay() {
  if (!shown || !now) return;
  overlay.replaceChildren();
  const { width, height } = stage.getBoundingClientRect();
  overlay.setAttribute("viewBox", `0 0 ${width} ${height}`);
  const part = pane().width;
  drawBreaks(run, now, 0, part);
  if (run.other && now.other) {
    drawBreaks(run.other, now.other, part, width);
    element(overlay, "line", { class: "axis", x1: part, x2: part, y1: 0, y2: height });
    [[run, now, 0], [run.other, now.other, part]].forEach(([of, told, left]) => {
      element(overlay, "text", { class: "caption", x: left + 10, y: 18 }, `${of.label}, ${told.when}`);
    });
  }
  drawTriad(height);
  drawScale(part, height);
}
// The breaks of a run in its part of the picture.
function drawBreaks(of, told, left, right) {
  const { height } = pane(), project = projector(shown.view, told, left), firsts = firstsOf(of);
  const taken = [];
  for (const { order, at } of told.breaks) {
    const r = of.ruptures[order - 1];
    if (view.hidden_layers.includes(r.layer) || view.hidden_wires.includes(r.wire) || (view.cut !== undefined && at[2] > view.cut)) continue;
    const [x, y] = project(spread(at));
    if (!(x >= left && y >= 0 && x <= right && y <= height)) continue;
    element(overlay, "circle", { class: "mark", cx: x, cy: y, r: r.wire === view.selected ? 9 : 5 });
    if (r.first_of_wire && taken.every(p => Math.hypot(p[0] - x, p[1] - y) > 20)) {
      taken.push([x, y]);
      element(overlay, "circle", { class: "badge", cx: x, cy: y - 16, r: 8 });
      element(overlay, "text", { class: "number", x, y: y - 16 }, of.wires[r.wire].order === order ? firsts.indexOf(r.wire) + 1 : order);
    }
  }
}
function drawTriad(height) {
  const rotate = turned(shown.view), [x, y] = [40, height - 40];
  [["x", [1, 0, 0]], ["y", [0, 1, 0]], ["z", [0, 0, 1]]].forEach(([name, axis]) => {
    const [dx, dy] = rotate(axis).map(v => v * 26);
    element(overlay, "line", { class: "triad", x1: x, y1: y, x2: x + dx, y2: y - dy });
    element(overlay, "text", { class: "caption", x: x + 1.25 * dx - 3, y: y - 1.25 * dy + 4 }, name);
  });
}
function drawScale(width, height) {
  const scale = height / shown.view.height, raw = 110 / scale, power = 10 ** Math.floor(Math.log10(raw));
  const length = [5, 2, 1].map(v => v * power).find(v => v <= raw) ?? power;
  const [right, y] = [width - 14, height - 14], left = right - length * scale;
  element(overlay, "path", { class: "axis", d: `M${left} ${y - 4}V${y}H${right}V${y - 4}` });
  const text = element(overlay, "text", { class: "caption", x: right, y: y - 6 }, `${+length.toPrecision(3)} mm${shown.view.perspective ? " in the middle" : ""}`);
  text.setAttribute("text-anchor", "end");
}

function drawNow() {
  const words = (of, told) => {
    const layers = told.layers.map((l, k) => `${of.layers[k]} ${l.whole} of ${l.of}`).join(", ");
    const stress = of.pulled ? `, nominal stress ${fixed(told.stress, 1)} MPa` : "";
    return `${told.when}${stress}, ${fixed(told.time_ms, 3)} ms. Whole wires: ${layers || "none"}. Broken bonds: ${told.bonds_broken}.`;
  };
  $("now").textContent = now.other ? `${words(run, now)} Right: ${words(run.other, now.other)}` : words(run, now);
  $("cut").min = now.reach[2][0];
  $("cut").max = now.reach[2][1];
  if (view.cut === undefined) $("cut").value = now.reach[2][1];
  drawCurve();
  markRows();
}

let curve;
function drawCurve() {
  const svg = $("curve");
  if (!run.pulled) return;
  const ofWire = past && past.wire === view.selected ? past.stress : [];
  const beside = run.other?.curve ?? { x: [], y: [] };
  const [low, high] = extent([...run.curve.y, ...beside.y, ...ofWire, 0]);
  curve = frame(svg, { x: extent([...run.curve.x, ...beside.x]), y: [low, 1.05 * high], xTitle: run.abscissa, yTitle: "nominal stress (MPa)" });
  line(svg, curve, run.curve.x, run.curve.y, "line");
  if (run.other) line(svg, curve, beside.x, beside.y, "line beside");
  if (ofWire.length) line(svg, curve, run.curve.x, ofWire, "wire");
  const at = now ? now.x : run.states[0].x;
  element(svg, "line", { class: "now", x1: curve.px(at), x2: curve.px(at), y1: curve.top, y2: curve.bottom });
  for (const r of run.ruptures) {
    const kind = ["break", r.state > view.state + 1e-6 && "future", r.wire === view.selected && "selected"].filter(Boolean).join(" ");
    const dot = element(svg, "circle", { class: kind, cx: curve.px(r.x), cy: curve.py(r.body_stress), r: r.first_of_wire ? 4 : 2.5 });
    dot.onclick = event => { event.stopPropagation(); toRupture(r); };
    element(dot, "title", {}, `break ${r.order}: wire ${run.wires[r.wire].number}, ${r.when}`);
  }
  const selected = view.selected === undefined ? "" : `; blue: ${wireName(view.selected).toLowerCase()} at mid-gauge`;
  svg.setAttribute("aria-label", `Nominal stress over strain, ${run.ruptures.length} breaks${selected}${run.other ? `; dashed: ${run.other.label}, right` : ""}`);
}
$("curve").onclick = event => {
  if (!curve) return;
  leave();
  const x = curve.value(event.clientX);
  const off = run.states.map(s => Math.abs(s.x - x));
  toState(off.indexOf(Math.min(...off)));
};

const map = new Map2D($("map"), run.wires);
function drawMap() {
  if (!colours || !now || !run.wires.length) return;
  const broken = new Map();
  for (const { order } of now.breaks) {
    const r = run.ruptures[order - 1];
    broken.set(r.wire, [...(broken.get(r.wire) ?? []), r.bond_in_wire]);
  }
  map.draw(colours, broken, view.selected);
}
$("map").onclick = event => {
  const box = $("map").getBoundingClientRect();
  const found = map.at((event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height);
  if (!found) return;
  particle = null;
  select(found.wire);
  const share = found.particle / Math.max(1, run.wires[found.wire].len - 1);
  fitted = false;
  Object.assign(view, { follow: run.body.low[2] + share * (run.body.high[2] - run.body.low[2]), centre: [...run.body.axis, 0] });
  view.height = Math.min(view.height, 6 * run.body.radius);
  $("follow").checked = true;
};

function drawChosen() {
  const wire = view.selected, svg = $("along");
  const known = wire !== undefined && chosen?.wire === wire;
  svg.toggleAttribute("hidden", !known);
  $("chosen-title").textContent = wire === undefined ? "No wire selected" : wireName(wire);
  if (wire === undefined) {
    $("chosen-text").textContent = "Click a wire in the picture, in the map or in a table.";
  } else {
    const r = ruptureOf(wire);
    $("chosen-text").textContent = r
      ? `Broke as number ${firsts.indexOf(wire) + 1} of the wires, at ${r.when}, z = ${fixed(r.rest_z, 1)} mm before loading (${fixed(r.z, 1)} mm then), true stress ${fixed(r.stress, 0)} MPa, body ${fixed(r.body_stress, 1)} MPa, ${r.cause}.`
      : "Did not break.";
  }
  if (known) drawAlong(svg);
  drawParticle();
}
function drawAlong(svg) {
  const most = Math.max(1e-9, extent(chosen.plastic_strain)[1]), top = 0.95 * Math.max(1, extent(chosen.stress)[1]);
  const at = frame(svg, {
    x: extent(chosen.z), y: [Math.min(0, extent(chosen.stress)[0]), 1.05 * Math.max(1, extent(chosen.stress)[1])],
    xTitle: "z before loading (mm)", yTitle: `true axial stress (MPa); blue: plastic strain, at most ${fixed(most, 1)} %`,
  });
  line(svg, at, chosen.z, chosen.stress, "line");
  line(svg, at, chosen.z, chosen.plastic_strain.map(v => (v === null ? null : v / most * top)), "wire");
  for (const r of run.ruptures.filter(r => r.wire === chosen.wire && r.state <= view.state + 1e-6)) {
    element(svg, "circle", { class: "break", cx: at.px(r.rest_z), cy: at.bottom, r: 4 });
  }
  svg.setAttribute("aria-label", `${wireName(chosen.wire)}: stress ${fixed(extent(chosen.stress)[0], 0)} to ${fixed(extent(chosen.stress)[1], 0)} MPa along its length, plastic strain up to ${fixed(most, 1)} %`);
}
function drawParticle() {
  const list = $("particle");
  list.replaceChildren();
  if (!particle) return;
  const add = (name, value) => {
    const [dt, dd] = ["dt", "dd"].map(kind => document.createElement(kind));
    [dt.textContent, dd.textContent] = [name, value];
    list.append(dt, dd);
  };
  const p = particle, of = p.other ? run.other : run;
  if (run.other) add("run", of.label);
  add("particle", p.wire === null ? `free sphere ${p.particle}` : `${p.number_in_wire} of ${p.of} in wire ${of.wires[p.wire].number}`);
  add("position", `${p.position.map(v => fixed(v, 3)).join(", ")} mm (z ${fixed(p.rest_z, 3)} mm before loading)`);
  add("radius", `${fixed(p.radius, 4)} mm`);
  add("speed", `${fixed(p.speed, 3)} m/s`);
  add("contact pressure", `${fixed(p.contact_pressure, 1)} MPa`);
  if (p.wire === null) return;
  if (!p.held_by) return add("bonds", "none holds it");
  add("true axial stress", `${fixed(p.stress, 1)} MPa`);
  add("plastic strain", `${fixed(p.plastic_strain, 2)} %`);
  add("utilisation", `${fixed(p.utilisation, 1)} % of rupture`);
}

function table(into, heads) {
  const head = into.createTHead().insertRow();
  for (const [text, kind] of heads) {
    const cell = document.createElement("th");
    Object.assign(cell, { textContent: text, className: kind ?? "", scope: "col" });
    head.append(cell);
  }
  into.createTBody();
}
function addRows(into, rows) {
  const [body] = into.tBodies, heads = [...into.tHead.rows[0].cells];
  for (const { cells, wire, state, go: act, name } of rows) {
    const row = body.insertRow();
    Object.assign(row.dataset, { wire, state: state ?? -1 });
    row.onclick = act;
    cells.forEach((text, k) => {
      const cell = row.insertCell();
      cell.className = heads[k].className;
      if (k) { cell.append(text); return; }
      const button = document.createElement("button");
      Object.assign(button, { type: "button", textContent: text });
      button.setAttribute("aria-label", name);
      cell.append(button);
    });
  }
}
table($("breaks"), [["order"], ["wire", "n"], ["layer"], [run.pulled ? "strain %" : "ms", "n"], ["z mm", "n"], ["MPa", "n"]]);
// The breaks from number `from` on, and in which order wires broke.
function tellBreaks(from) {
  addRows($("breaks"), run.ruptures.slice(from).map(r => ({
  cells: [r.order, run.wires[r.wire].number, run.layers[r.layer], fixed(r.x, 3), fixed(r.rest_z, 1), fixed(r.stress, 0)],
  wire: r.wire, state: r.state, go: () => toRupture(r), name: `Break ${r.order}, wire ${run.wires[r.wire].number}`,
  })));
  for (const row of $("wires").tBodies[0].rows) row.cells[2].textContent = brokeAs(+row.dataset.wire);
}
const brokeAs = k => (firsts.includes(k) ? firsts.indexOf(k) + 1 : "–");
table($("wires"), [["wire"], ["layer"], ["broke as", "n"], ["shown"]]);
addRows($("wires"), run.wires.map((w, k) => {
  const box = document.createElement("input");
  Object.assign(box, { type: "checkbox", checked: true });
  box.setAttribute("aria-label", `Show wire ${w.number}`);
  box.onclick = event => event.stopPropagation();
  box.onchange = () => {
    view.hidden_wires = view.hidden_wires.filter(other => other !== k).concat(box.checked ? [] : [k]);
    changed();
  };
  return {
    cells: [w.number, run.layers[w.layer], brokeAs(k), box], wire: k,
    go: () => { particle = null; select(k); }, name: `Select wire ${w.number}`,
  };
}));
tellBreaks(0);

// ---- Layers, apart and cut, colours, what is taken away. -----------------------------------------------------------------
run.layers.forEach((name, k) => {
  const label = document.createElement("label"), box = document.createElement("input");
  Object.assign(box, { type: "checkbox", checked: true });
  box.dataset.layer = k;
  box.onchange = () => {
    view.hidden_layers = view.hidden_layers.filter(other => other !== k).concat(box.checked ? [] : [k]);
    changed();
  };
  label.append(box, ` ${name} (${run.wires.filter(w => w.layer === k).length})`);
  const ghost = document.createElement("button");
  Object.assign(ghost, { type: "button", className: "ghost", textContent: "ghost", title: "Draw see-through" });
  ghost.setAttribute("aria-label", `ghost: ${name} layer see-through`);
  ghost.dataset.layer = k;
  ghost.onclick = () => {
    const solid = view.ghost_layers.includes(k);
    view.ghost_layers = view.ghost_layers.filter(other => other !== k).concat(solid ? [] : [k]);
    tellGhosts();
    changed();
  };
  const row = document.createElement("div");
  row.className = "layer";
  row.append(label, ghost);
  $("layers").append(row);
});
function tellGhosts() {
  for (const button of document.querySelectorAll("#layers .ghost")) {
    button.setAttribute("aria-pressed", view.ghost_layers.includes(+button.dataset.layer));
  }
}
tellGhosts();
$("explode").oninput = ({ target }) => { view.explode = +target.value; changed(); };
$("cut").oninput = ({ target }) => {
  if (+target.value >= +target.max) { delete view.cut; } else { view.cut = +target.value; }
  tellCut();
  changed();
};
function tellCut() {
  $("cut-text").textContent = view.cut === undefined ? "whole" : `what lies above ${fixed(view.cut, 1)} mm is cut off`;
}

const colourOf = () => run.colours.find(c => c.word === view.colour);
for (const { word, about } of run.colours) $("colour").add(new Option(about, word));
function drawLegend() {
  const colour = colourOf(), legend = $("legend");
  legend.replaceChildren();
  const add = (parent, name, text = "") => {
    const made = document.createElement(name);
    made.textContent = text;
    parent.append(made);
    return made;
  };
  $("range").hidden = !colour.range;
  if (colour.range) {
    const scale = add(legend, "div"), bar = add(scale, "div");
    scale.className = "scale";
    bar.className = "bar";
    const [least, most] = colour.range, whole = Math.max(most - least, 1e-30);
    const tell = () => {
      const ends = view.range ?? colour.range, [low, high] = ends.map(v => 100 * clamp((v - least) / whole, 0, 1));
      const at = k => low + (high - low) * k / (colour.stops.length - 1);
      bar.style.background = `linear-gradient(to right, ${colour.stops.map((stop, k) => `${stop} ${at(k)}%`).join(",")})`;
      [$("low").value, $("high").value] = ends.map(v => +v.toPrecision(4));
    };
    // A handle at either end of the colours.
    ["low", "high"].forEach((end, k) => {
      const handle = add(scale, "input");
      Object.assign(handle, { type: "range", min: least, max: most, step: "any" });
      handle.value = (view.range ?? colour.range)[k];
      handle.dataset.end = end;
      handle.setAttribute("aria-label", `${end} end of the colours, ${colour.title}`);
      handle.oninput = () => {
        const ends = [...(view.range ?? colour.range)], room = whole / 1000;
        ends[k] = k ? Math.max(+handle.value, ends[0] + room) : Math.min(+handle.value, ends[1] - room);
        handle.value = ends[k];
        view.range = ends;
        tell();
        changed();
      };
    });
    add(legend, "div", colour.title).className = "muted";
    tell();
    return;
  }
  const chips = add(legend, "div");
  chips.className = "chips";
  const names = colour.word === "layer" ? run.layers : colour.categories.slice(0, 9).map((_, k) => `${k + 1}`);
  names.forEach((name, k) => {
    const chip = add(chips, "span");
    add(chip, "span").className = "swatch";
    chip.lastChild.style.background = colour.categories[k];
    chip.append(name);
  });
}
$("colour").onchange = ({ target }) => { view.colour = target.value; delete view.range; drawLegend(); changed(); };
$("low").onchange = $("high").onchange = () => {
  const [low, high] = [+$("low").value, +$("high").value];
  if (low < high) { view.range = [low, high]; changed(); }
  drawLegend();
};
$("reset-range").onclick = () => { delete view.range; drawLegend(); changed(); };

const fileSize = () => ($("size").value ? $("size").value.split("x").map(Number) : sizeOf());
const fileView = of => ($("finer").checked ? { ...of, supersampling: 2 } : of);
$("save").onclick = () => say({ picture: { size: fileSize(), view: fileView(view) } });
$("command").onclick = () => say({ command: { size: fileSize(), view: fileView(view) } });
$("entry").onclick = () => say({ entry: { size: fileSize(), view: fileView(view) } });
function keep(blob, ending) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = `${run.name}-${view.state.toFixed(2)}.${ending}`;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

// Puts a view on the screen, and into everything that is set by it.
function show(wanted) {
  leave();
  fitted = false;
  for (const key of ["follow", "range", "selected", "cut"]) if (!(key in wanted)) delete view[key];
  Object.assign(view, wanted);
  theme(view.theme);
  $("follow").checked = view.follow !== undefined;
  $("perspective").checked = view.perspective > 0;
  $("explode").value = view.explode;
  $("colour").value = view.colour;
  if (view.cut !== undefined) $("cut").value = view.cut;
  tellCut();
  for (const box of document.querySelectorAll("#layers input")) box.checked = !view.hidden_layers.includes(+box.dataset.layer);
  for (const row of $("wires").tBodies[0].rows) row.querySelector("input").checked = !view.hidden_wires.includes(+row.dataset.wire);
  tellGhosts();
  drawLegend();
  toState(view.state);
  select(view.selected ?? null);
}
const film = new Film($, {
  say, show, file: keep, size: fileSize, present: () => structuredClone(view), finish: fileView,
  name: of => moment(run.states[clamp(Math.round(of.state), 0, last)]),
});

function theme(name) {
  document.documentElement.dataset.theme = view.theme = name;
  $("theme").textContent = name === "dark" ? "Light" : "Dark";
  changed();
}
$("theme").onclick = () => theme(view.theme === "dark" ? "light" : "dark");

// ---- Beginning: at the first break, close up. -------------------------------------------------------------------------
$("foot").textContent = `${run.about} Drawn by ${run.adapter}.`;
const warnings = document.createElement("details");
$("foot").before(warnings);
function drawWarnings() {
  const words = document.createElement("summary"), count = run.warnings.length;
  words.textContent = `${count} ${count === 1 ? "warning" : "warnings"} of the run`;
  warnings.hidden = !count;
  warnings.replaceChildren(words, ...run.warnings.map(text => Object.assign(document.createElement("p"), { textContent: text })));
}
drawWarnings();
if (!run.layers.length) $("layers").hidden = true;
if (!run.pulled) $("curve").closest("section").hidden = true;
theme(matchMedia("(prefers-color-scheme: light)").matches ? "light" : "dark");
drawLegend();
if (live) live.heard(run.live, false);
toState(first && !live ? first.state : last);
if (run.body.gauge && !live) go("break"); else go("home");
drawTicks();
drawChosen();
let resized;
new ResizeObserver(() => {
  clearTimeout(resized);
  resized = setTimeout(() => { drawTicks(); drawCurve(); drawChosen(); changed(); }, 60);
}).observe(stage);
connect();
requestAnimationFrame(tick);
document.documentElement.dataset.ready = "yes";
// For tests and for those who script the page from its console.
window.explore = { view, go, toState, select, changed, run: () => run, shown: () => shown, film, live };
