// Draws the charts and moves the slider. All data stand in the page as JSON; nothing here knows what a chart shows.
(() => {
  "use strict";
  const root = document.documentElement;
  const byId = (id) => document.getElementById(id);
  const troubles = [];

  // What fails is told to the reader, and can be asked for by a test.
  function tell(what) {
    troubles.push(String(what));
    root.dataset.troubles = troubles.length;
    const place = byId("trouble");
    place.hidden = false;
    place.querySelector("span").textContent = troubles.join("; ");
  }
  addEventListener("error", (event) => tell(event.message));
  addEventListener("unhandledrejection", (event) => tell(event.reason));
  addEventListener("securitypolicyviolation", (event) => tell(`blocked ${event.violatedDirective} ${event.blockedURI}`));

  // Colours are the style sheet's: "$ink" in a figure is its --ink, as it is in the theme shown.
  const probe = document.createElement("span");
  probe.hidden = true;
  document.body.append(probe);
  function colour(name) {
    probe.style.color = "";
    probe.style.color = `var(--${name})`;
    return getComputedStyle(probe).color;
  }
  const themed = (key, value) =>
    typeof value === "string" && /^\$[a-z]+[0-9]?$/.test(value) ? colour(value.slice(1)) : value;

  const PRINTED = 700;
  let printing = false;
  const figures = [...document.querySelectorAll("script.figure")].map((script) => ({
    id: script.dataset.of,
    text: script.textContent,
  }));
  // Named one by one: the library's own set has a button that sends the chart to a server.
  const modeBarButtons = [["toImage"], ["zoom2d", "pan2d"], ["zoomIn2d", "zoomOut2d", "resetScale2d"]];
  const config = { responsive: true, displaylogo: false, modeBarButtons };

  const stateData = document.querySelector("script.states");
  const { states, marks } = stateData ? JSON.parse(stateData.textContent) : { states: [], marks: null };
  let current = states.length - 1;

  // The map's figure with stresses and breaks of the current state.
  function atState(figure) {
    const state = states[current];
    state.stress.forEach((stress, wire) => { figure.data[wire].z = { ...stress }; });
    const crosses = figure.data[figure.data.length - 1];
    for (const part of ["x", "y", "text"]) crosses[part] = marks[part].slice(0, state.broken);
    const numbers = crosses.x.slice(0, 150).map((x, i) => ({
      x, y: crosses.y[i], text: marks.order[i], showarrow: false, xanchor: "left", xshift: 8,
      font: { size: 10, color: colour("ink") }, bgcolor: colour("paper"), borderpad: 1,
    }));
    figure.layout.annotations = figure.layout.annotations.concat(numbers);
    figure.layout.datarevision = current;
    return figure;
  }

  // The chosen wire, from 0, or -1: its row of the map, its line and its breaks in the curves.
  let chosen = -1;
  function marked(id, figure) {
    const broke = marks ? marks.wire.flatMap((wire, k) => (wire === chosen ? [k] : [])) : [];
    const line = { type: "line", layer: "above", line: { color: colour("signal"), width: 2 } };
    const shapes = figure.layout.shapes ?? [];
    if (id === "map" && marks) {
      const y = marks.row[chosen];
      shapes.push({ ...line, type: "rect", xref: "paper", x0: 0, x1: 1, y0: y - 0.5, y1: y + 0.5 });
    } else if (/^(curve|wires)-/.test(id)) {
      for (const k of broke) shapes.push({ ...line, yref: "paper", x0: marks.at[k], x1: marks.at[k], y0: 0, y1: 1 });
    }
    if (/^wires-/.test(id)) figure.data[chosen] = { ...figure.data[chosen], opacity: 1, line: { color: colour("signal"), width: 3 } };
    figure.layout.shapes = shapes;
    return figure;
  }

  function draw({ id, text }) {
    let figure = JSON.parse(text, themed);
    if (id === "map") figure = atState(figure);
    if (chosen >= 0) figure = marked(id, figure);
    if (printing) figure.layout.width = PRINTED;
    return Plotly.react(byId(id), figure.data, figure.layout, config);
  }
  async function drawAll() {
    await Promise.all(figures.map(draw));
    // Counted in the page, not in the data: a test looks at it.
    root.dataset.charts = figures.filter(({ id }) => byId(id).querySelector(".main-svg")).length;
  }

  // Theme: the system's until the reader chooses.
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const isDark = () => (root.dataset.theme ? root.dataset.theme === "dark" : dark.matches);
  function showTheme() {
    byId("theme").textContent = isDark() ? "Light" : "Dark";
    byId("theme").setAttribute("aria-pressed", String(isDark()));
    byId("theme").setAttribute("aria-label", isDark() ? "Change to light" : "Change to dark");
    solid?.soon();
    return drawAll();
  }
  byId("theme").addEventListener("click", () => {
    root.dataset.theme = isDark() ? "light" : "dark";
    showTheme();
  });
  dark.addEventListener("change", showTheme);
  // Paper is light and narrow; charts do not follow it by themselves.
  addEventListener("beforeprint", () => { printing = true; root.dataset.print = "yes"; drawAll(); });
  addEventListener("afterprint", () => { printing = false; delete root.dataset.print; drawAll(); });

  // The shape that can be turned.
  let solid = null;
  function choose(wire) {
    chosen = wire;
    solid?.choose(wire);
    for (const row of document.querySelectorAll("tr[data-wire]")) row.classList.toggle("chosen", Number(row.dataset.wire) === wire);
    tellChosen();
    return drawAll();
  }
  function tellChosen(pointed = "") {
    const place = byId("solid-told");
    if (!place) return;
    const orders = marks ? marks.order.slice(0, states[current].broken).filter((_, k) => marks.wire[k] === chosen) : [];
    const fate = orders.length ? `broken: ${orders.length > 1 ? "breaks" : "break"} ${orders.join(", ")}` : "whole here";
    place.textContent = pointed || (chosen < 0 ? place.dataset.help : `${solid.name(chosen)}: ${fate}. Click it again to let it go.`);
  }
  function makeSolid() {
    const canvas = byId("solid"), facts = document.querySelector("script.solid");
    if (!canvas || !facts) return;
    byId("solid-told").dataset.help = byId("solid-told").textContent;
    const hooks = { colour, told: tellChosen, picked: (wire) => { choose(wire).catch(tell); } };
    solid = solidPicture(canvas, JSON.parse(facts.textContent), hooks);
    if (!solid) {
      canvas.closest(".solid").textContent = "This browser has no WebGL 2, so the run cannot be turned here; strandsnap explore draws it itself.";
      return;
    }
    for (const button of document.querySelectorAll(".solid [data-view]")) {
      button.addEventListener("click", () => solid.look(button.dataset.view));
    }
    for (const button of document.querySelectorAll(".solid [data-layer]")) {
      button.addEventListener("click", () => {
        const on = button.getAttribute("aria-pressed") !== "true";
        button.setAttribute("aria-pressed", String(on));
        solid.hide(Number(button.dataset.layer), !on);
      });
    }
    solid.ready.then(() => { root.dataset.solid = "yes"; }).catch(tell);
  }

  // Slider, buttons and arrow keys.
  const slider = byId("slider");
  const map = figures.find(({ id }) => id === "map");
  async function show(index) {
    current = Math.min(Math.max(index, 0), states.length - 1);
    const state = states[current];
    slider.value = current;
    slider.setAttribute("aria-valuetext", state.told);
    byId("state").textContent = state.told;
    if (byId("frame")) {
      // A state without a frame shows none, not that of another one.
      byId("frame").style.visibility = state.picture ? "visible" : "hidden";
      if (state.picture) byId("frame").src = state.picture;
      byId("frame").alt = `Frame of the run at ${state.told}`;
    }
    if (solid) {
      solid.show(current);
      byId("solid").setAttribute("aria-label", `The run in three dimensions at ${state.told}`);
      tellChosen();
    }
    if (map) await draw(map);
    root.dataset.state = current;
  }
  function play(on) {
    clearTimeout(play.timer);
    play.on = on;
    byId("play").textContent = on ? "Pause" : "Play";
    byId("play").setAttribute("aria-pressed", String(on));
    if (on) step();
  }
  async function step() {
    await show(current + 1 < states.length ? current + 1 : 0);
    if (!play.on) return;
    if (current + 1 < states.length) play.timer = setTimeout(step, 250);
    else play(false);
  }
  if (slider) {
    slider.addEventListener("input", () => { play(false); show(Number(slider.value)); });
    byId("play").addEventListener("click", () => play(!play.on));
    for (const button of document.querySelectorAll(".jump")) {
      button.addEventListener("click", () => { play(false); show(Number(button.dataset.state)); });
    }
    addEventListener("keydown", (event) => {
      const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      const free = event.target === document.body || event.target.closest("#states .controls");
      if (!by || !free || event.target === slider || event.altKey || event.ctrlKey || event.metaKey) return;
      event.preventDefault();
      play(false);
      show(current + by);
    });
  }

  makeSolid();
  // For tests.
  globalThis.page = { choose, solid: () => solid };
  showTheme().catch(tell).finally(() => { root.dataset.ready = "yes"; });
})();
