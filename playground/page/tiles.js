// SPDX-License-Identifier: GPL-3.0-or-later
// The links of an answer as tiles of the rectangle of two patches, or of the square of all, in the
// colour of their mean kernel.  Pixels are written one by one: there may be a million links.

import { Scale } from "./palette.js";

const SIDE = 512; // pixels of the longer side
const LEAST_SIDE = 64;
const OUTLINED = 5; // pixels of a tile that has white between itself and the next
const BRIGHTEST = 0.995; // of the area of tiles is below the end of the scale
const MOST_SAMPLES = 20000;

const length = ({ a, b }) => Math.hypot(b[0] - a[0], b[1] - a[1]);

/** Where each patch from `first` to `end` begins on an axis of length 1, and how long it is. */
function axis(lengths, first, end) {
  const total = lengths.slice(first, end).reduce((sum, l) => sum + l, 0) || 1;
  const starts = new Map();
  let at = 0;
  for (let k = first; k < end; k++) {
    starts.set(k, at / total);
    at += lengths[k];
  }
  return { starts, total };
}

/** The patches along both sides: one each of two patches, or all. */
function axes(answer, patches) {
  const lengths = Array.from({ length: patches }, (_, k) => length(answer.segment(k)));
  const pair = patches === 2;
  return [axis(lengths, 0, pair ? 1 : patches), axis(lengths, pair ? 1 : 0, patches)];
}

/** The kernel that hardly a tile exceeds: it has no bound where patches meet. */
function brightest({ exchange, links }, lengths) {
  const step = Math.max(1, Math.floor(exchange.length / MOST_SAMPLES));
  const tiles = [];
  for (let k = 0; k < exchange.length; k += step) {
    const area = lengths[links[2 * k]] * lengths[links[2 * k + 1]];
    if (area > 0) tiles.push([exchange[k] / area, area]);
  }
  tiles.sort((p, q) => p[0] - q[0]);
  let left = BRIGHTEST * tiles.reduce((sum, [, area]) => sum + area, 0);
  for (const [kernel, area] of tiles) if ((left -= area) <= 0) return kernel;
  return tiles.at(-1)?.[0] ?? 1;
}

/** The pixels of each element along an axis, first and end; both 0 if its patch is not there. */
function pixelsOf(answer, lengths, { starts, total }, side) {
  const pixels = new Uint16Array(2 * answer.count);
  const root = new Map([...starts.keys()].map((patch) => [patch, answer.segment(patch).a]));
  for (let k = 0; k < answer.count; k++) {
    const patch = answer.patch(k);
    if (!starts.has(patch)) continue;
    const before = length({ a: root.get(patch), b: answer.segment(k).a });
    const start = starts.get(patch) + before / total;
    const low = Math.min(side - 1, Math.round(side * start));
    const high = Math.min(side, Math.round(side * (start + lengths[k] / total)));
    pixels[2 * k] = low;
    pixels[2 * k + 1] = Math.max(low + 1, high - (high - low >= OUTLINED ? 1 : 0));
  }
  return pixels;
}

class Tiles {
  constructor(canvas, answer, patches) {
    const [columns, rows] = axes(answer, patches);
    const longer = Math.max(columns.total, rows.total);
    const side = (total) => Math.max(LEAST_SIDE, Math.round((SIDE * total) / longer));
    this.answer = answer;
    this.lengths = Float64Array.from({ length: answer.count }, (_, k) => answer.length(k));
    this.width = canvas.width = side(columns.total);
    this.height = canvas.height = side(rows.total);
    this.columns = pixelsOf(answer, this.lengths, columns, this.width);
    this.rows = pixelsOf(answer, this.lengths, rows, this.height);
    this.image = new ImageData(this.width, this.height);
    this.image.data.fill(255);
    this.scale = new Scale(brightest(answer, this.lengths), "log");
  }

  /** Rows go up. */
  put(column, row, kernel) {
    const [x0, x1] = [this.columns[2 * column], this.columns[2 * column + 1]];
    const [y0, y1] = [this.rows[2 * row], this.rows[2 * row + 1]];
    for (let y = y0; y < y1; y++)
      for (let x = x0; x < x1; x++)
        this.scale.put(this.image.data, 4 * ((this.height - 1 - y) * this.width + x), kernel);
  }

  paint() {
    const { links, exchange } = this.answer;
    for (let k = 0; k < exchange.length; k++) {
      const [near, far] = [links[2 * k], links[2 * k + 1]];
      const kernel = exchange[k] / (this.lengths[near] * this.lengths[far]);
      this.put(near, far, kernel);
      this.put(far, near, kernel);
    }
  }
}

/** Paints the tiles of an answer for so many patches; returns the end of their scale. */
export function paintTiles(canvas, answer, patches) {
  const tiles = new Tiles(canvas, answer, patches);
  tiles.paint();
  canvas.getContext("2d").putImageData(tiles.image, 0, 0);
  return tiles.scale.top;
}
