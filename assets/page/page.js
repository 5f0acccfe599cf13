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

  function draw({ id, text }) {
    let figure = JSON.parse(text, themed);
    if (id === "map") figure = atState(figure);
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

  showTheme().catch(tell).finally(() => { root.dataset.ready = "yes"; });
})();
