// The run as a shape in WebGL: every bond a round piece of wire, found pixel by pixel. `told(words)` says what is pointed at,
// `picked(wire)` that a wire was chosen.
globalThis.solidPicture = (canvas, facts, { colour, told, picked }) => {
  // An instance is a particle and the next one: x, y, z, radius; then stress as a share, kind, redness, wire.
  const VERTEX = `#version 300 es
    layout(location = 0) in vec4 a;
    layout(location = 1) in vec4 aMore;
    layout(location = 2) in vec4 b;
    layout(location = 3) in vec4 bMore;
    uniform mat3 turn; uniform vec3 centre; uniform vec3 scale;
    flat out vec4 A; flat out vec4 B; flat out vec4 look; flat out float wire;
    out vec2 p;
    void main() {
      int corner = gl_VertexID;
      A = vec4(turn * (a.xyz - centre), a.w);
      B = aMore.y > 1.5 ? A : vec4(turn * (b.xyz - centre), b.w);
      look = vec4(aMore.x, aMore.y > 1.5 ? aMore.x : bMore.x, aMore.z, aMore.y > 1.5 ? aMore.z : bMore.z);
      wire = aMore.w;
      vec2 along = B.xy - A.xy;
      along = length(along) > 1e-9 ? normalize(along) : vec2(1.0, 0.0);
      float r = max(A.w, B.w);
      vec2 side = vec2(-along.y, along.x) * ((corner & 1) == 0 ? -r : r);
      p = (corner < 2 ? A.xy - along * r : B.xy + along * r) + side;
      gl_Position = aMore.y < 0.5 ? vec4(2.0, 2.0, 2.0, 1.0) : vec4(p * scale.xy, 0.0, 1.0);
    }`;
  const FRAGMENT = `#version 300 es
    precision highp float;
    flat in vec4 A; flat in vec4 B; flat in vec4 look; flat in float wire;
    in vec2 p;
    uniform vec3 scale; uniform vec3 stops[32]; uniform vec3 ground; uniform vec3 grey; uniform vec3 red; uniform float chosen;
    out vec4 picture;
    void main() {
      float r = 0.5 * (A.w + B.w);
      vec3 axis = B.xyz - A.xyz;
      float l = length(axis);
      vec3 u = l > 1e-9 ? axis / l : vec3(1.0, 0.0, 0.0);
      // On the line of sight (p, z) the distance from the axis is r where z - A.z solves a quadratic equation.
      vec2 q = p - A.xy;
      float m = dot(q, u.xy), flatness = 1.0 - u.z * u.z;
      float root = m * m * u.z * u.z - flatness * (dot(q, q) - m * m - r * r);
      float s = -1.0, z = 0.0;
      if (l > 1e-9 && root >= 0.0 && flatness > 1e-6) {
        z = (m * u.z + sqrt(root)) / flatness;
        s = m + z * u.z;
      }
      vec3 on;
      if (s >= 0.0 && s <= l) {
        on = A.xyz + s * u;
        z += A.z;
      } else {
        // A round end: the one whose sphere is nearer to the eye here.
        float toA = A.w * A.w - dot(q, q), toB = B.w * B.w - dot(p - B.xy, p - B.xy);
        float zA = toA >= 0.0 ? A.z + sqrt(toA) : -1e9, zB = toB >= 0.0 ? B.z + sqrt(toB) : -1e9;
        z = max(zA, zB);
        if (z < -1e8) discard;
        on = zA >= zB ? A.xyz : B.xyz;
        s = zA >= zB ? 0.0 : l;
      }
      vec3 n = normalize(vec3(p, z) - on);
      float share = l > 1e-9 ? clamp(s / l, 0.0, 1.0) : 0.0;
      float value = mix(look.x, look.y, share);
      float at = clamp(value, 0.0, 1.0) * 31.0;
      int k = int(at);
      vec3 base = value > 1.0 ? grey : mix(stops[k], stops[min(k + 1, 31)], fract(at));
      base = mix(base, red, share < 0.5 ? look.z : look.w);
      float light = 0.42 + 0.58 * max(dot(n, normalize(vec3(-0.35, 0.62, 0.7))), 0.0);
      float edge = 1.0 - n.z;
      base *= light * (1.0 - 0.55 * edge * edge);
      base += 0.22 * pow(max(dot(n, normalize(vec3(-0.18, 0.34, 0.92))), 0.0), 24.0);
      picture = vec4(chosen >= 0.0 && chosen != wire ? mix(base, ground, 0.65) : base, 1.0);
      gl_FragDepth = clamp(0.5 - 0.5 * z * scale.z, 0.0, 1.0);
    }`;
  const { particles, wires } = facts, WIDTH = 8;
  const gl = canvas.getContext("webgl2", { antialias: false, preserveDrawingBuffer: true });
  if (!gl) return null;
  const program = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text.trimStart());
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  gl.useProgram(program);
  const place = name => gl.getUniformLocation(program, name);
  gl.uniform3fv(place("stops"), facts.stops.flat().map(v => v / 255));
  const buffer = gl.createBuffer();
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  for (let k = 0; k < 4; k++) {
    gl.enableVertexAttribArray(k);
    gl.vertexAttribPointer(k, 4, gl.FLOAT, false, 4 * WIDTH, 16 * k);
    gl.vertexAttribDivisor(k, 1);
  }
  gl.enable(gl.DEPTH_TEST);

  const wireOf = new Int32Array(particles).fill(-1);
  wires.forEach((wire, number) => wireOf.fill(number, wire.first, wire.first + wire.len));
  const hidden = new Set();
  const size = [0, 1, 2].map(k => Math.max(facts.high[k] - facts.low[k], 2 * facts.thickest));
  const middle = [0, 1, 2].map(k => (facts.low[k] + facts.high[k]) / 2);
  const depth = 4 * Math.hypot(...size);
  const view = { azimuth: -28, elevation: 22, centre: [...middle], height: 1 };
  let states = null, shown = null, index = facts.states - 1, chosen = -1;

  // Every state as numbers for the adapter: undone in the order in which they were made small.
  async function unpack() {
    const bytes = Uint8Array.from(atob(facts.data), c => c.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    const all = new Uint8Array(await new Response(stream).arrayBuffer());
    const now = [0, 1, 2].map(() => new Uint16Array(particles));
    states = [];
    for (let state = 0, from = 0; state < facts.states; state++) {
      for (const axis of now) {
        for (let i = 0; i < particles; i++) axis[i] += all[from + i] + 256 * all[from + particles + i];
        from += 2 * particles;
      }
      const part = k => all.subarray(from + k * particles, from + (k + 1) * particles);
      states.push({ place: now.map(axis => axis.slice()), radius: part(0), stress: part(1), holds: part(2) });
      from += 3 * particles;
    }
  }

  function upload() {
    const { place, radius, stress, holds } = states[index];
    // One more than there are: the last particle has no next one.
    shown = new Float32Array((particles + 1) * WIDTH);
    for (let i = 0; i < particles; i++) {
      const wire = wireOf[i], at = WIDTH * i, of = wires[wire];
      for (let k = 0; k < 3; k++) shown[at + k] = facts.low[k] + (facts.high[k] - facts.low[k]) * place[k][i] / 65535;
      shown[at + 3] = radius[i] / 255 * facts.thickest;
      shown[at + 4] = stress[i] === 255 ? 2 : stress[i] / 254;
      const after = holds[i], before = i > 0 && wireOf[i - 1] === wire ? holds[i - 1] : 0;
      const away = of && hidden.has(of.layer);
      shown[at + 5] = away ? 0 : after ? 1 : before ? 0 : 2;
      const inner = of ? [i > of.first && !before, i + 1 < of.first + of.len && !after] : [];
      shown[at + 6] = inner.some(Boolean) ? 1 : 0;
      shown[at + 7] = wire;
    }
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, shown, gl.DYNAMIC_DRAW);
  }

  // Rows are right, up and towards the eye: at no turn z runs to the right and y up, and the eye looks along +x.
  function turn() {
    const [az, el] = [view.azimuth, view.elevation].map(angle => angle * Math.PI / 180);
    const [sa, ca, se, ce] = [Math.sin(az), Math.cos(az), Math.sin(el), Math.cos(el)];
    return [[-sa, 0, ca], [se * ca, ce, se * sa], [-ce * ca, se, -ce * sa]];
  }
  const rotated = (rows, p) => rows.map(row => row[0] * p[0] + row[1] * p[1] + row[2] * p[2]);

  // Shows all that lies between two corners.
  function fit(low, high) {
    const rows = turn(), [w, h] = [canvas.clientWidth || 4, canvas.clientHeight || 3];
    let half = 0;
    for (let k = 0; k < 8; k++) {
      const corner = [0, 1, 2].map(axis => ((k >> axis) & 1 ? 1 : -1) * (high[axis] - low[axis]) / 2);
      const [x, y] = rotated(rows, corner);
      half = Math.max(half, Math.abs(x) * h / w, Math.abs(y));
    }
    view.centre = [0, 1, 2].map(k => (low[k] + high[k]) / 2);
    view.height = 2.15 * Math.max(half, facts.thickest);
  }

  // The places between which wires have broken so far.
  function breaks() {
    const ends = [];
    for (let i = 0; i < particles; i++) if (shown[WIDTH * i + 6]) ends.push([0, 1, 2].map(k => shown[WIDTH * i + k]));
    if (!ends.length) return false;
    // Half of them lie between the quartiles along the strand: there the fracture is.
    ends.sort((a, b) => a[2] - b[2]);
    const core = ends.slice(Math.floor(ends.length / 4), Math.ceil(3 * ends.length / 4));
    const across = Math.max(size[0], size[1]);
    const z = core.reduce((sum, end) => sum + end[2], 0) / core.length;
    const reach = Math.max(0.9 * across, (core[core.length - 1][2] - core[0][2]) / 2 + 0.3 * across);
    fit([facts.low[0], facts.low[1], z - reach], [facts.high[0], facts.high[1], z + reach]);
    return true;
  }

  const parts = text => (text.match(/[\d.]+/g) ?? [0, 0, 0]).slice(0, 3).map(v => v / 255);
  function draw() {
    if (!shown) return;
    const finer = Math.min(2, Math.max(devicePixelRatio, 1.5));
    const [w, h] = [canvas.clientWidth, canvas.clientHeight].map(side => Math.max(1, Math.round(side * finer)));
    if (canvas.width !== w || canvas.height !== h) Object.assign(canvas, { width: w, height: h });
    const rows = turn(), ground = parts(colour("panel"));
    gl.viewport(0, 0, w, h);
    gl.clearColor(...ground, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    // Columns of the matrix one after the other.
    gl.uniformMatrix3fv(place("turn"), false, [0, 1, 2].flatMap(column => rows.map(row => row[column])));
    gl.uniform3fv(place("centre"), view.centre);
    gl.uniform3fv(place("scale"), [2 * h / w / view.height, 2 / view.height, 1 / depth]);
    gl.uniform3fv(place("ground"), ground);
    gl.uniform3fv(place("grey"), parts(colour("line")));
    gl.uniform3fv(place("red"), parts(colour("signal")));
    gl.uniform1f(place("chosen"), chosen);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, particles);
  }
  let waiting = false;
  function soon() {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => { waiting = false; draw(); });
  }

  // The wire under a place of the picture (px from its top left), nearest to the eye.
  function under(x, y) {
    const rows = turn(), scale = canvas.clientHeight / view.height;
    const [px, py] = [(x - canvas.clientWidth / 2) / scale, (canvas.clientHeight / 2 - y) / scale];
    let found = -1, nearest = -Infinity;
    for (let i = 0; i < particles; i++) {
      if (wireOf[i] < 0 || !shown[WIDTH * i + 5]) continue;
      const at = k => rotated(rows, [0, 1, 2].map(axis => shown[WIDTH * k + axis] - view.centre[axis]));
      const [a, b] = [at(i), shown[WIDTH * i + 5] === 1 ? at(i + 1) : at(i)];
      const [dx, dy] = [b[0] - a[0], b[1] - a[1]], square = dx * dx + dy * dy;
      const share = square > 0 ? Math.min(1, Math.max(0, ((px - a[0]) * dx + (py - a[1]) * dy) / square)) : 0;
      const off = Math.hypot(px - a[0] - share * dx, py - a[1] - share * dy), r = shown[WIDTH * i + 3];
      const z = a[2] + share * (b[2] - a[2]) + Math.sqrt(Math.max(r * r - off * off, 0));
      if (off <= r && z > nearest) [found, nearest] = [wireOf[i], z];
    }
    return found;
  }

  let grip = null;
  const moveBy = (dx, dy) => {
    const rows = turn(), by = view.height / canvas.clientHeight;
    view.centre = view.centre.map((c, k) => c - dx * by * rows[0][k] + dy * by * rows[1][k]);
  };
  const turnBy = (dx, dy) => { view.azimuth += dx; view.elevation = Math.min(90, Math.max(-90, view.elevation + dy)); };
  const zoomBy = factor => { view.height = Math.min(4 * Math.hypot(...size), Math.max(facts.thickest, view.height * factor)); };
  const place2 = event => { const box = canvas.getBoundingClientRect(); return [event.clientX - box.left, event.clientY - box.top]; };
  const name = wire => `wire ${wires[wire].number}, ${facts.layers[wires[wire].layer]} layer`;
  canvas.addEventListener("pointerdown", event => {
    canvas.setPointerCapture(event.pointerId);
    grip = { at: [event.clientX, event.clientY], moved: 0 };
  });
  canvas.addEventListener("pointermove", event => {
    if (!shown) return;
    if (!grip) {
      const wire = under(...place2(event));
      told(wire < 0 ? "" : name(wire));
      return;
    }
    const [dx, dy] = [event.clientX - grip.at[0], event.clientY - grip.at[1]];
    grip = { at: [event.clientX, event.clientY], moved: grip.moved + Math.abs(dx) + Math.abs(dy) };
    if (event.shiftKey) moveBy(dx, dy); else turnBy(0.4 * dx, 0.4 * dy);
    soon();
  });
  canvas.addEventListener("pointerup", event => {
    if (grip && grip.moved < 4 && shown) {
      const wire = under(...place2(event));
      picked(wire === chosen ? -1 : wire);
    }
    grip = null;
  });
  canvas.addEventListener("pointercancel", () => { grip = null; });
  canvas.addEventListener("wheel", event => { event.preventDefault(); zoomBy(Math.exp(0.0015 * event.deltaY)); soon(); }, { passive: false });
  canvas.addEventListener("keydown", event => {
    const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    const factor = { "+": 0.8, "-": 1.25 }[event.key];
    if (!way && !factor) return;
    event.preventDefault();
    event.stopPropagation();
    if (factor) zoomBy(factor);
    else if (event.shiftKey) moveBy(-20 * way[0], -20 * way[1]);
    else turnBy(6 * way[0], 6 * way[1]);
    soon();
  });
  new ResizeObserver(soon).observe(canvas);

  const look = name => { if (name !== "break" || !breaks()) fit(facts.low, facts.high); soon(); };
  return {
    // It opens on what broke, or on the whole where nothing did.
    ready: unpack().then(() => { upload(); look("break"); draw(); }),
    show(number) { index = number; if (states) { upload(); soon(); } },
    choose(wire) { chosen = wire; soon(); },
    hide(layer, away) { if (away) hidden.add(layer); else hidden.delete(layer); if (states) { upload(); soon(); } },
    look, soon, name, under,
    // For tests.
    state: () => ({ index, chosen, hidden: [...hidden], view, place: i => [...shown.slice(WIDTH * i, WIDTH * i + 3)] }),
  };
};
