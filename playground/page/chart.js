// SPDX-License-Identifier: GPL-3.0-or-later
// L against N, both logarithmic, as SVG.

const WIDTH = 320;
const HEIGHT = 220;
const LEFT = 46;
const BOTTOM = 34;
const TOP = 10;
const RIGHT = 12;

const power = (k) =>
  k < 4 ? String(10 ** k) : `10${[...String(k)].map((d) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[d]).join("")}`;

function element(name, attributes, text = "") {
  const e = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, v] of Object.entries(attributes)) e.setAttribute(key, v);
  e.textContent = text;
  return e;
}

/** A logarithmic axis over whole decades. */
function axis(values, from, to) {
  const logs = values.map(Math.log10);
  const low = Math.floor(Math.min(...logs));
  const high = Math.max(low + 1, Math.ceil(Math.max(...logs)));
  return {
    low,
    high,
    at: (v) => from + ((Math.log10(v) - low) / (high - low)) * (to - from),
  };
}

function frame(svg, x, y) {
  const bottom = HEIGHT - BOTTOM;
  for (let k = x.low; k <= x.high; k++) {
    const at = x.at(10 ** k);
    svg.append(element("line", { x1: at, x2: at, y1: TOP, y2: bottom, class: "grid" }));
    svg.append(element("text", { x: at, y: bottom + 15, class: "middle" }, power(k)));
  }
  for (let k = y.low; k <= y.high; k++) {
    const at = y.at(10 ** k);
    svg.append(element("line", { x1: LEFT, x2: WIDTH - RIGHT, y1: at, y2: at, class: "grid" }));
    svg.append(element("text", { x: LEFT - 6, y: at + 4, class: "end" }, power(k)));
  }
  svg.append(
    element("text", { x: (LEFT + WIDTH) / 2, y: HEIGHT - 3, class: "middle" }, "elements N"),
  );
  const side = {
    x: 0,
    y: 0,
    class: "middle",
    transform: `translate(11 ${HEIGHT / 2 - 12}) rotate(-90)`,
  };
  svg.append(element("text", side, "links L"));
}

/** Draws the rows of a study, and the answer that is shown as a ring. */
export function drawChart(svg, study, now) {
  svg.setAttribute("viewBox", `0 0 ${WIDTH} ${HEIGHT}`);
  svg.replaceChildren();
  const dots = study.rows.filter((r) => r.links > 0);
  const all = now && now.links > 0 ? [...dots, now] : dots;
  if (!all.length) return;
  const x = axis(
    all.map((r) => r.elements),
    LEFT,
    WIDTH - RIGHT,
  );
  const y = axis(
    all.map((r) => r.links),
    HEIGHT - BOTTOM,
    TOP,
  );
  frame(svg, x, y);
  const path = dots.map((r) => `${x.at(r.elements)},${y.at(r.links)}`).join(" ");
  svg.append(element("polyline", { points: path, class: "curve" }));
  for (const r of dots)
    svg.append(
      element("circle", { cx: x.at(r.elements), cy: y.at(r.links), r: 3.2, class: "dot" }),
    );
  if (now && now.links > 0)
    svg.append(
      element("circle", { cx: x.at(now.elements), cy: y.at(now.links), r: 7, class: "now" }),
    );
}
