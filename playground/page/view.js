// SPDX-License-Identifier: GPL-3.0-or-later
// The plan: light, walls, elements and links on a canvas.

const MARGIN = 28; // pixels around the scene
const OUTSIDE = 2; // hr2d_place
const LEAST_TICKED = 3; // pixels; ends of shorter elements would be a blot
const DARK = "#10141a";
const CHOSEN = "#ff3d9a";
const IMAGE = "rgb(16 20 26 / 30%)";
const SUNLIGHT = "#ffd23f";
const SUN = 11; // pixels, its radius

/** Nodes without light take the mean colour of neighbours that have some, so that the smooth image
    does not fade before a wall. */
function spread({ data, width, height }) {
  const lit = Uint8Array.from({ length: width * height }, (_, k) => data[4 * k + 3] && 1);
  for (let k = 0; k < lit.length; k++) {
    if (lit[k]) continue;
    const sum = [0, 0, 0, 0];
    const column = k % width;
    for (const dx of [-1, 0, 1])
      for (const dy of [-width, 0, width]) {
        const other = k + dx + dy;
        if (column + dx < 0 || column + dx >= width || !lit[other]) continue;
        for (let c = 0; c < 4; c++) sum[c] += data[4 * other + c];
      }
    const count = sum[3] / 255;
    if (count) for (let c = 0; c < 4; c++) data[4 * k + c] = sum[c] / count;
  }
}

