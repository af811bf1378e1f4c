// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of the plan as files: what is on the screen, and the scale of its colours below it.

import { short } from "./panel.js";

const LEGEND = 44; // pixels of height
const TICKS = 6;
const STEPS = 64;

export function download(blob, name) {
  const url = URL.createObjectURL(blob);
  const link = document.createElement("a");
  link.href = url;
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}

function legend(scale, width) {
  const ticks = Array.from({ length: TICKS }, (_, k) => ({
    x: 20 + (k / (TICKS - 1)) * (width - 40),
    text: short(scale.value(k / (TICKS - 1))),
  }));
  const step = (width - 40) / STEPS;
  const swatches = Array.from({ length: STEPS }, (_, k) => ({
    x: 20 + k * step,
    width: step + 0.5,
    colour: scale.css(scale.value((k + 0.5) / STEPS)),
  }));
  return { ticks, swatches };
}

export function toPNG({ view, scale }) {
  const ratio = view.canvas.width / view.width;
  const canvas = document.createElement("canvas");
  canvas.width = view.canvas.width;
  canvas.height = Math.round(view.canvas.height + LEGEND * ratio);
  const c = canvas.getContext("2d");
  c.fillStyle = "#ffffff";
  c.fillRect(0, 0, canvas.width, canvas.height);
  c.drawImage(view.canvas, 0, 0);
  c.setTransform(ratio, 0, 0, ratio, 0, view.canvas.height);
  const { ticks, swatches } = legend(scale, view.width);
  for (const s of swatches) {
    c.fillStyle = s.colour;
    c.fillRect(s.x, 8, s.width, 12);
  }
  c.fillStyle = "#16202b";
  c.font = "12px sans-serif";
  c.textAlign = "center";
  for (const t of ticks) c.fillText(t.text, t.x, 36);
  return new Promise((resolve) => canvas.toBlob(resolve, "image/png"));
}

const escape = (text) => text.replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`);
const at = (v) => v.toFixed(2);

/** Light as an image; walls, elements and the legend as shapes. */
export function toSVG({ view, scale, scene, answer, band, images }) {
  const { width, height } = view;
  const lines = [];
  const line = (a, b, stroke, thick, title = "") => {
    const [p, q] = [view.toScreen(a), view.toScreen(b)];
    lines.push(
      `<line x1="${at(p[0])}" y1="${at(p[1])}" x2="${at(q[0])}" y2="${at(q[1])}" ` +
        `stroke="${stroke}" stroke-width="${thick}"><title>${escape(title)}</title></line>`,
    );
  };
  for (let k = 0; k < images.length; k += 4)
    line([images[k], images[k + 1]], [images[k + 2], images[k + 3]], "#8a8f96", 2);
  for (const w of scene.walls) line(w.a, w.b, "#10141a", w.kind === "mirror" || w.kind === "gas" ? 1.5 : 4, w.name);
  for (const leaf of answer ? answer.leaves() : []) {
    const { a, b } = answer.segment(leaf);
    const n = view.front(a, b).map((v) => (4.5 * v) / view.scale);
    const shift = ([x, y]) => [x + n[0], y - n[1]];
    line(shift(a), shift(b), scale.css(answer.value(leaf, band)), 5);
  }
  const { ticks, swatches } = legend(scale, width);
  return (
    `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height + LEGEND}" ` +
    `width="${width}" height="${height + LEGEND}" font-family="sans-serif" font-size="12">\n` +
    `<clipPath id="plan"><rect width="${width}" height="${height}"/></clipPath>` +
    `<rect width="${width}" height="${height}" fill="#d5dbe2"/>\n` +
    `<g clip-path="url(#plan)" stroke-linecap="round">\n${view.imageSVG()}\n${lines.join("\n")}\n` +
    `</g>\n<g transform="translate(0 ${height})">\n` +
    swatches
      .map(
        ({ x, width: wide, colour }) =>
          `<rect x="${at(x)}" y="8" width="${at(wide)}" height="12" fill="${colour}"/>`,
      )
      .join("") +
    ticks
      .map((t) => `<text x="${at(t.x)}" y="36" text-anchor="middle">${escape(t.text)}</text>`)
      .join("") +
    `\n</g>\n</svg>\n`
  );
}
