// SPDX-License-Identifier: GPL-3.0-or-later
// The panel: what it shows of a scene and of an answer.

import { drawChart } from "./chart.js";
import { paintTiles } from "./tiles.js";

const TICKS = 6;

export const $ = (id) => document.getElementById(id);

/** A number in few digits. */
export function short(value) {
  if (!Number.isFinite(value)) return "unknown";
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e6)) return value.toExponential(2);
  return String(Number(value.toPrecision(4)));
}

const whole = (value) => value.toLocaleString("en");
const tiny = (value) => (Number.isFinite(value) ? value.toExponential(1) : "not known");

export function showStatus(state, text) {
  const status = $("status");
  status.dataset.state = state;
  if (status.textContent !== text) status.textContent = text;
  const busy = state === "busy";
  $("stop").hidden = !busy;
  $("progress").hidden = !busy;
  if (busy) $("progress").removeAttribute("value");
}

/** The phase is not spoken by a reader of the screen: it would never be silent. */
export function showProgress({ phase, fraction }) {
  $("progress").value = fraction;
  $("progress").title = phase;
}

/** A note stays until the next edit, a failure until the next answer. */
export function showMessage(text, kind = "failure") {
  $("message").dataset.kind = kind;
  $("message").textContent = text;
  $("message").hidden = !text;
}

function showList(list, rows) {
  list.replaceChildren(
    ...rows.flatMap(([term, text]) => {
      const dt = document.createElement("dt");
      const dd = document.createElement("dd");
      dt.textContent = term;
      dd.textContent = text;
      return [dt, dd];
    }),
  );
}

/** N, L and, of an exact answer, its errors. */
export function showNumbers(answer, exact) {
  const a = answer.account;
  const rows = [
    ["elements N", whole(a.elements)],
    ["links L", whole(a.links)],
    ["order p", String(a.order)],
  ];
  if (exact) {
    const say = (text) => (answer.measured ? text : "…");
    rows.push(
      ["error of averages", say(`about ${tiny(a.average.estimate)}`)],
      ["at most", say(tiny(a.average.bound))],
      ["error at points", say(`about ${tiny(a.sup.estimate)}`)],
    );
    if (answer.seconds) rows.push(["time", `${short(answer.seconds)} s`]);
  }
  showList($("numbers"), rows);
}

/** Every average with all its digits. */
export function showValues(answer, names) {
  const rows = [];
  for (let patch = 0; patch < names.length; patch++)
    for (let band = 0; band < answer.bands; band++) {
      const row = document.createElement("tr");
      const cells = [
        names[patch],
        band,
        answer.average(patch, band),
        answer.average(patch, band, 1),
      ];
      for (const text of cells) row.insertCell().textContent = String(text);
      rows.push(row);
    }
  $("values").tBodies[0].replaceChildren(...rows);
}

/** The names of all patches, in their order. */
export function namesOf(scene) {
  return scene.walls.flatMap((w) => (w.both ? [w.name, `${w.name} (back)`] : [w.name]));
}

export function showLegend(scale) {
  const canvas = $("legend");
  const context = canvas.getContext("2d");
  const image = context.createImageData(canvas.width, 1);
  for (let k = 0; k < canvas.width; k++)
    scale.put(image.data, 4 * k, scale.value(k / (canvas.width - 1)));
  context.putImageData(image, 0, 0);
  $("legend-ticks").replaceChildren(
    ...Array.from({ length: TICKS }, (_, k) => {
      const tick = document.createElement("span");
      tick.textContent = short(scale.value(k / (TICKS - 1)));
      return tick;
    }),
  );
}

export function showStudy(study, now) {
  drawChart($("chart"), study, now);
  const rows = study.rows.filter((r) => r.links > 0);
  if (!rows.length) {
    $("chart-text").textContent = "No links: no light reaches anything here.";
    return;
  }
  const last = rows.at(-1);
  const slope = study.slope ? `; L grows like N to the power of ${study.slope.toFixed(2)}` : "";
  const ring = now
    ? ` The ring is the answer that is shown: N = ${whole(now.elements)}, L = ${whole(now.links)}.`
    : "";
  $("chart-text").textContent =
    `The paper’s algorithm for ε from ${short(rows[0].epsilon)} to ${short(last.epsilon)}: ` +
    `up to N = ${whole(last.elements)} and L = ${whole(last.links)}${slope}.${ring}`;
}

/** The links as tiles; a sketch has none to show. */
export function showTiles(answer, patches) {
  const count = answer.exchange.length;
  if (!count && answer.account.links) return;
  const top = paintTiles($("tiles"), answer, patches);
  const where = patches === 2 ? "the rectangle of two patches" : `the square of ${patches} patches`;
  const clustered = answer.account.links > count ? " or are linked in clusters" : "";
  $("tiles-text").textContent =
    `${whole(count)} links as tiles of ${where}: columns and rows are elements, colours the mean ` +
    `kernel, bright from ${short(top)} on, dark at ${short(top / 1e4)}. What is white does not ` +
    `see each other${clustered}.`;
}

/** Fills the controls of the chosen wall, or switches them off. */
export function showWall(scene, chosen, band, top) {
  const wall = scene.walls[chosen];
  const pair = (id, value, most) => {
    if (most) $(id).max = Math.max(most, value);
    if (document.activeElement !== $(id)) $(id).value = value;
    if (document.activeElement !== $(`${id}-number`)) $(`${id}-number`).value = value;
  };
  for (const id of [
    "emission",
    "emission-number",
    "reflectance",
    "reflectance-number",
    "both",
    "flip",
    "delete",
  ])
    $(id).disabled = !wall;
  $("wall").value = wall ? String(chosen) : "";
  pair("emission", wall ? wall.emission[band] : 0, top);
  pair("reflectance", wall ? wall.reflectance[band] : 0);
  pair("background", scene.background[band], top);
  $("both").checked = Boolean(wall?.both);
}

function option(value, text) {
  const o = document.createElement("option");
  o.value = value;
  o.textContent = text;
  return o;
}

/** The lists that depend on the scene alone. */
export function showLists(scene, band) {
  $("wall").replaceChildren(
    option("", "none"),
    ...scene.walls.map((w, k) => option(k, w.name)),
  );
  $("band").replaceChildren(
    ...scene.background.map((_, k) => option(k, `${k + 1} of ${scene.bands}`)),
  );
  $("band").value = String(band);
  document.querySelector(".of-bands").hidden = scene.bands === 1;
}