export class View {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d");
    this.scale = 1; // pixels per scene length
    this.centre = [0, 0]; // of the canvas, in scene lengths
    this.image = null;
  }

  /** Takes the size that the page gives the canvas. */
  resize() {
    const ratio = devicePixelRatio || 1;
    this.width = this.canvas.clientWidth;
    this.height = this.canvas.clientHeight;
    this.canvas.width = Math.round(this.width * ratio);
    this.canvas.height = Math.round(this.height * ratio);
    this.context.setTransform(ratio, 0, 0, ratio, 0, 0);
  }

  fit({ low, high }) {
    const width = Math.max(high[0] - low[0], 1e-9);
    const height = Math.max(high[1] - low[1], 1e-9);
    this.scale = Math.min(
      (this.width - 2 * MARGIN) / width,
      (this.height - 2 * MARGIN) / height,
    );
    this.centre = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2];
  }

  zoom(factor, about = [this.width / 2, this.height / 2]) {
    const fixed = this.toScene(about);
    this.scale *= factor;
    const now = this.toScene(about);
    this.centre = [this.centre[0] + fixed[0] - now[0], this.centre[1] + fixed[1] - now[1]];
  }

  /** Moves what is shown by so many pixels. */
  shift([dx, dy]) {
    this.centre = [this.centre[0] - dx / this.scale, this.centre[1] + dy / this.scale];
  }

  toScreen([x, y]) {
    return [
      this.width / 2 + (x - this.centre[0]) * this.scale,
      this.height / 2 - (y - this.centre[1]) * this.scale,
    ];
  }

  toScene([x, y]) {
    return [
      this.centre[0] + (x - this.width / 2) / this.scale,
      this.centre[1] - (y - this.height / 2) / this.scale,
    ];
  }

  /** What of the plane is to be seen. */
  area() {
    const [x0, y1] = this.toScene([0, 0]);
    const [x1, y0] = this.toScene([this.width, this.height]);
    return { low: [x0, y0], high: [x1, y1] };
  }

  /** Keeps a field as an image with a pixel for each node; that of a sketch is coarse. */
  setField(field, bands, band, colours, coarse) {
    const { columns, rows, mean, place } = field;
    const image = new ImageData(columns, rows);
    for (let row = 0; row < rows; row++)
      for (let column = 0; column < columns; column++) {
        const node = (rows - 1 - row) * columns + column; // row 0 of the grid is the lowest
        if (place[node] === OUTSIDE) continue;
        colours.put(image.data, 4 * (row * columns + column), mean[node * bands + band]);
      }
    if (coarse) spread(image);
    const canvas = document.createElement("canvas");
    canvas.width = columns;
    canvas.height = rows;
    canvas.getContext("2d").putImageData(image, 0, 0);
    this.image = { canvas, low: field.low, high: field.high, columns, rows, place, coarse };
  }

  clear() {
    this.ground = getComputedStyle(this.canvas).backgroundColor;
    this.context.fillStyle = this.ground;
    this.context.fillRect(0, 0, this.width, this.height);
  }

  /** A node is the middle of its pixel. */
  paintField() {
    if (!this.image) return;
    const { canvas, low, high, columns, rows } = this.image;
    const [x0, y1] = this.toScreen(low);
    const [x1, y0] = this.toScreen(high);
    const dx = (x1 - x0) / Math.max(1, columns - 1);
    const dy = (y1 - y0) / Math.max(1, rows - 1);
    this.context.imageSmoothingEnabled = true;
    this.context.imageSmoothingQuality = "high";
    this.context.drawImage(canvas, x0 - dx / 2, y0 - dy / 2, x1 - x0 + dx, y1 - y0 + dy);
  }

  /** The field as an element of an SVG. */
  imageSVG() {
    if (!this.image) return "";
    const { canvas, low, high, columns, rows } = this.image;
    const [x0, y1] = this.toScreen(low);
    const [x1, y0] = this.toScreen(high);
    const dx = (x1 - x0) / Math.max(1, columns - 1);
    const dy = (y1 - y0) / Math.max(1, rows - 1);
    return (
      `<image x="${x0 - dx / 2}" y="${y0 - dy / 2}" width="${x1 - x0 + dx}" ` +
      `height="${y1 - y0 + dy}" preserveAspectRatio="none" href="${canvas.toDataURL()}"/>`
    );
  }

  /** Whether no light is at the node that is nearest to a point on the screen. */
  outside(point) {
    const { low, high, columns, rows, place } = this.image;
    const [x, y] = this.toScene(point);
    const column = Math.round(((x - low[0]) / (high[0] - low[0])) * (columns - 1));
    const row = Math.round(((y - low[1]) / (high[1] - low[1])) * (rows - 1));
    const known = column >= 0 && row >= 0 && column < columns && row < rows;
    return !known || place[row * columns + column] === OUTSIDE;
  }

  /** Wipes off what the wide pixels of a sketch show behind walls where no light is. */
  wipeBacks(scene) {
    if (!this.image?.coarse) return;
    const { low, high, columns } = this.image;
    const pixel = ((high[0] - low[0]) / (columns - 1)) * this.scale;
    for (const wall of scene.walls)
      if (!wall.both && wall.kind !== "mirror" && wall.kind !== "gas") this.wipeBack(wall, pixel);
  }

  wipeBack(wall, pixel) {
    const p = this.toScreen(wall.a);
    const q = this.toScreen(wall.b);
    const n = this.front(wall.a, wall.b);
    const u = [-n[1], n[0]]; // along the wall
    const length = Math.hypot(q[0] - p[0], q[1] - p[1]);
    const step = Math.max(pixel / 5, length / 400);
    const depth = 2 * pixel;
    const at = (s, behind) => [
      p[0] + s * u[0] - behind * n[0],
      p[1] + s * u[1] - behind * n[1],
    ];
    this.context.lineCap = "butt";
    // Beyond the ends of a wall, as at a corner of a room, only where that is not the end of it.
    const further = (s) => (s < 0 ? s - pixel : s > length ? s + pixel : s);
    for (let s = -depth; s < length + depth; s += step)
      if (this.outside(at(s, depth)) && this.outside(at(further(s), depth)))
        this.line(at(s, 0), at(s, depth), step + 1, this.ground);
  }

  line(p, q, width, style) {
    const c = this.context;
    c.beginPath();
    c.moveTo(...p);
    c.lineTo(...q);
    c.lineWidth = width;
    c.strokeStyle = style;
    c.stroke();
  }

  /** The normal to the front, in pixels on the screen. */
  front(a, b) {
    const p = this.toScreen(a);
    const q = this.toScreen(b);
    const length = Math.hypot(q[0] - p[0], q[1] - p[1]) || 1;
    return [(q[1] - p[1]) / length, -(q[0] - p[0]) / length];
  }

  paintWalls(scene) {
    this.context.lineCap = "round";
    for (const w of scene.walls) {
      const dashes = { mirror: [10, 4, 2, 4], gas: [3, 4] }[w.kind];
      this.context.setLineDash(dashes ?? []);
      this.line(this.toScreen(w.a), this.toScreen(w.b), dashes ? 2 : 4, DARK);
    }
    this.context.setLineDash([]);
  }

  /** What stands around a cell between mirrors or in a period, faintly. */
  paintImages(images) {
    this.context.lineCap = "round";
    for (let k = 0; k < images.length; k += 4)
      this.line(
        this.toScreen([images[k], images[k + 1]]),
        this.toScreen([images[k + 2], images[k + 3]]),
        2.5,
        IMAGE,
      );
  }

  /** Where the sun stands on the screen: it is as far away as the edge. */
  sunAt(bearing) {
    const turn = (bearing * Math.PI) / 180;
    const far = Math.min(this.width, this.height) / 2 - SUN - 6;
    return [this.width / 2 + far * Math.sin(turn), this.height / 2 - far * Math.cos(turn)];
  }

  /** Whether a point of the screen is on the sun. */
  isSun([x, y], sun) {
    if (!(sun?.irradiance > 0)) return false;
    const at = this.sunAt(sun.bearing);
    return Math.hypot(x - at[0], y - at[1]) < SUN + 8;
  }

  /** The bearing of a point of the screen from its middle. */
  bearingOf([x, y]) {
    return (Math.atan2(x - this.width / 2, this.height / 2 - y) * 180) / Math.PI;
  }

  /** A disc, and its light as arrows. */
  paintSun(sun) {
    if (!(sun?.irradiance > 0)) return;
    const c = this.context;
    const [x, y] = this.sunAt(sun.bearing);
    const turn = (sun.bearing * Math.PI) / 180;
    const [ux, uy] = [-Math.sin(turn), Math.cos(turn)]; // the way of its light
    c.lineCap = "round";
    for (const side of [-8, 0, 8]) {
      const from = [x - side * uy + (SUN + 5) * ux, y + side * ux + (SUN + 5) * uy];
      const to = [from[0] + 22 * ux, from[1] + 22 * uy];
      this.line(from, to, 4, DARK);
      this.line(from, to, 2, SUNLIGHT);
    }
    c.beginPath();
    c.arc(x, y, SUN, 0, 2 * Math.PI);
    c.fillStyle = SUNLIGHT;
    c.fill();
    c.lineWidth = 2;
    c.strokeStyle = DARK;
    c.stroke();
  }

  /** The leaves in the colours of their radiosity, along their fronts. */
  paintLeaves(answer, colours, band, ticks) {
    const { elements, stride } = answer;
    const shift = ([x, y], n, by) => [x + by * n[0], y + by * n[1]];
    const leaves = [];
    for (let at = 0; at < elements.length; at += stride) if (!elements[at + 5]) leaves.push(at);
    this.context.lineCap = "butt";
    for (const at of leaves) {
      const [p, q, n] = this.element(answer, at);
      this.line(shift(p, n, 4.5), shift(q, n, 4.5), 6.5, DARK);
    }
    for (const at of leaves) {
      const [p, q, n] = this.element(answer, at);
      this.line(shift(p, n, 4.5), shift(q, n, 4.5), 4.5, colours.css(elements[at + 6 + band]));
      const long = Math.hypot(q[0] - p[0], q[1] - p[1]) >= LEAST_TICKED;
      if (ticks && long) this.line(shift(p, n, 0), shift(p, n, 9), 1.2, "#ffffff");
    }
  }

  /** The ends of an element on the screen, and the normal to its front. */
  element({ elements }, at) {
    const a = [elements[at], elements[at + 1]];
    const b = [elements[at + 2], elements[at + 3]];
    return [this.toScreen(a), this.toScreen(b), this.front(a, b)];
  }

  middle(answer, element) {
    const [p, q, n] = this.element(answer, element * answer.stride);
    return [(p[0] + q[0]) / 2 + 4.5 * n[0], (p[1] + q[1]) / 2 + 4.5 * n[1]];
  }

  /** The links of the elements on a path from a leaf to its root. */
  paintLinks(answer, path, links) {
    this.context.lineCap = "round";
    const lines = links.map(([near, far]) => [
      this.middle(answer, near),
      this.middle(answer, far),
    ]);
    for (const [p, q] of lines) this.line(p, q, 3, "rgb(0 0 0 / 45%)");
    for (const [p, q] of lines) this.line(p, q, 1.2, "#ffffff");
    if (!path.length) return;
    const [p, q] = this.element(answer, path[0] * answer.stride);
    this.line(p, q, 10, DARK);
    this.line(p, q, 6, "#ffffff");
  }

  paintChosen(wall) {
    const ends = [this.toScreen(wall.a), this.toScreen(wall.b)];
    this.context.lineCap = "round";
    this.line(...ends, 3, CHOSEN);
    for (const [x, y] of ends) {
      this.context.fillStyle = "#ffffff";
      this.context.fillRect(x - 6, y - 6, 12, 12);
      this.context.fillStyle = CHOSEN;
      this.context.fillRect(x - 4, y - 4, 8, 8);
    }
    this.paintFront(wall, ends);
  }

  /** An arrow to the front of the chosen wall. */
  paintFront(wall, [p, q]) {
    const n = this.front(wall.a, wall.b);
    const m = [(p[0] + q[0]) / 2, (p[1] + q[1]) / 2];
    const tip = [m[0] + 16 * n[0], m[1] + 16 * n[1]];
    const t = [-n[1], n[0]];
    const barb = (side) => [
      tip[0] - 6 * n[0] + side * 5 * t[0],
      tip[1] - 6 * n[1] + side * 5 * t[1],
    ];
    for (const [width, style] of [
      [5, "#ffffff"],
      [2.5, CHOSEN],
    ]) {
      this.line(m, tip, width, style);
      this.line(barb(1), tip, width, style);
      this.line(barb(-1), tip, width, style);
    }
  }
}
