// Charts as SVG, drawn from numbers; the unrolled map as pixels. Nothing here knows of the socket.
const NS = "http://www.w3.org/2000/svg";

export function element(parent, name, attributes = {}, text) {
  const made = document.createElementNS(NS, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text !== undefined) made.textContent = text;
  parent.append(made);
  return made;
}

// Round numbers between two ends, some `count` of them.
function ticks(low, high, count) {
  const raw = (high - low) / count, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map(s => s * power).find(s => s >= raw);
  const found = [];
  for (let v = Math.ceil(low / step) * step; v <= high + 1e-9 * step; v += step) found.push(+v.toPrecision(10));
  return found;
}

// A frame with two axes; gives the functions from values to places and back.
export function frame(svg, { x, y, xTitle, yTitle }) {
  svg.replaceChildren();
  const { width, height } = svg.getBoundingClientRect();
  const w = Math.max(width, 120), h = Math.max(height, 80);
  svg.setAttribute("viewBox", `0 0 ${w} ${h}`);
  const edge = { left: 38, right: 8, top: 14, bottom: 26 };
  const span = ([low, high]) => (high > low ? [low, high] : [low - 0.5, low + 0.5]);
  const [x0, x1] = span(x), [y0, y1] = span(y);
  const px = v => edge.left + (v - x0) / (x1 - x0) * (w - edge.left - edge.right);
  const py = v => h - edge.bottom - (v - y0) / (y1 - y0) * (h - edge.top - edge.bottom);
  const value = client => {
    const box = svg.getBoundingClientRect();
    return x0 + ((client - box.left) * w / box.width - edge.left) / (w - edge.left - edge.right) * (x1 - x0);
  };
  element(svg, "path", { class: "axis", d: `M${edge.left} ${edge.top}V${h - edge.bottom}H${w - edge.right}` });
  for (const v of ticks(x0, x1, 6)) {
    element(svg, "text", { x: px(v), y: h - edge.bottom + 11, "text-anchor": "middle" }, v);
  }
  for (const v of ticks(y0, y1, 4)) element(svg, "text", { x: edge.left - 4, y: py(v) + 3, "text-anchor": "end" }, v);
  element(svg, "text", { x: w - edge.right, y: h - 3, "text-anchor": "end" }, xTitle);
  element(svg, "text", { x: 2, y: 9 }, yTitle);
  return { px, py, value, top: edge.top, bottom: h - edge.bottom };
}

// A line through points; a gap where a value is missing.
export function line(svg, at, xs, ys, kind) {
  let d = "", pen = false;
  xs.forEach((x, k) => {
    const y = ys[k];
    if (y === null || y === undefined) { pen = false; return; }
    d += `${pen ? "L" : "M"}${at.px(x).toFixed(1)} ${at.py(y).toFixed(1)}`;
    pen = true;
  });
  return element(svg, "path", { class: kind, d });
}

export const extent = values => {
  const numbers = values.filter(v => v !== null && v !== undefined);
  return numbers.length ? [Math.min(...numbers), Math.max(...numbers)] : [0, 1];
};

// Rows of wires from the innermost at the bottom, a pixel for each particle; red where a bond is broken.
export class Map2D {
  constructor(canvas, wires) {
    Object.assign(this, { canvas, wires });
    this.columns = Math.max(1, ...wires.map(w => w.len));
    this.rows = [];
    let row = 0;
    wires.forEach((wire, k) => {
      if (k && wire.layer !== wires[k - 1].layer) row += 1;
      this.rows.push(row++);
    });
    this.height = Math.max(1, row);
  }

  draw(colours, broken, selected) {
    const per = Math.max(2, Math.min(6, Math.floor(400 / this.height)));
    const [w, h] = [this.columns, this.height * per];
    if (this.canvas.width !== w || this.canvas.height !== h) Object.assign(this.canvas, { width: w, height: h });
    const context = this.canvas.getContext("2d");
    const image = context.createImageData(w, h);
    const put = (x, y, r, g, b) => image.data.set([r, g, b, 255], 4 * (y * w + x));
    this.wires.forEach((wire, k) => {
      const top = h - (this.rows[k] + 1) * per;
      for (let x = 0; x < w; x++) {
        const i = 3 * (wire.first + Math.floor(x * wire.len / w));
        for (let y = top; y < top + per - 1; y++) put(x, y, colours[i], colours[i + 1], colours[i + 2]);
      }
      for (const bond of broken.get(k) ?? []) {
        const middle = Math.round((bond + 0.5) * w / wire.len);
        for (let x = Math.max(0, middle - 1); x <= Math.min(w - 1, middle + 1); x++) {
          for (let y = top; y < top + per; y++) put(x, y, 255, 45, 60);
        }
      }
      if (k === selected) {
        for (let x = 0; x < w; x++) put(x, top + per - 1, 98, 181, 242);
        for (let y = top; y < top + per; y++) for (const x of [0, 1, 2, w - 3, w - 2, w - 1]) put(x, y, 98, 181, 242);
      }
    });
    context.putImageData(image, 0, 0);
  }

  // Wire and particle of it at a place given in shares of the canvas.
  at(right, down) {
    const row = Math.floor((1 - down) * this.height);
    const wire = this.rows.indexOf(row);
    if (wire < 0) return null;
    const { len } = this.wires[wire];
    return { wire, particle: Math.min(len - 1, Math.floor(right * len)) };
  }
}
